// SPDX-License-Identifier: MIT
// Rule under attack: an intact packet is never lost and none is invented, whatever surrounds it and however
// it arrives, and a false COUNT delays the next SIP by at most one.
#include "arcos/frame.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "captures.h"
#include "unity.h"

#define BYTE_TICKS 25 // at 9600 baud a byte takes 25/24 ms
#define TICKS_PER_MS 24

static captures_t sips;
static char message[200];

// What came out of a parser, copied at once because a packet is valid until the next call only.
typedef struct {
    captures_t got;
    uint32_t at_ms[CAPTURES_PACKETS_MAX];
} sink_t;

static sink_t sink;

static void rebuild(uint8_t *frame, const argus_packet_t *packet) {
    const uint16_t checksum = argus_frame_checksum(packet->data, packet->count);
    frame[0] = 0xFA;
    frame[1] = 0xFB;
    frame[2] = (uint8_t)(packet->count + 2);
    memcpy(frame + 3, packet->data, packet->count);
    frame[3 + packet->count] = (uint8_t)(checksum >> 8);
    frame[4 + packet->count] = (uint8_t)checksum;
}

static void fetch_all(argus_parser_t *parser, uint32_t now_ms) {
    argus_packet_t packet;
    uint8_t frame[ARGUS_FRAME_TOTAL_MAX];
    while (argus_parser_next(parser, now_ms, &packet)) {
        sink.at_ms[sink.got.packets] = now_ms;
        rebuild(frame, &packet);
        captures_add(&sink.got, frame, packet.count + (size_t)5);
    }
}

static void feed(argus_parser_t *parser, uint32_t now_ms, const uint8_t *bytes, size_t count) {
    while (count > 0) {
        const size_t taken = argus_parser_push(parser, now_ms, bytes, count);
        const uint32_t before = parser->packets;
        fetch_all(parser, now_ms);
        TEST_ASSERT_TRUE_MESSAGE(taken > 0 || parser->packets > before,
                                 "the loop of the header does not progress");
        TEST_ASSERT_TRUE_MESSAGE(taken <= count, "took more than it was given");
        bytes += taken;
        count -= taken;
    }
}

typedef enum { WHOLE, BYTEWISE, CHUNKS, MODES } feed_mode_t;

static void feed_as(argus_parser_t *parser, const captures_t *stream, feed_mode_t mode, random_t *random) {
    for (size_t at = 0; at < stream->length;) {
        const size_t left = stream->length - at;
        size_t size = mode == WHOLE ? left : mode == BYTEWISE ? 1 : 1 + random_below(random, 300);
        size = size < left ? size : left;
        feed(parser, (uint32_t)at, stream->bytes + at, size);
        at += size;
    }
}

static void start(argus_parser_t *parser) {
    argus_parser_init(parser);
    memset(&sink.got, 0, sizeof sink.got);
}

void setUp(void) {
    if (sips.packets == 0) {
        captures_load_sips(&sips);
    }
}

static size_t sip_with(uint8_t *packet, unsigned readings, uint8_t seed) {
    uint8_t data[256] = {0x33, seed, 1, 2, 3, 4, 5, 6, 7, 8, 9, 128, 0, 0, 0, 0, 7, 0, 0, (uint8_t)readings};
    size_t count = 20;
    for (unsigned i = 0; i < readings; i++) {
        data[count++] = (uint8_t)i;
        data[count++] = (uint8_t)(seed * 7 + i * 31);
        data[count++] = (uint8_t)(i % 20);
    }
    memset(data + count, 0, 12);
    return argus_frame_encode(packet, ARGUS_FRAME_TOTAL_MAX, data, count + 12);
}

// ------------------------------------------------------------------------------------------------ golden
// bytes

static const char *const golden[] = {
    "FA FB 03 00 00 00",
    "FA FB 03 01 00 01",
    "FA FB 03 02 00 02",
    "FA FB 06 01 3B 01 00 02 3B",
    "FA FB 06 05 1B 2C 01 31 1C",
    "FA FB 04 07 3B 07 3B",
    "FA FB 06 20 1B FD 04 1D 1F",
    "FA FB 06 1E 1B 19 09 37 24",
    "FA FB 0D 03 2B 08 01 02 03 04 05 06 07 08 17 33",
    "FA FB 0E 03 2B 08 01 02 03 04 05 06 07 08 00 1F 3B",
    "FA FB 10 E0 00 E8 03 00 00 30 F8 FF FF 5A 00 00 00 52 FA",
    "FA FB 1D 02 50 33 44 58 5F 30 30 30 31 00 50 69 6F 6E 65 65 72 00 70 33 64 78 2D 73 68 00 4B 53",
    "FA FB 28 32 00 00 00 00 00 00 00 00 00 00 80 00 00 00 00 06 00 00 02 00 88 13 08 D2 04 00 00 00 FF 00 "
    "80 00 00 00 "
    "00 00 00 1F 95",
    "FA FB 34 33 DC 05 06 FF 00 04 2C 01 2C 01 7F 00 00 00 00 07 00 00 06 02 2C 03 03 16 03 0A 88 13 0B 88 "
    "13 04 25 03 "
    "0C 88 13 00 00 00 FF 00 7F 00 00 00 00 00 00 97 59"};

