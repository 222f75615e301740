// SPDX-License-Identifier: MIT
// The profiles: which rules run, by groups of rules.
#ifndef ARGUS_PROFILE_H
#define ARGUS_PROFILE_H

#include "argus/argus.h"

// Groups of rules. A profile is a row of ARGUS_PROFILE_TABLE that has or has not each of them; diagnosis off
// has BEYOND alone, whatever the profile.
#define ARGUS_GROUP_PAPER 1u    // the tests of the paper
#define ARGUS_GROUP_EVIDENCE 2u // evidence judges
#define ARGUS_GROUP_BEYOND 4u   // how it drives and plans beyond the paper

// X(groups, rule, group, value, meaning): the rule has this value where its group is among `groups`, else 0.
// 1: the rule runs; of a length: mm.
#define ARGUS_RULE_TABLE(X, groups)                                                                    \
    X(groups, dead_reading, PAPER, 1,                                                                  \
      "5000 on a sonar that looks ahead is a dead reading: STOP, DISABLED (S2)")                       \
    X(groups, disparity, PAPER, 1,                                                                     \
      "Algorithm 1 finds suspects, Algorithm 2 verifies them; DISABLED is for good")                   \
    X(groups, evidence, EVIDENCE, 1,                                                                   \
      "evidence judges every reading of every sonar; looks settle it; one that does well returns")     \
    X(groups, swing_margin_mm, BEYOND, 20,                                                             \
      "S7: room wanted beyond the circle that the body sweeps in a turn")                              \
    X(groups, remembers, BEYOND, 1,                                                                    \
      "S7: what was seen a moment ago, twice, and has left the cones, is still there")                 \
    X(groups, reads_again, BEYOND, 1,                                                                  \
      "S7: one echo of a steady sonar is read once more before it forbids a turn")                     \
    X(groups, nudges, BEYOND, 1,                                                                       \
      "S7: a turn of 20 degrees at most asks for what the body sweeps in it, not for the circle")      \
    X(groups, watches_turn, BEYOND, 1, "S7: what comes into view within the circle in a turn ends it") \
    X(groups, watches_flank, BEYOND, 1,                                                                \
      "S2: a wall that its way slants into, or that is not heard any more: STOP")                      \
    X(groups, backs_to_turn, BEYOND, 1,                                                                \
      "S7: backs away as far as a turn asks for, at the driving speed where S5 lets it")               \
    X(groups, passes_abeam, BEYOND, 1,                                                                 \
      "S7: of the rear, one that looks abeam need not read clear beyond what the way back asks for")   \
    X(groups, drives_seen, BEYOND, 1,                                                                  \
      "S1: drives as far as living sonars have seen the way; stops only to see more")                  \
    X(groups, adapts_plan, BEYOND, 1,                                                                  \
      "S1: under policy adaptive any sonar may look ahead; else it stands for paper")                  \
    X(groups, adapts_speed, BEYOND, 1,                                                                 \
      "S5: as fast as what is seen ahead allows; turns gently while it drives")                        \
    X(groups, may_reverse, BEYOND, 1,                                                                  \
      "drives on with the rear ahead when the front has failed and the rear has not")                  \
    X(groups, leaves_ahead, BEYOND, 1, "S4: hemmed in, it goes on from the heading that it has")       \
    X(groups, asks_echo, EVIDENCE, 1,                                                                  \
      "S5: slow until a sonar ahead has heard an echo: silence is no proof of a free way")

typedef struct {
#define ARGUS_RULE_FIELD(groups, rule, group, value, meaning) uint8_t rule;
    ARGUS_RULE_TABLE(ARGUS_RULE_FIELD, 0)
#undef ARGUS_RULE_FIELD
} argus_profile_t;

// The rules of a configuration; those of the paper where the setting is out of its range.
const argus_profile_t *argus_profile(const argus_config_t *config);

#endif
