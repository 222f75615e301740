// SPDX-License-Identifier: MIT
// Slow statistics of every sonar, their slopes, and what they foretell.
#include "awareness/trend.h"

#include <string.h>

#include "awareness/numbers.h"
#include "knowledge/angle.h"

typedef struct {
    uint16_t length_mm; // of a segment, at least
    uint16_t count;     // of readings or pairs in it, at least
    int16_t least;      // below, nothing is said
    int16_t growth;     // least lead of the fast mean
    int16_t level;      // where the evidence will have convicted
    int16_t jump;       // one segment differs from the fast mean by no more than this: a place, not a trend
    uint8_t segments;   // before anything is said
    uint8_t run;        // in a row that show the growth
    bool is_signed;
} rule_t;

// Sixteenths of a permille; see docs/manager.md, Trends.
static const rule_t rules[ARGUS_TRENDS] = {
#define ROW(name, ...) [ARGUS_TREND_##name] = {__VA_ARGS__},
    ARGUS_TREND_NUMBERS(ROW)
#undef ROW
};

void argus_trend_init(argus_trend_t *const self) {
    memset(self, 0, sizeof *self);
}

void argus_trend_forget(argus_trend_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    memset(&self->of[sonar], 0, sizeof self->of[sonar]);
}

void argus_trend_restart(argus_trend_t *const self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_trend_sonar_t *const s = &self->of[i];
        memset(s->count, 0, sizeof s->count);
        memset(s->sum, 0, sizeof s->sum);
        s->echo_mm = 0;
        s->gap = 0;
    }
}

static void add(argus_trend_sonar_t *const self, const argus_trend_kind_t kind, const uint32_t odometer_mm,
                const int32_t value) {
    ARGUS_ASSERT((unsigned)kind < ARGUS_TRENDS);
    if (self->count[kind] == 0) {
        self->from_mm[kind] = odometer_mm;
        self->sum[kind] = 0;
    }
    if (self->count[kind] < UINT16_MAX) {
        self->count[kind]++;
        self->sum[kind] += value;
    }
}

static bool goes_on(const argus_trend_sonar_t *const self, const argus_knowledge_t *const knowledge,
                    const int32_t reading_mm) {
    ARGUS_ASSERT(reading_mm >= 0);
    const int32_t way_mm = (int32_t)((knowledge->odometer_mm - self->echo_odometer_mm) & 0xFFFFu);
    const int32_t limit = ARGUS_FAMILIAR_MM + reading_mm * ARGUS_TREND_GOES_ON_PERCENT / 100 + way_mm;
    return argus_abs(reading_mm - self->echo_mm) <= limit;
}

static void take_echo(argus_trend_sonar_t *const self, const argus_knowledge_t *const knowledge,
                      const uint16_t reading_mm) {
    const bool near = reading_mm < ARGUS_LASTING_MM && self->echo_mm > 0 && self->echo_mm < ARGUS_LASTING_MM;
    if (near && goes_on(self, knowledge, reading_mm)) {
        for (int i = 0; i < self->gap; i++) {
            add(self, ARGUS_TREND_DROPOUT, knowledge->odometer_mm, ARGUS_TREND_UNIT);
        }
        add(self, ARGUS_TREND_DROPOUT, knowledge->odometer_mm, 0);
    }
    self->echo_mm = reading_mm;
    self->echo_odometer_mm = knowledge->odometer_mm;
    self->echo_heading_cdeg = knowledge->pose.heading_cdeg;
    self->gap = 0;
}

void argus_trend_reading(argus_trend_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_trend_sonar_t *const s = &self->of[sonar];
    const uint16_t reading_mm = knowledge->sonar[sonar].reading_mm;
    const bool turned =
        argus_angle_abs_diff(knowledge->pose.heading_cdeg, s->echo_heading_cdeg) > ARGUS_SAME_CDEG;
    if (knowledge->rotating || knowledge->still_sips > 0 || turned) {
        s->echo_mm = 0;
        s->gap = 0;
    }
    if (reading_mm < ARGUS_NO_ECHO_MM) {
        take_echo(s, knowledge, reading_mm);
    } else if (s->gap < ARGUS_TREND_GAP_MAX) {
        s->gap++;
    } else {
        s->echo_mm = 0;
    }
}

static void take_residual(argus_trend_sonar_t *const self, const uint32_t odometer_mm,
                          const int32_t reading_mm, const int32_t expected_mm) {
    ARGUS_ASSERT(reading_mm >= 0);
    const int32_t residual_mm = reading_mm - expected_mm;
    const int32_t limit_mm = ARGUS_AGREE_MM + argus_min(reading_mm, expected_mm) * ARGUS_AGREE_PERCENT / 100;
    if (expected_mm <= 0 || argus_abs(residual_mm) > limit_mm) {
        return;
    }
    add(self, ARGUS_TREND_BIAS, odometer_mm, residual_mm * ARGUS_TREND_UNIT / limit_mm);
}

