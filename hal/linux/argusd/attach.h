// SPDX-License-Identifier: MIT
// argusd --attach: the screen and the keys of an argusd that runs elsewhere, over its control socket.
#ifndef ARGUSD_ATTACH_H
#define ARGUSD_ATTACH_H

#include "argusd.h"
#include "control_spec.h"
#include "json_read.h"
#include "voice.h"

#define ATTACH_BYTES 65536

typedef struct {
    hal_clock_t clock;
    int fd; // -1: argusd has ended the connection
    control_spec_t spec;
    uint32_t tried_ms; // to connect anew
    char place[160];
    control_token_t token;
    voice_t voice;
    moment_t moment;
    view_t view;
    bool seen;   // a state has come
    bool silent; // nothing has come for a while
    uint32_t heard_ms;
    char grant[33];
    uint32_t seq;
    tui_key_t wanted; // waits for control
    bool over;
    argusd_exit_t code;
    size_t used;
    char in[ATTACH_BYTES];
    json_doc_t doc;
} attach_t;

// Connects. False: `message` says why not.
bool attach_open(attach_t *self, const control_spec_t *spec, const control_token_t *token,
                 const hal_clock_t *clock, char *message, size_t capacity);

// Shows until somebody leaves; a stream ends with its argusd, a screen connects to the next one.
argusd_exit_t attach_run(attach_t *self, const voice_options_t *options);

#endif
