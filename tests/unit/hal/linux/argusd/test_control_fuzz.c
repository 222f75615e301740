// SPDX-License-Identifier: MIT
// Rule under attack: whatever lines come, valid, mutated or random, argusd lives, each reply is one JSON
// object, and nothing that was not entitled, or was said before, moves the robot.
#include <stdlib.h>

#include "control_bench.h"
#include "json_read.h"

#define MANY 1000000u
#define FEW 20000u

static bench_client_t holder;   // has control, and gave orders that somebody recorded
static bench_client_t watcher;  // authenticated, without control
static bench_client_t stranger; // does not know the token
static uint32_t seed;
static char recorded[4][256];

static uint32_t below(uint32_t bound) {
    seed = seed * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(seed >> 8) * bound >> 24);
}

static const char *const templates[] = {
    "{\"do\":\"hello\",\"id\":1}",
    "{\"do\":\"watch\",\"topics\":[\"events\",\"state\",\"readings\",\"evidence\"],\"period_ms\":50}",
    "{\"do\":\"status\",\"id\":\"\\u00e9\"}",
    "{\"do\":\"release\"}",
    "{\"do\":\"order\",\"order\":\"stop\"}",
    "{\"do\":\"order\",\"grant\":\"00112233445566778899aabbccddeeff\",\"seq\":1,\"order\":\"go\"}",
    "{\"do\":\"order\",\"grant\":\"\",\"seq\":9007199254740991,\"order\":\"turn\",\"deg\":-180}",
    "{\"do\":\"order\",\"grant\":\"x\",\"seq\":2,\"order\":\"step\",\"way\":\"ahead\"}",
    "{\"do\":\"order\",\"seq\":3,\"order\":\"goto\",\"x_mm\":30000,\"y_mm\":-30000}",
    "{\"do\":\"order\",\"seq\":4,\"order\":\"course\",\"points\":[[1,2],[3,4],[500,600]]}",
    "{\"do\":\"order\",\"seq\":5,\"order\":\"fail\",\"sonar\":3,\"kind\":\"stuck\",\"for_ms\":1000}",
    "{\"do\":\"order\",\"order\":\"active\"}",
    "{\"do\":\"order\",\"order\":\"quit\"}",
};
#define TEMPLATES (sizeof templates / sizeof templates[0])

static const char *const pieces[] = {
    "{",          "}",     "[",   "]",    "\"",   ":",       ",",          "\\u0000",
    "\\ud800",    "1e999", "-",   "null", "true", "\"do\":", "\"grant\":", "\"order\":\"go\"",
    "\"seq\":99", "[[[[[", "\x80"};

static size_t mutate(char *line, size_t length) {
    for (uint32_t times = 1 + below(4); times > 0 && length > 0; times--) {
        const size_t at = below((uint32_t)length);
        switch (below(5)) {
        case 0:
            line[at] = (char)below(256);
            break;
        case 1:
            line[at] = (char)(line[at] ^ 1 << below(8));
            break;
        case 2: // a part is gone
            length = at + below((uint32_t)(length - at) + 1);
            break;
        case 3: // a piece is put over
        {
            const char *const piece = pieces[below(sizeof pieces / sizeof pieces[0])];
            const size_t size = strlen(piece);
            if (length + size < 400) {
                memmove(line + at + size, line + at, length - at);
                memcpy(line + at, piece, size);
                length += size;
            }
            break;
        }
        default: // a part comes twice
            if (length + (length - at) < 400) {
                memcpy(line + length, line + at, length - at);
                length += length - at;
            }
            break;
        }
    }
    return length;
}

static size_t make_message(char *line) {
    size_t length = 0;
    if (below(10) == 0) {
        for (length = 0; length < 1 + below(300); length++) {
            line[length] = (char)below(256);
        }
    } else {
        const char *const base = templates[below(TEMPLATES)];
        length = strlen(base);
        memcpy(line, base, length);
        length = below(4) == 0 ? length : mutate(line, length);
    }
    line[length++] = '\n';
    return length;
}

// What the manager was asked for since: how many orders other than STOP; `stops` of those.
static int orders_taken(int *stops) {
    argus_event_t event;
    int orders = 0;
    while (argus_next_event(&bench_robot.argus, &event)) {
        if (event.id == ARGUS_EV_OPERATOR) {
            orders += event.value != ARGUS_OP_STOP;
            *stops += event.value == ARGUS_OP_STOP;
        }
        orders += event.id == ARGUS_EV_MISSION_START;
    }
    return orders;
}

