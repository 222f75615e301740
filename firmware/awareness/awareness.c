// SPDX-License-Identifier: MIT
// Looks at every SIP for what calls for a STOP, and counts the disparities that make a suspect.
#include "awareness/awareness.h"

#include <string.h>

#include "knowledge/angle.h"
#include "knowledge/profile.h"

#define MOVING_MM_S 5
#define REFRESH_MS 320u // a server that lists every sonar in every SIP lists one ping several times

void argus_awareness_init(argus_awareness_t *const self) {
    memset(self, 0, sizeof *self);
}

void argus_awareness_restart(argus_awareness_t *const self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->of[i].in_a_row = 0;
    }
    self->verified = 0;
}

void argus_awareness_moved(argus_awareness_t *const self) {
    self->verified = 0;
}

void argus_awareness_cleared(argus_awareness_t *const self, const argus_knowledge_t *const knowledge,
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
static void count_disparity(argus_awareness_t *const self, const argus_knowledge_t *const knowledge,
                            const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_disparate_t *const d = &self->of[sonar];
    const bool repeated = knowledge->lists_all && knowledge->sip_ms - d->counted_ms < REFRESH_MS;
    if (self->away || repeated) {
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

static bool looks_along_motion(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t speed = (knowledge->vel_left_mm_s + knowledge->vel_right_mm_s) / 2;
    const unsigned ahead = speed > MOVING_MM_S ? argus_robot_ahead(knowledge->robot) : 0u;
    const unsigned behind = speed < -MOVING_MM_S ? argus_robot_astern(knowledge->robot) : 0u;
    return ((ahead | behind) >> sonar & 1u) != 0;
}

static void see_object(argus_alarm_t *const alarm, const int sonar, const uint16_t reading_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    alarm->object |= (argus_mask_t)(1u << sonar);
    if (alarm->object_sonar == -1 || reading_mm < alarm->object_mm) {
        alarm->object_sonar = (int8_t)sonar;
        alarm->object_mm = reading_mm;
    }
}

static void judge_fresh(argus_alarm_t *const alarm, const argus_knowledge_t *const knowledge,
                        const argus_config_t *const config, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &knowledge->sonar[sonar];
    const bool forward = argus_robot_faces_forward(knowledge->robot, sonar);
    if (argus_is_out(knowledge, sonar)) {
        return;
    }
    const bool dead = s->reading_mm >= knowledge->robot->no_echo_mm;
    if (forward && dead && argus_profile(config)->dead_reading) {
        alarm->dead |= (argus_mask_t)(1u << sonar);
    }
    if (s->reading_mm <= config->object_range_mm && looks_along_motion(knowledge, sonar)) {
        see_object(alarm, sonar, s->reading_mm);
    }
}

static bool is_silent(const argus_knowledge_t *const knowledge, const argus_config_t *const config,
                      const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return !argus_is_out(knowledge, sonar) && argus_silent_ms(knowledge, sonar) > (uint32_t)config->stale_ms;
}

argus_alarm_t argus_awareness_sip(argus_awareness_t *const self, const argus_knowledge_t *const knowledge,
                                  const argus_config_t *const config) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    argus_alarm_t alarm = {.object_sonar = -1};
    for (int i = 0; i < knowledge->sonars; i++) {
        const bool forward = argus_robot_faces_forward(knowledge->robot, i);
        if ((knowledge->fresh >> i & 1u) != 0) {
            judge_fresh(&alarm, knowledge, config, i);
            if (forward) {
                count_disparity(self, knowledge, i);
            }
        }
        if (forward && is_silent(knowledge, config, i)) {
            alarm.silent |= (argus_mask_t)(1u << i);
        }
    }
    alarm.bumper = (knowledge->bumpers_front | knowledge->bumpers_rear) != 0;
    alarm.stall = knowledge->stall_left || knowledge->stall_right;
    return alarm;
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

static bool is_suspect(argus_awareness_t *const self, const argus_knowledge_t *const knowledge,
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

argus_mask_t argus_suspects(argus_awareness_t *const self, const argus_knowledge_t *const knowledge,
                            const argus_config_t *const config) {
    unsigned mask = 0;
    for (int i = 0; i < knowledge->robot->forward_count; i++) {
        const int sonar = knowledge->robot->forward[i];
        mask |= is_suspect(self, knowledge, config, sonar) ? 1u << sonar : 0u;
    }
    return (argus_mask_t)mask;
}
