// SPDX-License-Identifier: MIT
// Settings by name, from the firmware's table.
#include "board/config.h"

#include <string.h>

#include "hal/crc32.h"

#define SECTION "[argus]"
#define PAIR_BYTES 8u

// Texts in a row, and numbers as they fit.
#define KEY(key, def, min, max, unit, choices, meaning) #key "\0"
#define CHOICES(key, def, min, max, unit, choices, meaning) choices "\0"
#define DEFAULT(key, def, min, max, unit, choices, meaning) (def),
#define MINIMUM(key, def, min, max, unit, choices, meaning) (min),
#define MAXIMUM(key, def, min, max, unit, choices, meaning) (max),
static const char keys[] = ARGUS_CONFIG_TABLE(KEY);
static const char choices_of[] = ARGUS_CONFIG_TABLE(CHOICES);
static const int16_t defaults[BOARD_CONFIG_COUNT] = {ARGUS_CONFIG_TABLE(DEFAULT)};
static const int16_t minima[BOARD_CONFIG_COUNT] = {ARGUS_CONFIG_TABLE(MINIMUM)};
static const int32_t maxima[BOARD_CONFIG_COUNT] = {ARGUS_CONFIG_TABLE(MAXIMUM)};

_Static_assert(sizeof(argus_config_t) == BOARD_CONFIG_COUNT * sizeof(int32_t),
               "the settings are one int32_t for each row of their table");

const char *board_config_key(int row) {
    return board_word_nth(keys, row);
}

int32_t board_config_value(const argus_config_t *config, int row) {
    int32_t value = 0;
    memcpy(&value, (const char *)config + (size_t)row * sizeof value, sizeof value);
    return value;
}

static void put_value(argus_config_t *config, int row, int32_t value) {
    memcpy((char *)config + (size_t)row * sizeof value, &value, sizeof value);
}

// The value of one of "a|b|c", or -1.
static int32_t choice_of(const char *choices, board_word_t word) {
    const char *at = choices;
    for (int32_t value = 0; word.length > 0; value++) {
        size_t size = 0;
        // The analyzer does not follow texts that stand in a row, each with its end.
        // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult)
        while (at[size] != '\0' && at[size] != '|') {
            size++;
        }
        if (size == word.length && memcmp(at, word.at, size) == 0) {
            return value;
        }
        if (at[size] == '\0') {
            break;
        }
        at += size + 1;
    }
    return -1;
}

static bool is_in_range(int row, int32_t value) {
    return value >= minima[row] && value <= maxima[row];
}

board_config_answer_t board_config_set(argus_config_t *config, board_word_t key, board_word_t value) {
    const int row = board_word_row(key, keys);
    int32_t number = 0;
    if (row < 0) {
        return BOARD_CONFIG_NO_KEY;
    }
    const char *const choices = board_word_nth(choices_of, row);
    const bool may_be_number = *choices == '\0' || board_word_is((board_word_t){"auto", 4}, choices);
    number = choice_of(choices, value);
    const bool is_named = number >= 0;
    if (!is_named && (!may_be_number || !board_word_number(value, &number))) {
        return BOARD_CONFIG_NO_VALUE;
    }
    if (!is_named && !is_in_range(row, number)) {
        return BOARD_CONFIG_NO_RANGE;
    }
    put_value(config, row, number);
    return BOARD_CONFIG_TAKEN;
}

static bool is_blank(char character) {
    return character == ' ' || character == '\t' || character == '\r';
}

static board_word_t trimmed(const char *from, const char *to) {
    while (from < to && is_blank(*from)) {
        from++;
    }
    while (to > from && is_blank(to[-1])) {
        to--;
    }
    return (board_word_t){from, (size_t)(to - from)};
}

// A remark begins a line, or stands behind a blank.
static const char *end_of_value(const char *from, const char *to) {
    for (const char *at = from; at < to; at++) {
        if (*at == ';' && at > from && is_blank(at[-1])) {
            return at;
        }
    }
    return to;
}

static board_config_answer_t take_line(argus_config_t *config, const char *from, const char *to) {
    const board_word_t line = trimmed(from, to);
    if (line.length == 0 || line.at[0] == '#' || line.at[0] == ';' || board_word_is(line, SECTION)) {
        return BOARD_CONFIG_TAKEN;
    }
    const char *const end = line.at + line.length;
    const char *const equals = board_word_find(line.at, end, '=');
    if (equals == end) {
        return BOARD_CONFIG_NO_LINE;
    }
    const board_word_t key = trimmed(line.at, equals);
    const board_word_t value = trimmed(equals + 1, end_of_value(equals + 1, end));
    return board_config_set(config, key, value);
}

board_config_answer_t board_config_ini(argus_config_t *config, const char *text, unsigned *line) {
    const char *const end = text + strlen(text);
    *line = 0;
    while (text < end) {
        const char *const stop = board_word_find(text, end, '\n');
        (*line)++;
        const board_config_answer_t answer = take_line(config, text, stop);
        if (answer != BOARD_CONFIG_TAKEN) {
            return answer;
        }
        text = stop + 1;
    }
    return BOARD_CONFIG_TAKEN;
}

