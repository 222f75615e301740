// SPDX-License-Identifier: MIT
// Puts a sonar into any state of health: by the change that leads there, from a state in which it may happen.
#include "health.h"

#include "knowledge/health.h"

void put_health(argus_sonar_t *sonar, argus_health_t health, argus_fault_kind_t kind, uint32_t now_ms) {
    static const struct {
        argus_health_t from;
        argus_change_t change;
    } way[] = {
        [ARGUS_UNKNOWN] = {ARGUS_PROBATION, ARGUS_CHANGE_FORGOTTEN},
        [ARGUS_HEALTHY] = {ARGUS_SUSPECT, ARGUS_CHANGE_CLEARED},
        [ARGUS_SUSPECT] = {ARGUS_HEALTHY, ARGUS_CHANGE_SUSPECTED},
        [ARGUS_DISABLED] = {ARGUS_HEALTHY, ARGUS_CHANGE_DISABLED},
        [ARGUS_PROBATION] = {ARGUS_DISABLED, ARGUS_CHANGE_TRIED},
        [ARGUS_STALE] = {ARGUS_HEALTHY, ARGUS_CHANGE_STALLED},
    };
    static argus_knowledge_t knowledge;
    knowledge.sonar[0] = *sonar;
    if (sonar->health != health) {
        knowledge.sonar[0].health = way[health].from;
    }
    argus_health_set(&knowledge, 0, way[health].change, kind, 0, now_ms);
    *sonar = knowledge.sonar[0];
}
