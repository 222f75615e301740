// SPDX-License-Identifier: MIT
// Telemetry between the manager and a CAN socket.
#include "bus.h"

#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

#include "text.h"

#define FRAMES_MAX 16 // in one call: a bus that takes everything must not keep time from passing

uint64_t bus_seed(void) {
    uint64_t seed = 0;
    struct timespec wall = {0};
    if (getrandom(&seed, sizeof seed, GRND_NONBLOCK) == (ssize_t)sizeof seed) {
        return seed;
    }
    clock_gettime(CLOCK_REALTIME, &wall); // early at boot
    return (uint64_t)wall.tv_sec << 32 ^ (uint64_t)wall.tv_nsec ^ (uint64_t)getpid() << 20;
}

bool bus_open(bus_t *self, const hal_can_spec_t *spec, const hal_can_sys_t *sys, uint32_t stale_ms,
              uint64_t seed, uint32_t now_ms, char *message, size_t capacity) {
    memset(self, 0, sizeof *self);
    hal_can_raw_init(&self->raw, sys);
    hal_telemetry_init(&self->telemetry, spec->robot, stale_ms, seed, now_ms);
    const hal_link_error_t error =
        hal_can_raw_open(&self->raw, spec->interface, hal_telemetry_command_id(&self->telemetry), now_ms);
    if (error != HAL_LINK_OK) {
        hal_can_raw_explain(error, spec->interface, message, capacity);
        return false;
    }
    self->on = true;
    return true;
}

void bus_event(bus_t *self, const argus_status_t *status, const argus_event_t *event) {
    if (self->on) {
        hal_telemetry_event(&self->telemetry, status, event);
    }
}

// A frame that says how things are is of no use when the interface comes up again; an emergency is.
static void forget_old(bus_t *self) {
    if (self->raw.error != HAL_LINK_OK && self->held.id >= HAL_DBC_HEARTBEAT_ID) {
        self->holds = false;
    }
}

uint32_t bus_process(bus_t *self, const argus_status_t *status, uint32_t now_ms) {
    if (!self->on) {
        return UINT32_MAX;
    }
    hal_can_raw_process(&self->raw, now_ms);
    for (int i = 0; i < FRAMES_MAX; i++) {
        const uint32_t wait_ms = hal_can_raw_wait_ms(&self->raw, now_ms);
        if (wait_ms > 0) {
            forget_old(self);
            return wait_ms;
        }
        self->holds = self->holds || hal_telemetry_next(&self->telemetry, status, now_ms, &self->held);
        if (!self->holds) {
            break;
        }
        self->holds =
            !hal_can_raw_send(&self->raw, self->held.id, self->held.data, self->held.length, now_ms);
    }
    return hal_telemetry_due_ms(&self->telemetry, now_ms);
}

bool bus_order(bus_t *self, uint32_t now_ms, hal_telemetry_verdict_t *verdict, hal_dbc_command_t *order) {
    uint8_t data[HAL_DBC_LENGTH] = {0};
    const int length = self->on ? hal_can_raw_receive(&self->raw, data, now_ms) : -1;
    if (length < 0) {
        return false;
    }
    *verdict = hal_telemetry_take(&self->telemetry, data, (size_t)length, now_ms, order);
    return true;
}

bool bus_notice(bus_t *self, char *text, size_t capacity) {
    if (!self->on) {
        return false;
    }
    if (self->raw.bus_off != self->bus_off_said) {
        self->bus_off_said = self->raw.bus_off;
        snprintf(text, capacity,
                 "%s: bus-off: check wiring, termination and bitrate; ip link set %s type can restart-ms 100 "
                 "makes it come back by itself",
                 self->raw.interface, self->raw.interface);
        return true;
    }
    if (self->raw.error == self->said) {
        return false;
    }
    self->said = self->raw.error;
    if (self->said == HAL_LINK_OK) {
        snprintf(text, capacity, "telemetry: %s is back", self->raw.interface);
        return true;
    }
    char reason[ARGUSD_MESSAGE_MAX / 2];
    hal_can_raw_explain(self->said, self->raw.interface, reason, sizeof reason);
    snprintf(text, capacity, "telemetry: %s", reason);
    return true;
}

bool bus_refusal(bus_t *self, hal_telemetry_verdict_t verdict, uint32_t now_ms, char *text, size_t capacity) {
    if (self->ever_refused && now_ms - self->refused_ms < BUS_SAY_MS) {
        return false;
    }
    self->ever_refused = true;
    self->refused_ms = now_ms;
    snprintf(text, capacity, "%s: an order was refused: %s", self->raw.interface,
             hal_telemetry_verdict_text(verdict));
    return true;
}

bool bus_link_notice(bus_t *self, const hal_isotp_t *link, uint32_t now_ms, char *text, size_t capacity) {
    if (self->ever_link && now_ms - self->link_said_ms < BUS_SAY_MS) {
        return false;
    }
    for (int i = 0; i < HAL_ISOTP_ERRORS; i++) {
        if (link->errors[i] != self->link_said[i]) {
            self->link_said[i] = link->errors[i];
            self->link_said_ms = now_ms;
            self->ever_link = true;
            snprintf(text, capacity, "%s: %s (%u so far)", link->text,
                     hal_isotp_error_text((hal_isotp_error_t)i), (unsigned)link->errors[i]);
            return true;
        }
    }
    return false;
}

int bus_fd(const bus_t *self) {
    return self->on ? hal_can_raw_fd(&self->raw) : -1;
}

void bus_close(bus_t *self, const argus_status_t *status, uint32_t now_ms) {
    hal_telemetry_frame_t frame;
    if (!self->on) {
        return;
    }
    (void)bus_process(self, status, now_ms);
    hal_telemetry_farewell(&self->telemetry, status, now_ms, &frame);
    (void)hal_can_raw_send(&self->raw, frame.id, frame.data, frame.length, now_ms);
    hal_can_raw_close(&self->raw);
    self->on = false;
}
