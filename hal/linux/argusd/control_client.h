// SPDX-License-Identifier: MIT
// One program at the control socket: its lines in, its lines out, and what it has asked to be told.
#ifndef ARGUSD_CONTROL_CLIENT_H
#define ARGUSD_CONTROL_CLIENT_H

#include "output.h"

#define CONTROL_LINE_MAX 4096 // to us, with its end
#define CONTROL_PATIENCE_MS 10000u
#define CONTROL_PERIOD_MS 500u

typedef enum {
    CONTROL_EVENTS = 1,
    CONTROL_STATE = 2,
    CONTROL_READINGS = 4,
    CONTROL_EVIDENCE = 8
} control_topic_t;

typedef struct {
    bool on;
    bool authentic;
    bool begun; // its first byte was seen
    bool skips; // the rest of a line that is too long
    bool over;  // it says nothing more: closed as soon as all is answered
    bool rude;  // ... at once
    bool had_control;
    int fd;
    uint32_t since_ms;
    uint32_t took_ms;   // it took a byte last, or nothing waited for it
    uint32_t lost_said; // lines dropped that it was told of
    unsigned topics;    // control_topic_t
    uint32_t period_ms;
    uint32_t state_ms; // told last
    uint32_t evidence_ms;
    size_t used;
    char in[CONTROL_LINE_MAX];
    output_t out;
} control_client_t;

void control_client_open(control_client_t *self, int fd, bool authentic, uint32_t now_ms);
void control_client_close(control_client_t *self);

// Reads once what is there.
void control_client_read(control_client_t *self);

// Takes bytes as if they had been read; returns how many there was room for. For control_client_read(), and
// for tests.
size_t control_client_feed(control_client_t *self, const char *bytes, size_t count);

typedef enum { CONTROL_NO_LINE, CONTROL_LINE, CONTROL_TOO_LONG } control_line_t;

// The next whole line without its end, 0-terminated, in `line` of CONTROL_LINE_MAX bytes.
control_line_t control_client_line(control_client_t *self, char *line, size_t *length);
bool control_client_has_line(const control_client_t *self);

void control_client_say(control_client_t *self, const char *line, size_t length);

// Writes what it takes now, and tells it what it missed once there is room.
void control_client_flush(control_client_t *self, uint32_t now_ms);

// It is gone, or of no use any more.
bool control_client_is_over(const control_client_t *self, uint32_t now_ms);

#endif
