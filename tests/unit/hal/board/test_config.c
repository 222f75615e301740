// SPDX-License-Identifier: MIT
// Rule under attack: a board takes the settings that the table allows and no others, keeps what differs, and
// never runs with half a setting.
#include "board/config.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

static argus_config_t config;
static argus_config_t base;
static uint8_t packed[BOARD_CONFIG_PACKED_MAX];
static bool outdated;

void setUp(void) {
    argus_config_default(&config);
    argus_config_default(&base);
}

static board_config_answer_t set(const char *key, const char *value) {
    return board_config_set(&config, (board_word_t){key, strlen(key)}, (board_word_t){value, strlen(value)});
}

static board_config_answer_t read_ini(const char *text, unsigned wanted_line) {
    unsigned line = 0;
    const board_config_answer_t answer = board_config_ini(&config, text, &line);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(wanted_line, line, text);
    return answer;
}

// Each key at its ends, and one step beyond.
void test_ranges_of_the_table(void) {
    char text[16];
#define CHECK(key, def, min, max, unit, choices, meaning)                        \
    if ((choices)[0] == '\0') {                                                  \
        snprintf(text, sizeof text, "%d", (int)(min));                           \
        TEST_ASSERT_EQUAL_MESSAGE(BOARD_CONFIG_TAKEN, set(#key, text), #key);    \
        TEST_ASSERT_EQUAL_INT32(min, config.key);                                \
        snprintf(text, sizeof text, "%d", (int)(max));                           \
        TEST_ASSERT_EQUAL_MESSAGE(BOARD_CONFIG_TAKEN, set(#key, text), #key);    \
        TEST_ASSERT_EQUAL_INT32(max, config.key);                                \
        snprintf(text, sizeof text, "%d", (int)(max) + 1);                       \
        TEST_ASSERT_EQUAL_MESSAGE(BOARD_CONFIG_NO_RANGE, set(#key, text), #key); \
        snprintf(text, sizeof text, "%d", (int)(min) - 1);                       \
        TEST_ASSERT_EQUAL_MESSAGE(BOARD_CONFIG_NO_RANGE, set(#key, text), #key); \
        TEST_ASSERT_EQUAL_INT32(max, config.key);                                \
    }
    ARGUS_CONFIG_TABLE(CHECK)
#undef CHECK
}

void test_every_answer_has_its_own_text(void) {
    TEST_ASSERT_EQUAL_STRING("taken", board_config_explain(BOARD_CONFIG_TAKEN));
    TEST_ASSERT_EQUAL_STRING("no such key", board_config_explain(BOARD_CONFIG_NO_KEY));
    TEST_ASSERT_EQUAL_STRING("out of its range", board_config_explain(BOARD_CONFIG_NO_RANGE));
    TEST_ASSERT_EQUAL_STRING("write key = value", board_config_explain(BOARD_CONFIG_NO_LINE));
    TEST_ASSERT_EQUAL_STRING("ok", board_config_fault_text(ARGUS_CONFIG_OK));
    TEST_ASSERT_EQUAL_STRING_LEN("S5: less step_mm", board_config_fault_text(ARGUS_CONFIG_STEP), 16);
}

void test_choices_by_name_and_by_nothing_else(void) {
    TEST_ASSERT_EQUAL(BOARD_CONFIG_TAKEN, set("profile", "paper"));
    TEST_ASSERT_EQUAL_INT32(ARGUS_PROFILE_PAPER, config.profile);
    TEST_ASSERT_EQUAL(BOARD_CONFIG_TAKEN, set("robot", "peoplebot-sh"));
    TEST_ASSERT_EQUAL_INT32(ARGUS_ROBOT_LAST, config.robot);
    static const char *const wrong[] = {"", "pape", "papers", "paper|argus", "0", "Paper", "|"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(BOARD_CONFIG_NO_VALUE, set("profile", wrong[i]), wrong[i]);
    }
}

// Its default is a word, and no number of its range.
void test_one_that_follows_the_robot(void) {
    argus_config_t back = base;
    TEST_ASSERT_EQUAL(BOARD_CONFIG_TAKEN, set("object_range_mm", "300"));
    TEST_ASSERT_EQUAL_INT32(300, config.object_range_mm);
    base = config; // compiled in
    TEST_ASSERT_EQUAL(BOARD_CONFIG_TAKEN, set("object_range_mm", "auto"));
    TEST_ASSERT_EQUAL_INT32(ARGUS_AUTO, config.object_range_mm);
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_RANGE, set("object_range_mm", "0"));
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_RANGE, set("object_range_mm", "149"));
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_VALUE, set("object_range_mm", "automatic"));
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_VALUE, set("step_mm", "auto"));
    const size_t count = board_config_pack(&base, &config, packed);
    TEST_ASSERT_EQUAL_size_t(count, board_config_unpack(&back, packed, count, &outdated));
    TEST_ASSERT_EQUAL_MEMORY(&config, &back, sizeof config);
}

void test_what_is_no_number(void) {
    static const char *const wrong[] = {"", "-", "+", "1.5", "1e3", "0x10", "12a", "a", "9999999999", "1 2"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(BOARD_CONFIG_NO_VALUE, set("step_mm", wrong[i]), wrong[i]);
    }
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_KEY, set("steps_mm", "100"));
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_KEY, set("", "100"));
    TEST_ASSERT_EQUAL_MEMORY(&base, &config, sizeof config);
}

void test_an_ini_text(void) {
    TEST_ASSERT_EQUAL(
        BOARD_CONFIG_TAKEN,
        read_ini("# a remark\r\n[argus]\n\n ; another\nstep_mm=100\n\tspeed_mm_s =  150 ; slow\n"
                 "profile = paper",
                 7));
    TEST_ASSERT_EQUAL_INT32(100, config.step_mm);
    TEST_ASSERT_EQUAL_INT32(150, config.speed_mm_s);
    TEST_ASSERT_EQUAL_INT32(ARGUS_PROFILE_PAPER, config.profile);
    TEST_ASSERT_EQUAL(BOARD_CONFIG_TAKEN, read_ini("", 0));
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_LINE, read_ini("\nstep_mm 100\n", 2));
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_LINE, read_ini("[other]\n", 1));
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_KEY, read_ini("step_mm = 100\nstep = 1\n", 2));
    TEST_ASSERT_EQUAL(BOARD_CONFIG_NO_RANGE, read_ini("step_mm = 100000\n", 1));
}

