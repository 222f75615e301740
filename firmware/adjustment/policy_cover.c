// SPDX-License-Identifier: MIT
// For each span of headings that a sweep may pass, the least stops by dynamic programming over the blind
// bearings.
#include "adjustment/policy_cover.h"

#include "knowledge/angle.h"

#define SETS (1u << ARGUS_FORWARD_MAX)
#define NONE UINT16_MAX
#define STOP_SHIFT 12 // a price: stops, and the sum of the rotations below them
#define HALF_DEG 180

_Static_assert(ARGUS_FORWARD_MAX *HALF_DEG < 1 << STOP_SHIFT,
               "each stop sees a bearing more, so the sum has room");
_Static_assert(ARGUS_FORWARD_MAX << STOP_SHIFT < NONE, "... and the number of stops");
_Static_assert(ARGUS_TURNS_MAX <= 32, "a bit for each turn");

// The turns [from, to) of the list lie on the way of a sweep.
typedef struct {
    int from;
    int to;
    int sweep_deg;
} span_t;

typedef struct {
    uint16_t least[SETS]; // price at which a set of blind bearings is seen
    uint32_t steps;
} table_t;

// That of one stop.
static uint16_t price(const argus_turns_t *const turns, const int k) {
    ARGUS_ASSERT(k >= 0 && k < turns->count);
    return (uint16_t)((1 << STOP_SHIFT) + argus_abs(turns->deg[k]));
}

static void fill(table_t *const table, const argus_turns_t *const turns, const span_t *const span) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    ARGUS_ASSERT(table->least[0] == 0); // nothing is seen for nothing
    for (unsigned set = 1; set <= argus_turns_open(turns); set++) {
        table->least[set] = NONE;
        for (int k = span->from; k < span->to; k++) {
            const uint16_t rest = table->least[set & ~(unsigned)turns->sees[k]];
            const bool helps = (turns->sees[k] & set) != 0;
            ARGUS_ASSERT(!helps || rest != NONE); // the span sees all, so each part of all
            const uint16_t sum = helps ? (uint16_t)(rest + price(turns, k)) : NONE;
            table->least[set] = sum < table->least[set] ? sum : table->least[set];
            table->steps++;
        }
    }
}

static bool sees_all(const argus_turns_t *const turns, const span_t *const span) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    unsigned seen = 0;
    for (int k = span->from; k < span->to; k++) {
        seen |= turns->sees[k];
    }
    return seen == argus_turns_open(turns);
}

// A sweep of more than half around comes round sooner going on.
static span_t span_of(const argus_turns_t *const turns, const int from, const int to) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    const int low = from < turns->count ? argus_min(0, turns->deg[from]) : 0;
    const int high = to > 0 ? argus_max(0, turns->deg[to - 1]) : 0;
    return (span_t){.from = from, .to = to, .sweep_deg = 2 * argus_min(high - low, HALF_DEG)};
}

static int count_negative(const argus_turns_t *const turns) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    int negative = 0;
    while (negative < turns->count && turns->deg[negative] < 0) {
        negative++;
    }
    return negative;
}

// One way round sees all that there is.
static bool is_wanted(const argus_turns_t *const turns, const span_t *const span) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    const bool all = span->from == 0 && span->to == turns->count;
    return (all || span->sweep_deg < 2 * HALF_DEG) && sees_all(turns, span);
}

// Of those that cost the same in time the one of least price, and then that with the lowest turn in which
// they differ.
typedef struct {
    int32_t cost;
    uint16_t price;
    uint32_t stops; // bit k: turn k is one
    span_t span;
} choice_t;

// The stops of the cheapest set. Of several that with the lowest turns: what a turn of a cheapest set leaves
// is seen by the rest of it.
static uint32_t stops_of(const table_t *const table, const argus_turns_t *const turns,
                         const span_t *const span) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    uint32_t stops = 0;
    unsigned set = argus_turns_open(turns);
    for (int k = span->from; k < span->to; k++) { // each is needed once, in whatever order
        const unsigned rest = set & ~(unsigned)turns->sees[k];
        if (rest != set && table->least[set] == table->least[rest] + price(turns, k)) {
            stops |= (uint32_t)1 << k;
            set = rest;
        }
    }
    ARGUS_ASSERT(set == 0);
    return stops;
}

static bool is_cheaper(const choice_t *const a, const choice_t *const b) {
    if (a->cost != b->cost) {
        return a->cost < b->cost;
    }
    if (a->price != b->price) {
        return a->price < b->price;
    }
    const uint32_t differ = a->stops ^ b->stops;
    return (a->stops & differ & (~differ + 1u)) != 0;
}

static void try_span(choice_t *const best, table_t *const table, const argus_turns_t *const turns,
                     const span_t span, const int32_t stop_cost, const int32_t degree_cost) {
    if (!is_wanted(turns, &span)) {
        return;
    }
    fill(table, turns, &span);
    const uint16_t least = table->least[argus_turns_open(turns)];
    const choice_t here = {.cost = (least >> STOP_SHIFT) * stop_cost + span.sweep_deg * degree_cost,
                           .price = least,
                           .stops = stops_of(table, turns, &span),
                           .span = span};
    if (is_cheaper(&here, best)) {
        *best = here;
    }
}

static void add(argus_plan_t *const plan, const argus_turns_t *const turns, const uint32_t stops,
                const int k) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    if ((stops >> k & 1u) != 0) {
        ARGUS_ASSERT(plan->count < ARGUS_ROTATIONS_MAX); // each stop sees another blind bearing
        plan->rotation_deg[plan->count++] = turns->deg[k];
    }
}

static void list(argus_plan_t *const plan, const argus_turns_t *const turns, const uint32_t stops,
                 const int negative, const bool around) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    for (int k = negative - 1; k >= 0 && !around; k--) {
        add(plan, turns, stops, k);
    }
    for (int k = negative; k < turns->count; k++) {
        add(plan, turns, stops, k);
    }
    for (int k = 0; k < negative && around; k++) {
        add(plan, turns, stops, k);
    }
}

uint32_t argus_policy_cover(argus_plan_t *const plan, const argus_turns_t *const turns,
                            const int32_t stop_cost, const int32_t degree_cost) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX && turns->blinds > 0);
    const int negative = count_negative(turns);
    table_t table = {.steps = 0};
    choice_t best = {.cost = INT32_MAX, .price = NONE};
    for (int from = 0; from <= negative; from++) {
        for (int to = negative; to <= turns->count; to++) {
            try_span(&best, &table, turns, span_of(turns, from, to), stop_cost, degree_cost);
        }
    }
    plan->complete = best.cost < INT32_MAX;
    if (plan->complete) {
        list(plan, turns, best.stops, negative, best.span.sweep_deg == 2 * HALF_DEG);
    }
    ARGUS_ASSERT(table.steps <= ARGUS_COVER_STEPS_MAX);
    return table.steps;
}
