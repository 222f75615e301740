// SPDX-License-Identifier: MIT
// The settings of a board: compiled in as an INI text, changed one by one over the second UART, kept as what
// differs.
#ifndef BOARD_CONFIG_H
#define BOARD_CONFIG_H

#include "argus/argus.h"
#include "board/word.h"

enum {
#define BOARD_CONFIG_ROW(key, def, min, max, unit, choices, meaning) BOARD_CONFIG_##key,
    ARGUS_CONFIG_TABLE(BOARD_CONFIG_ROW)
#undef BOARD_CONFIG_ROW
        BOARD_CONFIG_COUNT
};

// Of board_config_pack(): a count, then for each a digest of the key, and the number or the digest of the
// word.
#define BOARD_CONFIG_PACKED_MAX (2 + 8 * BOARD_CONFIG_COUNT)

typedef enum {
    BOARD_CONFIG_TAKEN,
    BOARD_CONFIG_NO_KEY,   // no such key
    BOARD_CONFIG_NO_VALUE, // neither a whole number nor one of the choices
    BOARD_CONFIG_NO_RANGE, // out of its range
    BOARD_CONFIG_NO_LINE   // neither key = value, nor [argus], nor a comment
} board_config_answer_t;

// Sets one key. Not TAKEN: nothing is changed.
board_config_answer_t board_config_set(argus_config_t *config, board_word_t key, board_word_t value);

// Sets what an INI text says, up to the first line that is wrong, whose number from 1 `*line` becomes.
board_config_answer_t board_config_ini(argus_config_t *config, const char *text, unsigned *line);

// What a refusal means; static text.
const char *board_config_explain(board_config_answer_t answer);
const char *board_config_fault_text(argus_config_fault_t fault);

const char *board_config_key(int row);
int32_t board_config_value(const argus_config_t *config, int row);

// CRC-32 over all numbers and words: two boards with the same digest run with the same settings, whatever
// choices their builds have beside.
uint32_t board_config_digest(const argus_config_t *config);

// Writes what differs from `base`; the length.
size_t board_config_pack(const argus_config_t *base, const argus_config_t *config,
                         uint8_t bytes[BOARD_CONFIG_PACKED_MAX]);

// Reads that back over `config`; its length, 0: damaged. A key that there is no more is left out.
// `*outdated`: it has a word that there is no more, or the place of one instead, as builds before stored it;
// then nothing is taken.
size_t board_config_unpack(argus_config_t *config, const uint8_t *bytes, size_t count, bool *outdated);

// That length alone.
size_t board_config_length(const uint8_t *bytes, size_t count);

#endif
