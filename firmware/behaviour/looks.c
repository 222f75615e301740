// SPDX-License-Identifier: MIT
// Weighs a look against the stop that it costs.
#include "behaviour/looks.h"

#include "arcos/gen_arcos.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"

argus_mask_t argus_doubted(const argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    ARGUS_ASSERT(argus_rules(self)->evidence);
    unsigned mask = 0;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        mask |= argus_evidence_suspects(&self->evidence, i) ? 1u << i : 0u;
    }
    return (argus_mask_t)(mask & ~(unsigned)argus_out(&self->knowledge) & ~(unsigned)self->orders.pinned);
}

// Those in question: named, and not yet looked at here.
static unsigned open_names(const argus_t *const self) {
    return argus_named(&self->knowledge) & argus_open_suspects(self);
}

// Looks prove nothing of those that do not look ahead: after two they tell no more.
argus_mask_t argus_to_settle(const argus_t *const self) {
    if (self->looks.settling >= ARGUS_LOOKS_SETTLE_MOST) {
        return 0;
    }
    const unsigned proves = self->looks.settling < ARGUS_LOOKS_PROOFS_AT_GOAL
                                ? argus_robot_all(self->knowledge.robot)
                                : argus_robot_forward(self->knowledge.robot);
    return (argus_mask_t)(argus_named(&self->knowledge) & proves);
}

argus_mask_t argus_to_try(const argus_t *const self) {
    const argus_guard_t guard = argus_guard(self);
    const bool others = (self->knowledge.heard & ~(unsigned)argus_out(&self->knowledge)) != 0;
    const bool may = argus_rules(self)->evidence && argus_guard_may_turn(&guard) && !argus_is_stopped(self);
    const bool due = others && !self->looks.tried && !argus_guard_is_heard(&guard);
    return may && due ? (argus_mask_t)(argus_wanted_sonars(self) & ~(unsigned)self->orders.pinned) : 0;
}

// Those ahead that no other sonar sees for, and that were not cleared a moment ago.
static argus_mask_t alone(const argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    const argus_guard_t guard = argus_guard(self);
    const unsigned open = argus_guard_alone(&guard) & argus_open_suspects(self);
    unsigned mask = 0;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        mask |= (open >> i & 1u) != 0 && !argus_looks_hold(&self->looks, i, self->knowledge.odometer_mm)
                    ? 1u << i
                    : 0u;
    }
    return (argus_mask_t)mask;
}

// A sonar that is named ahead costs what the robot would drive faster without it.
void argus_count_loss(const argus_t *const self, argus_looks_t *const mine) {
    if ((open_names(self) & argus_robot_ahead(self->knowledge.robot)) == 0) {
        argus_looks_free(mine);
        return;
    }
    const argus_guard_t guard = argus_guard(self);
    const int32_t seen_mm = argus_guard_seen_mm(&guard);
    const int32_t free_mm_s = argus_guard_free_speed_mm_s(&guard, seen_mm);
    const int32_t lost_mm_s = free_mm_s - argus_guard_speed_mm_s(&guard, seen_mm);
    ARGUS_ASSERT(free_mm_s > 0 && lost_mm_s >= 0);
    argus_looks_lose(mine, lost_mm_s, free_mm_s);
}

// To hire or to buy: a look is bought when its cost has been lost to the doubt. So both together are never
// more than twice the cheaper one. Where no other sonar sees what a suspect may not, it is bought at once.
bool argus_look_pays(const argus_t *const self) {
    const argus_looks_t *const looks = &self->looks;
    const bool pays = looks->asked || alone(self) != 0 || argus_looks_cost(looks);
    if (!pays || self->orders.passive || argus_is_stopped(self)) {
        return false;
    }
    const argus_guard_t guard = argus_guard(self);
    return argus_guard_may_turn(&guard);
}

// A `slow` diagnosis once withdrawn is not reinstated: what stays is that others contradict it.
argus_fault_kind_t argus_named_kind(const argus_t *const self, const int sonar,
                                    const argus_finding_t *const finding) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->knowledge.sonars);
    const argus_fault_kind_t kind = finding->named;
    if (kind == ARGUS_KIND_NONE && finding->doubted) {
        return ARGUS_KIND_OFF; // it fails with the whole of its array
    }
    return kind == ARGUS_KIND_SLOW && self->looks.hold[sonar].slow_withdrawn ? ARGUS_KIND_WRONG : kind;
}
