// SPDX-License-Identifier: MIT
// Attacks: only the sonar that was named is altered, only for its time; every other byte passes as it came,
// and what is passed on is a whole packet with a right checksum.
#include "inject.h"

#include <stdlib.h>
#include <string.h>

#include "arcos/frame.h"
#include "arcos/sip.h"
#include "unity.h"

static inject_t inject;
static uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
static uint8_t out[4096];

void setUp(void) {
    inject_init(&inject, true, 1);
}

// A SIP that lists `count` sonars from 0 on, each at `mm` + its number; returns its length.
static size_t make_sip(uint8_t count, uint16_t mm) {
    uint8_t data[200] = {ARCOS_TYPE_SIP_STATIONARY};
    data[19] = count;
    for (uint8_t i = 0; i < count; i++) {
        const uint16_t value = (uint16_t)(mm + i);
        data[20 + 3 * i] = i;
        data[21 + 3 * i] = (uint8_t)(value & 0xFF);
        data[22 + 3 * i] = (uint8_t)(value >> 8);
    }
    memset(data + 20 + 3 * count, 0x5A, 12);
    return argus_frame_encode(packet, sizeof packet, data, 20 + 3u * count + 12);
}

static size_t pass(const uint8_t *bytes, size_t count, uint32_t now_ms) {
    const driver_filter_t filter = inject_filter(&inject);
    return filter.alter(filter.context, now_ms, bytes, count, out);
}

// What the manager's own parser makes of `count` bytes at out.
static bool decode(size_t count, argus_sip_t *sip) {
    argus_parser_t parser;
    argus_packet_t found;
    argus_parser_init(&parser);
    TEST_ASSERT_EQUAL_size_t(count, argus_parser_push(&parser, 0, out, count));
    return argus_parser_next(&parser, 0, &found) && argus_sip_decode(sip, &found) &&
           parser.bad_checksums == 0 && parser.skipped_bytes == 0;
}

static int reading(const argus_sip_t *sip, uint8_t number) {
    for (int i = 0; i < sip->sonar_count; i++) {
        if (sip->sonar[i].number == number) {
            return sip->sonar[i].range_mm;
        }
    }
    return -1;
}

static int read_after(uint16_t mm, uint8_t number) {
    argus_sip_t sip;
    const size_t length = make_sip(16, mm);
    TEST_ASSERT_TRUE(decode(pass(packet, length, 100), &sip));
    for (uint8_t i = 0; i < 16; i++) {
        if (i != number) {
            TEST_ASSERT_EQUAL_INT(mm + i, reading(&sip, i));
        }
    }
    TEST_ASSERT_TRUE(sip.has_battery_x10);
    return reading(&sip, number);
}

void test_each_kind_does_what_its_word_says(void) {
    inject_set(&inject, 3, ARGUS_KIND_OFF, 5000, 0);
    TEST_ASSERT_EQUAL_INT(5000, read_after(1000, 3));
    inject_set(&inject, 3, ARGUS_KIND_SILENT, 5000, 0);
    TEST_ASSERT_EQUAL_INT(-1, read_after(1000, 3));
    inject_set(&inject, 3, ARGUS_KIND_STUCK, 5000, 0);
    TEST_ASSERT_EQUAL_INT(1203, read_after(1200, 3));
    TEST_ASSERT_EQUAL_INT(1203, read_after(1900, 3));
    inject_set(&inject, 3, ARGUS_KIND_WRONG, 5000, 0);
    TEST_ASSERT_EQUAL_INT(1001, read_after(2000, 3));
    TEST_ASSERT_EQUAL_INT(100, read_after(120, 3));
    inject_set(&inject, 3, ARGUS_KIND_NONE, 0, 0);
    TEST_ASSERT_EQUAL_INT(1503, read_after(1500, 3));
}

