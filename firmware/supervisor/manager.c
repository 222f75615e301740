// SPDX-License-Identifier: MIT
// The health-check loop: bytes to SIPs to knowledge to awareness, then the present mode; and what an operator
// asks.
#include "supervisor/manager.h"

#include <string.h>

#include "behaviour/looks.h"
#include "behaviour/mode.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"
#include "knowledge/body.h"
#include "knowledge/config.h"
#include "knowledge/observe.h"
#include "supervisor/body.h"
#include "supervisor/faults.h"
#include "supervisor/history.h"
#include "supervisor/journey.h"
#include "supervisor/modes.h"
#include "supervisor/motions.h"
#include "supervisor/orders.h"
#include "supervisor/robot_changed.h"

#define AWAY_CDEG 500
#define IDLE_POLL_MS 50u
#define BUSY_POLL_MS 10u

void argus_manager_init(argus_t *const self, const argus_config_t *const config, const uint32_t now_ms) {
    const argus_robot_t *const chosen = argus_robot_chosen(config->robot);
    memset(self, 0, sizeof *self); // which is how most parts begin
    const argus_robot_t *const robot = chosen != NULL ? chosen : argus_robot_default();
    self->config = *config;
    argus_config_mend(&self->config); // refused below, for good
    self->follows = argus_config_follows(&self->config);
    argus_config_follow(&self->config, self->follows, robot);
    self->rules = argus_profile(&self->config);
    const int32_t fault = argus_config_check(config).fault;
    self->orders.mended = fault == ARGUS_CONFIG_RANGE;
    self->orders.locked = fault != ARGUS_CONFIG_OK;
    self->orders.passive = self->orders.locked || config->active == 0;
    argus_set_now(self, now_ms);
    argus_session_init(&self->session);
    argus_knowledge_init(&self->knowledge);
    argus_body_is(&self->knowledge, robot, now_ms);
    argus_evidence_set_caution(&self->evidence, self->config.caution);
    argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_GO_OFFLINE, false);
}

bool argus_set_course(argus_t *const self, const argus_point_t *const points, const uint16_t count) {
    if (!argus_journey_set(&self->travel, points, count)) {
        return false;
    }
    if (self->mission != ARGUS_MISSION_RUNNING) {
        argus_touches_init(&self->echoes.touches);
    }
    self->mission = ARGUS_MISSION_RUNNING;
    argus_looks_leave(&self->looks);
    argus_emit(&self->events, ARGUS_EV_MISSION_START, count);
    if (self->mode == ARGUS_MODE_IDLE || self->waiting.why == ARGUS_WAIT_CATASTROPHIC) {
        argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_CHECK, true);
    }
    return true;
}

void argus_link_up(argus_t *const self, const uint32_t now_ms) {
    argus_set_now(self, now_ms);
    argus_session_link_up(&self->session, now_ms);
    argus_emit(&self->events, ARGUS_EV_LINK_UP, 0);
}

static void note_order(argus_order_t *const order, const argus_motion_t *const motion) {
    if (argus_motion_is_under_way(motion)) {
        const bool moves = motion->kind == ARGUS_MOTION_MOVE;
        order->under_way = true;
        order->way_mm = (uint16_t)(moves ? argus_abs(motion->target_mm) : 0);
        order->speed_mm_s = (uint16_t)motion->speed_mm_s;
    }
}

// The robot's watchdog waits since it was spoken to last; what is in the outbox it hears yet.
static void note_watchdog(const argus_t *const self, argus_order_t *const order) {
    const argus_session_t *const session = &self->session;
    const uint32_t stated_ms = session->has_robot ? session->robot.watchdog_ms : 0;
    const uint32_t waits_ms = stated_ms > 0 ? stated_ms : ARCOS_TIMING_WATCHDOG_MS;
    const uint32_t quiet_ms = session->outbox.length > 0 ? 0 : self->now_ms - session->spoke_ms;
    order->watchdog_ms = (uint16_t)(quiet_ms < waits_ms ? waits_ms - quiet_ms : 0);
    order->accel_mm_s2 = (uint16_t)self->config.accel_mm_s2;
    order->decel_mm_s2 = (uint16_t)self->config.decel_mm_s2;
}

