// SPDX-License-Identifier: MIT
// Takes sonars out of use, flags suspects, and keeps failure state, plan and firing order in step.
#include "supervisor/faults.h"

#include <string.h>

#include "behaviour/state.h"
#include "knowledge/angle.h"
#include "supervisor/journey.h"

void argus_share_slots(const argus_t *const self, argus_outbox_t *const out, argus_firing_t *const firing) {
    if (argus_is_active(self) && argus_is_open(self)) {
        argus_firing_share(firing, &self->knowledge, argus_rules(self)->evidence != 0, out, self->now_ms);
    }
}

static void emit_plan(argus_events_t *const events, const argus_plan_t *const before,
                      const argus_plan_t *const plan) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    if (before->disabled == plan->disabled && before->count == plan->count &&
        memcmp(before->rotation_deg, plan->rotation_deg, sizeof plan->rotation_deg) == 0) {
        return;
    }
    argus_emit(events, ARGUS_EV_PLAN, plan->count);
    for (int i = 0; i < plan->count; i++) {
        argus_emit(events, ARGUS_EV_PLAN_ROTATION, plan->rotation_deg[i]);
    }
}

static argus_mask_t living(const argus_t *const self) {
    return argus_living(&self->knowledge, (uint32_t)self->config.stale_ms, self->now_ms);
}

// Suspects that are covered for like those that are out. Under profile argus these are the named ones that no
// other sonar sees for. Under paper they are those that no witness could judge. One that is still to be
// verified needs none, as nothing moves ahead before it is.
static argus_mask_t covered_suspects(const argus_t *const self) {
    if (argus_rules(self)->evidence) {
        const argus_guard_t guard = argus_guard(self);
        return argus_guard_alone(&guard);
    }
    return (argus_mask_t)(self->algorithm1.verified & argus_with_health(&self->knowledge, ARGUS_SUSPECT) &
                          argus_robot_forward(self->knowledge.robot));
}

static argus_plan_t plan_for(const argus_t *const self, const argus_mask_t blind) {
    return argus_plan(self->knowledge.robot, argus_policy(self), blind, living(self));
}

// Doubt never leaves the robot without a plan that it has without. With the ring others may look by now.
void argus_replan(argus_t *const self) {
    const argus_mask_t disabled = argus_out(&self->knowledge) & argus_robot_forward(self->knowledge.robot);
    const argus_mask_t blind = (argus_mask_t)(disabled | covered_suspects(self));
    const uint8_t failure = (uint8_t)argus_failure_of(self->knowledge.robot, argus_out(&self->knowledge));
    const argus_plan_t before = self->plan;
    if (failure != self->events.state) {
        self->events.state = failure;
        const argus_mask_t front = argus_robot_forward(argus_robot_built(self->knowledge.robot));
        argus_emit(&self->events, ARGUS_EV_FAILURE_STATE,
                   argus_count_bits(argus_out(&self->knowledge) & front));
    }
    if (blind == before.disabled && (blind == 0 || !argus_plan_asks_ring(argus_policy(self)))) {
        return;
    }
    self->plan = plan_for(self, blind);
    if (!self->plan.complete && argus_rules(self)->evidence) {
        self->plan = plan_for(self, disabled);
    }
    emit_plan(&self->events, &before, &self->plan);
    if (before.disabled != self->plan.disabled) {
        argus_share_slots(self, &self->session.outbox, &self->firing);
    }
}

bool argus_keep_plan(const argus_t *const self, argus_plan_t *const plan, argus_events_t *const events) {
    if (plan->disabled == 0 || !argus_plan_asks_ring(argus_policy(self))) {
        return true;
    }
    const argus_plan_t before = *plan;
    const unsigned lives = living(self) & ~(unsigned)before.disabled;
    const unsigned needs = argus_plan_needs(self->knowledge.robot, &before);
    if ((needs & ~lives) != 0 || (!before.complete && lives != before.looks)) {
        *plan = plan_for(self, before.disabled);
        emit_plan(events, &before, plan);
    }
    return plan->complete;
}

// One that hears nothing has not told what was not there.
static bool has_lied(const argus_fault_kind_t kind) {
    return kind != ARGUS_KIND_OFF && kind != ARGUS_KIND_SILENT && kind != ARGUS_KIND_INTERMITTENT;
}

void argus_disable(argus_t *const self, const int sonar, const argus_fault_kind_t kind) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(kind != ARGUS_KIND_NONE);
    const argus_event_t said =
        argus_health_set(&self->knowledge, sonar, ARGUS_CHANGE_DISABLED, kind, (int32_t)kind, self->now_ms);
    argus_evidence_agree_anew(&self->evidence, sonar); // what brings it back comes after this
    argus_evidence_retract(&self->evidence, sonar);
    argus_echoes_forget(&self->echoes, sonar, has_lied(kind));
    argus_rays_forget(&self->rays, sonar);
    argus_journey_restart(&self->travel);
    argus_replan(self);
    argus_emit_event(&self->events, said); // after the plan that follows from it
}

void argus_watch(argus_knowledge_t *const knowledge, argus_events_t *const events,
                 const argus_mask_t sonars) {
    ARGUS_ASSERT((sonars & argus_robot_forward(knowledge->robot)) == 0);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((sonars >> i & 1u) == 0) {
            continue;
        }
        if (knowledge->sonar[i].health == ARGUS_STALE) {
            argus_emit_change(events, knowledge, i, ARGUS_CHANGE_HEARD, ARGUS_KIND_NONE, 0);
        } else {
            argus_emit_change(events, knowledge, i, ARGUS_CHANGE_STALLED, ARGUS_KIND_NONE,
                              (int32_t)(argus_silent_ms(knowledge, i) & 0x7FFFFFFFu));
        }
    }
}

void argus_flag_suspects(const argus_t *const self, argus_knowledge_t *const knowledge,
                         argus_events_t *const events, const argus_mask_t suspects) {
    ARGUS_ASSERT((suspects & ~(unsigned)argus_robot_all(knowledge->robot)) == 0);
    ARGUS_ASSERT((suspects & argus_out(knowledge)) == 0);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((suspects >> i & 1u) != 0 && knowledge->sonar[i].health != ARGUS_SUSPECT) {
            argus_emit_change(events, knowledge, i, ARGUS_CHANGE_SUSPECTED, ARGUS_KIND_NONE,
                              self->algorithm1.of[i].difference_mm);
        }
    }
}
