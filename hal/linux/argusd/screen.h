// SPDX-License-Identifier: MIT
// The screen as a grid of characters: what the paper's user interface shows, laid out for 80 x 24 and up.
#ifndef ARGUSD_SCREEN_H
#define ARGUSD_SCREEN_H

#include <stdbool.h>
#include <stdint.h>

#include "view.h"

#define SCREEN_ROWS_MAX 80
#define SCREEN_COLUMNS_MAX 200
#define SCREEN_LOG_LINES 64
#define SCREEN_LOG_WIDTH 160

typedef enum { TONE_PLAIN, TONE_TITLE, TONE_DIM, TONE_GOOD, TONE_WARN, TONE_BAD, TONE_OPERATOR } tone_t;

typedef struct {
    char character;
    uint8_t tone;
} cell_t;

typedef struct {
    int rows;
    int columns;
    bool colourless; // words tell what colours would; canvas_clear leaves it
    cell_t cell[SCREEN_ROWS_MAX][SCREEN_COLUMNS_MAX];
} canvas_t;

// A line said, and how often in a row of few.
typedef struct {
    char text[SCREEN_LOG_WIDTH];
    uint8_t tone;
    uint16_t key;
    uint16_t times;
} screen_line_t;

// The last lines said, oldest first.
typedef struct {
    screen_line_t line[SCREEN_LOG_LINES];
    int count;
} screen_log_t;

// A line whose key is that of one of the last few takes its place, at the end, and counts; key 0 never does.
void screen_log_add(screen_log_t *self, const char *line, tone_t tone, uint16_t key);

// Sizes are cut to the largest; any size down to 1 x 1 is drawn, as much of it as fits.
void canvas_clear(canvas_t *self, int rows, int columns);

// Draws everything that fits: a narrow canvas has fewer columns and shorter lines, but no word is cut.
void screen_draw(canvas_t *canvas, const view_t *view, const screen_log_t *log);

// Lays the list of keys over it, below the lines that say what the robot does.
void screen_draw_keys(canvas_t *canvas);

#endif