static void go_offline(argus_t *const self) {
    // None was ever heard: the silence has no beginning.
    const uint32_t silence_ms = self->session.sips > 0 ? self->now_ms - self->session.heard_ms : 0;
    self->checked = false;
    self->stalled = false;
    argus_journey_jog(&self->travel, 0);
    note_order(&self->knowledge.order, &self->motion);
    argus_motion_init(&self->motion);
    argus_emit(&self->events, ARGUS_EV_LINK_LOST, (int32_t)(silence_ms & 0x7FFFFFFFu));
    argus_base_drop(&self->base);
    argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_GO_OFFLINE, false);
}

void argus_link_lost(argus_t *const self, const uint32_t now_ms) {
    argus_set_now(self, now_ms);
    argus_session_link_down(&self->session);
    go_offline(self);
}

// The readings begin anew.
static void restart_evidence(argus_t *const self) {
    argus_algorithm1_restart(&self->algorithm1);
    argus_evidence_restart(&self->evidence);
    argus_extremes_restart(&self->extremes);
    argus_common_init(&self->common);
    argus_slip_restart(&self->slip);
    argus_knowledge_unhear(&self->knowledge);
}

static void on_open(argus_t *const self) {
    ARGUS_ASSERT(argus_is_open(self));
    argus_emit(&self->events, ARGUS_EV_SESSION_OPEN, self->session.attempts);
    argus_pace_init(&self->pace);
    self->motion.speed_mm_s = self->config.speed_mm_s; // the set-up sent it, for the robot before
    argus_latency_open(&self->latency, self->session.has_robot);
    argus_meet_body(self);
    if (!self->orders.passive) {
        argus_enable_motors(self, &self->session.outbox);
    }
    argus_knowledge_reopen(&self->knowledge, self->now_ms);
    self->reverse = (argus_reverse_t){.odometer_mm = self->knowledge.odometer_mm};
    restart_evidence(self);
    argus_rays_forget_all(&self->rays);
    self->reflexes.motors_said = false;
    self->reflexes.touched_unheard = false;
    argus_looks_open(&self->looks);
    self->stalled = false;
    argus_base_drop(&self->base);
    self->firing = (argus_firing_t){0};
    if (self->plan.disabled != 0) {
        argus_share_slots(self, &self->session.outbox,
                          &self->firing); // the robot begins each session with its own order
    }
    argus_meet_robot(self);
    argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_CHECK, true);
}

static void on_stall(argus_t *const self) {
    self->stalled = true;
    self->checked = false;
    argus_emit(&self->events, ARGUS_EV_LINK_STALLED, self->config.link_stall_ms);
    argus_stop_and_do(self, ARGUS_STOP_STOP, ARGUS_DO_CHECK, true);
}

static void on_resume(argus_t *const self) {
    self->stalled = false;
    argus_emit(&self->events, ARGUS_EV_LINK_RESUMED, (int32_t)self->session.gap_ms);
    restart_evidence(self);
    argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_CHECK, true);
}

static void take_slip(argus_slip_t *const slip, argus_knowledge_t *const knowledge) {
    if (argus_slip_sip(slip, knowledge)) {
        argus_knowledge_set_back(knowledge, &slip->first);
    }
}

// Seen at once that SETV got lost, and soon that it is not heeded.
static void take_pace(const argus_t *const self, argus_pace_t *const pace, argus_setup_t *const setup,
                      argus_events_t *const events) {
    const argus_motion_t *const motion = &self->motion;
    const bool drives = motion->kind == ARGUS_MOTION_MOVE && !motion->settled;
    const bool known = pace->seen_mm_s > 0;
    const bool found = argus_pace_sip(pace, &self->knowledge, drives ? motion->speed_mm_s : 0);
    if (pace->sips > 0) {
        argus_setup_doubt(setup, ARGUS_SETUP_SPEED);
    }
    if (found && !known) {
        argus_emit(events, ARGUS_EV_SPEED_EXCEEDED, pace->seen_mm_s);
    }
}

