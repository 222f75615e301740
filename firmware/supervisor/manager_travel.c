// SPDX-License-Identifier: MIT
// Driving: normal, and in failure mode sweep by sweep and step by step (paper: Fig. 10).
#include "knowledge/angle.h"
#include "supervisor/manager_internal.h"

#define AIM_CDEG 1000    // a bearing farther off than this is turned to at rest
#define AIMED_CDEG 200   // at rest, near enough
#define STEER_CDEG 200   // while driving, corrected beyond this
#define STEER_LEG_MM 250 // ... and only this far from the leg's end
#define LEG_DONE_MM 60
#define FLANK_MM 130
#define UNHEEDED_MS 3000u // MOVE after MOVE for so long and the robot stands: it does not obey

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
    return self->jog_mm > 0 ? self->knowledge.pose.heading_cdeg
                            : argus_task_bearing_cdeg(&self->task, &self->knowledge);
}

static int32_t off_bearing(const argus_t *const self) {
    return argus_angle_abs_diff(bearing(self), self->knowledge.pose.heading_cdeg);
}

// Where there is no room to turn, a leg straight ahead may lead out; not along a wall that is so near that a
// slant could not be seen in time.
static void turn_to_bearing(argus_t *const self) {
    const bool narrow =
        argus_swing_is_blocked(self) && self->jog_mm == 0 && argus_flank_mm(&self->knowledge) > FLANK_MM;
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
        argus_give_up_turn(self);
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
    self->aimed = argus_all_fresh_since(&self->knowledge, argus_wanted_sonars(self), &self->motion.mark);
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
        argus_say(self, ARGUS_EV_GOAL_REACHED, ARGUS_NO_SONAR,
                  argus_task_goal_mm(&self->task, &self->knowledge));
        argus_decide(self);
    }
    return true;
}

static void blocked_ahead(argus_t *const self, const argus_event_id_t event, const int sonar,
                          const int32_t reading_mm) {
    argus_say(self, event, sonar, reading_mm);
    argus_halt(self);
    self->jog_mm = 0;
    argus_task_refuse(&self->task, &self->knowledge);
    argus_enter_checking(self, true);
}

