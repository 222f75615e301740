// SPDX-License-Identifier: MIT
// Answers the questions of the safety rules from what is known now.
#include "adjustment/guard.h"

#include "arcos/gen_arcos.h"
#include "knowledge/angle.h"
#include "knowledge/config.h"

#define SLOTS 8u // in a round
#define HOME_CDEG 200
#define STRAIGHT_ROOM_MM 47
#define SEEN_MOST_MM 1200   // of the way that others see: more would allow no higher speed
#define SEEN_LEFT_MM 100    // of it that is left
#define SEEN_DOUBTED_MM 200 // of it, where one is doubted: with less it goes at the speed of a step
#define LEAST_MM_S 30       // no setting is slower
#define LEAST_WAY_MM 10     // of a MOVE, while there is a way
#define SPEED_STEP_MM_S 25  // the speed asked for changes by so much at a time
#define SWING_TURNING_MM 10 // of the margin so much is left in a turn: readings scatter
#define SWING_SPARE_MM 10   // backing away makes so much more room than a turn asks for
#define BACKOFFS_MAX 3
#define FASTEST_MM_S 2000
#define NUDGE_CDEG 2000
#define NUDGE_ROOM_MM 40 // an echo is anywhere in its cone: more than readings scatter
#define NUDGE_PARTS 5
#define ROUNDING_MM 3     // of a place that is turned, where the body is
#define ABEAM_LEAST_MM 97 // beside a way straight back: a P3-DX ends 77 mm beside the faces of those abeam,
#define ABEAM_SLANT \
    2 // ... and a smooth wall that slants in by 25 degrees, half of the way, is heard by no sonar
#define BACK_MOST_MM 300
#define BACK_LEFT_MM 150 // of what the rear reads clear
#define BACK_STEP_MM 25
#define ASTERN_MM 50 // beyond the rear end
#define ASIDE_ROOM_MM 20
#define LEAD_FIRST_MM 1000u

int32_t argus_guard_straight_half_mm(const argus_robot_t *const robot) {
    return argus_robot_half_width_mm(robot) + STRAIGHT_ROOM_MM;
}

bool argus_guard_may_step(const argus_plan_t *const plan) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    return plan->disabled == 0 || plan->complete;
}

bool argus_guard_may_drive(const argus_guard_t *const self, const argus_plan_t *const plan) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    return plan->disabled == 0 || (self->profile->drives_seen && argus_guard_may_step(plan));
}

bool argus_guard_may_translate(const argus_guard_t *const self) {
    ARGUS_ASSERT(self->knowledge->robot != NULL);
    const bool motors = (self->knowledge->flags & ARCOS_FLAG_MOTORS) != 0;
    return self->active && self->linked && motors && self->checked && self->bumpers == 0;
}

// Of which an echo is asked: none where the profile does not ask.
static argus_mask_t asked_of(const argus_guard_t *const self) {
    const argus_knowledge_t *const knowledge = self->knowledge;
    const unsigned used = argus_robot_all(knowledge->robot) & ~(unsigned)argus_out(knowledge);
    const unsigned ahead = used & argus_robot_forward(knowledge->robot);
    return (argus_mask_t)(self->profile->asks_echo ? (ahead != 0 ? ahead : used) : 0u);
}

// The end that leads fails as a whole: any of its sonars tells that it lives, and none that looks astern.
bool argus_guard_has_led(const argus_guard_t *const self) {
    const argus_knowledge_t *const knowledge = self->knowledge;
    const argus_mask_t asked = asked_of(self);
    const unsigned live = argus_robot_leading(knowledge->robot) & ~(unsigned)argus_out(knowledge);
    const uint32_t unheard_mm = argus_unheard_mm(knowledge, (argus_mask_t)live);
    const uint32_t led_mm = knowledge->odometer_mm - self->reverse.odometer_mm;
    const bool first = (knowledge->heard & asked) == 0 && !self->reverse.done;
    return asked != 0 &&
           (unheard_mm < led_mm ? unheard_mm : led_mm) >= (first ? LEAD_FIRST_MM : ARGUS_LEAD_MM);
}

