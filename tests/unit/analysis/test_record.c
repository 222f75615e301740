// SPDX-License-Identifier: MIT
// Rule under attack: a record is taken whole or not at all; any bytes are survived; what it says of evidence
// convicts no one.
#include "analysis/record.h"

#include <stdlib.h>
#include <string.h>

#include "awareness/numbers.h"
#include "health.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_evidence_t e;
static argus_record_note_t note;
static uint8_t record[ARGUS_RECORD_BYTES + 10];

static size_t write_one(void) {
    argus_knowledge_init(&k);
    argus_evidence_init(&e);
    put_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_WRONG, 5);
    k.sonar[3].disabled_before = 7;
    put_health(&k.sonar[4], ARGUS_PROBATION, ARGUS_KIND_SLOW, 5);
    k.sonar[5].disabled_before = 65535;
    k.sonar[5].disabled_times = 9;
    k.sonar[5].relapses = 3;
    k.sonar[9].kind_before = ARGUS_KIND_SILENT;
    e.of[3].score[ARGUS_TEST_STUCK] = 2600;
    e.of[3].hypothesis[5].over_healthy = ARGUS_LATE_NAMING;
    e.of[6].score[ARGUS_TEST_DROPOUT] = 2200;
    e.of[7].score[ARGUS_TEST_PEERS] = -150;
    k.odometer_mm = 20000;
    k.sonar[6].named = true;
    k.sonar[6].missions_named = 2;
    k.sonar[7].named = true;
    k.sonar[7].missions_named = 255;
    k.sonar[2].missions_named = 4;
    return argus_record_encode(&k, &e, 0xDEADBEEFu, record, sizeof record);
}

static argus_knowledge_t other;
static argus_evidence_t found;

static argus_record_fault_t read_back(const uint8_t *bytes, size_t length) {
    argus_knowledge_init(&other);
    argus_evidence_init(&found);
    return argus_record_decode(&other, &found, &note, bytes, length);
}

void test_history_comes_back(void) {
    const size_t length = write_one();
    TEST_ASSERT_EQUAL(ARGUS_RECORD_BYTES, length);
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OK, read_back(record, length));
    TEST_ASSERT_EQUAL(8, other.sonar[3].disabled_before);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, other.sonar[3].kind_before);
    TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, other.sonar[4].kind_before);
    TEST_ASSERT_EQUAL(65535, other.sonar[5].disabled_before);
    TEST_ASSERT_EQUAL(3, other.sonar[5].relapses);
    TEST_ASSERT_EQUAL(ARGUS_KIND_SILENT, other.sonar[9].kind_before);
    TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, other.sonar[3].health); // history, not a verdict
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, other.sonar[3].kind);
    TEST_ASSERT_EQUAL_HEX16(1u << 3 | 1u << 4, note.out);
    TEST_ASSERT_EQUAL_HEX32(0xDEADBEEFu, note.robot);
}

void test_missions_in_which_it_was_named_are_counted_one_after_the_other(void) {
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OK, read_back(record, write_one()));
    TEST_ASSERT_EQUAL(3, other.sonar[6].missions_named);
    TEST_ASSERT_EQUAL(255, other.sonar[7].missions_named);
    TEST_ASSERT_EQUAL(0, other.sonar[2].missions_named); // not this time
    TEST_ASSERT_FALSE(other.sonar[6].named);
    k.odometer_mm = 9999; // too short a way to show anything
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OK,
                      read_back(record, argus_record_encode(&k, &e, 1, record, sizeof record)));
    TEST_ASSERT_EQUAL(4, other.sonar[2].missions_named);
    argus_record_forget(&other, &found);
    TEST_ASSERT_EQUAL(0, other.sonar[2].missions_named);
}

// Whatever the scores were: of one that was out a suspicion is left at most, of any other not even that.
void test_old_evidence_neither_names_nor_convicts(void) {
    for (int score = INT16_MIN; score <= INT16_MAX; score += 7) {
        write_one();
        for (int i = 0; i < ARGUS_SONARS; i++) {
            for (int test = 0; test < ARGUS_TESTS; test++) {
                e.of[i].score[test] = (int16_t)score;
            }
            e.of[i].hypothesis[3].over_healthy = (int16_t)score;
        }
        TEST_ASSERT_EQUAL(ARGUS_RECORD_OK,
                          read_back(record, argus_record_encode(&k, &e, 1, record, sizeof record)));
        for (int i = 0; i < ARGUS_SONARS; i++) {
            TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_names(&found, i));
            TEST_ASSERT_TRUE((note.out >> i & 1) != 0 || !argus_evidence_suspects(&found, i));
            TEST_ASSERT_TRUE(found.of[i].hypothesis[0].over_healthy >= 0);
        }
    }
    write_one();
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OK,
                      read_back(record, argus_record_encode(&k, &e, 1, record, sizeof record)));
    TEST_ASSERT_TRUE(argus_evidence_suspects(&found, 3));
}