static void take_far(argus_trend_sonar_t *const self, const uint32_t odometer_mm, const int32_t reading_mm,
                     const int32_t expected_mm) {
    ARGUS_ASSERT(reading_mm >= 0);
    if (expected_mm >= ARGUS_NEAR_MM && expected_mm <= ARGUS_TREND_FAR_TO_MM) {
        add(self, ARGUS_TREND_RANGE, odometer_mm, reading_mm >= ARGUS_NO_ECHO_MM ? ARGUS_TREND_UNIT : 0);
    }
}

static void take_view(argus_trend_sonar_t *const self, const uint32_t odometer_mm, const int32_t reading_mm,
                      const int32_t expected_mm) {
    ARGUS_ASSERT(reading_mm >= 0);
    if (reading_mm < ARGUS_NO_ECHO_MM) {
        take_residual(self, odometer_mm, reading_mm, expected_mm);
    }
    take_far(self, odometer_mm, reading_mm, expected_mm);
}

void argus_trend_pair(argus_trend_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const int32_t reading_mm, const int other, const int32_t other_mm,
                      const int32_t along_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(other >= 0 && other < ARGUS_SONARS);
    ARGUS_ASSERT(reading_mm >= 0);
    const uint32_t odometer_mm = knowledge->odometer_mm;
    if (other_mm < ARGUS_NO_ECHO_MM && !argus_is_out(knowledge, other)) {
        take_view(&self->of[sonar], odometer_mm, reading_mm, other_mm - along_mm);
    }
    if (reading_mm < ARGUS_NO_ECHO_MM && !argus_is_out(knowledge, sonar)) {
        take_view(&self->of[other], odometer_mm, other_mm, reading_mm + along_mm);
    }
}

static int16_t towards(const int16_t mean, const int32_t value, const int32_t weight) {
    return (int16_t)(mean + (value - mean) / weight);
}

static int32_t size_of(const int16_t value, const bool is_signed) {
    return is_signed ? argus_abs(value) : value;
}

// How many segments each mean is behind a value that grows evenly.
static int32_t lag_of(const int32_t segments, const int32_t weight) {
    return argus_min((segments - 1) / 2, weight - 1);
}

static int32_t lead_of(const argus_slope_t *const self, const rule_t *const rule) {
    const int32_t lead = self->fast - self->slow;
    return rule->is_signed && self->fast < 0 ? -lead : lead;
}

typedef struct {
    int32_t mean;
    int32_t count;
    int32_t length_mm;
    int32_t usual; // what the others show
} segment_t;

// Whether a difference between means is beyond chance: 2.6 standard deviations of the fast mean, times the
// root of `eighths` / 5. One of them is 0.3 of that of a segment. Segments in a row are asked for besides.
static bool is_significant(const int64_t difference, const argus_slope_t *const slope,
                           const segment_t *const segment, const bool is_signed, const int32_t eighths) {
    const int64_t share = argus_max(slope->slow, segment->usual);
    const int64_t variance =
        is_signed ? (int64_t)ARGUS_TREND_SPREAD * ARGUS_TREND_SPREAD : share * (ARGUS_TREND_UNIT - share);
    return difference > 0 && 8 * difference * difference * segment->count >= eighths * variance;
}

static bool is_growing(const argus_slope_t *const self, const rule_t *const rule,
                       const segment_t *const segment) {
    const int32_t excess = size_of(self->fast, rule->is_signed) - segment->usual;
    const int32_t lead = lead_of(self, rule);
    return self->segments >= rule->segments && excess >= rule->least && lead >= rule->growth &&
           is_significant(excess, self, segment, rule->is_signed, 10) &&
           is_significant(lead, self, segment, rule->is_signed, 5);
}

static void take_segment(argus_slope_t *const slope, const segment_t *const segment, const int32_t jump) {
    const int32_t value = argus_between(slope->fast - jump, slope->fast + jump, segment->mean);
    const int32_t n = slope->segments + 1;
    const int32_t metres = (int32_t)argus_min(segment->length_mm / 1000, UINT8_MAX);
    slope->fast = towards(slope->fast, value, argus_min(n, ARGUS_TREND_FAST));
    slope->slow = towards(slope->slow, value, argus_min(n, ARGUS_TREND_SLOW));
    slope->metres = (uint8_t)(slope->metres + (metres - slope->metres) / argus_min(n, ARGUS_TREND_FAST));
    slope->segments = (uint8_t)argus_min(n, UINT8_MAX);
}

// A segment that does not show the growth itself does not count for it.
static void judge_slope(argus_slope_t *const self, const rule_t *const rule, const segment_t *const segment) {
    const int32_t excess =
        (rule->is_signed && self->fast < 0 ? -segment->mean : segment->mean) - segment->usual;
    if (!is_growing(self, rule, segment)) {
        self->run = 0;
    } else if (excess >= rule->least && self->run < UINT8_MAX) {
        self->run++;
    }
}

