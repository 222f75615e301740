// SPDX-License-Identifier: MIT
// Draws the screen.
#include "screen.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define FRONT_SONARS 8
#define SHOWN_SONARS 16
#define RING_TOP 3
#define RING_ROWS 13
#define RING_COLUMNS 34
#define RING_RANGE_MM 3000 // an echo at this distance lies on the rim
#define RING_INNER 3       // columns from the centre where a reading of 0 lies
#define RIGHT 36           // column of the tables
#define RIGHT_ROWS 16      // below: the log
#define NARROW 60          // fewer columns: no ring

void screen_log_add(screen_log_t *self, const char *line, tone_t tone) {
    const int at = (self->first + self->count) % SCREEN_LOG_LINES;
    snprintf(self->line[at], sizeof self->line[at], "%s", line);
    self->tone[at] = (uint8_t)tone;
    if (self->count < SCREEN_LOG_LINES) {
        self->count++;
    } else {
        self->first = (self->first + 1) % SCREEN_LOG_LINES;
    }
}

static int between(int value, int low, int high) {
    return value < low ? low : value > high ? high : value;
}

void canvas_clear(canvas_t *self, int rows, int columns) {
    self->rows = between(rows, 1, SCREEN_ROWS_MAX);
    self->columns = between(columns, 1, SCREEN_COLUMNS_MAX);
    for (int row = 0; row < self->rows; row++) {
        for (int column = 0; column < self->columns; column++) {
            self->cell[row][column] = (cell_t){.character = ' ', .tone = TONE_PLAIN};
        }
    }
}

static void put(canvas_t *canvas, int row, int column, tone_t tone, char character) {
    if (row >= 0 && row < canvas->rows && column >= 0 && column < canvas->columns) {
        // Control characters would move the cursor.
        const char shown = character >= ' ' && character <= '~' ? character : '?';
        canvas->cell[row][column] = (cell_t){.character = shown, .tone = (uint8_t)tone};
    }
}

static void put_text(canvas_t *canvas, int row, int column, tone_t tone, const char *text) {
    for (int i = 0; text[i] != '\0'; i++) {
        put(canvas, row, column + i, tone, text[i]);
    }
}

__attribute__((format(printf, 5, 6))) static void write_at(canvas_t *canvas, int row, int column, tone_t tone,
                                                           const char *format, ...) {
    char text[SCREEN_COLUMNS_MAX + 1];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    put_text(canvas, row, column, tone, text);
}

static tone_t tone_of_failure(argus_failure_t failure) {
    return failure == ARGUS_IS_NORMAL ? TONE_GOOD : failure == ARGUS_IS_MINOR ? TONE_WARN : TONE_BAD;
}

static tone_t tone_of_health(argus_health_t health) {
    switch (health) {
    case ARGUS_HEALTHY:
        return TONE_GOOD;
    case ARGUS_SUSPECT:
    case ARGUS_PROBATION:
    case ARGUS_STALE:
        return TONE_WARN;
    case ARGUS_DISABLED:
        return TONE_BAD;
    case ARGUS_UNKNOWN:
    default:
        return TONE_DIM;
    }
}

static void draw_title(canvas_t *canvas, const view_t *view) {
    const argus_status_t *const status = &view->status;
    for (int column = 0; column < canvas->columns; column++) {
        put(canvas, 0, column, TONE_TITLE, ' ');
    }
    write_at(canvas, 0, 1, TONE_TITLE, "argus  %.40s  %.16s", view->link,
             view->name[0] != '\0' ? view->name : "no robot");
    char right[40];
    snprintf(right, sizeof right, " %s %s %2d.%d V ", status->online ? "online" : "OFFLINE",
             status->active ? "ACTIVE" : "PASSIVE", status->battery_dv / 10, status->battery_dv % 10);
    put_text(canvas, 0, canvas->columns - (int)strlen(right), TONE_TITLE, right);
}

static void draw_progress(canvas_t *canvas, const view_t *view, int row, int column) {
    const argus_status_t *const status = &view->status;
    char bar[] = "[--------------------]";
    const int cells = (int)sizeof bar - 3;
    const uint32_t whole = view->course_mm > 0 ? view->course_mm : 1;
    const uint32_t left = status->goal_mm < 0 ? 0 : (uint32_t)status->goal_mm;
    const uint32_t done = left < whole ? whole - left : 0;
    for (int i = 0; i < cells; i++) {
        bar[i + 1] = (uint64_t)done * (uint64_t)cells > (uint64_t)i * whole ? '#' : '-';
    }
    write_at(canvas, row, column, TONE_PLAIN, "goal %u.%02u m %s %u %%  waypoint %u of %u",
             (unsigned)(left / 1000), (unsigned)(left % 1000 / 10), bar,
             (unsigned)((uint64_t)done * 100u / whole),
             (unsigned)(status->waypoint < status->waypoints ? status->waypoint + 1 : status->waypoints),
             (unsigned)status->waypoints);
}

