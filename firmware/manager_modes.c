// SPDX-License-Identifier: MIT
// The modes: what each does with a SIP, and what follows it (paper: Fig. 2 and Fig. 10).
#include "argus/angle.h"
#include "manager_internal.h"

#define AIM_CDEG 1000       // a bearing farther off than this is turned to at rest
#define AIMED_CDEG 200      // at rest, near enough
#define STEER_CDEG 200      // while driving, corrected beyond this
#define STEER_LEG_MM 250    // ... and only this far from the leg's end
#define LEG_DONE_MM 60
#define RETRY_MS 1000u
#define SAY_EVERY_S 10u

void argus_enter(argus_t *const self, const argus_mode_t mode) {
    self->mode = mode;
    self->since_ms = self->now_ms;
    if (mode != ARGUS_MODE_WAITING) {
        self->wait = ARGUS_WAIT_NONE;
    }
    if (mode != ARGUS_MODE_VERIFYING) {
        argus_verify_init(&self->verify);
    }
}

// Waiting for the same thing again without having driven in between counts on.
void argus_enter_waiting(argus_t *const self, const argus_wait_t why) {
    if (self->wait_last != why) {
        self->wait_last = why;
        self->wait_since_ms = self->now_ms;
        self->waited_s = 0;
        argus_say(self, why == ARGUS_WAIT_WAY ? ARGUS_EV_NO_WAY : ARGUS_EV_WAITING, ARGUS_NO_SONAR, 0);
    }
    self->wait = why;
    self->tried_ms = self->now_ms;
    argus_enter(self, ARGUS_MODE_WAITING);
}

// Whatever is under way must not go on beside a check.
static void come_to_rest(argus_t *const self) {
    const bool under_way = self->motion.kind == ARGUS_MOTION_MOVE || self->motion.kind == ARGUS_MOTION_TURN;
    if (self->motion.settled) {
        return;
    }
    if (under_way && !self->motion.failed) {
        argus_stop(self, ARCOS_CMD_STOP);
    } else if (self->motion.kind != ARGUS_MOTION_STOP || self->motion.failed) {
        argus_motion_hold(&self->motion, self->now_ms);
    }
}

// At rest on the base heading; `full`: as many rounds of readings as Algorithm 1 wants for a suspect.
void argus_enter_checking(argus_t *const self, const bool full) {
    if (self->mode == ARGUS_MODE_CLOSING || self->mode == ARGUS_MODE_CLOSED) {
        return;
    }
    self->rounds = full || !self->checked ? (uint8_t)self->config.suspect_readings : 1;
    self->arriving = false;
    self->marked = false;
    come_to_rest(self);
    argus_enter(self, ARGUS_MODE_CHECKING);
}

void argus_enter_verifying(argus_t *const self, const uint16_t suspects) {
    argus_flag_suspects(self, suspects);
    argus_halt(self);
    if (!self->motion.settled && self->motion.kind != ARGUS_MOTION_STOP) {
        argus_motion_hold(&self->motion, self->now_ms);
    }
    argus_enter(self, ARGUS_MODE_VERIFYING);
}

static void take_base(argus_t *const self) {
    if (!self->has_base) {
        self->has_base = true;
        self->base_cdeg = self->knowledge.pose.heading_cdeg;
    }
}

// True when the robot stands on the base heading; else it is on its way there, or S7 forbids.
static bool is_home(argus_t *const self) {
    if (self->passive) {
        return true;
    }
    if (self->motion.failed) {
        argus_say(self, ARGUS_EV_TURN_FAILED, ARGUS_NO_SONAR,
                  argus_angle_abs_diff(self->knowledge.pose.heading_cdeg, self->motion.target_cdeg) / 100);
        argus_enter_waiting(self, ARGUS_WAIT_MOTORS);
        return false;
    }
    if (!self->motion.settled) {
        return false;
    }
    take_base(self);
    if (argus_angle_abs_diff(self->knowledge.pose.heading_cdeg, self->base_cdeg) > 2 * 100) {
        argus_turn(self, self->base_cdeg);
        return false;
    }
    return true;
}

static void declare_healthy(argus_t *const self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_sonar_t *const s = &self->knowledge.sonar[i];
        if (s->reported && (s->health == ARGUS_UNKNOWN || s->health == ARGUS_STALE)) {
            argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
            argus_say(self, ARGUS_EV_SONAR_HEALTHY, i, s->reading_mm);
        }
    }
}

