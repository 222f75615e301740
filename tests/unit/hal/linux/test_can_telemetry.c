// SPDX-License-Identifier: MIT
// Attacks: what the frames say is what the manager knows, each in its time and never more often; only a
// fresh, intact order that was never seen before is taken.
#include <stdio.h>
#include <string.h>

#include "hal/can_telemetry.h"
#include "robot.h"
#include "unity.h"

#define MAX_FRAMES 4000

static robot_t robot;
static hal_telemetry_t telemetry;
static hal_telemetry_frame_t frames[MAX_FRAMES];
static uint32_t frame_ms[MAX_FRAMES];
static int count;
static int events_fed;

static uint32_t now_ms(void) {
    return robot.start_ms + robot.t_ms;
}

static void begin(uint8_t number, uint32_t start_ms) {
    const argus_config_t config = robot_config();
    robot_init(&robot, &config, start_ms);
    hal_telemetry_init(&telemetry, number, (uint32_t)config.stale_ms, 42, now_ms());
    count = 0;
    events_fed = 0;
}

void setUp(void) {
    begin(0, UINT32_MAX - 3000); // the clock wraps in every test
}

static const argus_status_t *seen(void) {
    static argus_status_t status;
    argus_status(&robot.argus, &status);
    return &status;
}

static void collect(void) {
    for (; events_fed < robot.events; events_fed++) {
        hal_telemetry_event(&telemetry, seen(), &robot.event[events_fed]);
    }
    while (hal_telemetry_next(&telemetry, seen(), now_ms(), &frames[count])) {
        frame_ms[count] = robot.t_ms;
        count++;
        TEST_ASSERT_LESS_THAN_INT(MAX_FRAMES, count);
    }
}

static void run(uint32_t ms) {
    for (uint32_t passed = 0; passed < ms; passed += 10) {
        robot_run(&robot, 10);
        collect();
    }
}

static int frames_of(uint16_t id, int from) {
    int found = 0;
    for (int i = from; i < count; i++) {
        found += frames[i].id == id;
    }
    return found;
}

static const uint8_t *last_of(uint16_t id) {
    for (int i = count - 1; i >= 0; i--) {
        if (frames[i].id == id) {
            return frames[i].data;
        }
    }
    TEST_FAIL_MESSAGE("no such frame");
    return NULL;
}

// A signal of the last frame with an id, by its place in tools/argus.dbc.
static uint32_t get(uint16_t id, unsigned start, unsigned length) {
    const uint8_t *const data = last_of(id);
    uint64_t bits = 0;
    for (unsigned i = 0; i < 8; i++) {
        bits |= (uint64_t)data[i] << (8 * i);
    }
    return (uint32_t)(bits >> start & ((1ull << length) - 1));
}

static uint16_t last_nonce(void) {
    return (uint16_t)get(HAL_DBC_HEARTBEAT_ID, 48, 16);
}

// Packing
// ------------------------------------------------------------------------------------------------------

static void packed_is(const char *hex, const uint8_t *data) {
    char text[17];
    for (int i = 0; i < 8; i++) {
        snprintf(text + 2 * i, 3, "%02x", data[i]);
    }
    TEST_ASSERT_EQUAL_STRING(hex, text);
}