static void draw_mode(canvas_t *canvas, const view_t *view) {
    const argus_status_t *const status = &view->status;
    write_at(canvas, 1, 1, TONE_PLAIN, "%-9s", argus_name(ARGUS_NAME_MODE, status->mode));
    write_at(canvas, 1, 11, tone_of_failure(status->failure), "%s",
             argus_name(ARGUS_NAME_FAILURE, status->failure));
    write_at(canvas, 1, 27, TONE_PLAIN, "mission %s", argus_name(ARGUS_NAME_MISSION, status->mission));
    if (status->waypoints > 0) {
        draw_progress(canvas, view, 2, 1);
    } else {
        put_text(canvas, 2, 1, TONE_DIM, "no course: drive by keys");
    }
}

// 256 times the cosine, by table: on whole tens of degrees exactly, between them on a straight line.
static int cos256(int degrees) {
    static const int16_t quarter[] = {256, 252, 241, 222, 196, 165, 128, 88, 44, 0, -44};
    const int turn = ((degrees % 360) + 360) % 360;
    const int half = turn <= 180 ? turn : 360 - turn;
    const int size = half <= 90 ? half : 180 - half;
    const int step = quarter[size / 10 + 1] - quarter[size / 10];
    const int value = quarter[size / 10] + step * (size % 10) / 10;
    return half <= 90 ? value : -value;
}

// A row is twice as high as a column is wide.
static void put_polar(canvas_t *canvas, int degrees, int radius, tone_t tone, char character) {
    const int row = RING_TOP + RING_ROWS / 2 - radius * cos256(degrees) / 512;
    const int column = RING_COLUMNS / 2 - radius * cos256(degrees - 90) / 256;
    put(canvas, row, column, tone, character);
}

static void draw_echo(canvas_t *canvas, const argus_status_t *status, int sonar) {
    static const char digits[] = "0123456789ABCDEFGHIJKLMNOPQRSTUV";
    const int bearing = status->bearing_deg[sonar];
    const int rim = RING_ROWS - 1;
    const int reading = between(status->reading_mm[sonar], 0, RING_RANGE_MM);
    if (status->age_ms[sonar] == UINT32_MAX) {
        put_polar(canvas, bearing, rim, TONE_DIM, '-');
        return;
    }
    const int radius = RING_INNER + (rim - RING_INNER) * reading / RING_RANGE_MM;
    if (status->health[sonar] == ARGUS_DISABLED) {
        put_polar(canvas, bearing, rim, TONE_BAD, 'x');
    } else if (status->reading_mm[sonar] >= ARGUS_NO_ECHO_MM) {
        put_polar(canvas, bearing, rim, TONE_DIM, '.');
    } else {
        put_polar(canvas, bearing, radius, tone_of_health(status->health[sonar]), digits[sonar]);
    }
}

static void draw_ring(canvas_t *canvas, const argus_status_t *status) {
    const int middle = RING_TOP + RING_ROWS / 2;
    const int column = RING_COLUMNS / 2;
    for (int sonar = status->sonars - 1; sonar >= 0; sonar--) {
        draw_echo(canvas, status, sonar);
    }
    put_text(canvas, middle - 1, column - 1, status->bumpers_front != 0 ? TONE_BAD : TONE_PLAIN, "/^\\");
    put_text(canvas, middle, column - 1, TONE_PLAIN, "| |");
    put_text(canvas, middle + 1, column - 1, status->bumpers_rear != 0 ? TONE_BAD : TONE_PLAIN, "\\_/");
}

