// SPDX-License-Identifier: MIT
// Obstacle avoidance: takes the corridor free of remembered echoes that is nearest to the way to the
// waypoint.
#include "task/task.h"

#include "adjustment/guard.h"
#include "knowledge/angle.h"

#define WIDE_ROOM_MM \
    30 // beside the swing circle: room to turn anywhere on the way (S7 wants 20 under `argus`)
#define NARROW_ROOM_MM 92    // beside the body, for the beam's width: where there is no wide way
#define CORRIDOR_ROOM_MM 440 // free length wanted ahead of the body
#define LEG_MM 300           // way along a detour before choosing again
#define STEP_CDEG 1000
#define STEPS 14           // detours up to 140 degrees off the waypoint's bearing
#define OTHER_SIDE_STEPS 6 // a detour prefers the side it began on by so much
#define REFUSED_CDEG 1500
#define MOVED_ON_MM 150

static int32_t corridor_mm(const argus_knowledge_t *const knowledge) {
    return knowledge->robot->front_mm + CORRIDOR_ROOM_MM;
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
    ARGUS_ASSERT(self->refused <= sizeof self->refused_cdeg / sizeof self->refused_cdeg[0]);
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

// What is known of what stands about the robot.
typedef struct {
    const argus_knowledge_t *knowledge;
    const argus_echoes_t *echoes;
} around_t;

typedef struct {
    int32_t half_mm;
    int32_t length_mm;
} corridor_t;

static bool is_free(const argus_task_t *const self, const around_t *const around, const int32_t heading_cdeg,
                    const corridor_t *const wanted) {
    return !is_refused(self, heading_cdeg) &&
           argus_echoes_clear_mm(around->echoes, around->knowledge, heading_cdeg, wanted->half_mm) >=
               wanted->length_mm;
}

// The side on which the detour began costs nothing, the other one OTHER_SIDE_STEPS. Size of the `step`th try
// on a side, outside 1..STEPS when there is none.
static int detour_size(const argus_task_t *const self, const int step, const int8_t side) {
    const bool other = self->side != 0 && side != self->side;
    return other ? step - OTHER_SIDE_STEPS : step;
}

// Nearest to the bearing first.
static bool find_detour(argus_task_t *const self, const around_t *const around, const int32_t half_mm,
                        const int32_t bearing_cdeg, int32_t *const heading_cdeg) {
    ARGUS_ASSERT(half_mm > 0 && self->side >= -1 && self->side <= 1);
    const corridor_t wanted = {half_mm, corridor_mm(around->knowledge)};
    int8_t side = self->side != 0 ? self->side : 1;
    for (int i = 2; i < 2 * (STEPS + OTHER_SIDE_STEPS + 1); i++) {
        const int size = detour_size(self, i / 2, side);
        const int32_t heading = argus_angle_wrap(bearing_cdeg + side * size * STEP_CDEG);
        if (size >= 1 && size <= STEPS && is_free(self, around, heading, &wanted)) {
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
static bool choose_corridor(argus_task_t *const self, const around_t *const around, const int32_t half_mm) {
    ARGUS_ASSERT(self->next < self->count);
    lead_to(self, self->waypoint[self->next]);
    const int32_t bearing = argus_task_bearing_cdeg(self, around->knowledge);
    const int32_t leg_mm = argus_task_leg_mm(self, around->knowledge);
    const corridor_t direct = {half_mm, argus_min(corridor_mm(around->knowledge), leg_mm + half_mm)};
    if ((!self->avoiding && !is_refused(self, bearing)) || is_free(self, around, bearing, &direct)) {
        self->avoiding = false;
        self->side = 0;
        return true;
    }
    self->avoiding = true;
    int32_t heading = 0;
    if (!find_detour(self, around, half_mm, bearing, &heading)) {
        return false;
    }
    lead_ahead(self, around->knowledge, heading);
    return true;
}

bool argus_task_choose(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                       const argus_echoes_t *const echoes) {
    ARGUS_ASSERT(self->next <= self->count);
    const around_t around = {knowledge, echoes};
    if (self->next >= self->count) {
        return false;
    }
    forgive_when_moved(self, knowledge);
    const int32_t wide_mm = knowledge->robot->swing_radius_mm + WIDE_ROOM_MM;
    const int32_t narrow_mm = argus_robot_half_width_mm(knowledge->robot) + NARROW_ROOM_MM;
    if (choose_corridor(self, &around, wide_mm) || choose_corridor(self, &around, narrow_mm)) {
        return true;
    }
    self->has_leg = false;
    self->side = 0;
    return false;
}

bool argus_task_escape(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                       const argus_echoes_t *const echoes) {
    ARGUS_ASSERT(self->count <= ARGUS_WAYPOINTS_MAX);
    const around_t around = {knowledge, echoes};
    const int32_t heading = knowledge->pose.heading_cdeg;
    const corridor_t wanted = {argus_guard_straight_half_mm(knowledge->robot), corridor_mm(knowledge)};
    if (self->next >= self->count || !is_free(self, &around, heading, &wanted)) {
        return false;
    }
    self->avoiding = true;
    lead_ahead(self, knowledge, heading);
    return true;
}
