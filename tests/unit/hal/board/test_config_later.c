// SPDX-License-Identifier: MIT
// Rule under attack: a stored setting keeps its meaning when a build has other choices before it. The code of
// the board is compiled once more here, as a build whose table has a choice more before all those of today.
#include "board/config.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

#define FIRST "aaa-first|"

// The choices of a later build, as it would read them in its table.
static const char *later_nth(const char *texts, int row) {
    static char longer[200];
    const char *text = board_word_nth(texts, row);
    if (strchr(text, '|') == NULL) {
        return text;
    }
    snprintf(longer, sizeof longer, FIRST "%s", text);
    return longer;
}

#define board_word_nth later_nth
#define board_config_key later_key
#define board_config_value later_value
#define board_config_set later_set
#define board_config_ini later_ini
#define board_config_explain later_explain
#define board_config_fault_text later_fault_text
#define board_config_digest later_digest
#define board_config_pack later_pack
#define board_config_length later_length
#define board_config_unpack later_unpack
#include "../../../../hal/board/config.c"
#undef board_word_nth
#undef board_config_key
#undef board_config_value
#undef board_config_set
#undef board_config_ini
#undef board_config_explain
#undef board_config_fault_text
#undef board_config_digest
#undef board_config_pack
#undef board_config_length
#undef board_config_unpack

// From config.h, whose names were the later build's while it was compiled.
const char *board_config_key(int row);
int32_t board_config_value(const argus_config_t *config, int row);
uint32_t board_config_digest(const argus_config_t *config);
size_t board_config_pack(const argus_config_t *base, const argus_config_t *config,
                         uint8_t bytes[BOARD_CONFIG_PACKED_MAX]);
size_t board_config_unpack(argus_config_t *config, const uint8_t *bytes, size_t count, bool *outdated);

static int choices_in(int row) {
    const char *at = board_word_nth(choices_of, row);
    int count = strchr(at, '|') != NULL ? 1 : 0;
    for (; *at != '\0'; at++) {
        count += *at == '|';
    }
    return count;
}

// Each setting that is picked by name, each of its choices: stored by today's build, read by the later one,
// it is the same word in another place. A number is the same number.
void test_a_choice_more_before_all_others_changes_no_stored_setting(void) {
    int picked = 0;
    for (int row = 0; row < BOARD_CONFIG_COUNT; row++) {
        const int choices = choices_in(row);
        for (int32_t place = 0; place < choices; place++) {
            argus_config_t base, config, back;
            uint8_t packed[BOARD_CONFIG_PACKED_MAX];
            bool outdated = false;
            argus_config_default(&base);
            put_value(&base, row, place == 0 ? 1 : 0); // another one, so that it is stored
            config = back = base;
            put_value(&config, row, place);
            const size_t count = board_config_pack(&base, &config, packed);
            TEST_ASSERT_EQUAL_size_t_MESSAGE(10, count, board_config_key(row));
            TEST_ASSERT_EQUAL_size_t(10, later_unpack(&back, packed, count, &outdated));
            TEST_ASSERT_FALSE_MESSAGE(outdated, board_config_key(row));
            TEST_ASSERT_EQUAL_INT32_MESSAGE(place + 1, board_config_value(&back, row), board_config_key(row));
            picked++;
        }
    }
    TEST_ASSERT_GREATER_OR_EQUAL(2 + 2 + 5 + 5 + 2, picked); // profile, diagnosis, policy, robot, active
}

void test_two_builds_with_the_same_words_have_the_same_digest(void) {
    argus_config_t config, later;
    argus_config_default(&config);
    argus_config_default(&later);
    for (int row = 0; row < BOARD_CONFIG_COUNT; row++) {
        if (choices_in(row) > 0) {
            put_value(&later, row, board_config_value(&config, row) + 1);
        }
    }
    TEST_ASSERT_EQUAL_HEX32(board_config_digest(&config), later_digest(&later));
    TEST_ASSERT_NOT_EQUAL(board_config_digest(&config), later_digest(&config));
}

// What today's build stored it reads itself, and the word that only the later one has it refuses.
void test_a_word_of_a_later_build_is_outdated(void) {
    argus_config_t base, config, back;
    uint8_t packed[BOARD_CONFIG_PACKED_MAX];
    bool outdated = false;
    argus_config_default(&base);
    config = back = base;
    put_value(&base, BOARD_CONFIG_robot, 1);
    const size_t count = later_pack(&base, &config, packed); // its first word
    TEST_ASSERT_EQUAL_size_t(10, board_config_unpack(&back, packed, count, &outdated));
    TEST_ASSERT_TRUE(outdated);
    TEST_ASSERT_EQUAL_MEMORY(&config, &back, sizeof back);
}
