// SPDX-License-Identifier: MIT
// Where a client of the robot may connect: a TCP port or a pty with a name.
#ifndef ARGUSD_GUARD_PORT_H
#define ARGUSD_GUARD_PORT_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "claim.h"

typedef enum { GUARD_TCP, GUARD_PTY } guard_kind_t;

typedef struct {
    guard_kind_t kind;
    const char *text;    // as it was written
    char name[PATH_MAX]; // host, without brackets, or path
    uint16_t port;       // TCP
} guard_spec_t;

// pty:PATH or tcp:HOST:PORT, IPv6 in brackets. False: `message` says what is wrong. `text` must outlive it.
bool guard_spec_parse(guard_spec_t *spec, const char *text, char *message, size_t capacity);

typedef struct {
    guard_spec_t spec;
    int listener;  // TCP: accepts; pty: its master; -1: closed
    int client;    // TCP: the client's socket, -1: none; pty: the master while the other side is open
    bool linked;   // the pty's name is there
    claim_t claim; // ... and ours
    bool refused;  // it would have been open to other machines
} guard_port_t;

// Listens; no client is there yet. `beyond`: a TCP host that is not loopback is allowed.
bool guard_port_open(guard_port_t *self, const guard_spec_t *spec, bool beyond, char *message,
                     size_t capacity);

// A client that came: its descriptor, also in self->client; -1: none. May be one more than the present one,
// which is then given back in `other`, to be closed by the caller.
void guard_port_accept(guard_port_t *self, int *other);

// Whether the client is still there; it is let go if not. Reads what it sent; 0: nothing now.
size_t guard_port_read(guard_port_t *self, uint8_t *bytes, size_t capacity);

// The bytes that were taken.
size_t guard_port_write(guard_port_t *self, const uint8_t *bytes, size_t count);

// What to wait for; -1: nothing that poll() could tell.
int guard_port_fd(const guard_port_t *self);

void guard_port_drop(guard_port_t *self);
void guard_port_close(guard_port_t *self);

#endif
