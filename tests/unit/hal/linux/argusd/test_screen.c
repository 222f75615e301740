// SPDX-License-Identifier: MIT
// Attacks: the screen shows what it must at 80 x 24, draws at any size with any contents, and keys mean what
// it says.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robot/robot.h"
#include "screen.h"
#include "tui_key.h"
#include "unity.h"

#define SONARS (ARGUS_SONARS < 16 ? ARGUS_SONARS : 16) // that its robot has, of those that a build manages

static canvas_t canvas;
static view_t view;
static screen_log_t log_;

static void row_text(int row, char *text) {
    for (int column = 0; column < canvas.columns; column++) {
        text[column] = canvas.cell[row][column].character;
    }
    text[canvas.columns] = '\0';
}

static int find(const char *part) {
    char text[SCREEN_COLUMNS_MAX + 1];
    for (int row = 0; row < canvas.rows; row++) {
        row_text(row, text);
        if (strstr(text, part) != NULL) {
            return row;
        }
    }
    return -1;
}

void setUp(void) {
    static const int16_t bearings[SONARS] = {90,  50,   30,   10,   -10, -30, -50, -90,
                                             -90, -130, -150, -170, 170, 150, 130, 90};
    memset(&view, 0, sizeof view);
    memcpy(view.status.bearing_deg, bearings, sizeof bearings);
    memset(&log_, 0, sizeof log_);
    canvas.colourless = false;
    for (int i = 0; i < SONARS; i++) {
        view.status.reading_mm[i] = (uint16_t)(1000 + i);
        view.status.health[i] = ARGUS_HEALTHY;
        view.status.bearing_deg[i] = argus_robot_pose(argus_robot_default(), i).heading_deg;
    }
    view.status.sonars = SONARS;
    strcpy(view.link, "serial:/dev/ttyUSB0@9600");
    strcpy(view.name, "P3DX_0001");
    view.status.online = true;
    view.status.battery_dv = 127;
}

static void draw(int rows, int columns) {
    canvas_clear(&canvas, rows, columns);
    screen_draw(&canvas, &view, &log_);
}

static int coloured_cells(int top, int bottom) {
    int count = 0;
    for (int row = top; row < bottom; row++) {
        for (int column = 0; column < canvas.columns; column++) {
            count += canvas.cell[row][column].tone != TONE_DIM;
        }
    }
    return count;
}

// What nothing new has come of is of earlier: it is marked in words, and nothing has a colour that says how
// it is.
void test_a_picture_of_earlier_is_marked_and_grey(void) {
    static const int columns[] = {80, 40, 24};
    view.silent = true;
    view.status.health[3] = ARGUS_DISABLED;
    screen_log_add(&log_, "argusd reports nothing", TONE_WARN, 0);
    for (int i = 0; i < 3; i++) {
        draw(24, columns[i]);
        TEST_ASSERT_EQUAL(0, find("NO NEWS"));
        TEST_ASSERT_EQUAL(-1, find("online"));
        TEST_ASSERT_EQUAL(0, coloured_cells(1, 17));
        TEST_ASSERT_EQUAL(TONE_WARN, canvas.cell[17][1].tone);
    }
    view.silent = false;
    draw(24, 80);
    TEST_ASSERT_EQUAL(-1, find("NO NEWS"));
    TEST_ASSERT_GREATER_THAN(0, coloured_cells(1, 17));
}

