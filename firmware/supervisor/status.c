// SPDX-License-Identifier: MIT
// What the manager shows of itself: a status copy, and its invariants.
#include <string.h>

#include "awareness/names.h"
#include "behaviour/state.h"

static void copy_sonars(const argus_t *const self, argus_status_t *const status) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const argus_sonar_t *const s = &self->knowledge.sonar[i];
        status->reading_mm[i] = s->reported ? s->reading_mm : 0;
        status->readings[i] = s->readings;
        status->age_ms[i] = argus_age_ms(&self->knowledge, i, self->now_ms);
        status->health[i] = (uint8_t)s->health;
        status->kind[i] = (uint8_t)s->kind;
    }
    for (int i = 0; i < self->knowledge.sonars; i++) {
        status->bearing_deg[i] = argus_robot_pose(argus_robot_built(self->knowledge.robot), i).heading_deg;
    }
    status->sonars = self->knowledge.sonars;
    status->forward = argus_robot_forward(self->knowledge.robot);
}

// Which end leads is our affair: outside, ahead is where the robot is built to drive.
static void copy_motion(const argus_knowledge_t *const from, argus_status_t *const status) {
    const argus_wheels_t wheels = argus_built_wheels(from);
    const uint16_t bumpers = argus_built_bumpers(from);
    status->reversed = from->robot->reversed;
    status->pose = from->pose;
    status->pose.heading_cdeg = argus_built_heading_cdeg(from);
    status->vel_left_mm_s = (int16_t)wheels.left_mm_s;
    status->vel_right_mm_s = (int16_t)wheels.right_mm_s;
    status->bumpers_front = (uint8_t)(bumpers >> 8);
    status->bumpers_rear = (uint8_t)(bumpers & 0xFFu);
}

static void copy_robot(const argus_knowledge_t *const from, argus_status_t *const status) {
    copy_motion(from, status);
    status->battery_dv = from->battery_dv;
    status->flags = from->flags;
    status->motors = (from->flags & ARCOS_FLAG_MOTORS) != 0;
    status->lists_all = from->lists_all;
    status->sips = from->sips;
}

static void copy_session(const argus_session_t *const from, argus_status_t *const status) {
    status->open = argus_session_is_open(from);
    status->packets = from->parser.packets;
    status->bad_checksums = from->parser.bad_checksums;
    status->skipped_bytes = from->parser.skipped_bytes;
    status->robot_name = from->name;
    status->robot_class = from->robot_class;
    status->robot_subclass = from->subclass;
    status->has_configpac = from->has_robot;
    status->robot_version = from->robot.version;
    status->robot_serial = from->robot.serial;
    status->robot_watchdog_ms = from->robot.watchdog_ms;
    status->robot_sonar_cycle_ms = from->robot.sonar_cycle_ms;
}

void argus_status(const argus_t *const self, argus_status_t *const status) {
    memset(status, 0, sizeof *status);
    copy_sonars(self, status);
    copy_robot(&self->knowledge, status);
    copy_session(&self->session, status);
    status->mode = (uint8_t)self->mode;
    status->mission = (uint8_t)self->mission;
    status->wait = self->mode == ARGUS_MODE_WAITING ? (uint8_t)self->waiting.why : ARGUS_WAIT_NONE;
    status->bar = (uint8_t)self->orders.bar;
    status->failure = self->events.state;
    status->plan = self->plan;
    status->goal_mm = argus_task_goal_mm(&self->travel.task, &self->knowledge);
    status->waypoint = self->travel.task.next;
    status->waypoints = self->travel.task.count;
    status->active = !self->orders.passive;
    status->paused = self->orders.paused;
    status->online = status->open && !self->stalled;
    status->pinned = self->orders.pinned;
    status->stops = self->stops;
    status->robot_body = self->knowledge.robot->name;
}

// A sonar that is out has had its verdict, by the evidence or by something else.
static void copy_suspicion(const argus_t *const self, const int sonar, argus_suspicions_t *const to) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    to->kind[sonar] = (uint8_t)argus_names_best(&self->evidence, sonar, &to->percent[sonar]);
    to->against[sonar] = self->evidence.of[sonar].against;
    if (s->kind != ARGUS_KIND_NONE) {
        to->kind[sonar] = (uint8_t)s->kind;
        to->percent[sonar] = s->health == ARGUS_DISABLED ? 100 : to->percent[sonar];
    }
}

void argus_suspicions(const argus_t *const self, argus_suspicions_t *const suspicions) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    memset(suspicions, 0, sizeof *suspicions);
    if (!argus_rules(self)->evidence) {
        return;
    }
    for (int i = 0; i < self->knowledge.sonars; i++) {
        copy_suspicion(self, i, suspicions);
    }
}

static bool queues_hold(const argus_t *const self) {
    return self->events.count <= ARGUS_EVENT_QUEUE && self->events.head < ARGUS_EVENT_QUEUE &&
           self->session.outbox.length <= ARGUS_OUTBOX_BYTES &&
           self->session.parser.length <= ARGUS_FRAME_TOTAL_MAX;
}

static bool task_holds(const argus_t *const self) {
    return self->travel.task.count <= ARGUS_WAYPOINTS_MAX &&
           self->travel.task.next <= self->travel.task.count && self->echoes.count <= ARGUS_POINTS_MAX &&
           self->echoes.next < ARGUS_POINTS_MAX;
}

static bool plan_holds(const argus_t *const self) {
    return self->plan.count <= ARGUS_ROTATIONS_MAX &&
           (self->plan.disabled & ~(unsigned)argus_robot_forward(self->knowledge.robot)) == 0;
}

// S1 and S6: nothing translates before a full check; normal driving only while no bearing is blind.
static bool driving_holds(const argus_t *const self) {
    const bool driving = self->mode == ARGUS_MODE_DRIVING;
    const bool stepping = self->mode == ARGUS_MODE_STEPPING;
    const argus_guard_t guard = argus_guard(self);
    if (self->mode == ARGUS_MODE_CREEPING) {
        return self->checked && self->config.creep_mm_s > 0 && !self->orders.passive;
    }
    if (!driving && !stepping) {
        return true;
    }
    return self->checked && !self->orders.passive &&
           (stepping ? argus_guard_may_step(&self->plan) : argus_guard_may_drive(&guard, &self->plan));
}

// Those beyond the robot's are ABSENT, and only what is or may be out has the kind of a fault.
static bool is_sound(const argus_t *const self, const int sonar) {
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const bool whole =
        s->health != ARGUS_SUSPECT && s->health != ARGUS_DISABLED && s->health != ARGUS_PROBATION;
    const bool absent = s->health == ARGUS_ABSENT;
    const bool named = s->kind != ARGUS_KIND_NONE;
    return (absent || sonar < self->knowledge.sonars) && s->health <= ARGUS_ABSENT && !(whole && named) &&
           (named || s->health != ARGUS_DISABLED);
}

static bool health_holds(const argus_t *const self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (!is_sound(self, i)) {
            return false;
        }
    }
    return argus_failure_of(self->knowledge.robot, argus_out(&self->knowledge)) == self->events.state;
}

int argus_invariants_broken(const argus_t *const self) {
    const bool holds[] = {queues_hold(self), task_holds(self), plan_holds(self), driving_holds(self),
                          health_holds(self)};
    for (int i = 0; i < (int)(sizeof holds / sizeof holds[0]); i++) {
        if (!holds[i]) {
            return i + 1;
        }
    }
    return 0;
}
