// SPDX-License-Identifier: MIT
// Carries out intents, under the guard, and changes the mode (paper: Fig. 2).
#include "supervisor/modes.h"

#include "behaviour/looks.h"
#include "behaviour/mode.h"
#include "behaviour/reflexes.h"
#include "behaviour/resting.h"
#include "behaviour/reverse.h"
#include "behaviour/state.h"
#include "behaviour/travel.h"
#include "knowledge/angle.h"
#include "supervisor/body.h"
#include "supervisor/check.h"
#include "supervisor/faults.h"
#include "supervisor/journey.h"
#include "supervisor/judge.h"
#include "supervisor/motions.h"

#define FOLLOW_MOST 4                       // intents in a row that follow from one
#define MORE_MOST (ARGUS_WAYPOINTS_MAX + 8) // times that a mode has more to do in one SIP

static void enter(argus_t *const self, const argus_mode_t mode) {
    ARGUS_ASSERT(argus_mode_may_follow(self->mode, mode));
    self->mode = mode;
    self->since_ms = self->now_ms;
    if (mode != ARGUS_MODE_WAITING) {
        self->waiting.why = ARGUS_WAIT_NONE;
    }
    if (mode != ARGUS_MODE_VERIFYING) {
        argus_verify_init(&self->verifying.verify);
        argus_inquiry_init(&self->verifying.inquiry);
    }
}

// STOP or E_STOP; under `passive` nothing is sent, and rest waited for. What an operator asked for is not
// taken up again by itself.
static void stop(argus_t *const self, const uint8_t command) {
    ARGUS_ASSERT(command == ARCOS_CMD_STOP || command == ARCOS_CMD_E_STOP);
    argus_journey_jog(&self->travel, 0);
    if (self->orders.passive) {
        argus_motion_hold(&self->motion, self->now_ms);
        return;
    }
    argus_motion_stop(&self->motion, &self->session.outbox, self->now_ms);
    if (command == ARCOS_CMD_E_STOP) {
        argus_outbox_urgent(&self->session.outbox, ARCOS_CMD_E_STOP);
    }
    self->stops++;
    argus_emit(&self->events, ARGUS_EV_STOPPED, argus_built_heading_cdeg(&self->knowledge));
}

// Whatever is under way must not go on beside a check.
static void come_to_rest(argus_t *const self) {
    const argus_motion_t *const motion = &self->motion;
    if (argus_motion_is_under_way(motion) && !motion->failed) {
        stop(self, ARCOS_CMD_STOP);
    } else if (!motion->settled && (motion->kind != ARGUS_MOTION_STOP || motion->failed)) {
        argus_motion_hold(&self->motion, self->now_ms);
    }
}

// Entering a mode ------------------------------------------------------------------------------------------

// At rest on the base heading.
static void enter_checking(argus_t *const self, const argus_intent_t *const intent) {
    ARGUS_ASSERT(intent->act <= ARGUS_DO_REACH);
    ARGUS_ASSERT(self->config.suspect_readings > 0);
    argus_checking_t *const mine = &self->checking;
    const uint8_t rounds = mine->rounds; // of a check under way
    if (self->mode == ARGUS_MODE_CLOSING || self->mode == ARGUS_MODE_CLOSED) {
        return;
    }
    mine->rounds = intent->full || !self->checked ? (uint8_t)self->config.suspect_readings : 1;
    mine->marked = false;
    mine->all_round = intent->all_round || intent->again;
    argus_journey_leave_goal(&self->travel);
    come_to_rest(self);
    enter(self, ARGUS_MODE_CHECKING);
    if (intent->again) {
        self->turning.again = true;
        mine->rounds = (uint8_t)argus_max(rounds, mine->rounds);
        mine->marked = true;
        mine->mark = argus_mark_now(&self->knowledge);
    }
}

static void enter_verifying(argus_t *const self, const argus_mask_t suspects) {
    ARGUS_ASSERT((suspects & ~(unsigned)argus_robot_all(self->knowledge.robot)) == 0);
    ARGUS_ASSERT(!self->orders.passive);
    argus_flag_suspects(self, &self->knowledge, &self->events, suspects);
    argus_algorithm1_reopen(&self->algorithm1, suspects);
    argus_looks_begin(&self->looks, self->travel.arriving);
    if (argus_is_to_halt(self)) {
        stop(self, ARCOS_CMD_STOP);
    }
    if (!self->motion.settled && self->motion.kind != ARGUS_MOTION_STOP) {
        argus_motion_hold(&self->motion, self->now_ms);
    }
    enter(self, ARGUS_MODE_VERIFYING);
}