bool argus_guard_is_heard(const argus_guard_t *const self) {
    const argus_mask_t asked = asked_of(self);
    return asked == 0 || ((self->knowledge->heard & asked) != 0 && !argus_guard_has_led(self));
}

bool argus_guard_may_creep(const argus_guard_t *const self) {
    ARGUS_ASSERT(!self->creeps || self->config->creep_mm_s > 0);
    return self->creeps && argus_guard_may_translate(self);
}

// At a step's speed, and never faster than usual.
static int32_t slow_mm_s(const argus_config_t *const config) {
    ARGUS_ASSERT(config->step_speed_mm_s > 0);
    return argus_min(config->step_speed_mm_s, config->speed_mm_s);
}

int32_t argus_guard_unseen_mm_s(const argus_guard_t *const self) {
    ARGUS_ASSERT(self->config->creep_mm_s >= 0);
    const int32_t creep_mm_s = self->config->creep_mm_s;
    const int32_t most_mm_s = slow_mm_s(self->config);
    return creep_mm_s > 0 ? argus_min(creep_mm_s, most_mm_s) : most_mm_s;
}

int32_t argus_guard_touched_mm(const argus_guard_t *const self) {
    const argus_robot_t *const robot = self->knowledge->robot;
    const int32_t before_mm = argus_touches_before_mm(&self->echoes->touches, self->knowledge, 1);
    return before_mm == INT32_MAX ? INT32_MAX : before_mm + robot->front_mm - robot->sonar_face_mm;
}

// What the shortest reading ahead says now, less the way driven since it was taken. A place that was touched
// is as good as a reading.
static int32_t read_mm(const argus_guard_t *const self) {
    const argus_knowledge_t *const knowledge = self->knowledge;
    int32_t shortest = argus_min(knowledge->robot->no_echo_mm, argus_guard_touched_mm(self));
    for (int i = 0; i < knowledge->sonars; i++) {
        if (argus_counts_ahead(knowledge, i) && argus_usable(knowledge, i)) {
            const int32_t since_mm = (int32_t)(knowledge->odometer_mm - knowledge->sonar[i].odometer_mm);
            shortest = argus_min(shortest, argus_reading_ahead_mm(knowledge, i) - since_mm);
        }
    }
    return shortest;
}

static bool is_seen_beside(const argus_guard_t *const self, const int sonar) {
    return sonar >= 0 && argus_trusted(self->knowledge, sonar);
}

argus_mask_t argus_guard_alone(const argus_guard_t *const self) {
    const argus_robot_t *const robot = self->knowledge->robot;
    const unsigned named = argus_named(self->knowledge) & argus_robot_forward(robot);
    unsigned mask = 0;
    for (int i = 0; i < self->knowledge->sonars; i++) {
        const bool seen = is_seen_beside(self, argus_robot_beside(robot, i, true)) ||
                          is_seen_beside(self, argus_robot_beside(robot, i, false));
        mask |= (named >> i & 1u) != 0 && !seen ? 1u << i : 0u;
    }
    return (argus_mask_t)mask;
}

static unsigned blind(const argus_guard_t *const self) {
    const unsigned out = argus_out(self->knowledge) & argus_robot_forward(self->knowledge->robot);
    return out | argus_guard_alone(self);
}

bool argus_guard_is_blind(const argus_guard_t *const self) {
    return blind(self) != 0;
}

int argus_guard_gap(const argus_guard_t *const self) {
    const argus_robot_t *const robot = self->knowledge->robot;
    const unsigned mask = blind(self);
    int longest = 0;
    int run = 0;
    for (int k = 0; k < robot->forward_count; k++) {
        run = (mask >> robot->forward[k] & 1u) != 0 ? run + 1 : 0;
        longest = argus_max(longest, run);
    }
    return longest;
}

static int32_t seen_by_rays_mm(const argus_guard_t *const self) {
    const int32_t half_mm = argus_guard_straight_half_mm(self->knowledge->robot);
    return argus_max(0,
                     argus_rays_seen_mm(self->rays, self->knowledge, half_mm, SEEN_MOST_MM) - SEEN_LEFT_MM);
}