void test_golden_packets_encode_to_their_bytes_and_are_accepted(void) {
    for (size_t i = 0; i < sizeof golden / sizeof golden[0]; i++) {
        uint8_t wire[ARGUS_FRAME_TOTAL_MAX];
        uint8_t made[ARGUS_FRAME_TOTAL_MAX];
        argus_parser_t parser;
        const size_t total = captures_hex(golden[i], wire, sizeof wire);
        TEST_ASSERT_EQUAL_MESSAGE(total, argus_frame_encode(made, sizeof made, wire + 3, total - 5),
                                  golden[i]);
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(wire, made, total, golden[i]);
        start(&parser);
        feed(&parser, 0, wire, total);
        TEST_ASSERT_EQUAL_MESSAGE(1, sink.got.packets, golden[i]);
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(wire, sink.got.bytes, total, golden[i]);
    }
}

void test_encode_refuses_what_is_empty_too_long_or_does_not_fit(void) {
    uint8_t data[300] = {1};
    uint8_t packet[300];
    TEST_ASSERT_EQUAL(0, argus_frame_encode(packet, sizeof packet, data, 0));
    TEST_ASSERT_EQUAL(200, argus_frame_encode(packet, sizeof packet, data, 195));
    TEST_ASSERT_EQUAL(0, argus_frame_encode(packet, sizeof packet, data, 196));
    TEST_ASSERT_EQUAL(0, argus_frame_encode(packet, sizeof packet, data, SIZE_MAX));
    TEST_ASSERT_EQUAL(0, argus_frame_encode(packet, 14, data, 10));
    TEST_ASSERT_EQUAL(15, argus_frame_encode(packet, 15, data, 10));
}

void test_packets_of_every_length_come_through(void) {
    for (size_t count = 1; count <= 253; count++) {
        uint8_t frame[ARGUS_FRAME_TOTAL_MAX];
        uint8_t data[253];
        argus_parser_t parser;
        const argus_packet_t packet = {data, (uint8_t)count};
        for (size_t i = 0; i < count; i++) {
            data[i] = (uint8_t)(0xB0 + i * 37);
        }
        rebuild(frame, &packet);
        for (int bytewise = 0; bytewise < 2; bytewise++) {
            start(&parser);
            for (size_t i = 0; i < count + 5; i += bytewise ? 1 : count + 5) {
                feed(&parser, 0, frame + i, bytewise ? 1 : count + 5);
            }
            TEST_ASSERT_EQUAL(1, sink.got.packets);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(frame, sink.got.bytes, count + 5);
            TEST_ASSERT_EQUAL(0, parser.skipped_bytes);
        }
    }
}

void test_recorded_streams_come_through_packet_by_packet(void) {
    static captures_t stream;
    random_t random = random_seed(1);
    for (size_t i = 0; i < captures_count; i++) {
        memset(&stream, 0, sizeof stream);
        captures_load(&stream, captures_names[i], "r2c");
        for (int mode = WHOLE; mode < MODES; mode++) {
            argus_parser_t parser;
            start(&parser);
            feed_as(&parser, &stream, (feed_mode_t)mode, &random);
            TEST_ASSERT_EQUAL_MESSAGE(stream.packets, sink.got.packets, captures_names[i]);
            TEST_ASSERT_EQUAL_MESSAGE(0, parser.bad_checksums + parser.skipped_bytes, captures_names[i]);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(stream.bytes, sink.got.bytes, stream.length);
        }
    }
}

