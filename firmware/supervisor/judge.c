// SPDX-License-Identifier: MIT
// Judges one sonar by the evidence: in use, or out.
#include "supervisor/judge.h"

#include "awareness/finding.h"
#include "behaviour/looks.h"
#include "behaviour/mode.h"
#include "behaviour/reverse.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"
#include "supervisor/faults.h"

#define PROBATION_AGREED 4
#define PROBATION_MS 4000u
#define PROBATION_DOUBLINGS 4

// What changes the way ahead is answered by a check at rest.
static void break_off(const argus_t *const self, argus_intent_t *const intent) {
    if (argus_mode_may(self->mode, ARGUS_MAY_BREAK_OFF)) {
        intent->stop = ARGUS_STOP_HALT;
        intent->act = ARGUS_DO_CHECK;
    }
}

static void convict(argus_t *const self, const int sonar, const argus_fault_kind_t kind,
                    argus_intent_t *const intent) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)kind < ARGUS_KINDS);
    const bool ahead = (argus_robot_forward(self->knowledge.robot) >> sonar & 1u) != 0;
    argus_disable(self, sonar, kind);
    const bool goes_on =
        argus_rules(self)->drives_seen && argus_guard_may_step(&self->plan) && !argus_should_turn_about(self);
    if (ahead && !goes_on) {
        break_off(self, intent);
    }
}

// A suspicion lasts as long as the evidence, or a look that is to judge it.
static bool is_kept(const argus_t *const self, const argus_finding_t *const finding) {
    ARGUS_ASSERT(finding->level <= ARGUS_FOUND_CERTAIN);
    return finding->level >= ARGUS_FOUND_HELD || self->mode == ARGUS_MODE_VERIFYING || self->looks.asked;
}

// Named in this mission, and in the one before: it gets worse, though looks may have cleared it each time.
static void warn_of(const argus_sonar_t *const s, argus_events_t *const events, const int sonar,
                    const bool named_before) {
    if (!named_before && s->missions_named > 0) {
        argus_emit_of(events, ARGUS_EV_SONAR_DEGRADING, sonar, s->missions_named + 1);
    }
}

// A suspect carries the kind that the evidence names so far.
static void name(argus_t *const self, const int sonar, const argus_finding_t *const finding) {
    ARGUS_ASSERT(!argus_is_out(&self->knowledge, sonar));
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const argus_fault_kind_t kind = argus_named_kind(self, sonar, finding);
    const bool named = argus_looks_stands(&self->looks, sonar, kind, self->now_ms) || finding->doubted;
    if (named) {
        argus_flag_suspects(self, &self->knowledge, &self->events, (argus_mask_t)(1u << sonar));
    }
    ARGUS_ASSERT(!named || s->health == ARGUS_SUSPECT);
    if (named && kind != s->kind) {
        const bool named_before = s->named;
        argus_looks_rename(&self->looks, sonar, s->kind, kind);
        argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_NAMED, kind, (int32_t)kind);
        warn_of(s, &self->events, sonar, named_before);
        argus_rays_forget(&self->rays, sonar); // nothing that it has seen is counted on
        argus_replan(self);
    }
    if (s->health == ARGUS_SUSPECT && !finding->doubted && !is_kept(self, finding)) {
        argus_looks_forget(&self->looks, sonar);
        argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_DROPPED, ARGUS_KIND_NONE,
                          s->reading_mm);
        argus_replan(self);
    }
}

// Where the robot may not turn for it no look can prove what it is named for.
static bool bars_its_proof(const argus_t *const self, const int sonar) {
    const argus_guard_t guard = argus_guard(self);
    return self->knowledge.sonar[sonar].health == ARGUS_SUSPECT && argus_guard_echo_blocks(&guard, sonar) &&
           argus_is_hemmed_in(self);
}

// What is not certain yields to what can be proved here.
static argus_fault_kind_t convicts(const argus_t *const self, const int sonar,
                                   const argus_finding_t *const finding) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const bool open = finding->level < ARGUS_FOUND_CERTAIN && bars_its_proof(self, sonar);
    return open ? self->knowledge.sonar[sonar].kind : finding->kind;
}

static void judge_in(argus_t *const self, const int sonar, const argus_finding_t *const finding,
                     argus_intent_t *const intent) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_fault_kind_t kind = convicts(self, sonar, finding);
    if (kind != ARGUS_KIND_NONE) {
        convict(self, sonar, kind, intent);
    } else if (finding->doubted || !finding->excused) {
        name(self, sonar, finding);
    }
}