// Suspects not verified in this place: also those whose verification was broken off, or could not be begun.
uint16_t argus_open_suspects(const argus_t *const self) {
    return (uint16_t)(argus_with_health(&self->knowledge, ARGUS_SUSPECT) & ~(unsigned)self->awareness.verified);
}

static void finish_check(argus_t *const self) {
    const uint16_t found = argus_suspects(&self->awareness, &self->knowledge, &self->config);
    const uint16_t suspects = (uint16_t)(found | argus_open_suspects(self));
    self->check_ms = self->now_ms;
    if (suspects != 0 && !self->passive && !self->stay) {
        argus_enter_verifying(self, suspects);
        return;
    }
    argus_flag_suspects(self, suspects);
    declare_healthy(self);
    argus_replan(self);
    self->checked = true;
    argus_say(self, ARGUS_EV_HEALTH_CHECK, ARGUS_NO_SONAR, argus_count_bits(argus_disabled(&self->knowledge)));
    argus_decide(self);
}

static uint16_t wanted_sonars(const argus_t *const self) {
    return (uint16_t)(ARGUS_FORWARD_MASK & ~(unsigned)argus_disabled(&self->knowledge));
}

static void run_checking(argus_t *const self) {
    if (!is_home(self)) {
        self->marked = false;
        return;
    }
    if (!self->marked) {
        self->marked = true;
        self->mark = self->passive ? argus_mark_now(&self->knowledge) : self->motion.mark;
    }
    if (!argus_all_fresh_since(&self->knowledge, wanted_sonars(self), &self->mark)) {
        return;
    }
    self->mark = argus_mark_now(&self->knowledge);
    self->mark.from_ms = self->now_ms;
    if (self->rounds > 1) {
        self->rounds--;
        return;
    }
    finish_check(self);
}

static void apply_verdict(argus_t *const self) {
    const int sonar = self->verify.sonar;
    argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    switch (self->verify.result) {
    case ARGUS_RESULT_CONVICTED: argus_disable(self, sonar, ARGUS_KIND_WRONG); break;
    case ARGUS_RESULT_CLEARED:
        argus_awareness_cleared(&self->awareness, &self->knowledge, sonar, self->verify.difference_mm);
        argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
        argus_say(self, ARGUS_EV_SONAR_CLEARED, sonar, self->verify.mean_mm);
        break;
    case ARGUS_RESULT_DROPPED:
        self->awareness.of[sonar].in_a_row = 0;
        argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
        argus_say(self, ARGUS_EV_SUSPICION_DROPPED, sonar, self->verify.difference_mm);
        break;
    case ARGUS_RESULT_UNPROVEN:
        self->awareness.verified |= (uint16_t)(1u << sonar);
        argus_say(self, ARGUS_EV_SONAR_UNPROVEN, sonar, self->verify.reading_mm);
        break;
    case ARGUS_RESULT_NONE:
    default: break;
    }
}

static void say_witnesses(argus_t *const self) {
    for (int side = 0; side < 2; side++) {
        if ((self->verify.heard >> side & 1) != 0) {
            argus_say(self, ARGUS_EV_SONAR_WITNESS, self->verify.sonar + (side == 0 ? -1 : 1),
                      self->verify.witness_mm[side]);
        }
    }
}

static int next_suspect(const argus_t *const self) {
    const unsigned open = argus_open_suspects(self);
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        if ((open >> i & 1u) != 0) {
            return i;
        }
    }
    return -1;
}

static void begin_next_suspect(argus_t *const self) {
    const int sonar = next_suspect(self);
    if (sonar < 0) {
        argus_enter_checking(self, false);
        return;
    }
    argus_verify_begin(&self->verify, sonar, self->base_cdeg);
    argus_say(self, ARGUS_EV_SONAR_VERIFYING, sonar, self->knowledge.sonar[sonar].reading_mm);
}

