// SPDX-License-Identifier: MIT
// The columns of the table of rules.
#include "knowledge/profile.h"

const argus_profile_t *argus_profile(const argus_config_t *const config) {
#define PAPER(rule, paper, argus, trusting, meaning) .rule = (paper),
#define ARGUS(rule, paper, argus, trusting, meaning) .rule = (argus),
#define TRUSTING(rule, paper, argus, trusting, meaning) .rule = (trusting),
    static const argus_profile_t profiles[] = {
        [ARGUS_PROFILE_PAPER] = {ARGUS_RULE_TABLE(PAPER)},
        [ARGUS_PROFILE_ARGUS] = {ARGUS_RULE_TABLE(ARGUS)},
    };
    static const argus_profile_t trusting = {ARGUS_RULE_TABLE(TRUSTING)};
#undef TRUSTING
#undef PAPER
#undef ARGUS
    if (config->diagnosis == 0) {
        return &trusting;
    }
    return &profiles[config->profile == ARGUS_PROFILE_ARGUS ? ARGUS_PROFILE_ARGUS : ARGUS_PROFILE_PAPER];
}
