// SPDX-License-Identifier: MIT
// Drives: normally, and in failure mode sweep by sweep and step by step.
#include "behaviour/travel.h"

#include "behaviour/looks.h"
#include "behaviour/reverse.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"

#define AIM_CDEG 1000     // a bearing farther off than this is turned to at rest
#define GENTLE_CDEG 4000  // ... a new leg up to here while it drives: what the front sonars see lies there
#define AIMED_CDEG 200    // at rest, near enough
#define STEER_CDEG 200    // while driving, corrected beyond this
#define STEER_LEG_MM 250  // ... and only this far from the leg's end
#define SEEN_LEAST_MM 200 // of the way; with less it stops to look
#define SEEN_AGAIN_MM 500 // ... then wants so much, or sweeps: else it would stop again at once
#define FLANK_MM 130
#define CREEP_MM 150     // of a MOVE: what it still does when the link fails
#define CREEP_LEFT_MM 60 // ... and so much before what was touched
#define MOVE_LEAST_MM 5  // of a MOVE: with less some robots do nothing,
#define MOVE_SLOW_MM 100 // ... and with less some take longer than is waited for
#define MOVE_STANDS_MS 1000u
#define UNHEEDED_MS 3000u // MOVE after MOVE for so long and the robot stands: it does not obey

// The SIP is not used up yet.
static void say(argus_intent_t *const intent, const argus_event_id_t event, const int sonar,
                const int32_t value) {
    argus_to_say(intent, event, sonar, value);
    intent->more = true;
}

void argus_begin_travel(argus_travel_t *const mine) {
    mine->aimed = false;
    mine->stopped_short = false;
    mine->arriving = false;
}

static int32_t bearing(const argus_t *const self, const argus_travel_t *const mine) {
    return mine->jog_mm > 0 ? self->knowledge.pose.heading_cdeg
                            : argus_task_bearing_cdeg(&mine->task, &self->knowledge);
}

static int32_t off_bearing(const argus_t *const self, const argus_travel_t *const mine) {
    return argus_angle_abs_diff(bearing(self, mine), self->knowledge.pose.heading_cdeg);
}

static int32_t left_mm(const argus_t *const self, const argus_travel_t *const mine) {
    ARGUS_ASSERT(mine->jog_mm >= 0);
    return mine->jog_mm > 0 ? mine->jog_mm : argus_task_leg_mm(&mine->task, &self->knowledge);
}

// The goal stays, so S7 is asked once more after a round: a single echo may have said no.
static void settle(const argus_t *const self, argus_intent_t *const intent) {
    const argus_guard_t guard = argus_guard(self);
    const argus_mask_t open = argus_rules(self)->evidence ? argus_to_settle(self) : 0;
    const bool may_turn = argus_guard_may_turn(&guard);
    intent->again = open != 0 && !may_turn && !self->turning.again;
    if (intent->again) {
        argus_to_check(intent, false);
    } else if (open != 0 && may_turn) {
        intent->act = ARGUS_DO_VERIFY;
        intent->sonars = open;
    } else {
        intent->act = ARGUS_DO_REACH;
    }
}

static void arrive(const argus_t *const self, argus_travel_t *const mine, argus_intent_t *const intent) {
    if (!mine->arriving) {
        mine->arriving = true;
        intent->act = ARGUS_DO_BRAKE;
        return;
    }
    if (!self->motion.settled) {
        return;
    }
    const int32_t away_mm = argus_max(self->config.goal_radius_mm, self->config.waypoint_radius_mm);
    if (argus_task_goal_mm(&mine->task, &self->knowledge) > away_mm) {
        mine->arriving = false;
        argus_task_return(&mine->task);
        return;
    }
    settle(self, intent);
}

// Waypoints and the goal. True: `intent` is what the SIP calls for.
static bool makes_progress(const argus_t *const self, argus_travel_t *const mine,
                           argus_intent_t *const intent) {
    int passed = 0;
    const bool arrived = argus_task_progress(&mine->task, &self->knowledge, &self->config, &passed);
    mine->unsaid = (uint16_t)(mine->unsaid + passed);
    if (mine->unsaid > 0) {
        say(intent, ARGUS_EV_WAYPOINT, ARGUS_NO_SONAR, mine->task.next - mine->unsaid + 1);
        mine->unsaid--;
        return true;
    }
    if (arrived) {
        arrive(self, mine, intent);
    }
    return arrived;
}