// Into the client's side of p10_badck one packet with a bad checksum and 20 bytes of junk were put, between 7
// good ones.
void test_junk_and_a_bad_checksum_cost_nothing_else(void) {
    static captures_t stream;
    random_t random = random_seed(2);
    captures_load_bytes(&stream, "p10_badck", "c2r");
    for (int mode = WHOLE; mode < MODES; mode++) {
        argus_parser_t parser;
        start(&parser);
        feed_as(&parser, &stream, (feed_mode_t)mode, &random);
        fetch_all(&parser, 100000);
        TEST_ASSERT_EQUAL(7, sink.got.packets);
        TEST_ASSERT_EQUAL(1, parser.bad_checksums);
        TEST_ASSERT_EQUAL(9 + 12, parser.skipped_bytes);
    }
}

// ------------------------------------------------------------------------------------------------ damage

typedef enum { FLIP, LENGTH, DELETE, STRAY_FA, STRAY_FA_FB, DAMAGES } damage_t;
static const char *const damage_names[] = {"any byte flipped", "wrong length byte", "a byte deleted",
                                           "stray FA before", "stray FA FB before"};

static captures_t damaged;
static captures_t intact;

static void add_damaged(damage_t damage, const uint8_t *packet, size_t total, random_t *random) {
    uint8_t copy[ARGUS_FRAME_TOTAL_MAX];
    const uint8_t stray[] = {0xFA, 0xFB};
    const size_t at = damage == LENGTH ? 2 : random_below(random, (uint32_t)total);
    memcpy(copy, packet, total);
    if (damage == STRAY_FA || damage == STRAY_FA_FB) {
        captures_add(&damaged, stray, damage == STRAY_FA ? 1 : 2);
        captures_add(&intact, packet, total);
    } else if (damage == DELETE) {
        memmove(copy + at, copy + at + 1, total - at - 1);
        total--;
    } else {
        copy[at] = (uint8_t)(copy[at] ^ (1 + random_below(random, 255)));
    }
    captures_add(&damaged, copy, total);
}

static void damage_every_tenth(damage_t damage, size_t phase, random_t *random) {
    memset(&damaged, 0, sizeof damaged);
    memset(&intact, 0, sizeof intact);
    for (size_t i = 0; i < sips.packets; i++) {
        const uint8_t *packet = sips.bytes + sips.at[i];
        if (i % 10 == phase) {
            add_damaged(damage, packet, sips.total[i], random);
        } else {
            captures_add(&damaged, packet, sips.total[i]);
            captures_add(&intact, packet, sips.total[i]);
        }
    }
}

static bool same_packet(const captures_t *a, size_t i, const captures_t *b, size_t j) {
    return a->total[i] == b->total[j] && memcmp(a->bytes + a->at[i], b->bytes + b->at[j], a->total[i]) == 0;
}

// In order: each accepted packet is matched with the next intact one equal to it, at most 20 further on.
static void compare(size_t *lost, size_t *bogus) {
    size_t next = 0;
    size_t matched = 0;
    *bogus = 0;
    for (size_t i = 0; i < sink.got.packets; i++) {
        size_t j = next;
        while (j < intact.packets && j < next + 20 && !same_packet(&sink.got, i, &intact, j)) {
            j++;
        }
        if (j < intact.packets && j < next + 20) {
            next = j + 1;
            matched++;
        } else {
            (*bogus)++;
        }
    }
    *lost = intact.packets - matched;
}

void test_damage_loses_no_intact_packet_and_invents_none(void) {
    TEST_ASSERT_TRUE_MESSAGE(sips.packets > 1400, "the recorded SIPs are missing");
    size_t total_lost[DAMAGES] = {0};
    size_t total_bogus[DAMAGES] = {0};
    for (size_t run = 0; run < DAMAGES * 10 * MODES; run++) {
        const damage_t damage = (damage_t)(run % DAMAGES);
        const uint64_t seed = 1000 + run / MODES / DAMAGES;
        random_t random = random_seed(seed);
        argus_parser_t parser;
        size_t lost = 0;
        size_t bogus = 0;
        damage_every_tenth(damage, seed % 10, &random);
        start(&parser);
        feed_as(&parser, &damaged, (feed_mode_t)(run / DAMAGES % MODES), &random);
        compare(&lost, &bogus);
        total_lost[damage] += lost;
        total_bogus[damage] += bogus;
        const size_t limit = damage == LENGTH ? 1 : 0;
        snprintf(message, sizeof message, "%s: lost %zu, bogus %zu (run %zu, seed %llu)",
                 damage_names[damage], lost, bogus, run, (unsigned long long)seed);
        TEST_ASSERT_TRUE_MESSAGE(lost <= limit && bogus <= limit, message);
    }
    for (int i = 0; i < DAMAGES; i++) {
        printf("  %-20s lost %zu / bogus %zu in %zu hits\n", damage_names[i], total_lost[i], total_bogus[i],
               sips.packets * MODES);
    }
}

