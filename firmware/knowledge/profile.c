// SPDX-License-Identifier: MIT
// The rules of each profile, from its groups.
#include "knowledge/profile.h"

#define RULE(groups, rule, group, value, meaning) .rule = ((groups) & ARGUS_GROUP_##group) != 0 ? (value) : 0,
#define PROFILE(name, word, paper, evidence, beyond, meaning)                                             \
    [ARGUS_PROFILE_##                                                                                     \
        name] = {ARGUS_RULE_TABLE(RULE, (paper) * ARGUS_GROUP_PAPER | (evidence) * ARGUS_GROUP_EVIDENCE | \
                                            (beyond) * ARGUS_GROUP_BEYOND)},

const argus_profile_t *argus_profile(const argus_config_t *const config) {
    static const argus_profile_t profiles[] = {ARGUS_PROFILE_TABLE(PROFILE, )};
    static const argus_profile_t trusting = {ARGUS_RULE_TABLE(RULE, ARGUS_GROUP_BEYOND)};
    if (config->diagnosis == 0) {
        return &trusting;
    }
    const bool is_known = config->profile >= 0 && config->profile < (int32_t)ARGUS_PROFILES;
    return &profiles[is_known ? config->profile : ARGUS_PROFILE_PAPER];
}