// The bytes are cantools' for the same values.
void test_packing_agrees_with_another_implementation(void) {
    uint8_t data[8];
    hal_dbc_heartbeat_pack(data, &(hal_dbc_heartbeat_t){4, 2, 1, 1, 5, 2, 9, 14, 3, 12, 0x1234, 0xABCD});
    packed_is("6455e9c33412cdab", data);
    hal_dbc_health_pack(
        data,
        &(hal_dbc_health_t){{0, 1, 2, 3, 4, 5, 0, 1}, {7, 6, 5, 4, 3, 2, 1, 0}, {1, 0, 0, 1, 0, 0, 0, 1}});
    packed_is("78312a631c150841", data);
    hal_dbc_readings_pack(data, &(hal_dbc_readings_t){{150, 5000, 8191, 4097}, {1, 2, 0, 4}});
    packed_is("96208853ff1f0190", data);
    hal_dbc_plan_pack(data, &(hal_dbc_plan_t){5, 1, 0, {1, 0, 1, 1, 0, 1}, 11, {-20, 20, -128, 127, -1, 0}});
    packed_is("adb5ec14807fff00", data);
    hal_dbc_emergency_pack(data, &(hal_dbc_emergency_t){37, 1, 2, 3, 15, 4, 200, -123456});
    packed_is("25e88fc8c01dfeff", data);
}

void test_values_beyond_a_signal_do_not_spill_into_the_next(void) {
    uint8_t data[8];
    hal_dbc_readings_pack(data, &(hal_dbc_readings_t){{65535, 0, 0, 0}, {0, 0, 0, 0}});
    packed_is("ff1f000000000000", data);
    hal_dbc_emergency_pack(data, &(hal_dbc_emergency_t){65535, 0, 0, 0, 0, 0, 0, 0});
    packed_is("ff07000000000000", data);
}

void test_command_unpacks(void) {
    static const uint8_t data[8] = {5, 3, 0xEF, 0xBE, 0, 0, 0x34, 0x12};
    hal_dbc_command_t order;
    hal_dbc_command_unpack(&order, data);
    TEST_ASSERT_EQUAL_UINT8(5, order.order);
    TEST_ASSERT_EQUAL_UINT8(3, order.sonar);
    TEST_ASSERT_EQUAL_HEX16(0xBEEF, order.nonce);
    TEST_ASSERT_EQUAL_HEX16(0, order.reserved);
    TEST_ASSERT_EQUAL_HEX16(0x1234, order.crc);
}

// Schedule
// -----------------------------------------------------------------------------------------------------

void test_everything_is_said_at_once_and_each_second(void) {
    collect();
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_FRAMES, count);
    for (uint16_t i = 0; i < HAL_TELEMETRY_FRAMES; i++) {
        TEST_ASSERT_EQUAL_HEX16(0x500 + i, frames[i].id);
        TEST_ASSERT_EQUAL_UINT8(8, frames[i].length);
    }
    robot.mute = true; // no robot: nothing changes
    run(10000);
    for (uint16_t i = 0; i < HAL_TELEMETRY_FRAMES; i++) {
        TEST_ASSERT_EQUAL_INT(11, frames_of((uint16_t)(0x500 + i), 0));
    }
}

// As many as there are sonars, each once; no frame is owed for those that are not there.
void test_a_robot_with_more_sonars_has_frames_for_them(void) {
    static const struct {
        uint8_t sonars;
        unsigned health;
        unsigned readings;
    } rows[] = {{8, 2, 4}, {16, 2, 4}, {17, 3, 5}, {24, 3, 6}, {28, 4, 7}, {32, 4, 8}};
    for (size_t row = 0; row < sizeof rows / sizeof rows[0] && rows[row].sonars <= ARGUS_SONARS; row++) {
        hal_telemetry_frame_t frame;
        argus_status_t status = *seen();
        unsigned sent = 0;
        status.sonars = rows[row].sonars;
        hal_telemetry_init(&telemetry, 1, 1500, 42, 0);
        while (hal_telemetry_next(&telemetry, &status, 0, &frame)) {
            TEST_ASSERT_EQUAL_UINT(0, sent >> (frame.id - 0x510) & 1u);
            sent |= 1u << (frame.id - 0x510);
        }
        const unsigned health = (1u << 1 | 1u << 2) | (rows[row].health > 2 ? 1u << 8 : 0u) |
                                (rows[row].health > 3 ? 1u << 9 : 0u);
        const unsigned readings = 0xFu << 3 | ((1u << (rows[row].readings - 4)) - 1u) << 10;
        TEST_ASSERT_EQUAL_HEX(1u | health | readings | 1u << 7, sent);
        TEST_ASSERT_GREATER_THAN_UINT32(0, hal_telemetry_due_ms(&telemetry, 0));
    }
}

