// SPDX-License-Identifier: MIT
// What must happen in the SIP that shows it (S2), and the motions and judgements that all modes share.
#include "knowledge/angle.h"
#include "supervisor/manager_internal.h"

#define SWING_MM (self->knowledge.robot->swing_radius_mm)
#define SWING_MARGIN_MM 20  // an echo is taken to lie on the axis of its sonar
#define SWING_TURNING_MM 10 // ... of which that much is left in a turn: readings scatter
#define SWING_SPARE_MM 10   // backing away makes so much more room than a turn asks for
#define BACKOFFS_MAX 3
#define HEMMED_IN_MS 10000u // people who stand beside it walk on
#define LOW_BATTERY_DV 115  // where CONFIGpac names none
#define ABEAM_SONARS argus_robot_rear_flank(self->knowledge.robot)
#define REAR_SONARS (argus_robot_astern(self->knowledge.robot) | ABEAM_SONARS)
#define ABEAM_CLEAR_MM 250 // beside a way straight back of 300 mm; the body ends 77 mm beside their faces
#define BACK_MOST_MM 300
#define BACK_LEFT_MM 150 // of what the rear reads clear
#define BACK_STEP_MM 25
#define ASTERN_MM 50 // beyond the rear end

static bool is_active(const argus_t *const self) {
    return !self->passive && !self->shutdown;
}

void argus_stop(argus_t *const self, const uint8_t command) {
    self->jog_mm = 0; // what an operator asked for is not taken up again by itself
    if (self->passive) {
        argus_motion_hold(&self->motion, self->now_ms);
        return;
    }
    argus_motion_stop(&self->motion, &self->session.outbox, self->now_ms);
    if (command == ARCOS_CMD_E_STOP) {
        argus_outbox_urgent(&self->session.outbox, ARCOS_CMD_E_STOP);
    }
    self->stops++;
    argus_say(self, ARGUS_EV_STOPPED, ARGUS_NO_SONAR, self->knowledge.pose.heading_cdeg);
}

// A motion may be on its way though the SIPs do not show it yet.
void argus_halt(argus_t *const self) {
    const bool commanded = self->motion.kind == ARGUS_MOTION_MOVE || self->motion.kind == ARGUS_MOTION_TURN;
    if (!argus_at_rest(&self->knowledge) || (commanded && !self->motion.settled)) {
        argus_stop(self, ARCOS_CMD_STOP);
    }
}

bool argus_may_translate(const argus_t *const self) {
    const bool motors = (self->knowledge.flags & ARCOS_FLAG_MOTORS) != 0;
    const bool healthy_link = argus_session_is_open(&self->session) && !self->stalled;
    return is_active(self) && healthy_link && motors && self->checked && self->bumpers == 0;
}

// What has failed, or has the name of a fault, does not read clear: nobody looks there in its place.
static bool is_relied_on(const argus_t *const self, const int sonar) {
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const bool named = s->health == ARGUS_SUSPECT && s->kind != ARGUS_KIND_NONE;
    return argus_age_ms(&self->knowledge, sonar, self->now_ms) <= (uint32_t)self->config.stale_ms && !named &&
           !argus_is_out(&self->knowledge, sonar);
}

bool argus_rear_is_watched(const argus_t *const self) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((REAR_SONARS >> i & 1u) != 0 && !is_relied_on(self, i)) {
            return false;
        }
    }
    return true;
}

// Those that look abeam see what the robot passes by, not what it backs into.
static int32_t rear_clear_mm(const argus_t *const self, const int sonar) {
    const bool abeam = argus_judges(self) && (ABEAM_SONARS >> sonar & 1u) != 0;
    return abeam ? argus_min(ABEAM_CLEAR_MM, self->config.rear_clear_mm) : self->config.rear_clear_mm;
}

bool argus_rear_is_clear(const argus_t *const self) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const bool counts = (REAR_SONARS >> i & 1u) != 0;
        if (counts && self->knowledge.sonar[i].reading_mm <= rear_clear_mm(self, i)) {
            return false;
        }
    }
    return argus_rear_is_watched(self);
}

