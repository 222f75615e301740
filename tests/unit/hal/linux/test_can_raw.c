// SPDX-License-Identifier: MIT
// Attacks: telemetry outlives an interface that is down, full or removed, and takes no frame but plain ones
// of its id.
#include <errno.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <string.h>
#include <sys/socket.h>

#include "fake_can.h"
#include "hal/can_raw.h"
#include "unity.h"

static hal_can_raw_t raw;
static uint8_t data[8];
static uint32_t now_ms;

void setUp(void) {
    fake_can_reset();
    now_ms = UINT32_MAX - 500; // the clock wraps
    hal_can_raw_init(&raw, &fake_can_sys);
}

static void open_it(void) {
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_can_raw_open(&raw, "can0", 0x203, now_ms));
}

static bool send_one(void) {
    return hal_can_raw_send(&raw, 0x500, data, 8, now_ms);
}

static void deliver(uint32_t id, uint8_t length) {
    struct can_frame frame = {.can_id = id, .len = length, .data = {1, 2, 3}};
    fake_can_deliver(sizeof frame, &frame, sizeof frame);
}

void test_only_the_command_id_is_let_in(void) {
    struct can_filter filter;
    open_it();
    TEST_ASSERT_EQUAL_INT(SOCK_RAW, fake_can.type);
    TEST_ASSERT_EQUAL_INT(CAN_RAW, fake_can.protocol);
    TEST_ASSERT_EQUAL_INT(CAN_RAW_FILTER, fake_can.option[0]);
    memcpy(&filter, fake_can.value[0], sizeof filter);
    TEST_ASSERT_EQUAL_HEX32(0x203, filter.can_id);
    TEST_ASSERT_EQUAL_HEX32(CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG, filter.can_mask);
    deliver(0x203 | CAN_EFF_FLAG, 8);
    deliver(0x203 | CAN_RTR_FLAG, 8);
    deliver(0x202, 8);
    deliver(0x203, 9); // no classic frame is that long
    deliver(0x203, 5);
    TEST_ASSERT_EQUAL_INT(5, hal_can_raw_receive(&raw, data, now_ms));
    TEST_ASSERT_EQUAL_UINT8(2, data[1]);
    TEST_ASSERT_EQUAL_INT(-1, hal_can_raw_receive(&raw, data, now_ms));
}

void test_a_frame_goes_out_as_it_is(void) {
    struct can_frame frame;
    memcpy(data, "abcdefgh", 8);
    open_it();
    TEST_ASSERT_TRUE(send_one());
    TEST_ASSERT_EQUAL_size_t(sizeof frame, fake_can.sent_length[0]);
    memcpy(&frame, fake_can.sent[0], sizeof frame);
    TEST_ASSERT_EQUAL_HEX32(0x500, frame.can_id);
    TEST_ASSERT_EQUAL_UINT8(8, frame.len);
    TEST_ASSERT_EQUAL_MEMORY(data, frame.data, 8);
    TEST_ASSERT_EQUAL_UINT32(1, raw.sent);
}

void test_a_full_queue_is_tried_again_soon(void) {
    open_it();
    fake_can_answer_send(-ENOBUFS);
    TEST_ASSERT_FALSE(send_one());
    TEST_ASSERT_EQUAL_UINT32(HAL_CAN_RAW_HOLD_MS, hal_can_raw_wait_ms(&raw, now_ms));
    now_ms += HAL_CAN_RAW_HOLD_MS;
    TEST_ASSERT_EQUAL_UINT32(0, hal_can_raw_wait_ms(&raw, now_ms));
    TEST_ASSERT_TRUE(send_one());
    TEST_ASSERT_EQUAL_UINT32(1, raw.full);
    TEST_ASSERT_EQUAL_INT(0, fake_can.closed);
}

