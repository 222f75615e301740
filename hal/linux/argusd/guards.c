// SPDX-License-Identifier: MIT
// Serves one client at a time, whichever port it came by.
#include "guards.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "arcos/frame.h"

#define READ_BYTES 512
#define READS_PER_TURN 4 // a flood must not keep the robot waiting
#define STALE_MS 10000u  // a client so long without a sign of life makes room for another
#define SAY_MS 10000u    // between two lines about what is no client
#define OUT_BYTES 1024

argusd_exit_t guards_open(guards_t *self, const guards_options_t *options, driver_t *driver, char *message,
                          size_t capacity) {
    memset(self, 0, sizeof *self);
    self->served = -1;
    self->driver = driver;
    self->readings = options->readings;
    for (int i = 0; i < options->count; i++) {
        if (!guard_port_open(&self->at[i], &options->at[i], options->beyond, message, capacity)) {
            const bool refused = self->at[i].refused;
            guards_close(self, 0);
            return refused ? ARGUSD_EXIT_USAGE : ARGUSD_EXIT_LINK;
        }
        self->count = i + 1;
    }
    return ARGUSD_EXIT_OK;
}

void guards_wait(const guards_t *self, struct pollfd *wait) {
    for (int i = 0; i < GUARDS_MAX; i++) {
        const guard_port_t *const at = &self->at[i];
        const bool tcp = i < self->count && at->spec.kind == GUARD_TCP;
        const bool held = i == self->served && self->held_count > 0;
        wait[2 * i] = (struct pollfd){.fd = tcp ? at->listener : -1, .events = POLLIN};
        wait[2 * i + 1] = (struct pollfd){.fd = i < self->count ? guard_port_fd(at) : -1,
                                          .events = (short)(held ? POLLIN | POLLOUT : POLLIN)};
    }
}

static void flush(guards_t *self, uint32_t now_ms) {
    if (self->served < 0 || self->held_count == 0) {
        return;
    }
    const size_t put = guard_port_write(&self->at[self->served], self->held, self->held_count);
    if (put > 0) {
        self->held_count -= put;
        memmove(self->held, self->held + put, self->held_count);
        self->taken_ms = now_ms;
    }
}

static void pass(guards_t *self, uint32_t now_ms, argus_port_io_t io) {
    uint8_t out[OUT_BYTES];
    io.readings = (uint8_t)self->readings;
    io.there = self->served >= 0 && self->spoken;
    io.out = out;
    for (;;) {
        const size_t room = sizeof self->held - self->held_count;
        io.capacity = room < sizeof out ? room : sizeof out;
        const size_t count = argus_guard_port(self->driver->core, &self->port, now_ms, &io);
        memcpy(self->held + self->held_count, out, count);
        self->held_count += count;
        if (count == 0) {
            break;
        }
        io.client_count = 0;
        io.robot_count = 0;
    }
    flush(self, now_ms);
}

static void see_robot(void *context, bool from_robot, const uint8_t *bytes, size_t count) {
    guards_t *const self = context;
    (void)from_robot;
    pass(self, hal_clock_now_ms(&self->driver->clock),
         (argus_port_io_t){.robot = bytes, .robot_count = count});
}

driver_tap_t guards_tap(guards_t *self) {
    return (driver_tap_t){.see = see_robot, .context = self};
}

// The client it was serving is gone: said to the manager before another is heard.
static void leave(guards_t *self, uint32_t now_ms) {
    self->served = -1;
    self->held_count = 0;
    pass(self, now_ms, (argus_port_io_t){0});
}

static bool is_stale(const guards_t *self, uint32_t now_ms) {
    return now_ms - self->heard_ms >= STALE_MS ||
           (self->held_count > 0 && now_ms - self->taken_ms >= STALE_MS);
}

static void turn_away(guards_t *self, const guard_port_t *at) {
    snprintf(self->notice, sizeof self->notice,
             "guard %s: a second client was turned away; one at a time, and the first one is still there",
             at->spec.text);
}

static void welcome(guards_t *self, int index, uint32_t now_ms) {
    self->served = index;
    self->spoken = self->at[index].spec.kind == GUARD_PTY;
    self->heard_ms = now_ms;
    self->taken_ms = now_ms;
}