int32_t argus_guard_seen_mm(const argus_guard_t *const self) {
    return self->profile->drives_seen && argus_guard_is_blind(self) ? seen_by_rays_mm(self) : INT32_MAX;
}

int32_t argus_guard_unseen_way_mm(const argus_guard_t *const self) {
    const argus_knowledge_t *const knowledge = self->knowledge;
    ARGUS_ASSERT(self->late_ms >= 0);
    const int32_t speed_mm_s = (knowledge->vel_left_mm_s + knowledge->vel_right_mm_s) / 2;
    return argus_max(0, argus_within(FASTEST_MM_S, speed_mm_s)) * self->late_ms / 1000;
}

// Of a robot that does not keep to SETV the length of a MOVE bounds the speed: it must stand at its end.
static int32_t bounded_mm(const argus_guard_t *const self, const int32_t way_mm) {
    const argus_config_t *const config = self->config;
    const argus_robot_t *const robot = self->knowledge->robot;
    if (self->faster_mm_s == 0) {
        return way_mm;
    }
    const int32_t range_mm = argus_max(argus_min(read_mm(self), INT16_MAX), config->object_range_mm);
    const int32_t safe_mm_s = argus_config_speed_mm_s(config, robot, range_mm, self->late_ms);
    const int32_t decel_mm_s2 = argus_max(config->decel_mm_s2, robot->decel_mm_s2);
    const int32_t most_mm = argus_max(safe_mm_s * safe_mm_s / (2 * decel_mm_s2), LEAST_WAY_MM);
    return self->faster_mm_s > safe_mm_s ? argus_min(way_mm, most_mm) : way_mm;
}

int32_t argus_guard_ahead_mm(const argus_guard_t *const self, const int32_t seen_mm) {
    const int32_t clear_mm = argus_min(argus_max(0, read_mm(self) - self->config->object_range_mm), seen_mm);
    return bounded_mm(self, argus_max(0, clear_mm - argus_guard_unseen_way_mm(self)));
}

// A sonar ahead has the name of a fault.
static bool is_doubted(const argus_guard_t *const self) {
    return (argus_named(self->knowledge) & argus_robot_ahead(self->knowledge->robot)) != 0;
}

// A wall close beside may slant in.
static bool may_hurry(const argus_guard_t *const self) {
    return self->profile->adapts_speed && argus_flank_mm(self->knowledge, 0) > ARGUS_FLANK_NEAR_MM;
}

int32_t argus_guard_heard_mm(const argus_guard_t *const self) {
    const argus_robot_t *const robot = self->knowledge->robot;
    return argus_echoes_ahead_mm(self->echoes, self->knowledge, argus_guard_straight_half_mm(robot)) -
           robot->sonar_face_mm;
}

// Where something is as near as may be: the settings are checked for that, without what the link is late.
static int32_t near_speed_mm_s(const argus_guard_t *const self) {
    const argus_config_t *const config = self->config;
    ARGUS_ASSERT(config->speed_mm_s > 0);
    if (self->late_ms == 0) {
        return config->speed_mm_s;
    }
    const int32_t safe_mm_s =
        argus_config_speed_mm_s(config, self->knowledge->robot, config->object_range_mm, self->late_ms);
    return argus_between(LEAST_MM_S, config->speed_mm_s, safe_mm_s);
}

int32_t argus_guard_free_speed_mm_s(const argus_guard_t *const self, const int32_t seen_mm) {
    const argus_config_t *const config = self->config;
    const int32_t near_mm_s = near_speed_mm_s(self);
    if (!may_hurry(self)) {
        return near_mm_s;
    }
    const int32_t unseen_mm =
        argus_min(argus_min(seen_mm, INT16_MAX) + SEEN_LEFT_MM, argus_guard_heard_mm(self));
    const int32_t range_mm = argus_max(argus_min(read_mm(self), unseen_mm), config->object_range_mm);
    const int32_t safe_mm_s =
        argus_config_speed_mm_s(config, self->knowledge->robot, range_mm, self->late_ms);
    const int32_t most_mm_s =
        argus_min(safe_mm_s / SPEED_STEP_MM_S * SPEED_STEP_MM_S, config->speed_max_mm_s);
    return argus_max(near_mm_s, most_mm_s);
}