// Waiting for the same thing again without having driven in between counts on.
static void enter_waiting(argus_t *const self, const argus_wait_t why) {
    ARGUS_ASSERT(why != ARGUS_WAIT_NONE);
    argus_waiting_t *const mine = &self->waiting;
    if (mine->last != why) {
        mine->last = why;
        mine->since_ms = self->now_ms;
        mine->said_s = 0;
        argus_emit(&self->events, why == ARGUS_WAIT_WAY ? ARGUS_EV_NO_WAY : ARGUS_EV_WAITING, 0);
    }
    mine->why = why;
    mine->tried_ms = self->now_ms;
    enter(self, ARGUS_MODE_WAITING);
}

static void enter_travel(argus_t *const self) {
    const argus_guard_t guard = argus_guard(self);
    if (!argus_guard_is_heard(&guard) && argus_looks_unheard(&self->looks)) {
        argus_emit(&self->events, ARGUS_EV_NO_ECHO, argus_guard_unseen_mm_s(&guard));
    }
    ARGUS_ASSERT(self->checked && (guard.creeps || argus_guard_may_step(&self->plan)));
    argus_begin_travel(&self->travel);
    argus_base_drop(&self->base);
    if (guard.creeps) {
        argus_emit(&self->events, ARGUS_EV_CREEPING, argus_guard_unseen_mm_s(&guard));
        enter(self, ARGUS_MODE_CREEPING);
    } else {
        enter(self, argus_guard_may_drive(&guard, &self->plan) ? ARGUS_MODE_DRIVING : ARGUS_MODE_SWEEPING);
    }
}

static void enter_idle(argus_t *const self) {
    argus_base_drop(&self->base);
    self->turning.again = false;
    self->waiting.last = ARGUS_WAIT_NONE;
    enter(self, ARGUS_MODE_IDLE);
}

static void fail_mission(const argus_t *const self, argus_mission_t *const mission,
                         argus_events_t *const events) {
    if (*mission == ARGUS_MISSION_RUNNING) {
        *mission = ARGUS_MISSION_FAILED;
        argus_emit(events, ARGUS_EV_MISSION_FAILED, argus_task_goal_mm(&self->travel.task, &self->knowledge));
    }
}

// No sonar ahead has heard an echo yet, others have: a look lets them.
static void try_ahead(const argus_t *const self, argus_looks_t *const looks, const argus_mask_t sonars,
                      argus_intent_t *const next) {
    ARGUS_ASSERT(sonars != 0 && !looks->tried);
    if (self->mode != ARGUS_MODE_CHECKING) {
        argus_to_check(next, true);
        return;
    }
    argus_looks_tried(looks);
    next->act = ARGUS_DO_VERIFY;
    next->sonars = sonars;
}

// No sonar sees the way: all that could are out, or suspects that no one can judge; or a touch has shown it.
static void stand(argus_t *const self, argus_intent_t *const next) {
    argus_journey_jog(&self->travel, 0);
    argus_to_wait(next, ARGUS_WAIT_ECHO);
    if (!argus_guard_may_step(&self->plan)) {
        fail_mission(self, &self->mission, &self->events);
        argus_to_wait(next, ARGUS_WAIT_CATASTROPHIC);
    }
}

static void set_off(argus_t *const self, argus_intent_t *const next) {
    const argus_guard_t guard = argus_guard(self);
    if (argus_is_unseen(self, &guard) && !guard.creeps) {
        stand(self, next);
    } else if (guard.bumpers != 0) {
        argus_to_wait(next, ARGUS_WAIT_BUMPER);
    } else if (!argus_guard_may_translate(&guard)) {
        argus_to_wait(next, ARGUS_WAIT_MOTORS);
    } else {
        enter_travel(self);
    }
}

