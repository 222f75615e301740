// SPDX-License-Identifier: MIT
// What outlives a mission, what is foretold from it, and what an operator does to one sonar.
#include "analysis/record.h"
#include "supervisor/manager_internal.h"

static uint32_t robot_of(const argus_t *const self) {
    const argus_session_t *const session = &self->session;
    return argus_record_robot(session->name, session->robot_class, session->subclass);
}

size_t argus_record_save(const argus_t *const self, uint8_t *const buffer, const size_t capacity) {
    return argus_record_encode(&self->knowledge, &self->evidence, self->robot, buffer, capacity);
}

// What failed last time may have been repaired: it comes back on evidence, like one that failed in this
// mission.
static void put_on_probation(argus_t *const self, const argus_mask_t sonars) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        argus_sonar_t *const s = &self->knowledge.sonar[i];
        if ((sonars >> i & 1u) == 0 || argus_is_out(&self->knowledge, i)) {
            continue;
        }
        const argus_fault_kind_t kind = s->kind_before == ARGUS_KIND_NONE ? ARGUS_KIND_WRONG : s->kind_before;
        argus_sonar_set_health(s, ARGUS_PROBATION, kind, self->now_ms);
        self->recorded |= (argus_mask_t)(1u << i);
        argus_say(self, ARGUS_EV_SONAR_PROBATION, i, 0);
    }
    argus_replan(self);
}

static void refuse(argus_t *const self, const argus_record_fault_t fault) {
    argus_say(self, ARGUS_EV_RECORD_IGNORED, ARGUS_NO_SONAR, (int32_t)fault);
}

// The robot was not known when the record was read.
static void take_back(argus_t *const self) {
    argus_record_forget(&self->knowledge, &self->evidence);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        argus_sonar_t *const s = &self->knowledge.sonar[i];
        if ((self->recorded >> i & 1u) != 0 && s->health == ARGUS_PROBATION) {
            argus_sonar_set_health(s, ARGUS_UNKNOWN, ARGUS_KIND_NONE, self->now_ms);
        }
    }
    self->recorded = 0;
    refuse(self, ARGUS_RECORD_OTHER_ROBOT);
    argus_replan(self);
}

void argus_meet_robot(argus_t *const self) {
    const uint32_t robot = robot_of(self);
    if (self->loaded && self->robot != 0 && self->robot != robot) {
        take_back(self);
    }
    self->loaded = false;
    self->robot = robot;
}

bool argus_record_load(argus_t *const self, const uint8_t *const record, const size_t length) {
    argus_record_note_t note;
    const argus_record_fault_t fault =
        argus_record_decode(&self->knowledge, &self->evidence, &note, record, length);
    if (fault != ARGUS_RECORD_OK) {
        refuse(self, fault);
        return false;
    }
    self->loaded = true;
    self->robot = note.robot;
    if (argus_judges(self)) {
        put_on_probation(self, note.out);
    }
    if (argus_session_is_open(&self->session)) {
        argus_meet_robot(self);
    }
    return true;
}

void argus_foretell(argus_t *const self) {
    if (!argus_judges(self)) {
        return;
    }
    const int sonar = argus_trend_news(&self->evidence.trend, &self->knowledge);
    if (sonar >= 0) {
        argus_say(self, ARGUS_EV_SONAR_DEGRADING, sonar, argus_trend_horizon_m(&self->evidence.trend, sonar));
    }
}

// One in use becomes a suspect that the next health check looks at; one that is out begins its probation
// anew, with its relapses forgiven, since nothing but evidence brings it back.
static void begin_retest(argus_t *const self, const int sonar) {
    argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const argus_mask_t bit = (argus_mask_t)(1u << sonar);
    argus_evidence_forget(&self->evidence, sonar);
    argus_trend_forget(&self->evidence.trend, sonar);
    self->hold[sonar].acquittals = 0;
    self->awareness.verified &= (argus_mask_t) ~(unsigned)bit;
    if (argus_is_out(&self->knowledge, sonar)) {
        s->relapses = 0;
        argus_sonar_set_health(s, ARGUS_PROBATION, s->kind, self->now_ms);
        argus_say(self, ARGUS_EV_SONAR_PROBATION, sonar, s->reading_mm);
        self->looked_once = false; // a look at all comes with the check
    } else {
        self->evidence.lost |= bit;
        argus_flag_suspects(self, bit);
    }
}

static bool may_serve(const argus_t *const self, const argus_op_t op, const int32_t sonar) {
    if (sonar < 0 || sonar >= self->knowledge.sonars || op > ARGUS_OP_DISABLE) {
        return false;
    }
    const bool pinned = (self->pinned >> sonar & 1u) != 0;
    if (op == ARGUS_OP_RETEST) {
        return argus_session_is_open(&self->session) && !pinned;
    }
    return argus_judges(self) && pinned == (op == ARGUS_OP_UNPIN);
}

static void retest(argus_t *const self, const int sonar) {
    self->stay = false; // the others order no motion
    if (argus_judges(self)) {
        begin_retest(self, sonar);
    } else {
        argus_awareness_init(&self->awareness);
    }
    argus_stop(self, ARCOS_CMD_STOP);
    argus_enter_checking(self, true);
}

static void pin(argus_t *const self, const int sonar, const bool on) {
    const unsigned bit = 1u << sonar;
    self->pinned = (argus_mask_t)(on ? self->pinned | bit : self->pinned & ~bit);
    argus_say(self, ARGUS_EV_SONAR_PINNED, sonar, on ? 1 : 0);
}

static void take_out(argus_t *const self, const int sonar) {
    if (self->knowledge.sonar[sonar].health != ARGUS_DISABLED) {
        argus_disable(self, sonar, ARGUS_KIND_WRONG);
    }
    pin(self, sonar, true);
    if (argus_session_is_open(&self->session)) {
        argus_enter_checking(self, false);
    }
}

bool argus_serve(argus_t *const self, const argus_op_t op, const int32_t sonar) {
    if (!may_serve(self, op, sonar)) {
        return false;
    }
    argus_say(self, ARGUS_EV_OPERATOR, ARGUS_NO_SONAR, (int32_t)op);
    if (op == ARGUS_OP_RETEST) {
        retest(self, sonar);
    } else if (op == ARGUS_OP_DISABLE) {
        take_out(self, sonar);
    } else {
        pin(self, sonar, op == ARGUS_OP_PIN);
    }
    return true;
}