// As fast as S5 lets it drive with the rear's overhang.
static int32_t back_speed_mm_s(const argus_t *const self) {
    const int32_t overhang_mm = self->knowledge.robot->rear_overhang_mm;
    const bool stops_in_time = argus_config_stop_mm(&self->config, self->knowledge.robot) + overhang_mm <
                               self->config.object_range_mm;
    return argus_judges(self) && stops_in_time ? self->config.speed_mm_s : self->config.step_speed_mm_s;
}

static void back_off(argus_t *const self, const int32_t distance_mm, const int32_t speed_mm_s) {
    if (!is_active(self) || !argus_rear_is_clear(self)) {
        return;
    }
    argus_say(self, ARGUS_EV_BACKING, ARGUS_NO_SONAR, distance_mm);
    argus_motion_move(&self->motion, &self->session.outbox, -distance_mm, speed_mm_s, self->now_ms);
    argus_enter(self, ARGUS_MODE_BACKING);
}

void argus_back_off(argus_t *const self, const int32_t distance_mm) {
    back_off(self, distance_mm, self->config.step_speed_mm_s);
}

// Of what is seen, were the robot farther back; under `argus` what was seen a moment ago and has left the
// cones is still there.
static int32_t nearest_to_centre_mm(const argus_t *const self, const int32_t back_mm) {
    const int32_t now_mm = argus_nearest_to_centre_mm(&self->knowledge, back_mm);
    return argus_judges(self)
               ? argus_min(now_mm, argus_task_nearest_mm(&self->task, &self->knowledge, back_mm))
               : now_mm;
}

static int32_t swing_mm(const argus_t *const self) {
    return argus_judges(self) ? SWING_MM + SWING_MARGIN_MM : SWING_MM;
}

bool argus_swing_is_blocked(const argus_t *const self) {
    return nearest_to_centre_mm(self, 0) <= swing_mm(self);
}

// What the rear reads clear less some room; no farther than usual past what was seen beside the way, since a
// smooth wall that slants in by 15 to 25 degrees is heard by nobody.
static int32_t most_back_mm(const argus_t *const self) {
    const int32_t clear_mm = argus_min(BACK_MOST_MM, self->config.rear_clear_mm - BACK_LEFT_MM);
    const int32_t astern_cdeg = argus_angle_wrap(self->knowledge.pose.heading_cdeg + 18000);
    const int32_t free_mm = argus_task_clear_mm(&self->task, &self->knowledge, astern_cdeg,
                                                argus_task_straight_half_mm(self->knowledge.robot));
    const bool is_free = free_mm >= self->knowledge.robot->rear_mm + clear_mm + ASTERN_MM;
    const bool again = self->backed > 1; // far once is far enough
    return is_free && !again ? clear_mm : argus_min(clear_mm, self->config.backoff_mm);
}

// The least way back, up to the most, after which a turn is free; where none is, the usual one.
static int32_t way_to_turn_mm(const argus_t *const self) {
    const int32_t usual_mm = self->config.backoff_mm;
    if (!argus_judges(self)) {
        return usual_mm;
    }
    const int32_t most_mm = most_back_mm(self);
    for (int32_t way_mm = usual_mm; way_mm <= most_mm; way_mm += BACK_STEP_MM) {
        if (nearest_to_centre_mm(self, way_mm) > swing_mm(self) + SWING_SPARE_MM) {
            return way_mm;
        }
    }
    return argus_min(usual_mm, most_mm);
}

// S7: no rotation while a bumper is pressed or an echo lies within the swing circle.
bool argus_may_turn(const argus_t *const self) {
    return is_active(self) && self->bumpers == 0 && !argus_swing_is_blocked(self);
}

static bool may_back_off(const argus_t *const self) {
    return is_active(self) && self->bumpers == 0 && self->backed < BACKOFFS_MAX && argus_rear_is_clear(self);
}

bool argus_is_hemmed_in(const argus_t *const self) {
    const bool waited =
        self->wait_last == ARGUS_WAIT_TURN && self->now_ms - self->wait_since_ms >= HEMMED_IN_MS;
    return argus_judges(self) && self->mission == ARGUS_MISSION_RUNNING && !self->paused && waited &&
           self->bumpers == 0 && !argus_may_turn(self) && !may_back_off(self);
}

