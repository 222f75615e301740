// SPDX-License-Identifier: MIT
// Obstacle avoidance: remembers echoes and takes the free corridor that is nearest to the way to the
// waypoint.
#include <string.h>

#include "knowledge/angle.h"
#include "task/task.h"

#define REMEMBER_BELOW_MM 2000 // beyond it a beam is too wide to say where the echo lies
#define SAME_PLACE_MM 80
#define SAME_THING_MM 150
#define FORGET_MS 60000u
#define WIDE_ROOM_MM \
    30 // beside the swing circle: room to turn anywhere on the way (S7 wants 20 under `argus`)
#define NARROW_ROOM_MM 92 // beside the body, for the beam's width: where there is no wide way
#define STRAIGHT_ROOM_MM 47
#define NEAR_MM 1000
#define LATELY_MS 5000u      // what was seen so near does not go away while a look is prepared
#define CORRIDOR_ROOM_MM 440 // free length wanted ahead of the body
#define BEHIND_MM 100        // an echo this far ahead of the centre is beside the robot already
#define LEG_MM 300           // way along a detour before choosing again
#define STEP_CDEG 1000
#define STEPS 14           // detours up to 140 degrees off the waypoint's bearing
#define OTHER_SIDE_STEPS 6 // a detour prefers the side it began on by so much
#define REFUSED_CDEG 1500
#define MOVED_ON_MM 150
#define BUMPER_AHEAD_MM 30 // of the body
#define BY_TOUCH UINT8_MAX // no sonar: it is there for sure

int32_t argus_task_straight_half_mm(const argus_robot_t *const robot) {
    return argus_robot_half_width_mm(robot) + STRAIGHT_ROOM_MM;
}

static int32_t corridor_mm(const argus_knowledge_t *const knowledge) {
    return knowledge->robot->front_mm + CORRIDOR_ROOM_MM;
}

static bool same_place(const argus_seen_t *const seen, const argus_point_t *const at) {
    return argus_abs(seen->x_mm - at->x_mm) < SAME_PLACE_MM &&
           argus_abs(seen->y_mm - at->y_mm) < SAME_PLACE_MM;
}

// The slot that holds this place already, else a free one, else the oldest.
static argus_seen_t *slot_for(argus_task_t *const self, const argus_point_t *const at) {
    for (uint16_t i = 0; i < self->seen_count; i++) {
        if (same_place(&self->seen[i], at)) {
            return &self->seen[i];
        }
    }
    if (self->seen_count < ARGUS_POINTS_MAX) {
        return &self->seen[self->seen_count++];
    }
    self->seen_next = (uint16_t)((self->seen_next + 1) % ARGUS_POINTS_MAX);
    return &self->seen[self->seen_next];
}

bool argus_task_is_one_thing(const argus_point_t a, const argus_point_t b) {
    return argus_abs(a.x_mm - b.x_mm) <= SAME_THING_MM && argus_abs(a.y_mm - b.y_mm) <= SAME_THING_MM;
}

// A second echo of one thing, lately; a wall gives one a little farther on, as far as the robot drove
// meanwhile. What was seen twice before stays so for as long as it is remembered.
static bool is_seen_again(const argus_seen_t *const seen, const argus_point_t *const at,
                          const uint32_t now_ms) {
    const uint32_t age_ms = now_ms - seen->seen_ms;
    const argus_point_t there = {seen->x_mm, seen->y_mm};
    return (argus_task_is_one_thing(there, *at) && age_ms <= LATELY_MS) ||
           (seen->again && age_ms <= FORGET_MS && same_place(seen, at));
}

// ... of something at most so far from there.
static bool has_seen(const argus_task_t *const self, const argus_point_t *const at, const uint32_t now_ms,
                     const argus_point_t *const from, const int32_t within_mm) {
    for (uint16_t i = 0; i < self->seen_count; i++) {
        const argus_seen_t *const seen = &self->seen[i];
        if (is_seen_again(seen, at, now_ms) &&
            argus_hypot(seen->x_mm - from->x_mm, seen->y_mm - from->y_mm) <= within_mm) {
            return true;
        }
    }
    return false;
}

bool argus_task_has_seen(const argus_task_t *const self, const argus_knowledge_t *const knowledge,
                         const argus_point_t at, const int32_t within_mm) {
    const argus_point_t centre = {knowledge->pose.x_mm, knowledge->pose.y_mm};
    return has_seen(self, &at, knowledge->sip_ms, &centre, within_mm);
}

static void remember(argus_task_t *const self, const argus_point_t at, const uint8_t sonar,
                     const uint32_t now_ms) {
    if (argus_abs(at.x_mm) > INT16_MAX || argus_abs(at.y_mm) > INT16_MAX) {
        return;
    }
    const bool again = sonar == BY_TOUCH || has_seen(self, &at, now_ms, &at, INT32_MAX);
    argus_seen_t *const slot = slot_for(self, &at);
    slot->again = again;
    slot->x_mm = (int16_t)at.x_mm;
    slot->y_mm = (int16_t)at.y_mm;
    slot->sonar = sonar;
    slot->seen_ms = now_ms;
}

