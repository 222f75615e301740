// SPDX-License-Identifier: MIT
// Chooses the looks of an active verification and says when they have shown enough.
#include "argus/inquiry.h"

#include <string.h>

#include "argus/angle.h"

#define READINGS 2          // two that agree make a view
#define READINGS_UNSTEADY 7 // where a sonar does not agree with itself
#define LOOK_MS 2600u       // a sonar that yields nothing is not waited for longer
#define FIRST_LOOKS 2

// The pitch of the ring is 20 degrees; 0 and 7 are 40 off their neighbours. Half a turn lets the other array
// see.
static const int16_t looks_cdeg[] = {-2000, 2000, 0, -4000, 4000, 18000};
#define LOOKS ((uint8_t)(sizeof looks_cdeg / sizeof looks_cdeg[0]))
#define LOOK_BEHIND (LOOKS - 1)

void argus_inquiry_init(argus_inquiry_t *const self) {
    memset(self, 0, sizeof *self);
}

// The suspects, and two neighbours on either side within their array.
static uint16_t around(const uint16_t suspects) {
    unsigned mask = 0;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        for (int k = i - 2; k <= i + 2; k++) {
            const bool same = k >= 0 && k < ARGUS_SONARS && k / 8 == i / 8;
            mask |= same && (suspects >> i & 1u) != 0 ? 1u << k : 0u;
        }
    }
    return (uint16_t)mask;
}

void argus_inquiry_begin(argus_inquiry_t *const self, const uint16_t suspects, const uint16_t out,
                         const int32_t base_cdeg) {
    argus_inquiry_init(self);
    self->active = true;
    self->base_cdeg = base_cdeg;
    argus_inquiry_add(self, suspects, out);
}

void argus_inquiry_add(argus_inquiry_t *const self, const uint16_t suspects, const uint16_t out) {
    self->suspects |= suspects;
    const unsigned around_mask = self->suspects != 0 ? around(self->suspects) : ARGUS_FORWARD_MASK;
    self->watched = (uint16_t)(around_mask & ~(unsigned)out);
}

int32_t argus_inquiry_heading_cdeg(const argus_inquiry_t *const self) {
    return self->returning ? self->base_cdeg : argus_angle_wrap(self->base_cdeg + looks_cdeg[self->look]);
}

static void mark_settled(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge) {
    self->marked = true;
    self->settled_ms = knowledge->sip_ms;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->seen[i] = (uint8_t)(knowledge->sonar[i].readings & 0xFFu);
    }
}

static bool has_seen_enough(const argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                            const argus_evidence_t *const evidence) {
    if (knowledge->sip_ms - self->settled_ms >= LOOK_MS) {
        return true;
    }
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const unsigned more = (knowledge->sonar[i].readings - self->seen[i]) & 0xFFu;
        const unsigned needed = argus_evidence_is_unsteady(evidence, i) ? READINGS_UNSTEADY : READINGS;
        if ((self->watched >> i & 1u) != 0 && more < needed) {
            return false;
        }
    }
    return true;
}

static bool is_open(const argus_evidence_t *const evidence, const int sonar) {
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

// A whole array that hears nothing cannot clear itself: the other one must look.
static bool is_deaf(const argus_knowledge_t *const knowledge, const int first) {
    for (int i = first; i < first + 8; i++) {
        if (argus_usable(knowledge, i)) {
            return false;
        }
    }
    return true;
}

static uint8_t next_look(const argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                         const argus_evidence_t *const evidence) {
    const bool one_deaf = is_deaf(knowledge, 0) != is_deaf(knowledge, 8);
    const uint8_t next = (uint8_t)(self->look + 1);
    if (next >= FIRST_LOOKS && one_deaf && self->look < LOOK_BEHIND && self->suspects != 0) {
        return LOOK_BEHIND;
    }
    const bool enough = next >= FIRST_LOOKS && is_resolved(self, evidence);
    return enough || next >= LOOK_BEHIND ? LOOKS : next;
}

bool argus_inquiry_step(argus_inquiry_t *const self, const argus_knowledge_t *const knowledge,
                        const argus_evidence_t *const evidence) {
    if (self->returning) {
        self->active = false;
        return true;
    }
    if (!self->marked) {
        mark_settled(self, knowledge);
        return false;
    }
    if (!has_seen_enough(self, knowledge, evidence)) {
        return false;
    }
    self->marked = false;
    self->look = next_look(self, knowledge, evidence);
    self->returning = self->look >= LOOKS;
    return true;
}