// What is doubted is not counted on: as fast as the others have seen.
int32_t argus_guard_speed_mm_s(const argus_guard_t *const self, const int32_t seen_mm) {
    if (!argus_guard_is_heard(self)) {
        return argus_guard_unseen_mm_s(self);
    }
    const bool asks = is_doubted(self) && seen_mm == INT32_MAX && self->profile->drives_seen;
    const int32_t others_mm = asks ? seen_by_rays_mm(self) : seen_mm;
    return asks && others_mm < SEEN_DOUBTED_MM ? slow_mm_s(self->config)
                                               : argus_guard_free_speed_mm_s(self, others_mm);
}

uint32_t argus_guard_two_rounds_ms(const argus_config_t *const config) {
    ARGUS_ASSERT(config->sonar_cycle_ms > 0);
    return 2u * SLOTS * (uint32_t)config->sonar_cycle_ms + ARCOS_TIMING_SIP_CYCLE_MS;
}

bool argus_guard_sees_ahead(const argus_guard_t *const self) {
    const uint32_t limit_ms = argus_guard_two_rounds_ms(self->config);
    for (int i = 0; i < self->knowledge->sonars; i++) {
        const bool forward = argus_robot_faces_forward(self->knowledge->robot, i);
        const bool counts = forward && !argus_is_out(self->knowledge, i);
        if (counts && argus_age_ms(self->knowledge, i, self->now_ms) > limit_ms) {
            return false;
        }
    }
    return true;
}

bool argus_guard_is_home(const argus_guard_t *const self, const int32_t base_cdeg) {
    return argus_angle_abs_diff(self->knowledge->pose.heading_cdeg, base_cdeg) <= HOME_CDEG;
}

static int32_t swing_mm(const argus_guard_t *const self) {
    ARGUS_ASSERT(self->knowledge->robot->swing_radius_mm >= 0);
    const int32_t margin_mm = self->profile->swing_margin_mm;
    return self->knowledge->robot->swing_radius_mm +
           (self->squeezes ? argus_min(margin_mm, SWING_TURNING_MM) : margin_mm);
}

static int32_t remembered_mm(const argus_guard_t *const self, const int32_t back_mm) {
    ARGUS_ASSERT(back_mm >= 0);
    return argus_echoes_nearest_mm(self->echoes, self->knowledge, back_mm);
}

int32_t argus_guard_nearest_mm(const argus_guard_t *const self, const int32_t back_mm) {
    ARGUS_ASSERT(back_mm >= 0);
    const int32_t now_mm = argus_nearest_to_centre_mm(self->knowledge, back_mm);
    return argus_min(now_mm, self->profile->remembers ? remembered_mm(self, back_mm)
                                                      : argus_touches_nearest_mm(&self->echoes->touches,
                                                                                 self->knowledge, back_mm));
}

bool argus_guard_swing_is_blocked(const argus_guard_t *const self) {
    return argus_guard_nearest_mm(self, 0) <= swing_mm(self);
}

bool argus_guard_may_turn(const argus_guard_t *const self) {
    ARGUS_ASSERT(self->profile != NULL && self->echoes != NULL);
    return self->active && self->bumpers == 0 && !argus_guard_swing_is_blocked(self);
}

// The parts of a nudge, as directions of the robot's frame of now.
typedef struct {
    int32_t c[NUDGE_PARTS];
    int32_t s[NUDGE_PARTS];
    uint32_t reach; // of a corner of the body and its room from the centre, squared
} nudge_t;