void test_only_what_differs_is_kept_and_comes_back(void) {
    argus_config_t back = base;
    TEST_ASSERT_EQUAL_size_t(2, board_config_pack(&base, &config, packed));
    set("step_mm", "120");
    set("policy", "fewest");
    const size_t count = board_config_pack(&base, &config, packed);
    TEST_ASSERT_EQUAL_size_t(18, count);
    TEST_ASSERT_EQUAL_size_t(count, board_config_unpack(&back, packed, count + 5, &outdated));
    TEST_ASSERT_EQUAL_MEMORY(&config, &back, sizeof config);
}

void test_a_packed_text_that_is_damaged_or_of_another_table(void) {
    argus_config_t back = base;
    set("step_mm", "120");
    const size_t count = board_config_pack(&base, &config, packed);
    for (size_t cut = 0; cut < count; cut++) {
        TEST_ASSERT_EQUAL_size_t(0, board_config_unpack(&back, packed, cut, &outdated));
        TEST_ASSERT_EQUAL_MEMORY(&base, &back, sizeof back);
    }
    packed[2] ^= 1; // a key that there is no more
    TEST_ASSERT_EQUAL_size_t(count, board_config_unpack(&back, packed, count, &outdated));
    TEST_ASSERT_EQUAL_MEMORY(&base, &back, sizeof back);
    packed[2] ^= 1;
    packed[9] = 0x7F; // out of its range
    TEST_ASSERT_EQUAL_size_t(count, board_config_unpack(&back, packed, count, &outdated));
    TEST_ASSERT_EQUAL_MEMORY(&base, &back, sizeof back);
}

void test_the_digest_tells_any_setting_apart(void) {
    const uint32_t digest = board_config_digest(&config);
    for (int row = 0; row < BOARD_CONFIG_COUNT; row++) {
        argus_config_t other = config;
        int32_t value = board_config_value(&other, row) + 1;
        memcpy((char *)&other + (size_t)row * sizeof value, &value, sizeof value);
        TEST_ASSERT_NOT_EQUAL_MESSAGE(digest, board_config_digest(&other), board_config_key(row));
    }
}