// What comes before the way: the motors, the course, the health check beside it. True: `intent` is what the
// SIP calls for.
static bool is_called_away(const argus_t *const self, argus_travel_t *const mine,
                           argus_intent_t *const intent) {
    if (mine->jog_mm == 0 && makes_progress(self, mine, intent)) {
        return true;
    }
    if (mine->beside_sip == self->knowledge.sips) {
        return false;
    }
    mine->beside_sip = self->knowledge.sips;
    intent->act = ARGUS_DO_CHECK_BESIDE;
    intent->more = true;
    return true;
}

static void cannot_move(argus_intent_t *const intent) {
    argus_to_check(intent, true);
    intent->stop = ARGUS_STOP_STOP;
}

static void end_leg(const argus_t *const self, argus_travel_t *const mine) {
    if (mine->jog_mm > 0 || !mine->task.has_leg) {
        return;
    }
    const bool missed = mine->aimed && off_bearing(self, mine) > AIM_CDEG;
    argus_task_keep(&mine->task, &self->knowledge, &self->echoes);
    mine->aimed = mine->aimed && !missed;
}

// The MOVE at work was begun before the robot saw what it sees now (S5).
static bool is_too_fast(const argus_t *const self, const argus_guard_t *const guard) {
    const int32_t speed_mm_s = argus_max(self->motion.speed_mm_s, guard->faster_mm_s);
    return self->motion.kind == ARGUS_MOTION_MOVE && !self->motion.settled &&
           speed_mm_s > argus_guard_speed_mm_s(guard, argus_guard_seen_mm(guard));
}

static void halt_to_wait(const argus_wait_t why, argus_intent_t *const intent) {
    intent->stop = ARGUS_STOP_HALT;
    argus_to_wait(intent, why);
}

// Where no sonar looks ahead any more, all that counts was seen in sweeps.
static int32_t reading_of(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= ARGUS_NO_SONAR && sonar < ARGUS_SONARS);
    return sonar < 0 ? self->knowledge.robot->no_echo_mm : argus_reading_ahead_mm(&self->knowledge, sonar);
}

static bool is_barred_ahead(const argus_t *const self, const argus_guard_t *const guard) {
    const int32_t heard_mm = reading_of(self, argus_nearest_ahead(&self->knowledge));
    return argus_min(heard_mm, argus_guard_touched_mm(guard)) <= self->config.object_range_mm;
}

// A leg to drive. False: `intent` is what the SIP calls for.
static bool has_way(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                    argus_intent_t *const intent) {
    if (mine->jog_mm > 0 || mine->task.has_leg) {
        return true;
    }
    const argus_search_news_t news =
        argus_task_choose(&mine->task, &self->knowledge, &self->echoes, is_barred_ahead(self, guard));
    if (news == ARGUS_SEARCH_GOES_ON) {
        intent->act = is_too_fast(self, guard) ? ARGUS_DO_BRAKE : ARGUS_DO_NOTHING; // a MOVE ends by itself
        return false;
    }
    if (news == ARGUS_SEARCH_NO_WAY) {
        halt_to_wait(ARGUS_WAIT_WAY, intent);
        return false;
    }
    mine->aimed = false;
    if (!mine->task.avoiding) {
        return true;
    }
    argus_to_say(intent, ARGUS_EV_AVOIDING, ARGUS_NO_SONAR, bearing(self, mine) / 100);
    return false; // one leg a SIP: the next one sees more
}

// A leg that leads out of a place too narrow to turn in: straight ahead, but for a nudge. Not along a wall so
// near that a slant could not be seen in time. A suspect's reading alone is no wall: it would hold the robot
// for ever where no look can be had.
static bool leads_out(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                      const int32_t by_cdeg) {
    const argus_mask_t doubted = argus_with_health(&self->knowledge, ARGUS_SUSPECT);
    const bool open =
        by_cdeg != 0 ? argus_guard_may_nudge(guard, by_cdeg)
                     : !is_barred_ahead(self, guard) && argus_flank_mm(&self->knowledge, doubted) > FLANK_MM;
    return open && argus_task_escape(&mine->task, &self->knowledge, &self->echoes, by_cdeg);
}

