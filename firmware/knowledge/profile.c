// SPDX-License-Identifier: MIT
// The two columns of the table of rules.
#include "knowledge/profile.h"

const argus_profile_t *argus_profile(const argus_config_t *const config) {
#define PAPER(rule, paper, argus, meaning) .rule = (paper),
#define ARGUS(rule, paper, argus, meaning) .rule = (argus),
    static const argus_profile_t profiles[] = {
        [ARGUS_PROFILE_PAPER] = {ARGUS_RULE_TABLE(PAPER)},
        [ARGUS_PROFILE_ARGUS] = {ARGUS_RULE_TABLE(ARGUS)},
    };
#undef PAPER
#undef ARGUS
    return &profiles[config->profile == ARGUS_PROFILE_ARGUS ? ARGUS_PROFILE_ARGUS : ARGUS_PROFILE_PAPER];
}