static void run_verifying(argus_t *const self) {
    if (self->verify.phase == ARGUS_VERIFY_IDLE) {
        if (is_home(self)) {
            begin_next_suspect(self);
        }
        return;
    }
    if (self->motion.failed) {
        argus_enter_checking(self, false);
        return;
    }
    if (!self->motion.settled || !argus_verify_step(&self->verify, &self->knowledge, &self->motion.mark)) {
        return;
    }
    if (self->verify.phase != ARGUS_VERIFY_DONE) {
        argus_turn(self, argus_verify_heading_cdeg(&self->verify));
        return;
    }
    say_witnesses(self);
    apply_verdict(self);
    argus_verify_init(&self->verify);
}

static bool check_is_due(const argus_t *const self) {
    return self->now_ms - self->check_ms >= (uint32_t)self->config.health_check_ms;
}

// Who may not turn cannot verify: there a suspicion lasts as long as the disparity.
static void drop_suspicions(argus_t *const self) {
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        argus_sonar_t *const s = &self->knowledge.sonar[i];
        if (s->health == ARGUS_SUSPECT && self->awareness.of[i].in_a_row == 0) {
            argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
            argus_say(self, ARGUS_EV_SUSPICION_DROPPED, i, 0);
        }
    }
}

// The periodic health check beside the main task; true when it took over.
static bool health_check(argus_t *const self) {
    if (!check_is_due(self)) {
        return false;
    }
    self->check_ms = self->now_ms;
    const uint16_t suspects = argus_suspects(&self->awareness, &self->knowledge, &self->config);
    if (self->passive) {
        drop_suspicions(self);
    }
    if (suspects == 0) {
        return false;
    }
    if (self->passive || self->paused) {
        argus_flag_suspects(self, suspects);
        return false;
    }
    argus_enter_verifying(self, suspects);
    return true;
}

static void enter_travel(argus_t *const self) {
    self->aimed = false;
    self->has_base = false;
    self->arriving = false;
    argus_enter(self, self->plan.disabled == 0 ? ARGUS_MODE_DRIVING : ARGUS_MODE_SWEEPING);
    self->drive.done = false;
    self->drive.base_cdeg = 0;
}

static void fail_mission(argus_t *const self) {
    if (self->mission == ARGUS_MISSION_RUNNING) {
        self->mission = ARGUS_MISSION_FAILED;
        argus_say(self, ARGUS_EV_MISSION_FAILED, ARGUS_NO_SONAR, argus_task_goal_mm(&self->task, &self->knowledge));
    }
}

void argus_decide(argus_t *const self) {
    const bool jogging = self->jog_mm > 0;
    const bool wants = jogging || (self->mission == ARGUS_MISSION_RUNNING && !self->paused);
    if (self->passive || !wants) {
        self->has_base = false;
        self->wait_last = ARGUS_WAIT_NONE;
        argus_enter(self, ARGUS_MODE_IDLE);
    } else if (self->plan.disabled != 0 && !self->plan.complete) { // all six are out, or suspects that no one can judge
        fail_mission(self);
        argus_enter_waiting(self, ARGUS_WAIT_CATASTROPHIC);
    } else if (self->bumpers != 0) {
        argus_enter_waiting(self, ARGUS_WAIT_BUMPER);
    } else if (!argus_may_translate(self)) {
        argus_enter_waiting(self, ARGUS_WAIT_MOTORS);
    } else {
        enter_travel(self);
    }
}

// A leg to drive; false when every heading is blocked and the manager waits.
static bool has_way(argus_t *const self) {
    if (self->jog_mm > 0 || self->task.has_leg) {
        return true;
    }
    if (!argus_task_choose(&self->task, &self->knowledge)) {
        argus_halt(self);
        argus_enter_waiting(self, ARGUS_WAIT_WAY);
        return false;
    }
    self->aimed = false;
    if (self->task.avoiding) {
        argus_say(self, ARGUS_EV_AVOIDING, ARGUS_NO_SONAR,
                  argus_task_bearing_cdeg(&self->task, &self->knowledge) / 100);
    }
    return true;
}

static int32_t bearing(const argus_t *const self) {
    return self->jog_mm > 0 ? self->knowledge.pose.heading_cdeg : argus_task_bearing_cdeg(&self->task, &self->knowledge);
}

static int32_t off_bearing(const argus_t *const self) {
    return argus_angle_abs_diff(bearing(self), self->knowledge.pose.heading_cdeg);
}

