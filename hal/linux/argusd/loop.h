// SPDX-License-Identifier: MIT
// The event loop: link, signals, screen and output around the fault manager.
#ifndef ARGUSD_LOOP_H
#define ARGUSD_LOOP_H

#include "argusd.h"
#include "bus.h"
#include "driver.h"
#include "output.h"
#include "state.h"
#include "tape.h"
#include "tui.h"
#include "view.h"

typedef struct {
    bool json;
    bool plain;         // no screen, even on a terminal
    uint32_t status_ms; // between status lines, 0: none
    const char *notice; // to tell at the start, or NULL
    uint32_t answer_ms; // how long a robot may take to answer at start; UINT32_MAX: for ever
} loop_options_t;

typedef struct {
    loop_options_t options;
    driver_t driver;
    state_t state;
    tape_t tape;
    bus_t bus; // off unless opened before
    output_t out;
    output_t err;
    tui_t tui;
    bool colour;
    bool met; // a robot has answered
    bool ending;
    argusd_exit_t code;
    uint32_t start_ms;
    uint32_t now_ms;
    uint64_t t_ms; // since the start; does not wrap
    uint32_t ending_ms;
    uint32_t status_ms; // last status line
    uint32_t shown_ms;  // last picture on the screen
    uint32_t saved_ms;  // last look at the record
    int quits;          // how often q was pressed
    uint32_t lost_said; // lines dropped that have been told
    bool reader_said;   // ... and that the reader is gone
    uint32_t course_mm;
    uint8_t sonar; // the one that the operator has chosen
    view_t view;
    char line[4096];
} loop_t;

// Runs until the mission is over (without a screen), a robot fails to answer, or somebody ends it. The driver
// is attached, its course set. Gives the terminal back and closes the link.
argusd_exit_t loop_run(loop_t *self, const loop_options_t *options);

#endif