void test_the_last_sonar_is_in_the_last_frames(void) {
#if ARGUS_SONARS >= 32
    hal_telemetry_frame_t frame;
    argus_status_t status = *seen();
    status.sonars = 32;
    status.health[31] = ARGUS_DISABLED;
    status.kind[31] = ARGUS_KIND_STUCK;
    status.reading_mm[30] = 1234;
    status.age_ms[30] = 0;
    status.readings[30] = 1;
    while (hal_telemetry_next(&telemetry, &status, now_ms(), &frame)) {
        if (frame.id == 0x509) {
            TEST_ASSERT_EQUAL_HEX8(ARGUS_DISABLED | ARGUS_KIND_STUCK << 3, frame.data[7]);
        } else if (frame.id == 0x50D) {
            TEST_ASSERT_EQUAL_UINT(1234, (frame.data[4] | frame.data[5] << 8) & 0x1FFF);
            TEST_ASSERT_EQUAL_UINT(HAL_DBC_VALIDITY_FRESH, frame.data[5] >> 5);
        }
        count++;
    }
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_SLOTS, count);
#endif
}

void test_every_reading_is_on_the_bus_and_none_too_often(void) {
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    collect();
    for (int i = 0; i < 16; i++) {
        TEST_ASSERT_EQUAL_UINT32(robot.argus.knowledge.sonar[i].readings, telemetry.readings[i]);
    }
    const int from = count;
    const uint32_t start_ms = robot.t_ms;
    uint32_t shown = 0;
    for (int tick = 0; tick < 1000; tick++) {
        const int before = count;
        run(10);
        for (int i = before; i < count; i++) {
            for (unsigned k = 0; frames[i].id >= 0x503 && frames[i].id <= 0x506 && k < 4; k++) {
                shown += frames[i].data[2 * k + 1] >> 5 == HAL_DBC_VALIDITY_FRESH;
            }
        }
    }
    const uint32_t passed_ms = robot.t_ms - start_ms;
    TEST_ASSERT_UINT32_WITHIN(8, 2 * passed_ms / 40, shown); // two transducers each 40 ms
    for (uint16_t id = 0x503; id <= 0x506; id++) {
        TEST_ASSERT_LESS_OR_EQUAL_INT((int)(passed_ms / HAL_TELEMETRY_READING_MS) + 1, frames_of(id, from));
    }
}

void test_a_server_that_lists_all_does_not_fill_the_bus(void) {
    robot.lists_all = true;
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    collect();
    const int from = count;
    run(10000);
    for (uint16_t id = 0x503; id <= 0x506; id++) {
        TEST_ASSERT_INT_WITHIN(2, 10000 / HAL_TELEMETRY_ALL_MS, frames_of(id, from));
    }
}

void test_due_tells_when_to_call_again(void) {
    robot.mute = true;
    collect();
    uint32_t slept_ms = 0;
    while (slept_ms < 5000) {
        const uint32_t due_ms = hal_telemetry_due_ms(&telemetry, now_ms());
        TEST_ASSERT_GREATER_THAN_UINT32(0, due_ms);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(HAL_TELEMETRY_PERIOD_MS, due_ms);
        const int before = count;
        robot.t_ms += due_ms;
        slept_ms += due_ms;
        collect();
        TEST_ASSERT_GREATER_THAN_INT(before, count);
    }
}

// A bit of stuffing after each 4 of the 34 + 64 bits from start to CRC; 47 bits are never data.
#define WORST_FRAME_BITS (47 + 64 + (34 + 64 - 1) / 4)
#define BUS_BITS_S 500000

