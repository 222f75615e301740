// SPDX-License-Identifier: MIT
// argusd on the vehicle's CAN bus: telemetry out, orders in.
#ifndef ARGUSD_BUS_H
#define ARGUSD_BUS_H

#include "argusd.h"
#include "hal/can_raw.h"
#include "hal/can_telemetry.h"
#include "hal/isotp.h"

#define BUS_SAY_MS 10000u // between two lines about the same thing

typedef struct {
    bool on;
    hal_can_raw_t raw;
    hal_telemetry_t telemetry;
    bool holds; // a frame that the interface has not taken yet
    hal_telemetry_frame_t held;
    hal_link_error_t said; // last said about the interface
    uint32_t refused_ms;   // when a refused order was said last
    bool ever_refused;
    uint32_t bus_off_said;
    uint32_t link_said[HAL_ISOTP_ERRORS]; // errors of a link over CAN, as told
    uint32_t link_said_ms;
    bool ever_link;
} bus_t;

// Starts telemetry of the spec's robot on its interface. `stale_ms`: as in the settings. False: `message`
// says why not and what to do.
bool bus_open(bus_t *self, const hal_can_spec_t *spec, const hal_can_sys_t *sys, uint32_t stale_ms,
              uint64_t seed, uint32_t now_ms, char *message, size_t capacity);

// A number that differs from start to start.
uint64_t bus_seed(void);

// Call with each event, before it is shown.
void bus_event(bus_t *self, const argus_status_t *status, const argus_event_t *event);

// Sends what is due, as far as the interface takes it; returns the ms until it wants to be called again.
uint32_t bus_process(bus_t *self, const argus_status_t *status, uint32_t now_ms);

// The next frame received on the command id; false: none. `order` is to be carried out if it is TAKEN.
bool bus_order(bus_t *self, uint32_t now_ms, hal_telemetry_verdict_t *verdict, hal_dbc_command_t *order);

// What is to be told to people, on one line; false: nothing.
bool bus_notice(bus_t *self, char *text, size_t capacity);
bool bus_refusal(bus_t *self, hal_telemetry_verdict_t verdict, uint32_t now_ms, char *text, size_t capacity);

// Errors of a link over CAN, one kind at a time; false: nothing new, or too soon.
bool bus_link_notice(bus_t *self, const hal_isotp_t *link, uint32_t now_ms, char *text, size_t capacity);

int bus_fd(const bus_t *self); // -1: none

// A last heartbeat, then silence.
void bus_close(bus_t *self, const argus_status_t *status, uint32_t now_ms);

#endif
