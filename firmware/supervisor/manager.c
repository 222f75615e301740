// SPDX-License-Identifier: MIT
// The health-check loop: bytes to SIPs to knowledge to awareness, then the present mode; and what an operator
// asks.
#include "supervisor/manager.h"

#include <string.h>

#include "knowledge/angle.h"
#include "supervisor/manager_internal.h"

#define AWAY_CDEG 500
#define SHUTDOWN_REST_MS 1500u
#define IDLE_POLL_MS 50u
#define BUSY_POLL_MS 10u

void argus_say(argus_t *const self, const argus_event_id_t id, const int sonar, const int32_t value) {
    const argus_event_t event = {.t_ms = self->now_ms,
                                 .id = (uint16_t)id,
                                 .sonar = (int8_t)sonar,
                                 .state = (uint8_t)self->failure,
                                 .value = value};
    argus_events_push(&self->events, event);
}

void argus_manager_init(argus_t *const self, const argus_config_t *const config, const uint32_t now_ms) {
    memset(self, 0, sizeof *self);
    self->config = *config;
    self->locked = argus_config_check(config).fault != ARGUS_CONFIG_OK;
    self->passive = self->locked || config->active == 0;
    self->now_ms = now_ms;
    argus_session_init(&self->session);
    argus_knowledge_init(&self->knowledge);
    if (argus_robot_chosen(config->robot) != NULL) {
        argus_knowledge_set_robot(&self->knowledge, argus_robot_chosen(config->robot), now_ms);
    }
    argus_awareness_init(&self->awareness);
    argus_verify_init(&self->verify);
    argus_evidence_init(&self->evidence);
    argus_evidence_set_caution(&self->evidence, self->config.caution);
    argus_inquiry_init(&self->inquiry);
    argus_motion_init(&self->motion);
    argus_task_init(&self->task);
    argus_events_init(&self->events);
    argus_enter(self, ARGUS_MODE_OFFLINE);
}

bool argus_set_course(argus_t *const self, const argus_point_t *const points, const uint16_t count) {
    if (!argus_task_set(&self->task, points, count)) {
        return false;
    }
    self->mission = ARGUS_MISSION_RUNNING;
    self->arriving = false;
    argus_say(self, ARGUS_EV_MISSION_START, ARGUS_NO_SONAR, count);
    if (self->mode == ARGUS_MODE_IDLE || self->wait == ARGUS_WAIT_CATASTROPHIC) {
        argus_enter_checking(self, true);
    }
    return true;
}

void argus_link_up(argus_t *const self, const uint32_t now_ms) {
    self->now_ms = now_ms;
    argus_session_link_up(&self->session, now_ms);
    argus_say(self, ARGUS_EV_LINK_UP, ARGUS_NO_SONAR, 0);
}

static void go_offline(argus_t *const self) {
    const uint32_t silence_ms = self->now_ms - self->session.heard_ms;
    self->checked = false;
    self->stalled = false;
    self->has_base = false;
    self->jog_mm = 0;
    argus_motion_init(&self->motion);
    argus_say(self, ARGUS_EV_LINK_LOST, ARGUS_NO_SONAR, (int32_t)(silence_ms & 0x7FFFFFFFu));
    argus_enter(self, self->shutdown ? ARGUS_MODE_CLOSED : ARGUS_MODE_OFFLINE);
}

void argus_link_lost(argus_t *const self, const uint32_t now_ms) {
    self->now_ms = now_ms;
    argus_session_link_down(&self->session);
    go_offline(self);
}

static void enable_motors(argus_t *const self) {
    if (!self->passive && argus_session_is_open(&self->session)) {
        argus_outbox_int(&self->session.outbox, ARCOS_CMD_ENABLE, 1);
    }
}

static void on_open(argus_t *const self) {
    argus_say(self, ARGUS_EV_SESSION_OPEN, ARGUS_NO_SONAR, self->session.attempts);
    argus_meet_body(self);
    enable_motors(self);
    argus_knowledge_reopen(&self->knowledge, self->now_ms);
    argus_awareness_restart(&self->awareness);
    argus_evidence_restart(&self->evidence);
    self->motion.speed_mm_s = self->config.speed_mm_s; // the set-up sent it
    self->motors_said = false;
    self->stalled = false;
    self->has_base = false;
    self->ordered = false;
    if (self->plan.disabled != 0) {
        argus_share_slots(self); // the robot begins each session with its own order
    }
    argus_meet_robot(self);
    argus_enter_checking(self, true);
}

static void on_stall(argus_t *const self) {
    self->stalled = true;
    self->checked = false;
    argus_say(self, ARGUS_EV_LINK_STALLED, ARGUS_NO_SONAR, self->config.link_stall_ms);
    argus_stop(self, ARCOS_CMD_STOP);
    argus_enter_checking(self, true);
}

static void on_resume(argus_t *const self) {
    self->stalled = false;
    argus_say(self, ARGUS_EV_LINK_RESUMED, ARGUS_NO_SONAR, (int32_t)self->session.gap_ms);
    argus_awareness_restart(&self->awareness);
    argus_evidence_restart(&self->evidence);
    argus_enter_checking(self, true);
}