static void turn_to_bearing(const argus_t *const self, const argus_guard_t *const guard,
                            argus_travel_t *const mine, argus_intent_t *const intent) {
    static const int16_t tries_cdeg[] = {2000, 1500, 1000, 500, 0, -500, -1000, -1500, -2000};
    ARGUS_ASSERT(mine->jog_mm == 0); // an operator's step goes where the robot looks
    const int32_t to_cdeg = bearing(self, mine);
    const int32_t now_cdeg = self->knowledge.pose.heading_cdeg;
    const bool left = argus_angle_wrap(to_cdeg - now_cdeg) > 0;
    const bool hemmed = argus_guard_swing_is_blocked(guard) &&
                        !argus_may_be_crosstalk(self, guard); // that is read again first
    for (int i = 0; i < (int)(sizeof tries_cdeg / sizeof tries_cdeg[0]) && hemmed; i++) {
        const int32_t by_cdeg = left ? tries_cdeg[i] : -tries_cdeg[i];
        if (leads_out(self, guard, mine, by_cdeg)) {
            if (by_cdeg != 0) {
                argus_to_turn(intent, argus_angle_wrap(now_cdeg + by_cdeg));
            }
            return;
        }
    }
    argus_to_turn(intent, to_cdeg);
}

// It drives and may turn on the way.
static bool is_gentle(const argus_t *const self, const argus_guard_t *const guard,
                      const argus_travel_t *const mine) {
    return argus_rules(self)->adapts_speed && self->motion.kind == ARGUS_MOTION_MOVE &&
           !self->motion.settled && mine->jog_mm == 0 && off_bearing(self, mine) <= GENTLE_CDEG &&
           left_mm(self, mine) > STEER_LEG_MM && argus_guard_may_turn(guard);
}

// Turns to the leg's bearing at rest. True when the robot looks along it, else `intent` leads there.
static bool is_aimed(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                     argus_intent_t *const intent) {
    mine->aimed = mine->aimed || is_gentle(self, guard, mine);
    if (mine->aimed) {
        return true;
    }
    if (self->motion.failed) {
        argus_turn_failed(self, intent);
        return false;
    }
    if (!argus_at_rest(&self->knowledge) || !self->motion.settled) {
        const bool moves = self->motion.kind == ARGUS_MOTION_MOVE && !self->motion.settled;
        intent->act = moves ? ARGUS_DO_BRAKE : ARGUS_DO_NOTHING;
        return false;
    }
    if (off_bearing(self, mine) > AIMED_CDEG) {
        turn_to_bearing(self, guard, mine, intent);
        return false;
    }
    mine->aimed = argus_all_fresh_since(&self->knowledge, argus_wanted_sonars(self), &self->motion.mark);
    return mine->aimed;
}

// It looks along its way. Else `intent` is what the SIP calls for first.
static bool is_ready(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                     argus_intent_t *const intent) {
    if (is_called_away(self, mine, intent)) {
        return false;
    }
    end_leg(self, mine);
    return has_way(self, guard, mine, intent) && is_aimed(self, guard, mine, intent);
}