static void decide(argus_t *const self, argus_intent_t *const next) {
    ARGUS_ASSERT(self->mode != ARGUS_MODE_CLOSING && self->mode != ARGUS_MODE_CLOSED);
    const bool jogging = self->travel.jog_mm > 0;
    const bool wants = jogging || (self->mission == ARGUS_MISSION_RUNNING && !self->orders.paused);
    if (self->orders.passive || !wants) {
        enter_idle(self);
        return;
    }
    if (argus_should_turn_about(self)) { // also to the end that has been heard
        next->act = ARGUS_DO_TURN_ABOUT;
        return;
    }
    const argus_mask_t unheard = argus_to_try(self);
    if (unheard != 0) {
        try_ahead(self, &self->looks, unheard, next);
    } else {
        set_off(self, next);
    }
}

// Carrying out
// -----------------------------------------------------------------------------------------------

static void turn(argus_t *const self, const int32_t heading_cdeg, argus_intent_t *const next) {
    ARGUS_ASSERT(!self->orders.passive && !self->orders.shutdown);
    if (argus_turn_to(self, &self->motion, &self->bend, &self->session.outbox, heading_cdeg)) {
        argus_waiting_t *const waiting = &self->waiting;
        waiting->last = waiting->last == ARGUS_WAIT_TURN ? ARGUS_WAIT_NONE : waiting->last;
        self->turning.again = false;
        return;
    }
    argus_instead_of_turn(self, next);
    self->turning.again = false;
    if (next->act == ARGUS_DO_BACK) { // far once counts twice
        self->turning.backed = (uint8_t)(self->turning.backed + (next->mm > self->config.backoff_mm ? 2 : 1));
    }
}

static void back(argus_t *const self, const argus_intent_t *const intent) {
    ARGUS_ASSERT(intent->act <= ARGUS_DO_REACH);
    ARGUS_ASSERT(intent->mm > 0 && intent->speed_mm_s > 0);
    const argus_guard_t guard = argus_guard(self);
    if (!guard.active || !argus_guard_may_back(&guard)) {
        return;
    }
    const int32_t most_mm_s = guard.creeps ? argus_guard_unseen_mm_s(&guard) : intent->speed_mm_s;
    if (argus_move(self, &self->motion, &self->session.outbox, -intent->mm,
                   argus_min(intent->speed_mm_s, most_mm_s))) {
        argus_emit(&self->events, ARGUS_EV_BACKING, intent->mm);
        enter(self, ARGUS_MODE_BACKING);
    }
}

// The robot will stand somewhere else: what was tried and verified here does not count there.
static void move_on(const argus_t *const self, argus_algorithm1_t *const algorithm1,
                    argus_turning_t *const turning, argus_waiting_t *const waiting) {
    ARGUS_ASSERT(self->checked);
    // A suspect that the evidence could not clear is covered for like one that is out.
    const bool keeps = argus_rules(self)->evidence != 0;
    const argus_mask_t kept = keeps ? argus_with_health(&self->knowledge, ARGUS_SUSPECT) : 0;
    argus_algorithm1_moved(algorithm1, kept);
    turning->backed = 0;
    turning->again = false;
    waiting->last = ARGUS_WAIT_NONE;
}

static void go_ahead(argus_t *const self, const argus_intent_t *const intent) {
    ARGUS_ASSERT(intent->act <= ARGUS_DO_REACH);
    const argus_guard_t guard = argus_guard(self);
    ARGUS_ASSERT(argus_guard_may_translate(&guard));
    int32_t speed_mm_s = intent->speed_mm_s;
    if (intent->act == ARGUS_DO_STEP) {
        ARGUS_ASSERT(argus_guard_may_step(&self->plan));
        enter(self, ARGUS_MODE_STEPPING);
    } else if (intent->act == ARGUS_DO_CREEP) {
        ARGUS_ASSERT(argus_guard_may_creep(&guard));
        speed_mm_s = argus_guard_unseen_mm_s(&guard);
    } else {
        ARGUS_ASSERT(argus_guard_may_drive(&guard, &self->plan) &&
                     intent->mm <= argus_guard_ahead_mm(&guard, argus_guard_seen_mm(&guard)));
    }
    if (!argus_move(self, &self->motion, &self->session.outbox, intent->mm, speed_mm_s)) {
        argus_motion_hold(&self->motion, self->now_ms);
        return;
    }
    if (intent->moves_on) {
        move_on(self, &self->algorithm1, &self->turning, &self->waiting);
    }
    if (intent->steers) {
        argus_steer(self, &self->bend, &self->session.outbox, intent->cdeg);
    }
}