// Sensitivity of the judge itself: it must see a packet lost and a packet invented.
void test_the_judge_of_damage_sees_losses_and_inventions(void) {
    random_t random = random_seed(7);
    argus_parser_t parser;
    size_t lost = 0;
    size_t bogus = 0;
    damage_every_tenth(STRAY_FA, 3, &random);
    start(&parser);
    feed(&parser, 0, damaged.bytes + damaged.at[5], damaged.length - damaged.at[5]);
    compare(&lost, &bogus);
    TEST_ASSERT_GREATER_THAN(0, lost);
    sink.got.bytes[sink.got.at[40] + 10] ^= 1;
    compare(&lost, &bogus);
    TEST_ASSERT_EQUAL(1, bogus);
}

void test_every_single_flip_of_a_sip_spares_its_neighbours(void) {
    for (unsigned readings = 0; readings <= 6; readings += 2) {
        uint8_t packet[3][ARGUS_FRAME_TOTAL_MAX];
        const size_t total = sip_with(packet[0], readings, 1);
        sip_with(packet[1], readings, 2);
        sip_with(packet[2], readings, 3);
        for (size_t at = 0; at < total; at++) {
            for (unsigned flip = 1; flip < 256; flip++) {
                argus_parser_t parser;
                packet[1][at] ^= (uint8_t)flip;
                start(&parser);
                for (int i = 0; i < 4; i++) {
                    feed(&parser, 0, packet[i % 3], total);
                }
                packet[1][at] ^= (uint8_t)flip;
                snprintf(message, sizeof message, "readings %u byte %zu flip 0x%02X", readings, at, flip);
                TEST_ASSERT_EQUAL_MESSAGE(3, sink.got.packets, message);
            }
        }
    }
}

// ------------------------------------------------------------------------------------------------ time

// Sends `count` bytes at 9600 baud from `start_ms`; the reader wakes every `wake_ms` and takes what has
// arrived.
static uint32_t send_timed(argus_parser_t *parser, uint32_t start_ms, const uint8_t *bytes, size_t count,
                           uint32_t wake_ms) {
    size_t given = 0;
    uint32_t now_ms = start_ms;
    while (given < count) {
        size_t arrived = (size_t)(now_ms - start_ms) * TICKS_PER_MS / BYTE_TICKS;
        arrived = arrived < count ? arrived : count;
        feed(parser, now_ms, bytes + given, arrived - given);
        fetch_all(parser, now_ms);
        given = arrived;
        now_ms += given < count ? wake_ms : 0;
    }
    return now_ms;
}

static void idle_until(argus_parser_t *parser, uint32_t from_ms, uint32_t until_ms, uint32_t wake_ms) {
    for (uint32_t now = from_ms; (int32_t)(until_ms - now) > 0; now += wake_ms) {
        fetch_all(parser, now);
    }
}

static bool accepted_at(const uint8_t *packet, size_t total, uint32_t at_ms) {
    for (size_t i = 0; i < sink.got.packets; i++) {
        if (sink.got.total[i] == total && sink.at_ms[i] == at_ms &&
            memcmp(sink.got.bytes + sink.got.at[i], packet, total) == 0) {
            return true;
        }
    }
    return false;
}

// One SIP of `readings` each 100 ms; the second is damaged by `harm`. All others must be out when their last
// byte is in.
typedef void (*harm_t)(uint8_t *packet, size_t *total, size_t which);

static void run_timed(unsigned readings, harm_t harm, size_t which, uint32_t wake_ms, uint32_t epoch_ms) {
    argus_parser_t parser;
    start(&parser);
    for (uint32_t k = 0; k < 4; k++) {
        uint8_t packet[ARGUS_FRAME_TOTAL_MAX + 8];
        size_t total = sip_with(packet, readings, (uint8_t)(k + 1));
        const uint32_t sent_ms = epoch_ms + 100 * k;
        if (k == 1) {
            harm(packet, &total, which);
        }
        const uint32_t done_ms = send_timed(&parser, sent_ms, packet, total, wake_ms);
        snprintf(message, sizeof message, "readings %u harm %zu wake %u epoch %u: SIP %u is not out in time",
                 readings, which, (unsigned)wake_ms, (unsigned)epoch_ms, (unsigned)k);
        TEST_ASSERT_TRUE_MESSAGE(k == 1 || accepted_at(packet, total, done_ms), message);
        idle_until(&parser, done_ms, sent_ms + 100, wake_ms);
    }
    snprintf(message, sizeof message, "readings %u harm %zu: a packet was invented", readings, which);
    TEST_ASSERT_TRUE_MESSAGE(sink.got.packets <= 4, message);
}

