// SPDX-License-Identifier: MIT
// Judges how late the link is.
#include "supervisor/latency.h"

#include "knowledge/angle.h"
#include "supervisor/mode.h"
#include "supervisor/modes.h"
#include "supervisor/say.h"
#include "supervisor/state.h"

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

void argus_latency_open(argus_t *const self) {
    self->latency = (argus_latency_t){0};
    argus_roundtrip_begin(&self->latency.trip, self->session.has_robot);
}

// Beyond what it is on a link without delay, to a cycle less.
static int32_t beyond_ms(const argus_t *const self) {
    const argus_roundtrip_t *const trip = &self->latency.trip;
    const int32_t beyond =
        argus_roundtrip_ms(trip, self->now_ms) - argus_roundtrip_usual_ms(trip, &self->config);
    return argus_between(0, LATE_MOST_MS, beyond);
}

static void say(argus_t *const self, const uint8_t level) {
    argus_latency_t *const mine = &self->latency;
    if (level == mine->level || (level < mine->level && level != LEVEL_PROMPT)) {
        return;
    }
    mine->level = level;
    argus_tell(self, level == LEVEL_PROMPT ? ARGUS_EV_LINK_PROMPT : ARGUS_EV_LINK_SLOW,
               argus_roundtrip_ms(&mine->trip, self->now_ms));
}

static uint8_t level_of(const argus_latency_t *const mine) {
    if (mine->stands) {
        return LEVEL_STANDS;
    }
    return mine->late_ms >= (mine->level == LEVEL_PROMPT ? SLOWER_MS : PROMPT_MS) ? LEVEL_SLOWER
                                                                                  : LEVEL_PROMPT;
}

static bool may_check(const argus_t *const self) {
    return argus_mode_may(self->mode, ARGUS_IN_SESSION) && self->mode != ARGUS_MODE_WAITING;
}

// Whatever moves is stopped; the check that follows does not begin before the link is prompt.
static void stand(argus_t *const self) {
    self->latency.stands = true;
    self->latency.calm_sips = 0;
    self->checked = false;
    say(self, LEVEL_STANDS);
    argus_stop_and_do(self, ARGUS_STOP_STOP, may_check(self) ? ARGUS_DO_CHECK : ARGUS_DO_NOTHING, true);
}

// All that was read meanwhile was late.
static void go_on(argus_t *const self) {
    self->latency.stands = false;
    say(self, level_of(&self->latency));
    argus_stop_and_do(self, ARGUS_STOP_HALT, may_check(self) ? ARGUS_DO_CHECK : ARGUS_DO_NOTHING, true);
}

static void judge(argus_t *const self, const int32_t beyond) {
    argus_latency_t *const mine = &self->latency;
    const bool stands = beyond > mine->late_ms + OVERDUE_MS || mine->late_ms > STANDS_MS;
    if (stands && !mine->stands) {
        stand(self);
    }
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

bool argus_latency_sip(argus_t *const self) {
    argus_latency_t *const mine = &self->latency;
    argus_roundtrip_sip(&mine->trip, &self->session, &self->config, self->now_ms);
    const int32_t beyond = beyond_ms(self);
    mine->overdue = beyond > mine->late_ms;
    judge(self, beyond);
    measure(mine, beyond);
    const bool calm = !mine->overdue && mine->late_ms <= STANDS_MS;
    mine->calm_sips = (uint8_t)(calm ? argus_min(mine->calm_sips + 1, CALM_SIPS) : 0);
    const bool goes_on = mine->stands && mine->calm_sips == CALM_SIPS;
    if (goes_on) {
        go_on(self);
    }
    say(self, level_of(mine));
    self->motion.late_ms = (uint32_t)mine->late_ms;
    return goes_on;
}

void argus_latency_process(argus_t *const self) {
    if (argus_is_open(self) && argus_roundtrip_is_known(&self->latency.trip)) {
        judge(self, beyond_ms(self));
    }
}

int32_t argus_latency_oldest_ms(const argus_latency_t *const self) {
    return argus_max(self->late_ms, self->before_ms);
}

bool argus_latency_is_prompt(const argus_latency_t *const self) {
    return !self->stands && !self->overdue;
}