// What was late may be of any lag.
void test_old_lateness_is_of_any_lag(void) {
    write_one();
    e.of[4].hypothesis[5].over_healthy = ARGUS_CEILING;
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OK,
                      read_back(record, argus_record_encode(&k, &e, 1, record, sizeof record)));
    for (int i = 0; i < ARGUS_LAGS; i++) {
        TEST_ASSERT_EQUAL(ARGUS_LATE_NAMING - 1, found.of[4].hypothesis[i].over_healthy);
        TEST_ASSERT_EQUAL(0, found.of[5].hypothesis[i].over_healthy);
    }
}

void test_a_mission_without_a_fault_makes_up_for_a_relapse(void) {
    write_one();
    put_health(&k.sonar[5], ARGUS_HEALTHY, ARGUS_KIND_NONE, 9);
    read_back(record, argus_record_encode(&k, &e, 1, record, sizeof record));
    TEST_ASSERT_EQUAL(3, other.sonar[5].relapses); // disabled in this mission
    k.sonar[5].disabled_times = 0;
    read_back(record, argus_record_encode(&k, &e, 1, record, sizeof record));
    TEST_ASSERT_EQUAL(2, other.sonar[5].relapses);
    k.sonar[5].relapses = 0;
    read_back(record, argus_record_encode(&k, &e, 1, record, sizeof record));
    TEST_ASSERT_EQUAL(0, other.sonar[5].relapses);
}

void test_forgetting_leaves_nothing(void) {
    argus_knowledge_t clean;
    argus_evidence_t empty;
    argus_knowledge_init(&clean);
    argus_evidence_init(&empty);
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OK, read_back(record, write_one()));
    argus_record_forget(&other, &found);
    TEST_ASSERT_EQUAL_MEMORY(&clean, &other, sizeof clean);
    TEST_ASSERT_EQUAL_MEMORY(&empty, &found, sizeof empty);
}

void test_identity_is_of_all_three_texts(void) {
    const uint32_t it = argus_record_robot("amigo", "Pioneer", "p3dx-sh");
    TEST_ASSERT_EQUAL_HEX32(it, argus_record_robot("amigo", "Pioneer", "p3dx-sh"));
    TEST_ASSERT_TRUE(it != argus_record_robot("amiga", "Pioneer", "p3dx-sh"));
    TEST_ASSERT_TRUE(it != argus_record_robot("amigo", "pioneer", "p3dx-sh"));
    TEST_ASSERT_TRUE(it != argus_record_robot("amigo", "Pioneer", "p3dx"));
    TEST_ASSERT_TRUE(it != argus_record_robot("amigoP", "ioneer", "p3dx-sh"));
    TEST_ASSERT_TRUE(argus_record_robot("", "", "") != 0);
}

void test_too_small_a_buffer_gives_nothing(void) {
    const size_t length = write_one();
    for (size_t capacity = 0; capacity < length; capacity++) {
        TEST_ASSERT_EQUAL(0, argus_record_encode(&k, &e, 1, record, capacity));
    }
    TEST_ASSERT_EQUAL(length, argus_record_encode(&k, &e, 1, record, length));
}

static void refused_untouched(const uint8_t *bytes, size_t length) {
    static argus_knowledge_t clean;
    static argus_evidence_t empty;
    argus_knowledge_init(&clean);
    argus_evidence_init(&empty);
    TEST_ASSERT_TRUE(read_back(bytes, length) != ARGUS_RECORD_OK);
    TEST_ASSERT_EQUAL_MEMORY(&clean, &other, sizeof clean);
    TEST_ASSERT_EQUAL_MEMORY(&empty, &found, sizeof empty);
    TEST_ASSERT_EQUAL_HEX16(0, note.out);
}

void test_every_damaged_bit_and_every_length_is_refused_untouched(void) {
    const size_t length = write_one();
    for (size_t bit = 0; bit < length * 8; bit++) {
        record[bit / 8] ^= (uint8_t)(1u << bit % 8);
        refused_untouched(record, length);
        record[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    for (size_t cut = 0; cut < length; cut++) {
        uint8_t *exact = malloc(cut + 1); // so that the sanitizer sees a read beyond it
        memcpy(exact, record, cut);
        refused_untouched(exact, cut);
        free(exact);
    }
    refused_untouched(record, length + 1);
}

// A record that is right but for what it holds: any content is taken without harm.
void test_any_content_is_survived(void) {
    uint32_t seed = 1;
    for (int round = 0; round < 2000; round++) {
        write_one();
        for (size_t i = 12; i < ARGUS_RECORD_BYTES - 2; i++) {
            seed = seed * 1664525u + 1013904223u;
            record[i] = (uint8_t)(seed >> 24);
        }
        unsigned crc = 0xFFFFu;
        for (size_t i = 0; i < ARGUS_RECORD_BYTES - 2; i++) {
            crc ^= (unsigned)record[i] << 8;
            for (int bit = 0; bit < 8; bit++) {
                crc = (crc & 0x8000u) != 0 ? (crc << 1 ^ 0x1021u) & 0xFFFFu : crc << 1 & 0xFFFFu;
            }
        }
        record[ARGUS_RECORD_BYTES - 2] = (uint8_t)(crc & 0xFFu);
        record[ARGUS_RECORD_BYTES - 1] = (uint8_t)(crc >> 8);
        TEST_ASSERT_EQUAL(ARGUS_RECORD_OK, read_back(record, ARGUS_RECORD_BYTES));
        for (int i = 0; i < ARGUS_SONARS; i++) {
            TEST_ASSERT_TRUE(other.sonar[i].kind_before <= ARGUS_KIND_INTERMITTENT);
        }
    }
}

void test_another_version_ring_or_set_of_tests_is_foreign(void) {
    static const int at[] = {4, 5, 10, 11};
    for (int i = 0; i < 4; i++) {
        const size_t length = write_one();
        record[at[i]]++;
        TEST_ASSERT_EQUAL(ARGUS_RECORD_FOREIGN, read_back(record, length));
    }
}

static void seal(uint8_t *of, size_t length) {
    unsigned crc = 0xFFFFu;
    for (size_t i = 0; i < length - 2; i++) {
        crc ^= (unsigned)of[i] << 8;
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc & 0x8000u) != 0 ? (crc << 1 ^ 0x1021u) & 0xFFFFu : crc << 1 & 0xFFFFu;
        }
    }
    of[length - 2] = (uint8_t)(crc & 0xFFu);
    of[length - 1] = (uint8_t)(crc >> 8);
}