// A second effector by the same layers: awareness sees a way bend, analysis sizes it, adjustment counters it.
static void take_bend(const argus_t *const self, argus_bend_t *const bend, argus_wheel_t *const wheel,
                      argus_events_t *const events) {
    const argus_motion_t *const motion = &self->motion;
    const bool straight = motion->kind == ARGUS_MOTION_MOVE && !motion->settled && motion->target_mm > 0;
    argus_way_turn_t piece;
    if (self->config.diagnosis == 0 || !argus_bend_sip(bend, &self->knowledge, straight, &piece)) {
        return;
    }
    const argus_wheel_news_t news = argus_wheel_judge(wheel, &self->knowledge, &piece);
    if (news != ARGUS_WHEEL_SAME) {
        argus_emit(events, news == ARGUS_WHEEL_NAMED ? ARGUS_EV_WHEEL_SHORT : ARGUS_EV_WHEEL_EVEN,
                   wheel->short_pm);
    }
}

// The sonars that look along a blind bearing, in a sweep.
static argus_mask_t sweep_looks(const argus_t *const self) {
    const bool looks = self->mode == ARGUS_MODE_SWEEPING && self->base.taken && self->motion.settled;
    return looks ? argus_sweep_wants(&self->travel.drive, &self->plan, self->knowledge.robot) : 0;
}

static bool is_on_its_way(const argus_t *const self) {
    return self->mode == ARGUS_MODE_DRIVING || self->mode == ARGUS_MODE_SWEEPING ||
           self->mode == ARGUS_MODE_STEPPING; // while it creeps there is no plan to keep
}

static void take_evidence(argus_t *const self) {
    if (argus_rules(self)->evidence) {
        argus_evidence_sip(&self->evidence, &self->knowledge);
        argus_extremes_sip(&self->extremes, &self->knowledge);
        argus_common_sip(&self->common, &self->evidence, &self->knowledge);
        argus_common_weigh(&self->common, &self->evidence, &self->knowledge);
        const int32_t laser = argus_evidence_laser_news(&self->evidence);
        if (laser != 0) {
            argus_emit(&self->events, ARGUS_EV_LASER_FAULT, laser);
        }
    }
    take_slip(&self->slip, &self->knowledge);
    take_bend(self, &self->bend, &self->wheel, &self->events);
    take_pace(self, &self->pace, &self->session.setup, &self->events);
}

// The check that follows does not begin before the link is prompt.
static void take_lateness(argus_t *const self, const argus_lateness_t news) {
    const bool may = argus_mode_may(self->mode, ARGUS_IN_SESSION) && self->mode != ARGUS_MODE_WAITING;
    if (news == ARGUS_LATE_AS_BEFORE) {
        return;
    }
    ARGUS_ASSERT(news == ARGUS_LATE_STANDS || !self->checked); // no mode runs while it stands
    self->checked = false;
    argus_stop_and_do(self, news == ARGUS_LATE_STANDS ? ARGUS_STOP_STOP : ARGUS_STOP_HALT,
                      may ? ARGUS_DO_CHECK : ARGUS_DO_NOTHING, true);
    if (news == ARGUS_LATE_GOES_ON) {
        restart_evidence(self);
    }
}

// How late the link is, before anything of the SIP is used.
static void take_latency(argus_t *const self) {
    argus_roundtrip_sip(&self->latency.trip, &self->session, &self->config, self->now_ms);
    take_lateness(self, argus_latency_sip(&self->latency, &self->config, &self->events));
    self->motion.late_ms = (uint32_t)self->latency.late_ms;
    self->knowledge.late_ms = (uint32_t)argus_latency_oldest_ms(&self->latency);
}

