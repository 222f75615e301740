// SPDX-License-Identifier: MIT
// argusd --survey: turns the robot on the spot, step by step, and reports each sonar's verdict.
#ifndef ARGUSD_SURVEY_H
#define ARGUSD_SURVEY_H

#include <stdio.h>

#include "argusd.h"
#include "driver.h"

typedef struct {
    FILE *table;
    bool json;     // the table, an object for each sonar
    FILE *picture; // the ring as an SVG; NULL: none
} survey_output_t;

// The driver's link is open and it is active, without a course. Writes the table, or why there is none to
// `message`. The exit code is ARGUSD_EXIT_FAULTS where a sonar is out or a suspect.
argusd_exit_t survey_run(driver_t *driver, uint32_t wait_ms, int cancel_fd, const survey_output_t *output,
                         char *message, size_t capacity);

#endif
