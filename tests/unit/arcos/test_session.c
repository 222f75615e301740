// SPDX-License-Identifier: MIT
// Rule under attack: the session finds, opens, keeps, loses, finds again and leaves the robot in the order
// that is safe, whatever the robot answers, when, and in which pieces.
#include "arcos/session.h"

#include <stdio.h>
#include <string.h>

#include "captures.h"
#include "knowledge/config.h"
#include "unity.h"

#define LOG_MAX 4000
#define EPOCH_MS (UINT32_MAX - 1500u) // the clock wraps in every test

// ------------------------------------------------------------------------------------------------ a small
// robot

typedef struct {
    uint8_t command;
    int32_t argument; // 0 when there is none
    uint32_t at_ms;   // since the start of the test
} entry_t;

typedef enum { WAIT, GOT0, GOT1, SYNCED, OPENED } robot_state_t;

static struct {
    robot_state_t state;
    argus_parser_t parser;
    uint8_t out[8192];
    size_t out_count;
    uint32_t sip_due_ms;
    uint8_t sip_type;
    uint8_t sips;
    const uint8_t *config; // data of its CONFIGpac, NULL: it does not answer
    size_t config_count;
    const char *identity; // behind the type byte of the SYNC2 reply, `identity_count` bytes
    size_t identity_count;
    uint32_t lose_replies; // so many SYNC replies get lost
    bool dead;             // neither hears nor speaks
    bool mute;             // its bytes do not arrive
    bool deaf;             // ours do not arrive
    bool ignores_close;
    int16_t speed_mm_s; // of both wheels; it brakes after VEL 0
    bool braking;
    bool runs_away; // it does not
    entry_t log[LOG_MAX];
    size_t logged;
} robot;

static argus_session_t session;
static argus_config_t config;
static uint32_t time_ms; // since the start of the test
static uint32_t tick_ms;
static size_t chunk; // bytes a read delivers at most
static unsigned seen;
static unsigned counts[9];
static uint32_t last_at_ms[9];
static char message[160];

static const uint8_t example_config[] =
    "\x20Pioneer\0p3dx-sh\0P3DX0001\0\0h\x01\xDC\x05,\x01\xD0\x07\xF4\x01P3DX_0001\0d\0\0\0\0\x01"
    "\0\x01s\0\xBA@\xD0\x07\0\xC8\0d\0\xEE\x02"
    "2\0d\0\xEE\x02"
    "d\0d\0(\0\x14\0\0\0,\x01,\x01(\0\x1E"
    "\0\0\0\0\0\0(\x02\0\0\0\0\0\x80\0n\0"
    "2.6\0\0\0\0\0\0";
static const char example_identity[] = "P3DX_0001\0Pioneer\0p3dx-sh";

static uint32_t now(void) {
    return EPOCH_MS + time_ms;
}

void setUp(void) {
    memset(&robot, 0, sizeof robot);
    memset(counts, 0, sizeof counts);
    argus_parser_init(&robot.parser);
    robot.sip_type = 0x32;
    robot.config = example_config;
    robot.config_count = sizeof example_config - 1;
    robot.identity = example_identity;
    robot.identity_count = sizeof example_identity;
    argus_config_default(&config);
    argus_config_follow(&config, argus_config_follows(&config), argus_robot_default());
    argus_session_init(&session);
    time_ms = 0;
    tick_ms = 10;
    chunk = sizeof robot.out;
    seen = 0;
}

static void robot_says(const uint8_t *data, size_t count) {
    uint8_t packet[ARCOS_FRAME_SEND_TOTAL_MAX];
    const size_t total = argus_frame_encode(packet, sizeof packet, data, count);
    if (!robot.dead && !robot.mute && robot.out_count + total <= sizeof robot.out) {
        memcpy(robot.out + robot.out_count, packet, total);
        robot.out_count += total;
    }
}

static void robot_echoes(uint8_t sync) {
    uint8_t data[64] = {sync};
    if (robot.lose_replies > 0) {
        robot.lose_replies--;
        return;
    }
    if (sync == 2) {
        memcpy(data + 1, robot.identity, robot.identity_count);
    }
    robot_says(data, 1 + (sync == 2 ? robot.identity_count : 0));
}

// Strict order, as ARCOS: anything unexpected sends it back to WAIT, SYNC0 always starts over.
static void robot_syncs(uint8_t command) {
    if (command == 0) {
        robot.state = GOT0;
    } else if (command == 1 && robot.state == SYNCED) {
        robot.state = OPENED;
        robot.sip_due_ms = time_ms + 100;
        return;
    } else if ((command == 1 && robot.state <= GOT1) || (command == 2 && robot.state >= GOT1)) {
        const robot_state_t needed = command == 1 ? GOT0 : GOT1;
        robot.state = robot.state >= needed && robot.state != WAIT ? (robot_state_t)(needed + 1) : WAIT;
    } else {
        robot.state = WAIT;
        return;
    }
    robot_echoes(command);
}

static void robot_hears(uint8_t command) {
    if (robot.state != OPENED) {
        robot_syncs(command);
    } else if (command == ARCOS_CMD_CLOSE && !robot.ignores_close) {
        robot.state = WAIT;
    } else if (command == ARCOS_CMD_CONFIG && robot.config != NULL) {
        robot_says(robot.config, robot.config_count);
    } else if (command == ARCOS_CMD_VEL) {
        robot.braking = !robot.runs_away && robot.speed_mm_s != 0;
    }
}

static void robot_reads(const uint8_t *bytes, size_t count) {
    argus_packet_t packet;
    TEST_ASSERT_EQUAL_MESSAGE(count, argus_parser_push(&robot.parser, time_ms, bytes, count),
                              "not one whole packet");
    TEST_ASSERT_TRUE_MESSAGE(argus_parser_next(&robot.parser, time_ms, &packet), "not one whole packet");
    TEST_ASSERT_LESS_THAN(LOG_MAX, robot.logged);
    const int32_t magnitude = packet.count == 4 ? packet.data[2] | packet.data[3] << 8 : 0;
    const int32_t argument = packet.count == 4 && packet.data[1] == 0x1B ? -magnitude : magnitude;
    robot.log[robot.logged++] = (entry_t){packet.data[0], argument, time_ms};
    if (!robot.dead && !robot.deaf) {
        robot_hears(packet.data[0]);
    }
}

static size_t sip_data(uint8_t *data, uint8_t number) {
    memset(data, 0, 32);
    data[0] = robot.sip_type;
    data[1] = number;
    for (int i = 7; i <= 9; i += 2) {
        data[i] = (uint8_t)((unsigned)robot.speed_mm_s & 0xFFu);
        data[i + 1] = (uint8_t)((unsigned)robot.speed_mm_s >> 8 & 0xFFu);
    }
    return 32;
}

