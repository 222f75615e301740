// SPDX-License-Identifier: MIT
// Lines that the control socket sends unasked.
#ifndef ARGUSD_CONTROL_STREAM_H
#define ARGUSD_CONTROL_STREAM_H

#include "argus/argus.h"
#include "view.h"

// Each writes one line without its end and returns its length, 0 when it does not fit.
size_t control_readings_line(const view_t *view, char *line, size_t capacity);
size_t control_evidence_line(const view_t *view, const argus_suspicions_t *suspicions, char *line,
                             size_t capacity);

#endif