// It is healthy and shows no gaps: what is there it hears again.
static bool is_steady(const argus_t *const self, const int sonar) {
    return self->knowledge.sonar[sonar].health == ARGUS_HEALTHY &&
           self->evidence.of[sonar].score[ARGUS_TEST_DROPOUT] <= 0;
}

static bool only_steady_forbid_to_turn(const argus_t *const self) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const bool forbids = argus_echo_to_centre_mm(&self->knowledge, i, 0) <= swing_mm(self);
        if (forbids && !is_steady(self, i)) {
            return false;
        }
    }
    return true;
}

// All that forbids to turn is an echo of now, of who would hear it again were something there. Once for each
// try, since echoes that jump are never remembered as of one thing.
static bool may_be_crosstalk(const argus_t *const self) {
    return argus_judges(self) && !self->swing_again && self->bumpers == 0 &&
           argus_task_nearest_mm(&self->task, &self->knowledge, 0) > swing_mm(self) &&
           only_steady_forbid_to_turn(self);
}

static void read_again(argus_t *const self) {
    const int32_t rounds = self->rounds; // of a full check under way
    self->swing_again = true;
    argus_enter_checking(self, false);
    self->rounds = (uint8_t)argus_max(rounds, self->rounds);
    self->all_round = true;
    self->marked = true;
    self->mark = argus_mark_now(&self->knowledge);
}

// Where it may not turn, a few times backing away may help.
bool argus_turn(argus_t *const self, const int32_t heading_cdeg) {
    const int32_t nearest = nearest_to_centre_mm(self, 0);
    if (argus_may_turn(self)) {
        self->wait_last = self->wait_last == ARGUS_WAIT_TURN ? ARGUS_WAIT_NONE : self->wait_last;
        argus_motion_turn(&self->motion, &self->session.outbox, &self->knowledge, heading_cdeg, self->now_ms);
        self->swing_again = false;
        return true;
    }
    if (may_be_crosstalk(self)) {
        read_again(self);
        return false;
    }
    self->swing_again = false;
    argus_say(self, ARGUS_EV_TURN_BLOCKED, ARGUS_NO_SONAR, nearest == INT32_MAX ? 0 : nearest);
    if (may_back_off(self)) {
        const int32_t way_mm = way_to_turn_mm(self);
        self->backed = (uint8_t)(self->backed + (way_mm > self->config.backoff_mm ? 2 : 1));
        back_off(self, way_mm, back_speed_mm_s(self));
    } else {
        argus_enter_waiting(self, ARGUS_WAIT_TURN);
    }
    return false;
}

void argus_disable(argus_t *const self, const int sonar, const argus_fault_kind_t kind) {
    argus_sonar_set_health(&self->knowledge.sonar[sonar], ARGUS_DISABLED, kind, self->now_ms);
    self->evidence.of[sonar].agreed = 0; // what brings it back comes after this
    argus_evidence_retract(&self->evidence, sonar);
    argus_task_forget(&self->task, sonar);
    argus_task_restart(&self->task);
    argus_replan(self);
    argus_say(self, ARGUS_EV_SONAR_DISABLED, sonar, (int32_t)kind);
}

// The forward-facing sonars in use, and every other one of the rest of their arrays: these watch the swing
// circle.
static size_t add_half(const argus_t *const self, const int half, uint8_t *const order) {
    const argus_robot_t *const robot = self->knowledge.robot;
    const unsigned others = argus_robot_polled(robot) & ~(unsigned)argus_robot_forward(robot);
    size_t count = 0;
    int other = 0;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if (argus_robot_faces_forward(robot, i) && !argus_is_out(&self->knowledge, i)) {
            order[count++] = (uint8_t)(i + 1);
        }
    }
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((others >> i & 1u) != 0 && other++ % 2 == half) {
            order[count++] = (uint8_t)(i + 1);
        }
    }
    return count;
}

