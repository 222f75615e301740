// SPDX-License-Identifier: MIT
// Looks up a robot, and what its masks and figures say.
#include "robot/robot.h"

#include <stddef.h>

_Static_assert(ARGUS_ROBOT_LAST == ARGUS_ROBOTS,
               "the setting robot has a value for each row, and by-subclass");

const argus_robot_t *argus_robot_default(void) {
    return &argus_robot_table.robots[0];
}

const argus_robot_t *argus_robot_unknown(void) {
    static const argus_robot_t unknown = {.front_mm = INT16_MAX,
                                          .rear_mm = INT16_MAX,
                                          .width_mm = INT16_MAX,
                                          .swing_radius_mm = INT16_MAX,
                                          .pitch_deg = 1,
                                          .decel_mm_s2 = 1,
                                          .track_mm = 1,
                                          .dist_conv_um = 1000,
                                          .no_echo_mm = 5000};
    return &unknown;
}

static char lower(const char letter) {
    return letter >= 'A' && letter <= 'Z' ? (char)(letter + ('a' - 'A')) : letter;
}

// No further than the end of `name`: there, at the latest, the two differ or both end.
static bool is_name(const char *const said, const char *const name) {
    size_t i = 0;
    while (name[i] != '\0' && lower(said[i]) == name[i]) {
        i++;
    }
    return name[i] == '\0' && said[i] == '\0';
}

const argus_robot_t *argus_robot_find(const char *const subclass) {
    if (is_name(subclass, "p3dx")) {
        return argus_robot_default();
    }
    for (int i = 0; i < ARGUS_ROBOTS; i++) {
        if (is_name(subclass, argus_robot_table.robots[i].name)) {
            return &argus_robot_table.robots[i];
        }
    }
    return NULL;
}

const argus_robot_t *argus_robot_chosen(const int32_t choice) {
    return choice >= 1 && choice <= ARGUS_ROBOTS ? &argus_robot_table.robots[choice - 1] : NULL;
}

uint8_t argus_robot_choice(const argus_robot_t *const self) {
    const argus_robot_t *const built = argus_robot_built(self);
    for (uint8_t i = 0; i < ARGUS_ROBOTS; i++) {
        if (built == &argus_robot_table.robots[i]) {
            return (uint8_t)(i + 1);
        }
    }
    return 0;
}

bool argus_robot_is_own(const argus_robot_t *const self) {
    return argus_robot_is_known(self) && argus_robot_choice(self) == 0;
}

const argus_robot_t *argus_robot_other_end(const argus_robot_t *const self) {
    const argus_robot_t *const other = self->other != 0 ? self + self->other : NULL;
    if (other == NULL) {
        return NULL;
    }
    const int last = other->forward[other->forward_count - 1];
    const bool whole = other->forward[0] < ARGUS_SONARS && last < ARGUS_SONARS; // GCOV_EXCL_BR_LINE: as below
    return whole ? other : NULL; // GCOV_EXCL_BR_LINE: a build of 8 sonars manages one end only
}

const argus_robot_t *argus_robot_built(const argus_robot_t *const self) {
    ARGUS_ASSERT(!self->reversed || self->other != 0);
    return self->reversed ? self + self->other : self;
}

int32_t argus_robot_facing_cdeg(const argus_robot_t *const self) {
    return self->reversed ? 18000 : 0;
}

bool argus_robot_is_known(const argus_robot_t *const self) {
    return self->name[0] != '\0';
}

int argus_robot_sonars(const argus_robot_t *const self) {
    return self->sonars < ARGUS_SONARS ? self->sonars : ARGUS_SONARS;
}

argus_sonar_pose_t argus_robot_pose(const argus_robot_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < argus_robot_sonars(self));
    argus_sonar_pose_t pose = ((const argus_sonar_pose_t *)((const char *)self + self->poses))[sonar];
    if (self->reversed) {
        pose.x_mm = (int16_t)-pose.x_mm;
        pose.y_mm = (int16_t)-pose.y_mm;
        pose.heading_deg = (int16_t)(pose.heading_deg > 0 ? pose.heading_deg - 180 : pose.heading_deg + 180);
    }
    return pose;
}

int argus_robot_beside(const argus_robot_t *const self, const int sonar, const bool left) {
    const int step = left ? -1 : 1;
    for (int i = 0; i < self->forward_count; i++) {
        const int beside = i + step;
        if (self->forward[i] == sonar && beside >= 0 && beside < self->forward_count) {
            return self->forward[beside];
        }
    }
    return -1;
}

argus_mask_t argus_robot_all(const argus_robot_t *const self) {
    const int count = argus_robot_sonars(self);
    ARGUS_ASSERT(count <= ARGUS_SONARS);
    return (argus_mask_t)(count == 0 ? 0u : UINT32_MAX >> (32 - count));
}

argus_mask_t argus_robot_forward(const argus_robot_t *const self) {
    return self->forward_mask;
}

argus_mask_t argus_robot_ahead(const argus_robot_t *const self) {
    return self->ahead_mask;
}

argus_mask_t argus_robot_astern(const argus_robot_t *const self) {
    return self->astern_mask;
}

argus_mask_t argus_robot_flank(const argus_robot_t *const self) {
    return self->flank_mask;
}

argus_mask_t argus_robot_rear_flank(const argus_robot_t *const self) {
    return self->rear_flank_mask;
}

argus_mask_t argus_robot_array(const argus_robot_t *const self, const int array) {
    return (argus_mask_t)(argus_robot_all(self) & UINT32_C(0xFF)
                                                      << ARCOS_TIMING_TRANSDUCERS_PER_ARRAY * array);
}

argus_mask_t argus_robot_polled(const argus_robot_t *const self) {
    uint32_t mask = 0;
    for (int array = 0; array < self->arrays; array++) {
        const argus_mask_t its = argus_robot_array(self, array);
        mask |= (its & argus_robot_forward(self)) != 0 ? its : 0u;
    }
    return (argus_mask_t)mask;
}

argus_mask_t argus_robot_leading(const argus_robot_t *const self) {
    return (argus_mask_t)(argus_robot_polled(self) & ~(uint32_t)argus_robot_astern(self));
}

bool argus_robot_faces_forward(const argus_robot_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return (argus_robot_forward(self) >> sonar & 1u) != 0;
}

bool argus_robot_looks_ahead(const argus_robot_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return (argus_robot_ahead(self) >> sonar & 1u) != 0;
}

// A sector without a role sees at one height only.
argus_mask_t argus_robot_looking(const argus_robot_t *const self) {
    const unsigned guard = (unsigned)self->ahead_mask | (unsigned)self->astern_mask |
                           (unsigned)self->flank_mask | (unsigned)self->rear_flank_mask;
    return (argus_mask_t)(argus_robot_all(self) & ~((unsigned)self->sector_mask & ~guard));
}

argus_mask_t argus_robot_sectors(const argus_robot_t *const self) {
    return self->sector_mask;
}

int32_t argus_robot_cone_deg(const argus_robot_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return (self->sector_mask >> sonar & 1u) != 0 ? self->sector_deg : self->cone_deg;
}

int32_t argus_robot_half_width_mm(const argus_robot_t *const self) {
    return (self->width_mm + 1) / 2;
}
