// SPDX-License-Identifier: MIT
// The command line.
#ifndef ARGUSD_OPTIONS_H
#define ARGUSD_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "argus/argus.h"
#include "control_spec.h"
#include "guards.h"
#include "hal/links.h"
#include "precedence.h"

typedef enum {
    OPTIONS_RUN,
    OPTIONS_CHECK,
    OPTIONS_SURVEY,
    OPTIONS_ATTACH,
    OPTIONS_HELP,
    OPTIONS_VERSION,
    OPTIONS_LIST_EVENTS,
    OPTIONS_LIST_CONFIG,
    OPTIONS_EXAMPLE_CONFIG
} options_action_t;

#define OPTIONS_WAIT_FOREVER UINT32_MAX

typedef struct {
    options_action_t action;
    hal_link_spec_t link;
    const char *config_path; // NULL: not given, like the paths below
    const char *course_path;
    const char *state_path;
    const char *record_path;
    const char *token_path;
    control_spec_t control; // family 0: not given, like the next
    control_spec_t attach;
    bool control_beyond_loopback;
    bool inject;
    const char *ring_path;
    const char *picture_path;
    const char *robot;        // a choice of the setting of that name
    hal_can_spec_t telemetry; // interface "": not given
    bool no_telemetry;
    uint64_t record_max_bytes; // 0: not given
    guards_options_t guards;
    precedence_options_t precedence;
    const char *readings; // of --guard-readings, NULL: not given
    argus_point_t goal;
    bool has_goal;
    bool passive;
    bool active;
    bool json;
    bool plain;
    bool auto_baud;
    bool has_wait;
    uint32_t wait_ms;
    bool has_status;
    uint32_t status_ms; // 0: no status lines
} options_t;

// False: `message` says on one line what is wrong and what to do. `argv` must outlive `options`.
bool options_parse(options_t *options, int argc, char **argv, char *message, size_t capacity);

void options_help(FILE *out);

#endif