void test_nothing_that_happens_makes_telemetry_take_two_percent_of_the_bus(void) {
    argus_status_t status;
    const uint32_t seconds = 60;
    uint32_t time_ms = 5;
    uint64_t bits = 0;
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    status = *seen();
    hal_telemetry_init(&telemetry, 0, 1500, 42, time_ms);
    for (uint32_t tick = 0; tick < seconds * 1000; tick++) { // everything changes each ms
        hal_telemetry_frame_t frame;
        const argus_event_t event = {.id = ARGUS_EV_STALL, .sonar = ARGUS_NO_SONAR, .value = (int32_t)tick};
        time_ms++;
        for (int i = 0; i < 16; i++) {
            status.readings[i]++;
            status.health[i] = (argus_health_t)(tick % 5);
        }
        status.plan.count = (uint8_t)(1 + tick % 3);
        hal_telemetry_event(&telemetry, &status, &event);
        while (hal_telemetry_next(&telemetry, &status, time_ms, &frame)) {
            bits += WORST_FRAME_BITS;
        }
    }
    bits += seconds * WORST_FRAME_BITS; // and an order for each nonce
    TEST_ASSERT_LESS_THAN_UINT32(BUS_BITS_S * 2 / 100, (uint32_t)(bits / seconds));
    TEST_ASSERT_GREATER_THAN_UINT32(BUS_BITS_S * 17 / 1000, (uint32_t)(bits / seconds)); // SPEC.md's sum
}

void test_ids_of_another_robot(void) {
    begin(7, 0);
    collect();
    TEST_ASSERT_EQUAL_HEX16(0x570, frames[0].id);
    TEST_ASSERT_EQUAL_HEX16(0x577, frames[HAL_TELEMETRY_FRAMES - 1].id);
    TEST_ASSERT_EQUAL_HEX16(0x207, hal_telemetry_command_id(&telemetry));
    const argus_event_t event = {.id = ARGUS_EV_BUMPER, .sonar = ARGUS_NO_SONAR, .value = 0x200};
    hal_telemetry_event(&telemetry, seen(), &event);
    collect();
    TEST_ASSERT_EQUAL_HEX16(0x087, frames[count - 1].id);
}

// Contents
// -----------------------------------------------------------------------------------------------------

void test_heartbeat_follows_the_manager(void) {
    collect();
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_STATE_OFFLINE, get(0x500, 4, 2));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    run(1000);
    TEST_ASSERT_EQUAL_UINT32(ARGUS_MODE_IDLE, get(0x500, 0, 4));
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_STATE_ACTIVE, get(0x500, 4, 2));
    const uint32_t roll = get(0x500, 16, 4);
    const uint32_t uptime_s = get(0x500, 32, 16);
    run(5000);
    TEST_ASSERT_EQUAL_UINT32((roll + 5) % 16, get(0x500, 16, 4));
    TEST_ASSERT_EQUAL_UINT32(uptime_s + 5, get(0x500, 32, 16));
    argus_operator(&robot.argus, now_ms(), ARGUS_OP_PASSIVE, 0);
    run(1000);
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_STATE_PASSIVE, get(0x500, 4, 2));
    argus_shutdown(&robot.argus, now_ms());
    run(3000);
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_STATE_CLOSED, get(0x500, 4, 2));
}

void test_farewell_says_closed_whatever_the_mode(void) {
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    collect();
    const uint32_t roll = get(0x500, 16, 4);
    hal_telemetry_farewell(&telemetry, seen(), now_ms(), &frames[count]);
    TEST_ASSERT_EQUAL_HEX16(0x500, frames[count].id);
    count++;
    TEST_ASSERT_EQUAL_UINT32((roll + 1) & 0xF, get(0x500, 16, 4));
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_STATE_CLOSED, get(0x500, 4, 2));
    TEST_ASSERT_EQUAL_UINT32(ARGUS_MODE_IDLE, get(0x500, 0, 4));
}