// In the order of what they explain.
const char *board_config_explain(board_config_answer_t answer) {
    return board_word_nth("taken\0no such key\0neither number nor choice\0out of its range\0"
                          "write key = value\0",
                          (int)answer);
}

const char *board_config_fault_text(argus_config_fault_t fault) {
    return board_word_nth("ok\0out of range\0S5: less speed_mm_s or more object_range_mm\0"
                          "S5: less step_mm or more check_range_mm\0",
                          (int)fault);
}

static void put32(uint8_t *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++) {
        bytes[i] = (uint8_t)(value >> (8 * i));
    }
}

static uint32_t get32(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

// A setting that is picked by name; "auto" is a number that has one word.
static bool is_picked(int row) {
    const char *const choices = board_word_nth(choices_of, row);
    const char *const end = choices + strlen(choices);
    return board_word_find(choices, end, '|') < end;
}

// The word that stands for a value, "" for none.
static board_word_t word_of(int row, int32_t value) {
    const char *at = board_word_nth(choices_of, row);
    const char *const end = at + strlen(at);
    for (; value > 0 && at < end; value--) {
        const char *const bar = board_word_find(at, end, '|');
        at = bar < end ? bar + 1 : end;
    }
    const char *const stop = board_word_find(at, end, '|');
    return value < 0 ? (board_word_t){at, 0} : (board_word_t){at, (size_t)(stop - at)};
}

// What a value means, however many choices a later table has before it: the digest of its word, or the
// number.
static uint32_t meaning_of(int row, int32_t value) {
    const board_word_t word = word_of(row, value);
    return is_picked(row) && word.length > 0 ? hal_crc32(0, word.at, word.length) : (uint32_t)value;
}

// The value that means so; -1: no word of the table has this digest.
static int32_t picked_by(int row, uint32_t meaning) {
    for (int32_t value = 0; word_of(row, value).length > 0; value++) {
        if (meaning_of(row, value) == meaning) {
            return value;
        }
    }
    return -1;
}

uint32_t board_config_digest(const argus_config_t *config) {
    uint32_t crc = 0;
    for (int row = 0; row < BOARD_CONFIG_COUNT; row++) {
        uint8_t bytes[4];
        put32(bytes, meaning_of(row, board_config_value(config, row)));
        crc = hal_crc32(crc, bytes, sizeof bytes);
    }
    return crc;
}

static uint32_t key_digest(int row) {
    const char *const key = board_config_key(row);
    return hal_crc32(0, key, strlen(key));
}

// Of a setting that is picked by name another one than builds used that stored the place of the word.
static uint32_t stored_key(int row) {
    return is_picked(row) ? hal_crc32(key_digest(row), "=", 1) : key_digest(row);
}

size_t board_config_pack(const argus_config_t *base, const argus_config_t *config,
                         uint8_t bytes[BOARD_CONFIG_PACKED_MAX]) {
    uint16_t pairs = 0;
    for (int row = 0; row < BOARD_CONFIG_COUNT; row++) {
        const int32_t value = board_config_value(config, row);
        if (value != board_config_value(base, row)) {
            put32(bytes + 2 + PAIR_BYTES * pairs, stored_key(row));
            put32(bytes + 2 + PAIR_BYTES * pairs + 4, meaning_of(row, value));
            pairs++;
        }
    }
    bytes[0] = (uint8_t)pairs;
    bytes[1] = (uint8_t)(pairs >> 8);
    return 2 + PAIR_BYTES * pairs;
}

// False: a word that the table has no more. A number of another range is left out.
static bool take_meaning(argus_config_t *config, int row, uint32_t meaning) {
    const bool picked = is_picked(row);
    const int32_t value = picked ? picked_by(row, meaning) : (int32_t)meaning;
    if (picked && value < 0) {
        return false;
    }
    if (picked || value == defaults[row] || is_in_range(row, value)) {
        put_value(config, row, value);
    }
    return true;
}

// False: by the place of a word, as older builds stored it, or a word that the table has no more. A key that
// there is no more is left out.
static bool take_pair(argus_config_t *config, uint32_t key, uint32_t meaning) {
    for (int row = 0; row < BOARD_CONFIG_COUNT; row++) {
        if (is_picked(row) && key == key_digest(row)) {
            return false;
        }
        if (key == stored_key(row)) {
            return take_meaning(config, row, meaning);
        }
    }
    return true;
}

size_t board_config_length(const uint8_t *bytes, size_t count) {
    if (count < 2) {
        return 0;
    }
    const size_t pairs = (size_t)bytes[0] | (size_t)bytes[1] << 8;
    return pairs > (count - 2) / PAIR_BYTES ? 0 : 2 + PAIR_BYTES * pairs;
}

size_t board_config_unpack(argus_config_t *config, const uint8_t *bytes, size_t count, bool *outdated) {
    const size_t length = board_config_length(bytes, count);
    argus_config_t taken = *config;
    *outdated = false;
    for (size_t at = 2; at < length && !*outdated; at += PAIR_BYTES) {
        *outdated = !take_pair(&taken, get32(bytes + at), get32(bytes + at + 4));
    }
    if (!*outdated) {
        *config = taken;
    }
    return length;
}
