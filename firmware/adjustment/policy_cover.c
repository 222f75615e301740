// SPDX-License-Identifier: MIT
// For each span of headings that a sweep may pass, the least stops by dynamic programming over the blind
// bearings.
#include "adjustment/policy_cover.h"

#include "knowledge/angle.h"

#define SETS (1u << ARGUS_FORWARD_MAX)
#define NONE UINT64_MAX
#define STOP_SHIFT 56 // a price: stops, sum of the rotations, and who is first in the list of turns
#define SUM_SHIFT 40
#define HALF_DEG 180

_Static_assert(ARGUS_TURNS_MAX <= SUM_SHIFT, "a bit for each turn");

// The turns [from, to) of the list lie on the way of a sweep.
typedef struct {
    int from;
    int to;
    int sweep_deg;
} span_t;

typedef struct {
    uint64_t least[SETS]; // price at which a set of blind bearings is seen
    uint32_t steps;
} table_t;

// That of one stop. Prices of sets of equal size compare by sum, then by the lowest turn in which they
// differ.
static uint64_t price(const argus_turns_t *const turns, const int k) {
    const uint64_t first = ((uint64_t)1 << SUM_SHIFT) - ((uint64_t)1 << (SUM_SHIFT - 1 - k));
    return ((uint64_t)1 << STOP_SHIFT) + ((uint64_t)argus_abs(turns->deg[k]) << SUM_SHIFT) + first;
}

static void fill(table_t *const table, const argus_turns_t *const turns, const span_t *const span) {
    table->least[0] = 0;
    for (unsigned set = 1; set <= argus_turns_open(turns); set++) {
        table->least[set] = NONE;
        for (int k = span->from; k < span->to; k++) {
            const uint64_t rest = table->least[set & ~(unsigned)turns->sees[k]];
            const bool helps = (turns->sees[k] & set) != 0 && rest != NONE;
            const uint64_t sum = helps ? rest + price(turns, k) : NONE;
            table->least[set] = sum < table->least[set] ? sum : table->least[set];
            table->steps++;
        }
    }
}

static bool sees_all(const argus_turns_t *const turns, const span_t *const span) {
    unsigned seen = 0;
    for (int k = span->from; k < span->to; k++) {
        seen |= turns->sees[k];
    }
    return seen == argus_turns_open(turns);
}

// Who sweeps more than half around comes round sooner going on.
static span_t span_of(const argus_turns_t *const turns, const int from, const int to) {
    const int low = from < turns->count ? argus_min(0, turns->deg[from]) : 0;
    const int high = to > 0 ? argus_max(0, turns->deg[to - 1]) : 0;
    return (span_t){.from = from, .to = to, .sweep_deg = 2 * argus_min(high - low, HALF_DEG)};
}

static int count_negative(const argus_turns_t *const turns) {
    int negative = 0;
    while (negative < turns->count && turns->deg[negative] < 0) {
        negative++;
    }
    return negative;
}

// One way round sees all that there is.
static bool is_wanted(const argus_turns_t *const turns, const span_t *const span) {
    const bool all = span->from == 0 && span->to == turns->count;
    return (all || span->sweep_deg < 2 * HALF_DEG) && sees_all(turns, span);
}

typedef struct {
    int32_t cost;
    uint64_t price;
    span_t span;
} choice_t;

static void try_span(choice_t *const best, table_t *const table, const argus_turns_t *const turns,
                     const span_t span, const int32_t stop_cost, const int32_t degree_cost) {
    if (!is_wanted(turns, &span)) {
        return;
    }
    fill(table, turns, &span);
    const uint64_t least = table->least[argus_turns_open(turns)];
    const int32_t cost = (int32_t)(least >> STOP_SHIFT) * stop_cost + span.sweep_deg * degree_cost;
    if (cost < best->cost || (cost == best->cost && least < best->price)) {
        *best = (choice_t){.cost = cost, .price = least, .span = span};
    }
}

// Bit k: a stop of the cheapest set.
static uint64_t stops_of(const table_t *const table, const argus_turns_t *const turns,
                         const span_t *const span) {
    uint64_t stops = 0;
    unsigned set = argus_turns_open(turns);
    for (int k = span->from; k < span->to; k++) { // each is needed once, in whatever order
        const unsigned rest = set & ~(unsigned)turns->sees[k];
        if (rest != set && table->least[rest] != NONE &&
            table->least[set] == table->least[rest] + price(turns, k)) {
            stops |= (uint64_t)1 << k;
            set = rest;
        }
    }
    ARGUS_ASSERT(set == 0);
    return stops;
}

static void add(argus_plan_t *const plan, const argus_turns_t *const turns, const uint64_t stops,
                const int k) {
    if ((stops >> k & 1u) != 0 && plan->count < ARGUS_ROTATIONS_MAX) {
        plan->rotation_deg[plan->count++] = turns->deg[k];
    }
}

static void list(argus_plan_t *const plan, const argus_turns_t *const turns, const uint64_t stops,
                 const int negative, const bool around) {
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
    choice_t best = {.cost = INT32_MAX};
    for (int from = 0; from <= negative; from++) {
        for (int to = negative; to <= turns->count; to++) {
            try_span(&best, &table, turns, span_of(turns, from, to), stop_cost, degree_cost);
        }
    }
    plan->complete = best.cost < INT32_MAX;
    if (plan->complete) {
        fill(&table, turns, &best.span);
        const uint64_t stops = stops_of(&table, turns, &best.span);
        list(plan, turns, stops, negative, best.span.sweep_deg == 2 * HALF_DEG);
    }
    ARGUS_ASSERT(table.steps <= ARGUS_COVER_STEPS_MAX);
    return table.steps;
}
