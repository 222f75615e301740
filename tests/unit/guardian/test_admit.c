// SPDX-License-Identifier: MIT
// Attacks: nothing passes that is not on the list, nothing that undoes what the bounds count on is on it, and
// no number out of range is read as another one.
#include "guardian/admit.h"

#include <string.h>

#include "unity.h"

static argus_said_t said;

static bool admit(const uint8_t *data, uint8_t count) {
    const argus_packet_t packet = {.data = data, .count = count};
    return argus_admit(&packet, &said);
}

static bool admit_int(uint8_t command, uint8_t type, unsigned magnitude) {
    const uint8_t data[] = {command, type, (uint8_t)(magnitude & 0xFF), (uint8_t)(magnitude >> 8)};
    return admit(data, sizeof data);
}

void test_what_undoes_the_bounds_is_not_on_the_list(void) {
    static const uint8_t refused[] = {
        ARCOS_CMD_POLLING,     ARCOS_CMD_SONAR_CYCLE,  ARCOS_CMD_HOSTBAUD,    ARCOS_CMD_MAINTENANCE,
        ARCOS_CMD_LATVEL,      ARCOS_CMD_LATACCEL,     ARCOS_CMD_TICKSMM,     ARCOS_CMD_REVCOUNT,
        ARCOS_CMD_DRIFTFACTOR, ARCOS_CMD_ROTKP,        ARCOS_CMD_ROTKV,       ARCOS_CMD_ROTKI,
        ARCOS_CMD_TRANSKP,     ARCOS_CMD_TRANSKV,      ARCOS_CMD_TRANSKI,     ARCOS_CMD_JOYDRIVE,
        ARCOS_CMD_BUMPSTALL,   ARCOS_CMD_E_STALL,      ARCOS_CMD_SETRVDIR,    ARCOS_CMD_GYROCALCW,
        ARCOS_CMD_GYROCALCCW,  ARCOS_CMD_KICK,         ARCOS_CMD_POWER_FIRST, ARCOS_CMD_POWER2_LAST,
        ARCOS_CMD_BATTEST,     ARCOS_CMD_SIM_SET_POSE, ARCOS_CMD_SIM_RESET,   ARCOS_CMD_RECENTERWHEELS,
        ARCOS_CMD_LX_FIRST,    ARCOS_CMD_LX2_LAST,     ARCOS_CMD_CHARGE,      ARCOS_CMD_SIM_EXIT};
    for (size_t i = 0; i < sizeof refused; i++) {
        TEST_ASSERT_FALSE_MESSAGE(admit_int(refused[i], ARCOS_ARG_POSITIVE, 1), "it is let pass");
        TEST_ASSERT_EQUAL_UINT8(ARGUS_TOPIC_REFUSED, said.topic);
        TEST_ASSERT_EQUAL_UINT8(refused[i], said.command);
    }
}

// Of commands that have no name either.
void test_each_row_is_met_once_and_no_more(void) {
    int admitted = 0;
    int rows = 0;
    uint8_t seen[256] = {0};
#define ROW(first, last, topic, form, answer, meaning)                                  \
    for (int command = ARCOS_CMD_##first; command <= ARCOS_CMD_##last; command++) {     \
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(0, seen[command], #first " is in another row"); \
        seen[command] = 1;                                                              \
        rows++;                                                                         \
    }
    ARGUS_CLIENT_TABLE(ROW)
#undef ROW
    for (int command = 0; command < 256; command++) {
        const uint8_t plain[] = {(uint8_t)command};
        TEST_ASSERT_EQUAL_INT(seen[command], admit(plain, 1));
        admitted += seen[command];
    }
    TEST_ASSERT_EQUAL_INT(rows, admitted);
}

void test_a_number_is_read_as_the_robot_reads_it_or_refused(void) {
    for (unsigned magnitude = 0; magnitude <= 0xFFFF; magnitude++) {
        const bool in_range = magnitude <= 32767;
        TEST_ASSERT_EQUAL_INT(in_range, admit_int(ARCOS_CMD_RVEL, ARCOS_ARG_POSITIVE, magnitude));
        TEST_ASSERT_EQUAL_INT32(in_range ? (int32_t)magnitude : said.argument, said.argument);
        TEST_ASSERT_EQUAL_INT(in_range, admit_int(ARCOS_CMD_HEAD, ARCOS_ARG_NEGATIVE, magnitude));
        TEST_ASSERT_EQUAL_INT32(in_range ? -(int32_t)magnitude : said.argument, said.argument);
        TEST_ASSERT_TRUE(admit_int(ARCOS_CMD_VEL2, ARCOS_ARG_POSITIVE, magnitude));
    }
}

void test_a_type_that_is_none_of_a_number(void) {
    for (int type = 0; type < 256; type++) {
        const bool right = type == ARCOS_ARG_POSITIVE || type == ARCOS_ARG_NEGATIVE;
        TEST_ASSERT_EQUAL_INT(right, admit_int(ARCOS_CMD_VEL, (uint8_t)type, 100));
    }
    static const uint8_t more[] = {ARCOS_CMD_MOVE, ARCOS_ARG_POSITIVE, 1, 0, 0};
    TEST_ASSERT_FALSE(admit(more, sizeof more));
}

void test_a_string_is_as_long_as_it_tells(void) {
    static const uint8_t right[] = {ARCOS_CMD_TTY2, ARCOS_ARG_STRING, 2, 'a', 'b'};
    static const uint8_t ended[] = {ARCOS_CMD_TTY2, ARCOS_ARG_STRING, 2, 'a', 'b', 0};
    static const uint8_t cut[] = {ARCOS_CMD_TTY2, ARCOS_ARG_STRING, 3, 'a', 'b'};
    TEST_ASSERT_TRUE(admit(right, sizeof right));
    TEST_ASSERT_TRUE(admit(ended, sizeof ended));
    TEST_ASSERT_FALSE(admit(cut, sizeof cut));
}

void test_a_number_is_no_string(void) {
    static const uint8_t bare[] = {ARCOS_CMD_TTY2};
    TEST_ASSERT_FALSE(admit_int(ARCOS_CMD_TTY2, ARCOS_ARG_POSITIVE, 0));
    TEST_ASSERT_FALSE(admit_int(ARCOS_CMD_TTY2, ARCOS_ARG_NEGATIVE, 1));
    TEST_ASSERT_TRUE(admit(bare, sizeof bare));
}