void test_readings_health_and_plan_of_a_dead_sonar(void) {
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    run(1200);
    TEST_ASSERT_EQUAL_UINT32(2600, get(0x503, 48, 13)); // sonar 3
    TEST_ASSERT_EQUAL_UINT32(ARGUS_HEALTHY, get(0x501, 24, 3));
    TEST_ASSERT_EQUAL_UINT32(0, get(0x507, 0, 3));
    const uint32_t plan_roll = get(0x507, 12, 4);
    const int from = count;
    robot.fault[3] = ROBOT_OFF;
    run(4000);
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_RANGE_NO_ECHO, get(0x503, 48, 13));
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_VALIDITY_DISABLED, get(0x503, 61, 3));
    TEST_ASSERT_EQUAL_UINT32(ARGUS_DISABLED, get(0x501, 24, 3));
    TEST_ASSERT_EQUAL_UINT32(ARGUS_KIND_OFF, get(0x501, 27, 3));
    TEST_ASSERT_EQUAL_UINT32(ARGUS_IS_MINOR, get(0x500, 6, 2));
    TEST_ASSERT_EQUAL_UINT32(1, get(0x500, 13, 3));
    TEST_ASSERT_EQUAL_UINT32(robot.argus.plan.count, get(0x507, 0, 3));
    TEST_ASSERT_EQUAL_UINT32(1, get(0x507, 5 + 2, 1)); // Blind3
    TEST_ASSERT_EQUAL_INT(robot.argus.plan.rotation_deg[0], (int8_t)get(0x507, 16, 8));
    TEST_ASSERT_EQUAL_UINT32((plan_roll + 1) % 16, get(0x507, 12, 4));
    TEST_ASSERT_GREATER_THAN_INT(0, frames_of(0x080, from));
}

void test_a_sonar_that_never_reported_and_one_that_stopped(void) {
    robot.fault[9] = ROBOT_SILENT;
    run(6000);
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_RANGE_NONE, get(0x505, 16, 13));
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_VALIDITY_NEVER, get(0x505, 29, 3));
    robot.fault[10] = ROBOT_SILENT;
    run(4000);
    TEST_ASSERT_EQUAL_UINT32(2600, get(0x505, 32, 13));
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_VALIDITY_OLD, get(0x505, 45, 3));
}

// Emergencies
// --------------------------------------------------------------------------------------------------

static void say(uint16_t id, int sonar, int32_t value) {
    const argus_event_t event = {.id = id, .sonar = (int8_t)sonar, .state = ARGUS_IS_MINOR, .value = value};
    hal_telemetry_event(&telemetry, seen(), &event);
}

void test_an_emergency_goes_first_and_at_once(void) {
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    run(1000);
    robot.fault[3] = ROBOT_OFF;
    const int from = robot.events;
    while (robot_count_events(&robot, ARGUS_EV_SONAR_DEAD, from) == 0) {
        robot_run(&robot, 10);
    }
    const int first = count;
    collect();
    TEST_ASSERT_EQUAL_HEX16(0x080, frames[first].id);
    TEST_ASSERT_EQUAL_UINT8(ARGUS_EV_SONAR_DEAD, frames[first].data[0]);
    TEST_ASSERT_EQUAL_UINT8(3, frames[first].data[2] & 0x1F);
    TEST_ASSERT_EQUAL_UINT8(5000 & 0xFF, frames[first].data[4]);
    TEST_ASSERT_EQUAL_UINT8(5000 >> 8, frames[first].data[5]);
}

