// SPDX-License-Identifier: MIT
// Saves and loads the record, and takes back what belongs to another robot.
#include "supervisor/history.h"

#include "analysis/record.h"
#include "behaviour/state.h"
#include "supervisor/faults.h"

static uint32_t robot_of(const argus_t *const self) {
    const argus_session_t *const session = &self->session;
    return argus_record_robot(session->name, session->robot_class, session->subclass);
}

size_t argus_record_save(const argus_t *const self, uint8_t *const buffer, const size_t capacity) {
    return argus_record_encode(&self->knowledge, &self->evidence, self->history.robot, buffer, capacity);
}

// What failed last time may have been repaired: it comes back on evidence, like one that failed in this
// mission.
static void put_on_probation(argus_history_t *const history, argus_knowledge_t *const knowledge,
                             argus_events_t *const events, const argus_mask_t sonars) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((sonars >> i & 1u) == 0 || argus_is_out(knowledge, i)) {
            continue;
        }
        const argus_fault_kind_t before = knowledge->sonar[i].kind_before;
        const argus_fault_kind_t kind = before == ARGUS_KIND_NONE ? ARGUS_KIND_WRONG : before;
        history->recorded |= (argus_mask_t)(1u << i);
        argus_emit_change(events, knowledge, i, ARGUS_CHANGE_RECORDED, kind, 0);
    }
}

// The robot was not known when the record was read.
static void take_back(argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    ARGUS_ASSERT(self->history.loaded);
    argus_record_forget(&self->knowledge, &self->evidence);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const argus_sonar_t *const s = &self->knowledge.sonar[i];
        if ((self->history.recorded >> i & 1u) != 0 && s->health == ARGUS_PROBATION) {
            argus_emit_change(&self->events, &self->knowledge, i, ARGUS_CHANGE_FORGOTTEN, ARGUS_KIND_NONE, 0);
        }
    }
    self->history.recorded = 0;
    argus_emit(&self->events, ARGUS_EV_RECORD_IGNORED, ARGUS_RECORD_OTHER_ROBOT);
    argus_replan(self);
}

void argus_meet_robot(argus_t *const self) {
    ARGUS_ASSERT(argus_is_open(self));
    const uint32_t robot = robot_of(self);
    if (self->history.loaded && self->history.robot != 0 && self->history.robot != robot) {
        take_back(self);
    }
    self->history.loaded = false;
    self->history.robot = robot;
}

bool argus_record_load(argus_t *const self, const uint8_t *const record, const size_t length) {
    argus_record_note_t note;
    const argus_record_fault_t fault =
        argus_record_decode(&self->knowledge, &self->evidence, &note, record, length);
    if (fault != ARGUS_RECORD_OK) {
        argus_emit(&self->events, ARGUS_EV_RECORD_IGNORED, (int32_t)fault);
        return false;
    }
    self->history.loaded = true;
    self->history.robot = note.robot;
    if (argus_rules(self)->evidence) {
        put_on_probation(&self->history, &self->knowledge, &self->events, note.out);
        argus_replan(self);
    }
    if (argus_is_open(self)) {
        argus_meet_robot(self);
    }
    return true;
}
