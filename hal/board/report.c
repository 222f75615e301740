// SPDX-License-Identifier: MIT
// Lines about events, the status and the board.
#include "board/report.h"

#include "board/board.h"
#include "board/line.h"
#include "board/word.h"

// A sonar, or the event's subject.
static void put_name(board_line_t *line, const argus_event_t *event) {
    if (event->sonar >= 0 && event->sonar < ARGUS_SONARS) {
        board_line_sonar(line, "name", event->sonar);
    } else {
        board_line_text(line, "name", argus_name(ARGUS_NAME_SUBJECT, event->id));
    }
}

// The seven keys that every line has.
static board_line_t begin(board_ring_t *ring, const argus_event_t *event, uint32_t t_ms, const char *name) {
    board_line_t line = board_line_begin(ring);
    board_line_seconds(&line, "t", t_ms);
    board_line_text(&line, "event", name);
    board_line_int(&line, "id", event->id);
    board_line_int(&line, "level", (int32_t)argus_event_level(event->id));
    put_name(&line, event);
    board_line_int(&line, "value", event->value);
    board_line_text(&line, "state", argus_name(ARGUS_NAME_FAILURE, event->state));
    return line;
}

bool board_report_event(board_ring_t *ring, const argus_event_t *event, uint32_t t_ms) {
    board_line_t line = begin(ring, event, t_ms, argus_name(ARGUS_NAME_EVENT, event->id));
    return board_line_end(&line);
}

static void put_motion(board_line_t *line, const argus_status_t *status) {
    board_line_text(line, "mode", argus_name(ARGUS_NAME_MODE, (int)status->mode));
    board_line_text(line, "mission", argus_name(ARGUS_NAME_MISSION, (int)status->mission));
    board_line_bool(line, "active", status->active);
    board_line_bool(line, "paused", status->paused);
    board_line_bool(line, "online", status->online);
    board_line_int(line, "x_mm", status->pose.x_mm);
    board_line_int(line, "y_mm", status->pose.y_mm);
    board_line_int(line, "heading_cdeg", status->pose.heading_cdeg);
    board_line_int(line, "goal_mm", status->goal_mm);
    board_line_int(line, "waypoint", status->waypoint);
    board_line_int(line, "battery_dv", status->battery_dv);
}

static void put_line(board_line_t *line, const argus_status_t *status, uint32_t lost) {
    board_line_int(line, "sips", (int32_t)status->sips);
    board_line_int(line, "bad_checksums", (int32_t)status->bad_checksums);
    board_line_int(line, "skipped_bytes", (int32_t)status->skipped_bytes);
    board_line_int(line, "stops", (int32_t)status->stops);
    board_line_int(line, "lines_lost", (int32_t)lost);
    board_line_int(line, "stack_left", (int32_t)board_stack_left());
    board_line_text(line, "robot", status->robot_name);
}

static void put_sonars(board_line_t *line, const argus_status_t *status) {
    board_line_open(line, "reading_mm");
    for (int i = 0; i < ARGUS_SONARS; i++) {
        board_line_item(line, status->reading_mm[i]);
    }
    board_line_close(line);
    board_line_open(line, "health");
    for (int i = 0; i < ARGUS_SONARS; i++) {
        board_line_word(line, argus_name(ARGUS_NAME_HEALTH, (int)status->health[i]));
    }
    board_line_close(line);
}

bool board_report_status(board_ring_t *ring, const argus_status_t *status, uint32_t t_ms) {
    const argus_event_t event = {.id = ARGUS_EV_STATUS,
                                 .sonar = ARGUS_NO_SONAR,
                                 .state = (uint8_t)status->failure,
                                 .value = (int32_t)status->sips};
    board_line_t line = begin(ring, &event, t_ms, argus_name(ARGUS_NAME_EVENT, event.id));
    put_motion(&line, status);
    put_line(&line, status, ring == NULL ? 0 : ring->lost);
    put_sonars(&line, status);
    return board_line_end(&line);
}

static board_line_t begin_note(board_ring_t *ring, uint32_t t_ms, const char *name) {
    board_line_t line = board_line_begin(ring);
    board_line_seconds(&line, "t", t_ms);
    board_line_text(&line, "event", name);
    board_line_int(&line, "id", 0);
    board_line_int(&line, "level", ARGUS_LEVEL_OK);
    board_line_text(&line, "name", "board");
    return line;
}

// In the order of board_reset_t.
static const char *reason_name(board_reset_t reason) {
    return board_word_nth("power\0pin\0order\0watchdog\0fault\0brownout\0", (int)reason);
}

bool board_report_start(board_ring_t *ring, uint32_t digest, const char *settings) {
    const board_note_t note = board_last_note();
    if (ring != NULL) {
        board_ring_put(ring, '\n'); // ends the line that the life before may have left open
    }
    board_line_t line = begin_note(ring, 0, "START");
    board_line_text(&line, "board", board_name());
    board_line_text(&line, "version", ARGUS_VERSION);
    board_line_hex(&line, "config", digest);
    board_line_text(&line, "settings", settings);
    board_line_text(&line, "reset", reason_name(board_reset_reason()));
    board_line_hex(&line, "pc", note.pc);
    board_line_hex(&line, "lr", note.lr);
    board_line_hex(&line, "cause", note.cause);
    board_line_int(&line, "invariant", note.invariant);
    return board_line_end(&line);
}

bool board_report_note(board_ring_t *ring, uint32_t t_ms, const char *name, const char *what,
                       const char *text) {
    board_line_t line = begin_note(ring, t_ms, name);
    board_line_text(&line, "what", what);
    board_line_text(&line, "text", text);
    return board_line_end(&line);
}

bool board_report_setting(board_ring_t *ring, uint32_t t_ms, const char *key, int32_t value) {
    board_line_t line = begin_note(ring, t_ms, "SETTING");
    board_line_text(&line, "key", key);
    board_line_int(&line, "value", value);
    return board_line_end(&line);
}