void test_all_that_matters_is_there_at_80_by_24(void) {
    view.status.health[3] = ARGUS_DISABLED;
    view.status.kind[3] = ARGUS_KIND_OFF;
    view.status.reading_mm[3] = 5000;
    view.status.health[6] = ARGUS_SUSPECT;
    view.status.failure = ARGUS_IS_MINOR;
    view.status.plan =
        (argus_plan_t){.disabled = 1u << 3, .count = 1, .rotation_deg = {-20}, .complete = true};
    view.status.mode = ARGUS_MODE_SWEEPING;
    view.status.mission = ARGUS_MISSION_RUNNING;
    view.status.waypoints = 2;
    view.status.goal_mm = 1500;
    view.course_mm = 3000;
    screen_log_add(&log_, "the last event", TONE_BAD, 0);
    draw(24, 80);
    static const char *const parts[] = {"serial:/dev/ttyUSB0@9600",
                                        "P3DX_0001",
                                        "12.7 V",
                                        "PASSIVE",
                                        "SWEEPING",
                                        "IsMinor",
                                        "mission running",
                                        "goal 1.50 m",
                                        "50 %",
                                        " 3  +10 5000 !off",
                                        " 6  -50 1006 SUSPECT",
                                        "15  +90 1015 HEALTHY",
                                        "plan (deg): -20, covers all",
                                        "the last event",
                                        "q quit",
                                        "link DOWN"};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        TEST_ASSERT_NOT_EQUAL_MESSAGE(-1, find(parts[i]), parts[i]);
    }
    TEST_ASSERT_EQUAL_INT(23, find("q quit"));
}

void test_the_newest_lines_are_shown(void) {
    char line[32];
    for (int i = 0; i < 3 * SCREEN_LOG_LINES; i++) {
        snprintf(line, sizeof line, "line <%d>", i);
        screen_log_add(&log_, line, TONE_PLAIN, 0);
    }
    draw(24, 80);
    TEST_ASSERT_EQUAL_INT(22, find("line <191>"));
    TEST_ASSERT_EQUAL_INT(17, find("line <186>"));
    TEST_ASSERT_EQUAL_INT(-1, find("line <185>"));
}

// A sonar's echo lies on its side of the robot, and farther echoes farther out.
void test_the_ring_has_the_right_sense(void) {
    static const struct {
        int sonar;
        int row; // sign relative to the centre
        int column;
    } cases[] = {{0, 0, -1}, {7, 0, 1}, {3, -1, -1}, {4, -1, 1}, {11, 1, 1}, {12, 1, -1}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int k = 0; k < SONARS; k++) {
            view.status.age_ms[k] = k == cases[i].sonar ? 0 : UINT32_MAX;
        }
        view.status.reading_mm[cases[i].sonar] = 2000;
        draw(24, 80);
        int row = -1;
        int column = -1;
        for (int r = 3; r < 16; r++) {
            for (int c = 0; c < 34; c++) {
                const char digit = "0123456789ABCDEF"[cases[i].sonar];
                if (canvas.cell[r][c].character == digit) {
                    row = r - 9;
                    column = c - 17;
                }
            }
        }
        TEST_ASSERT_TRUE_MESSAGE((row > 0) - (row < 0) == cases[i].row, "row");
        TEST_ASSERT_TRUE_MESSAGE((column > 0) - (column < 0) == cases[i].column, "column");
    }
}

void test_any_size_and_any_contents_are_drawn(void) {
    srand(13);
    for (int round = 0; round < 20000; round++) {
        unsigned char *const bytes = (unsigned char *)&view;
        for (size_t i = 0; i < sizeof view; i++) {
            bytes[i] = (unsigned char)rand();
        }
        // What the manager guarantees: enumerations, flags and strings are what they claim to be.
        argus_status_t *const status = &view.status;
        status->online = status->active = view.link_up = status->plan.complete = (round & 1) != 0;
        view.silent = view.inject = view.controlled = (round & 2) != 0;
        status->plan.return_each = false;
        status->sonars = (uint8_t)(rand() % (SONARS + 1));
        view.sonar = (uint8_t)(rand() % SONARS);
        status->paused = status->open = status->motors = status->lists_all = (round & 2) != 0;
        status->has_configpac = view.has_can = (round & 4) != 0;
        status->mode = ARGUS_MODE_CLOSED;
        status->mission = ARGUS_MISSION_FAILED;
        status->failure = ARGUS_IS_CATASTROPHIC;
        for (int i = 0; i < SONARS; i++) {
            status->health[i] = (argus_health_t)(rand() % (ARGUS_ABSENT + 1));
            status->kind[i] = (argus_fault_kind_t)(rand() % 8);
        }
        view.name[ARGUS_NAME_MAX - 1] = view.link[VIEW_LINK_MAX - 1] = '\0';
        draw(rand() % 100, rand() % 250);
        for (int row = 0; row < canvas.rows; row++) {
            for (int column = 0; column < canvas.columns; column++) {
                TEST_ASSERT_TRUE(canvas.cell[row][column].character >= ' ' &&
                                 canvas.cell[row][column].character <= '~');
            }
        }
    }
}

