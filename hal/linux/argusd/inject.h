// SPDX-License-Identifier: MIT
// Faults that argusd itself makes, for a test on a real robot. Readings are altered on their way from the
// wire to the manager, for a time that always ends.
#ifndef ARGUSD_INJECT_H
#define ARGUSD_INJECT_H

#include "argus/argus.h"
#include "driver.h"

#define INJECT_MIN_MS 1000u
#define INJECT_MAX_MS 600000u
#define INJECT_SETTLE_MS 5000u // after the end, until what was heard before names nothing any more
#define INJECT_FIRINGS 5       // so late is one that is slow
#define INJECT_PACKET_MAX 258

typedef struct {
    argus_fault_kind_t kind; // NONE: nothing
    argus_fault_kind_t mark; // what it is, or was while the sonar is not in use again; NONE: its own readings
    uint32_t since_ms;       // begun, or ended
    uint32_t for_ms;
    bool has_stuck;
    uint16_t stuck_mm;
    uint16_t before_mm[INJECT_FIRINGS]; // its last readings, the oldest at `next`
    uint8_t known;
    uint8_t next;
} inject_sonar_t;

typedef struct {
    int sonar;
    argus_fault_kind_t kind; // NONE: it ended
    uint32_t for_ms;
} inject_change_t;

typedef struct {
    bool armed;
    inject_sonar_t of[ARGUS_SONARS];
    uint32_t random;
    // A packet that is not whole yet.
    uint8_t held[INJECT_PACKET_MAX];
    size_t used;
    uint32_t held_ms; // its last byte
    // Begun or ended, and not told yet.
    inject_change_t change[ARGUS_SONARS * 2];
    size_t changes;
} inject_t;

void inject_init(inject_t *self, bool armed, uint32_t seed);

// One of PX4's words, or `silent`; false: none of them. `ok` is NONE.
bool inject_kind(const char *word, argus_fault_kind_t *kind);

// Alters a sonar from now on; NONE ends it. A second order replaces the first.
void inject_set(inject_t *self, int sonar, argus_fault_kind_t kind, uint32_t for_ms, uint32_t now_ms);

// Ends what has lasted long enough; everything, with `all`.
void inject_expire(inject_t *self, bool all, uint32_t now_ms);

// What began or ended since, oldest first; false: nothing more.
bool inject_change(inject_t *self, inject_change_t *change);

// An end is not enough: what the manager found of an injected fault stays marked until the sonar is in use
// again.
void inject_settle(inject_t *self, const argus_status_t *status, uint32_t now_ms);

uint32_t inject_marked(const inject_t *self); // a mask

bool inject_is_on(const inject_t *self);

// For the driver.
driver_filter_t inject_filter(inject_t *self);

#endif
