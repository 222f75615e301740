// SPDX-License-Identifier: MIT
// What a board tells over its second UART: lines of JSON with the keys of argusd's (docs/flash.md).
#ifndef BOARD_REPORT_H
#define BOARD_REPORT_H

#include "argus/argus.h"
#include "board/ring.h"

#define BOARD_EVENT_LINE_MAX 192 // no line about an event is longer
#define BOARD_STATUS_LINE_MAX 960

// False: there was no room for the line, nothing is sent.
bool board_report_event(board_ring_t *ring, const argus_event_t *event, uint32_t t_ms);
bool board_report_status(board_ring_t *ring, const argus_status_t *status, uint32_t t_ms);

// The board itself: what it is, why it started, with what settings.
bool board_report_start(board_ring_t *ring, uint32_t digest, const char *settings);

// Something about the board; `what` and `text` are an order and its answer, or a matter and what is the
// matter.
bool board_report_note(board_ring_t *ring, uint32_t t_ms, const char *name, const char *what,
                       const char *text);

// One setting.
bool board_report_setting(board_ring_t *ring, uint32_t t_ms, const char *key, int32_t value);

#endif
