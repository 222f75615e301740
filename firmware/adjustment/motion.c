// SPDX-License-Identifier: MIT
// Commands one motion and watches the SIPs until it has settled.
#include "adjustment/motion.h"

#include <string.h>

#include "knowledge/angle.h"

#define ON_TARGET_CDEG 100
#define SETTLED_SIPS 2
#define START_MS 400 // a motion may take this long to show in the SIPs
#define RETRY_SIPS 5 // at rest off the target for so many SIPs: command it again
#define TRIES_MAX 3
#define SAME_MM 20   // a MOVE that ends so little beyond the one at work ends there, too
#define EARLIER_MM 5 // ... or so little before it: in a narrow place more is too near
#define RENEW_MS 600 // one that goes farther is sent so long before the robot would brake

void argus_motion_init(argus_motion_t *const self) {
    memset(self, 0, sizeof *self);
}

static void begin(argus_motion_t *const self, const argus_motion_kind_t kind, const uint32_t now_ms) {
    ARGUS_ASSERT(kind != ARGUS_MOTION_NONE);
    self->kind = kind;
    self->issued_ms = now_ms;
    self->on_target = 0;
    self->off_target = 0;
    self->tries = 1;
    self->settled = false;
    self->failed = false;
}

// The robot takes headings in whole degrees of its own odometry frame.
static int32_t robot_degrees(const argus_knowledge_t *const knowledge, const int32_t heading_cdeg) {
    const int32_t own = argus_angle_wrap(heading_cdeg - argus_heading_offset_cdeg(knowledge));
    ARGUS_ASSERT(own > -18000 && own <= 18000);
    return (own + (own >= 0 ? 50 : -50)) / 100;
}

void argus_motion_turn(argus_motion_t *const self, argus_outbox_t *const out,
                       const argus_knowledge_t *const knowledge, const int32_t heading_cdeg,
                       const uint32_t now_ms) {
    const int32_t degrees = robot_degrees(knowledge, heading_cdeg);
    begin(self, ARGUS_MOTION_TURN, now_ms);
    self->target_cdeg = argus_angle_wrap(degrees * 100 + argus_heading_offset_cdeg(knowledge));
    argus_outbox_int(out, ARCOS_CMD_HEAD, degrees);
}

void argus_motion_steer(argus_outbox_t *const out, const argus_knowledge_t *const knowledge,
                        const int32_t heading_cdeg) {
    argus_outbox_int(out, ARCOS_CMD_HEAD, robot_degrees(knowledge, heading_cdeg));
}

static int32_t left_mm(const argus_motion_t *const self, const argus_knowledge_t *const knowledge) {
    return (int32_t)(self->end_mm - knowledge->odometer_mm);
}

// The MOVE at work ends there, or goes far enough for now. A MOVE counts from where the robot is when it
// comes, so one that is sent again and comes late ends farther on.
static bool leads_there(const argus_motion_t *const self, const argus_knowledge_t *const knowledge,
                        const int32_t distance_mm) {
    const int32_t has_mm = left_mm(self, knowledge);
    const int32_t beyond_mm = has_mm - distance_mm;
    const int32_t brakes_mm = self->speed_mm_s * self->speed_mm_s / (2 * knowledge->robot->decel_mm_s2);
    const bool goes_on = has_mm > brakes_mm + self->speed_mm_s * RENEW_MS / 1000;
    const bool rolls = self->kind == ARGUS_MOTION_MOVE && !self->settled && knowledge->still_sips == 0;
    return rolls && has_mm > 0 && beyond_mm < EARLIER_MM && (beyond_mm > -SAME_MM || goes_on);
}

static void send_move(argus_motion_t *const self, argus_outbox_t *const out,
                      const argus_knowledge_t *const knowledge, const int32_t distance_mm) {
    const int32_t built_mm = knowledge->robot->reversed ? -distance_mm : distance_mm;
    if (argus_outbox_int(out, ARCOS_CMD_MOVE, built_mm)) {
        self->target_mm = distance_mm;
        self->end_mm = knowledge->odometer_mm + (uint32_t)argus_max(distance_mm, 0);
    }
}

