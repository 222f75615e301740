// SPDX-License-Identifier: MIT
// Sees what calls for a STOP, or for an event, in one SIP.
#include "behaviour/reflexes.h"

#include "adjustment/grazing.h"
#include "behaviour/mode.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"

#define LOST_DEG 30        // what looks farther aside passes by what it loses
#define LOW_BATTERY_DV 115 // where CONFIGpac names none
#define HYSTERESIS_DV 2
#define LEAST_BATTERY_DV 60 // with less no robot would be running,
#define MOST_BATTERY_DV 300 // ... and none charges to more
#define SETTLED_IN_MS 1500u
#define BATTERY_SIPS 5 // one reading of it may be anything
#define STANDS_MM 20   // since a contact: what it touched has moved away, if anything has
#define UNSOUND_MS 60000u
#define UNSOUND_MOST 3
#define HEADING_ALONE_CDEG_MM 10 // it is the heading that leapt where there are more for each mm

// The pose has gone on without it. Again and again, and it is not known where the robot is.
static void distrust(const argus_t *const self, argus_reflexes_t *const mine, const argus_event_id_t event,
                     const int32_t value, argus_intent_t *const intent) {
    const bool again = mine->unsound > 0 && self->now_ms - mine->unsound_ms < UNSOUND_MS;
    mine->unsound = (uint8_t)(again ? argus_min(mine->unsound + 1, UNSOUND_MOST + 1) : 1);
    mine->unsound_ms = self->now_ms;
    if (mine->unsound > UNSOUND_MOST) {
        return; // all is said and done
    }
    const bool lost = mine->unsound == UNSOUND_MOST;
    argus_to_say(intent, lost ? ARGUS_EV_ODOMETRY_LOST : event, ARGUS_NO_SONAR, value);
    intent->stop = ARGUS_STOP_STOP;
    intent->unchecked = true;
    intent->base = ARGUS_BASE_DROP;
    intent->act = lost ? ARGUS_DO_GIVE_UP : ARGUS_DO_CHECK;
    intent->full = true;
}

static void sees_leap(const argus_t *const self, const argus_alarm_t *const alarm,
                      argus_reflexes_t *const mine, argus_intent_t *const intent) {
    const argus_knowledge_t *const knowledge = &self->knowledge;
    const bool news = (int32_t)(knowledge->leaps - mine->leaps) > 0;
    (void)alarm;
    mine->leaps = knowledge->leaps;
    if (!news) {
        return;
    }
    if (knowledge->leaps_unseen != mine->unseen) { // at once: where it went meanwhile is not known
        mine->unseen = knowledge->leaps_unseen;
        mine->unsound = UNSOUND_MOST - 1;
        mine->unsound_ms = self->now_ms;
    }
    const bool position = knowledge->leap_mm * HEADING_ALONE_CDEG_MM >= knowledge->leap_cdeg;
    distrust(self, mine, position ? ARGUS_EV_POSE_LEAP : ARGUS_EV_HEADING_LEAP,
             position ? knowledge->leap_mm : knowledge->leap_cdeg / 100, intent);
}

static void sees_slip(const argus_t *const self, const argus_alarm_t *const alarm,
                      argus_reflexes_t *const mine, argus_intent_t *const intent) {
    const bool news = self->slip.slips != mine->slips;
    (void)alarm;
    mine->slips = self->slip.slips;
    if (news) {
        distrust(self, mine, ARGUS_EV_SLIP, self->slip.slipped_mm, intent);
    }
}

// What is touched is in range of those ahead: if they have never heard anything they do not live.
static void note_touch(const argus_t *const self, argus_reflexes_t *const mine, const bool ahead) {
    const argus_guard_t guard = argus_guard(self);
    mine->touched_unheard = mine->touched_unheard || (ahead && !argus_guard_is_heard(&guard));
}

// Whatever touches it: it stands, and waits for a way free of it.
static void touched(argus_intent_t *const intent, const argus_stop_t stop) {
    intent->stop = (uint8_t)stop;
    intent->way = ARGUS_WAY_REFUSE;
    intent->unchecked = true;
    argus_to_wait(intent, ARGUS_WAIT_BUMPER);
}

// What comes to a robot that stands is no place.
static bool is_struck(const argus_t *const self) {
    return argus_at_rest(&self->knowledge) && !argus_motion_is_under_way(&self->motion);
}

