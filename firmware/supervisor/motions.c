// SPDX-License-Identifier: MIT
// Puts commands to the wheels into the outbox, one motion at a time.
#include "supervisor/motions.h"

#include "behaviour/permit.h"
#include "knowledge/angle.h"

bool argus_is_to_halt(const argus_t *const self) {
    return !argus_at_rest(&self->knowledge) || argus_motion_is_under_way(&self->motion);
}

static bool may(const argus_t *const self, const argus_wants_t wants, const int32_t by_cdeg) {
    const argus_ask_t order = {.mover = ARGUS_MOVER_MANAGER, .wants = wants, .by_cdeg = by_cdeg};
    return argus_permit(self, order) == ARGUS_PERMIT_GIVEN;
}

bool argus_turn_to(const argus_t *const self, argus_motion_t *const motion, argus_bend_t *const bend,
                   argus_outbox_t *const out, const int32_t heading_cdeg) {
    if (!may(self, ARGUS_WANTS_TURN, argus_angle_wrap(heading_cdeg - self->knowledge.pose.heading_cdeg))) {
        return false;
    }
    argus_bend_ordered(bend, heading_cdeg, self->now_ms);
    argus_motion_turn(motion, out, &self->knowledge, heading_cdeg, self->now_ms);
    return true;
}

void argus_turn_again(const argus_t *const self, argus_motion_t *const motion, argus_outbox_t *const out) {
    const int32_t by_cdeg = argus_angle_wrap(motion->target_cdeg - self->knowledge.pose.heading_cdeg);
    argus_motion_again(motion, out, &self->knowledge, may(self, ARGUS_WANTS_TURN, by_cdeg), self->now_ms);
}

bool argus_move(const argus_t *const self, argus_motion_t *const motion, argus_outbox_t *const out,
                const int32_t distance_mm, const int32_t speed_mm_s) {
    ARGUS_ASSERT(speed_mm_s > 0 && distance_mm != INT32_MIN);
    if (!may(self, distance_mm < 0 ? ARGUS_WANTS_BACK : ARGUS_WANTS_AHEAD, 0)) {
        return false;
    }
    const argus_session_t *const session = &self->session;
    const int32_t top_mm_s = session->has_robot ? session->robot.vel_max_mm_s : 0; // its own ceiling
    argus_motion_move(motion, out, &self->knowledge, distance_mm,
                      top_mm_s > 0 ? argus_min(speed_mm_s, top_mm_s) : speed_mm_s, self->now_ms);
    return true;
}

// On the way ahead, by little.
void argus_steer(const argus_t *const self, argus_bend_t *const bend, argus_outbox_t *const out,
                 const int32_t heading_cdeg) {
    if (may(self, ARGUS_WANTS_AHEAD, 0)) {
        argus_bend_ordered(bend, heading_cdeg, self->now_ms);
        argus_motion_steer(out, &self->knowledge, heading_cdeg);
    }
}

void argus_enable_motors(const argus_t *const self, argus_outbox_t *const out) {
    if (may(self, ARGUS_WANTS_MOTORS, 0)) {
        argus_outbox_int(out, ARCOS_CMD_ENABLE, 1);
    }
}
