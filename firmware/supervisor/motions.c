// SPDX-License-Identifier: MIT
// Puts commands to the wheels into the outbox, one motion at a time.
#include "supervisor/motions.h"

#include "knowledge/angle.h"
#include "supervisor/journey.h"
#include "supervisor/permit.h"
#include "supervisor/say.h"

void argus_brake(argus_t *const self) {
    argus_motion_stop(&self->motion, &self->session.outbox, self->now_ms);
}

void argus_hold(argus_t *const self) {
    argus_motion_hold(&self->motion, self->now_ms);
}

void argus_stop(argus_t *const self, const uint8_t command) {
    ARGUS_ASSERT(command == ARCOS_CMD_STOP || command == ARCOS_CMD_E_STOP);
    argus_journey_jog(&self->travel, 0); // what an operator asked for is not taken up again by itself
    if (self->orders.passive) {
        argus_hold(self);
        return;
    }
    argus_brake(self);
    if (command == ARCOS_CMD_E_STOP) {
        argus_outbox_urgent(&self->session.outbox, ARCOS_CMD_E_STOP);
    }
    self->stops++;
    argus_tell(self, ARGUS_EV_STOPPED, argus_built_heading_cdeg(&self->knowledge));
}

static bool is_under_way(const argus_motion_t *const motion) {
    return motion->kind == ARGUS_MOTION_MOVE || motion->kind == ARGUS_MOTION_TURN;
}

// A motion may be on its way though the SIPs do not show it yet.
void argus_halt(argus_t *const self) {
    const bool commanded = is_under_way(&self->motion) && !self->motion.settled;
    if (!argus_at_rest(&self->knowledge) || commanded) {
        argus_stop(self, ARCOS_CMD_STOP);
    }
}

void argus_come_to_rest(argus_t *const self) {
    if (self->motion.settled) {
        return;
    }
    if (is_under_way(&self->motion) && !self->motion.failed) {
        argus_stop(self, ARCOS_CMD_STOP);
    } else if (self->motion.kind != ARGUS_MOTION_STOP || self->motion.failed) {
        argus_hold(self);
    }
}

static bool may(const argus_t *const self, const argus_wants_t wants, const int32_t by_cdeg) {
    const argus_ask_t order = {.mover = ARGUS_MOVER_MANAGER, .wants = wants, .by_cdeg = by_cdeg};
    return argus_permit(self, order) == ARGUS_PERMIT_GIVEN;
}

bool argus_turn_to(argus_t *const self, const int32_t heading_cdeg) {
    if (!may(self, ARGUS_WANTS_TURN, argus_angle_wrap(heading_cdeg - self->knowledge.pose.heading_cdeg))) {
        return false;
    }
    argus_bend_ordered(&self->bend, heading_cdeg, self->now_ms);
    argus_motion_turn(&self->motion, &self->session.outbox, &self->knowledge, heading_cdeg, self->now_ms);
    return true;
}

void argus_turn_again(argus_t *const self) {
    const int32_t by_cdeg = argus_angle_wrap(self->motion.target_cdeg - self->knowledge.pose.heading_cdeg);
    argus_motion_again(&self->motion, &self->session.outbox, &self->knowledge,
                       may(self, ARGUS_WANTS_TURN, by_cdeg), self->now_ms);
}

bool argus_move(argus_t *const self, const int32_t distance_mm, const int32_t speed_mm_s) {
    ARGUS_ASSERT(speed_mm_s > 0 && distance_mm != INT32_MIN);
    if (!may(self, distance_mm < 0 ? ARGUS_WANTS_BACK : ARGUS_WANTS_AHEAD, 0)) {
        return false;
    }
    const argus_session_t *const session = &self->session;
    const int32_t top_mm_s = session->has_robot ? session->robot.vel_max_mm_s : 0; // its own ceiling
    argus_motion_move(&self->motion, &self->session.outbox, &self->knowledge, distance_mm,
                      top_mm_s > 0 ? argus_min(speed_mm_s, top_mm_s) : speed_mm_s, self->now_ms);
    return true;
}

// On the way ahead, by little.
void argus_steer(argus_t *const self, const int32_t heading_cdeg) {
    if (may(self, ARGUS_WANTS_AHEAD, 0)) {
        argus_bend_ordered(&self->bend, heading_cdeg, self->now_ms);
        argus_motion_steer(&self->session.outbox, &self->knowledge, heading_cdeg);
    }
}

void argus_enable_motors(argus_t *const self) {
    if (may(self, ARGUS_WANTS_MOTORS, 0)) {
        argus_outbox_int(&self->session.outbox, ARCOS_CMD_ENABLE, 1);
    }
}