void argus_task_see(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                    const uint32_t now_ms) {
    for (int i = 0; i < knowledge->sonars; i++) {
        const bool fresh = (knowledge->fresh >> i & 1u) != 0;
        if (fresh && argus_usable(knowledge, i) && knowledge->sonar[i].health != ARGUS_SUSPECT &&
            !knowledge->rotating && knowledge->sonar[i].reading_mm < REMEMBER_BELOW_MM) {
            remember(self, argus_to_course(&knowledge->pose, argus_echo_robot(knowledge, i)), (uint8_t)i,
                     now_ms);
        }
    }
}

void argus_task_forget(argus_task_t *const self, const int sonar) {
    uint16_t kept = 0;
    for (uint16_t i = 0; i < self->seen_count; i++) {
        if (self->seen[i].sonar != sonar) {
            self->seen[kept++] = self->seen[i];
        }
    }
    self->seen_count = kept;
    self->seen_next = 0;
}

void argus_task_touched(argus_task_t *const self, const argus_point_t at, const uint32_t now_ms) {
    remember(self, at, BY_TOUCH, now_ms);
}

// The front segments lie across the bow, bit 1 leftmost; what they touched is remembered as if it had been
// seen.
void argus_task_bumped(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                       const uint32_t now_ms) {
    const argus_robot_t *const robot = knowledge->robot;
    const int segments = robot->front_bumpers;
    for (int segment = 1; segment <= segments; segment++) {
        if ((knowledge->bumpers_front >> segment & 1u) != 0) {
            const int32_t beside_mm = (segments + 1 - 2 * segment) * (robot->width_mm / segments) / 2;
            const argus_point_t touched = {robot->front_mm + BUMPER_AHEAD_MM, beside_mm};
            argus_task_touched(self, argus_to_course(&knowledge->pose, touched), now_ms);
        }
    }
}

int32_t argus_task_clear_mm(const argus_task_t *const self, const argus_knowledge_t *const knowledge,
                            const int32_t heading_cdeg, const int32_t half_mm) {
    const int32_t c = argus_cos(heading_cdeg);
    const int32_t s = argus_sin(heading_cdeg);
    int32_t clear = INT32_MAX;
    for (uint16_t i = 0; i < self->seen_count; i++) {
        const int32_t dx = argus_max(-32000, argus_min(32000, self->seen[i].x_mm - knowledge->pose.x_mm));
        const int32_t dy = argus_max(-32000, argus_min(32000, self->seen[i].y_mm - knowledge->pose.y_mm));
        const int32_t ahead = (dx * c + dy * s) / ARGUS_TRIG_ONE;
        const int32_t beside = (dy * c - dx * s) / ARGUS_TRIG_ONE;
        const bool recent = knowledge->sip_ms - self->seen[i].seen_ms <= FORGET_MS;
        if (recent && ahead > BEHIND_MM && argus_abs(beside) < half_mm) {
            clear = argus_min(clear, ahead);
        }
    }
    return clear;
}

int32_t argus_task_nearest_mm(const argus_task_t *const self, const argus_knowledge_t *const knowledge,
                              const int32_t back_mm) {
    const argus_point_t back = {-back_mm, 0};
    const argus_point_t centre = argus_to_course(&knowledge->pose, back);
    int32_t nearest = INT32_MAX;
    for (uint16_t i = 0; i < self->seen_count; i++) {
        const int32_t dx = self->seen[i].x_mm - centre.x_mm;
        const int32_t dy = self->seen[i].y_mm - centre.y_mm;
        const bool near = argus_abs(dx) < NEAR_MM && argus_abs(dy) < NEAR_MM;
        if (near && self->seen[i].again && knowledge->sip_ms - self->seen[i].seen_ms <= LATELY_MS) {
            nearest = argus_min(nearest, argus_hypot(dx, dy));
        }
    }
    return nearest;
}

void argus_task_refuse(argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    self->has_leg = false;
    self->avoiding = true;
    self->refused_at.x_mm = knowledge->pose.x_mm;
    self->refused_at.y_mm = knowledge->pose.y_mm;
    if (self->refused < sizeof self->refused_cdeg / sizeof self->refused_cdeg[0]) {
        self->refused_cdeg[self->refused++] = knowledge->pose.heading_cdeg;
    }
}

void argus_task_refuse_slant(argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    argus_task_refuse(self, knowledge);
    self->slanted = true;
    self->slanted_cdeg = knowledge->pose.heading_cdeg;
}