// In failure mode the slots of the sonars that are out go to those that look ahead.
void argus_share_slots(argus_t *const self) {
    if (!is_active(self) || !argus_session_is_open(&self->session)) {
        return;
    }
    uint8_t order[ARCOS_TIMING_ARRAYS_MAX * ARCOS_TIMING_POLLING_MAX_PER_ARRAY];
    size_t count = add_half(self, 0, order);
    count += add_half(self, 1, order + count);
    for (int i = 0; argus_judges(self) && i < self->knowledge.sonars; i++) {
        if (argus_robot_faces_forward(self->knowledge.robot, i) && argus_is_out(&self->knowledge, i)) {
            order[count++] = (uint8_t)(i + 1); // its own slot, to show that it does well again
        }
    }
    argus_outbox_string(&self->session.outbox, ARCOS_CMD_POLLING, order, count);
    self->ordered = true;
    self->ordered_ms = self->now_ms;
}

static void say_plan(argus_t *const self) {
    argus_say(self, ARGUS_EV_PLAN, ARGUS_NO_SONAR, self->plan.count);
    for (int i = 0; i < self->plan.count; i++) {
        argus_say(self, ARGUS_EV_PLAN_ROTATION, ARGUS_NO_SONAR, self->plan.rotation_deg[i]);
    }
}

// A suspect that no witness could judge is planned for as if it were disabled: its bearing counts as
// uncovered. One that is still to be verified is not: nothing moves ahead before it is.
void argus_replan(argus_t *const self) {
    const argus_mask_t disabled = argus_out(&self->knowledge) & ARGUS_FORWARD_MASK;
    const argus_mask_t blind = disabled | (argus_with_health(&self->knowledge, ARGUS_SUSPECT) &
                                           self->awareness.verified & ARGUS_FORWARD_MASK);
    const argus_failure_t failure = argus_failure_of(self->knowledge.robot, disabled);
    if (failure != self->failure) {
        self->failure = failure;
        argus_say(self, ARGUS_EV_FAILURE_STATE, ARGUS_NO_SONAR, argus_count_bits(disabled));
    }
    if (blind == self->plan.disabled) {
        return;
    }
    self->plan = argus_plan(self->knowledge.robot, (argus_policy_t)self->config.policy, blind);
    say_plan(self);
    argus_share_slots(self);
}

void argus_flag_suspects(argus_t *const self, const argus_mask_t suspects) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        argus_sonar_t *const s = &self->knowledge.sonar[i];
        if ((suspects >> i & 1u) != 0 && s->health != ARGUS_SUSPECT) {
            argus_sonar_set_health(s, ARGUS_SUSPECT, ARGUS_KIND_NONE, self->now_ms);
            argus_say(self, ARGUS_EV_SONAR_SUSPECT, i, self->awareness.of[i].difference_mm);
        }
    }
}

// New contact only: bits already answered are let be until they clear.
static bool react_bumper(argus_t *const self) {
    const uint16_t pressed = (uint16_t)(self->knowledge.bumpers_front << 8 | self->knowledge.bumpers_rear);
    const bool fresh = (pressed & ~(unsigned)self->bumpers) != 0;
    if (pressed == 0 && self->bumpers != 0) {
        argus_say(self, ARGUS_EV_BUMPER_CLEAR, ARGUS_NO_SONAR, 0);
    }
    self->bumpers = pressed;
    if (!fresh) {
        return false;
    }
    argus_say(self, ARGUS_EV_BUMPER, ARGUS_NO_SONAR, pressed);
    argus_task_bumped(&self->task, &self->knowledge, self->now_ms);
    argus_task_refuse(&self->task, &self->knowledge);
    argus_stop(self, ARCOS_CMD_E_STOP);
    self->checked = false;
    argus_enter_waiting(self, ARGUS_WAIT_BUMPER);
    return true;
}

static bool react_stall(argus_t *const self, const argus_alarm_t *const alarm) {
    if (!alarm->stall || self->bumpers != 0) {
        self->stall_said = alarm->stall;
        return false;
    }
    if (self->stall_said) {
        return false;
    }
    self->stall_said = true;
    argus_say(self, ARGUS_EV_STALL, ARGUS_NO_SONAR,
              self->knowledge.stall_left + 2 * self->knowledge.stall_right);
    argus_task_refuse(&self->task, &self->knowledge);
    argus_stop(self, ARCOS_CMD_STOP);
    self->checked = false;
    argus_enter_waiting(self, ARGUS_WAIT_BUMPER);
    return true;
}