static void robot_reports(void) {
    uint8_t data[32];
    if (robot.state == OPENED && (int32_t)(time_ms - robot.sip_due_ms) >= 0) {
        robot.sip_due_ms += 100;
        robot.speed_mm_s =
            (int16_t)(robot.speed_mm_s - (robot.braking ? (robot.speed_mm_s > 0 ? 20 : -20) : 0));
        robot.braking = robot.braking && robot.speed_mm_s != 0;
        robot_says(data, sip_data(data, ++robot.sips));
    }
}

static void note(unsigned bits) {
    seen |= bits;
    for (unsigned i = 0; i < 9; i++) {
        if (bits >> i & 1) {
            counts[i]++;
            last_at_ms[i] = time_ms;
        }
    }
}

static unsigned count_of(unsigned bit) {
    for (unsigned i = 0; i < 9; i++) {
        if (bit == 1u << i) {
            return counts[i];
        }
    }
    return UINT32_MAX;
}

static uint32_t time_of(unsigned bit) {
    for (unsigned i = 0; i < 9; i++) {
        if (bit == 1u << i && counts[i] > 0) {
            return last_at_ms[i];
        }
    }
    return UINT32_MAX;
}

static void receive(const uint8_t *bytes, size_t count) {
    size_t taken = 0;
    unsigned bits = 0;
    do {
        size_t used = 0;
        bits = argus_session_receive(&session, &config, now(), bytes + taken, count - taken, &used);
        TEST_ASSERT_TRUE_MESSAGE(used > 0 || bits != 0 || taken == count, "receive makes no progress");
        taken += used;
        TEST_ASSERT_LESS_OR_EQUAL(count, taken);
        note(bits);
    } while (taken < count || bits != 0);
}

static void client_turn(void) {
    uint8_t packet[ARCOS_FRAME_SEND_TOTAL_MAX];
    unsigned bits = 1;
    for (int i = 0; bits != 0; i++) {
        TEST_ASSERT_LESS_THAN_MESSAGE(10, i, "process never returns 0");
        note(bits = argus_session_process(&session, &config, now()));
    }
    for (size_t total = 1; total > 0;) {
        total = argus_session_transmit(&session, now(), packet, sizeof packet);
        if (total > 0) {
            robot_reads(packet, total);
        }
    }
}

static void turn(void) {
    uint8_t bytes[sizeof robot.out];
    robot_reports();
    const size_t count = robot.out_count;
    memcpy(bytes, robot.out, count);
    robot.out_count = 0;
    for (size_t at = 0; at < count; at += chunk) {
        receive(bytes + at, count - at < chunk ? count - at : chunk);
    }
    client_turn();
    time_ms += tick_ms;
}

static void run_until(uint32_t until_ms) {
    while (time_ms < until_ms) {
        turn();
    }
}

static bool run_until_seen(unsigned bit, uint32_t until_ms) {
    const unsigned before = count_of(bit);
    while (time_ms < until_ms && count_of(bit) == before) {
        turn();
    }
    return count_of(bit) > before;
}

static void connect(void) {
    argus_session_link_up(&session, now());
    TEST_ASSERT_TRUE_MESSAGE(run_until_seen(ARGUS_SESSION_DID_OPEN, 5000), "the session does not open");
    turn();
}

static size_t logged(uint8_t command) {
    size_t count = 0;
    for (size_t i = 0; i < robot.logged; i++) {
        count += robot.log[i].command == command;
    }
    return count;
}

static void assert_log(size_t from, const entry_t *wanted, size_t count) {
    for (size_t i = 0; i < count; i++) {
        snprintf(message, sizeof message, "entry %zu of the log: command %d argument %d", from + i,
                 robot.log[from + i].command, (int)robot.log[from + i].argument);
        TEST_ASSERT_LESS_THAN_MESSAGE(robot.logged, from + i, message);
        TEST_ASSERT_EQUAL_MESSAGE(wanted[i].command, robot.log[from + i].command, message);
        TEST_ASSERT_EQUAL_MESSAGE(wanted[i].argument, robot.log[from + i].argument, message);
    }
}

static const entry_t greeting[] = {{ARCOS_CMD_PULSE, 0, 0}, {ARCOS_CMD_OPEN, 0, 0},  {ARCOS_CMD_CLOSE, 0, 0},
                                   {ARCOS_CMD_OPEN, 0, 0},  {ARCOS_CMD_VEL, 0, 0},   {ARCOS_CMD_RVEL, 0, 0},
                                   {ARCOS_CMD_SETO, 0, 0},  {ARCOS_CMD_CONFIG, 0, 0}};
static const entry_t set_up[] = {{ARCOS_CMD_SETV, 200, 0},  {ARCOS_CMD_SETA, 300, 0},
                                 {ARCOS_CMD_SETA, -600, 0}, {ARCOS_CMD_SETRV, 60, 0},
                                 {ARCOS_CMD_SETRA, 200, 0}, {ARCOS_CMD_SETRA, -200, 0},
                                 {ARCOS_CMD_SONAR, 1, 0}};
#define GREETING (sizeof greeting / sizeof greeting[0])
#define SET_UP (sizeof set_up / sizeof set_up[0])

// ------------------------------------------------------------------------------------------------ opening

void test_a_waiting_robot_is_opened_in_the_right_order(void) {
    connect();
    assert_log(0, greeting, GREETING);
    assert_log(GREETING, set_up, SET_UP);
    TEST_ASSERT_EQUAL(GREETING + SET_UP, robot.logged);
    TEST_ASSERT_GREATER_OR_EQUAL(250, robot.log[0].at_ms); // it listens first
    TEST_ASSERT_TRUE(argus_session_is_open(&session));
    TEST_ASSERT_EQUAL(1000, argus_session_distance_um(&session, 1000));
    TEST_ASSERT_EQUAL_STRING("P3DX_0001", session.name);
    TEST_ASSERT_EQUAL_STRING("Pioneer", session.robot_class);
    TEST_ASSERT_EQUAL_STRING("p3dx-sh", session.subclass);
    TEST_ASSERT_TRUE(session.has_robot);
    TEST_ASSERT_EQUAL(1, session.attempts);
    TEST_ASSERT_EQUAL(0, seen & ~(unsigned)(ARGUS_SESSION_DID_OPEN | ARGUS_SESSION_GOT_SIP));
}

// Which robot may be driven is decided by what knows the body.
void test_the_set_up_never_enables_the_motors(void) {
    connect();
    run_until(3000);
    assert_log(GREETING, set_up, SET_UP);
    TEST_ASSERT_EQUAL(0, logged(ARCOS_CMD_ENABLE));
}

void test_answers_in_pieces_of_any_size_make_no_difference(void) {
    for (size_t size = 1; size <= 150; size++) {
        setUp();
        chunk = size;
        tick_ms = 1 + (uint32_t)size % 20;
        connect();
        assert_log(0, greeting, GREETING);
        assert_log(GREETING, set_up, SET_UP);
        TEST_ASSERT_EQUAL(0, session.parser.bad_checksums + session.parser.skipped_bytes);
    }
}

