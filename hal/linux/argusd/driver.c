// SPDX-License-Identifier: MIT
// The manager's hands on the wire.
#include "driver.h"

#include <stdio.h>
#include <string.h>

#include "argusd.h"
#include "hal/crc32.h"

#define TELNET_IAC 255u
#define TELNET_WILL 251u // ... to 254: WILL, WON'T, DO, DON'T
#define READ_BYTES 512
#define READS_PER_WAKE 8 // a flood must not keep time from passing
#define RETRY_FIRST_MS 250u
#define RETRY_MAX_MS 4000u
#define REOPEN_TIMEOUT_MS 1000
#define LOOK_MS 1000u
#define FRUITLESS_MIN 2

static uint32_t now_ms(const driver_t *self) {
    return hal_clock_now_ms(&self->clock);
}

void driver_init(driver_t *self, const argus_config_t *config, hal_clock_t clock, const hal_link_spec_t *spec,
                 hal_transport_t *transport) {
    memset(self, 0, sizeof *self);
    self->clock = clock;
    self->spec = *spec;
    self->transport = transport;
    self->cancel_fd = -1;
    self->retry_ms = RETRY_FIRST_MS;
    self->error = HAL_LINK_NOT_OPEN;
    self->core = argus_init(&self->memory, config, now_ms(self));
}

static argus_status_t status_of(const driver_t *self) {
    argus_status_t status;
    argus_status(self->core, &status);
    return status;
}

void driver_attach(driver_t *self, hal_link_t link) {
    self->link = link;
    self->up = true;
    self->error = HAL_LINK_OK;
    self->held = 0;
    self->up_ms = now_ms(self);
    self->bytes_before = self->bytes_in;
    self->packets_before = status_of(self).packets;
    self->failed = false;
    self->settles = self->spec.scheme->settle_ms > 0;
    if (!self->settles) {
        argus_link_up(self->core, self->up_ms);
    }
}

// The ms until the manager is told that the link is up; what arrives before is read and dropped.
static uint32_t settle(driver_t *self) {
    const uint32_t passed_ms = now_ms(self) - self->up_ms;
    if (passed_ms < self->spec.scheme->settle_ms) {
        return self->spec.scheme->settle_ms - passed_ms;
    }
    self->settles = false;
    argus_link_up(self->core, now_ms(self));
    return UINT32_MAX;
}

hal_link_error_t driver_open(driver_t *self, int timeout_ms) {
    hal_link_t link = {0};
    self->error = hal_transport_open(self->transport, &self->spec, timeout_ms, self->cancel_fd, &link);
    self->failed = self->error != HAL_LINK_OK && self->error != HAL_LINK_CANCELLED;
    self->tried = self->tried || self->failed;
    if (self->error == HAL_LINK_OK) {
        driver_attach(self, link);
    } else {
        self->fruitless = 0;
    }
    return self->error;
}

static void lengthen_pause(driver_t *self) {
    self->retry_ms = self->retry_ms < RETRY_MAX_MS / 2 ? self->retry_ms * 2 : RETRY_MAX_MS;
}

// Of bytes alone a link is of no use: a server that is busy says so, and closes.
static bool is_of_use(const driver_t *self) {
    return self->up && status_of(self).packets != self->packets_before;
}

static void lose(driver_t *self, int error) {
    const bool of_use = is_of_use(self);
    self->fruitless = of_use ? 0 : self->fruitless + 1;
    self->words = of_use ? 0 : self->words;
    hal_link_close(&self->link);
    self->up = false;
    self->held = 0;
    self->error = (hal_link_error_t)error;
    self->lost_ms = now_ms(self);
    if (self->fruitless < FRUITLESS_MIN) {
        self->retry_ms = RETRY_FIRST_MS;
    } else {
        lengthen_pause(self);
    }
    argus_link_lost(self->core, self->lost_ms);
}

static void show(const driver_t *self, bool from_robot, const uint8_t *bytes, size_t count) {
    if (self->tap.see != NULL) {
        self->tap.see(self->tap.context, from_robot, bytes, count);
    }
}