static nudge_t nudge_of(const argus_robot_t *const robot, const int32_t by_cdeg) {
    const int32_t along_mm = argus_max(robot->front_mm, robot->rear_mm) + NUDGE_ROOM_MM + ROUNDING_MM;
    const int32_t across_mm = argus_robot_half_width_mm(robot) + NUDGE_ROOM_MM + ROUNDING_MM;
    nudge_t nudge = {.reach = argus_square_of(along_mm, across_mm)};
    for (int32_t i = 0; i < NUDGE_PARTS; i++) {
        nudge.c[i] = argus_cos(by_cdeg * (i + 1) / NUDGE_PARTS);
        nudge.s[i] = argus_sin(by_cdeg * (i + 1) / NUDGE_PARTS);
    }
    return nudge;
}

// Turned so far, the body comes too near to a point, which is given in the robot's frame of now.
static bool is_swept(const argus_robot_t *const robot, const argus_point_t at, const nudge_t *const nudge) {
    if (argus_square_of(at.x_mm, at.y_mm) > nudge->reach) {
        return false;
    }
    for (int i = 0; i < NUDGE_PARTS; i++) {
        const int32_t x_mm = (at.x_mm * nudge->c[i] + at.y_mm * nudge->s[i]) / ARGUS_TRIG_ONE;
        const int32_t y_mm = (at.y_mm * nudge->c[i] - at.x_mm * nudge->s[i]) / ARGUS_TRIG_ONE;
        if (x_mm > -robot->rear_mm - NUDGE_ROOM_MM && x_mm < robot->front_mm + NUDGE_ROOM_MM &&
            argus_abs(y_mm) < argus_robot_half_width_mm(robot) + NUDGE_ROOM_MM) {
            return true;
        }
    }
    return false;
}

static bool is_heard_in_nudge(const argus_knowledge_t *const knowledge, const nudge_t *const nudge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        if (argus_usable(knowledge, i) && is_swept(knowledge->robot, argus_echo_robot(knowledge, i), nudge)) {
            return true;
        }
    }
    return false;
}

static bool is_touched_in_nudge(const argus_guard_t *const self, const nudge_t *const nudge) {
    const argus_touches_t *const touches = &self->echoes->touches;
    for (int i = 0; i < touches->count; i++) {
        if (is_swept(self->knowledge->robot, argus_touches_seen(touches, self->knowledge, i), nudge)) {
            return true;
        }
    }
    return false;
}

static bool is_remembered_in_nudge(const argus_guard_t *const self, const nudge_t *const nudge) {
    const argus_view_t from = argus_view(self->knowledge);
    for (int i = 0; i < self->echoes->count; i++) {
        argus_point_t at;
        if (argus_echoes_beside(self->echoes, &from, i, &at) && is_swept(self->knowledge->robot, at, nudge)) {
            return true;
        }
    }
    return false;
}

bool argus_guard_may_nudge(const argus_guard_t *const self, const int32_t by_cdeg) {
    if (!self->profile->nudges || !self->active || self->bumpers != 0 || argus_abs(by_cdeg) > NUDGE_CDEG) {
        return false;
    }
    const nudge_t nudge = nudge_of(self->knowledge->robot, by_cdeg);
    return !is_heard_in_nudge(self->knowledge, &nudge) && !is_remembered_in_nudge(self, &nudge) &&
           !is_touched_in_nudge(self, &nudge);
}

bool argus_guard_echo_blocks(const argus_guard_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->knowledge->sonars);
    return argus_echo_to_centre_mm(self->knowledge, sonar, 0) <= swing_mm(self);
}

int argus_guard_barring(const argus_guard_t *const self) {
    int sonar = self->knowledge->sonars - 1;
    while (sonar >= 0 && !argus_guard_echo_blocks(self, sonar)) {
        sonar--;
    }
    return sonar;
}

bool argus_guard_memory_blocks(const argus_guard_t *const self) {
    return remembered_mm(self, 0) <= swing_mm(self);
}