void test_the_chosen_sonar_is_marked_and_a_pinned_one_too(void) {
    view.sonar = 11;
    view.status.pinned = 1u << 2;
    draw(24, 80);
    int marked = 0;
    for (int row = 1; row < 23; row++) {
        for (int column = 0; column < 80; column++) {
            if (canvas.cell[row][column].tone == TONE_TITLE) {
                marked++;
                TEST_ASSERT_EQUAL_INT('1', canvas.cell[row][column].character);
            }
        }
    }
    TEST_ASSERT_EQUAL_INT(2, marked); // "11"
    TEST_ASSERT_TRUE(find(" 2= ") > 0);
    TEST_ASSERT_EQUAL_INT(-1, find(" 3= "));
}

void test_keys(void) {
    TEST_ASSERT_EQUAL_INT(TUI_AHEAD, tui_meaning('w'));
    TEST_ASSERT_EQUAL_INT(TUI_AHEAD, tui_meaning(TUI_KEY_UP));
    TEST_ASSERT_EQUAL_INT(TUI_BACK, tui_meaning('s'));
    TEST_ASSERT_EQUAL_INT(TUI_LEFT, tui_meaning('a'));
    TEST_ASSERT_EQUAL_INT(TUI_RIGHT, tui_meaning(TUI_KEY_RIGHT));
    TEST_ASSERT_EQUAL_INT(TUI_STOP, tui_meaning(' '));
    TEST_ASSERT_EQUAL_INT(TUI_GO, tui_meaning('g'));
    TEST_ASSERT_EQUAL_INT(TUI_RECHECK, tui_meaning('r'));
    TEST_ASSERT_EQUAL_INT(TUI_PASSIVE, tui_meaning('p'));
    TEST_ASSERT_EQUAL_INT(TUI_QUIT, tui_meaning('q'));
    TEST_ASSERT_EQUAL_INT(TUI_NEXT, tui_meaning('n'));
    TEST_ASSERT_EQUAL_INT(TUI_PREVIOUS, tui_meaning('b'));
    TEST_ASSERT_EQUAL_INT(TUI_RETEST, tui_meaning('t'));
    TEST_ASSERT_EQUAL_INT(TUI_PIN, tui_meaning('k'));
    TEST_ASSERT_EQUAL_INT(TUI_TAKE_OUT, tui_meaning('x'));
    TEST_ASSERT_EQUAL_INT(TUI_QUIT, tui_meaning(3));
    TEST_ASSERT_EQUAL_INT(TUI_HELP, tui_meaning('?'));
    TEST_ASSERT_EQUAL_INT(TUI_UNKNOWN, tui_meaning('z'));
    TEST_ASSERT_EQUAL_INT(TUI_UNKNOWN, tui_meaning(-1));
    TEST_ASSERT_EQUAL_INT(TUI_NONE, tui_meaning(TUI_KEY_NONE));
}

void test_what_repeats_is_one_line_that_counts(void) {
    screen_log_add(&log_, "before", TONE_PLAIN, 7);
    for (int i = 0; i < 100; i++) {
        screen_log_add(&log_, i % 2 == 0 ? "suspect 3" : "dropped 3", TONE_WARN, 3);
        screen_log_add(&log_, i % 2 == 0 ? "suspect 4" : "dropped 4", TONE_WARN, 4);
    }
    TEST_ASSERT_EQUAL_INT(3, log_.count);
    draw(24, 80);
    TEST_ASSERT_EQUAL_INT(17, find("before"));
    TEST_ASSERT_EQUAL_INT(18, find("dropped 3 (100 times)"));
    TEST_ASSERT_EQUAL_INT(19, find("dropped 4 (100 times)"));
    for (int i = 0; i < 20; i++) { // long ago is another story
        screen_log_add(&log_, "other", TONE_PLAIN, 0);
    }
    screen_log_add(&log_, "suspect 3", TONE_WARN, 3);
    draw(24, 80);
    TEST_ASSERT_EQUAL_INT(22, find("suspect 3"));
    TEST_ASSERT_EQUAL_INT(-1, find("(101 times)"));
}