// Rule: an alarm about any sonar of the build has its other edge, also past the sixteen of the frames of
// health.
void test_both_edges_of_the_last_sonar_go_out(void) {
    collect();
    const int from = count;
    const int sonar = ARGUS_SONARS - 1;
    say(ARGUS_EV_SONAR_HEALTHY, sonar, 700);
    collect();
    TEST_ASSERT_EQUAL_INT(0, frames_of(0x080, from));
    say(ARGUS_EV_SONAR_DISABLED, sonar, 1);
    say(ARGUS_EV_SONAR_HEALTHY, sonar, 700);
    say(ARGUS_EV_SONAR_HEALTHY, sonar, 700);
    collect();
    TEST_ASSERT_EQUAL_INT(2, frames_of(0x080, from));
    TEST_ASSERT_EQUAL_UINT32(sonar, get(0x080, 16, 5));
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_ABOUT_SONAR, get(0x080, 11, 1));
}

void test_both_edges_go_out_and_chatter_does_not(void) {
    collect();
    const int from = count;
    say(ARGUS_EV_SONAR_HEALTHY, 5, 700); // nothing was wrong with it
    say(ARGUS_EV_SONAR_SUSPECT, 5, 700);
    say(ARGUS_EV_STEP, -1, 200);
    say(ARGUS_EV_SESSION_OPEN, -1, 1);
    collect();
    TEST_ASSERT_EQUAL_INT(0, frames_of(0x080, from));
    say(ARGUS_EV_SONAR_DISABLED, 5, 1);
    say(ARGUS_EV_SONAR_HEALTHY, 5, 700);
    say(ARGUS_EV_SONAR_HEALTHY, 5, 700);
    say(ARGUS_EV_LINK_LOST, -1, 4000);
    say(ARGUS_EV_SESSION_OPEN, -1, 1);
    say(ARGUS_EV_SESSION_OPEN, -1, 1);
    say(ARGUS_EV_FAILURE_STATE, -1, 1);
    collect();
    TEST_ASSERT_EQUAL_INT(5, frames_of(0x080, from));
    TEST_ASSERT_EQUAL_UINT32(ARGUS_EV_FAILURE_STATE, get(0x080, 0, 11));
    TEST_ASSERT_EQUAL_UINT32(ARGUS_IS_MINOR, get(0x080, 14, 2));
    TEST_ASSERT_EQUAL_UINT32(HAL_DBC_ABOUT_ROBOT, get(0x080, 11, 1));
    TEST_ASSERT_EQUAL_UINT32(0, get(0x080, 16, 5));
    TEST_ASSERT_EQUAL_UINT32(4, get(0x080, 24, 8)); // Roll counts from 0
}

void test_a_shower_of_emergencies_is_spread_and_a_loss_is_seen(void) {
    robot.mute = true;
    collect();
    for (int i = 0; i < 60; i++) {
        say(ARGUS_EV_STALL, -1, i);
    }
    const int from = count;
    collect();
    TEST_ASSERT_EQUAL_INT((int)HAL_TELEMETRY_EDGE_BURST, frames_of(0x080, from));
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(HAL_TELEMETRY_EDGE_MS, hal_telemetry_due_ms(&telemetry, now_ms()));
    run(1000);
    TEST_ASSERT_EQUAL_INT((int)(HAL_TELEMETRY_EDGE_BURST + 1000 / HAL_TELEMETRY_EDGE_MS),
                          frames_of(0x080, from));
    run(20000);
    TEST_ASSERT_EQUAL_INT((int)HAL_TELEMETRY_EDGE_QUEUE, frames_of(0x080, from));
    TEST_ASSERT_EQUAL_UINT32(59, get(0x080, 24, 8));
}

// Orders
// -------------------------------------------------------------------------------------------------------

static void make(uint8_t data[8], uint8_t order, uint8_t sonar, uint16_t nonce) {
    const uint16_t id = hal_telemetry_command_id(&telemetry);
    memset(data, 0, 8);
    data[0] = order;
    data[1] = sonar;
    data[2] = (uint8_t)(nonce & 0xFF);
    data[3] = (uint8_t)(nonce >> 8);
    const uint16_t crc = hal_telemetry_crc(id, data);
    data[6] = (uint8_t)(crc & 0xFF);
    data[7] = (uint8_t)(crc >> 8);
}