// Each SYNC reply is cut in two at every byte, with a pause between that is longer than the parser's
// patience.
void test_a_sync_reply_split_anywhere_still_counts(void) {
    for (size_t cut = 1; cut < 32; cut++) {
        setUp();
        argus_session_link_up(&session, now());
        for (int i = 0; i < 200 && !argus_session_is_open(&session); i++) {
            uint8_t bytes[sizeof robot.out];
            robot_reports();
            const size_t count = robot.out_count;
            const size_t first = count < cut ? count : cut;
            memcpy(bytes, robot.out, count);
            robot.out_count = 0;
            receive(bytes, first);
            client_turn();
            time_ms += 45;
            receive(bytes + first, count - first);
            client_turn();
            time_ms += 5;
        }
        snprintf(message, sizeof message, "cut after byte %zu", cut);
        TEST_ASSERT_TRUE_MESSAGE(argus_session_is_open(&session), message);
        TEST_ASSERT_EQUAL_MESSAGE(3, logged(0) + logged(1) + logged(2) - 1, message);
    }
}

void test_no_sip_is_reported_before_the_session_is_open(void) {
    argus_session_link_up(&session, now());
    while (!argus_session_is_open(&session) && time_ms < 5000) {
        TEST_ASSERT_EQUAL(0, count_of(ARGUS_SESSION_GOT_SIP));
        turn();
    }
    TEST_ASSERT_EQUAL(2, session.sips); // the position of the second is counted from SETO
    run_until(time_ms + 1000);
    TEST_ASSERT_TRUE(count_of(ARGUS_SESSION_GOT_SIP) >= 9 && count_of(ARGUS_SESSION_GOT_SIP) <= 12);
}

void test_a_robot_started_later_is_found_with_back_off(void) {
    robot.dead = true;
    argus_session_link_up(&session, now());
    run_until(60000);
    uint32_t gap_ms = 0;
    size_t previous = 0;
    for (size_t i = 1; i < robot.logged; i++) {
        TEST_ASSERT_EQUAL(ARCOS_CMD_PULSE,
                          robot.log[i].command); // SYNC0 and nothing else, above all no CLOSE
        const uint32_t gap = robot.log[i].at_ms - robot.log[previous].at_ms;
        TEST_ASSERT_GREATER_OR_EQUAL(gap_ms, gap + 2 * tick_ms);
        TEST_ASSERT_LESS_OR_EQUAL(8000 + 500 + 250 + 3 * tick_ms, gap);
        gap_ms = gap;
        previous = i;
    }
    TEST_ASSERT_GREATER_OR_EQUAL(8000, gap_ms);
    TEST_ASSERT_TRUE(robot.logged >= 9 && robot.logged <= 12);
    TEST_ASSERT_EQUAL(robot.logged, count_of(ARGUS_SESSION_NO_ANSWER));
    robot.dead = false;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 10000));
    TEST_ASSERT_EQUAL(robot.log[0].command, ARCOS_CMD_PULSE);
    TEST_ASSERT_EQUAL(count_of(ARGUS_SESSION_NO_ANSWER) + 1, session.attempts);
}

void test_the_shortest_back_off_is_obeyed(void) {
    robot.dead = true;
    config.retry_max_ms = 500;
    argus_session_link_up(&session, now());
    run_until(30000);
    TEST_ASSERT_TRUE(robot.logged >= 22 && robot.logged <= 24); // every 250 + 500 + 500 ms
}

void test_any_lost_sync_reply_means_starting_over_at_sync0(void) {
    for (uint32_t answered = 0; answered < 3; answered++) {
        setUp();
        argus_session_link_up(&session, now());
        while (logged(0) + logged(1) + logged(2) < answered) {
            turn();
        }
        robot.lose_replies = 1;
        TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_NO_ANSWER, 3000));
        const size_t from = robot.logged;
        TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, 6000));
        assert_log(from, greeting, GREETING);
        TEST_ASSERT_EQUAL(2, session.attempts);
    }
}

void test_late_and_repeated_echoes_are_not_taken_for_the_next_answer(void) {
    const uint8_t sync0[] = {0xFA, 0xFB, 3, 0, 0, 0};
    argus_session_link_up(&session, now());
    while (session.state != ARGUS_SESSION_SYNC1) {
        turn();
    }
    robot.out_count = 0;
    for (int i = 0; i < 20; i++) {
        receive(sync0, sizeof sync0);
        TEST_ASSERT_EQUAL(ARGUS_SESSION_SYNC1, session.state);
    }
    TEST_ASSERT_EQUAL(20, session.unknown_packets);
}

// ------------------------------------------------------------------------------------------------ old
// sessions

static const entry_t dislodging[] = {{ARCOS_CMD_VEL, 0, 0}, {ARCOS_CMD_RVEL, 0, 0}, {ARCOS_CMD_CLOSE, 0, 0}};

void test_an_old_session_is_closed_before_sync0(void) {
    for (uint8_t type = 0x32; type <= 0x33; type++) {
        setUp();
        robot.state = OPENED;
        robot.sip_type = type;
        connect();
        assert_log(0, dislodging, 3);
        assert_log(3, greeting, GREETING);
        TEST_ASSERT_GREATER_OR_EQUAL(robot.log[2].at_ms + 100, robot.log[3].at_ms);
        TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_DISLODGE));
        TEST_ASSERT_EQUAL(0, count_of(ARGUS_SESSION_NO_ANSWER));
    }
}

void test_a_sip_instead_of_an_echo_is_an_old_session_too(void) {
    for (int step = 0; step < 3; step++) {
        for (uint8_t type = 0x32; type <= 0x33; type++) {
            setUp();
            robot.sip_type = type;
            argus_session_link_up(&session, now());
            while ((int)session.state < (int)ARGUS_SESSION_SYNC0 + step) {
                turn();
            }
            const size_t from = robot.logged;
            robot.out_count = 0;
            robot.state = OPENED;
            TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_DISLODGE, 4000));
            TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_GOT_SIP)); // it tells where the robot has got to
            TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, 4000));
            assert_log(from, dislodging, 3);
            assert_log(from + 3, greeting, GREETING);
            TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_DISLODGE));
        }
    }
}

// It brakes, 20 mm/s less with each SIP, once VEL 0 has come. Its session is not closed before it rests.
void test_an_old_session_in_motion_is_closed_when_the_robot_rests(void) {
    for (int lost = 0; lost < 2; lost++) {
        setUp();
        robot.state = OPENED;
        robot.speed_mm_s = -300;
        robot.deaf = lost == 1; // the first VEL 0 does not arrive
        argus_session_link_up(&session, now());
        run_until(600);
        TEST_ASSERT_EQUAL(ARGUS_SESSION_HALT, session.state);
        robot.deaf = false;
        TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_DISLODGE, 4000));
        TEST_ASSERT_EQUAL(0, robot.speed_mm_s);
        TEST_ASSERT_GREATER_OR_EQUAL(14, count_of(ARGUS_SESSION_GOT_SIP)); // where it got to is heard
        TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 2000));
    }
}