static bool react_dead(argus_t *const self, const argus_alarm_t *const alarm) {
    const argus_mask_t lost = alarm->dead | alarm->silent;
    if (lost == 0) {
        return false;
    }
    argus_stop(self, ARCOS_CMD_STOP);
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        if ((alarm->dead >> i & 1u) != 0) {
            argus_say(self, ARGUS_EV_SONAR_DEAD, i, self->knowledge.sonar[i].reading_mm);
            argus_disable(self, i, ARGUS_KIND_OFF);
        } else if ((alarm->silent >> i & 1u) != 0) {
            const uint32_t age = argus_age_ms(&self->knowledge, i, self->now_ms);
            argus_say(self, ARGUS_EV_SONAR_SILENT, i, (int32_t)(age & 0x7FFFFFFFu));
            argus_disable(self, i, ARGUS_KIND_SILENT);
        }
    }
    if (self->mode != ARGUS_MODE_WAITING && self->mode != ARGUS_MODE_CLOSING) {
        argus_enter_checking(self, false);
    }
    return true;
}

static void stop_before(argus_t *const self, const int sonar, const int32_t reading_mm) {
    argus_say(self, ARGUS_EV_OBJECT, sonar, reading_mm);
    argus_stop(self, ARCOS_CMD_STOP);
}

// An object is looked at again at rest, with Algorithm 1, before it is believed: a sonar that lies low is
// found there.
static bool react_object(argus_t *const self, const argus_alarm_t *const alarm) {
    const bool translating = self->mode == ARGUS_MODE_DRIVING || self->mode == ARGUS_MODE_STEPPING ||
                             self->mode == ARGUS_MODE_BACKING;
    if (alarm->object == 0 || !translating || self->motion.kind == ARGUS_MOTION_STOP) {
        return false;
    }
    self->evidence.jumped |= alarm->object; // looked at before it is believed
    stop_before(self, alarm->object_sonar, alarm->object_mm);
    if (self->mode != ARGUS_MODE_BACKING) {
        argus_task_refuse(&self->task, &self->knowledge);
    }
    argus_enter_checking(self, true);
    return true;
}

// True: for the second time. One echo within the swing circle may be crosstalk, the second one of the same
// place is not; it is remembered.
static bool note_near(argus_t *const self, const int sonar) {
    const argus_point_t echo = argus_echo_robot(&self->knowledge, sonar);
    if (argus_hypot(echo.x_mm, echo.y_mm) > SWING_MM + SWING_TURNING_MM) {
        return false;
    }
    argus_near_t *const near = &self->near[echo.y_mm > 0 ? 1 : 0]; // in a passage both sides show
    const argus_point_t at = argus_to_course(&self->knowledge.pose, echo);
    const bool here = near->valid && self->now_ms - near->t_ms <= argus_two_rounds_ms(self) &&
                      argus_task_is_one_thing(at, near->at);
    const bool again =
        here || argus_task_has_seen(&self->task, &self->knowledge, at, SWING_MM + SWING_TURNING_MM);
    *near = (argus_near_t){at, self->now_ms, true};
    if (again) {
        argus_task_touched(&self->task, at, self->now_ms); // or the rest of the turn would be tried at once
    }
    return again;
}

// S7 holds through the turn: what comes into view within the swing circle ends it.
static bool react_swing(argus_t *const self) {
    const bool turning = self->motion.kind == ARGUS_MOTION_TURN && !self->motion.settled;
    if (!argus_judges(self) || !turning) {
        self->near[0].valid = self->near[1].valid = false;
        return false;
    }
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const bool fresh = (self->knowledge.fresh >> i & 1u) != 0 && argus_usable(&self->knowledge, i);
        if (fresh && note_near(self, i)) {
            argus_say(self, ARGUS_EV_TURN_BLOCKED, ARGUS_NO_SONAR, nearest_to_centre_mm(self, 0));
            argus_stop(self, ARCOS_CMD_STOP);
            argus_enter_checking(self, true);
            return true;
        }
    }
    return false;
}