static void run_timed_all(harm_t harm, size_t cases) {
    static const unsigned sizes[] = {0, 4, 5, 6, 8, 11, 12, 16};
    static const uint32_t wakes[] = {1, 4, 10};
    for (size_t which = 0; which < cases; which++) {
        for (size_t i = 0; i < 8 * 3; i++) {
            run_timed(sizes[i / 3], harm, which, wakes[i % 3], which % 2 ? 0 : UINT32_MAX - 150);
        }
    }
}

static void false_count(uint8_t *packet, size_t *total, size_t which) {
    (void)total;
    packet[2] = (uint8_t)which;
}

void test_a_false_count_delays_a_sip_by_at_most_one(void) {
    run_timed_all(false_count, 256);
}

static void cut_off(uint8_t *packet, size_t *total, size_t which) {
    (void)packet;
    *total = which < *total ? which : *total - 1;
}

void test_a_sip_cut_off_anywhere_does_not_delay_the_next(void) {
    run_timed_all(cut_off, 90);
}

static void stray_header(uint8_t *packet, size_t *total, size_t which) {
    memmove(packet + 3, packet, *total);
    packet[0] = 0xFA;
    packet[1] = 0xFB;
    packet[2] = (uint8_t)which;
    *total += 3;
}

void test_a_stray_header_with_any_count_does_not_delay_the_next_sip(void) {
    run_timed_all(stray_header, 256);
}

// At x = -1030, y = `which`, the position of a SIP looks like a header with any COUNT; its own header is
// damaged.
static void header_in_position(uint8_t *packet, size_t *total, size_t which) {
    const uint8_t position[] = {0xFA, 0xFB, (uint8_t)which, 0x44};
    (void)total;
    memcpy(packet + 4, position, sizeof position);
    packet[0] ^= 0x40;
}

void test_a_header_inside_a_damaged_sip_does_not_delay_the_next(void) {
    run_timed_all(header_in_position, 512);
}

// At (-1030, 3) and heading 0 a SIP contains the bytes of a whole SYNC0: it must still arrive as a SIP.
static size_t sip_around_a_packet(uint8_t *packet, unsigned readings) {
    const uint8_t inside[] = {0xFA, 0xFB, 0x03, 0x00, 0x00, 0x00};
    uint8_t data[ARGUS_FRAME_TOTAL_MAX];
    const size_t total = sip_with(packet, readings, 1);
    memcpy(data, packet + 3, total - 5);
    memcpy(data + 1, inside, sizeof inside);
    return argus_frame_encode(packet, ARGUS_FRAME_TOTAL_MAX, data, total - 5);
}

static void pause_inside(unsigned readings, size_t cut, uint32_t pause_ms) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    argus_parser_t parser;
    const size_t total = sip_around_a_packet(packet, readings);
    start(&parser);
    feed(&parser, 0, packet, cut);
    fetch_all(&parser, pause_ms);
    feed(&parser, pause_ms, packet + cut, total - cut);
    snprintf(message, sizeof message, "readings %u: pause %u after byte %zu", readings, (unsigned)pause_ms,
             cut);
    TEST_ASSERT_EQUAL_MESSAGE(1, sink.got.packets, message);
    TEST_ASSERT_EQUAL_MESSAGE(total, sink.got.total[0], message);
}

void test_a_packet_inside_an_intact_sip_is_never_taken_for_it(void) {
    for (uint32_t pause_ms = 0; pause_ms <= 60; pause_ms += 5) {
        for (size_t cut = 0; cut < 55; cut++) {
            pause_inside(6, cut, pause_ms);
            pause_inside(16, cut, pause_ms);
        }
    }
}

// Doubt ends with the packet it was about: an IOpac that comes next and looks like a packet inside arrives as
// an IOpac.
void test_doubt_does_not_outlive_its_packet(void) {
    const uint8_t data[] = {0xF0, 0xFA, 0xFB, 0x03, 0x00, 0x00, 0x00, 1, 2, 3, 4, 5, 6};
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    argus_parser_t parser;
    start(&parser);
    const size_t sip = sip_with(packet, 6, 1);
    feed(&parser, 0, packet, 30);
    feed(&parser, 40, packet + 30, sip - 30);
    const size_t total = argus_frame_encode(packet, sizeof packet, data, sizeof data);
    for (size_t i = 0; i < total; i++) {
        feed(&parser, 41, packet + i, 1);
    }
    TEST_ASSERT_EQUAL(2, sink.got.packets);
    TEST_ASSERT_EQUAL(total, sink.got.total[1]);
}