void test_one_that_never_rests_is_closed_all_the_same(void) {
    robot.state = OPENED;
    robot.speed_mm_s = 300;
    robot.runs_away = true;
    argus_session_link_up(&session, now());
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_DISLODGE, 5000));
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(3000, time_ms);
}

void test_leaving_while_it_comes_to_rest_closes_it(void) {
    robot.state = OPENED;
    robot.speed_mm_s = 300;
    argus_session_link_up(&session, now());
    run_until(500);
    argus_session_leave(&session, now());
    run_until(3000);
    TEST_ASSERT_EQUAL(WAIT, robot.state);
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_CLOSE));
}

void test_a_robot_that_will_not_close_is_retried_with_back_off(void) {
    robot.state = OPENED;
    robot.ignores_close = true;
    argus_session_link_up(&session, now());
    run_until(60000);
    TEST_ASSERT_LESS_THAN(140, robot.logged); // 12 packets an attempt; without back-off it would be 1200
    TEST_ASSERT_GREATER_THAN(3, count_of(ARGUS_SESSION_NO_ANSWER));
    robot.ignores_close = false;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 12000));
}

// ------------------------------------------------------------------------------------------------ CONFIGpac

void test_without_configpac_it_opens_after_one_second(void) {
    robot.config = NULL;
    connect();
    uint32_t opened_ms = robot.log[3].at_ms;
    TEST_ASSERT_UINT32_WITHIN(2 * tick_ms, opened_ms + 1000, time_of(ARGUS_SESSION_DID_OPEN));
    TEST_ASSERT_FALSE(session.has_robot);
    TEST_ASSERT_TRUE(logged(ARCOS_CMD_CONFIG) >= 2 && logged(ARCOS_CMD_CONFIG) <= 4);
    TEST_ASSERT_EQUAL(1, logged(ARCOS_CMD_SONAR_CYCLE)); // the robot's own is not known
    const size_t asked = logged(ARCOS_CMD_CONFIG);
    run_until(time_ms + 5000);
    TEST_ASSERT_EQUAL(asked, logged(ARCOS_CMD_CONFIG));
}

// The timer, not a SIP, ends the waiting: its bit must not get lost.
void test_the_end_of_waiting_for_configpac_is_said_between_two_sips(void) {
    robot.config = NULL;
    argus_session_link_up(&session, now());
    while (robot.state != OPENED) {
        turn();
    }
    robot.sip_due_ms += 50;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, 3000));
    TEST_ASSERT_NOT_EQUAL(time_of(ARGUS_SESSION_DID_OPEN), time_of(ARGUS_SESSION_GOT_SIP));
}

void test_a_robot_that_opens_but_never_reports_is_tried_again(void) {
    argus_session_link_up(&session, now());
    while (robot.state != OPENED) {
        turn();
    }
    const uint32_t opened_ms = time_ms;
    robot.mute = true;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_NO_ANSWER, 10000));
    TEST_ASSERT_UINT32_WITHIN(3 * tick_ms, opened_ms + 4000, time_of(ARGUS_SESSION_NO_ANSWER));
    robot.mute = false;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 3000));
}

void test_a_configpac_of_any_length_does_no_harm(void) {
    static uint8_t long_config[195];
    memcpy(long_config, example_config, sizeof example_config);
    robot.config = long_config;
    for (robot.config_count = 1; robot.config_count < sizeof long_config; robot.config_count++) {
        const size_t count = robot.config_count;
        setUp();
        robot.config = long_config;
        robot.config_count = count;
        connect();
        TEST_ASSERT_EQUAL(count >= 26, session.has_robot);
        TEST_ASSERT_EQUAL(count >= 98 ? 0 : 1, logged(ARCOS_CMD_SONAR_CYCLE));
    }
}

void test_the_sonar_cycle_is_sent_when_it_differs(void) {
    config.sonar_cycle_ms = 30;
    connect();
    TEST_ASSERT_EQUAL(1, logged(ARCOS_CMD_SONAR_CYCLE));
}

void test_a_bare_echo_of_sync2_is_enough(void) {
    robot.identity_count = 0;
    connect();
    TEST_ASSERT_EQUAL_STRING("p3dx-sh", session.subclass);
    TEST_ASSERT_EQUAL_STRING("P3DX_0001", session.name);
    TEST_ASSERT_EQUAL_STRING("Pioneer", session.robot_class);
}

void test_the_identity_comes_from_sync2_when_there_is_no_configpac(void) {
    robot.config = NULL;
    connect();
    TEST_ASSERT_EQUAL_STRING("p3dx-sh", session.subclass);
    TEST_ASSERT_EQUAL_STRING("P3DX_0001", session.name);
    TEST_ASSERT_EQUAL_STRING("Pioneer", session.robot_class);
}

void test_the_subclass_decides_the_unit(void) {
    static const struct {
        const char *subclass;
        int32_t unit_um;
    } cases[] = {{"p3dx-sh", 750}, {"P3DX-SH", 750},  {"p3dx", 485},    {"P3DX", 485},
                 {"p3dx-s", 750},  {"p3dx-shx", 750}, {"p3at-sh", 750}, {"", 750}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        strcpy(session.subclass, cases[i].subclass);
        TEST_ASSERT_EQUAL_MESSAGE(cases[i].unit_um, argus_session_distance_um(&session, 750),
                                  cases[i].subclass);
    }
}

// ------------------------------------------------------------------------------------------------ keeping it

void test_the_robot_hears_something_every_pulse_ms(void) {
    connect();
    const size_t from = robot.logged;
    run_until(time_ms + 20000);
    for (size_t i = from; i < robot.logged; i++) {
        const uint32_t gap = robot.log[i].at_ms - robot.log[i - 1].at_ms;
        TEST_ASSERT_EQUAL(ARCOS_CMD_PULSE, robot.log[i].command);
        TEST_ASSERT_UINT32_WITHIN(tick_ms, 500,
                                  gap); // not later than the watchdog wants, not more than is needed
    }
    TEST_ASSERT_GREATER_THAN(from + 35, robot.logged);
}

void test_commands_take_the_place_of_pulses(void) {
    connect();
    const size_t pulses = logged(ARCOS_CMD_PULSE);
    for (int i = 0; i < 50; i++) {
        argus_outbox_int(&session.outbox, ARCOS_CMD_SETV, 100);
        run_until(time_ms + 300);
    }
    TEST_ASSERT_EQUAL(pulses, logged(ARCOS_CMD_PULSE));
}