// The event, a stop if it moves, and another heading after a full check.
static void blocked(argus_travel_t *const mine, const argus_event_id_t event, const int sonar,
                    const int32_t reading_mm, argus_intent_t *const intent) {
    ARGUS_ASSERT(sonar >= ARGUS_NO_SONAR && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(reading_mm >= 0);
    argus_to_say(intent, event, sonar, reading_mm);
    argus_to_check(intent, true);
    intent->stop = ARGUS_STOP_HALT;
    intent->way = ARGUS_WAY_REFUSE;
    mine->jog_mm = 0;
}

// What was touched before is in the way, nearer than `within_mm`.
static bool is_touched_ahead(const argus_guard_t *const guard, const int32_t within_mm,
                             argus_travel_t *const mine, argus_intent_t *const intent) {
    const int32_t touched_mm = argus_guard_touched_mm(guard);
    if (touched_mm <= within_mm) {
        blocked(mine, ARGUS_EV_OBJECT, ARGUS_NO_SONAR, touched_mm, intent);
    }
    return touched_mm <= within_mm;
}

static bool is_heeded(const argus_t *const self, argus_travel_t *const mine) {
    if (self->knowledge.still_sips == 0 || self->motion.kind != ARGUS_MOTION_MOVE || self->motion.settled) {
        mine->heeded_ms = self->now_ms;
    }
    return self->now_ms - mine->heeded_ms < UNHEEDED_MS;
}

// The way has not been seen far enough: a sweep, at rest.
static void look_ahead(const argus_t *const self, argus_travel_t *const mine, argus_intent_t *const intent) {
    mine->aimed = mine->jog_mm > 0;
    mine->stopped_short = true;
    if (!self->motion.settled) {
        intent->act = self->motion.kind == ARGUS_MOTION_MOVE ? ARGUS_DO_BRAKE : ARGUS_DO_NOTHING;
    } else if (self->plan.disabled == 0) { // names that only a look can settle, and there is no room for it
        argus_to_wait(intent, ARGUS_WAIT_TURN);
    } else {
        intent->act = ARGUS_DO_SWEEP;
    }
}

// A short wheel is countered on each SIP, by less than what S7 calls a nudge.
static bool counters(const argus_t *const self, const argus_guard_t *const guard, const int32_t to_cdeg) {
    const int32_t by_cdeg = argus_angle_wrap(to_cdeg - self->knowledge.pose.heading_cdeg);
    return argus_trim_is_due(&self->wheel, &self->knowledge) &&
           (argus_guard_may_turn(guard) || argus_guard_may_nudge(guard, by_cdeg));
}

// The heading on the way: swung about it, or led against a short wheel, or the bearing when it is off that.
static void steer(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                  argus_intent_t *const intent) {
    const int32_t to_cdeg = bearing(self, mine);
    const int32_t trim_cdeg = argus_angle_wrap(to_cdeg + argus_trim_cdeg(&self->wheel, &self->knowledge));
    intent->steers = argus_guard_may_turn(guard);
    intent->cdeg = to_cdeg;
    if (argus_guard_is_blind(guard) && argus_wanted_sonars(self) != 0) {
        intent->cdeg = argus_weave_cdeg(&mine->weave, argus_guard_gap(guard),
                                        self->knowledge.pose.heading_cdeg, bearing(self, mine));
    } else if (counters(self, guard, trim_cdeg)) {
        intent->cdeg = trim_cdeg;
        intent->steers = true;
    } else {
        intent->steers = intent->steers && off_bearing(self, mine) > STEER_CDEG;
    }
}

// What is wanted is worked out on each SIP; the MOVE at work ends where it should when we say nothing more.
static void move_on(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                    const int32_t free_mm, const int32_t seen_mm, argus_intent_t *const intent) {
    const int32_t way_mm = left_mm(self, mine);
    intent->act = ARGUS_DO_DRIVE;
    intent->mm = argus_min(way_mm - argus_guard_unseen_way_mm(guard), free_mm);
    if (intent->mm <= 0) {
        intent->act = ARGUS_DO_NOTHING; // the MOVE at work leads there
        return;
    }
    intent->speed_mm_s = argus_guard_speed_mm_s(guard, seen_mm);
    intent->moves_on = true;
    if (way_mm > STEER_LEG_MM) {
        steer(self, guard, mine, intent);
    }
}

// At rest before what bars the way, but for so little that the robot makes nothing of it, or makes it for
// ever: it has come as far as it can.
static bool stands_before(const argus_t *const self, const argus_travel_t *const mine, const int32_t free_mm,
                          const bool heeded) {
    const bool stands = self->now_ms - mine->heeded_ms >= MOVE_STANDS_MS;
    return stands && free_mm < (heeded ? MOVE_LEAST_MM : MOVE_SLOW_MM);
}

// It has driven for long without an echo; or the rear has looked, and the front leads on.
static bool changes_ends(const argus_t *const self, const argus_guard_t *const guard,
                         argus_intent_t *const intent) {
    if (argus_guard_has_led(guard) && argus_should_turn_about(self)) {
        argus_to_check(intent, true);
        intent->stop = ARGUS_STOP_HALT;
    } else if (argus_should_hand_back(self) && argus_at_rest(&self->knowledge)) {
        intent->act = ARGUS_DO_TURN_ABOUT;
    }
    return intent->act != ARGUS_DO_NOTHING;
}

static void drive_on(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                     argus_intent_t *const intent) {
    if (changes_ends(self, guard, intent)) {
        return;
    }
    if (!argus_guard_sees_ahead(guard)) {
        return; // the MOVE at work ends by itself
    }
    const int sonar = argus_nearest_ahead(&self->knowledge);
    const int32_t nearest_mm = reading_of(self, sonar);
    if (nearest_mm <= self->config.object_range_mm) {
        blocked(mine, ARGUS_EV_OBJECT, sonar, nearest_mm, intent);
        return;
    }
    if (is_touched_ahead(guard, self->config.object_range_mm, mine, intent)) {
        return;
    }
    const int32_t seen_mm = argus_guard_seen_mm(guard);
    const int32_t wanted_mm = mine->stopped_short ? SEEN_AGAIN_MM : SEEN_LEAST_MM;
    if (seen_mm < argus_min(left_mm(self, mine), wanted_mm)) {
        look_ahead(self, mine, intent);
        return;
    }
    mine->stopped_short = false;
    const int32_t free_mm = argus_guard_ahead_mm(guard, seen_mm);
    const bool heeded = is_heeded(self, mine);
    if (stands_before(self, mine, free_mm, heeded)) {
        blocked(mine, ARGUS_EV_OBJECT, sonar, nearest_mm, intent);
        return;
    }
    if (free_mm == 0) {
        return; // a fresh reading will tell
    }
    if (!heeded) {
        halt_to_wait(ARGUS_WAIT_MOTORS, intent);
        return;
    }
    move_on(self, guard, mine, free_mm, seen_mm, intent);
}

static void step(const argus_t *const self, const int32_t way_mm, argus_intent_t *const intent) {
    intent->act = ARGUS_DO_STEP;
    intent->mm = way_mm;
    intent->speed_mm_s = self->config.step_speed_mm_s;
}

static void end_way(argus_intent_t *const intent) {
    intent->base = ARGUS_BASE_DROP;
    intent->act = ARGUS_DO_DECIDE;
}

// One MOVE, then idle again.
static void jog_on(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                   argus_intent_t *const intent) {
    const int32_t seen_mm = argus_guard_seen_mm(guard);
    const int32_t ahead_mm = argus_guard_ahead_mm(guard, seen_mm);
    if (seen_mm < mine->jog_mm) {
        look_ahead(self, mine, intent);
    } else if (ahead_mm > 0) {
        step(self, argus_min(mine->jog_mm, ahead_mm), intent);
    } else { // no room: the step is over before it began
        mine->jog_mm = 0;
        end_way(intent);
    }
}

void argus_run_driving(const argus_t *const self, argus_travel_t *const mine, argus_intent_t *const intent) {
    ARGUS_ASSERT(mine->unsaid <= ARGUS_WAYPOINTS_MAX);
    const argus_guard_t guard = argus_guard(self);
    if (!argus_guard_may_translate(&guard)) {
        cannot_move(intent);
    } else if (is_ready(self, &guard, mine, intent)) {
        if (mine->jog_mm > 0) {
            jog_on(self, &guard, mine, intent);
        } else {
            drive_on(self, &guard, mine, intent);
        }
    }
}

static void step_ahead(const argus_t *const self, const argus_travel_t *const mine,
                       argus_intent_t *const intent) {
    step(self, argus_min(left_mm(self, mine), self->config.step_mm), intent);
    argus_to_say(intent, ARGUS_EV_STEP, ARGUS_NO_SONAR, intent->mm);
    intent->moves_on = true;
}

// The sweep is done and the robot is back on its heading: the compensating and the direct readings decide.
static void judge_sweep(const argus_t *const self, const argus_guard_t *const guard,
                        argus_travel_t *const mine, argus_intent_t *const intent) {
    const int direct = argus_nearest_ahead(&self->knowledge);
    const int32_t direct_mm = reading_of(self, direct);
    if (!mine->swept) {
        mine->swept = true;
        say(intent, ARGUS_EV_SWEEP, mine->drive.smallest_of, mine->drive.smallest_mm);
        return;
    }
    if (mine->drive.smallest_mm <= self->config.check_range_mm) {
        blocked(mine, ARGUS_EV_OBJECT_CHECKED, mine->drive.smallest_of, mine->drive.smallest_mm, intent);
        return;
    }
    if (direct_mm <= self->config.check_range_mm) {
        blocked(mine, ARGUS_EV_OBJECT, direct, direct_mm, intent);
        return;
    }
    if (is_touched_ahead(guard, self->config.check_range_mm, mine, intent)) {
        return;
    }
    if (argus_guard_seen_mm(guard) >= SEEN_LEAST_MM && argus_rules(self)->drives_seen) {
        end_way(intent);
    } else if (argus_rules(self)->disparity &&
               argus_open_suspects(self) != 0) { // S6: one that an operator wants looked at again
        argus_to_check(intent, false);
    } else {
        step_ahead(self, mine, intent);
    }
}

static void begin_sweep(const argus_t *const self, argus_travel_t *const mine, argus_intent_t *const intent) {
    argus_sweep_begin(&mine->drive, &self->plan, argus_base_cdeg(self));
    mine->swept = false;
    argus_to_turn(intent, argus_sweep_heading_cdeg(&mine->drive, &self->plan));
    intent->base = ARGUS_BASE_TAKE;
}

static void sweep_on(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                     argus_intent_t *const intent) {
    const argus_mark_t *const mark = &self->motion.mark;
    if (self->motion.failed) {
        argus_to_check(intent, true);
    } else if (!self->motion.settled) {
        return;
    } else if (argus_sweep_is_outdated(&mine->drive, &self->plan)) {
        begin_sweep(self, mine, intent);
    } else if (mine->drive.done) {
        if (argus_all_fresh_since(&self->knowledge, argus_wanted_sonars(self), mark)) {
            judge_sweep(self, guard, mine, intent);
        }
    } else if (argus_sweep_step(&mine->drive, &self->plan, &self->knowledge, mark) && !mine->drive.done) {
        argus_to_turn(intent, argus_sweep_heading_cdeg(&mine->drive, &self->plan));
    }
}

void argus_run_sweeping(const argus_t *const self, argus_travel_t *const mine, argus_intent_t *const intent) {
    const argus_guard_t guard = argus_guard(self);
    if (!argus_guard_may_translate(&guard)) {
        cannot_move(intent);
    } else if (self->base.taken) {
        sweep_on(self, &guard, mine, intent);
    } else if (is_ready(self, &guard, mine, intent)) {
        begin_sweep(self, mine, intent);
    }
}

void argus_run_stepping(const argus_t *const self, argus_travel_t *const mine, argus_intent_t *const intent) {
    if (self->motion.settled) {
        mine->jog_mm = 0;
        end_way(intent);
    }
}

// A short MOVE, renewed before it ends; only a bumper tells of what is in the way.
static void creep_on(const argus_t *const self, const argus_guard_t *const guard, argus_travel_t *const mine,
                     argus_intent_t *const intent) {
    const int32_t way_mm = left_mm(self, mine);
    if (!is_heeded(self, mine)) {
        halt_to_wait(ARGUS_WAIT_MOTORS, intent);
        return;
    }
    if (is_touched_ahead(guard, CREEP_MM + CREEP_LEFT_MM, mine, intent)) {
        return;
    }
    intent->act = ARGUS_DO_CREEP;
    intent->mm = mine->jog_mm > 0 ? way_mm : argus_min(way_mm, CREEP_MM);
    intent->steers =
        way_mm > STEER_LEG_MM && off_bearing(self, mine) > STEER_CDEG && argus_guard_may_turn(guard);
    intent->cdeg = bearing(self, mine);
    intent->moves_on = true;
}

void argus_run_creeping(const argus_t *const self, argus_travel_t *const mine, argus_intent_t *const intent) {
    const argus_guard_t guard = argus_guard(self);
    if (!argus_guard_may_creep(&guard)) { // a sonar sees again, too
        cannot_move(intent);
        return;
    }
    if (is_called_away(self, mine, intent)) {
        return;
    }
    if (mine->jog_mm > 0 && mine->aimed && self->motion.settled) { // an operator's step is done
        mine->jog_mm = 0;
        end_way(intent);
        return;
    }
    end_leg(self, mine);
    const bool steps = mine->jog_mm > 0 && !self->motion.settled; // one MOVE, not renewed
    if (has_way(self, &guard, mine, intent) && is_aimed(self, &guard, mine, intent) && !steps) {
        creep_on(self, &guard, mine, intent);
    }
}