// One that has given no sign of life for long makes room.
static void make_room(guards_t *self, uint32_t now_ms) {
    if (self->served >= 0 && is_stale(self, now_ms)) {
        guard_port_drop(&self->at[self->served]);
        leave(self, now_ms);
    }
}

// One at a port where the first client is still there, or at another port than the one that is served. One
// that came by a pty cannot be closed; it is not heard until the first one has gone.
static void take_second(guards_t *self, guard_port_t *at, int other) {
    turn_away(self, at);
    if (other >= 0) {
        close(other);
    } else if (at->spec.kind == GUARD_TCP) {
        guard_port_drop(at);
    }
}

static void greet(guards_t *self, int index, uint32_t now_ms) {
    guard_port_t *const at = &self->at[index];
    const bool was_there = at->client >= 0;
    int other = -1;
    guard_port_accept(at, &other);
    // cppcheck-suppress incorrectLogicOperator ; guard_port_accept() may have set at->client
    const bool came = other >= 0 || (!was_there && at->client >= 0);
    if (came) {
        make_room(self, now_ms);
    }
    if (at->client < 0) {
        at->client = other;
        other = -1;
    }
    if (self->served < 0 && at->client >= 0) { // also one that had to wait at a pty
        welcome(self, index, now_ms);
    } else if (came) {
        take_second(self, at, other);
    }
}

// A page in a browser of this machine can reach a TCP port: HTTP and TLS begin with other bytes than a
// packet.
static bool is_foreign(guards_t *self, uint8_t first, uint32_t now_ms) {
    const bool foreign = !self->spoken && first != ARCOS_FRAME_HEADER0;
    self->spoken = !foreign;
    if (foreign &&
        (!self->foreign_said || now_ms - self->foreign_ms >= SAY_MS)) { // a page tries again and again
        self->foreign_said = true;
        self->foreign_ms = now_ms;
        snprintf(self->notice, sizeof self->notice,
                 "guard %s: what came is not ARCOS (a page in a browser?) and was turned away",
                 self->at[self->served].spec.text);
    }
    return foreign;
}

static void hear(guards_t *self, uint32_t now_ms) {
    uint8_t bytes[READ_BYTES];
    const int index = self->served;
    for (int i = 0; i < READS_PER_TURN && self->served >= 0; i++) {
        const size_t got = guard_port_read(&self->at[index], bytes, sizeof bytes);
        if (got > 0 && is_foreign(self, bytes[0], now_ms)) {
            guard_port_drop(&self->at[index]);
        }
        if (self->at[index].client < 0) {
            leave(self, now_ms);
            return;
        }
        if (got == 0) {
            break;
        }
        self->heard_ms = now_ms;
        pass(self, now_ms, (argus_port_io_t){.client = bytes, .client_count = got});
    }
    pass(self, now_ms, (argus_port_io_t){0});
}

// Those on ptys that are not served: what they say is dropped.
static void ignore_others(guards_t *self) {
    uint8_t bytes[READ_BYTES];
    for (int i = 0; i < self->count; i++) {
        if (i != self->served && self->at[i].client >= 0) {
            (void)guard_port_read(&self->at[i], bytes, sizeof bytes);
        }
    }
}

void guards_serve(guards_t *self, uint32_t now_ms) {
    if (self->count == 0) {
        return;
    }
    hear(self, now_ms); // whether it has gone, before the next one is turned away
    for (int i = 0; i < self->count; i++) {
        greet(self, i, now_ms);
    }
    ignore_others(self);
    driver_transmit(self->driver);
}

bool guards_notice(guards_t *self, char *text, size_t capacity) {
    const bool is_new = self->notice[0] != '\0';
    snprintf(text, capacity, "%s", self->notice);
    self->notice[0] = '\0';
    return is_new;
}

void guards_close(guards_t *self, uint32_t now_ms) {
    if (self->served >= 0) {
        leave(self, now_ms);
    }
    for (int i = 0; i < self->count; i++) {
        guard_port_close(&self->at[i]);
    }
    self->count = 0;
}