// A build that manages more or fewer sonars reads those that both manage; of the others nothing is known.
void test_the_record_of_a_build_with_more_or_fewer_sonars_is_read(void) {
    for (int sonars = 0; sonars <= 40; sonars++) {
        static uint8_t of[12 + 43 * 40 + 2];
        const size_t length = 12 + 43 * (size_t)sonars + 2;
        const bool built = sonars % 8 == 0 && sonars > 0 && sonars <= 32;
        write_one();
        memcpy(of, record, 12);
        memset(of + 12, 0, sizeof of - 12);
        of[5] = (uint8_t)sonars;
        for (int i = 0; i < sonars; i++) {
            of[12 + 43 * i + 1] = ARGUS_KIND_WRONG;
            of[12 + 43 * i + 2] = (uint8_t)(i + 1);
        }
        seal(of, length);
        TEST_ASSERT_EQUAL(built ? ARGUS_RECORD_OK : ARGUS_RECORD_FOREIGN, read_back(of, length));
        for (int i = 0; i < ARGUS_SONARS; i++) {
            const bool known = built && i < sonars;
            TEST_ASSERT_EQUAL(known ? i + 1 : 0, other.sonar[i].disabled_before);
        }
        TEST_ASSERT_EQUAL(built ? ARGUS_RECORD_DAMAGED : ARGUS_RECORD_FOREIGN, read_back(of, length - 1));
    }
}

// Version 1 as it was written, sonar 3: disabled, wrong, 258 times.
void test_version_1_is_read_as_history(void) {
    static uint8_t old[72] = {'A', 'R', 'G', 'R', 1, 16};
    static const uint8_t sonar[] = {ARGUS_DISABLED, ARGUS_KIND_WRONG, 2, 1};
    memcpy(old + 6 + 3 * 4, sonar, sizeof sonar);
    old[70] = 0x0C;
    old[71] = 0x73;
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OK, read_back(old, sizeof old));
    TEST_ASSERT_EQUAL(258, other.sonar[3].disabled_before);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, other.sonar[3].kind_before);
    TEST_ASSERT_EQUAL_HEX16(0, note.out);
    TEST_ASSERT_EQUAL_HEX32(0, note.robot);
    for (size_t cut = 0; cut < sizeof old; cut++) {
        refused_untouched(old, cut);
    }
    old[20]++;
    refused_untouched(old, sizeof old);
}

// 0 is no robot's: one whose texts give it has another.
void test_no_robot_has_the_number_of_none(void) {
    TEST_ASSERT_EQUAL_UINT32(1, argus_record_robot("BZLV6R0", "Pioneer", "p3dx-sh"));
}

// Each reason by itself keeps the relapse: it had none, it was out in this mission, it is not healthy now.
void test_only_a_healthy_mission_makes_up_for_a_relapse(void) {
    static const struct {
        uint8_t relapses;
        uint16_t disabled_times;
        argus_health_t health;
        uint8_t left;
    } rows[] = {{0, 0, ARGUS_HEALTHY, 0}, {2, 0, ARGUS_HEALTHY, 1}, {2, 1, ARGUS_HEALTHY, 2},
                {2, 0, ARGUS_UNKNOWN, 2}, {2, 0, ARGUS_SUSPECT, 2}, {2, 0, ARGUS_PROBATION, 2}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        argus_knowledge_init(&k);
        argus_evidence_init(&e);
        put_health(&k.sonar[1], rows[i].health, ARGUS_KIND_WRONG, 0);
        k.sonar[1].relapses = rows[i].relapses;
        k.sonar[1].disabled_times = rows[i].disabled_times;
        const size_t length = argus_record_encode(&k, &e, 7, record, sizeof record);
        TEST_ASSERT_EQUAL(ARGUS_RECORD_OK, read_back(record, length));
        TEST_ASSERT_EQUAL(rows[i].left, other.sonar[1].relapses);
    }
}