static void on_sip(argus_t *const self) {
    const int32_t unit_um = argus_session_distance_um(&self->session, self->knowledge.robot->dist_conv_um);
    if (!argus_session_is_open(&self->session) || self->mode == ARGUS_MODE_CLOSED) {
        argus_knowledge_odometry(&self->knowledge, &self->session.sip, unit_um);
        return;
    }
    argus_knowledge_sip(&self->knowledge, &self->session.sip, unit_um, self->now_ms);
    self->awareness.away = self->has_base && argus_angle_abs_diff(self->knowledge.pose.heading_cdeg,
                                                                  self->base_cdeg) > AWAY_CDEG;
    const argus_alarm_t alarm = argus_awareness_sip(&self->awareness, &self->knowledge, &self->config);
    if (argus_judges(self)) {
        argus_evidence_sip(&self->evidence, &self->knowledge);
    }
    argus_react(self, &alarm); // it asks what was seen before this SIP
    argus_task_see(&self->task, &self->knowledge, self->now_ms);
    argus_judge(self);
    argus_foretell(self);
    argus_motion_sip(&self->motion, &self->session.outbox, &self->knowledge, self->now_ms);
    argus_run_mode(self);
}

static void handle_link(argus_t *const self, const unsigned bits) {
    if ((bits & ARGUS_SESSION_NO_ANSWER) != 0) {
        argus_say(self, ARGUS_EV_SESSION_NO_ANSWER, ARGUS_NO_SONAR, self->session.attempts);
    }
    if ((bits & ARGUS_SESSION_DID_DISLODGE) != 0) {
        argus_say(self, ARGUS_EV_SESSION_DISLODGED, ARGUS_NO_SONAR, 0);
    }
    if ((bits & ARGUS_SESSION_DID_STALL) != 0) {
        on_stall(self);
    }
    if ((bits & ARGUS_SESSION_DID_LOSE) != 0) {
        go_offline(self);
    }
}

static void handle(argus_t *const self, const unsigned bits) {
    handle_link(self, bits);
    if ((bits & ARGUS_SESSION_DID_OPEN) != 0) {
        on_open(self);
    }
    if ((bits & ARGUS_SESSION_DID_RESUME) != 0) {
        on_resume(self);
    }
    if ((bits & ARGUS_SESSION_GOT_SIP) != 0) {
        on_sip(self);
    }
    if ((bits & ARGUS_SESSION_DID_CLOSE) != 0) {
        argus_say(self, ARGUS_EV_SESSION_CLOSED, ARGUS_NO_SONAR, 0);
        argus_enter(self, ARGUS_MODE_CLOSED);
    }
}

void argus_receive(argus_t *const self, const uint32_t now_ms, const uint8_t *const bytes,
                   const size_t count) {
    self->now_ms = now_ms;
    size_t done = 0;
    for (;;) { // one packet may be complete without taking a byte more
        size_t taken = 0;
        const unsigned bits =
            argus_session_receive(&self->session, &self->config, now_ms, bytes + done, count - done, &taken);
        handle(self, bits);
        done += taken;
        if (bits == 0 && (done >= count || taken == 0)) {
            break;
        }
    }
}

static void process_shutdown(argus_t *const self) {
    const bool rested = argus_at_rest(&self->knowledge) || self->passive;
    const bool overdue = self->now_ms - self->since_ms >= SHUTDOWN_REST_MS;
    const bool leaving = self->session.state == ARGUS_SESSION_LEAVING;
    if (!leaving && ((rested && self->motion.settled) || self->passive || overdue)) {
        argus_session_leave(&self->session, self->now_ms);
    }
}

static void check_invariants(argus_t *const self) {
    const int broken = argus_invariants_broken(self);
    if (broken != 0 && self->invariant_said == 0) {
        self->invariant_said = (uint8_t)broken;
        argus_say(self, ARGUS_EV_INVARIANT, ARGUS_NO_SONAR, broken);
    }
}

uint32_t argus_process(argus_t *const self, const uint32_t now_ms) {
    self->now_ms = now_ms;
    for (;;) {
        const unsigned bits = argus_session_process(&self->session, &self->config, now_ms);
        if (bits == 0) {
            break;
        }
        handle(self, bits);
    }
    if (self->mode == ARGUS_MODE_CLOSING) {
        process_shutdown(self);
    }
    argus_wait_process(self);
    check_invariants(self);
    return self->session.parser.length > 0 || self->session.outbox.length > 0 ? BUSY_POLL_MS : IDLE_POLL_MS;
}

size_t argus_transmit(argus_t *const self, uint8_t *const buffer, const size_t capacity) {
    return argus_session_transmit(&self->session, self->now_ms, buffer, capacity);
}

