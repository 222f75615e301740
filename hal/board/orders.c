// SPDX-License-Identifier: MIT
// Orders by their words.
#include "board/orders.h"

#include <string.h>

#include "board/config.h"

static const char taken[] = "taken";
static const char too_many_or_far[] = "1 to 16 points within 30 m";

#define NUMBERED                                                                              \
    (1u << ARGUS_OP_MOVE | 1u << ARGUS_OP_TURN | 1u << ARGUS_OP_RETEST | 1u << ARGUS_OP_PIN | \
     1u << ARGUS_OP_UNPIN | 1u << ARGUS_OP_DISABLE)

// In the order of board_wish_t, likewise.
static const char wishes[] = "status\0settings\0save\0shutdown\0restart\0";

bool board_orders_take(board_orders_t *self, uint8_t byte) {
    if (byte == '\n' || byte == '\r') {
        return self->length > 0 || self->is_bad;
    }
    if (byte < ' ' || byte > '~' || self->length + 1u >= sizeof self->line) {
        self->is_bad = true;
    } else {
        self->line[self->length++] = (char)byte;
    }
    return false;
}

static board_word_t next_word(const char **at) {
    while (**at == ' ') {
        (*at)++;
    }
    board_word_t word = {.at = *at};
    while (**at != ' ' && **at != '\0') {
        (*at)++;
        word.length++;
    }
    return word;
}

static const char *obey_op(argus_op_t op, const char *rest, argus_t *core, uint32_t now_ms) {
    int32_t argument = 0;
    const bool has_number = (NUMBERED >> op & 1u) != 0;
    const board_word_t word = next_word(&rest);
    if (has_number ? !board_word_number(word, &argument) || next_word(&rest).length > 0 : word.length > 0) {
        return has_number ? "give one whole number" : "nothing may follow";
    }
    return argus_operator(core, now_ms, op, argument) ? taken : "not possible now";
}

// "X,Y"
static bool point_of(board_word_t word, argus_point_t *point) {
    const char *const end = word.at + word.length;
    const char *const comma = board_word_find(word.at, end, ',');
    return comma < end &&
           board_word_number((board_word_t){word.at, (size_t)(comma - word.at)}, &point->x_mm) &&
           board_word_number((board_word_t){comma + 1, (size_t)(end - comma - 1)}, &point->y_mm);
}

static const char *obey_course(const char *rest, argus_t *core) {
    argus_point_t points[BOARD_ORDER_POINTS_MAX];
    uint16_t count = 0;
    for (board_word_t word = next_word(&rest); word.length > 0; word = next_word(&rest)) {
        if (count == BOARD_ORDER_POINTS_MAX) {
            return too_many_or_far;
        }
        if (!point_of(word, &points[count])) {
            return "give points as X,Y in mm";
        }
        count++;
    }
    return argus_set_course(core, points, count) ? taken : too_many_or_far;
}

static const char *obey_set(const char *rest, argus_config_t *config) {
    argus_config_t changed = *config;
    const board_word_t key = next_word(&rest);
    const board_word_t value = next_word(&rest);
    if (next_word(&rest).length > 0) {
        return "give a key and a value";
    }
    const board_config_answer_t answer = board_config_set(&changed, key, value);
    if (answer != BOARD_CONFIG_TAKEN) {
        return board_config_explain(answer);
    }
    if (memcmp(&changed, config, sizeof changed) == 0) {
        return "it is so already";
    }
    *config = changed;
    return "from the next start, if it is saved";
}

// In small letters, of which capitals lack a bit.
static bool names(board_word_t word, const char *name) {
    size_t i = 0;
    while (i < word.length && word.at[i] == (name[i] | ('a' - 'A'))) {
        i++;
    }
    return i == word.length && name[i] == '\0';
}

static const char *obey_word(board_word_t word, const char *rest, argus_t *core, uint32_t now_ms,
                             argus_config_t *config) {
    for (int op = ARGUS_OP_STOP; op <= ARGUS_OP_DISABLE; op++) {
        if (names(word, argus_name(ARGUS_NAME_OP, op))) {
            return obey_op((argus_op_t)op, rest, core, now_ms);
        }
    }
    if (board_word_is(word, "course")) {
        return obey_course(rest, core);
    }
    if (board_word_is(word, "set")) {
        return obey_set(rest, config);
    }
    return "no such order";
}

static board_wish_t wish_of(board_word_t word, const char *rest) {
    const bool alone = next_word(&rest).length == 0;
    return alone ? (board_wish_t)(BOARD_WISH_NONE + 1 + board_word_row(word, wishes)) : BOARD_WISH_NONE;
}

const char *board_orders_obey(board_orders_t *self, argus_t *core, uint32_t now_ms, argus_config_t *config,
                              board_wish_t *wish) {
    const bool is_bad = self->is_bad;
    self->line[self->length] = '\0';
    self->length = 0;
    self->is_bad = false;
    *wish = BOARD_WISH_NONE;
    if (is_bad) {
        return "too long or no text";
    }
    const char *rest = self->line;
    const board_word_t word = next_word(&rest);
    *wish = wish_of(word, rest);
    return *wish != BOARD_WISH_NONE ? taken : obey_word(word, rest, core, now_ms, config);
}