// Where there is no room to turn, a leg straight ahead may lead out.
static void turn_to_bearing(argus_t *const self) {
    const bool narrow = argus_swing_is_blocked(self) && self->jog_mm == 0;
    if (!narrow || !argus_task_escape(&self->task, &self->knowledge)) {
        argus_turn(self, bearing(self));
    }
}

// Turns to the leg's bearing at rest. True when the robot looks along it.
static bool aim(argus_t *const self) {
    if (self->aimed) {
        return true;
    }
    if (self->motion.failed) {
        argus_enter_waiting(self, ARGUS_WAIT_MOTORS);
        return false;
    }
    if (!argus_at_rest(&self->knowledge) || !self->motion.settled) {
        if (self->motion.kind == ARGUS_MOTION_MOVE && !self->motion.settled) {
            argus_motion_stop(&self->motion, &self->session.outbox, self->now_ms);
        }
        return false;
    }
    if (off_bearing(self) > AIMED_CDEG) {
        turn_to_bearing(self);
        return false;
    }
    self->aimed = argus_all_fresh_since(&self->knowledge, wanted_sonars(self), &self->motion.mark);
    return self->aimed;
}

// Waypoints and the goal; true when the SIP is dealt with.
static bool make_progress(argus_t *const self) {
    int passed = 0;
    const uint16_t before = self->task.next;
    const bool arrived = argus_task_progress(&self->task, &self->knowledge, &self->config, &passed);
    for (int i = 0; i < passed; i++) {
        argus_say(self, ARGUS_EV_WAYPOINT, ARGUS_NO_SONAR, before + i + 1);
    }
    if (!arrived) {
        return false;
    }
    if (!self->arriving) {
        self->arriving = true;
        argus_motion_stop(&self->motion, &self->session.outbox, self->now_ms);
    } else if (self->motion.settled) {
        self->mission = ARGUS_MISSION_REACHED;
        argus_say(self, ARGUS_EV_GOAL_REACHED, ARGUS_NO_SONAR, argus_task_goal_mm(&self->task, &self->knowledge));
        argus_decide(self);
    }
    return true;
}

static void blocked_ahead(argus_t *const self, const argus_event_id_t event, const int sonar, const int32_t reading_mm) {
    argus_say(self, event, sonar, reading_mm);
    argus_halt(self);
    self->jog_mm = 0;
    argus_task_refuse(&self->task, &self->knowledge);
    argus_enter_checking(self, true);
}

static int nearest_forward(const argus_knowledge_t *const knowledge) {
    int nearest = -1;
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        if (argus_usable(knowledge, i) &&
            (nearest < 0 || knowledge->sonar[i].reading_mm < knowledge->sonar[nearest].reading_mm)) {
            nearest = i;
        }
    }
    return nearest;
}

static void steer(argus_t *const self, const int32_t left_mm) {
    if (off_bearing(self) > STEER_CDEG && left_mm > STEER_LEG_MM && argus_may_turn(self)) {
        argus_motion_steer(&self->session.outbox, &self->knowledge, bearing(self));
    }
}

static void moved_on(argus_t *const self) {
    argus_awareness_moved(&self->awareness);
    self->backed = 0;
    self->wait_last = ARGUS_WAIT_NONE;
}

// Every sonar that looks ahead has been refreshed within two rounds of its array.
static bool sees_ahead(const argus_t *const self) {
    const uint32_t limit_ms = 2u * 8u * (uint32_t)self->config.sonar_cycle_ms + 100u;
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        const bool counts = self->knowledge.sonar[i].health != ARGUS_DISABLED;
        if (counts && argus_age_ms(&self->knowledge, i, self->now_ms) > limit_ms) {
            return false;
        }
    }
    return true;
}

// S3: a MOVE that ends where it should without us, renewed on each SIP.
static void drive_on(argus_t *const self) {
    const int32_t left_mm = self->jog_mm > 0 ? self->jog_mm : argus_task_leg_mm(&self->task, &self->knowledge);
    const int32_t free_mm = argus_drive_free_mm(&self->knowledge, self->config.object_range_mm);
    if (!sees_ahead(self)) {
        return; // the MOVE at work ends by itself
    }
    const int sonar = nearest_forward(&self->knowledge);
    const int32_t nearest_mm = sonar < 0 ? 0 : self->knowledge.sonar[sonar].reading_mm;
    if (nearest_mm <= self->config.object_range_mm) {
        blocked_ahead(self, ARGUS_EV_OBJECT, sonar, nearest_mm);
        return;
    }
    if (free_mm == 0) {
        return; // a fresh reading will tell
    }
    argus_motion_move(&self->motion, &self->session.outbox, argus_min(left_mm, free_mm), self->config.speed_mm_s,
                      self->now_ms);
    moved_on(self);
    steer(self, left_mm);
}