void test_slow_is_five_firings_late(void) {
    inject_set(&inject, 0, ARGUS_KIND_SLOW, 5000, 0);
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_INT(1000, read_after((uint16_t)(1000 + 100 * i), 0));
    }
    TEST_ASSERT_EQUAL_INT(1000, read_after(1500, 0));
    TEST_ASSERT_EQUAL_INT(1100, read_after(1600, 0));
    TEST_ASSERT_EQUAL_INT(1200, read_after(1700, 0));
}

void test_garbage_and_gaps_are_by_chance(void) {
    int low = 0;
    int gaps = 0;
    inject_set(&inject, 7, ARGUS_KIND_GARBAGE, 5000, 0);
    for (int i = 0; i < 400; i++) {
        const int mm = read_after(1000, 7);
        TEST_ASSERT_TRUE(mm >= 100 && mm <= 5000);
        low += mm < 2550;
    }
    TEST_ASSERT_TRUE(low > 140 && low < 260);
    inject_set(&inject, 7, ARGUS_KIND_INTERMITTENT, 5000, 0);
    for (int i = 0; i < 400; i++) {
        const int mm = read_after(1000, 7);
        TEST_ASSERT_TRUE(mm == 1007 || mm == 5000);
        gaps += mm == 5000;
    }
    TEST_ASSERT_TRUE(gaps > 140 && gaps < 260);
}

void test_a_sip_that_lists_the_failing_one_alone_may_become_empty(void) {
    argus_sip_t sip;
    inject_set(&inject, 0, ARGUS_KIND_SILENT, 5000, 0);
    const size_t length = make_sip(1, 700);
    TEST_ASSERT_TRUE(decode(pass(packet, length, 0), &sip));
    TEST_ASSERT_EQUAL_INT(0, sip.sonar_count);
}

void test_every_fault_ends(void) {
    inject_change_t change;
    inject_set(&inject, 3, ARGUS_KIND_STUCK, 1000, UINT32_MAX - 500);
    inject_set(&inject, 5, ARGUS_KIND_OFF, 3000, UINT32_MAX - 500);
    TEST_ASSERT_TRUE(inject_change(&inject, &change));
    TEST_ASSERT_EQUAL_INT(3, change.sonar);
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_STUCK, change.kind);
    TEST_ASSERT_TRUE(inject_change(&inject, &change));
    inject_expire(&inject, false, 498);
    TEST_ASSERT_FALSE(inject_change(&inject, &change));
    inject_expire(&inject, false, 500); // the clock has gone round
    TEST_ASSERT_TRUE(inject_change(&inject, &change));
    TEST_ASSERT_EQUAL_INT(3, change.sonar);
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_NONE, change.kind);
    TEST_ASSERT_TRUE(inject_is_on(&inject));
    inject_expire(&inject, true, 501);
    TEST_ASSERT_FALSE(inject_is_on(&inject));
    TEST_ASSERT_TRUE(inject_change(&inject, &change));
    TEST_ASSERT_EQUAL_INT(5, change.sonar);
    TEST_ASSERT_FALSE(inject_change(&inject, &change));
}

// A verdict outlives the fault that it is about: nobody may take it for the sonar's own.
void test_a_mark_stays_until_the_sonar_is_in_use_again(void) {
    argus_status_t status = {0};
    inject_set(&inject, 3, ARGUS_KIND_SILENT, 3000, 1000);
    status.kind[3] = ARGUS_KIND_SILENT;
    inject_expire(&inject, false, 4000);
    TEST_ASSERT_FALSE(inject_is_on(&inject));
    inject_settle(&inject, &status, 90000);
    TEST_ASSERT_EQUAL_HEX32(1u << 3, inject_marked(&inject));
    TEST_ASSERT_EQUAL(ARGUS_KIND_SILENT, inject.of[3].mark);
    status.kind[3] = ARGUS_KIND_NONE;
    inject_settle(&inject, &status, 90000);
    TEST_ASSERT_EQUAL_HEX32(0, inject_marked(&inject));
}

