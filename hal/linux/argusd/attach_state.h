// SPDX-License-Identifier: MIT
// What argusd says at its control socket, as the picture and the events that it was made of.
#ifndef ARGUSD_ATTACH_STATE_H
#define ARGUSD_ATTACH_STATE_H

#include "argus/argus.h"
#include "json_read.h"
#include "view.h"

// A STATUS line. What it does not have stays as it was; false: it is no STATUS line.
bool attach_read_state(const json_doc_t *doc, view_t *view);

// An event line; `t_ms`: since argusd began. False: it is none.
bool attach_read_event(const json_doc_t *doc, argus_event_t *event, uint64_t *t_ms);

#endif
