// SPDX-License-Identifier: MIT
// Counts the disparities that make a suspect, and holds off one that Algorithm 2 has cleared.
#include "paper/algorithm1.h"

#include <string.h>

#include "knowledge/angle.h"

void argus_algorithm1_init(argus_algorithm1_t *const self) {
    memset(self, 0, sizeof *self);
}

void argus_algorithm1_restart(argus_algorithm1_t *const self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->of[i].in_a_row = 0;
    }
    self->verified = 0;
}

void argus_algorithm1_moved(argus_algorithm1_t *const self, const argus_mask_t kept) {
    self->verified &= kept;
}

void argus_algorithm1_reopen(argus_algorithm1_t *const self, const argus_mask_t sonars) {
    self->verified &= (argus_mask_t) ~(unsigned)sonars;
}

void argus_algorithm1_settle(argus_algorithm1_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->verified |= (argus_mask_t)(1u << sonar);
}

void argus_algorithm1_dropped(argus_algorithm1_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->of[sonar].in_a_row = 0;
}

void argus_algorithm1_cleared(argus_algorithm1_t *const self, const argus_knowledge_t *const knowledge,
                              const int sonar, const int32_t difference_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_disparate_t *const d = &self->of[sonar];
    d->held = true;
    d->held_odometer_mm = knowledge->odometer_mm;
    d->held_heading_cdeg = knowledge->pose.heading_cdeg;
    d->held_difference_mm = difference_mm;
    d->in_a_row = 0;
    self->verified |= (argus_mask_t)(1u << sonar);
}

// While the robot rotates the ring's readings belong to different headings: no verdict then. What it sees
// while it is turned away counts neither for nor against.
static void count_disparity(argus_algorithm1_t *const self, const argus_knowledge_t *const knowledge,
                            const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_disparate_t *const d = &self->of[sonar];
    const bool repeated = knowledge->lists_all && knowledge->sip_ms - d->counted_ms < ARGUS_REFRESH_MS;
    if (repeated) {
        return;
    }
    d->counted_ms = knowledge->sip_ms;
    int32_t difference = 0;
    const argus_verdict_t verdict =
        knowledge->rotating ? ARGUS_NO_VERDICT : argus_disparity(knowledge, sonar, &difference);
    if (verdict != ARGUS_DISPARATE) {
        d->in_a_row = 0;
        return;
    }
    d->difference_mm = difference;
    d->in_a_row = argus_one_more(d->in_a_row);
}

void argus_algorithm1_sip(argus_algorithm1_t *const self, const argus_knowledge_t *const knowledge,
                          const bool away) {
    for (int i = 0; !away && i < knowledge->robot->forward_count; i++) {
        const int sonar = knowledge->robot->forward[i];
        if ((knowledge->fresh >> sonar & 1u) != 0) {
            count_disparity(self, knowledge, sonar);
        }
    }
}

static bool has_changed(const argus_disparate_t *const d, const argus_knowledge_t *const knowledge,
                        const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t tr = argus_tolerance_mm(knowledge->robot, knowledge->sonar[sonar].reading_mm);
    return argus_abs(d->difference_mm - d->held_difference_mm) > 2 * tr;
}

// The hold-off ends after a way, a turn, or a clear change of the disparity.
static bool hold_ends(const argus_disparate_t *const d, const argus_knowledge_t *const knowledge,
                      const argus_config_t *const config, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return knowledge->odometer_mm - d->held_odometer_mm >= (uint32_t)config->holdoff_mm ||
           argus_angle_abs_diff(knowledge->pose.heading_cdeg, d->held_heading_cdeg) >=
               config->holdoff_deg * 100 ||
           has_changed(d, knowledge, sonar);
}

static bool is_suspect(argus_algorithm1_t *const self, const argus_knowledge_t *const knowledge,
                       const argus_config_t *const config, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_disparate_t *const d = &self->of[sonar];
    if (argus_is_out(knowledge, sonar) || d->in_a_row < config->suspect_readings) {
        return false;
    }
    if (d->held && hold_ends(d, knowledge, config, sonar)) {
        d->held = false;
        if (has_changed(d, knowledge, sonar)) { // another case, also in the same place
            self->verified &= (argus_mask_t) ~(1u << sonar);
        }
    }
    return !d->held && (self->verified >> sonar & 1u) == 0;
}

argus_mask_t argus_algorithm1_suspects(argus_algorithm1_t *const self,
                                       const argus_knowledge_t *const knowledge,
                                       const argus_config_t *const config) {
    unsigned mask = 0;
    for (int i = 0; i < knowledge->robot->forward_count; i++) {
        const int sonar = knowledge->robot->forward[i];
        mask |= is_suspect(self, knowledge, config, sonar) ? 1u << sonar : 0u;
    }
    return (argus_mask_t)mask;
}
