// SPDX-License-Identifier: MIT
// Names of what the manager says: look-ups in the event catalogue and in the enumerations.
#include "argus/argus.h"

// Texts, not pointers to them: a table of pointers is initialized data in a position-independent build.
#define NAME_BYTES 24
#define SUBJECT_BYTES 13

typedef struct {
    uint16_t id;
    uint8_t level;
    char name[NAME_BYTES];
    char subject[SUBJECT_BYTES];
} entry_t;

static const char nobody[] = "?";

static const entry_t *find(const int id) {
#define ENTRY(number, NAME, LEVEL, about, meaning) {number, ARGUS_LEVEL_##LEVEL, #NAME, about},
    static const entry_t catalogue[] = {ARGUS_EVENT_TABLE(ENTRY)};
#undef ENTRY
    for (size_t i = 0; i < sizeof catalogue / sizeof catalogue[0]; i++) {
        if (catalogue[i].id == id) {
            return &catalogue[i];
        }
    }
    return NULL;
}

argus_level_t argus_event_level(const uint16_t id) {
    const entry_t *const entry = find(id);
    return entry != NULL ? (argus_level_t)entry->level : ARGUS_LEVEL_ERROR;
}

// The enumerations that count from 0 (ARGUS_NAME_OP from 1), in the order of argus_name_of_t.
#define VALUES_MAX 12
static const char words[][VALUES_MAX][16] = {
    {"OK", "WARN", "ERROR", "STALE"},
    {"OFFLINE", "CHECKING", "VERIFYING", "IDLE", "DRIVING", "SWEEPING", "STEPPING", "BACKING", "WAITING",
     "CLOSING", "CLOSED"},
    {"none", "running", "reached", "failed"},
    {"none", "bumper", "motors", "turn", "way", "catastrophic"},
    {"IsNormal", "IsMinor", "IsMajor", "IsCatastrophic"},
    {"UNKNOWN", "HEALTHY", "SUSPECT", "DISABLED", "PROBATION", "STALE", "ABSENT"},
    {"", "off", "silent", "stuck", "wrong", "garbage", "slow", "intermittent"},
    {"?", "STOP", "GO", "RECHECK", "MOVE", "TURN", "PASSIVE", "ACTIVE", "RETEST", "PIN", "UNPIN", "DISABLE"},
};

const char *argus_name(const argus_name_of_t of, const int number) {
    if (of == ARGUS_NAME_EVENT || of == ARGUS_NAME_SUBJECT) {
        const entry_t *const entry = find(number);
        return entry == NULL ? nobody : of == ARGUS_NAME_EVENT ? entry->name : entry->subject;
    }
    const unsigned table = (unsigned)of - ARGUS_NAME_LEVEL;
    if (table >= sizeof words / sizeof words[0] || number < 0 || number >= VALUES_MAX) {
        return nobody;
    }
    const char *const word = words[table][number];
    const bool none = of == ARGUS_NAME_KIND && number == 0;
    return word[0] != '\0' || none ? word : nobody;
}
