// SPDX-License-Identifier: MIT
// Numbers orders that do nothing but show in the next SIP, and reads which of them have arrived.
#include "arcos/roundtrip.h"

#include <string.h>

#include "arcos/arithmetic.h"

#define PORTS ARGUS_ROUNDTRIP_PORTS
#define WINDOW (PORTS - 1) // so many may be under way: one number is that of the last one seen
#define AGAIN_MS 1000u     // nothing is seen: the last one may be lost
#define MUTE_MS 4000u      // later than any delay that a session is opened with
#define DOUBT_MS 300u      // the port does not show yet: CONFIG is asked for, too
#define ASK_MS 300u        // between two CONFIGs on a link that takes no time
#define ASK_AGAIN_MS 2500u
#define ASK_SHARE 5 // so many times the time of a CONFIGpac passes between two
#define CONFIG_BYTES 200
#define SIP_BYTES 64
#define LONGEST_MS 60000

static int32_t waits_ms(const uint32_t now_ms, const uint32_t then_ms) {
    const uint32_t elapsed = now_ms - then_ms;
    return elapsed < (uint32_t)LONGEST_MS ? (int32_t)elapsed : LONGEST_MS;
}

// On the wire.
static int32_t takes_ms(const argus_config_t *const config, const int32_t bytes) {
    ARGUS_ASSERT(config->baud >= 0);
    return config->baud > 0 ? bytes * ARCOS_TIMING_BITS_PER_BYTE * 1000 / config->baud : 0;
}

void argus_roundtrip_begin(argus_roundtrip_t *const self, const bool answers) {
    memset(self, 0, sizeof *self);
    self->answers = answers;
}

// Orders arrive in their sequence: with this one all before it.
static void see(argus_roundtrip_t *const self, const uint8_t number) {
    const uint8_t behind = (uint8_t)((self->newest + PORTS - number) % PORTS); // sent after it
    if (behind < self->waiting) {
        self->waiting = behind;
        self->seen_ms = self->sent_ms[number];
        self->shows = true;
    }
}

static void send(argus_roundtrip_t *const self, argus_outbox_t *const out, const uint32_t now_ms) {
    const bool again = self->waiting >= WINDOW;
    if (self->mute || (again && now_ms - self->last_ms < AGAIN_MS)) {
        return;
    }
    const uint8_t number = (uint8_t)(again ? self->newest : (self->newest + 1) % PORTS);
    if (!argus_outbox_int(out, ARCOS_CMD_ADSEL, number) || again) {
        self->last_ms = now_ms;
        return;
    }
    self->newest = number;
    self->sent_ms[number] = now_ms;
    self->last_ms = now_ms;
    self->waiting++;
}

static void begin(argus_roundtrip_t *const self, const argus_sip_t *const sip, const uint32_t now_ms) {
    self->begun = true;
    self->begun_ms = now_ms;
    self->newest = (uint8_t)(sip->anport % PORTS); // what it shows is none of ours
}

static void hear(argus_roundtrip_t *const self, const argus_session_t *const session) {
    const argus_setup_t *const setup = &session->setup;
    if (self->asks && (int32_t)(setup->told_ms - self->again_ms) >= 0 && setup->told) {
        self->asks = false;
        self->answers = true;
        self->took_ms = setup->told_ms - self->asked_ms;
    }
}

static void ask(argus_roundtrip_t *const self, argus_outbox_t *const out, const argus_config_t *const config,
                const uint32_t now_ms) {
    const uint32_t every_ms = ASK_MS + (uint32_t)takes_ms(config, CONFIG_BYTES) * ASK_SHARE;
    if (now_ms - self->again_ms < (self->asks ? ASK_AGAIN_MS : every_ms) ||
        !argus_outbox_plain(out, ARCOS_CMD_CONFIG)) {
        return;
    }
    self->asked_ms = self->asks ? self->asked_ms : now_ms;
    self->again_ms = now_ms;
    self->asks = true;
}

void argus_roundtrip_sip(argus_roundtrip_t *const self, argus_session_t *const session,
                         const argus_config_t *const config, const uint32_t now_ms) {
    if (!self->begun) {
        begin(self, &session->sip, now_ms);
    }
    if (session->sip.has_anport && session->sip.anport < PORTS) {
        see(self, session->sip.anport);
    }
    self->mute = !self->shows && now_ms - self->begun_ms >= MUTE_MS;
    send(self, &session->outbox, now_ms);
    hear(self, session);
    if (!self->shows && now_ms - self->begun_ms >= DOUBT_MS) {
        ask(self, &session->outbox, config, now_ms);
    }
}

bool argus_roundtrip_is_known(const argus_roundtrip_t *const self) {
    return self->begun && (self->shows || self->answers);
}

int32_t argus_roundtrip_ms(const argus_roundtrip_t *const self, const uint32_t now_ms) {
    if (!argus_roundtrip_is_known(self)) {
        return 0;
    }
    if (self->shows) {
        return waits_ms(now_ms, self->seen_ms);
    }
    return argus_max(self->asks ? waits_ms(now_ms, self->asked_ms) : 0, (int32_t)self->took_ms);
}

int32_t argus_roundtrip_usual_ms(const argus_roundtrip_t *const self, const argus_config_t *const config) {
    const int32_t cycles_ms = 2 * ARCOS_TIMING_SIP_CYCLE_MS;
    return cycles_ms + takes_ms(config, self->shows ? SIP_BYTES : SIP_BYTES + CONFIG_BYTES);
}