bool argus_next_event(argus_t *const self, argus_event_t *const event) {
    argus_events_t *const events = &self->events;
    if (argus_events_pop(events, event)) {
        return true;
    }
    if (events->lost == events->lost_said) {
        return false;
    }
    argus_say(self, ARGUS_EV_EVENTS_LOST, ARGUS_NO_SONAR,
              (int32_t)((events->lost - events->lost_said) & 0x7FFFFFFFu));
    events->lost_said = events->lost;
    return argus_events_pop(events, event);
}

static void go_passive(argus_t *const self) {
    argus_stop(self, ARCOS_CMD_STOP);
    self->passive = true;
    self->barred = false;
    argus_say(self, ARGUS_EV_PASSIVE, ARGUS_NO_SONAR, 0);
    if (argus_session_is_open(&self->session)) {
        argus_enter_checking(self, false);
    }
}

static void go_active(argus_t *const self) {
    if (self->locked || argus_say_barred(self)) {
        return;
    }
    self->passive = false;
    self->motors_said = false;
    argus_say(self, ARGUS_EV_ACTIVE, ARGUS_NO_SONAR, 0);
    enable_motors(self);
    if (self->plan.disabled != 0 || self->ordered) { // the plan may have gone while nothing was commanded
        argus_share_slots(self);
    }
    if (argus_session_is_open(&self->session)) {
        argus_enter_checking(self, true);
    }
}

static void pause(argus_t *const self) {
    self->paused = true;
    self->stay = true;
    self->has_base = false;
    self->jog_mm = 0;
    argus_stop(self, ARCOS_CMD_STOP);
    if (argus_session_is_open(&self->session)) {
        argus_enter_checking(self, false);
    }
}

static void resume(argus_t *const self) {
    self->paused = false;
    enable_motors(self);
    argus_task_restart(&self->task);
    if (self->mission == ARGUS_MISSION_FAILED) {
        self->mission = ARGUS_MISSION_RUNNING;
    }
    if (argus_session_is_open(&self->session)) {
        argus_enter_checking(self, true);
    }
}

static void jog(argus_t *const self, const int32_t distance_mm) {
    if (self->mode != ARGUS_MODE_IDLE || !argus_may_translate(self) || distance_mm == 0) {
        return;
    }
    if (argus_open_suspects(self) != 0) { // S6: verified first
        self->jog_mm = argus_max(0, argus_min(distance_mm, self->config.step_mm));
        argus_enter_checking(self, true);
        return;
    }
    if (distance_mm < 0) {
        argus_back_off(self, -argus_max(distance_mm, -self->config.backoff_mm));
        return;
    }
    self->jog_mm = argus_min(distance_mm, self->config.step_mm);
    argus_decide(self);
}

// The check that follows turns to the base heading first.
static void jog_turn(argus_t *const self, const int32_t degrees) {
    if (self->mode == ARGUS_MODE_IDLE && !self->passive) {
        self->base_cdeg = argus_angle_wrap(self->knowledge.pose.heading_cdeg + degrees % 360 * 100);
        self->has_base = true;
        argus_awareness_moved(&self->awareness);
        argus_enter_checking(self, false);
    }
}

static void recheck(argus_t *const self) {
    if (argus_session_is_open(&self->session)) {
        argus_awareness_init(&self->awareness);
        argus_stop(self, ARCOS_CMD_STOP);
        argus_enter_checking(self, true);
    }
}

bool argus_operator(argus_t *const self, const uint32_t now_ms, const argus_op_t op, const int32_t argument) {
    self->now_ms = now_ms;
    if (self->shutdown) {
        return false;
    }
    if (op >= ARGUS_OP_RETEST) {
        return argus_serve(self, op, argument);
    }
    argus_say(self, ARGUS_EV_OPERATOR, ARGUS_NO_SONAR, (int32_t)op);
    self->stay = false;
    switch (op) {
    case ARGUS_OP_STOP:
        pause(self);
        break;
    case ARGUS_OP_GO:
        resume(self);
        break;
    case ARGUS_OP_RECHECK:
        recheck(self);
        break;
    case ARGUS_OP_MOVE:
        jog(self, argument);
        break;
    case ARGUS_OP_TURN:
        jog_turn(self, argument);
        break;
    case ARGUS_OP_PASSIVE:
        go_passive(self);
        break;
    case ARGUS_OP_ACTIVE:
        go_active(self);
        break;
    default:
        break;
    }
    return true;
}

void argus_shutdown(argus_t *const self, const uint32_t now_ms) {
    self->now_ms = now_ms;
    if (self->shutdown) {
        return;
    }
    self->shutdown = true;
    if (!argus_session_is_open(&self->session)) { // one that is only being opened is closed again
        argus_session_leave(&self->session, now_ms);
        const bool leaving = self->session.state == ARGUS_SESSION_LEAVING;
        argus_enter(self, leaving ? ARGUS_MODE_CLOSING : ARGUS_MODE_CLOSED);
        return;
    }
    argus_stop(self, ARCOS_CMD_STOP);
    argus_enter(self, ARGUS_MODE_CLOSING);
}

bool argus_closed(const argus_t *const self) {
    return self->mode == ARGUS_MODE_CLOSED;
}
