// SPDX-License-Identifier: MIT
// Rule under attack: a record is taken whole or not at all; any bytes are survived.
#include "argus/record.h"

#include <stdlib.h>
#include <string.h>

#include "unity.h"

static argus_knowledge_t k;
static uint8_t record[200];

static size_t write_one(void) {
    argus_knowledge_init(&k);
    argus_sonar_set_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_WRONG, 5);
    k.sonar[3].disabled_before = 7;
    k.sonar[5].disabled_before = 65535;
    k.sonar[5].disabled_times = 9;
    k.sonar[9].kind_before = ARGUS_KIND_SILENT;
    return argus_record_encode(&k, record, sizeof record);
}

void test_history_comes_back(void) {
    const size_t length = write_one();
    argus_knowledge_t other;
    argus_knowledge_init(&other);
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OK, argus_record_decode(&other, record, length));
    TEST_ASSERT_EQUAL(8, other.sonar[3].disabled_before);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, other.sonar[3].kind_before);
    TEST_ASSERT_EQUAL(65535, other.sonar[5].disabled_before);
    TEST_ASSERT_EQUAL(ARGUS_KIND_SILENT, other.sonar[9].kind_before);
    TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, other.sonar[3].health); // history, not a verdict
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, other.sonar[3].kind);
}

void test_too_small_a_buffer_gives_nothing(void) {
    const size_t length = write_one();
    for (size_t capacity = 0; capacity < length; capacity++) {
        TEST_ASSERT_EQUAL(0, argus_record_encode(&k, record, capacity));
    }
    TEST_ASSERT_EQUAL(length, argus_record_encode(&k, record, length));
}

void test_every_damaged_bit_and_every_length_is_refused_untouched(void) {
    const size_t length = write_one();
    argus_knowledge_t clean, other;
    argus_knowledge_init(&clean);
    other = clean;
    for (size_t bit = 0; bit < length * 8; bit++) {
        record[bit / 8] ^= (uint8_t)(1u << bit % 8);
        TEST_ASSERT_TRUE(argus_record_decode(&other, record, length) != ARGUS_RECORD_OK);
        record[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    for (size_t cut = 0; cut < length; cut++) {
        uint8_t *exact = malloc(cut + 1); // so that the sanitizer sees a read beyond it
        memcpy(exact, record, cut);
        TEST_ASSERT_TRUE(argus_record_decode(&other, exact, cut) != ARGUS_RECORD_OK);
        free(exact);
    }
    TEST_ASSERT_TRUE(argus_record_decode(&other, record, length + 1) != ARGUS_RECORD_OK);
    TEST_ASSERT_EQUAL_MEMORY(&clean, &other, sizeof clean);
}

void test_another_version_is_foreign(void) {
    const size_t length = write_one();
    record[4]++;
    TEST_ASSERT_EQUAL(ARGUS_RECORD_FOREIGN, argus_record_decode(&k, record, length));
}