void test_even_the_shortest_packet_is_found_behind_a_false_header(void) {
    const uint8_t bytes[] = {0xFA, 0xFB, 40, 0x90, 1, 0xFA, 0xFB, 0x03, 0x00, 0x00, 0x00};
    argus_parser_t parser;
    start(&parser);
    feed(&parser, 0, bytes, sizeof bytes);
    TEST_ASSERT_EQUAL(0, sink.got.packets); // it may still be an ENCODERpac on its way
    fetch_all(&parser, 30);
    TEST_ASSERT_EQUAL(1, sink.got.packets);
    TEST_ASSERT_EQUAL(6, sink.got.total[0]);
}

// Three false headers in each other's reach make the parser move what it holds; a SIP behind them is still
// found at its last byte, long before the third would be complete.
void test_a_sip_is_found_at_once_after_what_is_held_was_moved(void) {
    static const size_t headers[] = {0, 250, 310};
    uint8_t bytes[508 + ARGUS_FRAME_TOTAL_MAX] = {0};
    argus_parser_t parser;
    for (size_t i = 0; i < 3; i++) {
        memcpy(bytes + headers[i], (const uint8_t[]){0xFA, 0xFB, 0xFF, 0x44}, 4);
    }
    const size_t total = sip_with(bytes + 508, 6, 1);
    start(&parser);
    feed(&parser, 0, bytes, 508);
    TEST_ASSERT_EQUAL(0, sink.got.packets);
    feed(&parser, 0, bytes + 508, total);
    TEST_ASSERT_EQUAL(1, sink.got.packets);
    TEST_ASSERT_EQUAL(508, parser.skipped_bytes);
}

void test_impossible_counts_are_counted_and_passed_over(void) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX] = {0xFA, 0xFB, 0, 0xFA, 0xFB, 1, 0xFA, 0xFB, 2};
    argus_parser_t parser;
    const size_t total = sip_with(packet + 9, 6, 1);
    start(&parser);
    feed(&parser, 0, packet, 9 + total);
    TEST_ASSERT_EQUAL(1, sink.got.packets);
    TEST_ASSERT_EQUAL(3, parser.bad_counts);
    TEST_ASSERT_EQUAL(0, parser.bad_checksums);
    TEST_ASSERT_EQUAL(9, parser.skipped_bytes);
}

void test_a_long_configpac_survives_9600_baud_and_a_hesitating_adapter(void) {
    uint8_t data[195];
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    memset(data, 'x', sizeof data);
    data[0] = ARCOS_TYPE_CONFIGPAC;
    const size_t total = argus_frame_encode(packet, sizeof packet, data, sizeof data);
    for (uint32_t wake_ms = 1; wake_ms <= 80; wake_ms++) {
        argus_parser_t parser;
        start(&parser);
        send_timed(&parser, 5, packet, total, wake_ms);
        snprintf(message, sizeof message, "read every %u ms", (unsigned)wake_ms);
        TEST_ASSERT_EQUAL_MESSAGE(1, sink.got.packets, message);
    }
}

void test_a_packet_read_late_in_two_halves_is_not_lost(void) {
    for (uint32_t freeze_ms = 0; freeze_ms < 3000; freeze_ms += 250) {
        uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
        argus_parser_t parser;
        const size_t total = sip_with(packet, 6, 9);
        start(&parser);
        feed(&parser, 0, packet, 20);
        feed(&parser, freeze_ms, packet + 20,
             total - 20); // the bytes waited in the kernel while we were stopped
        TEST_ASSERT_EQUAL(1, sink.got.packets);
    }
}

void test_what_never_completes_is_given_up(void) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    argus_parser_t parser;
    const size_t total = sip_with(packet, 6, 9);
    for (size_t cut = 1; cut < total; cut++) {
        const uint32_t base = UINT32_MAX - 60;
        start(&parser);
        feed(&parser, base, packet, cut);
        fetch_all(&parser, base + (cut < 3 ? 100 : 54 + 100)); // 54 ms for the 52 bytes that COUNT announces
        TEST_ASSERT_EQUAL(cut, parser.length);
        fetch_all(&parser, base + 54 + 101);
        TEST_ASSERT_EQUAL(0, parser.length);
        TEST_ASSERT_EQUAL(1, parser.timeouts);
        TEST_ASSERT_EQUAL(cut, parser.skipped_bytes);
    }
}

