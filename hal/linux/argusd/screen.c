// SPDX-License-Identifier: MIT
// Draws the screen.
#include "screen.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "tui_key.h"

#define PAUSED "PAUSED: g goes on"
#define PAUSED_COLUMN 44
#define NARROW 60 // columns
#define FRONT_SONARS 8
#define RING_TOP 3
#define RING_ROWS 13
#define RING_COLUMNS 34
#define RING_RANGE_MM 3000 // an echo at this distance lies on the rim
#define INJECTED_COLUMN 63
#define RING_INNER 3  // columns from the centre where a reading of 0 lies
#define RIGHT 36      // column of the tables
#define RIGHT_ROWS 16 // below: the log
#define RECENT 8      // lines of the log among which a repeated one counts

void screen_log_add(screen_log_t *self, const char *line, tone_t tone, uint16_t key) {
    unsigned times = 1;
    int gone = self->count == SCREEN_LOG_LINES ? 0 : self->count;
    for (int i = self->count - 1; key != 0 && i >= 0 && i >= self->count - RECENT; i--) {
        if (self->line[i].key == key) {
            times = self->line[i].times + 1u;
            gone = i;
            break;
        }
    }
    if (gone < self->count) {
        memmove(&self->line[gone], &self->line[gone + 1],
                (size_t)(self->count - gone - 1) * sizeof self->line[0]);
        self->count--;
    }
    screen_line_t *const last = &self->line[self->count];
    snprintf(last->text, sizeof last->text, "%s", line);
    last->tone = (uint8_t)tone;
    last->key = key;
    last->times = (uint16_t)(times < UINT16_MAX ? times : UINT16_MAX);
    self->count++;
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

// Of a text, what fits in so many columns without cutting a word.
static int length_that_fits(const char *text, int room) {
    const int length = (int)strlen(text);
    if (length <= room) {
        return length;
    }
    int end = room < 0 ? 0 : room;
    while (end > 0 && text[end] != ' ') {
        end--;
    }
    while (end > 0 && strchr(" ,;:", text[end - 1]) != NULL) {
        end--;
    }
    return end;
}

static int put_words(canvas_t *canvas, int row, int column, int room, tone_t tone, const char *text) {
    const int length = length_that_fits(text, room);
    for (int i = 0; i < length; i++) {
        put(canvas, row, column + i, tone, text[i]);
    }
    return length;
}

static void put_text(canvas_t *canvas, int row, int column, tone_t tone, const char *text) {
    put_words(canvas, row, column, canvas->columns - column, tone, text);
}

// The first of the texts that fits whole; "" ends them.
static const char *first_that_fits(const char *const *texts, int room) {
    while ((*texts)[0] != '\0' && (int)strlen(*texts) > room) {
        texts++;
    }
    return *texts;
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
    const char *const activity = status->active ? "ACTIVE" : "PASSIVE";
    const char *const name = view->name[0] != '\0' ? view->name : "no robot";
    char right[2][40];
    char left[2][SCREEN_COLUMNS_MAX + 1];
    for (int column = 0; column < canvas->columns; column++) {
        put(canvas, 0, column, TONE_TITLE, ' ');
    }
    const char *const state = view->silent ? "NO NEWS" : status->online ? "online" : "OFFLINE";
    snprintf(right[0], sizeof right[0], " %s %s %2d.%d V ", state, activity, status->battery_dv / 10,
             status->battery_dv % 10);
    snprintf(right[1], sizeof right[1], " %s ", view->silent ? state : activity);
    const char *const rights[] = {right[0], right[1], ""};
    const char *const shown = first_that_fits(rights, canvas->columns);
    const int room = canvas->columns - (int)strlen(shown);
    put_text(canvas, 0, room, TONE_TITLE, shown);
    snprintf(left[0], sizeof left[0], " argus  %s  %.16s", view->link, name);
    snprintf(left[1], sizeof left[1], " argus  %.16s", name);
    const char *const lefts[] = {left[0], left[1], " argus", ""};
    put_text(canvas, 0, 0, TONE_TITLE, first_that_fits(lefts, room));
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

static bool is_injected(const view_t *view) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (view->injected[i] != 0) {
            return true;
        }
    }
    return false;
}

// Wherever there is room: nobody must take a made fault for a real one.
static void draw_injected(canvas_t *canvas) {
    static const char text[] = "INJECTED FAULT";
    if (canvas->columns >= INJECTED_COLUMN + (int)sizeof text) {
        put_text(canvas, 1, INJECTED_COLUMN, TONE_BAD, text);
    } else {
        for (int column = 0; column < canvas->columns; column++) {
            put(canvas, 2, column, TONE_PLAIN, ' ');
        }
        put_text(canvas, 2, 1, TONE_BAD, text);
    }
}

