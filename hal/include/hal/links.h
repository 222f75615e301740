// SPDX-License-Identifier: MIT
// The links that a host can open: their text forms, and what argusd has to know of each.
//
// A new one is a file in hal/posix or hal/linux that defines its hal_scheme_t, and a row here.
#ifndef HAL_LINKS_H
#define HAL_LINKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/isotp.h"
#include "hal/link.h"

// Every scheme, X(name) for the hal_scheme_t hal_name_scheme, in the order of the help text.
#define HAL_SCHEME_TABLE(X) X(serial) X(tcp) X(can)

#define HAL_LINK_TARGET_MAX 256
#define HAL_LINK_NAME_MAX (HAL_LINK_TARGET_MAX + 16) // with a port
#define HAL_LINK_ADDRESS_BYTES 64
#define HAL_LINK_STATE_BYTES 2048

// For a file that defines a scheme: what it keeps has room.
#define HAL_LINK_FITS(type, bytes) _Static_assert(sizeof(type) <= (bytes), "hal/links.h: raise " #bytes)

typedef struct hal_scheme hal_scheme_t;

// What a text says: scheme:target and more.
typedef struct {
    const hal_scheme_t *scheme; // NULL: none was read
    char target[HAL_LINK_TARGET_MAX];
    uint32_t baud; // 0: a link without a rate
    bool has_baud; // the rate was given, not defaulted
    union {
        uint64_t align;
        uint8_t bytes[HAL_LINK_ADDRESS_BYTES]; // what else the scheme reads and uses
    } address;
} hal_link_spec_t;

// A row of the table. `state` is HAL_LINK_STATE_BYTES of memory that are the scheme's own.
struct hal_scheme {
    const char *word; // before the ':'
    const char *form; // an example, for refusals
    const char *help; // all that may be written; at most 79 characters a line
    const char *bare; // how a text may begin whose scheme was forgotten; NULL: none
    // Ends "passive, since a real robot may be ...".
    const char *robot_place;
    const char *if_silent;      // a hint when nothing is received; "" or begins with a blank
    const char *if_garbage;     // when no packet is among what is received
    const char *if_turned_away; // when the other end closes before a robot answers, time and again
    int32_t as_baud;            // the rate of a wire as fast, for a link without a rate; 0: none
    uint32_t settle_ms;         // after it came up, until the manager is told; 0: at once

    // What follows "WORD:". False: `message` says on one line what is wrong and what to write instead.
    bool (*parse)(hal_link_spec_t *spec, const char *text, char *message, size_t capacity);
    // The target as people know it; NULL: as it is written.
    void (*name)(const hal_link_spec_t *spec, char *text, size_t capacity);
    // True when the link ends in this machine, as one to an emulator does. NULL: never.
    bool (*stays_here)(const hal_link_spec_t *spec);
    void (*init)(void *state);
    // May be called again once the link is closed. `cancel_fd` as in hal_tcp_open().
    hal_link_error_t (*open)(void *state, const hal_link_spec_t *spec, int timeout_ms, int cancel_fd);
    hal_link_t (*link)(void *state);
    // One line about a failed opening: what, why, what to do.
    void (*explain)(const hal_link_spec_t *spec, hal_link_error_t error, char *text, size_t capacity);
    // True when opening again would lead to another device; NULL: never.
    bool (*moved)(const void *state);
    // Another rate for the open link; NULL: it has none that could be looked for.
    hal_link_error_t (*set_baud)(void *state, uint32_t baud);
    // The CAN bus that the link is on, and the errors that its session survived; NULL: on none.
    const hal_can_spec_t *(*bus)(const hal_link_spec_t *spec);
    const hal_isotp_t *(*isotp)(const void *state);
};

#define HAL_SCHEME_DECLARE(name) extern const hal_scheme_t hal_##name##_scheme;
HAL_SCHEME_TABLE(HAL_SCHEME_DECLARE)
#undef HAL_SCHEME_DECLARE

// The table, from 0; NULL behind its end.
const hal_scheme_t *hal_scheme_at(size_t index);

// One form of each scheme, as in "serial:/dev/ttyUSB0@9600, tcp:HOST:8101 or can:can0".
void hal_scheme_forms(char *text, size_t capacity);

// Reads a spec. False: `message` says on one line what is wrong and what to write instead; `spec` is
// unspecified.
bool hal_link_spec_parse(hal_link_spec_t *spec, const char *text, char *message, size_t capacity);

// What the spec leads to: path, host or interface; "" for one that was never read.
const char *hal_link_spec_target(const hal_link_spec_t *spec);

// The same as people know it: with the port, where there is one.
void hal_link_spec_name(const hal_link_spec_t *spec, char *text, size_t capacity);

// True when the link ends in this machine, as one to an emulator does: argusd then drives at once.
bool hal_link_spec_stays_here(const hal_link_spec_t *spec);

// True when a robot's rate can be looked for.
bool hal_link_spec_has_rate(const hal_link_spec_t *spec);

// The CAN bus of the link; NULL: it is on none.
const hal_can_spec_t *hal_link_spec_bus(const hal_link_spec_t *spec);

// Room for any one link.
typedef struct {
    const hal_scheme_t *scheme; // of what `state` holds; NULL: nothing yet
    union {
        uint64_t align;
        uint8_t bytes[HAL_LINK_STATE_BYTES];
    } state;
} hal_transport_t;

void hal_transport_init(hal_transport_t *self);

// Opens what the spec names; `link` is set on HAL_LINK_OK only. `cancel_fd` as in hal_tcp_open(). Whoever
// comes with another scheme has closed the link before.
hal_link_error_t hal_transport_open(hal_transport_t *self, const hal_link_spec_t *spec, int timeout_ms,
                                    int cancel_fd, hal_link_t *link);

// True when opening the same spec again would lead to another device.
bool hal_transport_moved(const hal_transport_t *self);

// Another rate for the open link; HAL_LINK_BAD_BAUD where there is none.
hal_link_error_t hal_transport_set_baud(hal_transport_t *self, uint32_t baud);

// The link over CAN; NULL: it is none.
const hal_isotp_t *hal_transport_isotp(const hal_transport_t *self);

// One line about a failed opening: what, why, what to do.
void hal_transport_explain(const hal_link_spec_t *spec, hal_link_error_t error, char *text, size_t capacity);

// For the files that define a scheme.

// Writes what is wrong; always false.
__attribute__((format(printf, 3, 4))) bool hal_link_refuse(char *message, size_t capacity, const char *format,
                                                           ...);

// A decimal number of 1 to 6 digits and nothing else.
bool hal_link_number(const char *text, uint32_t *value);

// Takes `length` characters as the target. False: there are none, or `capacity` does not hold them.
bool hal_link_take_target(hal_link_spec_t *spec, const char *text, size_t length, size_t capacity);

#endif
