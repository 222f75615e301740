// SPDX-License-Identifier: MIT
// What argusd says, and where: on the screen if there is one, else as lines on its two streams.
#ifndef ARGUSD_VOICE_H
#define ARGUSD_VOICE_H

#include "argus/argus.h"
#include "hal/clock.h"
#include "moment.h"
#include "output.h"
#include "tui.h"
#include "view.h"

typedef struct {
    bool json;
    bool plain;         // no screen, even on a terminal
    uint32_t status_ms; // between status lines, 0: none
} voice_options_t;

typedef struct {
    voice_options_t options;
    output_t out;
    output_t err;
    tui_t tui;
    bool colour;
    uint32_t status_ms; // last status line
    uint32_t shown_ms;  // last picture on the screen
    uint32_t lost_said; // lines dropped that have been told
    bool reader_said;   // ... and that the reader is gone
    bool taken_out;     // the operator took a sonar out of use at taken_out_ms
    uint32_t taken_out_ms;
    char line[4096];
} voice_t;

void voice_begin(voice_t *self, const voice_options_t *options, const moment_t *moment);

// For people: a line on the screen, else on standard error.
void voice_notice(voice_t *self, const char *text);

// To the operator, about a key.
void voice_answer(voice_t *self, const char *text);

void voice_event(voice_t *self, const moment_t *moment, const argus_event_t *event);

// A reader that was slow is told what it missed as soon as there is room.
void voice_losses(voice_t *self, const moment_t *moment, argus_failure_t failure);

// Whether a status line or a picture is due, and what it shows.
bool voice_is_due(const voice_t *self, uint32_t now_ms);
void voice_show(voice_t *self, const moment_t *moment, const view_t *view);

// Shows that nothing new has come: greyed on a screen; a stream has no line, for there is nothing to report.
void voice_show_silence(voice_t *self, const moment_t *moment, const view_t *view);

// `wait_ms`, or less if something is to be shown earlier.
uint32_t voice_wait_ms(const voice_t *self, uint32_t now_ms, uint32_t wait_ms);

// Writes what its readers take now.
void voice_flush(voice_t *self);

// On standard output after the last event, what came of it all: a sentence, with --json a last STATUS. Call
// when the screen is gone.
void voice_summary(voice_t *self, const view_t *view);

// The last lines may still wait for their reader, but not for long.
void voice_end(voice_t *self, const hal_clock_t *clock);

#endif