// The point is remembered, or the rest of the turn would be tried at once.
static void end_turn(const argus_t *const self, argus_echoes_t *const echoes, const argus_point_t at,
                     argus_intent_t *const next) {
    ARGUS_ASSERT(self->motion.kind == ARGUS_MOTION_TURN);
    const argus_guard_t guard = argus_guard(self);
    argus_echoes_touched(echoes, at, self->now_ms);
    argus_to_say(next, ARGUS_EV_TURN_BLOCKED, argus_guard_barring(&guard), argus_guard_nearest_mm(&guard, 0));
    argus_to_check(next, true);
    next->stop = ARGUS_STOP_STOP;
}

static void say_looks(const argus_t *const self, argus_events_t *const events, const argus_mask_t sonars) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    ARGUS_ASSERT(self->mode == ARGUS_MODE_VERIFYING && self->verifying.inquiry.active);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((sonars >> i & 1u) != 0) {
            argus_emit_of(events, ARGUS_EV_SONAR_VERIFYING, i, self->knowledge.sonar[i].reading_mm);
        }
    }
    if (sonars == 0) {
        argus_emit(events, ARGUS_EV_LOOK, 0);
    }
}

static void lose(argus_t *const self, const argus_intent_t *const intent, argus_intent_t *const next) {
    const argus_knowledge_t *const knowledge = &self->knowledge;
    ARGUS_ASSERT((intent->sonars | intent->silent) != 0);
    ARGUS_ASSERT(((intent->sonars | intent->silent) & argus_out(knowledge)) == 0);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((intent->sonars >> i & 1u) != 0) {
            argus_emit_of(&self->events, ARGUS_EV_SONAR_DEAD, i, knowledge->sonar[i].reading_mm);
            argus_disable(self, i, ARGUS_KIND_OFF);
        } else if ((intent->silent >> i & 1u) != 0) {
            const uint32_t age_ms = argus_age_ms(knowledge, i, self->now_ms);
            argus_emit_of(&self->events, ARGUS_EV_SONAR_SILENT, i, (int32_t)(age_ms & 0x7FFFFFFFu));
            argus_disable(self, i, ARGUS_KIND_SILENT);
        }
    }
    const bool stays = self->mode == ARGUS_MODE_WAITING || self->mode == ARGUS_MODE_CLOSING;
    next->act = stays ? ARGUS_DO_NOTHING : ARGUS_DO_CHECK;
}

static void reach(const argus_task_t *const task, argus_mission_t *const mission, argus_slip_t *const slip,
                  argus_knowledge_t *const knowledge, argus_intent_t *const next) {
    ARGUS_ASSERT(*mission == ARGUS_MISSION_RUNNING);
    if (argus_slip_denies(slip, knowledge)) { // the reflex tells it
        argus_knowledge_set_back(knowledge, &slip->first);
        argus_to_check(next, true);
        return;
    }
    *mission = ARGUS_MISSION_REACHED;
    argus_to_say(next, ARGUS_EV_GOAL_REACHED, ARGUS_NO_SONAR, argus_task_goal_mm(task, knowledge));
    next->act = ARGUS_DO_DECIDE;
}

static void stop_as(argus_t *const self, const argus_stop_t how) {
    ARGUS_ASSERT(how <= ARGUS_STOP_E_STOP);
    const bool halts = how == ARGUS_STOP_HALT && argus_is_to_halt(self);
    if (halts || how == ARGUS_STOP_STOP) {
        stop(self, ARCOS_CMD_STOP);
    } else if (how == ARGUS_STOP_E_STOP) {
        stop(self, ARCOS_CMD_E_STOP);
    }
}

static bool met_ahead(const argus_t *const self, const argus_contact_t how) {
    return how == ARGUS_CONTACT_AHEAD || (how == ARGUS_CONTACT_BUMPER && self->knowledge.bumpers_front != 0);
}

static void close_way(const argus_t *const self, argus_echoes_t *const echoes, argus_travel_t *const travel,
                      const argus_intent_t *const intent) {
    ARGUS_ASSERT(intent->act <= ARGUS_DO_REACH);
    ARGUS_ASSERT(intent->way <= ARGUS_WAY_FORGIVE);
    argus_echoes_met(echoes, &self->knowledge, (argus_contact_t)intent->met);
    if (intent->way == ARGUS_WAY_REFUSE) {
        argus_journey_refuse(travel, &self->knowledge, echoes);
    } else if (intent->way == ARGUS_WAY_FORGIVE) {
        argus_grid_fade(&echoes->grid);
    }
}