argus_touch_t argus_guard_touch(const argus_guard_t *const self, const int sonar, argus_point_t *const at,
                                bool *const left) {
    ARGUS_ASSERT(argus_usable(self->knowledge, sonar));
    const int32_t within_mm = self->knowledge->robot->swing_radius_mm + SWING_TURNING_MM;
    const argus_point_t echo = argus_echo_robot(self->knowledge, sonar);
    *at = argus_to_course(&self->knowledge->pose, echo);
    *left = echo.y_mm > 0;
    if (argus_hypot(echo.x_mm, echo.y_mm) > within_mm) {
        return ARGUS_TOUCH_NONE;
    }
    return argus_echoes_have_seen(self->echoes, self->knowledge, *at, within_mm) ? ARGUS_TOUCH_AGAIN
                                                                                 : ARGUS_TOUCH_FIRST;
}

// What has failed, or has the name of a fault, does not read clear: no other looks there in its place.
static bool is_relied_on(const argus_guard_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &self->knowledge->sonar[sonar];
    const bool named = s->health == ARGUS_SUSPECT && s->kind != ARGUS_KIND_NONE;
    return argus_age_ms(self->knowledge, sonar, self->now_ms) <= (uint32_t)self->config->stale_ms && !named &&
           !argus_is_out(self->knowledge, sonar);
}

static bool looks_back(const argus_guard_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_robot_t *const robot = self->knowledge->robot;
    return ((argus_robot_astern(robot) | argus_robot_rear_flank(robot)) >> sonar & 1u) != 0;
}

// A robot of which no sonar looks back never backs away.
bool argus_guard_rear_is_watched(const argus_guard_t *const self) {
    for (int i = 0; i < self->knowledge->sonars; i++) {
        if (looks_back(self, i) && !is_relied_on(self, i)) {
            return false;
        }
    }
    return argus_robot_astern(self->knowledge->robot) != 0;
}

// Those that look abeam see what the robot passes by, not what it backs into.
static int32_t rear_clear_mm(const argus_guard_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(self->config->rear_clear_mm > 0);
    const int32_t clear_mm = self->config->rear_clear_mm;
    const bool flank = (argus_robot_rear_flank(self->knowledge->robot) >> sonar & 1u) != 0;
    return self->profile->passes_abeam && flank
               ? argus_min(ABEAM_LEAST_MM + self->config->backoff_mm / ABEAM_SLANT, clear_mm)
               : clear_mm;
}

static bool is_near_behind(const argus_guard_t *const self, const int sonar) {
    return looks_back(self, sonar) && is_relied_on(self, sonar) &&
           self->knowledge->sonar[sonar].reading_mm <= rear_clear_mm(self, sonar);
}

// One that looks aslant sees the post of a door beside the way back, and a wall along it. An echo is anywhere
// in its cone: at the edge next to the way, it must lie beside the body, or far enough behind it.
static bool is_beside_way(const argus_guard_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_robot_t *const robot = self->knowledge->robot;
    const argus_sonar_pose_t pose = argus_robot_pose(robot, sonar);
    const int32_t edge_cdeg =
        18000 - argus_abs(pose.heading_deg) * 100 - argus_robot_cone_deg(robot, sonar) * 50;
    const bool flank = (argus_robot_rear_flank(robot) >> sonar & 1u) != 0;
    if (!self->profile->passes_abeam || flank || edge_cdeg <= 0) {
        return false;
    }
    const int32_t range_mm = self->knowledge->sonar[sonar].reading_mm;
    const int32_t aside_mm = argus_abs(pose.y_mm) + range_mm * argus_sin(edge_cdeg) / ARGUS_TRIG_ONE;
    const int32_t behind_mm = range_mm * argus_cos(edge_cdeg) / ARGUS_TRIG_ONE - pose.x_mm - robot->rear_mm;
    return aside_mm >= argus_robot_half_width_mm(robot) + ASIDE_ROOM_MM ||
           behind_mm >= self->config->backoff_mm + BACK_LEFT_MM;
}

// What those that look back and are relied on read.
static bool rear_reads_clear(const argus_guard_t *const self) {
    for (int i = 0; i < self->knowledge->sonars; i++) {
        if (is_near_behind(self, i) && !is_beside_way(self, i)) {
            return false;
        }
    }
    return true;
}