// New contact only: bits already answered are let be until they clear.
static void sees_bumper(const argus_t *const self, const argus_alarm_t *const alarm,
                        argus_reflexes_t *const mine, argus_intent_t *const intent) {
    const argus_knowledge_t *const knowledge = &self->knowledge;
    const uint16_t pressed = argus_built_bumpers(knowledge);
    const bool fresh = (pressed & ~(unsigned)mine->bumpers) != 0;
    const bool cleared = pressed == 0 && mine->bumpers != 0;
    (void)alarm;
    mine->bumpers = pressed;
    if (cleared) {
        const bool stands = !argus_motion_is_under_way(&self->motion) &&
                            knowledge->odometer_mm - mine->bumped_odometer_mm <= STANDS_MM;
        argus_to_say(intent, ARGUS_EV_BUMPER_CLEAR, ARGUS_NO_SONAR, 0);
        intent->met = stands ? ARGUS_CONTACT_GONE : ARGUS_CONTACT_NONE;
    }
    if (!fresh) {
        return;
    }
    mine->bumped_odometer_mm = knowledge->odometer_mm;
    note_touch(self, mine, knowledge->bumpers_front != 0);
    argus_to_say(intent, ARGUS_EV_BUMPER, ARGUS_NO_SONAR, pressed);
    intent->met = is_struck(self) ? ARGUS_CONTACT_NONE : ARGUS_CONTACT_BUMPER;
    touched(intent, ARGUS_STOP_E_STOP);
}

// What it met when its wheels came to a stand; a way that is being broken off leads on until it rests.
static argus_contact_t met_by(const argus_motion_t *const motion) {
    if (motion->kind == ARGUS_MOTION_TURN) {
        return ARGUS_CONTACT_TURN;
    }
    return motion->target_mm >= 0 ? ARGUS_CONTACT_AHEAD : ARGUS_CONTACT_BACK;
}

// What the E_STOP at a bumper leaves is no news: nothing is under way since. Away from it is a motion anew.
static bool explains_stall(const argus_t *const self, const argus_reflexes_t *const mine) {
    return mine->bumpers != 0 && argus_is_active(self) && !argus_motion_is_under_way(&self->motion);
}

static void sees_stall(const argus_t *const self, const argus_alarm_t *const alarm,
                       argus_reflexes_t *const mine, argus_intent_t *const intent) {
    const uint8_t stalls = (uint8_t)argus_built_stalls(&self->knowledge);
    const bool fresh = (stalls & ~(unsigned)mine->stalls) != 0;
    (void)alarm;
    mine->stalls = stalls;
    if (!fresh || explains_stall(self, mine)) {
        return;
    }
    const bool own = mine->bumpers == 0 || argus_motion_is_under_way(&self->motion);
    note_touch(self, mine, self->motion.kind == ARGUS_MOTION_MOVE && self->motion.target_mm > 0);
    argus_to_say(intent, ARGUS_EV_STALL, ARGUS_NO_SONAR, stalls);
    intent->met = (uint8_t)(own ? met_by(&self->motion) : ARGUS_CONTACT_NONE);
    touched(intent, ARGUS_STOP_STOP);
}

// The others (0, 7, the rear array) are not judged, but one that yields nothing any more must not be relied
// on.
static void sees_others(const argus_t *const self, const argus_alarm_t *const alarm,
                        argus_reflexes_t *const mine, argus_intent_t *const intent) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    unsigned changed = 0;
    (void)alarm;
    (void)mine;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const argus_health_t health = self->knowledge.sonar[i].health;
        const bool other = (argus_robot_forward(self->knowledge.robot) >> i & 1u) == 0;
        const bool silent = argus_silent_ms(&self->knowledge, i) > (uint32_t)self->config.stale_ms;
        const bool news = (health == ARGUS_HEALTHY && silent) || (health == ARGUS_STALE && !silent);
        changed |= other && news ? 1u << i : 0u;
    }
    const bool counts = argus_rules(self)->disparity && changed != 0;
    intent->act = counts ? ARGUS_DO_WATCH : ARGUS_DO_NOTHING;
    intent->sonars = (argus_mask_t)changed;
}

// SIPs in a row, counted up to one more than the one that says it.
static uint8_t in_a_row(const uint8_t before, const bool more) {
    return (uint8_t)(more ? argus_min(before + 1, BATTERY_SIPS + 1) : 0);
}

static bool is_voltage(const int32_t now_dv) {
    return now_dv >= LEAST_BATTERY_DV && now_dv <= MOST_BATTERY_DV;
}

