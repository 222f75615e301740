// SPDX-License-Identifier: MIT
// Compares the two ends of the robot.
#include "behaviour/reverse.h"

#include "behaviour/state.h"
#include "knowledge/angle.h"

#define AGAIN_MM 2000u // driven since the last time
#define MOST_PARTS 3   // two of three of those that face forward are most of them
#define LOOKS_MM 50u   // an end that leads has not set off
#define OTHER_LOST 1   // ... and so many the other end may have lost to be better than that

// Those of this end that face forward and are not relied on.
static argus_mask_t lost_of(const argus_t *const self, const argus_robot_t *const end) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    const argus_mask_t forward = argus_robot_forward(end);
    unsigned lost = 0;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const bool counts = (forward >> i & 1u) != 0 && !argus_trusted(&self->knowledge, i);
        lost |= counts ? 1u << i : 0u;
    }
    return (argus_mask_t)lost;
}

// How many; all while none of them has heard an echo in this session, nor for as long as an end leads
// without.
static int lost_count(const argus_t *const self, const argus_robot_t *const end) {
    const argus_mask_t forward = argus_robot_forward(end);
    const bool unheard = (self->knowledge.heard & forward) == 0 ||
                         argus_unheard_mm(&self->knowledge, argus_robot_leading(end)) >= ARGUS_LEAD_MM;
    return argus_count_bits(argus_rules(self)->asks_echo && unheard ? forward : lost_of(self, end));
}

static bool is_safe(const argus_t *const self, const argus_robot_t *const end) {
    return argus_config_check_for(&self->config, end).fault == ARGUS_CONFIG_OK;
}

static bool has_driven(const argus_t *const self) {
    const argus_reverse_t *const mine = &self->reverse;
    return !mine->done || self->knowledge.odometer_mm - mine->odometer_mm >= AGAIN_MM;
}

static bool can_go_on(const argus_t *const self, const argus_robot_t *const end) {
    const argus_mask_t lost = lost_of(self, end);
    const argus_mask_t living = (argus_mask_t)(argus_robot_forward(end) & ~(unsigned)lost);
    const argus_plan_t plan = argus_plan(end, argus_policy(self), lost, living);
    return argus_guard_may_step(&plan);
}

// Ends that hear nothing lead in turn: of a dead one and a living one, the one sees where the other drives.
// What this one has touched shows nothing of the other, but one that may creep has a bumper to go by.
static bool is_its_turn(const argus_t *const self, const argus_robot_t *const other) {
    const argus_guard_t guard = argus_guard(self);
    const bool touched = argus_is_shown_blind(self, &guard) && !guard.creeps;
    return (touched || argus_guard_has_led(&guard)) && argus_count_bits(lost_of(self, other)) <= OTHER_LOST;
}

static bool is_better(const argus_t *const self, const argus_robot_t *const other) {
    const argus_robot_t *const lead = self->knowledge.robot;
    const int lost = lost_count(self, lead);
    const int other_lost = lost_count(self, other);
    if (lead->reversed && other_lost == 0) {
        return true;
    }
    return lost * MOST_PARTS >= lead->forward_count * 2 && other_lost <= OTHER_LOST;
}

bool argus_should_turn_about(const argus_t *const self) {
    const argus_robot_t *const other = argus_robot_other_end(self->knowledge.robot);
    const bool may = argus_rules(self)->may_reverse && argus_is_active(self) && self->travel.jog_mm == 0;
    if (other == NULL || !may) {
        return false;
    }
    const bool pays = argus_guard_may_step(&self->plan)
                          ? is_its_turn(self, other) || (has_driven(self) && is_better(self, other))
                          : can_go_on(self, other);
    return pays && is_safe(self, other); // the costliest question last
}

static bool hears_ahead(const argus_t *const self) {
    const unsigned ahead = argus_robot_forward(self->knowledge.robot);
    bool hears = false;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        hears = hears || ((ahead >> i & 1u) != 0 && argus_usable(&self->knowledge, i));
    }
    return hears;
}

bool argus_should_hand_back(const argus_t *const self) {
    const argus_robot_t *const lead = self->knowledge.robot;
    const argus_robot_t *const front = argus_robot_other_end(lead);
    const uint32_t led_mm = self->knowledge.odometer_mm - self->reverse.odometer_mm;
    if (front == NULL || !lead->reversed || led_mm > LOOKS_MM ||
        argus_count_bits(lost_of(self, front)) > OTHER_LOST) {
        return false;
    }
    const bool lives = argus_unheard_mm(&self->knowledge, argus_robot_leading(front)) <= led_mm;
    return argus_rules(self)->asks_echo && (lives || !hears_ahead(self)) && is_safe(self, front);
}