void test_a_pause_is_shown(void) {
    draw(24, 80);
    TEST_ASSERT_EQUAL_INT(-1, find("PAUSED"));
    view.status.paused = true;
    draw(24, 80);
    TEST_ASSERT_EQUAL_INT(1, find("PAUSED"));
}

void test_the_keys_are_listed_each_with_what_it_does(void) {
    draw(24, 80);
    screen_draw_keys(&canvas);
#define LISTED(name, keys, effect)                           \
    TEST_ASSERT_NOT_EQUAL_MESSAGE(-1, find(keys), keys);     \
    TEST_ASSERT_NOT_EQUAL_MESSAGE(-1, find(effect), effect); \
    TEST_ASSERT_EQUAL_STRING(keys, tui_keys_of(TUI_##name)); \
    TEST_ASSERT_EQUAL_STRING(effect, tui_effect_of(TUI_##name));
    TUI_KEY_TABLE(LISTED)
#undef LISTED
    TEST_ASSERT_EQUAL_STRING("", tui_keys_of(TUI_UNKNOWN));
    draw(4, 10);
    screen_draw_keys(&canvas); // no room is no harm
}

// Whoever reads the keys looks for the one that goes on.
void test_the_list_of_keys_hides_neither_a_pause_nor_an_injected_fault(void) {
    view.status.paused = true;
    view.injected[3] = ARGUS_KIND_STUCK;
    for (int columns = 40; columns <= 120; columns += 5) {
        draw(24, columns);
        screen_draw_keys(&canvas);
        TEST_ASSERT_EQUAL_INT(1, find("PAUSED"));
        TEST_ASSERT_NOT_EQUAL(-1, find("INJECTED FAULT"));
        TEST_ASSERT_NOT_EQUAL(-1, find("stop and end"));
    }
}

// Words of the wide screen, and those that stand for a column where there is less room.
static bool is_a_word(const char *wide, const char *word) {
    static const char *const others[] = {"#", "mm", "health", "arrows/wasd", "wasd", "?"};
    char framed[64];
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        if (strcmp(word, others[i]) == 0) {
            return true;
        }
    }
    snprintf(framed, sizeof framed, " %s ", word);
    for (char *c = framed; *c != '\0'; c++) { // a cut ends before a comma, too
        *c = *c == ',' || *c == ':' || *c == ';' ? ' ' : *c;
    }
    return strstr(wide, framed) != NULL;
}

void test_a_narrow_screen_tells_which_event_it_was(void) {
    screen_log_add(&log_, "   12.345 WARN  drive          STOPPED 0: STOP sent", TONE_WARN, 0);
    screen_log_add(&log_, " > g: go on with the course", TONE_PLAIN, 0);
    draw(24, 40);
    TEST_ASSERT_NOT_EQUAL(-1, find("drive STOPPED 0: STOP sent"));
    TEST_ASSERT_EQUAL(-1, find("WARN"));
    TEST_ASSERT_NOT_EQUAL(-1, find("> g: go on with the course"));
    draw(24, 80);
    TEST_ASSERT_NOT_EQUAL(-1, find("12.345 WARN  drive"));
}

void test_a_narrow_screen_without_colours_tells_the_level(void) {
    screen_log_add(&log_, "   12.345 WARN  drive          STOPPED 0: STOP sent", TONE_WARN, 0);
    canvas.colourless = true;
    draw(24, 45);
    TEST_ASSERT_NOT_EQUAL(-1, find("WARN drive STOPPED 0: STOP sent"));
    TEST_ASSERT_EQUAL(-1, find("12.345"));
}

void test_a_narrow_screen_keeps_the_name_of_what_it_counts(void) {
    for (int i = 0; i < 2; i++) {
        screen_log_add(&log_, "   12.345 OK    health         HEALTH_CHECK 0: all front sonars have reported",
                       TONE_PLAIN, 77);
    }
    draw(24, 40);
    TEST_ASSERT_NOT_EQUAL(-1, find("health HEALTH_CHECK 0"));
    TEST_ASSERT_NOT_EQUAL(-1, find("(2 times)"));
}

void test_a_narrow_screen_says_why_a_key_had_no_effect(void) {
    screen_log_add(&log_, " > up, w: one step ahead: not while passive", TONE_WARN, 0);
    draw(24, 40);
    TEST_ASSERT_NOT_EQUAL(-1, find("one step ahead: not while passive"));
}

void test_a_narrow_screen_says_that_it_is_paused(void) {
    view.status.paused = true;
    draw(24, 40);
    TEST_ASSERT_NOT_EQUAL(-1, find("PAUSED"));
}

void test_a_notice_that_begins_with_digits_loses_nothing_on_a_narrow_screen(void) {
    static const char *const notices[] = {"127.0.0.1 port 81: no answer", "3 orders lost", "12.3456 of it",
                                          "12.34 of it", "12.345"};
    for (size_t i = 0; i < sizeof notices / sizeof notices[0]; i++) {
        screen_log_add(&log_, notices[i], TONE_WARN, 0);
    }
    draw(24, 40);
    for (size_t i = 0; i < sizeof notices / sizeof notices[0]; i++) {
        TEST_ASSERT_NOT_EQUAL_MESSAGE(-1, find(notices[i]), notices[i]);
    }
}

void test_narrow_screens_drop_columns_and_cut_no_word(void) {
    static char wide[SCREEN_ROWS_MAX * (SCREEN_COLUMNS_MAX + 2)];
    char text[SCREEN_COLUMNS_MAX + 1];
    size_t used = 0;
    view.status.waypoints = 2;
    view.status.goal_mm = 1500;
    view.course_mm = 3000;
    view.status.paused = true;
    screen_log_add(&log_, "  83.123 WARN  sonar/front/03 SONAR_SUSPECT 312: disparate to its neighbours",
                   TONE_WARN, 1);
    draw(24, 200);
    for (int row = 0; row < canvas.rows; row++) {
        row_text(row, text);
        used += (size_t)snprintf(wide + used, sizeof wide - used, " %s ", text);
    }
    for (char *c = wide; *c != '\0'; c++) {
        *c = *c == ',' || *c == ':' || *c == ';' ? ' ' : *c;
    }
    for (int columns = 1; columns < 73; columns++) { // from 73 on there is the ring
        draw(24, columns);
        for (int row = 0; row < canvas.rows; row++) {
            row_text(row, text);
            for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
                char message[128];
                snprintf(message, sizeof message, "%d columns, row %d: '%s'", columns, row, word);
                TEST_ASSERT_TRUE_MESSAGE(is_a_word(wide, word), message);
            }
        }
    }
    draw(24, 45);
    TEST_ASSERT_NOT_EQUAL(-1, find(" 6  -50 1006 HEALTHY"));
    draw(24, 40);
    TEST_ASSERT_NOT_EQUAL(-1, find(" 6  1006 HEALTHY"));
    draw(24, 20);
    TEST_ASSERT_NOT_EQUAL(-1, find(" 6  1006  14  1014"));
}

void test_an_injected_fault_is_not_taken_for_a_real_one(void) {
    draw(24, 80);
    TEST_ASSERT_EQUAL_INT(-1, find("INJECTED"));
    view.injected[3] = ARGUS_KIND_STUCK;
    for (int columns = 20; columns <= 120; columns += 5) {
        draw(24, columns);
        TEST_ASSERT_TRUE(find("INJECTED FAULT") >= 0);
        TEST_ASSERT_TRUE(find(" 3*") >= 0);
        TEST_ASSERT_EQUAL_INT(-1, find(" 2*"));
    }
}