static bool leg_is_over(argus_t *const self) {
    if (self->jog_mm > 0 || !self->task.has_leg) {
        return false;
    }
    const bool detour = self->task.avoiding && argus_task_leg_mm(&self->task, &self->knowledge) <= LEG_DONE_MM;
    const bool missed = self->aimed && off_bearing(self) > AIM_CDEG;
    self->task.has_leg = !detour;
    self->aimed = self->aimed && !missed;
    return detour;
}

static void run_driving(argus_t *const self) {
    if (!argus_may_translate(self)) {
        argus_stop(self, ARCOS_CMD_STOP);
        argus_enter_checking(self, true);
        return;
    }
    if ((self->jog_mm == 0 && make_progress(self)) || health_check(self)) {
        return;
    }
    leg_is_over(self);
    if (!has_way(self) || !aim(self)) {
        return;
    }
    if (self->jog_mm > 0) { // one MOVE, then idle again
        argus_enter(self, ARGUS_MODE_STEPPING);
        argus_motion_move(&self->motion, &self->session.outbox,
                          argus_min(self->jog_mm, argus_drive_free_mm(&self->knowledge, self->config.object_range_mm)),
                          self->config.step_speed_mm_s, self->now_ms);
        return;
    }
    drive_on(self);
}

static void step_ahead(argus_t *const self) {
    const int32_t left_mm = self->jog_mm > 0 ? self->jog_mm : argus_task_leg_mm(&self->task, &self->knowledge);
    const int32_t step_mm = argus_min(left_mm, self->config.step_mm);
    argus_say(self, ARGUS_EV_STEP, ARGUS_NO_SONAR, step_mm);
    argus_enter(self, ARGUS_MODE_STEPPING);
    argus_motion_move(&self->motion, &self->session.outbox, step_mm, self->config.step_speed_mm_s, self->now_ms);
    moved_on(self);
}

// The sweep is done and the robot is back on its heading: the compensating and the direct readings decide.
static void judge_sweep(argus_t *const self) {
    const int direct = nearest_forward(&self->knowledge);
    const int32_t direct_mm = direct < 0 ? 0 : self->knowledge.sonar[direct].reading_mm;
    argus_say(self, ARGUS_EV_SWEEP, self->drive.smallest_of, self->drive.smallest_mm);
    if (self->drive.smallest_mm <= self->config.check_range_mm) {
        blocked_ahead(self, ARGUS_EV_OBJECT_CHECKED, self->drive.smallest_of, self->drive.smallest_mm);
    } else if (direct_mm <= self->config.check_range_mm) {
        blocked_ahead(self, ARGUS_EV_OBJECT, direct, direct_mm);
    } else {
        step_ahead(self);
    }
}

static void run_sweep(argus_t *const self) {
    if (self->motion.failed) {
        argus_enter_checking(self, true);
        return;
    }
    if (!self->motion.settled) {
        return;
    }
    if (self->drive.done) {
        if (argus_all_fresh_since(&self->knowledge, wanted_sonars(self), &self->motion.mark)) {
            judge_sweep(self);
        }
        return;
    }
    if (argus_sweep_step(&self->drive, &self->plan, &self->knowledge, &self->motion.mark) && !self->drive.done) {
        argus_turn(self, argus_sweep_heading_cdeg(&self->drive, &self->plan));
    }
}

static void run_sweeping(argus_t *const self) {
    if (!argus_may_translate(self)) {
        argus_stop(self, ARCOS_CMD_STOP);
        argus_enter_checking(self, true);
        return;
    }
    if (self->has_base) {
        run_sweep(self);
        return;
    }
    if ((self->jog_mm == 0 && make_progress(self)) || health_check(self)) {
        return;
    }
    leg_is_over(self);
    if (!has_way(self) || !aim(self)) {
        return;
    }
    take_base(self);
    argus_sweep_begin(&self->drive, &self->plan, self->base_cdeg);
    argus_turn(self, argus_sweep_heading_cdeg(&self->drive, &self->plan));
}