static bool is_any_near_behind(const argus_guard_t *const self) {
    bool near = false;
    for (int i = 0; i < self->knowledge->sonars; i++) {
        near = near || is_near_behind(self, i);
    }
    return near;
}

bool argus_guard_rear_is_clear(const argus_guard_t *const self) {
    return argus_guard_rear_is_watched(self) && rear_reads_clear(self);
}

// Where not all that look back are left, a robot that creeps takes the way that it came.
bool argus_guard_may_back(const argus_guard_t *const self) {
    const bool feels = self->creeps && self->knowledge->bumpers_rear == 0;
    const int32_t touched_mm = argus_touches_before_mm(&self->echoes->touches, self->knowledge, -1);
    return rear_reads_clear(self) && touched_mm > self->config->backoff_mm + ASTERN_MM &&
           (feels || argus_guard_rear_is_watched(self));
}

bool argus_guard_may_back_off(const argus_guard_t *const self) {
    return self->active && self->bumpers == 0 && self->backed < BACKOFFS_MAX && argus_guard_may_back(self);
}

static int32_t abeam_mm(const argus_guard_t *const self) {
    int32_t nearest_mm = self->knowledge->robot->no_echo_mm;
    for (int i = 0; i < self->knowledge->sonars; i++) {
        if ((argus_robot_rear_flank(self->knowledge->robot) >> i & 1u) != 0) {
            nearest_mm = argus_min(nearest_mm, self->knowledge->sonar[i].reading_mm);
        }
    }
    return nearest_mm;
}

// What the rear reads clear less some room. Past what was seen beside the way it goes no farther than usual.
// No sonar hears a smooth wall that slants in by 15 to 25 degrees.
static int32_t most_back_mm(const argus_guard_t *const self) {
    const int32_t beside_mm = (abeam_mm(self) - ABEAM_LEAST_MM) * ABEAM_SLANT;
    const int32_t clear_mm =
        argus_min(argus_min(BACK_MOST_MM, beside_mm), self->config->rear_clear_mm - BACK_LEFT_MM);
    const int32_t astern_cdeg = argus_angle_wrap(self->knowledge->pose.heading_cdeg + 18000);
    const int32_t free_mm = argus_echoes_clear_mm(self->echoes, self->knowledge, astern_cdeg,
                                                  argus_guard_straight_half_mm(self->knowledge->robot));
    const bool is_free = free_mm >= self->knowledge->robot->rear_mm + clear_mm + ASTERN_MM;
    const bool again = self->backed > 1; // far once is far enough
    return is_free && !again && !is_any_near_behind(self) ? clear_mm
                                                          : argus_min(clear_mm, self->config->backoff_mm);
}

// The least way back, up to the most, after which a turn is free; where none is, the usual one.
int32_t argus_guard_back_mm(const argus_guard_t *const self) {
    ARGUS_ASSERT(self->config->backoff_mm > 0);
    const int32_t usual_mm = self->config->backoff_mm;
    if (!self->profile->backs_to_turn || self->creeps) {
        return usual_mm;
    }
    const int32_t most_mm = most_back_mm(self);
    for (int32_t way_mm = usual_mm; way_mm <= most_mm; way_mm += BACK_STEP_MM) {
        if (argus_guard_nearest_mm(self, way_mm) > swing_mm(self) + SWING_SPARE_MM) {
            return way_mm;
        }
    }
    return argus_min(usual_mm, most_mm);
}

int32_t argus_guard_back_speed_mm_s(const argus_guard_t *const self) {
    if (self->creeps) {
        return argus_guard_unseen_mm_s(self);
    }
    const argus_config_t *const config = self->config;
    const argus_robot_t *const robot = self->knowledge->robot;
    const bool stops_in_time = argus_config_stop_mm(config, robot, self->late_ms) + robot->rear_overhang_mm <
                               config->object_range_mm;
    return self->profile->backs_to_turn && stops_in_time ? config->speed_mm_s : config->step_speed_mm_s;
}