static void sees_battery(const argus_t *const self, const argus_alarm_t *const alarm,
                         argus_reflexes_t *const mine, argus_intent_t *const intent) {
    const argus_session_t *const session = &self->session;
    const int32_t stated_dv = session->has_robot ? session->robot.low_battery_dv : 0;
    const int32_t low_dv = stated_dv > 0 ? stated_dv : LOW_BATTERY_DV;
    const int32_t now_dv = self->knowledge.battery_dv;
    const bool said = mine->battery_said;
    (void)alarm;
    mine->battery_odd = in_a_row(mine->battery_odd, !is_voltage(now_dv));
    if (mine->battery_odd == BATTERY_SIPS) {
        argus_to_say(intent, ARGUS_EV_BATTERY_ODD, ARGUS_NO_SONAR, now_dv);
        return;
    }
    mine->battery_low = in_a_row(mine->battery_low, is_voltage(now_dv) && now_dv <= low_dv);
    const bool holds = mine->battery_low >= BATTERY_SIPS;
    mine->battery_said = holds || (said && now_dv <= low_dv + HYSTERESIS_DV);
    if (holds && !said) {
        argus_to_say(intent, ARGUS_EV_BATTERY_LOW, ARGUS_NO_SONAR, now_dv);
    }
}

// The motors may be cut by the robot's own button or E-stop at any time; a bumper's own stop is answered
// elsewhere.
static void sees_motors(const argus_t *const self, const argus_alarm_t *const alarm,
                        argus_reflexes_t *const mine, argus_intent_t *const intent) {
    const bool off = (self->knowledge.flags & ARCOS_FLAG_MOTORS) == 0;
    const bool settled_in = self->now_ms - self->knowledge.online_ms > SETTLED_IN_MS &&
                            self->now_ms - mine->active_ms > SETTLED_IN_MS;
    const bool busy = self->waiting.why == ARGUS_WAIT_BUMPER;
    (void)alarm;
    if (!argus_is_active(self) || busy || off == mine->motors_said || (off && !settled_in)) {
        return;
    }
    mine->motors_said = off;
    argus_to_say(intent, off ? ARGUS_EV_MOTORS_OFF : ARGUS_EV_MOTORS_ON, ARGUS_NO_SONAR,
                 self->knowledge.flags);
    intent->stop = ARGUS_STOP_STOP;
    intent->unchecked = true;
    intent->act = off ? ARGUS_DO_WAIT : ARGUS_DO_CHECK;
    intent->why = ARGUS_WAIT_MOTORS;
    intent->full = true;
}

static void sees_dead(const argus_t *const self, const argus_alarm_t *const alarm,
                      argus_reflexes_t *const mine, argus_intent_t *const intent) {
    ARGUS_ASSERT((alarm->dead & alarm->silent & argus_out(&self->knowledge)) == 0);
    (void)self;
    (void)mine;
    if ((alarm->dead | alarm->silent) == 0) {
        return;
    }
    intent->stop = ARGUS_STOP_STOP;
    intent->act = ARGUS_DO_LOSE;
    intent->sonars = alarm->dead;
    intent->silent = alarm->silent;
}

static void stop_before(argus_intent_t *const intent, const int sonar, const int32_t at_mm) {
    argus_to_say(intent, ARGUS_EV_OBJECT, sonar, at_mm);
    intent->stop = ARGUS_STOP_STOP;
    intent->way = ARGUS_WAY_REFUSE;
    argus_to_check(intent, true);
}

// An object is looked at again at rest, with Algorithm 1, before it is believed: a sonar that lies low is
// found there.
static void sees_object(const argus_t *const self, const argus_alarm_t *const alarm,
                        argus_reflexes_t *const mine, argus_intent_t *const intent) {
    ARGUS_ASSERT(alarm->object == 0 || alarm->object_sonar >= 0);
    const bool backing = self->mode == ARGUS_MODE_BACKING;
    (void)mine;
    if (alarm->object == 0 || !argus_mode_may(self->mode, ARGUS_MAY_TRANSLATE) ||
        self->motion.kind == ARGUS_MOTION_STOP) {
        return;
    }
    stop_before(intent, alarm->object_sonar, alarm->object_mm);
    intent->way = backing ? ARGUS_WAY_KEEP : ARGUS_WAY_REFUSE;
}

// True: for the second time. One echo within the swing circle may be crosstalk, the second one of the same
// place is not.
static bool note_near(const argus_t *const self, argus_reflexes_t *const mine, const int sonar,
                      argus_point_t *const at) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(argus_rules(self)->watches_turn);
    const argus_guard_t guard = argus_guard(self);
    bool left = false;
    const argus_touch_t touch = argus_guard_touch(&guard, sonar, at, &left);
    if (touch == ARGUS_TOUCH_NONE) {
        return false;
    }
    argus_near_t *const near = &mine->near[left ? 1 : 0]; // in a passage both sides show
    const bool here = near->valid && self->now_ms - near->t_ms <= argus_guard_two_rounds_ms(&self->config) &&
                      argus_are_one_thing(*at, near->at);
    *near = (argus_near_t){*at, self->now_ms, true};
    return here || touch == ARGUS_TOUCH_AGAIN;
}