void argus_motion_move(argus_motion_t *const self, argus_outbox_t *const out,
                       const argus_knowledge_t *const knowledge, const int32_t distance_mm,
                       const int32_t speed_mm_s, const uint32_t now_ms) {
    ARGUS_ASSERT(speed_mm_s > 0);
    const bool is_other = self->speed_mm_s != speed_mm_s;
    if (is_other) {
        argus_outbox_int(out, ARCOS_CMD_SETV, speed_mm_s);
        self->speed_mm_s = speed_mm_s;
    }
    if (is_other || !leads_there(self, knowledge, distance_mm)) {
        send_move(self, out, knowledge, distance_mm);
    } else {
        self->target_mm = left_mm(self, knowledge);
    }
    begin(self, ARGUS_MOTION_MOVE, now_ms);
}

void argus_motion_stop(argus_motion_t *const self, argus_outbox_t *const out, const uint32_t now_ms) {
    begin(self, ARGUS_MOTION_STOP, now_ms);
    argus_outbox_urgent(out, ARCOS_CMD_STOP);
}

void argus_motion_hold(argus_motion_t *const self, const uint32_t now_ms) {
    begin(self, ARGUS_MOTION_STOP, now_ms);
}

static bool started(const argus_motion_t *const self, const uint32_t now_ms) {
    return self->kind != ARGUS_MOTION_MOVE || now_ms - self->issued_ms >= START_MS + self->late_ms;
}

static bool on_target(const argus_motion_t *const self, const argus_knowledge_t *const knowledge,
                      const uint32_t now_ms) {
    ARGUS_ASSERT(self->kind != ARGUS_MOTION_NONE);
    if (knowledge->still_sips == 0 || !started(self, now_ms)) {
        return false;
    }
    return self->kind != ARGUS_MOTION_TURN ||
           argus_angle_abs_diff(knowledge->pose.heading_cdeg, self->target_cdeg) <= ON_TARGET_CDEG;
}

void argus_motion_again(argus_motion_t *const self, argus_outbox_t *const out,
                        const argus_knowledge_t *const knowledge, const bool may, const uint32_t now_ms) {
    ARGUS_ASSERT(self->kind == ARGUS_MOTION_TURN && self->tries > 0);
    if (!may || self->tries >= TRIES_MAX) {
        self->failed = true;
        return;
    }
    const uint8_t tries = self->tries;
    argus_motion_turn(self, out, knowledge, self->target_cdeg, now_ms);
    self->tries = (uint8_t)(tries + 1);
}

bool argus_motion_is_under_way(const argus_motion_t *const self) {
    ARGUS_ASSERT(self->kind <= ARGUS_MOTION_STOP);
    return (self->kind == ARGUS_MOTION_TURN || self->kind == ARGUS_MOTION_MOVE) && !self->settled;
}

bool argus_motion_sip(argus_motion_t *const self, const argus_knowledge_t *const knowledge,
                      const uint32_t now_ms) {
    ARGUS_ASSERT(self->tries <= TRIES_MAX && self->on_target <= SETTLED_SIPS);
    if (self->kind == ARGUS_MOTION_NONE || self->settled || self->failed) {
        return false;
    }
    if (on_target(self, knowledge, now_ms)) {
        self->on_target++;
        self->off_target = 0;
        self->settled = self->on_target >= SETTLED_SIPS;
        self->mark = argus_mark_now(knowledge);
        return false;
    }
    self->on_target = 0;
    const bool resting = knowledge->still_sips > 0 && now_ms - self->issued_ms >= START_MS + self->late_ms;
    self->off_target = resting ? (uint8_t)(self->off_target + 1) : 0;
    return self->kind == ARGUS_MOTION_TURN && self->off_target >= RETRY_SIPS;
}