// What the others show of late, the median: the surroundings are the same for all.
static int32_t usual_of(const argus_trend_t *const self, const int kind, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(kind >= 0 && kind < ARGUS_TRENDS);
    int32_t sorted[ARGUS_SONARS];
    int count = 0;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (i == sonar || self->of[i].slope[kind].segments == 0) {
            continue;
        }
        const int32_t value = self->of[i].slope[kind].fast;
        int at = count++;
        for (; at > 0 && sorted[at - 1] > value; at--) {
            sorted[at] = sorted[at - 1];
        }
        sorted[at] = value;
    }
    return count > 0 ? sorted[count / 2] : 0;
}

static void step(argus_trend_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                 const int kind) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(kind >= 0 && kind < ARGUS_TRENDS);
    argus_trend_sonar_t *const s = &self->of[sonar];
    const rule_t *const rule = &rules[kind];
    const uint32_t length_mm = knowledge->odometer_mm - s->from_mm[kind];
    if (s->count[kind] < rule->count || length_mm < rule->length_mm) {
        return;
    }
    const segment_t segment = {.mean = s->sum[kind] / s->count[kind],
                               .count = s->count[kind],
                               .length_mm = (int32_t)(length_mm & 0x7FFFFFFFu),
                               .usual = rule->is_signed ? 0 : usual_of(self, kind, sonar)};
    s->count[kind] = 0;
    take_segment(&s->slope[kind], &segment, rule->jump);
    judge_slope(&s->slope[kind], rule, &segment);
}

void argus_trend_sip(argus_trend_t *const self, const argus_knowledge_t *const knowledge) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        for (int kind = 0; kind < ARGUS_TRENDS; kind++) {
            step(self, knowledge, i, kind);
        }
    }
}

// Segments by which the fast mean is ahead of the slow one. They are 26 once a growth has lasted. When it has
// just begun the slow mean shows little of it, and how little tells the number.
static int32_t lead_segments(const argus_slope_t *const self, const rule_t *const rule) {
    const int32_t most =
        argus_max(1, lag_of(self->segments, ARGUS_TREND_SLOW) - lag_of(self->segments, ARGUS_TREND_FAST));
    const int32_t fast = argus_max(1, size_of(self->fast, rule->is_signed));
    const int32_t slow = argus_max(0, size_of(self->slow, rule->is_signed));
    return argus_between(1, most, argus_max(ARGUS_TREND_LEAD_LEAST, 57 * slow / fast - 11));
}

static int32_t horizon_of(const argus_slope_t *const self, const rule_t *const rule) {
    const int32_t lead = lead_of(self, rule);
    if (self->run < rule->run || lead < rule->growth) {
        return 0;
    }
    const int32_t way_to_go = argus_max(0, rule->level - size_of(self->fast, rule->is_signed));
    const int32_t metres = way_to_go * lead_segments(self, rule) / lead * argus_max(1, self->metres);
    return metres <= ARGUS_TREND_HORIZON_M ? argus_max(1, metres) : 0;
}

int32_t argus_trend_horizon_m(const argus_trend_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    int32_t nearest = 0;
    for (int kind = 0; kind < ARGUS_TRENDS; kind++) {
        const int32_t metres = horizon_of(&self->of[sonar].slope[kind], &rules[kind]);
        nearest = metres > 0 && (nearest == 0 || metres < nearest) ? metres : nearest;
    }
    return nearest;
}

static bool is_calm(const argus_trend_sonar_t *const self) {
    for (int kind = 0; kind < ARGUS_TRENDS; kind++) {
        if (self->slope[kind].run > 0 ||
            size_of(self->slope[kind].fast, rules[kind].is_signed) >= rules[kind].least) {
            return false;
        }
    }
    return true;
}

// A bias shows in both of a pair: it is laid to the one that differs most from all.
static bool is_chief(const argus_trend_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t mine = argus_abs(self->of[sonar].slope[ARGUS_TREND_BIAS].fast);
    for (int i = 0; mine >= rules[ARGUS_TREND_BIAS].least && i < ARGUS_SONARS; i++) {
        if (argus_abs(self->of[i].slope[ARGUS_TREND_BIAS].fast) > mine) {
            return false;
        }
    }
    return true;
}

int argus_trend_news(argus_trend_t *const self, const argus_knowledge_t *const knowledge) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_trend_sonar_t *const s = &self->of[i];
        if (s->said) {
            s->said = !is_calm(s);
        } else if (!argus_is_out(knowledge, i) && argus_trend_horizon_m(self, i) > 0 && is_chief(self, i)) {
            s->said = true;
            return i;
        }
    }
    return -1;
}
