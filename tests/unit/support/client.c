// SPDX-License-Identifier: MIT
// Calls argus_guard_port() as argusd does.
#include "client.h"

#include <string.h>

static client_t *present;

static void keep(client_t *client, const argus_packet_t *packet) {
    client->packets++;
    if (argus_sip_decode(&client->sip, packet)) {
        client->sips++;
        return;
    }
    client->others++;
    client->count = packet->count;
    memcpy(client->data, packet->data, packet->count);
}

static void take(client_t *client, const uint8_t *bytes, size_t count) {
    argus_packet_t packet;
    const uint32_t now_ms = client->robot->start_ms + client->robot->t_ms;
    for (size_t taken = 0; taken < count;) {
        taken += argus_parser_push(&client->parser, now_ms, bytes + taken, count - taken);
        while (argus_parser_next(&client->parser, now_ms, &packet)) {
            keep(client, &packet);
        }
    }
}

// Over the line of its robot, where that has one.
static void tell(client_t *client, const uint8_t *bytes, size_t count) {
    uint8_t arrived[ROBOT_LINE_MAX];
    if (!client->robot->has_line) {
        take(client, bytes, count);
        return;
    }
    robot_put(client->robot, ROBOT_TO_CLIENT, bytes, count);
    take(client, arrived, robot_taken(client->robot, ROBOT_TO_CLIENT, arrived));
}

static void pass(client_t *client, argus_port_io_t io) {
    uint8_t out[2048];
    size_t count = 0;
    io.readings = client->readings;
    io.there = client->there;
    io.out = out;
    io.capacity = client->room > 0 ? client->room : sizeof out;
    do {
        count = argus_guard_port(&client->robot->argus, &client->storage,
                                 client->robot->start_ms + client->robot->t_ms, &io);
        tell(client, out, count);
        io.client_count = io.robot_count = 0;
    } while (count > 0 && client->room == 0);
}

static void see(robot_t *robot, const uint8_t *bytes, size_t count) {
    (void)robot;
    pass(present, (argus_port_io_t){.robot = bytes, .robot_count = count});
}

void client_init(client_t *client, robot_t *robot) {
    memset(client, 0, sizeof *client);
    client->robot = robot;
    client->there = true;
    argus_parser_init(&client->parser);
    present = client;
    robot->after = see;
}

argus_port_t *client_port(client_t *client) {
    return (argus_port_t *)&client->storage;
}

void client_bytes(client_t *client, const uint8_t *bytes, size_t count) {
    uint8_t arrived[ROBOT_LINE_MAX];
    if (client->robot->has_line) {
        robot_put(client->robot, ROBOT_TO_GUARD, bytes, count);
        count = robot_taken(client->robot, ROBOT_TO_GUARD, arrived);
        bytes = arrived;
    }
    pass(client, (argus_port_io_t){.client = bytes, .client_count = count});
    robot_drain(client->robot);
}

void client_plain(client_t *client, uint8_t command) {
    uint8_t packet[16];
    client_bytes(client, packet, argus_command_plain(packet, sizeof packet, command));
}

void client_say(client_t *client, uint8_t command, int32_t argument) {
    uint8_t packet[16];
    client_bytes(client, packet, argus_command_int(packet, sizeof packet, command, argument));
}

void client_open(client_t *client) {
    client_plain(client, ARCOS_SYNC_SYNC0);
    client_plain(client, ARCOS_SYNC_SYNC1);
    client_plain(client, ARCOS_SYNC_SYNC2);
    client_say(client, ARCOS_CMD_OPEN, 1);
    client_say(client, ARCOS_CMD_ENABLE, 1);
}

void client_leave(client_t *client) {
    client->there = false;
    client_bytes(client, NULL, 0);
}

void client_run(client_t *client, uint32_t ms, bool pulses) {
    for (uint32_t passed = 0; passed < ms; passed += 10) {
        robot_tick(client->robot);
        client_bytes(client, NULL, 0);
        if (pulses && client->robot->t_ms % 500 == 0) {
            client_plain(client, ARCOS_CMD_PULSE);
        }
    }
}
