// SPDX-License-Identifier: MIT
// The profiles: which rules run, a row for each rule and a column for each profile.
#ifndef ARGUS_PROFILE_H
#define ARGUS_PROFILE_H

#include "argus/argus.h"

// X(rule, paper, argus, trusting, meaning): 1: the rule runs; of a length: mm. `trusting`: with diagnosis
// off, whatever the profile.
#define ARGUS_RULE_TABLE(X)                                                                                 \
    X(dead_reading, 1, 0, 0, "5000 on a sonar that looks ahead is a dead reading: STOP, DISABLED (S2)")     \
    X(disparity, 1, 0, 0, "Algorithm 1 finds suspects, Algorithm 2 verifies them; DISABLED is for good")    \
    X(evidence, 0, 1, 0,                                                                                    \
      "evidence judges every reading of every sonar; looks settle it; one that does well returns")          \
    X(swing_margin_mm, 0, 20, 20, "S7: room wanted beyond the circle that the body sweeps in a turn")       \
    X(remembers, 0, 1, 1, "S7: what was seen a moment ago, twice, and has left the cones, is still there")  \
    X(reads_again, 0, 1, 1, "S7: one echo of a steady sonar is read once more before it forbids a turn")    \
    X(nudges, 0, 1, 1,                                                                                      \
      "S7: a turn of 20 degrees at most asks for what the body sweeps in it, not for the circle")           \
    X(watches_turn, 0, 1, 1, "S7: what comes into view within the circle in a turn ends it")                \
    X(watches_flank, 0, 1, 1, "S2: a wall that its way slants into, or that is not heard any more: STOP")   \
    X(backs_to_turn, 0, 1, 1,                                                                               \
      "S7: backs away as far as a turn asks for, at the driving speed where S5 lets it")                    \
    X(passes_abeam, 0, 1, 1,                                                                                \
      "S7: of the rear, one that looks abeam need not read clear beyond what the way back asks for")        \
    X(drives_seen, 0, 1, 1, "S1: drives as far as living sonars have seen the way; stops only to see more") \
    X(adapts_plan, 0, 1, 1, "S1: under policy adaptive any sonar may look ahead; else it stands for paper") \
    X(adapts_speed, 0, 1, 1, "S5: as fast as what is seen ahead allows; turns gently while it drives")      \
    X(may_reverse, 0, 1, 1, "drives on with the rear ahead when the front has failed and the rear has not") \
    X(leaves_ahead, 0, 1, 1, "S4: hemmed in, it goes on from the heading that it has")                      \
    X(asks_echo, 0, 1, 0, "S5: slow until a sonar ahead has heard an echo: silence is no proof of a free way")

typedef struct {
#define ARGUS_RULE_FIELD(rule, paper, argus, trusting, meaning) uint8_t rule;
    ARGUS_RULE_TABLE(ARGUS_RULE_FIELD)
#undef ARGUS_RULE_FIELD
} argus_profile_t;

// The rules of a configuration; those of the paper where the setting is out of its range.
const argus_profile_t *argus_profile(const argus_config_t *config);

#endif
