// SPDX-License-Identifier: MIT
// Draws the conclusions of a health check (paper: Analysis).
#include "supervisor/check.h"

#include "knowledge/angle.h"
#include "supervisor/faults.h"
#include "supervisor/looks.h"
#include "supervisor/state.h"

static void declare_healthy(argus_knowledge_t *const knowledge, argus_events_t *const events) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        const argus_sonar_t *const s = &knowledge->sonar[i];
        if (s->reported && (s->health == ARGUS_UNKNOWN || s->health == ARGUS_STALE)) {
            argus_emit_change(events, knowledge, i, ARGUS_CHANGE_JUDGED, ARGUS_KIND_NONE, s->reading_mm);
        }
    }
}

static argus_mask_t find_suspects(const argus_t *const self, argus_algorithm1_t *const algorithm1) {
    if (argus_rules(self)->evidence) {
        return (argus_mask_t)(argus_doubted(self) | argus_open_suspects(self));
    }
    return argus_rules(self)->disparity
               ? argus_algorithm1_suspects(algorithm1, &self->knowledge, &self->config)
               : 0;
}

// The paper verifies every suspect at once; elsewhere a look must pay.
static bool is_look_due(const argus_t *const self, const argus_mask_t suspects) {
    return argus_rules(self)->evidence ? argus_look_pays(self) : suspects != 0;
}

static void verify(const argus_mask_t suspects, argus_intent_t *const intent) {
    intent->act = ARGUS_DO_VERIFY;
    intent->sonars = suspects;
}

void argus_conclude_check(argus_t *const self, argus_intent_t *const intent) {
    ARGUS_ASSERT(self->mode == ARGUS_MODE_CHECKING);
    const argus_mask_t suspects =
        (argus_mask_t)(find_suspects(self, &self->algorithm1) | argus_open_suspects(self));
    argus_flag_suspects(self, &self->knowledge, &self->events, suspects);
    argus_looks_checked(&self->looks, self->now_ms);
    if (is_look_due(self, suspects) && !self->orders.passive && !argus_is_stopped(self)) {
        verify(suspects, intent);
        return;
    }
    declare_healthy(&self->knowledge, &self->events);
    argus_replan(self);
    self->checked = true;
    argus_emit(&self->events, ARGUS_EV_HEALTH_CHECK, argus_count_bits(argus_out(&self->knowledge)));
    intent->act = ARGUS_DO_DECIDE;
}

static bool is_due(const argus_t *const self) {
    return argus_rules(self)->evidence ||
           self->now_ms - self->looks.check_ms >= (uint32_t)self->config.health_check_ms;
}

// A robot that may not turn cannot verify: there a suspicion lasts as long as the disparity.
static void drop_suspicions(const argus_t *const self, argus_knowledge_t *const knowledge,
                            argus_events_t *const events) {
    ARGUS_ASSERT(self->orders.passive);
    for (int i = 0; i < knowledge->sonars; i++) {
        if (argus_robot_faces_forward(knowledge->robot, i) && knowledge->sonar[i].health == ARGUS_SUSPECT &&
            self->algorithm1.of[i].in_a_row == 0) {
            argus_emit_change(events, knowledge, i, ARGUS_CHANGE_DROPPED, ARGUS_KIND_NONE, 0);
        }
    }
}

// While the course is paused nothing is looked at, but before an operator's step (S6).
static bool may_verify(const argus_t *const self) {
    return !self->orders.passive && !(self->orders.paused && self->mode == ARGUS_MODE_IDLE);
}

void argus_check_beside(argus_t *const self, argus_intent_t *const intent) {
    ARGUS_ASSERT(self->mode != ARGUS_MODE_VERIFYING && self->mode != ARGUS_MODE_CHECKING);
    if (!is_due(self)) {
        return;
    }
    argus_looks_checked(&self->looks, self->now_ms);
    const argus_mask_t suspects = find_suspects(self, &self->algorithm1);
    if (argus_rules(self)->evidence && self->mode == ARGUS_MODE_DRIVING) {
        argus_count_loss(self, &self->looks);
    }
    if (self->orders.passive && argus_rules(self)->disparity) {
        drop_suspicions(self, &self->knowledge, &self->events);
    }
    argus_flag_suspects(self, &self->knowledge, &self->events, suspects);
    if (may_verify(self) && is_look_due(self, suspects)) {
        verify(suspects, intent);
    }
}

static void emit_witnesses(argus_events_t *const events, const argus_verify_t *const verify) {
    for (int side = 0; side < 2; side++) {
        if ((verify->heard >> side & 1) != 0) {
            argus_emit_of(events, ARGUS_EV_SONAR_WITNESS, verify->by[side], verify->witness_mm[side]);
        }
    }
}

void argus_apply_verdict(argus_t *const self) {
    ARGUS_ASSERT(self->verifying.verify.phase == ARGUS_VERIFY_DONE);
    ARGUS_ASSERT(self->verifying.verify.result != ARGUS_RESULT_NONE);
    const argus_verify_t *const verify = &self->verifying.verify;
    const int sonar = verify->sonar;
    emit_witnesses(&self->events, verify);
    switch (verify->result) {
    case ARGUS_RESULT_CONVICTED:
        argus_disable(self, sonar, ARGUS_KIND_WRONG);
        break;
    case ARGUS_RESULT_CLEARED:
        argus_algorithm1_cleared(&self->algorithm1, &self->knowledge, sonar, verify->difference_mm);
        argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_CLEARED, ARGUS_KIND_NONE,
                          verify->mean_mm);
        break;
    case ARGUS_RESULT_DROPPED:
        argus_algorithm1_dropped(&self->algorithm1, sonar);
        argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_DROPPED, ARGUS_KIND_NONE,
                          verify->difference_mm);
        break;
    case ARGUS_RESULT_UNPROVEN:
        argus_algorithm1_settle(&self->algorithm1, sonar);
        argus_emit_of(&self->events, ARGUS_EV_SONAR_UNPROVEN, sonar, verify->reading_mm);
        break;
    case ARGUS_RESULT_NONE:
    default:
        break;
    }
}