static hal_telemetry_verdict_t take(const uint8_t *data, size_t length) {
    hal_dbc_command_t order;
    return hal_telemetry_take(&telemetry, data, length, now_ms(), &order);
}

static hal_telemetry_verdict_t send_order(uint8_t order, uint8_t sonar, uint16_t nonce) {
    uint8_t data[8];
    make(data, order, sonar, nonce);
    return take(data, 8);
}

// Over id 0x3231 and six bytes, as an implementation whose "123456789" is 0x29B1 (the standard check) has it.
void test_crc(void) {
    static const uint8_t data[8] = {'3', '4', '5', '6', '7', '8', 0, 0};
    TEST_ASSERT_EQUAL_HEX16(0xA12B, hal_telemetry_crc(0x3231, data)); // of "12345678"
}

void test_every_order_is_taken_once(void) {
    for (uint8_t order = HAL_DBC_ORDER_STOP; order <= HAL_DBC_ORDER_RETEST; order++) {
        run(1000);
        const uint16_t nonce = last_nonce();
        const uint8_t sonar = order == HAL_DBC_ORDER_RETEST ? 15 : 0;
        TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_TAKEN, send_order(order, sonar, nonce));
        TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_USED_NONCE, send_order(order, sonar, nonce));
    }
    run(1000);
    TEST_ASSERT_EQUAL_UINT32(5, get(0x500, 24, 4));
    TEST_ASSERT_EQUAL_UINT32(5, get(0x500, 28, 4));
    TEST_ASSERT_EQUAL_UINT32(5, hal_telemetry_refused(&telemetry));
}

void test_a_stuck_frame_moves_nothing(void) {
    uint8_t data[8];
    run(1000);
    make(data, HAL_DBC_ORDER_GO, 0, last_nonce());
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_TAKEN, take(data, 8));
    for (int i = 0; i < 5000; i++) {
        run(10);
        TEST_ASSERT_NOT_EQUAL_INT(HAL_TELEMETRY_TAKEN, take(data, 8));
        count = count > MAX_FRAMES / 2 ? 0 : count;
    }
}

void test_a_late_frame_moves_nothing(void) {
    collect();
    const uint16_t first = last_nonce();
    const uint32_t sent_ms = robot.t_ms;
    run(1990);
    TEST_ASSERT_EQUAL_UINT32(sent_ms + 1990, robot.t_ms);
    TEST_ASSERT_NOT_EQUAL_UINT16(first, last_nonce());
    robot.t_ms = sent_ms + 2000; // the last ms, though a newer heartbeat has gone
    hal_telemetry_t copy = telemetry;
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_TAKEN, send_order(HAL_DBC_ORDER_GO, 0, first));
    telemetry = copy;
    robot.t_ms++;
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_UNKNOWN_NONCE, send_order(HAL_DBC_ORDER_GO, 0, first));
}

void test_an_overtaken_frame_moves_nothing(void) {
    collect();
    const uint16_t first = last_nonce();
    run(1000);
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_TAKEN, send_order(HAL_DBC_ORDER_STOP, 0, last_nonce()));
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_USED_NONCE, send_order(HAL_DBC_ORDER_GO, 0, first));
}

void test_a_silent_bus_takes_nothing_after_two_seconds(void) {
    collect();
    robot.t_ms += 2500; // no heartbeat went out meanwhile
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_UNKNOWN_NONCE, send_order(HAL_DBC_ORDER_GO, 0, last_nonce()));
}

void test_before_the_first_heartbeat_nothing_is_taken(void) {
    for (uint32_t nonce = 0; nonce < 65536; nonce++) {
        TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_UNKNOWN_NONCE,
                              send_order(HAL_DBC_ORDER_GO, 0, (uint16_t)nonce));
    }
}

