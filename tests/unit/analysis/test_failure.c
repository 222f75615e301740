// SPDX-License-Identifier: MIT
// Rule under attack: the failure state of every fault map (paper: Fig. 6), whatever the other sonars do.
#include "analysis/failure.h"
#include "knowledge/angle.h"

#include "unity.h"

void test_all_64_maps(void) {
    for (unsigned map = 0; map < 64; map++) {
        int count = 0;
        for (unsigned bit = 0; bit < 6; bit++) {
            count += map >> bit & 1u;
        }
        const argus_failure_t wanted = count == 0   ? ARGUS_IS_NORMAL
                                       : count <= 2 ? ARGUS_IS_MINOR
                                       : count <= 5 ? ARGUS_IS_MAJOR
                                                    : ARGUS_IS_CATASTROPHIC;
        TEST_ASSERT_EQUAL(wanted, argus_failure_of(argus_robot_default(), (uint16_t)(map << 1)));
        TEST_ASSERT_EQUAL(wanted,
                          argus_failure_of(argus_robot_default(),
                                           (uint16_t)(map << 1 | 0xFF81u))); // 0, 7 and the rear do not count
        TEST_ASSERT_EQUAL(count, argus_count_bits((uint16_t)(map << 1)));
    }
}

void test_names(void) {
    TEST_ASSERT_EQUAL_STRING("IsNormal", argus_name(ARGUS_NAME_FAILURE, ARGUS_IS_NORMAL));
    TEST_ASSERT_EQUAL_STRING("IsMinor", argus_name(ARGUS_NAME_FAILURE, ARGUS_IS_MINOR));
    TEST_ASSERT_EQUAL_STRING("IsMajor", argus_name(ARGUS_NAME_FAILURE, ARGUS_IS_MAJOR));
    TEST_ASSERT_EQUAL_STRING("IsCatastrophic", argus_name(ARGUS_NAME_FAILURE, ARGUS_IS_CATASTROPHIC));
    TEST_ASSERT_EQUAL_STRING("?", argus_name(ARGUS_NAME_FAILURE, (int)4));
}

void test_of_four_forward_sonars_one_is_minor_and_four_are_catastrophic(void) {
    static const argus_failure_t wanted[] = {ARGUS_IS_NORMAL, ARGUS_IS_MINOR, ARGUS_IS_MAJOR, ARGUS_IS_MAJOR,
                                             ARGUS_IS_CATASTROPHIC};
    const argus_robot_t *amigo = argus_robot_find("amigo-sh");
    for (unsigned map = 0; map < 16; map++) {
        TEST_ASSERT_EQUAL(wanted[argus_count_bits(map)], argus_failure_of(amigo, (argus_mask_t)(map << 1)));
        TEST_ASSERT_EQUAL(wanted[argus_count_bits(map)],
                          argus_failure_of(amigo, (argus_mask_t)(map << 1 | 0xE1)));
    }
}