// S7 holds through the turn: what comes into view within the swing circle ends it.
static void sees_swing(const argus_t *const self, const argus_alarm_t *const alarm,
                       argus_reflexes_t *const mine, argus_intent_t *const intent) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    const bool turning = self->motion.kind == ARGUS_MOTION_TURN && !self->motion.settled;
    const argus_guard_t guard = argus_guard(self);
    const int32_t left_cdeg = argus_angle_wrap(self->motion.target_cdeg - self->knowledge.pose.heading_cdeg);
    argus_point_t at = {0, 0};
    (void)alarm;
    if (!argus_rules(self)->watches_turn || !turning) {
        mine->near[0].valid = mine->near[1].valid = false;
        return;
    }
    if (self->knowledge.fresh == 0 || argus_guard_may_nudge(&guard, left_cdeg)) {
        return;
    }
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const bool fresh = (self->knowledge.fresh >> i & 1u) != 0 && argus_usable(&self->knowledge, i);
        if (fresh && note_near(self, mine, i, &at)) {
            intent->act = ARGUS_DO_END_TURN;
            intent->at = at;
            return;
        }
    }
}

// A smooth wall that the robot slants into is heard by the sonar that looks abeam alone.
static bool is_slanting_in(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_robot_t *const robot = self->knowledge.robot;
    return (argus_robot_flank(robot) >> sonar & 1u) != 0 &&
           argus_grazing_wall(&self->evidence.pings[sonar], robot, sonar,
                              argus_config_stop_mm(&self->config, robot, self->latency.late_ms));
}

// ... or by those ahead for a moment, and not again. One that hears something farther off denies it.
static bool is_silent_ahead(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_robot_t *const robot = self->knowledge.robot;
    return argus_abs(argus_robot_pose(robot, sonar).heading_deg) <= LOST_DEG &&
           argus_trusted(&self->knowledge, sonar) &&
           self->knowledge.sonar[sonar].reading_mm >= robot->no_echo_mm;
}

// `heard`: something was heard in the way a moment ago.
static bool tells_of_wall(const argus_t *const self, const int sonar, const bool heard) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return is_slanting_in(self, sonar) || (heard && is_silent_ahead(self, sonar));
}

static void sees_flank(const argus_t *const self, const argus_alarm_t *const alarm,
                       argus_reflexes_t *const mine, argus_intent_t *const intent) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    const bool ahead = argus_mode_may(self->mode, ARGUS_MAY_TRANSLATE) && self->mode != ARGUS_MODE_BACKING;
    (void)alarm;
    (void)mine;
    if (!argus_rules(self)->watches_flank || !ahead || self->motion.kind != ARGUS_MOTION_MOVE ||
        self->motion.settled) {
        return;
    }
    const argus_guard_t guard = argus_guard(self);
    const bool heard = argus_guard_heard_mm(&guard) <= self->config.object_range_mm;
    const unsigned usable = self->knowledge.fresh & ~(unsigned)argus_out(&self->knowledge);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((usable >> i & 1u) != 0 && tells_of_wall(self, i, heard)) {
            const int32_t at_mm = self->knowledge.sonar[i].reading_mm;
            stop_before(intent, i, argus_min(at_mm, self->config.object_range_mm));
            return;
        }
    }
}

void argus_reflex(const argus_reflex_t reflex, const argus_t *const self, const argus_alarm_t *const alarm,
                  argus_reflexes_t *const mine, argus_intent_t *const intent) {
    switch (reflex) { // GCOV_EXCL_BR_LINE: the default, lines tell of the rest
#define SEES(name, last, meaning)               \
    case ARGUS_REFLEX_##name:                   \
        sees_##name(self, alarm, mine, intent); \
        break;
        ARGUS_REFLEX_TABLE(SEES)
#undef SEES
    case ARGUS_REFLEXES: // GCOV_EXCL_LINE: it counts them
    default:             // GCOV_EXCL_LINE
        break;           // GCOV_EXCL_LINE
    }
}

bool argus_reflex_is_last(const argus_reflex_t reflex) {
    static const uint8_t last_of[] = {
#define LAST(name, last, meaning) (last),
        ARGUS_REFLEX_TABLE(LAST)
#undef LAST
    };
    ARGUS_ASSERT(reflex < ARGUS_REFLEXES);
    return last_of[reflex] != 0;
}
