// SPDX-License-Identifier: MIT
// A link carries bytes to and from the robot: one struct for serial, TCP and the fake.
//
// Not thread-safe. The caller owns every struct; nothing is allocated. A hal_link_t is a view: it stays valid
// as long as the struct that it was made from.
#ifndef HAL_LINK_H
#define HAL_LINK_H

#include <stddef.h>
#include <stdint.h>

// Longest packet that one write may carry. ARCOS sends at most 200 bytes.
#define HAL_LINK_PACKET_MAX 256

// What can go wrong. Negative, so that calls which return counts can return them too. X(NAME, value, text).
#define HAL_LINK_ERROR_TABLE(X)                                                            \
    X(CLOSED, -1, "the other end closed the link")                                         \
    X(GONE, -2, "the device is gone (unplugged, or its other end has ended)")              \
    X(NOT_FOUND, -3, "no such file")                                                       \
    X(DENIED, -4, "no permission")                                                         \
    X(BUSY, -5, "another program uses it")                                                 \
    X(NOT_SERIAL, -6, "not a serial port")                                                 \
    X(BAD_BAUD, -7, "this rate is not one that the robot knows, or the port cannot do it") \
    X(UNRESOLVED, -8, "no address is known for this host name")                            \
    X(REFUSED, -9, "nobody listens there")                                                 \
    X(UNREACHABLE, -10, "no way to this host")                                             \
    X(TIMEOUT, -11, "no answer in time")                                                   \
    X(CANCELLED, -12, "given up on request")                                               \
    X(TOO_LONG, -13, "longer than a packet may be")                                        \
    X(NOT_OPEN, -14, "the link is not open")                                               \
    X(BAD_ARGUMENT, -15, "bad argument")                                                   \
    X(IO, -16, "input/output error")                                                       \
    X(NO_CAN, -17, "the kernel has no CAN")                                                \
    X(NO_PROTOCOL, -18, "the kernel has CAN, but not this protocol")                       \
    X(NOT_CAN, -19, "not a CAN interface")                                                 \
    X(DOWN, -20, "the interface is down")                                                  \
    X(NO_FD, -21, "the interface is not set up for CAN FD")

typedef enum {
    HAL_LINK_OK = 0,
#define HAL_LINK_ERROR_ENUM(name, value, text) HAL_LINK_##name = (value),
    HAL_LINK_ERROR_TABLE(HAL_LINK_ERROR_ENUM)
#undef HAL_LINK_ERROR_ENUM
} hal_link_error_t;

// Text of an error, without a full stop; "ok" for 0, "unknown error" for what is not in the table.
const char *hal_link_error_text(int error);

typedef struct {
    uint32_t bytes_in; // monotonic counters
    uint32_t bytes_out;
    uint32_t writes;
    uint32_t would_block; // writes that were not taken because the transport was full
} hal_link_counters_t;

typedef struct {
    // Never waits. Bytes read, 0 when there are none now, or an error; after an error the link is of no use
    // but to close.
    int (*read)(void *context, uint8_t *bytes, size_t capacity);
    // Never waits. Takes the packet whole (returns its length) or not at all (0: full, try when writable), or
    // an error. A part that the transport did not take at once is kept and goes out first.
    int (*write)(void *context, const uint8_t *packet, size_t count);
    // Pushes what write kept; bytes still kept, or an error.
    int (*flush)(void *context);
    // Not 0: after a write that was not taken, try again after so many ms, since poll() would call it
    // writable at once. NULL: always 0.
    uint32_t (*hold_ms)(const void *context);
    int (*fd)(const void *context); // for poll(); -1 when there is none or the link is closed
    const char *(*describe)(const void *context);
    const hal_link_counters_t *(*counters)(const void *context);
    void (*close)(void *context); // may be called twice
} hal_link_ops_t;

typedef struct {
    const hal_link_ops_t *ops; // NULL: no link; the calls below then say HAL_LINK_NOT_OPEN
    void *context;
} hal_link_t;

int hal_link_read(const hal_link_t *link, uint8_t *bytes, size_t capacity);
int hal_link_write(const hal_link_t *link, const uint8_t *packet, size_t count);
int hal_link_flush(const hal_link_t *link);
uint32_t hal_link_hold_ms(const hal_link_t *link);
int hal_link_fd(const hal_link_t *link);
const char *hal_link_describe(const hal_link_t *link);
hal_link_counters_t hal_link_counters(const hal_link_t *link);
void hal_link_close(const hal_link_t *link);

#endif