void test_every_flipped_bit_and_every_wrong_length_is_refused(void) {
    uint8_t data[8];
    collect();
    make(data, HAL_DBC_ORDER_GO, 0, last_nonce());
    for (int bit = 0; bit < 64; bit++) {
        data[bit / 8] ^= (uint8_t)(1 << bit % 8);
        TEST_ASSERT_EQUAL_INT_MESSAGE(HAL_TELEMETRY_BAD_CRC, take(data, 8), "a flipped bit was taken");
        data[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
    for (size_t length = 0; length < 8; length++) {
        TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_LENGTH, take(data, length));
    }
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_TAKEN, take(data, 8)); // and the nonce is still good
}

void test_a_frame_for_another_robot_has_a_wrong_crc(void) {
    uint8_t data[8];
    collect();
    make(data, HAL_DBC_ORDER_GO, 0, last_nonce());
    telemetry.robot = 1;
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_CRC, take(data, 8));
}

void test_nonsense_is_refused_and_uses_its_nonce_up(void) {
    static const struct {
        uint8_t order;
        uint8_t sonar;
    } table[] = {{0, 0}, {6, 0}, {255, 0}, {HAL_DBC_ORDER_RETEST, ARGUS_SONARS}, {HAL_DBC_ORDER_STOP, 1}};
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        run(1000);
        const uint16_t nonce = last_nonce();
        TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_ORDER, send_order(table[i].order, table[i].sonar, nonce));
        TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_USED_NONCE, send_order(HAL_DBC_ORDER_GO, 0, nonce));
    }
}

void test_no_random_frame_is_taken(void) {
    uint32_t random = 1; // the seed
    collect();
    for (int i = 0; i < 1000000; i++) {
        uint8_t data[8];
        for (int k = 0; k < 8; k++) {
            random = random * 1664525u + 1013904223u;
            data[k] = (uint8_t)(random >> 24);
        }
        TEST_ASSERT_NOT_EQUAL_INT(HAL_TELEMETRY_TAKEN, take(data, random % 9u));
    }
}

void test_a_reserved_bit_is_refused(void) {
    uint8_t data[8];
    collect();
    make(data, HAL_DBC_ORDER_GO, 0, last_nonce());
    data[4] = 1;
    const uint16_t crc = hal_telemetry_crc(hal_telemetry_command_id(&telemetry), data);
    data[6] = (uint8_t)(crc & 0xFF);
    data[7] = (uint8_t)(crc >> 8);
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_RESERVED, take(data, 8));
}

void test_nonces_do_not_come_again_and_differ_from_start_to_start(void) {
    static bool seen[65536];
    static uint16_t other[64];
    memset(seen, 0, sizeof seen);
    for (int i = 0; i < 65536; i++) {
        robot.t_ms += 1000;
        count = 0;
        collect();
        const uint16_t nonce = last_nonce();
        TEST_ASSERT_FALSE_MESSAGE(seen[nonce], "a nonce came twice");
        seen[nonce] = true;
        if (i < 64) {
            other[i] = nonce;
        }
    }
    int same = 0;
    hal_telemetry_init(&telemetry, 0, 1500, 43, now_ms());
    for (int i = 0; i < 64; i++) {
        robot.t_ms += 1000;
        count = 0;
        collect();
        same += last_nonce() == other[i];
    }
    TEST_ASSERT_LESS_THAN_INT(3, same);
}

void test_every_verdict_has_a_text(void) {
    TEST_ASSERT_EQUAL_STRING("taken", hal_telemetry_verdict_text(HAL_TELEMETRY_TAKEN));
    for (int i = 1; i < HAL_TELEMETRY_VERDICTS; i++) {
        TEST_ASSERT_GREATER_THAN_size_t(10, strlen(hal_telemetry_verdict_text((hal_telemetry_verdict_t)i)));
    }
    TEST_ASSERT_EQUAL_STRING("?", hal_telemetry_verdict_text(HAL_TELEMETRY_VERDICTS));
}