void test_a_clock_that_steps_back_loses_nothing(void) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    argus_parser_t parser;
    const size_t total = sip_with(packet, 6, 9);
    start(&parser);
    feed(&parser, 5000, packet, 30);
    fetch_all(&parser, 4000);
    feed(&parser, 4001, packet + 30, total - 30);
    TEST_ASSERT_EQUAL(1, sink.got.packets);
}

void test_counters_go_on_over_a_flush(void) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    argus_parser_t parser;
    const size_t total = sip_with(packet, 6, 9);
    start(&parser);
    feed(&parser, 0, packet, total);
    feed(&parser, 0, packet, 20);
    argus_parser_flush(&parser);
    TEST_ASSERT_EQUAL(0, parser.length);
    TEST_ASSERT_EQUAL(1, parser.packets);
    TEST_ASSERT_EQUAL(20, parser.skipped_bytes);
    feed(&parser, 0, packet, total);
    TEST_ASSERT_EQUAL(2, sink.got.packets);
}

void test_push_waits_until_a_complete_packet_is_fetched(void) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    argus_parser_t parser;
    argus_packet_t out;
    const size_t total = sip_with(packet, 6, 9);
    argus_parser_init(&parser);
    TEST_ASSERT_EQUAL(total, argus_parser_push(&parser, 0, packet, total));
    TEST_ASSERT_EQUAL(0, argus_parser_push(&parser, 0, packet, total));
    TEST_ASSERT_TRUE(argus_parser_next(&parser, 0, &out));
    TEST_ASSERT_EQUAL(total - 5, out.count);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(packet + 3, out.data, out.count);
    TEST_ASSERT_FALSE(argus_parser_next(&parser, 0, &out));
}

// ------------------------------------------------------------------------------------------------ anything

// Bytes that look like headers, with whole and broken packets between them.
static size_t nasty(random_t *random, uint8_t *out) {
    static const uint8_t liked[] = {0xFA, 0xFB, 0x00, 0x03, 0x06, 0x32, 0x33, 0x20, 0xFF};
    if (random_below(random, 40) == 0) {
        const size_t total = sip_with(out, random_below(random, 7), (uint8_t)random_below(random, 256));
        return random_below(random, 2) ? total : random_below(random, (uint32_t)total) + 1;
    }
    out[0] = random_below(random, 3) ? liked[random_below(random, sizeof liked)]
                                     : (uint8_t)random_below(random, 256);
    return 1;
}

void test_a_million_hostile_bytes_are_survived_and_accounted_for(void) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        random_t random = random_seed(seed);
        argus_parser_t parser;
        uint32_t now_ms = UINT32_MAX - 20000;
        size_t pushed = 0;
        size_t accepted = 0;
        argus_parser_init(&parser);
        while (pushed < 1000000 / 4) {
            uint8_t chunk[700 + ARGUS_FRAME_TOTAL_MAX];
            const size_t wanted = 1 + random_below(&random, random_below(&random, 2) ? 700 : 8);
            size_t size = 0;
            while (size < wanted) {
                size += nasty(&random, chunk + size);
            }
            for (size_t at = 0; at < size;) {
                argus_packet_t packet;
                at += argus_parser_push(&parser, now_ms, chunk + at, size - at);
                while (argus_parser_next(&parser, now_ms, &packet)) {
                    accepted += packet.count + (size_t)5;
                    const uint8_t *checksum = packet.data + packet.count;
                    TEST_ASSERT_EQUAL(argus_frame_checksum(packet.data, packet.count),
                                      checksum[0] << 8 | checksum[1]);
                }
            }
            pushed += size;
            now_ms += random_below(&random, 4) ? random_below(&random, 20) : random_below(&random, 500);
            snprintf(message, sizeof message, "seed %llu after %zu bytes", (unsigned long long)seed, pushed);
            TEST_ASSERT_EQUAL_MESSAGE(pushed, accepted + parser.skipped_bytes + parser.length, message);
        }
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, parser.packets, "the stream is not hostile enough");
    }
}

