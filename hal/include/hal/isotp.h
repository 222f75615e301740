// SPDX-License-Identifier: MIT
// ARCOS over CAN as a link: one packet per PDU of the kernel's ISO-TP (ISO 15765-2), both directions.
//
// Nothing here waits, except that closing a socket in the middle of a transfer can take the kernel 1 s. That
// happens only when argusd ends, or when the interface was removed. CAN_ISOTP_WAIT_TX_DONE is not set, since
// with it send() would wait for the robot. So a later read reports a transfer that failed. It is counted
// there as an error, and the link goes on.
#ifndef HAL_ISOTP_H
#define HAL_ISOTP_H

#include <errno.h>
#include <stdbool.h>

#include "hal/can_ear.h"
#include "hal/can_spec.h"
#include "hal/can_sys.h"
#include "hal/link.h"

#define HAL_ISOTP_PDU_MAX 258 // the longest ARCOS packet: COUNT 255 and 3 bytes

#define HAL_ISOTP_FORMAT_TEXT \
    "CAN FD frames where this link has classic ones, or the reverse: give or leave out fd in --link"

// Errors that a session survives, counted. X(NAME, name in reports, errno, text); errno 0: found by
// ourselves.
#define HAL_ISOTP_ERROR_TABLE(X)                                                              \
    X(NO_FLOW, no_flow, ECOMM, "no flow control came, a packet to the robot was lost")        \
    X(OVERFLOW, overflow, EMSGSIZE, "the robot's end said overflow, a packet to it was lost") \
    X(TIMEOUT, timeout, ETIMEDOUT, "the rest of a packet from the robot did not come")        \
    X(SEQUENCE, sequence, EILSEQ, "a packet from the robot came in wrong order")              \
    X(BAD_FRAME, bad_frame, EBADMSG, "a frame from the robot was malformed")                  \
    X(TOO_LONG, too_long, 0, "a message was longer than any packet")                          \
    X(NO_BUFFERS, no_buffers, ENOBUFS, "the interface's queue was full")                      \
    X(FORMAT, format, 0, HAL_ISOTP_FORMAT_TEXT)                                               \
    X(DOWN, down, ENETDOWN, "the interface went down")

typedef enum {
#define HAL_ISOTP_ERROR_ENUM(name, word, number, text) HAL_ISOTP_##name,
    HAL_ISOTP_ERROR_TABLE(HAL_ISOTP_ERROR_ENUM)
#undef HAL_ISOTP_ERROR_ENUM
        HAL_ISOTP_ERRORS
} hal_isotp_error_t;

typedef struct {
    const hal_can_sys_t *sys;
    hal_can_ear_t ear; // until a PDU came
    int fd;            // -1: none
    int index;         // of the interface that it is bound to
    bool is_open;      // else a socket is kept for when the interface comes up again
    bool is_down;      // the interface went down
    uint8_t hold;      // the queue was full: try again soon
    uint16_t taken;    // of the PDU held, for readers with little room
    uint16_t length;
    uint8_t pdu[HAL_ISOTP_PDU_MAX + 1]; // a byte more, so that a longer one is seen
    uint32_t errors[HAL_ISOTP_ERRORS];  // monotonic
    hal_link_counters_t counters;
    char text[HAL_CAN_NAME_MAX + 32];
} hal_isotp_t;

void hal_isotp_init(hal_isotp_t *self, const hal_can_sys_t *sys);

// Opens the interface's socket, or takes the one that was kept when it went down. HAL_LINK_NO_CAN and
// HAL_LINK_NO_PROTOCOL: the kernel lacks it or its module is not loaded.
hal_link_error_t hal_isotp_open(hal_isotp_t *self, const hal_can_spec_t *spec);

hal_link_t hal_isotp_link(hal_isotp_t *self);

const char *hal_isotp_error_name(hal_isotp_error_t error);
const char *hal_isotp_error_text(hal_isotp_error_t error);

// What to do about an error of hal_isotp_open(), on one line.
void hal_isotp_explain(hal_link_error_t error, const hal_can_spec_t *spec, char *text, size_t capacity);

#endif
