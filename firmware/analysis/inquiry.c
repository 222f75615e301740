// SPDX-License-Identifier: MIT
// Chooses the looks of an active verification and says when they have shown enough.
#include "analysis/inquiry.h"

#include <string.h>

#include "analysis/aim.h"
#include "knowledge/angle.h"

#define READINGS 2    // two that agree make a view
#define LOOK_MS 2600u // a sonar that yields nothing is not waited for longer
#define FIRST_LOOKS 2
#define SILENT_RUN 2
#define AIMS_MAX 4   // turns of a suspect onto what another has heard
#define AIMS_ASIDE 2 // ... and, while that lasts, of one that is none
#define AIMED 3      // readings of it

// In pitches of the ring; one that looks abeam is two off its neighbour.
static const int8_t looks[] = {-1, 1, 0, -2, 2};
#define LOOKS ((uint8_t)(sizeof looks / sizeof looks[0]))

void argus_inquiry_init(argus_inquiry_t *const self) {
    memset(self, 0, sizeof *self);
}

// The suspects, and two neighbours on either side within their array.
static argus_mask_t around(const argus_robot_t *const robot, const argus_mask_t suspects) {
    const int last = argus_robot_sonars(robot) - 1;
    unsigned mask = 0;
    for (int i = 0; i <= last; i++) {
        for (int k = argus_max(i - 2, 0); (suspects >> i & 1u) != 0 && k <= argus_min(i + 2, last); k++) {
            mask |= argus_robot_array_of(i) == argus_robot_array_of(k) ? 1u << k : 0u;
        }
    }
    return (argus_mask_t)mask;
}

// Hears nothing, and is not named yet.
static bool is_silent(const argus_evidence_t *const evidence, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_evidence_silent_run(evidence, sonar) >= SILENT_RUN &&
           argus_evidence_names(evidence, sonar) == ARGUS_KIND_NONE;
}

static bool aim(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                const argus_evidence_t *const evidence, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < knowledge->sonars && self->aims < AIMS_MAX);
    self->aiming = argus_aim(evidence, knowledge, sonar, &self->aim_cdeg);
    self->aimed = (uint8_t)sonar;
    self->aims = (uint8_t)(self->aims + (self->aiming ? 1 : 0));
    return self->aiming;
}

// Of those in `mask`, the one that the others contradict most; the lowest number of equals.
static int most_contradicted(const argus_evidence_t *const evidence, const unsigned mask) {
    ARGUS_ASSERT(mask != 0);
    int worst = -1;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const bool counts = (mask >> i & 1u) != 0;
        if (counts && (worst < 0 || argus_evidence_contradicted(evidence, i) >
                                        argus_evidence_contradicted(evidence, worst))) {
            worst = i;
        }
    }
    return worst;
}

static bool aim_at_one_of(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                          const argus_evidence_t *const evidence, unsigned mask) {
    while (mask != 0) {
        const int sonar = most_contradicted(evidence, mask);
        if (aim(self, knowledge, evidence, sonar)) {
            return true;
        }
        mask &= ~(1u << sonar);
    }
    return false;
}

// Suspects first, then those that the others contradict. False: nothing to aim at, or often enough.
static bool take_aim(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                     const argus_evidence_t *const evidence) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    self->aiming = false;
    if (self->aims >= AIMS_MAX) {
        return false;
    }
    unsigned silent = 0;
    for (int i = 0; i < knowledge->sonars; i++) {
        silent |= !argus_is_out(knowledge, i) && is_silent(evidence, i) ? 1u << i : 0u;
    }
    // Where there are suspects, some aims are theirs.
    const bool aside = self->suspects == 0 || self->aims < AIMS_ASIDE;
    return aim_at_one_of(self, knowledge, evidence, silent & self->suspects) ||
           (aside && aim_at_one_of(self, knowledge, evidence, silent));
}

static void set_look(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                     const uint8_t look) {
    ARGUS_ASSERT(look <= LOOKS);
    self->look = look;
    self->look_cdeg = look < LOOKS ? looks[look] * knowledge->robot->pitch_deg * 100 : 0;
}