static int nearest_forward(const argus_knowledge_t *const knowledge) {
    int nearest = -1;
    for (int i = 0; i < knowledge->sonars; i++) {
        if (argus_robot_faces_forward(knowledge->robot, i) && knowledge->sonar[i].reported &&
            !argus_is_out(knowledge, i) &&
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
    if (argus_judges(self)) { // a suspect that could not be cleared is covered for like one that is out
        self->awareness.verified &= argus_with_health(&self->knowledge, ARGUS_SUSPECT);
    } else {
        argus_awareness_moved(&self->awareness);
    }
    self->backed = 0;
    self->swing_again = false;
    self->wait_last = ARGUS_WAIT_NONE;
}

// Every sonar that looks ahead has been refreshed within two rounds of its array.
static bool sees_ahead(const argus_t *const self) {
    const uint32_t limit_ms = argus_two_rounds_ms(self);
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        const bool counts = !argus_is_out(&self->knowledge, i);
        if (counts && argus_age_ms(&self->knowledge, i, self->now_ms) > limit_ms) {
            return false;
        }
    }
    return true;
}

static bool is_heeded(argus_t *const self) {
    if (self->knowledge.still_sips == 0 || self->motion.kind != ARGUS_MOTION_MOVE || self->motion.settled) {
        self->heeded_ms = self->now_ms;
    }
    return self->now_ms - self->heeded_ms < UNHEEDED_MS;
}

// S3: a MOVE that ends where it should without us, renewed on each SIP.
static void drive_on(argus_t *const self) {
    const int32_t left_mm =
        self->jog_mm > 0 ? self->jog_mm : argus_task_leg_mm(&self->task, &self->knowledge);
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
    if (!is_heeded(self)) {
        argus_halt(self);
        argus_enter_waiting(self, ARGUS_WAIT_MOTORS);
        return;
    }
    argus_motion_move(&self->motion, &self->session.outbox, argus_min(left_mm, free_mm),
                      self->config.speed_mm_s, self->now_ms);
    moved_on(self);
    steer(self, left_mm);
}

static bool leg_is_over(argus_t *const self) {
    if (self->jog_mm > 0 || !self->task.has_leg) {
        return false;
    }
    const bool detour =
        self->task.avoiding && argus_task_leg_mm(&self->task, &self->knowledge) <= LEG_DONE_MM;
    const bool missed = self->aimed && off_bearing(self) > AIM_CDEG;
    self->task.has_leg = !detour;
    self->aimed = self->aimed && !missed;
    return detour;
}

void argus_run_driving(argus_t *const self) {
    if (!argus_may_translate(self)) {
        argus_stop(self, ARCOS_CMD_STOP);
        argus_enter_checking(self, true);
        return;
    }
    if ((self->jog_mm == 0 && make_progress(self)) || argus_health_check(self)) {
        return;
    }
    leg_is_over(self);
    if (!has_way(self) || !aim(self)) {
        return;
    }
    if (self->jog_mm > 0) { // one MOVE, then idle again
        argus_enter(self, ARGUS_MODE_STEPPING);
        argus_motion_move(
            &self->motion, &self->session.outbox,
            argus_min(self->jog_mm, argus_drive_free_mm(&self->knowledge, self->config.object_range_mm)),
            self->config.step_speed_mm_s, self->now_ms);
        return;
    }
    drive_on(self);
}

static void step_ahead(argus_t *const self) {
    const int32_t left_mm =
        self->jog_mm > 0 ? self->jog_mm : argus_task_leg_mm(&self->task, &self->knowledge);
    const int32_t step_mm = argus_min(left_mm, self->config.step_mm);
    argus_say(self, ARGUS_EV_STEP, ARGUS_NO_SONAR, step_mm);
    argus_enter(self, ARGUS_MODE_STEPPING);
    argus_motion_move(&self->motion, &self->session.outbox, step_mm, self->config.step_speed_mm_s,
                      self->now_ms);
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
    } else if (argus_open_suspects(self) != 0) { // S6: one that an operator wants looked at again
        argus_enter_checking(self, false);
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
        if (argus_all_fresh_since(&self->knowledge, argus_wanted_sonars(self), &self->motion.mark)) {
            judge_sweep(self);
        }
        return;
    }
    if (argus_sweep_step(&self->drive, &self->plan, &self->knowledge, &self->motion.mark) &&
        !self->drive.done) {
        argus_turn(self, argus_sweep_heading_cdeg(&self->drive, &self->plan));
    }
}

void argus_run_sweeping(argus_t *const self) {
    if (!argus_may_translate(self)) {
        argus_stop(self, ARCOS_CMD_STOP);
        argus_enter_checking(self, true);
        return;
    }
    if (self->has_base) {
        run_sweep(self);
        return;
    }
    if ((self->jog_mm == 0 && make_progress(self)) || argus_health_check(self)) {
        return;
    }
    leg_is_over(self);
    if (!has_way(self) || !aim(self)) {
        return;
    }
    argus_take_base(self);
    argus_sweep_begin(&self->drive, &self->plan, self->base_cdeg);
    argus_turn(self, argus_sweep_heading_cdeg(&self->drive, &self->plan));
}

void argus_run_stepping(argus_t *const self) {
    if (!self->motion.settled) {
        return;
    }
    self->jog_mm = 0;
    self->has_base = false;
    argus_decide(self);
}

void argus_run_backing(argus_t *const self) {
    if (self->motion.settled) {
        self->has_base = false;
        if (self->bumpers != 0) {
            argus_enter_waiting(self, ARGUS_WAIT_BUMPER);
        } else {
            argus_enter_checking(self, !argus_judges(self));
            self->all_round = argus_judges(self);
        }
    } else if (!argus_rear_is_watched(self)) {
        argus_halt(self);
    }
}
