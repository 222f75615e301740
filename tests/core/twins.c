// SPDX-License-Identifier: MIT
// Opens the ARCOS part of the firmware to tests/core/test_arcos_twins.py as flat arrays, one call per stream.
#include <string.h>

#include "arcos/command.h"
#include "arcos/configpac.h"
#include "arcos/sip.h"

typedef struct {
    uint8_t *at;
    size_t left;
} sink_t;

// Each packet becomes: the number of the read that released it (2 bytes), its length, its data.
static void put(sink_t *sink, size_t read, const argus_packet_t *packet) {
    const size_t total = 3 + (size_t)packet->count;
    if (total > sink->left) {
        __builtin_trap();
    }
    sink->at[0] = (uint8_t)(read & 0xFF);
    sink->at[1] = (uint8_t)(read >> 8);
    sink->at[2] = packet->count;
    memcpy(sink->at + 3, packet->data, packet->count);
    sink->at += total;
    sink->left -= total;
}

static void drain(argus_parser_t *parser, uint32_t now_ms, size_t read, sink_t *sink) {
    argus_packet_t packet;
    while (argus_parser_next(parser, now_ms, &packet)) {
        put(sink, read, &packet);
    }
}

size_t twins_stream(const uint8_t *bytes, const uint32_t *ends, const uint32_t *times_ms, size_t reads,
                    uint8_t *out, size_t capacity, uint32_t counters[5]) {
    argus_parser_t parser;
    sink_t sink = {out, capacity};
    size_t at = 0;
    argus_parser_init(&parser);
    for (size_t read = 0; read < reads; read++) {
        drain(&parser, times_ms[read], read, &sink);
        while (at < ends[read]) {
            at += argus_parser_push(&parser, times_ms[read], bytes + at, ends[read] - at);
            drain(&parser, times_ms[read], read, &sink);
        }
    }
    const uint32_t values[5] = {parser.packets, parser.bad_checksums, parser.bad_counts, parser.skipped_bytes,
                                parser.timeouts};
    memcpy(counters, values, sizeof values);
    return capacity - sink.left;
}

size_t twins_sip(const uint8_t *data, uint8_t count, int32_t *out) {
    const argus_packet_t packet = {data, count};
    argus_sip_t sip;
    memset(&sip, 0xA5, sizeof sip); // what decode leaves out must show
    if (!argus_sip_decode(&sip, &packet)) {
        return 0;
    }
    const int32_t fixed[] = {sip.moving,          sip.x_raw,          sip.y_raw,        sip.heading_raw,
                             sip.vel_left_mm_s,   sip.vel_right_mm_s, sip.battery_dv,   sip.stall_left,
                             sip.stall_right,     sip.bumpers_front,  sip.bumpers_rear, sip.flags,
                             sip.has_battery_x10, sip.battery_x10_dv, sip.has_rotvel,   sip.rotvel_ddeg_s,
                             sip.has_faultflags,  sip.faultflags};
    const size_t fields = sizeof fixed / sizeof fixed[0];
    memcpy(out, fixed, sizeof fixed);
    for (size_t i = 0; i < sip.sonar_count; i++) {
        out[fields + 2 * i] = sip.sonar[i].number;
        out[fields + 2 * i + 1] = sip.sonar[i].range_mm;
    }
    return fields + 2 * (size_t)sip.sonar_count;
}

size_t twins_config(const uint8_t *data, uint8_t count, int32_t *out, char strings[5][ARGUS_NAME_MAX]) {
    const argus_packet_t packet = {data, count};
    argus_configpac_t config;
    memset(&config, 0xA5, sizeof config);
    if (!argus_configpac_decode(&config, &packet)) {
        return 0;
    }
    const int32_t fixed[] = {config.sonar_cycle_ms, config.rear_sonar,       config.low_battery_dv,
                             config.watchdog_ms,    config.rotvel_max_deg_s, config.vel_max_mm_s,
                             config.accel_mm_s2,    config.decel_mm_s2,      config.front_bumpers,
                             config.rear_bumpers};
    const char *const text[5] = {config.robot_class, config.robot_subclass, config.serial, config.name,
                                 config.version};
    memcpy(out, fixed, sizeof fixed);
    for (size_t i = 0; i < 5; i++) {
        memcpy(strings[i], text[i], ARGUS_NAME_MAX);
    }
    return sizeof fixed / sizeof fixed[0];
}

// How many of the strings behind the type byte are whole, at most 3: a SYNC2 reply has three.
size_t twins_strings(const uint8_t *data, uint8_t count, char strings[3][ARGUS_NAME_MAX]) {
    const argus_packet_t packet = {data, count};
    size_t offset = 1;
    size_t whole = 0;
    while (whole < 3 && argus_packet_string(&packet, &offset, strings[whole])) {
        whole++;
    }
    return whole;
}

size_t twins_frame(const uint8_t *data, size_t count, uint8_t *out, size_t capacity) {
    return argus_frame_encode(out, capacity, data, count);
}

size_t twins_integer(uint8_t command, int32_t argument, uint8_t *out, size_t capacity) {
    return argus_command_int(out, capacity, command, argument);
}

size_t twins_string(uint8_t command, const uint8_t *text, size_t count, uint8_t *out, size_t capacity) {
    return argus_command_string(out, capacity, command, text, count);
}
