// SPDX-License-Identifier: MIT
// Attacks: telemetry goes on after every trouble of the bus, and says it once; an emergency survives it;
// orders arrive.
#include <errno.h>
#include <string.h>

#include "bus.h"
#include "fake_can.h"
#include "robot.h"
#include "unity.h"

static bus_t bus;
static argus_t core;
static argus_status_t status;
static uint32_t now_ms;
static char text[1024];

void setUp(void) {
    const argus_config_t config = robot_config();
    hal_can_spec_t spec;
    fake_can_reset();
    now_ms = UINT32_MAX - 1500; // the clock wraps
    argus_manager_init(&core, &config, now_ms);
    argus_status(&core, &status);
    TEST_ASSERT_TRUE(hal_can_spec_parse_telemetry(&spec, "can0,robot=1", text, sizeof text));
    TEST_ASSERT_TRUE(bus_open(&bus, &spec, &fake_can_sys, 1500, 1, now_ms, text, sizeof text));
}

static uint32_t process(void) {
    return bus_process(&bus, &status, now_ms);
}

static struct can_frame sent(int number) {
    struct can_frame frame;
    memcpy(&frame, fake_can.sent[number % FAKE_CAN_STEPS], sizeof frame);
    return frame;
}

static void run(uint32_t ms) {
    for (uint32_t passed = 0; passed < ms; passed += 10) {
        now_ms += 10;
        process();
    }
}

static void bump(void) {
    const argus_event_t event = {.id = ARGUS_EV_BUMPER, .sonar = ARGUS_NO_SONAR, .value = 0x200};
    bus_event(&bus, &status, &event);
}

void test_frames_go_out_and_the_wait_is_told(void) {
    const uint32_t wait_ms = process();
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_FRAMES, fake_can.sends);
    TEST_ASSERT_EQUAL_HEX32(0x510, sent(0).can_id);
    TEST_ASSERT_EQUAL_UINT32(HAL_TELEMETRY_PERIOD_MS, wait_ms);
    now_ms += wait_ms;
    process();
    TEST_ASSERT_EQUAL_INT(2 * HAL_TELEMETRY_FRAMES, fake_can.sends);
    bump();
    TEST_ASSERT_EQUAL_UINT32(HAL_TELEMETRY_PERIOD_MS, process());
    TEST_ASSERT_EQUAL_HEX32(0x081, sent(fake_can.sends - 1).can_id);
    TEST_ASSERT_FALSE(bus_notice(&bus, text, sizeof text));
}

void test_switched_off_it_does_nothing(void) {
    static bus_t off;
    hal_telemetry_verdict_t verdict = HAL_TELEMETRY_TAKEN;
    hal_dbc_command_t order;
    memset(&off, 0, sizeof off);
    bump();
    bus_event(&off, &status, &(argus_event_t){.id = ARGUS_EV_BUMPER});
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, bus_process(&off, &status, now_ms));
    TEST_ASSERT_EQUAL_INT(-1, bus_fd(&off));
    TEST_ASSERT_FALSE(bus_order(&off, now_ms, &verdict, &order));
    TEST_ASSERT_FALSE(bus_notice(&off, text, sizeof text));
    bus_close(&off, &status, now_ms);
    TEST_ASSERT_EQUAL_INT(0, fake_can.closed);
    TEST_ASSERT_EQUAL_INT(0, fake_can.sends);
}

void test_a_full_queue_loses_no_frame(void) {
    for (int i = 0; i < 3; i++) {
        fake_can_answer_send(-ENOBUFS);
    }
    TEST_ASSERT_EQUAL_UINT32(HAL_CAN_RAW_HOLD_MS, process());
    run(100);
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_FRAMES, fake_can.sends);
    TEST_ASSERT_EQUAL_HEX32(0x510, sent(0).can_id);
    TEST_ASSERT_EQUAL_UINT32(3, bus.raw.full);
}

void test_down_is_said_once_and_an_emergency_outlasts_it(void) {
    process();
    fake_can_answer_send(-ENETDOWN);
    fake_can.flags = 0;
    run(3000);
    TEST_ASSERT_TRUE(bus_notice(&bus, text, sizeof text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "telemetry: can0: the interface is down: ip link set can0 up"),
                                 text);
    TEST_ASSERT_FALSE(bus_notice(&bus, text, sizeof text));
    bump();
    run(3000);
    TEST_ASSERT_FALSE(bus_notice(&bus, text, sizeof text));
    const int before = fake_can.sends;
    fake_can.flags = IFF_UP;
    run(1500);
    TEST_ASSERT_EQUAL_HEX32(0x081, sent(before).can_id);
    TEST_ASSERT_EQUAL_HEX32(0x510, sent(before + 1).can_id);
    TEST_ASSERT_TRUE(bus_notice(&bus, text, sizeof text));
    TEST_ASSERT_EQUAL_STRING("telemetry: can0 is back", text);
}