void test_an_interface_that_is_down_keeps_its_socket(void) {
    open_it();
    fake_can_deliver(-ENETDOWN, "", 0);
    TEST_ASSERT_EQUAL_INT(-1, hal_can_raw_receive(&raw, data, now_ms));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_DOWN, raw.error);
    fake_can.flags = 0;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_UINT32(HAL_CAN_RAW_RETRY_MS, hal_can_raw_wait_ms(&raw, now_ms));
        now_ms += HAL_CAN_RAW_RETRY_MS;
        hal_can_raw_process(&raw, now_ms);
        TEST_ASSERT_EQUAL_INT(HAL_LINK_DOWN, raw.error);
    }
    fake_can.flags = IFF_UP;
    now_ms += HAL_CAN_RAW_RETRY_MS;
    hal_can_raw_process(&raw, now_ms);
    TEST_ASSERT_EQUAL_UINT32(0, hal_can_raw_wait_ms(&raw, now_ms));
    TEST_ASSERT_TRUE(send_one());
    TEST_ASSERT_EQUAL_INT(1, fake_can.opened);
}

void test_an_interface_that_was_removed_is_opened_anew(void) {
    open_it();
    fake_can_answer_send(-ENXIO);
    TEST_ASSERT_FALSE(send_one());
    TEST_ASSERT_EQUAL_INT(1, fake_can.closed);
    TEST_ASSERT_EQUAL_INT(-1, hal_can_raw_fd(&raw));
    TEST_ASSERT_FALSE(send_one());
    fake_can.index = 0;
    now_ms += HAL_CAN_RAW_RETRY_MS;
    hal_can_raw_process(&raw, now_ms);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_FOUND, raw.error);
    fake_can.index = 9;
    hal_can_raw_process(&raw, now_ms + 1); // too soon
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_FOUND, raw.error);
    now_ms += HAL_CAN_RAW_RETRY_MS;
    hal_can_raw_process(&raw, now_ms);
    TEST_ASSERT_TRUE(send_one());
    TEST_ASSERT_EQUAL_INT(9, fake_can.address.can_ifindex);
}

void test_an_interface_replaced_while_down_is_noticed(void) {
    open_it();
    fake_can_answer_send(-ENETDOWN);
    TEST_ASSERT_FALSE(send_one());
    fake_can.index = 8;
    now_ms += HAL_CAN_RAW_RETRY_MS;
    hal_can_raw_process(&raw, now_ms);
    TEST_ASSERT_TRUE(send_one());
    TEST_ASSERT_EQUAL_INT(2, fake_can.opened);
    TEST_ASSERT_EQUAL_INT(1, fake_can.closed);
}

void test_bus_off_is_counted(void) {
    open_it();
    deliver(CAN_ERR_FLAG | CAN_ERR_BUSOFF, CAN_ERR_DLC);
    TEST_ASSERT_EQUAL_INT(-1, hal_can_raw_receive(&raw, data, now_ms));
    TEST_ASSERT_EQUAL_UINT32(1, raw.bus_off);
}

void test_a_flood_of_frames_does_not_hold_the_caller(void) {
    open_it();
    for (int i = 0; i < FAKE_CAN_STEPS; i++) {
        deliver(0x202, 8);
    }
    TEST_ASSERT_EQUAL_INT(-1, hal_can_raw_receive(&raw, data, now_ms));
    TEST_ASSERT_LESS_THAN_INT(FAKE_CAN_STEPS, fake_can.in_next);
}

void test_failures_to_open_are_told_with_the_command_that_helps(void) {
    char text[512];
    fake_can.socket_says = -EPROTONOSUPPORT;
    const hal_link_error_t error = hal_can_raw_open(&raw, "can0", 0x200, now_ms);
    hal_can_raw_explain(error, "can0", text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "modprobe can-raw"), text);
    hal_can_raw_explain(HAL_LINK_NO_CAN, "can0", text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "modprobe can-raw"), text);
    hal_can_raw_explain(HAL_LINK_NOT_FOUND, "can0", text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "ip link add can0 type vcan"), text);
    hal_can_raw_close(&raw);
    TEST_ASSERT_EQUAL_INT(0, fake_can.closed);
}
