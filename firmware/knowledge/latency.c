// SPDX-License-Identifier: MIT
// Judges how late the link is.
#include "knowledge/latency.h"

#include "knowledge/angle.h"

#define CYCLE_MS ARCOS_TIMING_SIP_CYCLE_MS
#define OVERDUE_MS 150 // beyond what is expected: STOP
#define STANDS_MS 600  // late by more: no motion is safe and of use
#define SLOWER_MS 100  // late by more: said
#define PROMPT_MS 50   // ... until it is late by less
#define LATELY_SIPS 30 // the most of late counts so long at least, and twice as long at most
#define LATE_MOST_MS 4000
#define CALM_SIPS 5
#define LEVEL_PROMPT 0
#define LEVEL_SLOWER 1
#define LEVEL_STANDS 2

void argus_latency_open(argus_latency_t *const mine, const bool has_robot) {
    *mine = (argus_latency_t){0};
    argus_roundtrip_begin(&mine->trip, has_robot);
}

// Beyond what it is on a link without delay, to a cycle less.
static int32_t beyond_ms(const argus_latency_t *const self, const argus_config_t *const config,
                         const uint32_t now_ms) {
    const int32_t beyond =
        argus_roundtrip_ms(&self->trip, now_ms) - argus_roundtrip_usual_ms(&self->trip, config);
    return argus_between(0, LATE_MOST_MS, beyond);
}

static void emit(argus_latency_t *const mine, argus_events_t *const events, const uint8_t level) {
    if (level == mine->level || (level < mine->level && level != LEVEL_PROMPT)) {
        return;
    }
    mine->level = level;
    argus_emit(events, level == LEVEL_PROMPT ? ARGUS_EV_LINK_PROMPT : ARGUS_EV_LINK_SLOW,
               argus_roundtrip_ms(&mine->trip, events->now_ms));
}

static uint8_t level_of(const argus_latency_t *const mine) {
    if (mine->stands) {
        return LEVEL_STANDS;
    }
    return mine->late_ms >= (mine->level == LEVEL_PROMPT ? SLOWER_MS : PROMPT_MS) ? LEVEL_SLOWER
                                                                                  : LEVEL_PROMPT;
}

static argus_lateness_t judge(argus_latency_t *const mine, argus_events_t *const events,
                              const int32_t beyond) {
    const bool stands = beyond > mine->late_ms + OVERDUE_MS || mine->late_ms > STANDS_MS;
    if (!stands || mine->stands) {
        return ARGUS_LATE_AS_BEFORE;
    }
    mine->stands = true;
    mine->calm_sips = 0;
    emit(mine, events, LEVEL_STANDS);
    return ARGUS_LATE_STANDS;
}

// The sight of an order waits for the next SIP, so that it tells of a delay to a cycle. One SIP may be lost.
static void measure(argus_latency_t *const mine, const int32_t beyond) {
    const int32_t late_ms = beyond > 0 ? beyond + CYCLE_MS : 0;
    const int32_t counts_ms = argus_min(late_ms, mine->before_ms);
    mine->before_ms = late_ms;
    mine->most_ms = argus_max(mine->most_ms, counts_ms);
    mine->late_ms = argus_max(mine->most_ms, mine->then_ms);
    mine->sips++;
    if (mine->sips >= LATELY_SIPS) {
        mine->then_ms = mine->most_ms;
        mine->most_ms = counts_ms;
        mine->sips = 0;
    }
}

argus_lateness_t argus_latency_sip(argus_latency_t *const mine, const argus_config_t *const config,
                                   argus_events_t *const events) {
    const int32_t beyond = beyond_ms(mine, config, events->now_ms);
    mine->overdue = beyond > mine->late_ms;
    argus_lateness_t news = judge(mine, events, beyond);
    measure(mine, beyond);
    const bool calm = !mine->overdue && mine->late_ms <= STANDS_MS;
    mine->calm_sips = (uint8_t)(calm ? argus_min(mine->calm_sips + 1, CALM_SIPS) : 0);
    if (mine->stands && mine->calm_sips == CALM_SIPS) {
        mine->stands = false;
        news = ARGUS_LATE_GOES_ON;
    }
    emit(mine, events, level_of(mine));
    return news;
}

argus_lateness_t argus_latency_process(argus_latency_t *const mine, const argus_config_t *const config,
                                       argus_events_t *const events) {
    return argus_roundtrip_is_known(&mine->trip)
               ? judge(mine, events, beyond_ms(mine, config, events->now_ms))
               : ARGUS_LATE_AS_BEFORE;
}

int32_t argus_latency_oldest_ms(const argus_latency_t *const self) {
    return argus_max(self->late_ms, self->before_ms);
}

bool argus_latency_is_prompt(const argus_latency_t *const self) {
    return !self->stands && !self->overdue;
}