static void deliver_order(uint8_t order, uint16_t nonce) {
    struct can_frame frame = {.can_id = 0x201, .len = 8, .data = {order}};
    frame.data[2] = (uint8_t)(nonce & 0xFF);
    frame.data[3] = (uint8_t)(nonce >> 8);
    const uint16_t crc = hal_telemetry_crc(0x201, frame.data);
    frame.data[6] = (uint8_t)(crc & 0xFF);
    frame.data[7] = (uint8_t)(crc >> 8);
    fake_can_deliver(sizeof frame, &frame, sizeof frame);
}

void test_orders_arrive_and_refusals_are_said_now_and_then(void) {
    hal_telemetry_verdict_t verdict = HAL_TELEMETRY_TAKEN;
    hal_dbc_command_t order;
    process();
    const struct can_frame heartbeat = sent(0);
    const uint16_t nonce = (uint16_t)(heartbeat.data[6] | heartbeat.data[7] << 8);
    deliver_order(HAL_DBC_ORDER_GO, nonce);
    deliver_order(HAL_DBC_ORDER_GO, nonce);
    TEST_ASSERT_TRUE(bus_order(&bus, now_ms, &verdict, &order));
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_TAKEN, verdict);
    TEST_ASSERT_EQUAL_UINT8(HAL_DBC_ORDER_GO, order.order);
    TEST_ASSERT_TRUE(bus_order(&bus, now_ms, &verdict, &order));
    TEST_ASSERT_EQUAL_INT(HAL_TELEMETRY_BAD_USED_NONCE, verdict);
    TEST_ASSERT_FALSE(bus_order(&bus, now_ms, &verdict, &order));
    TEST_ASSERT_TRUE(bus_refusal(&bus, verdict, now_ms, text, sizeof text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "can0: an order was refused: its nonce"), text);
    TEST_ASSERT_FALSE(bus_refusal(&bus, verdict, now_ms + BUS_SAY_MS - 1, text, sizeof text));
    TEST_ASSERT_TRUE(bus_refusal(&bus, verdict, now_ms + BUS_SAY_MS, text, sizeof text));
}

void test_errors_of_the_link_are_said_with_their_count(void) {
    hal_isotp_t link;
    hal_isotp_init(&link, &fake_can_sys);
    TEST_ASSERT_FALSE(bus_link_notice(&bus, &link, now_ms, text, sizeof text));
    link.errors[HAL_ISOTP_NO_FLOW] = 3;
    TEST_ASSERT_TRUE(bus_link_notice(&bus, &link, now_ms, text, sizeof text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "no flow control came"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "(3 so far)"), text);
    link.errors[HAL_ISOTP_SEQUENCE] = 1;
    TEST_ASSERT_FALSE(bus_link_notice(&bus, &link, now_ms + 1, text, sizeof text));
    TEST_ASSERT_TRUE(bus_link_notice(&bus, &link, now_ms + BUS_SAY_MS, text, sizeof text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "wrong order"), text);
}

void test_bus_off_is_said_with_the_command_that_helps(void) {
    bus.raw.bus_off = 1;
    TEST_ASSERT_TRUE(bus_notice(&bus, text, sizeof text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "ip link set can0 type can restart-ms 100"), text);
    TEST_ASSERT_FALSE(bus_notice(&bus, text, sizeof text));
}

void test_the_end_is_said_on_the_bus(void) {
    process();
    bus_close(&bus, &status, now_ms);
    TEST_ASSERT_EQUAL_HEX32(0x510, sent(fake_can.sends - 1).can_id);
    TEST_ASSERT_EQUAL_UINT8(HAL_DBC_STATE_CLOSED, sent(fake_can.sends - 1).data[0] >> 4 & 3);
    TEST_ASSERT_EQUAL_INT(1, fake_can.closed);
}

void test_what_is_missing_is_named(void) {
    hal_can_spec_t spec = {.interface = "can9"};
    fake_can.index = 0;
    TEST_ASSERT_FALSE(bus_open(&bus, &spec, &fake_can_sys, 1500, 1, now_ms, text, sizeof text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "can9: no such interface"), text);
    fake_can.socket_says = -EPROTONOSUPPORT;
    TEST_ASSERT_FALSE(bus_open(&bus, &spec, &fake_can_sys, 1500, 1, now_ms, text, sizeof text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "modprobe can-raw"), text);
    TEST_ASSERT_FALSE(bus.on);
}

void test_seeds_differ(void) {
    TEST_ASSERT_TRUE(bus_seed() != bus_seed());
}
