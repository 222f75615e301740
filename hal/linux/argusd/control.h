// SPDX-License-Identifier: MIT
// The control socket (SPEC.md): programs that watch, one that orders; none of them is ever waited for.
#ifndef ARGUSD_CONTROL_H
#define ARGUSD_CONTROL_H

#include <poll.h>

#include "control_client.h"
#include "control_orders.h"
#include "control_port.h"
#include "moment.h"
#include "view.h"

#define CONTROL_CLIENTS 16
#define CONTROL_POLL_MAX (CONTROL_CLIENTS + 1)
#define CONTROL_SAID_MAX 16384 // a line from us
#define CONTROL_GRANT_BYTES 16

typedef struct {
    control_hands_t hands;
    const view_t *(*look)(void *context); // a picture as of now
    void *context;
} control_world_t;

typedef struct {
    bool on;
    bool needs_token;
    control_port_t port;
    control_token_t token;
    control_world_t world;
    moment_t moment;
    int holder; // the client that has control, -1: none
    char grant[2 * CONTROL_GRANT_BYTES + 1];
    int64_t seq; // of the last order of this grant, -1: none yet
    int first;   // the client that is looked at first in the next round
    uint32_t sips;
    uint32_t wrong_tokens;
    uint32_t wrong_said;
    uint32_t wrong_ms;
    char line[CONTROL_SAID_MAX];
    control_request_t request;
    control_client_t client[CONTROL_CLIENTS];
} control_t;

// Listens; no client is served before control_begin(). `token` on: a client must say it. False: `message`
// says why not.
bool control_open(control_t *self, const control_spec_t *spec, const control_token_t *token, char *message,
                  size_t capacity);
void control_begin(control_t *self, const control_world_t *world);

// What to wait for, at most CONTROL_POLL_MAX; returns how many.
int control_poll(const control_t *self, struct pollfd *wait);

// Lets in, reads, carries out, writes; a few requests of all clients together.
void control_serve(control_t *self, const moment_t *moment);

// To the clients that watch events.
void control_event(control_t *self, uint64_t t_ms, const argus_event_t *event);

// Streams what is due; returns the ms until something is.
uint32_t control_tell(control_t *self, const moment_t *moment);

bool control_is_held(const control_t *self);
bool control_is_quit(const control_t *self); // ordered to end

// What is to be told to people, on one line; false: nothing.
bool control_notice(control_t *self, char *text, size_t capacity);

// Says what it can and closes everything.
void control_close(control_t *self);

// For tests: a client on a socket that was opened already; its place, -1: none is free.
int control_admit(control_t *self, int fd, uint32_t now_ms);

#endif