void argus_inquiry_begin(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                         const argus_evidence_t *const evidence, const argus_mask_t suspects,
                         const int32_t base_cdeg) {
    argus_inquiry_init(self);
    self->active = true;
    self->base_cdeg = base_cdeg;
    argus_inquiry_add(self, knowledge, suspects);
    set_look(self, knowledge, 0);
    take_aim(self, knowledge, evidence);
}

void argus_inquiry_add(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                       const argus_mask_t suspects) {
    self->suspects |= suspects;
    const unsigned wanted = self->suspects != 0 ? around(knowledge->robot, self->suspects)
                                                : argus_robot_forward(knowledge->robot);
    self->watched = (argus_mask_t)(wanted & ~(unsigned)argus_out(knowledge));
}

int32_t argus_inquiry_heading_cdeg(const argus_inquiry_t *const self) {
    ARGUS_ASSERT(self->look <= LOOKS);
    if (self->returning || self->aiming) {
        return self->returning ? self->base_cdeg : self->aim_cdeg;
    }
    return argus_angle_wrap(self->base_cdeg + self->look_cdeg);
}

static void mark_settled(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    self->marked = true;
    self->settled_ms = knowledge->sip_ms;
    for (int i = 0; i < knowledge->sonars; i++) {
        self->seen[i] = (uint8_t)(knowledge->sonar[i].readings & 0xFFu);
    }
}

static unsigned more_of(const argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar) {
    return (knowledge->sonar[sonar].readings - self->seen[sonar]) & 0xFFu;
}

static bool has_seen_enough(const argus_inquiry_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    if (knowledge->sip_ms - self->settled_ms >= LOOK_MS) {
        return true;
    }
    if (self->aiming) {
        return more_of(self, knowledge, self->aimed) >= AIMED;
    }
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((self->watched >> i & 1u) != 0 && more_of(self, knowledge, i) < READINGS) {
            return false;
        }
    }
    return true;
}

static bool is_open(const argus_evidence_t *const evidence, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_evidence_suspects(evidence, sonar) &&
           argus_evidence_names(evidence, sonar) == ARGUS_KIND_NONE;
}

static bool is_resolved(const argus_inquiry_t *const self, const argus_evidence_t *const evidence) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if ((self->watched >> i & 1u) != 0 && is_open(evidence, i)) {
            return false;
        }
    }
    return true;
}

static uint8_t next_look(const argus_inquiry_t *const self, const argus_evidence_t *const evidence) {
    const uint8_t next = (uint8_t)(self->look + 1);
    return next >= FIRST_LOOKS && is_resolved(self, evidence) ? LOOKS : next;
}

// The aims have settled nothing of some suspect.
static bool is_in_doubt(const argus_inquiry_t *const self, const argus_evidence_t *const evidence) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const bool asked = (self->suspects >> i & 1u) != 0;
        if (asked && (is_silent(evidence, i) ||
                      (argus_evidence_silent_run(evidence, i) < SILENT_RUN && is_open(evidence, i)))) {
            return true;
        }
    }
    return false;
}

bool argus_inquiry_step(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                        const argus_evidence_t *const evidence) {
    ARGUS_ASSERT(self->active);
    self->suspects &= (argus_mask_t) ~(unsigned)argus_out(knowledge); // what is out is judged by other looks
    if (self->returning) {
        self->active = false;
        return true;
    }
    if (!self->marked) {
        mark_settled(self, knowledge);
        return false;
    }
    if (!has_seen_enough(self, knowledge)) {
        return false;
    }
    self->marked = false;
    const bool aimed = self->aiming;
    if (!aimed) {
        set_look(self, knowledge, next_look(self, evidence));
    }
    const bool over = self->look >= LOOKS;
    self->returning = over || (!take_aim(self, knowledge, evidence) && aimed && !is_in_doubt(self, evidence));
    return true;
}
