// SPDX-License-Identifier: MIT
// Changes the health of a sonar by the table of changes, counts how often it failed, and returns what is to
// be said.
#include "knowledge/health.h"

typedef struct {
    char from[7];
    uint8_t to;
    uint8_t event;
} row_t;

static const row_t *row_of(const argus_change_t change) {
    ARGUS_ASSERT(change < ARGUS_CHANGES);
#define ARGUS_EV_NONE 0
#define ROW(name, from, to, event, meaning) {from, ARGUS_##to, ARGUS_EV_##event},
    static const row_t rows[] = {ARGUS_CHANGE_TABLE(ROW)};
#undef ROW
#undef ARGUS_EV_NONE
    return &rows[change];
}

bool argus_health_may(const argus_knowledge_t *const self, const int sonar, const argus_change_t change) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    static const char initial[] = {'U', 'H', 'S', 'D', 'P', 'T', 'A'};
    const char *from = row_of(change)->from;
    const char now = initial[self->sonar[sonar].health];
    while (*from != '\0' && *from != now) {
        from++;
    }
    return *from != '\0';
}

// A relapse: it fails again, in this mission or after one in which it failed.
static void count_failure(argus_sonar_t *const s) {
    ARGUS_ASSERT(s->health != ARGUS_DISABLED);
    const bool again = s->disabled_times > 0 || s->disabled_before > 0;
    s->relapses = (uint8_t)(s->relapses + (again && s->relapses < UINT8_MAX ? 1 : 0));
    s->disabled_times = (uint16_t)(s->disabled_times + (s->disabled_times < UINT16_MAX ? 1 : 0));
}

argus_event_t argus_health_set(argus_knowledge_t *const self, const int sonar, const argus_change_t change,
                               const argus_fault_kind_t kind, const int32_t value, const uint32_t now_ms) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)kind < ARGUS_KINDS);
    argus_sonar_t *const s = &self->sonar[sonar];
    const row_t *const row = row_of(change);
    const bool same = change == ARGUS_CHANGE_NAMED || change == ARGUS_CHANGE_RENAMED; // it is known better
    if (row->to == ARGUS_DISABLED && s->health != ARGUS_DISABLED) {
        count_failure(s);
    }
    s->relapses = change == ARGUS_CHANGE_RETESTED ? 0 : s->relapses;
    s->named |= kind != ARGUS_KIND_NONE && (change == ARGUS_CHANGE_NAMED || row->to == ARGUS_DISABLED);
    s->since_ms = same ? s->since_ms : now_ms;
    s->health = (argus_health_t)row->to;
    s->kind = kind;
    return (argus_event_t){.id = row->event, .sonar = (int8_t)sonar, .value = value};
}

void argus_health_forgive(argus_knowledge_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->sonar[sonar].named = false;
    self->sonar[sonar].missions_named = 0;
}