void test_three_sips_in_one_read_are_three_sips(void) {
    uint8_t bytes[200];
    size_t count = 0;
    connect();
    for (uint8_t i = 1; i <= 3; i++) {
        uint8_t data[32];
        count +=
            argus_frame_encode(bytes + count, sizeof bytes - count, data, sip_data(data, (uint8_t)(100 + i)));
    }
    size_t at = 0;
    for (uint8_t i = 1; i <= 3; i++) {
        size_t taken = 0;
        TEST_ASSERT_EQUAL(ARGUS_SESSION_GOT_SIP,
                          argus_session_receive(&session, &config, now(), bytes + at, count - at, &taken));
        TEST_ASSERT_EQUAL(100 + i, session.sip.x_raw);
        at += taken;
    }
    TEST_ASSERT_EQUAL(count, at);
}

// Behind a header with a false COUNT three SIPs become complete at once: none may be overwritten unseen.
void test_sips_released_together_come_out_one_by_one(void) {
    uint8_t bytes[260] = {0xFA, 0xFB, 60, 0x44};
    size_t count = 4;
    connect();
    for (uint8_t i = 1; i <= 3; i++) {
        uint8_t data[32];
        count +=
            argus_frame_encode(bytes + count, sizeof bytes - count, data, sip_data(data, (uint8_t)(100 + i)));
    }
    const unsigned before = count_of(ARGUS_SESSION_GOT_SIP);
    receive(bytes, count);
    TEST_ASSERT_EQUAL(before + 3, count_of(ARGUS_SESSION_GOT_SIP));
    TEST_ASSERT_EQUAL(103, session.sip.x_raw);
}

void test_a_sip_wrong_inside_is_counted_and_not_reported(void) {
    uint8_t data[32];
    uint8_t packet[60];
    connect();
    const unsigned before = count_of(ARGUS_SESSION_GOT_SIP);
    sip_data(data, 1);
    data[19] = 200; // readings that are not there
    receive(packet, argus_frame_encode(packet, sizeof packet, data, sizeof data));
    TEST_ASSERT_EQUAL(1, session.bad_sips);
    TEST_ASSERT_EQUAL(before, count_of(ARGUS_SESSION_GOT_SIP));
}

void test_a_stall_is_said_once_and_resumed_with_zero_set_points(void) {
    connect();
    run_until(2000);
    const uint32_t heard_ms = time_of(ARGUS_SESSION_GOT_SIP);
    const size_t from = robot.logged;
    robot.mute = true;
    run_until(heard_ms + 2000);
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_STALL));
    TEST_ASSERT_UINT32_WITHIN(tick_ms, heard_ms + 600, time_of(ARGUS_SESSION_DID_STALL));
    const size_t resumed = robot.logged;
    argus_outbox_int(&session.outbox, ARCOS_CMD_MOVE, 500);
    robot.mute = false;
    robot.sip_due_ms = time_ms + 20;
    while (count_of(ARGUS_SESSION_DID_RESUME) == 0 && time_ms < heard_ms + 2500) {
        turn();
    }
    TEST_ASSERT_EQUAL(time_of(ARGUS_SESSION_DID_RESUME), time_of(ARGUS_SESSION_GOT_SIP));
    TEST_ASSERT_UINT32_WITHIN(tick_ms, time_ms - tick_ms - heard_ms, session.gap_ms);
    for (size_t i = from; i < resumed; i++) { // until STOP was heard a PULSE could set the robot moving again
        const bool stalled = robot.log[i].at_ms >= heard_ms + 600;
        TEST_ASSERT_TRUE(!stalled || robot.log[i].command != ARCOS_CMD_PULSE ||
                         robot.log[i - 1].command == ARCOS_CMD_STOP);
    }
    const entry_t zero[] = {{ARCOS_CMD_VEL, 0, 0}, {ARCOS_CMD_RVEL, 0, 0}};
    assert_log(robot.logged - 2, zero, 2);
    run_until(time_ms + 3000);
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_STALL));
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_RESUME));
}

void test_what_moves_and_waits_during_a_stall_is_dropped_on_resuming(void) {
    uint8_t data[32];
    uint8_t packet[60];
    connect();
    const size_t total = argus_frame_encode(packet, sizeof packet, data, sip_data(data, 1));
    robot.mute = true;
    run_until(time_ms + 1000);
    argus_outbox_int(&session.outbox, ARCOS_CMD_MOVE, 500);
    receive(packet, total);
    const size_t from = robot.logged;
    client_turn();
    TEST_ASSERT_EQUAL(ARCOS_CMD_VEL, robot.log[from].command);
    TEST_ASSERT_EQUAL(0, logged(ARCOS_CMD_MOVE));
}

// Our own host stood still: the SIPs of 3 s come in one read, and no timer has seen the gap.
void test_a_gap_that_no_timer_saw_is_said_with_its_end(void) {
    uint8_t bytes[2000];
    size_t count = 0;
    size_t taken = 0;
    connect();
    const uint32_t heard_ms = time_of(ARGUS_SESSION_GOT_SIP);
    argus_outbox_int(&session.outbox, ARCOS_CMD_MOVE, 500);
    for (uint8_t i = 1; i <= 30; i++) {
        uint8_t data[32];
        count += argus_frame_encode(bytes + count, sizeof bytes - count, data, sip_data(data, i));
    }
    time_ms = heard_ms + 3000;
    TEST_ASSERT_EQUAL_HEX(ARGUS_SESSION_GOT_SIP | ARGUS_SESSION_DID_STALL | ARGUS_SESSION_DID_RESUME,
                          argus_session_receive(&session, &config, now(), bytes, count, &taken));
    TEST_ASSERT_EQUAL(3000, session.gap_ms);
    argus_outbox_urgent(&session.outbox, ARCOS_CMD_STOP); // must not overtake
    receive(bytes + taken, count - taken);
    TEST_ASSERT_EQUAL(30, session.sip.x_raw);
    TEST_ASSERT_EQUAL(0, count_of(ARGUS_SESSION_DID_STALL)); // none in the other 29
    const size_t from = robot.logged;
    client_turn();
    const entry_t wanted[] = {{ARCOS_CMD_VEL, 0, 0}, {ARCOS_CMD_RVEL, 0, 0}, {ARCOS_CMD_STOP, 0, 0}};
    assert_log(from, wanted, 3);
    TEST_ASSERT_EQUAL(0, logged(ARCOS_CMD_MOVE));
}

void test_e_stop_alone_overtakes_the_zeros_after_a_gap(void) {
    uint8_t data[32];
    uint8_t packet[60];
    connect();
    const size_t total = argus_frame_encode(packet, sizeof packet, data, sip_data(data, 1));
    robot.mute = true;
    run_until(time_ms + 1000);
    receive(packet, total);
    argus_outbox_urgent(&session.outbox, ARCOS_CMD_STOP);
    argus_outbox_urgent(&session.outbox, ARCOS_CMD_E_STOP);
    const size_t from = robot.logged;
    client_turn();
    const entry_t wanted[] = {
        {ARCOS_CMD_E_STOP, 0, 0}, {ARCOS_CMD_VEL, 0, 0}, {ARCOS_CMD_RVEL, 0, 0}, {ARCOS_CMD_STOP, 0, 0}};
    assert_log(from, wanted, 4);
}

