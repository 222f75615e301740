// SPDX-License-Identifier: MIT
// The event loop: link, signals, screen and output around the fault manager.
#ifndef ARGUSD_LOOP_H
#define ARGUSD_LOOP_H

#include "argusd.h"
#include "bus.h"
#include "control.h"
#include "driver.h"
#include "guards.h"
#include "moment.h"
#include "notify.h"
#include "operator.h"
#include "state.h"
#include "tape.h"
#include "view.h"
#include "voice.h"

typedef struct {
    voice_options_t voice;
    const argus_config_t *config; // that the manager was given
    const char *notice;           // to tell at the start, or NULL
    uint32_t answer_ms;           // how long a robot may take to answer at start; UINT32_MAX: for ever
} loop_options_t;

typedef struct {
    loop_options_t options;
    driver_t driver;
    state_t state;
    tape_t tape;
    bus_t bus;         // off unless opened before
    guards_t guards;   // likewise
    control_t control; // likewise
    inject_t inject;
    voice_t voice;
    notify_t notify; // opened before
    operator_t operator;
    moment_t moment;
    const argus_config_t *config; // as in the options
    bool met;                     // a robot has answered
    bool ending;
    argusd_exit_t code;
    uint32_t start_ms;
    uint32_t ending_ms;
    uint32_t saved_ms;  // last look at the record
    int signals;        // seen so far
    int wishes;         // to end; what comes within a second of one is the same
    uint32_t wished_ms; // when the last one came
    bool closed;        // the session was closed in order
    uint32_t sips;      // so many had come when the end was asked for
    bool shut;          // the manager has been told
    bool heard;         // SIPs came after that, until the session was closed
    bool rested;        // ... and the last one showed the robot at rest
    uint32_t course_mm;
    view_t view;
} loop_t;

// Runs until the mission is over (without a screen), a robot fails to answer, or somebody ends it. The driver
// is attached, its course set. Gives the terminal back and closes the link.
argusd_exit_t loop_run(loop_t *self, const loop_options_t *options);

#endif
