// SPDX-License-Identifier: MIT
// Rule under attack: a recorded emulator of every model, played back with its own delays, is connected to,
// read without loss, and never driven into anything.
#include "supervisor/manager.h"

#include <stdio.h>
#include <string.h>

#include "captures.h"
#include "unity.h"

#define EPOCH_MS (UINT32_MAX - 3000u) // the clock wraps during each tape
#define PLAY_MAX_MS 200000u
#define EVENT_MAX 256

static captures_tape_t tape;
static argus_t argus;
static unsigned events[EVENT_MAX];
static size_t moves;
static uint32_t time_ms;

// The player waits for each of the client's four handshake packets, then goes on as recorded after that
// packet.
static const uint8_t handshake[] = {ARCOS_SYNC_SYNC0, ARCOS_SYNC_SYNC1, ARCOS_SYNC_SYNC2, ARCOS_CMD_OPEN};
static size_t mark[sizeof handshake + 1]; // chunk of each, then the end
static size_t heard;                      // handshake packets of our client
static size_t next;                       // chunk to play
static uint32_t behind_ms;                // player's time minus the tape's

static void thread(const char *name) {
    captures_load_tape(&tape, name);
    size_t at = 0;
    for (size_t i = 0; i < sizeof handshake; i++, at++) {
        while (at < tape.chunks &&
               (tape.chunk[at].from_robot || tape.bytes[tape.chunk[at].at + 3] != handshake[i])) {
            at++;
        }
        TEST_ASSERT_LESS_THAN_MESSAGE(tape.chunks, at, name);
        mark[i] = at;
    }
    mark[sizeof handshake] = tape.chunks;
    heard = 0;
    next = 0;
}

static void hear(const uint8_t *packet) {
    if (heard < sizeof handshake && packet[3] == handshake[heard]) {
        next = mark[heard] + 1;
        behind_ms = time_ms - tape.chunk[mark[heard]].t_ms;
        heard++;
    }
    moves += packet[3] == ARCOS_CMD_MOVE || packet[3] == ARCOS_CMD_HEAD;
}

static void drain(void) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    argus_event_t event;
    while (argus_transmit(&argus, packet, sizeof packet) > 0) {
        hear(packet);
    }
    while (argus_next_event(&argus, &event)) {
        events[event.id % EVENT_MAX]++;
    }
    TEST_ASSERT_EQUAL(0, argus_invariants_broken(&argus));
}

static void play_due(void) {
    while (heard > 0 && next < mark[heard]) {
        const captures_chunk_t *chunk = &tape.chunk[next];
        if (chunk->from_robot && time_ms < chunk->t_ms + behind_ms) {
            return;
        }
        next++; // before the client's answer moves it
        if (chunk->from_robot) {
            argus_receive(&argus, EPOCH_MS + time_ms, tape.bytes + chunk->at, chunk->count);
            drain();
        }
    }
}

static void play(const char *name, uint32_t tick_ms) {
    argus_config_t config;
    argus_config_default(&config);
    config.profile = ARGUS_PROFILE_PAPER;
    thread(name);
    memset(events, 0, sizeof events);
    moves = 0;
    argus_manager_init(&argus, &config, EPOCH_MS);
    argus_link_up(&argus, EPOCH_MS);
    for (time_ms = 0; next < tape.chunks && time_ms < PLAY_MAX_MS; time_ms += tick_ms) {
        play_due();
        argus_process(&argus, EPOCH_MS + time_ms);
        drain();
    }
    TEST_ASSERT_EQUAL_MESSAGE(tape.chunks, next, name);
}

static size_t recorded_sips(const char *name) {
    static captures_t stream;
    size_t sips = 0;
    memset(&stream, 0, sizeof stream);
    captures_load(&stream, name, "r2c");
    for (size_t i = 0; i < stream.packets; i++) {
        sips += stream.bytes[stream.at[i] + 3] == ARCOS_TYPE_SIP_STATIONARY;
    }
    return sips;
}