// Where no mode runs yet, or any more.
static void take_odometry(argus_knowledge_t *const knowledge, const argus_session_t *const session,
                          const int32_t unit_um, const uint32_t now_ms) {
    if (session->origin_due) {
        argus_knowledge_origin_due(knowledge);
    }
    argus_knowledge_odometry(knowledge, &session->sip, unit_um, now_ms);
}

static void on_sip(argus_t *const self) {
    const int32_t unit_um = argus_session_distance_um(&self->session, self->knowledge.robot->dist_conv_um);
    if (!argus_session_is_open(&self->session) || self->mode == ARGUS_MODE_CLOSED) {
        take_odometry(&self->knowledge, &self->session, unit_um, self->now_ms);
        return;
    }
    take_latency(self);
    argus_knowledge_sip(&self->knowledge, &self->session.sip, unit_um, self->now_ms);
    if (argus_sees_through_body(self, &self->orders, &self->events)) {
        argus_stop_and_do(self, ARGUS_STOP_STOP, ARGUS_DO_CHECK, true);
    }
    const int32_t away_cdeg = argus_angle_abs_diff(self->knowledge.pose.heading_cdeg, argus_base_cdeg(self));
    argus_algorithm1_sip(&self->algorithm1, &self->knowledge, away_cdeg > AWAY_CDEG);
    const argus_alarm_t alarm = argus_alarms(&self->knowledge, &self->config);
    if (!self->latency.stands) { // else it is not of now
        take_evidence(self);
    }
    argus_react(self, &alarm); // it asks what was seen before this SIP
    argus_echoes_see(&self->echoes, &self->knowledge, self->now_ms);
    argus_rays_see(&self->rays, &self->knowledge, sweep_looks(self));
    argus_judge_all(self);
    if (!argus_keep_plan(self, &self->plan, &self->events) && is_on_its_way(self)) {
        argus_stop_and_do(self, ARGUS_STOP_HALT, ARGUS_DO_CHECK, false);
    }
    if (argus_latency_is_prompt(&self->latency)) {
        if (argus_motion_sip(&self->motion, &self->knowledge, self->now_ms)) {
            argus_turn_again(self, &self->motion, &self->session.outbox);
        }
        argus_run_mode(self);
    }
    if (argus_is_in_vain(self, &self->travel, &self->events)) { // also while it stands for the link
        argus_stop_and_do(self, ARGUS_STOP_HALT, ARGUS_DO_GIVE_UP, false);
    }
    note_order(&self->knowledge.order, &self->motion);
    note_watchdog(self, &self->knowledge.order);
}

// The first one, the second, the fourth and so on: many are one event.
static void say_copies(argus_events_t *const events, const uint32_t found) {
    if ((found & (found - 1)) == 0) {
        argus_emit(events, ARGUS_EV_SIP_COPIED, (int32_t)(found & 0x7FFFFFFFu));
    }
}

static void handle_link(argus_t *const self, const unsigned bits) {
    if ((bits & ARGUS_SESSION_NO_ANSWER) != 0) {
        argus_emit(&self->events, ARGUS_EV_SESSION_NO_ANSWER, self->session.attempts);
    }
    if ((bits & ARGUS_SESSION_DID_DISLODGE) != 0) {
        argus_emit(&self->events, ARGUS_EV_SESSION_DISLODGED, 0);
    }
    if ((bits & ARGUS_SESSION_GOT_COPY) != 0) {
        say_copies(&self->events, self->session.copies.found);
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
    if ((bits & ARGUS_SESSION_OTHER_ROBOT) != 0) { // first: nothing of the other one's plan is for this robot
        argus_robot_changed(self);
    }
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
        argus_emit(&self->events, ARGUS_EV_SESSION_CLOSED, 0);
        argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_END, false);
    }
}

void argus_receive(argus_t *const self, const uint32_t now_ms, const uint8_t *const bytes,
                   const size_t count) {
    ARGUS_ASSERT(bytes != NULL || count == 0);
    argus_set_now(self, now_ms);
    size_t done = 0;
    for (;;) { // one packet may be complete without taking a byte more
        size_t taken = 0;
        const unsigned bits =
            argus_session_receive(&self->session, &self->config, now_ms, bytes + done, count - done, &taken);
        handle(self, bits);
        done += taken;
        if (bits == 0) {
            break;
        }
    }
    ARGUS_ASSERT(done == count);
}