static void draw_sonar(canvas_t *canvas, const view_t *view, int sonar, int row, int column) {
    const argus_status_t *const status = &view->status;
    const bool pinned = (status->pinned >> sonar & 1) != 0;
    char state[16];
    char reading[8] = "   -";
    char bearing[8] = "   -";
    const argus_health_t health = status->health[sonar];
    if (status->age_ms[sonar] != UINT32_MAX) {
        snprintf(reading, sizeof reading, "%4d", status->reading_mm[sonar]);
    }
    if (sonar < status->sonars) {
        snprintf(bearing, sizeof bearing, "%+4d", status->bearing_deg[sonar]);
    }
    if (health == ARGUS_DISABLED) {
        snprintf(state, sizeof state, "!%s", argus_name(ARGUS_NAME_KIND, status->kind[sonar]));
    } else {
        snprintf(state, sizeof state, "%s", argus_name(ARGUS_NAME_HEALTH, health));
    }
    write_at(canvas, row, column, tone_of_health(health), "%2d%c%s %s %-9.9s", sonar, pinned ? '=' : ' ',
             bearing, reading, state);
    if (sonar == view->sonar) {
        write_at(canvas, row, column, TONE_TITLE, "%2d", sonar);
    }
}

static void draw_sonars(canvas_t *canvas, const view_t *view, int column) {
    put_text(canvas, RING_TOP, column, TONE_DIM, " # front  mm  health    # rear   mm  health");
    const int first = view->sonar / SHOWN_SONARS * SHOWN_SONARS; // the page with the chosen one
    for (int i = first; i < first + SHOWN_SONARS && i < ARGUS_SONARS; i++) {
        const int row = RING_TOP + 1 + i % FRONT_SONARS;
        draw_sonar(canvas, view, i, row, i - first < FRONT_SONARS ? column : column + 22);
    }
}

static void draw_plan(canvas_t *canvas, const argus_plan_t *plan, int row, int column) {
    char text[80] = "plan: none needed";
    if (plan->disabled != 0) {
        size_t length = (size_t)snprintf(text, sizeof text, "plan (deg):");
        for (int i = 0; i < plan->count && i < ARGUS_ROTATIONS_MAX; i++) {
            length += (size_t)snprintf(text + length, sizeof text - length, " %+d", plan->rotation_deg[i]);
        }
        snprintf(text + length, sizeof text - length, plan->complete ? ", covers all" : ", INCOMPLETE");
    }
    put_text(canvas, row, column, plan->disabled == 0 || plan->complete ? TONE_PLAIN : TONE_BAD, text);
}

static void draw_numbers(canvas_t *canvas, const view_t *view, int row, int column) {
    const argus_status_t *const status = &view->status;
    draw_plan(canvas, &status->plan, row, column);
    write_at(canvas, row + 1, column, TONE_PLAIN, "at %d, %d mm, %d deg   %d/%d mm/s", (int)status->pose.x_mm,
             (int)status->pose.y_mm, (int)(status->pose.heading_cdeg / 100), status->vel_left_mm_s,
             status->vel_right_mm_s);
    write_at(canvas, row + 2, column,
             status->bumpers_front != 0 || status->bumpers_rear != 0 ? TONE_BAD : TONE_PLAIN,
             "motors %s  bumpers %02x/%02x  stops %u", status->motors ? "on" : "off", status->bumpers_front,
             status->bumpers_rear, (unsigned)status->stops);
    write_at(canvas, row + 3, column, view->link_up ? TONE_PLAIN : TONE_BAD,
             "link %s  SIPs %u  bad %u  junk %u", view->link_up ? "up" : "DOWN", (unsigned)status->sips,
             (unsigned)status->bad_checksums, (unsigned)status->skipped_bytes);
}

static void draw_log(canvas_t *canvas, const screen_log_t *log, int top, int bottom) {
    const int room = bottom - top;
    const int shown = log->count < room ? log->count : room;
    for (int i = 0; i < shown; i++) {
        const int at = (log->first + log->count - shown + i) % SCREEN_LOG_LINES;
        put_text(canvas, top + i, 1, (tone_t)log->tone[at], log->line[at]);
    }
}

void screen_draw(canvas_t *canvas, const view_t *view, const screen_log_t *log) {
    const bool narrow = canvas->columns < NARROW;
    const int last = canvas->rows - 1;
    draw_title(canvas, view);
    draw_mode(canvas, view);
    if (!narrow) {
        draw_ring(canvas, &view->status);
    }
    draw_sonars(canvas, view, narrow ? 1 : RIGHT);
    draw_numbers(canvas, view, RING_TOP + 9, narrow ? 1 : RIGHT);
    draw_log(canvas, log, RIGHT_ROWS + 1, last);
    for (int column = 0; column < canvas->columns; column++) {
        put(canvas, last, column, TONE_TITLE, ' ');
    }
    put_text(canvas, last, 1, TONE_TITLE,
             "arrows/wasd drive  space stop  g go  r recheck  p passive  nbtkx sonar  q quit");
}
