// SPDX-License-Identifier: MIT
// The listening end of the control socket: opened so that no other user can reach it, and the clients that
// connect.
#ifndef ARGUSD_CONTROL_PORT_H
#define ARGUSD_CONTROL_PORT_H

#include <sys/types.h>

#include "control_spec.h"

typedef struct {
    int fd; // -1: closed
    control_spec_t spec;
    dev_t device; // of the socket file that is ours
    ino_t inode;
} control_port_t;

// Listens. False: `message` says why not.
bool control_port_open(control_port_t *self, const control_spec_t *spec, char *message, size_t capacity);

// The client that waits to be let in, as a socket that never waits; -1: none. A peer of another user is
// turned away.
int control_port_accept(const control_port_t *self);

// The address as it would be given, with the port that the system chose.
void control_port_describe(const control_port_t *self, char *text, size_t capacity);

void control_port_close(control_port_t *self);

#endif