void test_the_zeros_of_a_gap_do_not_outlive_the_session(void) {
    uint8_t data[32];
    uint8_t packet[60];
    connect();
    const size_t total = argus_frame_encode(packet, sizeof packet, data, sip_data(data, 1));
    robot.mute = true;
    run_until(time_ms + 1000);
    receive(packet, total);
    argus_session_link_down(&session);
    robot.mute = false;
    robot.state = WAIT;
    robot.out_count = 0;
    argus_session_link_up(&session, now());
    const size_t from = robot.logged;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 5000));
    turn();
    assert_log(from, greeting, GREETING);
    assert_log(from + GREETING, set_up, SET_UP);
}

// What listening hears of an old session is reported, so that the pose catches up.
void test_the_sip_of_an_old_session_is_reported(void) {
    robot.state = OPENED;
    argus_session_link_up(&session, now());
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_DISLODGE, 1000));
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_GOT_SIP));
    TEST_ASSERT_EQUAL(time_of(ARGUS_SESSION_DID_DISLODGE), time_of(ARGUS_SESSION_GOT_SIP));
    TEST_ASSERT_EQUAL(robot.sips, session.sip.x_raw);
}

void test_a_lost_link_is_said_and_the_robot_found_again(void) {
    connect();
    run_until(2000);
    robot.mute = robot.deaf = true;
    const uint32_t heard_ms = time_of(ARGUS_SESSION_GOT_SIP);
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_LOSE, 8000));
    TEST_ASSERT_UINT32_WITHIN(tick_ms, heard_ms + 4000, time_of(ARGUS_SESSION_DID_LOSE));
    TEST_ASSERT_UINT32_WITHIN(tick_ms, 4000, session.gap_ms);
    TEST_ASSERT_FALSE(argus_session_is_open(&session));
    run_until(12000);
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_LOSE));
    robot.mute = robot.deaf = false; // the robot still is in the old session
    robot.sip_due_ms = time_ms;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 10000));
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_DISLODGE));
    TEST_ASSERT_EQUAL(2, count_of(ARGUS_SESSION_DID_OPEN));
}

void test_another_packet_during_a_stall_is_no_reset(void) {
    const uint8_t iopac[] = {ARCOS_TYPE_IOPAC, 0, 0, 0};
    connect();
    robot.sip_due_ms = time_ms + 1500;
    run_until(time_ms + 1000);
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_STALL));
    robot_says(iopac, sizeof iopac);
    run_until(time_ms + 1000);
    TEST_ASSERT_EQUAL(0, count_of(ARGUS_SESSION_DID_LOSE));
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_RESUME));
}

void test_what_the_last_robot_said_of_itself_is_forgotten(void) {
    connect();
    TEST_ASSERT_TRUE(session.has_robot);
    argus_session_link_down(&session);
    robot.state = WAIT;
    robot.config = NULL;
    argus_session_link_up(&session, now());
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 5000));
    TEST_ASSERT_FALSE(session.has_robot);
    TEST_ASSERT_EQUAL(0, session.robot.sonar_cycle_ms);
}

void test_a_robot_switched_off_and_on_is_noticed_by_its_echo(void) {
    connect();
    run_until(2000);
    robot.state = WAIT;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_LOSE, 3500));
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 3000));
    TEST_ASSERT_EQUAL(0, count_of(ARGUS_SESSION_DID_DISLODGE));
}

void test_a_reset_notice_ends_the_session(void) {
    for (unsigned type = 0xFE; type <= 0xFF; type++) {
        setUp();
        connect();
        const uint8_t notice = (uint8_t)type;
        const uint32_t heard_ms = time_of(ARGUS_SESSION_GOT_SIP);
        robot.sip_due_ms = time_ms + 50;
        run_until(time_ms + 30);
        robot_says(&notice, 1);
        robot.state = WAIT;
        turn();
        TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_LOSE));
        TEST_ASSERT_EQUAL(time_ms - tick_ms - heard_ms, session.gap_ms);
        TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 3000));
    }
}

void test_other_packets_are_counted_and_change_nothing(void) {
    connect();
    for (unsigned type = 0; type < 256; type++) {
        const uint8_t data[2] = {(uint8_t)type, 0};
        if (type == 0x32 || type == 0x33 || type >= 0xFE) {
            continue;
        }
        robot_says(data, sizeof data);
        turn();
        TEST_ASSERT_TRUE(argus_session_is_open(&session));
    }
    TEST_ASSERT_EQUAL(252, session.unknown_packets); // a CONFIGpac without strings is one of them
    TEST_ASSERT_EQUAL(0, seen & (ARGUS_SESSION_DID_LOSE | ARGUS_SESSION_DID_STALL));
}

void test_the_transport_can_go_and_come_at_any_moment(void) {
    for (uint32_t cut_ms = 0; cut_ms < 1500; cut_ms += 10) {
        setUp();
        argus_session_link_up(&session, now());
        run_until(cut_ms);
        receive((const uint8_t[]){0xFA, 0xFB, 20}, 3); // the cut goes through a packet
        argus_session_link_down(&session);
        TEST_ASSERT_EQUAL(0, session.parser.length);
        robot.out_count = 0;
        const size_t before = robot.logged;
        run_until(cut_ms + 500);
        TEST_ASSERT_EQUAL(before, robot.logged);
        argus_session_link_up(&session, now());
        snprintf(message, sizeof message, "cut at %u ms", (unsigned)cut_ms);
        TEST_ASSERT_TRUE_MESSAGE(run_until_seen(ARGUS_SESSION_DID_OPEN, time_ms + 5000), message);
        TEST_ASSERT_EQUAL_MESSAGE(1, session.attempts, message);
    }
}

// What the manager queues while nothing may be said must not reach a robot that waits for SYNC0.
void test_nothing_but_the_greeting_reaches_a_waiting_robot(void) {
    argus_session_link_up(&session, now());
    while (!argus_session_is_open(&session) && time_ms < 3000) {
        if (session.state == ARGUS_SESSION_LISTEN || session.state == ARGUS_SESSION_PAUSE) {
            argus_outbox_urgent(&session.outbox, ARCOS_CMD_STOP);
            argus_outbox_int(&session.outbox, ARCOS_CMD_MOVE, 100);
        }
        turn();
    }
    assert_log(0, greeting, GREETING);
}

// ------------------------------------------------------------------------------------------------ leaving

