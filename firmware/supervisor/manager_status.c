// SPDX-License-Identifier: MIT
// What the manager shows of itself: a status copy, its invariants, names.
#include <string.h>

#include "supervisor/manager_internal.h"

static void copy_sonars(const argus_t *const self, argus_status_t *const status) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const argus_sonar_t *const s = &self->knowledge.sonar[i];
        status->reading_mm[i] = s->reported ? (int16_t)(s->reading_mm & 0x7FFF) : 0;
        status->age_ms[i] = argus_age_ms(&self->knowledge, i, self->now_ms);
        status->health[i] = s->health;
        status->kind[i] = s->kind;
    }
}

static void copy_robot(const argus_knowledge_t *const from, argus_status_t *const status) {
    status->pose = from->pose;
    status->battery_dv = from->battery_dv;
    status->vel_left_mm_s = from->vel_left_mm_s;
    status->vel_right_mm_s = from->vel_right_mm_s;
    status->flags = from->flags;
    status->bumpers_front = from->bumpers_front;
    status->bumpers_rear = from->bumpers_rear;
    status->sips = from->sips;
}

void argus_status(const argus_t *const self, argus_status_t *const status) {
    memset(status, 0, sizeof *status);
    copy_sonars(self, status);
    copy_robot(&self->knowledge, status);
    status->mode = self->mode;
    status->mission = self->mission;
    status->failure = self->failure;
    status->plan = self->plan;
    status->goal_mm = argus_task_goal_mm(&self->task, &self->knowledge);
    status->waypoint = self->task.next;
    status->waypoints = self->task.count;
    status->active = !self->passive;
    status->online = argus_session_is_open(&self->session) && !self->stalled;
    status->bad_checksums = self->session.parser.bad_checksums;
    status->skipped_bytes = self->session.parser.skipped_bytes;
    status->stops = self->stops;
    status->robot_name = self->session.name;
    status->robot_class = self->session.robot_class;
    status->robot_subclass = self->session.subclass;
    status->body = argus_robot_choice(self->knowledge.robot);
    status->sonars = self->knowledge.sonars;
}

static bool queues_hold(const argus_t *const self) {
    return self->events.count <= ARGUS_EVENT_QUEUE && self->events.head < ARGUS_EVENT_QUEUE &&
           self->session.outbox.length <= ARGUS_OUTBOX_BYTES &&
           self->session.parser.length <= ARGUS_FRAME_TOTAL_MAX;
}

static bool task_holds(const argus_t *const self) {
    return self->task.count <= ARGUS_WAYPOINTS_MAX && self->task.next <= self->task.count &&
           self->task.seen_count <= ARGUS_POINTS_MAX && self->task.seen_next < ARGUS_POINTS_MAX;
}

static bool plan_holds(const argus_t *const self) {
    return self->plan.count <= ARGUS_ROTATIONS_MAX &&
           (self->plan.disabled & ~(unsigned)ARGUS_FORWARD_MASK) == 0;
}

// S1 and S6: nothing translates before a full check; normal driving only while no bearing is blind.
static bool driving_holds(const argus_t *const self) {
    const bool driving = self->mode == ARGUS_MODE_DRIVING;
    const bool stepping = self->mode == ARGUS_MODE_STEPPING;
    if (!driving && !stepping) {
        return true;
    }
    return self->checked && !self->passive && (stepping || self->plan.disabled == 0) &&
           (self->plan.disabled == 0 || self->plan.complete);
}

static bool health_holds(const argus_t *const self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const argus_sonar_t *const s = &self->knowledge.sonar[i];
        const bool whole =
            s->health != ARGUS_SUSPECT && s->health != ARGUS_DISABLED && s->health != ARGUS_PROBATION;
        if (s->health > ARGUS_ABSENT || (s->health == ARGUS_DISABLED && s->kind == ARGUS_KIND_NONE) ||
            (whole && s->kind != ARGUS_KIND_NONE)) {
            return false;
        }
    }
    return argus_failure_of(self->knowledge.robot, argus_out(&self->knowledge)) == self->failure;
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

const char *argus_mode_name(const argus_mode_t mode) {
    static const char name[][16] = {"OFFLINE",  "CHECKING", "VERIFYING", "IDLE",    "DRIVING", "SWEEPING",
                                    "STEPPING", "BACKING",  "WAITING",   "CLOSING", "CLOSED"};
    return (unsigned)mode < sizeof name / sizeof name[0] ? name[mode] : "?";
}

const char *argus_mission_name(const argus_mission_t mission) {
    static const char name[][16] = {"none", "running", "reached", "failed"};
    return (unsigned)mission < sizeof name / sizeof name[0] ? name[mission] : "?";
}