// True when the held packet is out.
static bool write_held(driver_t *self) {
    const int written = hal_link_write(&self->link, self->packet, self->held);
    if (written < 0) {
        lose(self, written);
        return false;
    }
    if (written > 0) {
        show(self, false, self->packet, self->held);
        self->held = 0;
    }
    return written > 0;
}

void driver_transmit(driver_t *self) {
    while (self->up) {
        if (self->held == 0) {
            self->held = argus_transmit(self->core, self->packet, sizeof self->packet);
        }
        if (self->held == 0 || !write_held(self)) {
            return;
        }
    }
}

// The robot's bytes to the manager, by way of the filter if there is one.
static void hand_over(driver_t *self, const uint8_t *bytes, size_t count) {
    uint8_t altered[READ_BYTES + DRIVER_FILTER_HOLD];
    if (self->filter.alter != NULL) {
        count = self->filter.alter(self->filter.context, now_ms(self), bytes, count, altered);
        bytes = altered;
    }
    if (count > 0) {
        show(self, true, bytes, count);
        argus_receive(self->core, now_ms(self), bytes, count);
        if (self->after.see != NULL) {
            self->after.see(self->after.context, true, bytes, count);
        }
        driver_transmit(self);
    }
}

// The first of them, for the reason.
static void keep_words(driver_t *self, const uint8_t *bytes, size_t count) {
    self->words = self->bytes_in == self->bytes_before ? 0 : self->words;
    for (size_t i = 0; i < count && self->words < sizeof self->word; i++) {
        self->word[self->words++] = bytes[i];
    }
}

void driver_receive(driver_t *self) {
    uint8_t bytes[READ_BYTES];
    for (int i = 0; i < READS_PER_WAKE && self->up; i++) {
        const int got = hal_link_read(&self->link, bytes, sizeof bytes);
        if (got < 0) {
            lose(self, got);
            return;
        }
        if (got == 0) {
            return;
        }
        keep_words(self, bytes, (size_t)got);
        self->bytes_in += (uint32_t)got;
        hand_over(self, bytes, (size_t)got);
    }
}

// The ms until the next attempt; 0 when one was just made and worked.
static uint32_t reopen(driver_t *self) {
    const uint32_t waited_ms = now_ms(self) - self->lost_ms;
    if (waited_ms < self->retry_ms) {
        return self->retry_ms - waited_ms;
    }
    if (driver_open(self, REOPEN_TIMEOUT_MS) == HAL_LINK_OK) {
        self->reopened++;
        return 0;
    }
    self->lost_ms = now_ms(self);
    lengthen_pause(self);
    return self->retry_ms;
}

// While no robot answers: a stable name may have moved to the adapter that the robot is at now.
static void look_where_it_leads(driver_t *self) {
    const uint32_t passed_ms = now_ms(self) - self->looked_ms;
    if (self->transport == NULL || passed_ms < LOOK_MS || status_of(self).open) {
        return;
    }
    self->looked_ms = now_ms(self);
    if (hal_transport_moved(self->transport)) {
        lose(self, HAL_LINK_GONE);
        self->fruitless = 0; // not closed by the other end
    }
}

// While the link's queue is full: poll() would not tell when it has room.
static uint32_t held_for_ms(const driver_t *self) {
    const uint32_t hold_ms = self->up && self->held > 0 ? hal_link_hold_ms(&self->link) : 0;
    return hold_ms > 0 ? hold_ms : UINT32_MAX;
}

uint32_t driver_process(driver_t *self) {
    uint32_t retry_ms = UINT32_MAX;
    if (self->up) {
        const int kept = hal_link_flush(&self->link);
        if (kept < 0) {
            lose(self, kept);
        }
        driver_transmit(self);
        look_where_it_leads(self);
        retry_ms = self->up && self->settles ? settle(self) : retry_ms;
    } else if (self->transport != NULL && !argus_closed(self->core)) {
        retry_ms = reopen(self);
    }
    if (self->up) {
        hand_over(self, NULL, 0); // what a filter holds back too long
    }
    const uint32_t wait_ms = argus_process(self->core, now_ms(self));
    driver_transmit(self);
    const uint32_t hold_ms = held_for_ms(self);
    retry_ms = hold_ms < retry_ms ? hold_ms : retry_ms;
    return wait_ms < retry_ms ? wait_ms : retry_ms;
}