void test_leaving_is_in_order_and_said_once(void) {
    const entry_t farewell[] = {
        {ARCOS_CMD_SONAR, 0, 0}, {ARCOS_CMD_STOP, 0, 0}, {ARCOS_CMD_ENABLE, 0, 0}, {ARCOS_CMD_CLOSE, 0, 0}};
    connect();
    argus_outbox_int(&session.outbox, ARCOS_CMD_MOVE, 500);
    const size_t from = robot.logged;
    argus_session_leave(&session, now());
    argus_session_leave(&session, now());
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_CLOSE, time_ms + 1000));
    TEST_ASSERT_GREATER_OR_EQUAL(robot.log[from].at_ms + 100, time_of(ARGUS_SESSION_DID_CLOSE));
    run_until(time_ms + 10000);
    assert_log(from, farewell, 4);
    TEST_ASSERT_EQUAL(from + 4, robot.logged);
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_CLOSE));
    argus_session_link_up(&session, now());
    run_until(time_ms + 3000);
    TEST_ASSERT_EQUAL(from + 4, robot.logged);
}

void test_leaving_waits_for_the_last_byte_on_the_wire(void) {
    connect();
    argus_session_leave(&session, now());
    for (int i = 0; i < 50; i++) { // the link takes nothing for half a second
        time_ms += 10;
        note(argus_session_process(&session, &config, now()));
    }
    const uint32_t sent_ms = time_ms;
    TEST_ASSERT_TRUE(run_until_seen(ARGUS_SESSION_DID_CLOSE, time_ms + 1000));
    TEST_ASSERT_GREATER_OR_EQUAL(sent_ms + 100, time_of(ARGUS_SESSION_DID_CLOSE));
    TEST_ASSERT_EQUAL(ARCOS_CMD_CLOSE, robot.log[robot.logged - 1].command);
}

void test_leaving_ends_from_any_moment_and_leaves_no_session_behind(void) {
    for (uint32_t leave_ms = 0; leave_ms < 1500; leave_ms += 10) {
        for (int old = 0; old < 2; old++) {
            setUp();
            robot.state = old ? OPENED : WAIT;
            argus_session_link_up(&session, now());
            run_until(leave_ms);
            argus_session_leave(&session, now());
            snprintf(message, sizeof message, "left at %u ms, old session %d", (unsigned)leave_ms, old);
            TEST_ASSERT_TRUE_MESSAGE(run_until_seen(ARGUS_SESSION_DID_CLOSE, leave_ms + 1700), message);
            TEST_ASSERT_TRUE_MESSAGE(robot.state != OPENED || logged(ARCOS_CMD_CLOSE) == 0, message);
        }
    }
}

void test_leaving_without_a_transport_ends_too(void) {
    argus_session_leave(&session, now());
    TEST_ASSERT_EQUAL(ARGUS_SESSION_DID_CLOSE, argus_session_process(&session, &config, now()));
    setUp();
    connect();
    argus_session_leave(&session, now());
    argus_session_link_down(&session);
    TEST_ASSERT_EQUAL(ARGUS_SESSION_DID_CLOSE, argus_session_process(&session, &config, now()));
    setUp();
    connect();
    argus_session_leave(&session, now()); // nobody fetches what waits: it must end all the same
    for (int i = 0; i < 200; i++) {
        time_ms += 10;
        note(argus_session_process(&session, &config, now()));
    }
    TEST_ASSERT_EQUAL(1, count_of(ARGUS_SESSION_DID_CLOSE));
}

// ------------------------------------------------------------------------------------------------ anything

// The vendor's emulator, as recorded: its answers come whatever we say; it calls itself a p3dx.
void test_a_recorded_conversation_opens(void) {
    static captures_t stream;
    memset(&stream, 0, sizeof stream);
    captures_load(&stream, "a_idle", "r2c");
    argus_session_link_up(&session, now());
    robot.dead = true;
    run_until(260);
    for (size_t i = 0; i < 60; i++) {
        receive(stream.bytes + stream.at[i], stream.total[i]);
        client_turn();
        time_ms += 100;
    }
    TEST_ASSERT_TRUE(argus_session_is_open(&session));
    TEST_ASSERT_EQUAL_STRING("MobileSim", session.name);
    TEST_ASSERT_EQUAL(485, argus_session_distance_um(&session, 1000));
    TEST_ASSERT_EQUAL(16, session.sip.sonar_count);
    TEST_ASSERT_GREATER_THAN(50, count_of(ARGUS_SESSION_GOT_SIP));
}

static size_t nasty(random_t *random, uint8_t *out) {
    static const uint8_t types[] = {0, 1, 2, 0x20, 0x32, 0x33, 0x32, 0xFE, 0xFF, 0x90};
    uint8_t data[195];
    const size_t count = 1 + random_below(random, 60);
    for (size_t i = 0; i < count; i++) {
        data[i] = (uint8_t)random_below(random, random_below(random, 4) ? 4 : 256);
    }
    data[0] = types[random_below(random, sizeof types)];
    if (count >= 11 && random_below(random, 2) == 0) {
        memset(&data[7], 0, 4); // of a SIP the wheels: a robot at rest is dislodged at once
    }
    const size_t total = argus_frame_encode(out, ARCOS_FRAME_SEND_TOTAL_MAX, data, count);
    if (random_below(random, 4) == 0) {
        out[random_below(random, (uint32_t)total)] ^= (uint8_t)random_below(random, 256);
    }
    return random_below(random, 5) ? total : random_below(random, (uint32_t)total) + 1;
}

void test_ten_million_hostile_bytes_are_survived(void) {
    unsigned ever = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        random_t random = random_seed(seed);
        size_t bytes = 0;
        setUp();
        robot.deaf = true;
        argus_session_link_up(&session, now());
        while (bytes < 1000000) {
            uint8_t packet[ARCOS_FRAME_SEND_TOTAL_MAX];
            const size_t total = nasty(&random, packet);
            receive(packet, total);
            client_turn();
            robot.logged = 0;
            bytes += total;
            time_ms += random_below(&random, random_below(&random, 50) ? 40 : 3000);
            snprintf(message, sizeof message, "seed %llu after %zu bytes", (unsigned long long)seed, bytes);
            TEST_ASSERT_TRUE_MESSAGE(
                session.state > ARGUS_SESSION_DOWN && session.state <= ARGUS_SESSION_OPEN, message);
            TEST_ASSERT_EQUAL_MESSAGE(0, session.outbox.length, message);
            if (random_below(&random, 3000) == 0) {
                argus_session_link_down(&session);
                argus_session_link_up(&session, now());
            }
        }
        ever |= seen;
    }
    const unsigned wanted = ARGUS_SESSION_GOT_SIP | ARGUS_SESSION_DID_OPEN | ARGUS_SESSION_DID_LOSE |
                            ARGUS_SESSION_DID_STALL | ARGUS_SESSION_DID_RESUME | ARGUS_SESSION_NO_ANSWER |
                            ARGUS_SESSION_DID_DISLODGE;
    TEST_ASSERT_EQUAL_HEX_MESSAGE(wanted, ever & wanted, "the bytes do not reach every reaction");
}