static void take_base(argus_base_t *const base, const int32_t heading_cdeg, const argus_base_do_t what) {
    ARGUS_ASSERT(what <= ARGUS_BASE_DROP);
    switch (what) {
    case ARGUS_BASE_TAKE:
        argus_base_take(base, heading_cdeg);
        break;
    case ARGUS_BASE_RENEW:
        argus_base_renew(base, heading_cdeg);
        break;
    case ARGUS_BASE_DROP:
        argus_base_drop(base);
        break;
    case ARGUS_BASE_KEEP:
    default:
        break;
    }
}

static void prepare(argus_t *const self, const argus_intent_t *const intent) {
    ARGUS_ASSERT(intent->act <= ARGUS_DO_REACH);
    if (intent->event != 0) {
        argus_emit_of(&self->events, (argus_event_id_t)intent->event, intent->sonar, intent->value);
    }
    stop_as(self, (argus_stop_t)intent->stop);
    close_way(self, &self->echoes, &self->travel, intent);
    if (met_ahead(self, (argus_contact_t)intent->met)) {
        argus_common_touched(&self->common, argus_robot_ahead(self->knowledge.robot));
    }
    self->checked = self->checked && !intent->unchecked;
    take_base(&self->base, self->knowledge.pose.heading_cdeg, (argus_base_do_t)intent->base);
}

static void perform_motion(argus_t *const self, const argus_intent_t *const intent,
                           argus_intent_t *const next) {
    ARGUS_ASSERT(intent->act != ARGUS_DO_NOTHING);
    switch ((argus_act_t)intent->act) { // GCOV_EXCL_BR_LINE: the default, lines tell of the rest
    case ARGUS_DO_HOLD:
        argus_motion_hold(&self->motion, self->now_ms);
        break;
    case ARGUS_DO_BRAKE:
        argus_motion_stop(&self->motion, &self->session.outbox, self->now_ms);
        break;
    case ARGUS_DO_TURN:
        turn(self, intent->cdeg, next);
        break;
    case ARGUS_DO_DRIVE:
    case ARGUS_DO_STEP:
    case ARGUS_DO_CREEP:
        go_ahead(self, intent);
        break;
    case ARGUS_DO_BACK:
        back(self, intent);
        break;
    case ARGUS_DO_ENABLE:
        argus_enable_motors(self, &self->session.outbox);
        break;
    case ARGUS_DO_END_TURN:
        end_turn(self, &self->echoes, intent->at, next);
        break;
    default:   // GCOV_EXCL_LINE: no motion is left
        break; // GCOV_EXCL_LINE
    }
}

static void perform_end(argus_t *const self, const argus_act_t act, argus_intent_t *const next) {
    switch (act) { // GCOV_EXCL_BR_LINE: the default, lines tell of the rest
    case ARGUS_DO_GIVE_UP:
        fail_mission(self, &self->mission, &self->events);
        argus_to_check(next, true);
        break;
    case ARGUS_DO_GO_OFFLINE:
        enter(self, self->orders.shutdown ? ARGUS_MODE_CLOSED : ARGUS_MODE_OFFLINE);
        break;
    case ARGUS_DO_LEAVE:
        enter(self, ARGUS_MODE_CLOSING);
        break;
    case ARGUS_DO_END:
        enter(self, ARGUS_MODE_CLOSED);
        break;
    default:   // GCOV_EXCL_LINE: no change of the mode is left
        break; // GCOV_EXCL_LINE
    }
}

static void perform_change(argus_t *const self, const argus_intent_t *const intent,
                           argus_intent_t *const next) {
    ARGUS_ASSERT(intent->act >= ARGUS_DO_CHECK && intent->act <= ARGUS_DO_END);
    switch ((argus_act_t)intent->act) {
    case ARGUS_DO_CHECK:
        enter_checking(self, intent);
        break;
    case ARGUS_DO_SWEEP:
        enter(self, ARGUS_MODE_SWEEPING);
        break;
    case ARGUS_DO_VERIFY:
        enter_verifying(self, intent->sonars);
        break;
    case ARGUS_DO_WAIT:
        enter_waiting(self, (argus_wait_t)intent->why);
        break;
    case ARGUS_DO_DECIDE:
        decide(self, next);
        break;
    case ARGUS_DO_TURN_ABOUT:
        argus_turn_about(self);
        argus_to_check(next, true);
        break;
    default:
        perform_end(self, (argus_act_t)intent->act, next);
        break;
    }
}

