// SPDX-License-Identifier: MIT
// Puts together what the engines have found of one sonar.
#include "awareness/finding.h"

// What needs no witness. An array that has failed as a whole is known by what it heard before, a laser by the
// way.
static argus_fault_kind_t certain(const argus_evidence_t *const evidence,
                                  const argus_extremes_t *const extremes, const argus_common_t *const common,
                                  const int sonar) {
    const argus_fault_kind_t laser = argus_evidence_laser(evidence, sonar);
    if (laser != ARGUS_KIND_NONE) {
        return laser;
    }
    return argus_common_convicts(common, sonar) ? ARGUS_KIND_OFF : argus_extremes_convicts(extremes, sonar);
}

// Below a conviction.
static argus_found_t level_of(const argus_evidence_t *const evidence, const argus_fault_kind_t named,
                              const int sonar) {
    ARGUS_ASSERT((unsigned)named < ARGUS_KINDS);
    if (named != ARGUS_KIND_NONE) {
        return ARGUS_FOUND_NAMED;
    }
    if (argus_evidence_suspects(evidence, sonar)) {
        return ARGUS_FOUND_SUSPECT;
    }
    return argus_evidence_holds(evidence, sonar) ? ARGUS_FOUND_HELD : ARGUS_FOUND_NONE;
}

argus_finding_t argus_finding(const argus_evidence_t *const evidence, const argus_extremes_t *const extremes,
                              const argus_common_t *const common, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_finding_t finding = {
        .level = ARGUS_FOUND_CERTAIN,
        .kind = certain(evidence, extremes, common, sonar),
        .named = argus_evidence_names(evidence, sonar),
        .doubted = argus_common_doubts(common, sonar),
        .excused = argus_common_excuses(common, sonar),
        .keeps_out = argus_evidence_suspects(evidence, sonar) || argus_extremes_keeps_out(extremes, sonar) ||
                     argus_common_convicts(common, sonar) ||
                     argus_evidence_laser(evidence, sonar) != ARGUS_KIND_NONE,
    };
    if (finding.kind == ARGUS_KIND_NONE) {
        finding.kind = argus_evidence_convicts(evidence, sonar);
        finding.level = finding.kind != ARGUS_KIND_NONE ? ARGUS_FOUND_CONVICTED
                                                        : level_of(evidence, finding.named, sonar);
    }
    return finding;
}