static void check_replies(bench_client_t *client) {
    static json_doc_t doc;
    client->used = 0;
    (void)bench_hear(client);
    for (char *at = client->text; *at != '\0';) {
        char *const end = strchr(at, '\n');
        if (end == NULL) {
            return; // the rest comes later
        }
        const bool whole = at != client->text || *at == '{'; // its beginning may have been taken before
        TEST_ASSERT_TRUE_MESSAGE(!whole || json_read(&doc, at, (size_t)(end - at)), at);
        at = end + 1;
    }
}

static void admit(bench_client_t *client, bool authentic) {
    bench_connect(client);
    if (authentic) {
        bench_expect(client, "{\"do\":\"hello\",\"token\":\"" BENCH_TOKEN "\"}", "\"ok\":true");
    }
}

static void readmit_if_closed(bench_client_t *client, bool authentic) {
    if (!bench.client[client->place].on) {
        bench_end(client);
        admit(client, authentic);
    }
}

// Valid orders of the holder that moved nothing yet are recorded as they went over the wire.
static void record_orders(void) {
    static const char *const orders[] = {"\"recheck\"", "\"pin\",\"sonar\":9", "\"unpin\",\"sonar\":9",
                                         "\"active\""};
    for (int i = 0; i < 4; i++) {
        snprintf(recorded[i], sizeof recorded[i],
                 "{\"do\":\"order\",\"grant\":\"%s\",\"seq\":%d,\"order\":%s}", bench.grant, 1000 + i,
                 orders[i]);
        bench_expect(&holder, recorded[i], "\"ok\":true");
    }
}

// Until no line waits: a message may hold several.
static void serve_all(void) {
    do {
        control_serve(&bench, &bench_moment);
    } while (control_tell(&bench, &bench_moment) == 0);
}

static void send_one(uint32_t number) {
    char line[512];
    const uint32_t who = below(3);
    bench_client_t *const client = who == 0 ? &stranger : who == 1 ? &watcher : &holder;
    size_t length = 0;
    if (who == 2 || below(8) == 0) { // a replay, on its own connection or on another's
        length = (size_t)snprintf(line, sizeof line, "%s\n", recorded[below(4)]);
    } else {
        length = make_message(line);
    }
    (void)!send(client->fd, line, length, MSG_DONTWAIT | MSG_NOSIGNAL);
    int stops = 0;
    serve_all();
    const int orders = orders_taken(&stops);
    char what[640];
    snprintf(what, sizeof what, "message %u moved something: %.*s", (unsigned)number, (int)length, line);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, orders, what);
    TEST_ASSERT_TRUE_MESSAGE(stops == 0 || who != 0, what);
    TEST_ASSERT_FALSE_MESSAGE(control_is_quit(&bench), what);
    TEST_ASSERT_FALSE_MESSAGE(inject_is_on(&bench_inject), what);
}

static void fuzz(uint32_t messages, uint32_t from) {
    seed = from;
    bench_begin(true, true);
    admit(&holder, true);
    admit(&watcher, true);
    admit(&stranger, false);
    bench_expect(&holder, "{\"do\":\"take\"}", "\"ok\":true");
    record_orders();
    bench_run(5000);
    int stops = 0;
    (void)orders_taken(&stops);
    const double x = bench_robot.x;
    const double th = bench_robot.th;
    for (uint32_t i = 0; i < messages; i++) {
        readmit_if_closed(&stranger, false);
        readmit_if_closed(&watcher, true);
        send_one(i);
        if (i % 16 == 0) {
            check_replies(&watcher);
            check_replies(&stranger);
            check_replies(&holder);
        }
        if (i % 1024 == 0) {
            robot_run(&bench_robot, 50); // events of its own are looked at by the support
            moment_take(&bench_moment, bench_robot.argus.now_ms);
            bench_robot.events = bench_robot.commands = 0;
        }
    }
    TEST_ASSERT_TRUE(control_is_held(&bench));
    TEST_ASSERT_TRUE(bench_robot.x == x && bench_robot.th == th);
    TEST_ASSERT_EQUAL_INT(0, argus_invariants_broken(&bench_robot.argus));
    bench_end(&holder);
    bench_end(&watcher);
    bench_end(&stranger);
    bench_finish();
}

void test_a_few_messages(void) {
    fuzz(FEW, 1);
}

void test_many_messages(void) { // soak
    fuzz(MANY / 10, 3);
}

void test_a_million_messages(void) { // wide
    fuzz(MANY, 2);
}