static void run_stepping(argus_t *const self) {
    if (!self->motion.settled) {
        return;
    }
    self->jog_mm = 0;
    self->has_base = false;
    argus_decide(self);
}

static void run_backing(argus_t *const self) {
    if (self->motion.settled) {
        self->has_base = false;
        if (self->bumpers != 0) {
            argus_enter_waiting(self, ARGUS_WAIT_BUMPER);
        } else {
            argus_enter_checking(self, true);
        }
    }
}

static void run_idle(argus_t *const self) {
    if (!self->motion.settled && self->motion.kind == ARGUS_MOTION_NONE) {
        argus_motion_hold(&self->motion, self->now_ms);
    }
    health_check(self);
}

// A bumper: E_STALL may have cut the motors; then back off, or wait for the way behind to clear.
static void leave_bumper(argus_t *const self) {
    const bool motors = (self->knowledge.flags & ARCOS_FLAG_MOTORS) != 0;
    const bool button = (self->knowledge.flags & ARCOS_FLAG_ESTOP) != 0;
    if (!motors && !button) {
        argus_outbox_int(&self->session.outbox, ARCOS_CMD_ENABLE, 1);
    } else if (motors && self->bumpers == 0 && !argus_rear_is_clear(self)) {
        argus_enter_checking(self, true); // freed, or a stall: no need to back away
    } else if (motors && argus_at_rest(&self->knowledge)) {
        argus_back_off(self, self->config.backoff_mm);
    }
}

static void leave_waiting(argus_t *const self) {
    switch (self->wait) {
    case ARGUS_WAIT_BUMPER:
        if (!self->passive) {
            leave_bumper(self);
        } else if (self->bumpers == 0) {
            argus_enter_checking(self, true);
        }
        break;
    case ARGUS_WAIT_MOTORS:
        if (!self->motors_said) {
            argus_enter_checking(self, true);
        }
        break;
    case ARGUS_WAIT_TURN:
    case ARGUS_WAIT_WAY:
        argus_task_forgive(&self->task);
        argus_enter_checking(self, true);
        break;
    case ARGUS_WAIT_NONE:
    case ARGUS_WAIT_CATASTROPHIC:
    default: break;
    }
}

static void run_waiting(argus_t *const self) {
    const uint32_t pause_ms = self->wait == ARGUS_WAIT_BUMPER ? RETRY_MS / 2 : RETRY_MS * 3;
    if (self->now_ms - self->tried_ms >= pause_ms) {
        self->tried_ms = self->now_ms;
        leave_waiting(self);
    }
}

void argus_wait_process(argus_t *const self) {
    const uint32_t waited_s = (self->now_ms - self->wait_since_ms) / 1000u;
    if (self->mode != ARGUS_MODE_WAITING || waited_s < self->waited_s + SAY_EVERY_S) {
        return;
    }
    self->waited_s = waited_s;
    argus_say(self, self->wait == ARGUS_WAIT_WAY ? ARGUS_EV_NO_WAY : ARGUS_EV_WAITING, ARGUS_NO_SONAR, (int32_t)waited_s);
}

static bool run_travel(argus_t *const self) {
    switch ((int)self->mode) {
    case ARGUS_MODE_DRIVING: run_driving(self); return true;
    case ARGUS_MODE_SWEEPING: run_sweeping(self); return true;
    case ARGUS_MODE_STEPPING: run_stepping(self); return true;
    case ARGUS_MODE_BACKING: run_backing(self); return true;
    default: return false;
    }
}

static void run_rest(argus_t *const self) {
    switch ((int)self->mode) {
    case ARGUS_MODE_CHECKING: run_checking(self); break;
    case ARGUS_MODE_VERIFYING: run_verifying(self); break;
    case ARGUS_MODE_IDLE: run_idle(self); break;
    case ARGUS_MODE_WAITING: run_waiting(self); break;
    default: break; // no session, or leaving it
    }
}

void argus_run_mode(argus_t *const self) {
    if (!run_travel(self)) {
        run_rest(self);
    }
}
