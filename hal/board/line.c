// SPDX-License-Identifier: MIT
// Bytes of a line are laid behind the ring's head, which moves when the line is whole.
#include "board/line.h"

#define DIGITS_MAX 10
#define ARRAY_SONARS 8

static void add(board_line_t *self, char character) {
    if (self->at == self->end) {
        self->cut = true;
        return;
    }
    self->ring->bytes[self->at & (self->ring->size - 1u)] = (uint8_t)character;
    self->at++;
}

static void add_text(board_line_t *self, const char *text) {
    for (; *text != '\0'; text++) {
        add(self, *text);
    }
}

static void separate(board_line_t *self) {
    if (self->comma) {
        add(self, ',');
    }
    self->comma = true;
}

// What would need an escape, or is no ASCII, is a question mark: it is of no use here.
static void add_quoted(board_line_t *self, const char *text) {
    add(self, '"');
    for (; *text != '\0'; text++) {
        const bool plain = *text >= ' ' && *text <= '~' && *text != '"' && *text != '\\';
        add(self, plain ? *text : '?');
    }
    add(self, '"');
}

static void add_number(board_line_t *self, uint32_t value, int digits) {
    char text[DIGITS_MAX];
    int count = 0;
    do {
        text[count++] = (char)('0' + value % 10u);
        value /= 10u;
    } while (value > 0 || count < digits);
    while (count > 0) {
        add(self, text[--count]);
    }
}

static void add_signed(board_line_t *self, int32_t value) {
    if (value < 0) {
        add(self, '-');
    }
    add_number(self, value < 0 ? 0u - (uint32_t)value : (uint32_t)value, 1);
}

board_line_t board_line_begin(board_ring_t *ring) {
    board_line_t self = {.ring = ring, .cut = ring == NULL};
    if (ring != NULL) {
        self.at = atomic_load_explicit(&ring->head, memory_order_relaxed);
        self.end = (uint16_t)(self.at + board_ring_room(ring));
    }
    add(&self, '{');
    return self;
}

bool board_line_end(board_line_t *self) {
    add_text(self, "}\n");
    if (self->ring != NULL && !self->cut) {
        atomic_store_explicit(&self->ring->head, self->at, memory_order_release);
    }
    return !self->cut;
}

void board_line_name(board_line_t *self, const char *name) {
    separate(self);
    add_quoted(self, name);
    add(self, ':');
    self->comma = false;
}

void board_line_word(board_line_t *self, const char *value) {
    separate(self);
    add_quoted(self, value);
}

void board_line_item(board_line_t *self, int32_t value) {
    separate(self);
    add_signed(self, value);
}

void board_line_text(board_line_t *self, const char *name, const char *value) {
    board_line_name(self, name);
    board_line_word(self, value);
}

void board_line_int(board_line_t *self, const char *name, int32_t value) {
    board_line_name(self, name);
    board_line_item(self, value);
}

void board_line_bool(board_line_t *self, const char *name, bool value) {
    board_line_name(self, name);
    add_text(self, value ? "true" : "false");
    self->comma = true;
}

void board_line_hex(board_line_t *self, const char *name, uint32_t value) {
    board_line_name(self, name);
    add(self, '"');
    for (int shift = 28; shift >= 0; shift -= 4) {
        add(self, "0123456789abcdef"[value >> shift & 15u]);
    }
    add(self, '"');
    self->comma = true;
}

void board_line_seconds(board_line_t *self, const char *name, uint32_t ms) {
    board_line_name(self, name);
    add_number(self, ms / 1000u, 1);
    add(self, '.');
    add_number(self, ms % 1000u, 3);
    self->comma = true;
}

// "sonar/front/03", "sonar/rear/11"
void board_line_sonar(board_line_t *self, const char *name, int sonar) {
    static const char arrays[][13] = {"front/", "rear/", "upper_front/", "upper_rear/"};
    board_line_name(self, name);
    add_text(self, "\"sonar/");
    add_text(self, arrays[sonar / ARRAY_SONARS]);
    add_number(self, (uint32_t)sonar, 2);
    add(self, '"');
    self->comma = true;
}

void board_line_open(board_line_t *self, const char *name) {
    board_line_name(self, name);
    add(self, '[');
}

void board_line_close(board_line_t *self) {
    add(self, ']');
    self->comma = true;
}