void test_every_tape_is_connected_to_and_read_to_its_end(void) {
    for (size_t i = 0; i < captures_count; i++) {
        const char *name = captures_names[i];
        for (uint32_t tick_ms = 1; tick_ms <= 21; tick_ms += 10) {
            play(name, tick_ms);
            const argus_session_t *session = &argus.session;
            TEST_ASSERT_EQUAL_MESSAGE(1, events[ARGUS_EV_SESSION_OPEN], name);
            const bool known = argus_robot_find(session->subclass) != NULL;
            TEST_ASSERT_EQUAL_MESSAGE(known ? 0 : 1, events[ARGUS_EV_SUBCLASS_UNKNOWN], name);
            TEST_ASSERT_EQUAL_MESSAGE(0, events[ARGUS_EV_SESSION_NO_ANSWER], name);
            TEST_ASSERT_EQUAL_MESSAGE(0, events[ARGUS_EV_LINK_LOST], name);
            TEST_ASSERT_EQUAL_STRING_MESSAGE("MobileSim", session->name, name);
            TEST_ASSERT_EQUAL_MESSAGE(recorded_sips(name), session->sips, name);
            TEST_ASSERT_EQUAL_MESSAGE(0, session->parser.bad_checksums + session->parser.skipped_bytes, name);
            TEST_ASSERT_EQUAL_MESSAGE(0, session->bad_sips, name);
            TEST_ASSERT_TRUE_MESSAGE(argus_session_is_open(session), name);
        }
    }
}

static void expect_model(const char *name, const char *subclass, int sonars, int unit_um) {
    play(name, 10);
    TEST_ASSERT_EQUAL_STRING(subclass, argus.session.subclass);
    TEST_ASSERT_EQUAL_MESSAGE(sonars, argus.session.sip.sonar_count, name);
    TEST_ASSERT_EQUAL_MESSAGE(unit_um, argus_session_distance_um(&argus.session, 1000), name);
    TEST_ASSERT_EQUAL_MESSAGE(0, argus.knowledge.pose.x_mm, name);
}

void test_the_three_models_say_who_they_are(void) {
    expect_model("m_p3dx", "p3dx", 16, 485);
    expect_model("m_powerbot", "powerbot", 32, 1000);
    expect_model("m_seekur", "seekur", 0, 1000);
}

// It was driven into a wall: both wheels stall at the end of the tape.
void test_the_ram_is_seen_as_a_stall(void) {
    play("d_ram", 10);
    TEST_ASSERT_GREATER_THAN(0, events[ARGUS_EV_STALL]);
}

void test_a_tape_without_sonars_moves_nothing(void) {
    const argus_point_t goal = {1000, 0};
    play("m_seekur", 10);
    TEST_ASSERT_TRUE(argus_set_course(&argus, &goal, 1));
    for (size_t round = 0; round < 20; round++) { // the same SIPs again
        next = mark[3] + 1;
        behind_ms = time_ms - tape.chunk[next].t_ms;
        for (; next < tape.chunks; time_ms += 10) {
            play_due();
            argus_process(&argus, EPOCH_MS + time_ms);
            drain();
        }
    }
    TEST_ASSERT_EQUAL(0, moves);
}

// ------------------------------------------------------------------------------------------------ what is
// sent

// Where a recorded client sent a command that we send too, our builder makes the same bytes.
void test_recorded_commands_that_we_send_too_are_built_alike(void) {
    static captures_t stream;
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    size_t same = 0;
    memset(&stream, 0, sizeof stream);
    for (size_t i = 0; i + 1 < captures_count; i++) { // the last holds damage
        captures_load(&stream, captures_names[i], "c2r");
    }
    for (size_t i = 0; i < stream.packets; i++) {
        const uint8_t *data = stream.bytes + stream.at[i] + 3;
        const size_t count = stream.total[i] - 5;
        size_t total = argus_frame_encode(packet, sizeof packet, data, count);
        TEST_ASSERT_EQUAL(stream.total[i], total);
        TEST_ASSERT_EQUAL_MEMORY(stream.bytes + stream.at[i], packet, total);
        if (count == 1) {
            total = argus_command_plain(packet, sizeof packet, data[0]);
        } else if (count == 4 && data[1] != ARCOS_ARG_STRING) {
            const int32_t value = data[2] | data[3] << 8;
            total = argus_command_int(packet, sizeof packet, data[0],
                                      data[1] == ARCOS_ARG_NEGATIVE ? -value : value);
        } else if (count > 2 && data[1] == ARCOS_ARG_STRING && count == 3 + (size_t)data[2]) {
            total = argus_command_string(packet, sizeof packet, data[0], data + 3, data[2]);
        } else {
            continue; // forms that we do not send: a NUL behind a string, simulator commands
        }
        same++;
        TEST_ASSERT_EQUAL(stream.total[i], total);
        TEST_ASSERT_EQUAL_MEMORY(stream.bytes + stream.at[i], packet, total);
    }
    TEST_ASSERT_GREATER_THAN(stream.packets * 9 / 10, same);
}
