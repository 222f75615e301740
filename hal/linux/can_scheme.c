// SPDX-License-Identifier: MIT
// The scheme can:IFACE[,key=value...]: ARCOS over ISO-TP.
#include <string.h>

#include "hal/links.h"

// A robot that was sending without a receiver waits up to 1 s for flow control before its next SIP (N_Bs of
// ISO-TP). Until a SIP could have come, SYNC0 may be a PULSE to an old session, on which the robot takes up
// its old motion.
#define SETTLE_MS 1150u

#define AS_BAUD 115200 // bytes in ISO-TP at 500 kbit/s take less time than so

HAL_LINK_FITS(hal_can_spec_t, HAL_LINK_ADDRESS_BYTES);
HAL_LINK_FITS(hal_isotp_t, HAL_LINK_STATE_BYTES);

static const hal_can_spec_t *bus(const hal_link_spec_t *spec) {
    const void *const address = spec->address.bytes;
    return address;
}

static bool parse(hal_link_spec_t *spec, const char *text, char *message, size_t capacity) {
    hal_can_spec_t can;
    if (!hal_can_spec_parse(&can, text, message, capacity)) {
        return false;
    }
    memcpy(spec->address.bytes, &can, sizeof can);
    return hal_link_take_target(spec, can.interface, strlen(can.interface), HAL_CAN_NAME_MAX);
}

static void init(void *state) {
    hal_isotp_init(state, &hal_can_sys);
}

static hal_link_error_t open_bus(void *state, const hal_link_spec_t *spec, int timeout_ms, int cancel_fd) {
    (void)timeout_ms; // opening a socket does not wait
    (void)cancel_fd;
    return hal_isotp_open(state, bus(spec));
}

static hal_link_t link_of(void *state) {
    return hal_isotp_link(state);
}

static void explain(const hal_link_spec_t *spec, hal_link_error_t error, char *text, size_t capacity) {
    hal_isotp_explain(error, bus(spec), text, capacity);
}

static const hal_isotp_t *isotp(const void *state) {
    return state;
}

const hal_scheme_t hal_can_scheme = {
    .word = "can",
    .form = "can:can0",
    .help = "can:IFACE[,robot=K][,tx=ID][,rx=ID][,pad=BYTE|none][,stmin=MS][,bs=N][,fd]:\n"
            "ISO-TP (default robot=0, tx=0x640+K, rx=0x648+K, pad=0xCC, stmin=0, bs=0)",
    .robot_place = "on the CAN bus",
    .if_silent = " Do ids and fd agree at both ends?",
    .if_garbage = "this is no robot that speaks ARCOS: check the two ids",
    .if_turned_away = "is the device in order, and is nobody else at it?",
    .as_baud = AS_BAUD,
    .settle_ms = SETTLE_MS,
    .parse = parse,
    .init = init,
    .open = open_bus,
    .link = link_of,
    .explain = explain,
    .bus = bus,
    .isotp = isotp,
};