static void perform_judgement(argus_t *const self, const argus_intent_t *const intent,
                              argus_intent_t *const next) {
    ARGUS_ASSERT(intent->act <= ARGUS_DO_REACH);
    switch ((argus_act_t)intent->act) { // GCOV_EXCL_BR_LINE: the default, lines tell of the rest
    case ARGUS_DO_CHECK_BESIDE:
        argus_check_beside(self, next);
        break;
    case ARGUS_DO_CONCLUDE:
        argus_conclude_check(self, next);
        break;
    case ARGUS_DO_VERDICT:
        argus_apply_verdict(self);
        break;
    case ARGUS_DO_LOOK:
        say_looks(self, &self->events, intent->sonars);
        turn(self, intent->cdeg, next);
        break;
    case ARGUS_DO_LOOKED:
        argus_conclude_looks(self);
        argus_to_check(next, false);
        break;
    case ARGUS_DO_LEAVE_OPEN:
        argus_leave_open(&self->knowledge, &self->algorithm1, &self->events, intent->sonars);
        argus_to_check(next, false);
        break;
    case ARGUS_DO_LOSE:
        lose(self, intent, next);
        break;
    case ARGUS_DO_WATCH:
        argus_watch(&self->knowledge, &self->events, intent->sonars);
        break;
    case ARGUS_DO_REACH:
        reach(&self->travel.task, &self->mission, &self->slip, &self->knowledge, next);
        break;
    default:   // GCOV_EXCL_LINE: no judgement is left
        break; // GCOV_EXCL_LINE
    }
}

static void perform(argus_t *const self, const argus_intent_t *const intent, argus_intent_t *const next) {
    ARGUS_ASSERT(intent->act <= ARGUS_DO_REACH);
    if (intent->act <= ARGUS_DO_END_TURN) {
        perform_motion(self, intent, next);
    } else if (intent->act <= ARGUS_DO_END) {
        perform_change(self, intent, next);
    } else {
        perform_judgement(self, intent, next);
    }
}

void argus_do(argus_t *const self, const argus_intent_t *const wanted) {
    argus_intent_t following[2];
    const argus_intent_t *intent = wanted;
    for (int i = 0; i < FOLLOW_MOST; i++) {
        argus_intent_t *const next = &following[i % 2];
        prepare(self, intent);
        if (intent->act == ARGUS_DO_NOTHING) {
            return;
        }
        *next = (argus_intent_t){0};
        perform(self, intent, next);
        intent = next;
    }
    ARGUS_ASSERT(intent->act == ARGUS_DO_NOTHING && intent->event == 0);
}

void argus_stop_and_do(argus_t *const self, const argus_stop_t stop, const argus_act_t act, const bool full) {
    argus_do(self, &(argus_intent_t){.stop = (uint8_t)stop, .act = (uint8_t)act, .full = full});
}

// One SIP --------------------------------------------------------------------------------------------------

void argus_react(argus_t *const self, const argus_alarm_t *const alarm) {
    bool goes_on = argus_mode_may(self->mode, ARGUS_MAY_REACT);
    for (int i = 0; i < ARGUS_REFLEXES && goes_on; i++) {
        argus_intent_t intent = {0};
        argus_reflex((argus_reflex_t)i, self, alarm, &self->reflexes, &intent);
        argus_do(self, &intent);
        goes_on = intent.act == ARGUS_DO_NOTHING || !argus_reflex_is_last((argus_reflex_t)i);
    }
}

void argus_judge_all(argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    if (!argus_rules(self)->evidence) {
        return;
    }
    const bool moves = argus_mode_may(self->mode, ARGUS_MAY_TRANSLATE);
    if (moves && argus_common_strikes(&self->common, argus_robot_forward(self->knowledge.robot))) {
        argus_stop_and_do(self, ARGUS_STOP_HALT, ARGUS_DO_CHECK, true);
    }
    for (int i = 0; i < self->knowledge.sonars && argus_mode_may(self->mode, ARGUS_MAY_JUDGE); i++) {
        argus_intent_t intent = {0};
        argus_judge(self, i, &intent);
        argus_do(self, &intent);
    }
}

