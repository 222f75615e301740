// SPDX-License-Identifier: MIT
// The guard ports of argusd: the one client that is served, and those that are turned away.
#ifndef ARGUSD_GUARDS_H
#define ARGUSD_GUARDS_H

#include <poll.h>

#include "argus/argus.h"
#include "argusd.h"
#include "driver.h"
#include "guard_port.h"

#define GUARDS_MAX 4
#define GUARDS_FDS (2 * GUARDS_MAX) // of each the listener and the client
#define GUARDS_HELD 2048            // bytes that a client's socket has not taken yet

// As the command line says.
typedef struct {
    guard_spec_t at[GUARDS_MAX];
    int count;
    argus_readings_t readings;
    bool beyond; // hosts other than loopback
} guards_options_t;

typedef struct {
    guard_port_t at[GUARDS_MAX];
    int count;
    int served;  // the port of its client; -1: none
    bool spoken; // it has begun with the first byte of a packet
    argus_readings_t readings;
    driver_t *driver;
    argus_port_storage_t port;
    uint8_t held[GUARDS_HELD];
    size_t held_count;
    uint32_t foreign_ms; // what is no client was said last,
    bool foreign_said;   // ... if ever
    uint32_t heard_ms;   // something of the client, last
    uint32_t taken_ms;   // it took bytes, last
    char notice[ARGUSD_MESSAGE_MAX];
} guards_t;

// OK; else `message` says why, and what was opened is closed again: LINK, or USAGE for a host beyond
// loopback.
argusd_exit_t guards_open(guards_t *self, const guards_options_t *options, driver_t *driver, char *message,
                          size_t capacity);

// What to wait for, GUARDS_FDS places; those without use are -1.
void guards_wait(const guards_t *self, struct pollfd *wait);

// Takes what clients have sent and passes it on. Call it on each turn of the loop.
void guards_serve(guards_t *self, uint32_t now_ms);

// A tap of the driver, behind the manager: the client has a SIP before the driver goes on.
driver_tap_t guards_tap(guards_t *self);

// Something for the operator; false: nothing new.
bool guards_notice(guards_t *self, char *text, size_t capacity);

void guards_close(guards_t *self, uint32_t now_ms);

#endif