// What the shortcut for bytes of a packet under way leaves out must change nothing: `plain` never takes it.
static void both_take(argus_parser_t *parser, argus_parser_t *plain, uint32_t now_ms, const uint8_t *bytes,
                      size_t count) {
    for (size_t at = 0; at < count;) {
        argus_packet_t one;
        argus_packet_t other;
        plain->ahead = 0;
        const size_t taken = argus_parser_push(parser, now_ms, bytes + at, count - at);
        TEST_ASSERT_EQUAL_MESSAGE(argus_parser_push(plain, now_ms, bytes + at, count - at), taken, message);
        at += taken;
        for (bool more = true; more;) {
            plain->ahead = 0;
            more = argus_parser_next(parser, now_ms, &one);
            TEST_ASSERT_EQUAL_MESSAGE(argus_parser_next(plain, now_ms, &other), more, message);
            if (more) {
                TEST_ASSERT_EQUAL_MESSAGE(other.count, one.count, message);
                TEST_ASSERT_EQUAL_MEMORY_MESSAGE(other.data, one.data, one.count, message);
            }
        }
        plain->ahead = parser->ahead;
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(plain, parser, offsetof(argus_parser_t, held), message);
    }
}

void test_bytes_of_a_packet_under_way_are_taken_as_any_others(void) {
    size_t ahead = 0;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        random_t random = random_seed(seed);
        argus_parser_t parser;
        argus_parser_t plain;
        uint32_t now_ms = UINT32_MAX - 5000;
        argus_parser_init(&parser);
        argus_parser_init(&plain);
        for (unsigned n = 0; n < 300; n++) {
            uint8_t chunk[2 * ARGUS_FRAME_TOTAL_MAX];
            size_t size = random_below(&random, 2) ? nasty(&random, chunk)
                                                   : sip_with(chunk, random_below(&random, 17), (uint8_t)n);
            size = random_below(&random, 8) ? size : random_below(&random, (uint32_t)size) + 1;
            snprintf(message, sizeof message, "seed %llu, piece %u", (unsigned long long)seed, n);
            for (size_t at = 0; at < size;) {
                const size_t left = size - at;
                const size_t part = random_below(&random, 4) ? 1 : 1 + random_below(&random, 40);
                both_take(&parser, &plain, now_ms, chunk + at, part < left ? part : left);
                at += part < left ? part : left;
                ahead += parser.ahead > 0;
                now_ms += random_below(&random, 60) ? random_below(&random, 3) : random_below(&random, 400);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_MESSAGE(1000, ahead, "the shortcut is never taken");
}

void test_a_packet_without_room_is_neither_sealed_nor_encoded(void) {
    static const uint8_t data[] = {1, 2, 3, 4};
    uint8_t packet[16] = {0};
    TEST_ASSERT_EQUAL(9, argus_frame_encode(packet, 9, data, sizeof data));
    for (size_t capacity = 0; capacity < 9; capacity++) {
        memset(packet, 0x55, sizeof packet);
        TEST_ASSERT_EQUAL(0, argus_frame_encode(packet, capacity, data, sizeof data));
        TEST_ASSERT_EQUAL(0, argus_frame_seal(packet, capacity, sizeof data));
        TEST_ASSERT_EACH_EQUAL_HEX8(0x55, packet, sizeof packet);
    }
    TEST_ASSERT_EQUAL(0, argus_frame_seal(packet, sizeof packet, 0)); // nothing is no packet
}

void test_no_bytes_are_no_news(void) {
    argus_parser_t parser;
    argus_parser_init(&parser);
    TEST_ASSERT_EQUAL(0, argus_parser_push(&parser, 1, NULL, 0));
    TEST_ASSERT_EQUAL(0, parser.packets);
}

// While bytes of a packet that is in no doubt are owed, there is nothing to decide: asked all the same, it
// changes nothing.
void test_asked_before_a_packet_is_whole_it_waits(void) {
    static const uint8_t data[] = {ARCOS_CMD_VEL, ARCOS_ARG_POSITIVE, 100, 0};
    uint8_t frame[16];
    argus_parser_t parser;
    argus_packet_t out;
    argus_parser_init(&parser);
    const size_t count = argus_frame_encode(frame, sizeof frame, data, sizeof data);
    size_t at = 0;
    while (!argus_parser_waits(&parser, 0)) {
        TEST_ASSERT_TRUE(at < count);
        at += argus_parser_push(&parser, 0, frame + at, 1);
        TEST_ASSERT_FALSE(argus_parser_next(&parser, 0, &out));
    }
    const argus_parser_t before = parser;
    TEST_ASSERT_FALSE(argus_parser_decide(&parser, 0, &out));
    TEST_ASSERT_EQUAL_MEMORY(&before, &parser, sizeof parser);
    while (at < count) {
        at += argus_parser_push(&parser, 0, frame + at, 1);
    }
    TEST_ASSERT_TRUE(argus_parser_next(&parser, 0, &out));
    TEST_ASSERT_EQUAL_MEMORY(data, out.data, sizeof data);
}