void argus_task_forgive(argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    self->refused = 0;
    self->slanted = self->slanted && argus_flank_mm(knowledge) <= ARGUS_FLANK_NEAR_MM;
}

static void forgive_when_moved(argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    const int32_t moved = argus_hypot(knowledge->pose.x_mm - self->refused_at.x_mm,
                                      knowledge->pose.y_mm - self->refused_at.y_mm);
    if (moved >= MOVED_ON_MM) {
        self->refused = 0;
        self->slanted = false;
    }
}

static bool is_refused(const argus_task_t *const self, const int32_t heading_cdeg) {
    if (self->slanted && argus_angle_abs_diff(self->slanted_cdeg, heading_cdeg) < REFUSED_CDEG) {
        return true;
    }
    for (uint8_t i = 0; i < self->refused; i++) {
        if (argus_angle_abs_diff(self->refused_cdeg[i], heading_cdeg) < REFUSED_CDEG) {
            return true;
        }
    }
    return false;
}

typedef struct {
    int32_t half_mm;
    int32_t length_mm;
} corridor_t;

static bool is_free(const argus_task_t *const self, const argus_knowledge_t *const knowledge,
                    const int32_t heading_cdeg, const corridor_t *const wanted) {
    return !is_refused(self, heading_cdeg) &&
           argus_task_clear_mm(self, knowledge, heading_cdeg, wanted->half_mm) >= wanted->length_mm;
}

// The side on which the detour began costs nothing, the other one OTHER_SIDE_STEPS. Size of the `step`th try
// on a side, outside 1..STEPS when there is none.
static int detour_size(const argus_task_t *const self, const int step, const int8_t side) {
    const bool other = self->side != 0 && side != self->side;
    return other ? step - OTHER_SIDE_STEPS : step;
}

// Nearest to the bearing first.
static bool find_detour(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                        const int32_t half_mm, const int32_t bearing_cdeg, int32_t *const heading_cdeg) {
    const corridor_t wanted = {half_mm, corridor_mm(knowledge)};
    int8_t side = self->side != 0 ? self->side : 1;
    for (int i = 2; i < 2 * (STEPS + OTHER_SIDE_STEPS + 1); i++) {
        const int size = detour_size(self, i / 2, side);
        const int32_t heading = argus_angle_wrap(bearing_cdeg + side * size * STEP_CDEG);
        if (size >= 1 && size <= STEPS && is_free(self, knowledge, heading, &wanted)) {
            self->side = self->side == 0 ? side : self->side;
            *heading_cdeg = heading;
            return true;
        }
        side = (int8_t)-side;
    }
    return false;
}

static void lead_to(argus_task_t *const self, const argus_point_t to) {
    self->leg = to;
    self->has_leg = true;
}

static void lead_ahead(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                       const int32_t heading_cdeg) {
    const argus_point_t ahead = {LEG_MM, 0};
    const argus_pose_t turned = {knowledge->pose.x_mm, knowledge->pose.y_mm, heading_cdeg};
    lead_to(self, argus_to_course(&turned, ahead));
}

// The waypoint itself when the corridor to it is free, else the best detour of that width.
static bool choose_corridor(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                            const int32_t half_mm) {
    lead_to(self, self->waypoint[self->next]);
    const int32_t bearing = argus_task_bearing_cdeg(self, knowledge);
    const int32_t leg_mm = argus_task_leg_mm(self, knowledge);
    const corridor_t direct = {half_mm, argus_min(corridor_mm(knowledge), leg_mm + half_mm)};
    if ((!self->avoiding && !is_refused(self, bearing)) || is_free(self, knowledge, bearing, &direct)) {
        self->avoiding = false;
        self->side = 0;
        return true;
    }
    self->avoiding = true;
    int32_t heading = 0;
    if (!find_detour(self, knowledge, half_mm, bearing, &heading)) {
        return false;
    }
    lead_ahead(self, knowledge, heading);
    return true;
}

bool argus_task_choose(argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    if (self->next >= self->count) {
        return false;
    }
    forgive_when_moved(self, knowledge);
    const int32_t wide_mm = knowledge->robot->swing_radius_mm + WIDE_ROOM_MM;
    const int32_t narrow_mm = argus_robot_half_width_mm(knowledge->robot) + NARROW_ROOM_MM;
    if (choose_corridor(self, knowledge, wide_mm) || choose_corridor(self, knowledge, narrow_mm)) {
        return true;
    }
    self->has_leg = false;
    self->side = 0;
    return false;
}

bool argus_task_escape(argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    const int32_t heading = knowledge->pose.heading_cdeg;
    const corridor_t wanted = {argus_task_straight_half_mm(knowledge->robot), corridor_mm(knowledge)};
    if (self->next >= self->count || !is_free(self, knowledge, heading, &wanted)) {
        return false;
    }
    self->avoiding = true;
    lead_ahead(self, knowledge, heading);
    return true;
}