bool argus_observe(argus_t *const self, const uint32_t now_ms, const argus_observation_t *const observation) {
    argus_set_now(self, now_ms);
    self->orders.passive = true; // there is nobody to drive
    argus_session_t *const session = &self->session;
    argus_sip_of(&session->sip, observation, argus_robot_built(self->knowledge.robot));
    const unsigned bits = argus_session_observe(session, &self->config, now_ms);
    handle(self, bits);
    return bits != 0 && argus_robot_is_known(self->knowledge.robot);
}

// No order is taken for done because it was sent.
static void keep_orders(const argus_t *const self, argus_session_t *const session,
                        argus_firing_t *const firing, argus_events_t *const events) {
    const bool rests = argus_at_rest(&self->knowledge) && !argus_motion_is_under_way(&self->motion);
    unsigned rows = (1u << ARGUS_SETUP_ROWS) - 1 - (1u << ARGUS_SETUP_ZERO);
    if (!rests) {
        rows &= ~(1u << ARGUS_SETUP_TELL); // the answer is long, and SIPs wait behind it
    }
    if (!argus_is_active(self)) {
        argus_setup_drop(&session->setup, ARGUS_SETUP_ENABLE);
        rows = 1u << ARGUS_SETUP_SONAR | 1u << ARGUS_SETUP_STOP | 1u << ARGUS_SETUP_E_STOP;
    }
    const int away = argus_session_resend(session, self->now_ms, rows);
    if (argus_outbox_first(&session->outbox) == ARCOS_CMD_POLLING) {
        firing->ordered_ms = self->now_ms;
    }
    if (away >= 0) {
        argus_emit(events, ARGUS_EV_ORDER_UNANSWERED, away);
    }
}

uint32_t argus_process(argus_t *const self, const uint32_t now_ms) {
    argus_set_now(self, now_ms);
    for (;;) {
        const unsigned bits = argus_session_process(&self->session, &self->config, now_ms);
        if (bits == 0) {
            break;
        }
        handle(self, bits);
    }
    if (argus_is_open(self)) {
        take_lateness(self, argus_latency_process(&self->latency, &self->config, &self->events));
    }
    argus_process_mode(self);
    keep_orders(self, &self->session, &self->firing, &self->events);
    const int broken = argus_invariants_broken(self);
    if (broken != 0 && self->invariant_said == 0) {
        self->invariant_said = (uint8_t)broken;
        argus_emit(&self->events, ARGUS_EV_INVARIANT, broken);
    }
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
    argus_emit(&self->events, ARGUS_EV_EVENTS_LOST,
               (int32_t)((events->lost - events->lost_said) & 0x7FFFFFFFu));
    events->lost_said = events->lost;
    return argus_events_pop(events, event);
}

bool argus_operator(argus_t *const self, const uint32_t now_ms, const argus_op_t op, const int32_t argument) {
    argus_set_now(self, now_ms);
    return argus_obey(self, op, argument);
}

void argus_shutdown(argus_t *const self, const uint32_t now_ms) {
    argus_set_now(self, now_ms);
    if (self->orders.shutdown) {
        return;
    }
    self->orders.shutdown = true;
    if (argus_is_open(self)) {
        argus_stop_and_do(self, ARGUS_STOP_STOP, ARGUS_DO_LEAVE, false);
        return;
    }
    argus_session_leave(&self->session, now_ms); // one that is only being opened is closed again
    const bool leaving = self->session.state == ARGUS_SESSION_LEAVING;
    argus_stop_and_do(self, ARGUS_STOP_NONE, leaving ? ARGUS_DO_LEAVE : ARGUS_DO_END, false);
}

bool argus_closed(const argus_t *const self) {
    return self->mode == ARGUS_MODE_CLOSED;
}