static void draw_mode(canvas_t *canvas, const view_t *view) {
    const argus_status_t *const status = &view->status;
    write_at(canvas, 1, 1, TONE_PLAIN, "%-9s", argus_name(ARGUS_NAME_MODE, (int)status->mode));
    write_at(canvas, 1, 11, tone_of_failure(status->failure), "%s",
             argus_name(ARGUS_NAME_FAILURE, (int)status->failure));
    const bool wide = canvas->columns >= PAUSED_COLUMN + (int)sizeof PAUSED;
    if (!status->paused || wide) {
        write_at(canvas, 1, 27, TONE_PLAIN, "mission %s",
                 argus_name(ARGUS_NAME_MISSION, (int)status->mission));
    }
    if (status->paused) {
        put_text(canvas, 1, wide ? PAUSED_COLUMN : 27, TONE_OPERATOR, wide ? PAUSED : "PAUSED");
    }
    if (status->waypoints > 0) {
        draw_progress(canvas, view, 2, 1);
    } else {
        put_text(canvas, 2, 1, TONE_DIM, "no course: drive by keys");
    }
    if (is_injected(view)) {
        draw_injected(canvas);
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

// What of a sonar there is room for.
typedef struct {
    int width;
    int other; // column of the rear array
    bool bearing;
    bool health;
    const char *head;
} layout_t;

static layout_t layout_of(int room) {
    static const layout_t layouts[] = {
        {44, 22, true, true, " # front  mm  health    # rear   mm  health"},
        {37, 19, false, true, " #    mm  health    #    mm  health"},
        {18, 10, false, false, " #    mm   #    mm"},
        {8, 0, false, false, " #    mm"},
    };
    size_t i = 0;
    while (i + 1 < sizeof layouts / sizeof layouts[0] && layouts[i].width > room) {
        i++;
    }
    return layouts[i];
}

static void put_bearing(char *text, size_t capacity, const argus_status_t *status, int sonar) {
    if (sonar < status->sonars) {
        snprintf(text, capacity, "%+4d", status->bearing_deg[sonar]);
    } else {
        snprintf(text, capacity, "   -");
    }
}

static char mark_of(const view_t *view, int sonar) {
    if (view->injected[sonar] != 0) {
        return '*';
    }
    return ((unsigned)view->status.pinned >> (unsigned)sonar & 1u) != 0 ? '=' : ' ';
}

static void draw_sonar(canvas_t *canvas, const view_t *view, int sonar, int row, int column,
                       const layout_t *layout) {
    const argus_status_t *const status = &view->status;
    const argus_health_t health = status->health[sonar];
    const bool out = health == ARGUS_DISABLED;
    char bearing[8] = "";
    char reading[8] = "   -";
    char state[16] = "";
    if (status->age_ms[sonar] != UINT32_MAX) {
        snprintf(reading, sizeof reading, "%4d", status->reading_mm[sonar]);
    }
    if (layout->bearing) {
        put_bearing(bearing, sizeof bearing, status, sonar);
    }
    if (layout->health) {
        snprintf(state, sizeof state, " %s%.9s", out ? "!" : "",
                 out ? argus_name(ARGUS_NAME_KIND, (int)status->kind[sonar])
                     : argus_name(ARGUS_NAME_HEALTH, (int)health));
    }
    write_at(canvas, row, column, tone_of_health(health), "%2d%c%s %s%.10s", sonar, mark_of(view, sonar),
             bearing, reading,
             layout->health ? state
             : out          ? "!"
                            : "");
    if (sonar == view->sonar) {
        write_at(canvas, row, column, TONE_TITLE, "%2d", sonar);
    }
}

static void draw_sonars(canvas_t *canvas, const view_t *view, int column) {
    const layout_t layout = layout_of(canvas->columns - column);
    put_text(canvas, RING_TOP, column, TONE_DIM, layout.head);
    const int shown = layout.other > 0 ? 2 * FRONT_SONARS : FRONT_SONARS;
    const int first = view->sonar / shown * shown; // the page with the chosen one
    for (int i = 0; i < shown && first + i < ARGUS_SONARS; i++) {
        draw_sonar(canvas, view, first + i, RING_TOP + 1 + i % FRONT_SONARS,
                   i < FRONT_SONARS ? column : column + layout.other, &layout);
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

static const char *after_word(const char *text) {
    text += strcspn(text, " ");
    return text + strspn(text, " ");
}

// As report_event_plain writes it. A notice may begin with an address.
static bool is_time(const char *text) {
    static const char digits[] = "0123456789";
    const size_t seconds = strspn(text, digits);
    return seconds > 0 && text[seconds] == '.' && strspn(text + seconds + 1, digits) == 3 &&
           text[seconds + 4] == ' ';
}

// Of the answer to a key what it does, and why not, if there is no room for its name.
static const char *without_key(const canvas_t *canvas, const char *text) {
    const char *const first = text + strspn(text, " ");
    const char *const colon = strncmp(first, "> ", 2) == 0 ? strstr(first, ": ") : NULL;
    return colon != NULL && (int)strlen(text) >= canvas->columns ? colon + 2 : text;
}

// Of an event on a narrow screen its time is left out, its level where a colour tells it, and what only fills
// a column.
static void narrow(const canvas_t *canvas, const char *text, char *shown, size_t capacity) {
    const char *const first = text + strspn(text, " ");
    const char *from = without_key(canvas, text);
    if (is_time(first)) {
        from = canvas->colourless ? after_word(first) : after_word(after_word(first));
    }
    size_t used = 0;
    for (; *from != '\0' && used + 1 < capacity; from++) {
        if (*from != ' ' || used == 0 || shown[used - 1] != ' ') {
            shown[used++] = *from;
        }
    }
    shown[used] = '\0';
}

static void draw_log(canvas_t *canvas, const screen_log_t *log, int top, int bottom) {
    const int room = bottom - top;
    const int shown = log->count < room ? log->count : room;
    for (int i = 0; i < shown; i++) {
        const screen_line_t *const line = &log->line[log->count - shown + i];
        char times[16] = "";
        if (line->times > 1) {
            snprintf(times, sizeof times, " (%u times)", (unsigned)line->times);
        }
        const int width = canvas->columns - 1 - (int)strlen(times);
        char narrowed[SCREEN_COLUMNS_MAX + 1];
        if (canvas->columns < NARROW) {
            narrow(canvas, line->text, narrowed, sizeof narrowed);
        }
        const int length = put_words(canvas, top + i, 1, width, (tone_t)line->tone,
                                     canvas->columns < NARROW ? narrowed : line->text);
        put_text(canvas, top + i, 1 + length, (tone_t)line->tone, times);
    }
}

static void draw_bottom(canvas_t *canvas) {
    static const char *const texts[] = {
        "arrows/wasd drive  space stop  g go  r recheck  p passive  nbtkx sonar  ? keys  q quit",
        "wasd drive  space stop  g go  r recheck  p passive  nbtkx sonar  ? keys  q quit",
        "space stop  g go  p passive  ? keys  q quit",
        "space stop  ? keys  q quit",
        "? keys  q quit",
        "? keys",
        "?",
        "",
    };
    const int last = canvas->rows - 1;
    for (int column = 0; column < canvas->columns; column++) {
        put(canvas, last, column, TONE_TITLE, ' ');
    }
    put_text(canvas, last, 1, TONE_TITLE, first_that_fits(texts, canvas->columns - 1));
}

// What is of earlier has no colour that says how things are.
static void grey(canvas_t *canvas, int top, int bottom) {
    for (int row = top; row < bottom && row < canvas->rows; row++) {
        for (int column = 0; column < canvas->columns; column++) {
            canvas->cell[row][column].tone = TONE_DIM;
        }
    }
}

void screen_draw(canvas_t *canvas, const view_t *view, const screen_log_t *log) {
    // The ring has room beside the numbers, or is left out.
    const bool narrow = layout_of(canvas->columns - RIGHT).health == false;
    draw_title(canvas, view);
    draw_mode(canvas, view);
    if (!narrow) {
        draw_ring(canvas, &view->status);
    }
    draw_sonars(canvas, view, narrow ? 1 : RIGHT);
    draw_numbers(canvas, view, RING_TOP + 9, narrow ? 1 : RIGHT);
    if (view->silent) {
        grey(canvas, 1, RIGHT_ROWS + 1);
    }
    draw_log(canvas, log, RIGHT_ROWS + 1, canvas->rows - 1);
    draw_bottom(canvas);
}

void screen_draw_keys(canvas_t *canvas) {
    int row = RING_TOP; // below what the robot does, and whether it is paused
    for (int key = TUI_NONE; key < TUI_GONE && row < canvas->rows - 1; key++) {
        const char *const keys = tui_keys_of((tui_key_t)key);
        if (keys[0] == '\0') {
            continue;
        }
        for (int column = 0; column < canvas->columns; column++) {
            put(canvas, row, column, TONE_PLAIN, ' ');
        }
        put_text(canvas, row, 1, TONE_TITLE, keys);
        put_text(canvas, row, 12, TONE_PLAIN, tui_effect_of((tui_key_t)key));
        row++;
    }
}