// ---- what is stored keeps its meaning

static int bars_in(const char *choices) {
    int bars = 0;
    for (; *choices != '\0'; choices++) {
        bars += *choices == '|';
    }
    return bars;
}

static board_word_t nth_choice(const char *choices, int n) {
    for (; n > 0; n--) {
        choices = strchr(choices, '|') + 1;
    }
    const char *end = strchr(choices, '|');
    return (board_word_t){choices, end != NULL ? (size_t)(end - choices) : strlen(choices)};
}

static const char *choices_of_row(int row) {
#define CHOICES_IN_A_ROW(key, def, min, max, unit, choices, meaning) choices,
    static const char *const all[] = {ARGUS_CONFIG_TABLE(CHOICES_IN_A_ROW)};
    return all[row];
}

// The pair of a record is made here by hand, from the words alone: whatever their places are in any table.
static uint32_t crc_of(uint32_t crc, const char *at, size_t size) {
    crc = ~crc;
    for (size_t i = 0; i < size; i++) {
        crc ^= (uint8_t)at[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320u : 0);
        }
    }
    return ~crc;
}

static void put_le(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(value >> 8 * i);
    }
}

static void pair_of(const char *key, bool picked, uint32_t meaning) {
    const uint32_t digest = crc_of(0, key, strlen(key));
    packed[0] = 1;
    packed[1] = 0;
    put_le(packed + 2, picked ? crc_of(digest, "=", 1) : digest);
    put_le(packed + 6, meaning);
}

void test_each_choice_is_stored_by_its_word(void) {
    for (int row = 0; row < BOARD_CONFIG_COUNT; row++) {
        const char *choices = choices_of_row(row);
        for (int n = 0; bars_in(choices) > 0 && n <= bars_in(choices); n++) {
            const board_word_t word = nth_choice(choices, n);
            argus_config_t back = base;
            uint8_t own[BOARD_CONFIG_PACKED_MAX];
            config = base;
            TEST_ASSERT_EQUAL(
                BOARD_CONFIG_TAKEN,
                board_config_set(&config,
                                 (board_word_t){board_config_key(row), strlen(board_config_key(row))}, word));
            pair_of(board_config_key(row), true, crc_of(0, word.at, word.length));
            const size_t count = board_config_pack(&base, &config, own);
            if (count > 2) { // else it is the default
                TEST_ASSERT_EQUAL_MEMORY_MESSAGE(packed, own, count, board_config_key(row));
            }
            TEST_ASSERT_EQUAL_size_t(10, board_config_unpack(&back, packed, 10, &outdated));
            TEST_ASSERT_FALSE(outdated);
            TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&config, &back, sizeof back, board_config_key(row));
        }
    }
}

// What older builds stored: the key, and the place of the word.
void test_the_place_of_a_word_is_outdated(void) {
    for (int row = 0; row < BOARD_CONFIG_COUNT; row++) {
        const bool picked = bars_in(choices_of_row(row)) > 0;
        for (uint32_t place = 0; place < 6; place++) {
            argus_config_t back = base;
            pair_of(board_config_key(row), false, place);
            TEST_ASSERT_EQUAL_size_t(10, board_config_unpack(&back, packed, 10, &outdated));
            TEST_ASSERT_EQUAL_MESSAGE(picked, outdated, board_config_key(row));
            if (picked) {
                TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&base, &back, sizeof back, board_config_key(row));
            }
        }
    }
}

// A good pair before it is not taken either: half of what was meant is something else.
void test_a_word_that_there_is_no_more_is_outdated(void) {
    argus_config_t back = base;
    set("step_mm", "120");
    const size_t count = board_config_pack(&base, &config, packed);
    uint8_t both[32];
    memcpy(both, packed, count);
    pair_of("robot", true, crc_of(0, "p2dx", 4));
    memcpy(both + count, packed + 2, 8);
    both[0] = 2;
    TEST_ASSERT_EQUAL_size_t(count + 8, board_config_unpack(&back, both, count + 8, &outdated));
    TEST_ASSERT_TRUE(outdated);
    TEST_ASSERT_EQUAL_MEMORY(&base, &back, sizeof back);
}