// What the other end said, for people: a blank for each run of what cannot be printed.
static void put_words(const driver_t *self, char *text, size_t capacity) {
    size_t used = 0;
    bool blank = false;
    for (size_t i = 0; i < self->words && used + 2 < capacity; i++) {
        const bool shows = self->word[i] > ' ' && self->word[i] <= '~';
        if (shows && blank && used > 0) {
            text[used++] = ' ';
        }
        if (shows) {
            text[used++] = (char)self->word[i];
        }
        blank = !shows;
    }
    text[used] = '\0';
}

void driver_explain_turned_away(const driver_t *self, char *text, size_t capacity) {
    char name[HAL_LINK_NAME_MAX];
    char words[sizeof self->word + 2];
    hal_link_spec_name(&self->spec, name, sizeof name);
    put_words(self, words, sizeof words);
    const bool spoke = words[0] != '\0';
    snprintf(text, capacity,
             "%s: the other end accepts and closes before a robot answers, %u times so far%s%s%s: %s", name,
             (unsigned)self->fruitless, spoke ? ", saying '" : "", words, spoke ? "'" : "",
             self->spec.scheme->if_turned_away);
}

bool driver_is_turned_away(const driver_t *self) {
    return self->fruitless >= FRUITLESS_MIN && !is_of_use(self);
}

// The reason as of now; HAL_LINK_OK: none, the link is of use. What an attempt brought while the link is
// turned away is the same reason.
static hal_link_error_t reason_now(const driver_t *self) {
    if (driver_is_turned_away(self)) {
        return HAL_LINK_CLOSED;
    }
    if (self->up) {
        return self->told == HAL_LINK_CLOSED && !is_of_use(self) ? HAL_LINK_CLOSED : HAL_LINK_OK;
    }
    return self->failed ? self->error : self->told;
}

// What stands beside the reason may change, too: the adapter has come back under another name.
static bool has_changed(driver_t *self, const hal_link_error_t reason) {
    char why[ARGUSD_MESSAGE_MAX];
    if (reason == self->told && (reason == HAL_LINK_OK || reason == HAL_LINK_CLOSED || !self->tried)) {
        return false;
    }
    self->tried = false;
    hal_transport_explain(&self->spec, reason, why, sizeof why);
    const uint32_t sum = hal_crc32(0, why, strlen(why));
    const bool changed = reason != self->told || sum != self->told_sum;
    self->told_sum = sum;
    return changed;
}

bool driver_meets_telnet(const driver_t *self) {
    return self->words > 1 && self->word[0] == TELNET_IAC && self->word[1] >= TELNET_WILL &&
           self->word[1] < TELNET_IAC;
}

// A session may open even so: only packets with a byte FF are damaged.
static bool has_met_telnet(driver_t *self, char *text, size_t capacity) {
    if (self->telnet_told || !driver_meets_telnet(self)) {
        return false;
    }
    self->telnet_told = true;
    snprintf(text, capacity, "%s: %s", hal_link_describe(&self->link), DRIVER_TELNET);
    return true;
}

bool driver_reason(driver_t *self, char *text, size_t capacity) {
    const hal_link_error_t reason = reason_now(self);
    if (self->up && has_met_telnet(self, text, capacity)) {
        return true;
    }
    if (self->transport == NULL || !has_changed(self, reason)) {
        return false;
    }
    self->told = reason;
    if (reason == HAL_LINK_OK) {
        snprintf(text, capacity, "%s: open again", hal_link_describe(&self->link));
    } else if (reason == HAL_LINK_CLOSED) {
        driver_explain_turned_away(self, text, capacity);
    } else {
        char why[ARGUSD_MESSAGE_MAX];
        hal_transport_explain(&self->spec, reason, why, sizeof why);
        snprintf(text, capacity, "%.*s; trying again until it is there", ARGUSD_MESSAGE_MAX - 64, why);
    }
    return true;
}

bool driver_wants_write(const driver_t *self) {
    return self->up && hal_link_hold_ms(&self->link) == 0 &&
           (self->held > 0 || hal_link_flush(&self->link) > 0);
}

void driver_close(driver_t *self) {
    hal_link_close(&self->link);
    self->up = false;
}