// After any hostile prefix a good robot is opened.
void test_after_any_garbage_a_good_robot_is_found(void) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        random_t random = random_seed(seed);
        setUp();
        argus_session_link_up(&session, now());
        for (int i = 0; i < 200; i++) {
            uint8_t packet[ARCOS_FRAME_SEND_TOTAL_MAX];
            receive(packet, nasty(&random, packet));
            client_turn();
            robot.out_count = 0;
            time_ms += random_below(&random, 40);
        }
        snprintf(message, sizeof message, "seed %llu", (unsigned long long)seed);
        run_until(time_ms + 20000);
        TEST_ASSERT_TRUE_MESSAGE(argus_session_is_open(&session), message);
    }
}

// ------------------------------------------------------------------------------------------------ leaving

// SIPs that still come so long after the last word tell that CLOSE did not arrive.
static uint16_t waiting_after_sip(uint32_t after_ms, uint8_t type) {
    uint8_t data[32];
    uint8_t packet[64];
    argus_session_init(&session);
    session.state = ARGUS_SESSION_LEAVING;
    session.spoke_ms = now() - after_ms;
    robot.sip_type = 0x32;
    sip_data(data, 1);
    data[0] = type;
    const size_t count = argus_frame_encode(packet, sizeof packet, data, sizeof data);
    size_t taken = 0;
    argus_session_receive(&session, &config, now(), packet, count, &taken);
    argus_session_process(&session, &config, now());
    return session.outbox.length;
}

void test_a_close_that_got_lost_is_said_again(void) {
    TEST_ASSERT_EQUAL(0, waiting_after_sip(149, 0x32));
    TEST_ASSERT_EQUAL(0, waiting_after_sip(150, 0x90)); // no SIP
    TEST_ASSERT_GREATER_THAN(0, waiting_after_sip(150, 0x32));
    TEST_ASSERT_EQUAL(ARCOS_CMD_STOP, argus_outbox_first(&session.outbox));
}

void test_what_is_left_is_left_once(void) {
    connect();
    argus_session_leave(&session, now());
    TEST_ASSERT_EQUAL(ARGUS_SESSION_LEAVING, session.state);
    const uint16_t length = session.outbox.length;
    argus_session_leave(&session, now());
    TEST_ASSERT_EQUAL(length, session.outbox.length);
    TEST_ASSERT_EQUAL(0, argus_session_observe(&session, &config, now())); // nobody is observed any more
    session.state = ARGUS_SESSION_CLOSED;
    argus_session_leave(&session, now());
    TEST_ASSERT_EQUAL(ARGUS_SESSION_CLOSED, session.state);
    TEST_ASSERT_EQUAL(0, argus_session_observe(&session, &config, now()));
}

// The zeros after a gap wait for room.
void test_zeros_that_do_not_fit_are_still_due(void) {
    uint8_t packet[16];
    connect();
    argus_outbox_clear(&session.outbox);
    session.zeros_due = 2;
    TEST_ASSERT_EQUAL(0, argus_session_transmit(&session, now(), packet, 3));
    TEST_ASSERT_EQUAL(2, session.zeros_due);
    TEST_ASSERT_EQUAL(9, argus_session_transmit(&session, now(), packet, sizeof packet));
    TEST_ASSERT_EQUAL(1, session.zeros_due);
}

void test_attempts_are_counted_to_their_most(void) {
    argus_session_init(&session);
    argus_session_link_up(&session, now());
    TEST_ASSERT_EQUAL(1, session.attempts);
    session.attempts = UINT16_MAX;
    session.state = ARGUS_SESSION_PAUSE;
    time_ms += 60000;
    argus_session_process(&session, &config, now());
    TEST_ASSERT_EQUAL(ARGUS_SESSION_LISTEN, session.state);
    TEST_ASSERT_EQUAL(UINT16_MAX, session.attempts);
}

// Each of the two ends a pause, whichever is the shorter.
void test_a_pause_ends_with_the_shorter_of_its_own_and_the_longest(void) {
    static const struct {
        uint32_t pause_ms;
        int32_t longest_ms;
        uint32_t ends_ms;
    } rows[] = {{500, 8000, 500}, {8000, 500, 500}};
    for (unsigned i = 0; i < 2; i++) {
        argus_session_init(&session);
        session.state = ARGUS_SESSION_PAUSE;
        session.since_ms = now();
        session.pause_ms = rows[i].pause_ms;
        config.retry_max_ms = rows[i].longest_ms;
        argus_session_process(&session, &config, now() + rows[i].ends_ms - 1);
        TEST_ASSERT_EQUAL(ARGUS_SESSION_PAUSE, session.state);
        argus_session_process(&session, &config, now() + rows[i].ends_ms);
        TEST_ASSERT_EQUAL(ARGUS_SESSION_LISTEN, session.state);
    }
}

// It leaves once nothing waits, and neither its last word nor the leave itself is younger than that.
void test_leaving_takes_its_time_since_the_word_and_since_the_leave(void) {
    for (uint32_t spoke_ms = 0; spoke_ms <= 400; spoke_ms += 50) {
        for (uint32_t left_ms = 0; left_ms <= 400; left_ms += 50) {
            argus_session_init(&session);
            session.state = ARGUS_SESSION_LEAVING;
            session.spoke_ms = now() - spoke_ms;
            session.since_ms = now() - left_ms;
            argus_session_process(&session, &config, now());
            TEST_ASSERT_EQUAL(spoke_ms >= 250 && left_ms >= 250, session.state == ARGUS_SESSION_CLOSED);
        }
    }
}

// A packet that broke off hides a whole SIP: silence shows it, without another byte.
void test_a_sip_inside_a_packet_that_broke_off_comes_with_time(void) {
    uint8_t data[32];
    uint8_t bytes[80] = {0xFA, 0xFB, 200, 0x20};
    connect();
    robot.sip_type = 0x32;
    sip_data(data, 1);
    const size_t count = 4 + argus_frame_encode(bytes + 4, sizeof bytes - 4, data, sizeof data);
    size_t taken = 0;
    const uint32_t sips = session.sips;
    TEST_ASSERT_EQUAL(0, argus_session_receive(&session, &config, now(), bytes, count, &taken));
    TEST_ASSERT_EQUAL(count, taken);
    TEST_ASSERT_EQUAL(0, argus_session_process(&session, &config, now() + 10) & ARGUS_SESSION_GOT_SIP);
    TEST_ASSERT_TRUE((argus_session_process(&session, &config, now() + 60) & ARGUS_SESSION_GOT_SIP) != 0);
    TEST_ASSERT_EQUAL(sips + 1, session.sips);
}
