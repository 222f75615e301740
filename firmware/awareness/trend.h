// SPDX-License-Identifier: MIT
// Trends (profile argus): slow statistics of every sonar over the way driven, and how far it may still drive
// before a growing one convicts it.
#ifndef ARGUS_TREND_H
#define ARGUS_TREND_H

#include "knowledge/knowledge.h"

typedef enum {
    ARGUS_TREND_DROPOUT, // share of the readings without an echo between two echoes of one thing
    ARGUS_TREND_BIAS,    // signed difference to other sonars on one bearing, in parts of what they may differ
    ARGUS_TREND_RANGE,   // share of the far echoes of others that it does not hear
    ARGUS_TRENDS
} argus_trend_kind_t;

// Two exponentially weighted means over segments of the way, in sixteenths of a permille. How far the fast
// one is ahead of the slow one tells how steeply a statistic grows.
typedef struct {
    int16_t fast;
    int16_t slow;
    uint8_t segments; // taken in, up to 255
    uint8_t metres;   // length of a segment, mean
    uint8_t run;      // segments in a row that showed a growth worth saying
} argus_slope_t;

typedef struct {
    argus_slope_t slope[ARGUS_TRENDS];
    bool said; // in the present episode
    // The present segment of each statistic: readings or pairs, their sum in its unit, where it began.
    uint16_t count[ARGUS_TRENDS];
    int32_t sum[ARGUS_TRENDS];
    uint32_t from_mm[ARGUS_TRENDS];
    // The echo that dropouts are counted against.
    uint16_t echo_mm;
    uint8_t gap;
    uint32_t echo_odometer_mm;
    int32_t echo_heading_cdeg;
} argus_trend_sonar_t;

typedef struct {
    argus_trend_sonar_t of[ARGUS_SONARS];
} argus_trend_t;

void argus_trend_init(argus_trend_t *self);
void argus_trend_forget(argus_trend_t *self, int sonar);

// The readings begin anew: what is half counted is dropped.
void argus_trend_restart(argus_trend_t *self);

// Each fresh reading of a sonar, once for each ping.
void argus_trend_reading(argus_trend_t *self, const argus_knowledge_t *knowledge, int sonar);

// Two sonars on one bearing from about one place: what each read, 5000 included; `along_mm`: how much nearer
// the first one stood.
void argus_trend_pair(argus_trend_t *self, const argus_knowledge_t *knowledge, int sonar, int32_t reading_mm,
                      int other, int32_t other_mm, int32_t along_mm);

// Closes the segments that are long enough; call it on each SIP. Cost: one pass over the sonars.
void argus_trend_sip(argus_trend_t *self, const argus_knowledge_t *knowledge);

// Metres of driving until the fastest growing statistic of a sonar will have reached the level at which it is
// convicted, 1..ARGUS_TREND_HORIZON_M; 0: none grows. True for as long as it grows, so once said it stays
// said.
int32_t argus_trend_horizon_m(const argus_trend_t *self, int sonar);

// The sonar with a growth that is new and worth saying now, -1: none. It counts as said from then on, until
// the growth is over.
int argus_trend_news(argus_trend_t *self, const argus_knowledge_t *knowledge);

#endif