// A smooth wall that the robot slants into is heard by the sonar that looks abeam alone.
static void react_flank(argus_t *const self) {
    const bool ahead = self->mode == ARGUS_MODE_DRIVING || self->mode == ARGUS_MODE_STEPPING;
    if (!argus_judges(self) || !ahead || self->motion.kind != ARGUS_MOTION_MOVE || self->motion.settled) {
        return;
    }
    const unsigned usable = self->knowledge.fresh & ~(unsigned)argus_out(&self->knowledge) &
                            argus_robot_flank(self->knowledge.robot);
    const int32_t stop_mm = argus_config_stop_mm(&self->config, self->knowledge.robot);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((usable >> i & 1u) != 0 && argus_evidence_slants_in(&self->evidence, i, stop_mm)) {
            stop_before(self, i, self->knowledge.sonar[i].reading_mm);
            argus_task_refuse_slant(&self->task, &self->knowledge);
            argus_enter_checking(self, true);
            return;
        }
    }
}

// The motors may be cut by the robot's own button or E-stop at any time; a bumper's own stop is answered
// elsewhere.
static void react_motors(argus_t *const self) {
    const bool off = (self->knowledge.flags & ARCOS_FLAG_MOTORS) == 0;
    const bool settled_in = self->now_ms - self->knowledge.online_ms > 1500u;
    const bool busy = self->mode == ARGUS_MODE_CLOSING || self->wait == ARGUS_WAIT_BUMPER;
    if (!is_active(self) || busy || off == self->motors_said || (off && !settled_in)) {
        return;
    }
    self->motors_said = off;
    argus_say(self, off ? ARGUS_EV_MOTORS_OFF : ARGUS_EV_MOTORS_ON, ARGUS_NO_SONAR, self->knowledge.flags);
    argus_stop(self, ARCOS_CMD_STOP);
    self->checked = false;
    if (off) {
        argus_enter_waiting(self, ARGUS_WAIT_MOTORS);
    } else {
        argus_enter_checking(self, true);
    }
}

// The others (0, 7, the rear array) are not judged, but one that yields nothing any more must not be relied
// on.
static void watch_others(argus_t *const self) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        argus_sonar_t *const s = &self->knowledge.sonar[i];
        const bool other = (ARGUS_FORWARD_MASK >> i & 1u) == 0;
        const uint32_t silent_ms = argus_silent_ms(&self->knowledge, i);
        const bool stale = silent_ms > (uint32_t)self->config.stale_ms;
        if (other && s->health == ARGUS_HEALTHY && stale) {
            argus_sonar_set_health(s, ARGUS_STALE, ARGUS_KIND_NONE, self->now_ms);
            argus_say(self, ARGUS_EV_SONAR_STALE, i, (int32_t)(silent_ms & 0x7FFFFFFFu));
        } else if (other && s->health == ARGUS_STALE && !stale) {
            argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
        }
    }
}

static void react_battery(argus_t *const self) {
    const argus_session_t *const session = &self->session;
    const int32_t stated = session->has_robot ? session->robot.low_battery_dv : 0;
    const int32_t low = stated > 0 ? stated : LOW_BATTERY_DV;
    const int32_t now = self->knowledge.battery_dv;
    const bool is_low = now > 0 && now <= low;
    if (is_low && !self->battery_said) {
        argus_say(self, ARGUS_EV_BATTERY_LOW, ARGUS_NO_SONAR, now);
    }
    self->battery_said = is_low || (self->battery_said && now <= low + 2); // 0.2 V of hysteresis
}

void argus_react(argus_t *const self, const argus_alarm_t *const alarm) {
    if (self->mode == ARGUS_MODE_CLOSING || self->mode == ARGUS_MODE_OFFLINE) {
        return;
    }
    if (react_bumper(self) || react_stall(self, alarm)) {
        return;
    }
    if (!argus_judges(self)) {
        watch_others(self);
    }
    react_battery(self);
    react_motors(self);
    if (!react_dead(self, alarm) && !react_object(self, alarm) && !react_swing(self)) {
        react_flank(self);
    }
}
