// SPDX-License-Identifier: MIT
// Orders by their words.
#include "board/orders.h"

#include <string.h>

#include "board/config.h"

static const char taken[] = "taken";

typedef struct {
    const char *at;
    size_t length;
} word_t;

typedef struct {
    const char *word;
    argus_op_t op;
    bool has_number;
} op_t;

static const op_t ops[] = {
    {"stop", ARGUS_OP_STOP, false},       {"go", ARGUS_OP_GO, false},
    {"recheck", ARGUS_OP_RECHECK, false}, {"move", ARGUS_OP_MOVE, true},
    {"turn", ARGUS_OP_TURN, true},        {"passive", ARGUS_OP_PASSIVE, false},
    {"active", ARGUS_OP_ACTIVE, false},   {"retest", ARGUS_OP_RETEST, true},
    {"pin", ARGUS_OP_PIN, true},          {"unpin", ARGUS_OP_UNPIN, true},
    {"disable", ARGUS_OP_DISABLE, true},
};

static const struct {
    const char *word;
    board_wish_t wish;
} wishes[] = {
    {"status", BOARD_WISH_STATUS},     {"settings", BOARD_WISH_SETTINGS}, {"save", BOARD_WISH_SAVE},
    {"shutdown", BOARD_WISH_SHUTDOWN}, {"restart", BOARD_WISH_RESTART},
};

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

static word_t next_word(const char **at) {
    while (**at == ' ') {
        (*at)++;
    }
    word_t word = {.at = *at};
    while (**at != ' ' && **at != '\0') {
        (*at)++;
        word.length++;
    }
    return word;
}

static bool is_word(word_t word, const char *text) {
    return word.length == strlen(text) && memcmp(word.at, text, word.length) == 0;
}

// A whole number of at most 6 digits, up to `stop`; false: something else.
static bool number_of(const char **at, char stop, int32_t *value) {
    const bool is_negative = **at == '-';
    int digits = 0;
    *value = 0;
    for (*at += is_negative; **at >= '0' && **at <= '9' && digits <= 6; (*at)++, digits++) {
        *value = *value * 10 + (**at - '0');
    }
    *value = is_negative ? -*value : *value;
    return digits > 0 && digits <= 6 && **at == stop;
}

static const char *obey_op(const op_t *op, const char *rest, argus_t *core, uint32_t now_ms) {
    int32_t argument = 0;
    const word_t word = next_word(&rest);
    const char *number = word.at;
    if (op->has_number ? !number_of(&number, '\0', &argument) : word.length > 0) {
        return op->has_number ? "give one whole number" : "nothing may follow it";
    }
    return argus_operator(core, now_ms, op->op, argument) ? taken : "it cannot be done now";
}

static const char *obey_course(const char *rest, argus_t *core) {
    argus_point_t points[BOARD_ORDER_POINTS_MAX];
    uint16_t count = 0;
    for (word_t word = next_word(&rest); word.length > 0; word = next_word(&rest)) {
        const char *at = word.at;
        if (count == BOARD_ORDER_POINTS_MAX) {
            return "at most 16 points";
        }
        if (!number_of(&at, ',', &points[count].x_mm)) {
            return "give points as X,Y in mm";
        }
        at++;
        if (!number_of(&at, *rest, &points[count].y_mm) || at != rest) {
            return "give points as X,Y in mm";
        }
        count++;
    }
    return argus_set_course(core, points, count) ? taken : "1 to 16 points, each within 30 m";
}

static const char *obey_set(const char *rest, argus_config_t *config) {
    argus_config_t changed = *config;
    const word_t key = next_word(&rest);
    const word_t value = next_word(&rest);
    if (next_word(&rest).length > 0) {
        return "give a key and a value";
    }
    const board_config_answer_t answer =
        board_config_set(&changed, key.at, key.length, value.at, value.length);
    if (answer != BOARD_CONFIG_TAKEN) {
        return board_config_explain(answer);
    }
    if (memcmp(&changed, config, sizeof changed) == 0) {
        return "it is so already";
    }
    *config = changed;
    return "from the next start on, if it is saved";
}

static const char *obey_word(word_t word, const char *rest, argus_t *core, uint32_t now_ms,
                             argus_config_t *config) {
    for (size_t i = 0; i < sizeof ops / sizeof ops[0]; i++) {
        if (is_word(word, ops[i].word)) {
            return obey_op(&ops[i], rest, core, now_ms);
        }
    }
    if (is_word(word, "course")) {
        return obey_course(rest, core);
    }
    if (is_word(word, "set")) {
        return obey_set(rest, config);
    }
    return "no such order";
}

static board_wish_t wish_of(word_t word, const char *rest) {
    for (size_t i = 0; i < sizeof wishes / sizeof wishes[0] && next_word(&rest).length == 0; i++) {
        if (is_word(word, wishes[i].word)) {
            return wishes[i].wish;
        }
    }
    return BOARD_WISH_NONE;
}

const char *board_orders_obey(board_orders_t *self, argus_t *core, uint32_t now_ms, argus_config_t *config,
                              board_wish_t *wish) {
    const bool is_bad = self->is_bad;
    self->line[self->length] = '\0';
    self->length = 0;
    self->is_bad = false;
    *wish = BOARD_WISH_NONE;
    if (is_bad) {
        return "too long, or not plain text";
    }
    const char *rest = self->line;
    const word_t word = next_word(&rest);
    *wish = wish_of(word, rest);
    return *wish != BOARD_WISH_NONE ? taken : obey_word(word, rest, core, now_ms, config);
}