// What was heard during the fault may name it shortly after its end.
void test_a_mark_stays_for_some_time_in_any_case(void) {
    const argus_status_t status = {0};
    inject_set(&inject, 3, ARGUS_KIND_OFF, 3000, 1000);
    inject_settle(&inject, &status, 3500);
    inject_expire(&inject, false, 4000);
    inject_settle(&inject, &status, 4000 + INJECT_SETTLE_MS - 1);
    TEST_ASSERT_EQUAL_HEX32(1u << 3, inject_marked(&inject));
    inject_settle(&inject, &status, 4000 + INJECT_SETTLE_MS);
    TEST_ASSERT_EQUAL_HEX32(0, inject_marked(&inject));
}

void test_nothing_is_armed_without_the_option(void) {
    inject_init(&inject, false, 1);
    TEST_ASSERT_NULL(inject_filter(&inject).alter);
}

void test_without_a_fault_bytes_pass_at_once(void) {
    const size_t length = make_sip(6, 900);
    TEST_ASSERT_EQUAL_size_t(10, pass(packet, 10, 0));
    TEST_ASSERT_EQUAL_MEMORY(packet, out, 10);
    TEST_ASSERT_EQUAL_size_t(length - 10, pass(packet + 10, length - 10, 0));
}

// In pieces of any size, with noise and damage between, with a sonar altered that no packet lists.
void test_what_is_not_altered_passes_byte_for_byte(void) {
    static uint8_t in[20000];
    static uint8_t got[24000];
    size_t length = 0;
    size_t used = 0;
    srand(7);
    while (length < 15000) {
        const size_t one = make_sip((uint8_t)(rand() % 8), (uint16_t)(rand() % 4000));
        if (rand() % 4 == 0) {
            packet[rand() % (int)one] ^= (uint8_t)(1 + rand() % 255);
        }
        memcpy(in + length, packet, one);
        length += one;
        for (int noise = rand() % 6; noise > 0; noise--) {
            in[length++] = (uint8_t)(rand() % 3 == 0 ? 0xFA : rand());
        }
    }
    inject_set(&inject, 15, ARGUS_KIND_OFF, 600000, 0);
    for (size_t at = 0; at < length;) {
        size_t piece = (size_t)(1 + rand() % 300);
        piece = piece > length - at ? length - at : piece;
        const size_t passed = pass(in + at, piece, 0);
        memcpy(got + used, out, passed);
        used += passed;
        at += piece;
    }
    const size_t rest = pass(NULL, 0, 1000);
    memcpy(got + used, out, rest);
    used += rest;
    TEST_ASSERT_EQUAL_size_t(length, used);
    TEST_ASSERT_EQUAL_MEMORY(in, got, length);
}

void test_what_stays_incomplete_is_not_held_back(void) {
    const size_t length = make_sip(6, 900);
    inject_set(&inject, 0, ARGUS_KIND_OFF, 5000, 0);
    TEST_ASSERT_EQUAL_size_t(0, pass(packet, length - 1, 100));
    TEST_ASSERT_EQUAL_size_t(0, pass(NULL, 0, 200));
    TEST_ASSERT_EQUAL_size_t(length - 1, pass(NULL, 0, 250));
    TEST_ASSERT_EQUAL_MEMORY(packet, out, length - 1);
}

void test_the_words_are_those_of_px4(void) {
    static const char *const words[] = {"ok",   "off",     "stuck",        "garbage", "wrong",
                                        "slow", "delayed", "intermittent", "silent"};
    argus_fault_kind_t kind = ARGUS_KIND_NONE;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(inject_kind(words[i], &kind), words[i]);
        TEST_ASSERT_EQUAL(i == 0, kind == ARGUS_KIND_NONE);
    }
    TEST_ASSERT_FALSE(inject_kind("OFF", &kind));
    TEST_ASSERT_FALSE(inject_kind("", &kind));
}