// One that is DISABLED goes on PROBATION, one on PROBATION is healthy.
static void restore(argus_t *const self, const int sonar) {
    ARGUS_ASSERT(argus_is_out(&self->knowledge, sonar));
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const bool healthy = s->health == ARGUS_PROBATION;
    argus_evidence_agree_anew(&self->evidence, sonar);
    argus_emit_change(&self->events, &self->knowledge, sonar,
                      healthy ? ARGUS_CHANGE_RESTORED : ARGUS_CHANGE_TRIED,
                      healthy ? ARGUS_KIND_NONE : s->kind, s->reading_mm);
    argus_replan(self);
}

// Probation grows with each relapse.
static uint8_t agreements_wanted(const argus_sonar_t *const s) {
    ARGUS_ASSERT(s->health == ARGUS_DISABLED || s->health == ARGUS_PROBATION || s->health == ARGUS_ABSENT);
    if (s->health != ARGUS_PROBATION) {
        return PROBATION_AGREED;
    }
    return (uint8_t)(PROBATION_AGREED << argus_min(s->relapses, PROBATION_DOUBLINGS));
}

// What repeated one value, and shows another one now, was not stuck: a name is enough to say what it is. Half
// the truth, where nothing is in range, is the same value each time.
static argus_fault_kind_t kind_of_out(const argus_t *const self, const int sonar,
                                      const argus_finding_t *const finding) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_fault_kind_t convicted = convicts(self, sonar, finding);
    const argus_fault_kind_t known = self->knowledge.sonar[sonar].kind;
    if (known == ARGUS_KIND_GARBAGE && convicted == ARGUS_KIND_WRONG) {
        return known; // what is anywhere is contradicted too: `wrong` says less
    }
    const bool stuck = known == ARGUS_KIND_STUCK && !argus_evidence_repeats(&self->evidence, sonar);
    return convicted == ARGUS_KIND_NONE && stuck ? finding->named : convicted;
}

static bool is_silent(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_silent_ms(&self->knowledge, sonar) > (uint32_t)self->config.stale_ms;
}

static bool does_well(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const bool long_enough = self->now_ms - s->since_ms >= PROBATION_MS;
    return long_enough && !is_silent(self, sonar) &&
           argus_evidence_agreed(&self->evidence, sonar) >= agreements_wanted(s);
}

static void judge_out(argus_t *const self, const int sonar, const argus_finding_t *const finding,
                      argus_intent_t *const intent) {
    ARGUS_ASSERT(argus_is_out(&self->knowledge, sonar));
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const argus_fault_kind_t kind = kind_of_out(self, sonar, finding);
    if (s->health == ARGUS_DISABLED && kind != ARGUS_KIND_NONE && kind != s->kind) {
        argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_RENAMED, kind, (int32_t)kind);
    }
    if (finding->keeps_out) {
        if (s->health == ARGUS_PROBATION && finding->named != ARGUS_KIND_NONE) {
            argus_disable(self, sonar, finding->named);
        }
    } else if (does_well(self, sonar)) {
        restore(self, sonar);
        if (argus_should_turn_about(self)) {
            break_off(self, intent);
        }
    }
}

// Its turn in a round comes late: each new order begins the round anew, so plans that change may pass it
// over.
static bool is_passed_over(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(!argus_robot_faces_forward(self->knowledge.robot, sonar));
    const bool late = (argus_robot_polled(self->knowledge.robot) >> sonar & 1u) != 0;
    return late && self->firing.ordered &&
           self->now_ms - self->firing.ordered_ms <= (uint32_t)self->config.stale_ms;
}

// Those that do not face forward yield to the same tests; one that yields nothing is out as well.
static bool has_fallen_silent(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const bool other = (argus_robot_forward(self->knowledge.robot) >> sonar & 1u) == 0;
    return other && is_silent(self, sonar) && !is_passed_over(self, sonar);
}

// An array that has never reported is none that failed: the robot has not got it.
static bool is_missing(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_mask_t array =
        argus_robot_array(self->knowledge.robot, sonar / ARCOS_TIMING_TRANSDUCERS_PER_ARRAY);
    return (self->knowledge.listed & array) == 0;
}

void argus_judge(argus_t *const self, const int sonar, argus_intent_t *const intent) {
    ARGUS_ASSERT(argus_rules(self)->evidence && sonar < self->knowledge.sonars);
    if ((self->orders.pinned >> sonar & 1u) != 0) {
        return;
    }
    const argus_finding_t finding = argus_finding(&self->evidence, &self->extremes, &self->common, sonar);
    if (argus_is_out(&self->knowledge, sonar)) {
        judge_out(self, sonar, &finding, intent);
    } else if (has_fallen_silent(self, sonar)) {
        if (is_missing(self, sonar)) {
            argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_MISSING, ARGUS_KIND_NONE,
                              0);
            return;
        }
        argus_disable(self, sonar, ARGUS_KIND_SILENT);
    } else {
        judge_in(self, sonar, &finding, intent);
    }
}