// What the present mode wants. In OFFLINE, CLOSING and CLOSED nothing acts.
static void run(argus_t *const self, argus_intent_t *const intent) {
    switch (self->mode) {
    case ARGUS_MODE_CHECKING:
        argus_run_checking(self, &self->checking, intent);
        break;
    case ARGUS_MODE_VERIFYING:
        argus_run_verifying(self, &self->verifying, intent);
        break;
    case ARGUS_MODE_IDLE:
        argus_run_idle(self, intent);
        break;
    case ARGUS_MODE_DRIVING:
        argus_run_driving(self, &self->travel, intent);
        break;
    case ARGUS_MODE_SWEEPING:
        argus_run_sweeping(self, &self->travel, intent);
        break;
    case ARGUS_MODE_STEPPING:
        argus_run_stepping(self, &self->travel, intent);
        break;
    case ARGUS_MODE_CREEPING:
        argus_run_creeping(self, &self->travel, intent);
        break;
    case ARGUS_MODE_BACKING:
        argus_run_backing(self, intent);
        break;
    case ARGUS_MODE_WAITING:
        argus_run_waiting(self, &self->waiting, intent);
        break;
    default:
        break;
    }
}

// It drives, or would if there were room or a way; an operator who has cut the motors is waited for.
static bool is_under_way(const argus_t *const self) {
    const argus_wait_t why = self->waiting.why;
    const bool waits =
        self->mode == ARGUS_MODE_WAITING && (why == ARGUS_WAIT_WAY || why == ARGUS_WAIT_TURN ||
                                             why == ARGUS_WAIT_BUMPER || why == ARGUS_WAIT_ECHO);
    return self->mission == ARGUS_MISSION_RUNNING && !self->orders.paused && !self->orders.passive &&
           (waits || self->mode == ARGUS_MODE_CHECKING || argus_mode_may(self->mode, ARGUS_MAY_TRANSLATE));
}

// A course that cannot begin with this robot fails; the bar has been reported.
static bool is_barred(const argus_t *const self) {
    return self->mission == ARGUS_MISSION_RUNNING && self->orders.bar != ARGUS_BAR_NONE;
}

void argus_run_mode(argus_t *const self) {
    ARGUS_ASSERT(argus_is_open(self)); // a SIP has come, and no mode ends the session
    bool more = true;
    for (int i = 0; i < MORE_MOST && more; i++) { // GCOV_EXCL_BR_LINE: none reaches the bound, see below
        const argus_mode_t mode = self->mode;
        argus_intent_t intent = {0};
        run(self, &intent);
        argus_do(self, &intent);
        more = intent.more && self->mode == mode;
    }
    ARGUS_ASSERT(!more);
    if (is_barred(self)) {
        fail_mission(self, &self->mission, &self->events);
        self->orders.unbegun = true;
    }
}

// Where it stands for a late link that is the reason.
bool argus_is_in_vain(const argus_t *const self, argus_travel_t *const travel, argus_events_t *const events) {
    const bool vain = argus_journey_is_hopeless(travel, &self->knowledge, is_under_way(self));
    if (vain && self->latency.stands) {
        argus_emit(events, ARGUS_EV_LINK_SLOW, argus_roundtrip_ms(&self->latency.trip, self->now_ms));
    } else if (vain) {
        argus_emit(events, ARGUS_EV_NO_WAY, (int32_t)(travel->task.progress.vain_ms / 1000u));
    }
    return vain;
}

static void close_when_at_rest(const argus_t *const self, argus_session_t *const session) {
    ARGUS_ASSERT(self->orders.shutdown);
    const bool rested = argus_at_rest(&self->knowledge) && self->motion.settled;
    const bool overdue = self->now_ms - self->since_ms >= argus_mode_limit_ms(self->mode);
    const bool leaving = session->state == ARGUS_SESSION_LEAVING;
    if (!leaving && (rested || self->orders.passive || overdue)) {
        argus_session_leave(session, self->now_ms);
    }
}

void argus_process_mode(argus_t *const self) {
    if (self->mode == ARGUS_MODE_CLOSING) {
        close_when_at_rest(self, &self->session);
    }
    argus_intent_t intent = {0};
    argus_go_on_waiting(self, &self->waiting, &intent);
    argus_do(self, &intent);
}
