// SPDX-License-Identifier: MIT
// Events and status as lines: JSON for machines, plain text for people.
#ifndef ARGUSD_REPORT_H
#define ARGUSD_REPORT_H

#include <stdio.h>

#include "argus/argus.h"
#include "json.h"
#include "view.h"

#define REPORT_LINE_MAX 4096

// ROS-like: "sonar/front/03", "sonar/rear/11", or the event's subject.
void report_name(const argus_event_t *event, char *text, size_t capacity);

// Each writes one line without its newline and returns its length, 0 when it does not fit. `t_ms`: since
// argusd began.
size_t report_event_json(const argus_event_t *event, uint64_t t_ms, char *line, size_t capacity);
size_t report_event_plain(const argus_event_t *event, uint64_t t_ms, bool colour, char *line,
                          size_t capacity);
size_t report_status_json(const view_t *view, int64_t unix_ms, char *line, size_t capacity);
size_t report_status_plain(const view_t *view, char *line, size_t capacity);

// As many as lists of one value a sonar hold: those that the robot has, and 16 at least.
int report_sonars(const argus_status_t *status);

// Adds the members `name`, readings in mm, and age_ms of these.
void report_readings(json_t *json, const char *name, const argus_status_t *status);

// What came of it all, for people.
size_t report_summary(const view_t *view, char *line, size_t capacity);

void report_list_events(FILE *out);

#endif
