// SPDX-License-Identifier: MIT
// The control socket round a manager with a robot in memory, its clients at the far ends of socket pairs.
#ifndef TEST_CONTROL_BENCH_H
#define TEST_CONTROL_BENCH_H

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "control.h"
#include "robot.h"
#include "unity.h"

#define BENCH_TOKEN "0123456789abcdef-token"

typedef struct {
    int place;
    int fd; // the client's end, -1: closed
    size_t used;
    char text[65536];
} bench_client_t;

static robot_t bench_robot;
static driver_t bench_driver;
static operator_t bench_operator;
static inject_t bench_inject;
static control_t bench;
static view_t bench_view;
static moment_t bench_moment;

static inline const view_t *bench_look(void *context) {
    (void)context;
    argus_status(&bench_robot.argus, &bench_view.status);
    bench_view.controlled = control_is_held(&bench);
    bench_view.t_ms = bench_moment.t_ms;
    return &bench_view;
}

// A robot that stands in a room, healthy and active; `token`: clients must say BENCH_TOKEN.
static inline void bench_begin(bool token, bool inject) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&bench_robot, &config, 0);
    bench_robot.world = robot_world_segments;
    robot_box(&bench_robot, -1500, -1600, 3200, 1400);
    TEST_ASSERT_TRUE(robot_until_mode(&bench_robot, ARGUS_MODE_IDLE, 20000));
    memset(&bench_driver, 0, sizeof bench_driver);
    bench_driver.core = &bench_robot.argus;
    operator_init(&bench_operator, &bench_driver, &config);
    inject_init(&bench_inject, inject, 1);
    memset(&bench, 0, sizeof bench);
    bench.on = true;
    bench.holder = -1;
    bench.port.fd = -1;
    bench.needs_token = token;
    bench.token.on = token;
    strcpy(bench.token.text, BENCH_TOKEN);
    const control_world_t world = {.hands = {.op = &bench_operator, .inject = &bench_inject},
                                   .look = bench_look};
    control_begin(&bench, &world);
    bench_moment = (moment_t){.now_ms = bench_robot.argus.now_ms};
}

static inline void bench_connect(bench_client_t *client) {
    int pair[2];
    TEST_ASSERT_EQUAL_INT(0, socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair));
    client->used = 0;
    client->fd = pair[1];
    client->place = control_admit(&bench, pair[0], bench_moment.now_ms);
    TEST_ASSERT_TRUE(client->place >= 0);
}

static inline void bench_serve(void) {
    control_serve(&bench, &bench_moment);
    control_tell(&bench, &bench_moment);
}

// Both clocks go on, and the robot with them.
static inline void bench_run(uint32_t ms) {
    for (uint32_t at = 0; at < ms; at += 10) {
        robot_tick(&bench_robot);
        moment_take(&bench_moment, bench_robot.argus.now_ms);
        bench_serve();
    }
}

// Takes what came; false: the connection was closed.
static inline bool bench_hear(bench_client_t *client) {
    for (;;) {
        const size_t room = sizeof client->text - 1 - client->used;
        const ssize_t got = recv(client->fd, client->text + client->used, room, MSG_DONTWAIT);
        if (got <= 0 || room == 0) {
            client->text[client->used] = '\0';
            return got != 0 || room == 0;
        }
        client->used += (size_t)got;
    }
}

// Sends a line and returns all that is said until it was looked at.
static inline const char *bench_ask(bench_client_t *client, const char *line) {
    client->used = 0;
    TEST_ASSERT_EQUAL_INT((int)strlen(line), send(client->fd, line, strlen(line), MSG_NOSIGNAL));
    TEST_ASSERT_EQUAL_INT(1, send(client->fd, "\n", 1, MSG_NOSIGNAL));
    bench_serve();
    bench_serve();
    (void)bench_hear(client);
    return client->text;
}

static inline void bench_expect(bench_client_t *client, const char *line, const char *part) {
    const char *const said = bench_ask(client, line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, part), said[0] == '\0' ? line : said);
}

// An order with the grant that is in force.
static inline const char *bench_order(bench_client_t *client, int seq, const char *order) {
    static char line[512];
    snprintf(line, sizeof line, "{\"do\":\"order\",\"grant\":\"%s\",\"seq\":%d,\"order\":%s}", bench.grant,
             seq, order);
    return bench_ask(client, line);
}

static inline void bench_end(bench_client_t *client) {
    if (client->fd >= 0) {
        close(client->fd);
        client->fd = -1;
    }
}

static inline void bench_finish(void) {
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        if (bench.client[i].on) {
            control_client_close(&bench.client[i]);
            bench.client[i].on = false;
        }
    }
}

#endif
