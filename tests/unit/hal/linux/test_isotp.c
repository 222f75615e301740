// SPDX-License-Identifier: MIT
// Attacks: one packet is one PDU; errors of a transfer are counted and the link goes on; an interface that
// went down gives the same socket back, one that was removed a new one.
#include <errno.h>
#include <linux/can/isotp.h>
#include <string.h>
#include <sys/socket.h>

#include "fake_can.h"
#include "hal/isotp.h"
#include "unity.h"

static hal_isotp_t isotp;
static hal_link_t link_;
static hal_can_spec_t spec;
static uint8_t bytes[512];
static char text[512];

void setUp(void) {
    fake_can_reset();
    hal_isotp_init(&isotp, &fake_can_sys);
    TEST_ASSERT_TRUE(hal_can_spec_parse(&spec, "vcan0,robot=2,stmin=5,bs=8", text, sizeof text));
    link_ = hal_isotp_link(&isotp);
}

static void open_it(void) {
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_isotp_open(&isotp, &spec));
}

static void deliver(size_t count, uint8_t first) {
    uint8_t pdu[FAKE_CAN_BYTES];
    for (size_t i = 0; i < count; i++) {
        pdu[i] = (uint8_t)(first + i);
    }
    fake_can_deliver((ssize_t)count, pdu, count);
}

void test_options_reach_the_socket(void) {
    struct can_isotp_options options;
    struct can_isotp_fc_options flow;
    open_it();
    TEST_ASSERT_EQUAL_INT(SOCK_DGRAM, fake_can.type);
    TEST_ASSERT_EQUAL_INT(CAN_ISOTP, fake_can.protocol);
    TEST_ASSERT_EQUAL_INT(2, fake_can.options);
    TEST_ASSERT_EQUAL_INT(CAN_ISOTP_OPTS, fake_can.option[0]);
    memcpy(&options, fake_can.value[0], sizeof options);
    TEST_ASSERT_EQUAL_HEX32(CAN_ISOTP_TX_PADDING, options.flags); // no WAIT_TX_DONE: nothing may wait
    TEST_ASSERT_EQUAL_HEX8(0xCC, options.txpad_content);
    memcpy(&flow, fake_can.value[1], sizeof flow);
    TEST_ASSERT_EQUAL_UINT8(8, flow.bs);
    TEST_ASSERT_EQUAL_UINT8(5, flow.stmin);
    TEST_ASSERT_EQUAL_INT(3, fake_can.address.can_ifindex);
    TEST_ASSERT_EQUAL_HEX32(0x642, fake_can.address.can_addr.tp.tx_id);
    TEST_ASSERT_EQUAL_HEX32(0x64A, fake_can.address.can_addr.tp.rx_id);
    TEST_ASSERT_EQUAL_STRING("can:vcan0 0x642/0x64A", hal_link_describe(&link_));
}

void test_fd_frames_where_the_interface_has_them(void) {
    struct can_isotp_ll_options frames;
    spec.fd = true;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NO_FD, hal_isotp_open(&isotp, &spec));
    TEST_ASSERT_EQUAL_INT(1, fake_can.closed);
    fake_can.mtu = CANFD_MTU;
    open_it();
    TEST_ASSERT_EQUAL_INT(CAN_ISOTP_LL_OPTS, fake_can.option[2]);
    memcpy(&frames, fake_can.value[2], sizeof frames);
    TEST_ASSERT_EQUAL_UINT8(CANFD_MTU, frames.mtu);
    TEST_ASSERT_EQUAL_UINT8(64, frames.tx_dl);
}

void test_failures_to_open_leave_nothing_open(void) {
    fake_can.socket_says = -EAFNOSUPPORT;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NO_CAN, hal_isotp_open(&isotp, &spec));
    fake_can.socket_says = -EPROTONOSUPPORT;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NO_PROTOCOL, hal_isotp_open(&isotp, &spec));
    fake_can.socket_says = 0;
    fake_can.bind_says = -EADDRNOTAVAIL;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_GONE, hal_isotp_open(&isotp, &spec));
    fake_can.set_says = -EINVAL;
    TEST_ASSERT_NOT_EQUAL_INT(HAL_LINK_OK, hal_isotp_open(&isotp, &spec));
    fake_can.index = 0;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_FOUND, hal_isotp_open(&isotp, &spec));
    TEST_ASSERT_EQUAL_INT(fake_can.opened, fake_can.closed);
    TEST_ASSERT_EQUAL_INT(-1, hal_link_fd(&link_));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_link_write(&link_, bytes, 6));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_link_flush(&link_));
}

// The kernel's ISO-TP passes over them without a word.
static void the_other_format_is_counted(bool fd, int *other, int *own) {
    fake_can_reset();
    fake_can.mtu = CANFD_MTU;
    hal_isotp_init(&isotp, &fake_can_sys);
    spec.fd = fd;
    open_it();
    *other = 3;
    *own = 2;
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_UINT32(3, isotp.errors[HAL_ISOTP_FORMAT]);
    deliver(6, 1);
    TEST_ASSERT_EQUAL_INT(6, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(1, fake_can.ear_closed);
    *other = 5; // a peer that was heard has the right format
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_UINT32(3, isotp.errors[HAL_ISOTP_FORMAT]);
    *other = 0;
    hal_link_close(&link_);
    TEST_ASSERT_EQUAL_INT(fake_can.ear_opened, fake_can.ear_closed);
}

void test_frames_of_the_other_format_are_counted_until_a_packet_came(void) {
    the_other_format_is_counted(false, &fake_can.ear_fd, &fake_can.ear_classic);
    the_other_format_is_counted(true, &fake_can.ear_classic, &fake_can.ear_fd);
}

void test_without_a_raw_socket_the_link_is_no_worse(void) {
    fake_can.ear_says = -EPROTONOSUPPORT;
    fake_can.ear_fd = 3;
    open_it();
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_UINT32(0, isotp.errors[HAL_ISOTP_FORMAT]);
    deliver(6, 1);
    TEST_ASSERT_EQUAL_INT(6, hal_link_read(&link_, bytes, sizeof bytes));
}

void test_each_pdu_is_read_whole_also_in_pieces(void) {
    open_it();
    deliver(HAL_ISOTP_PDU_MAX, 1);
    deliver(6, 100);
    TEST_ASSERT_EQUAL_INT(HAL_ISOTP_PDU_MAX, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(4, hal_link_read(&link_, bytes, 4));
    TEST_ASSERT_EQUAL_UINT8(100, bytes[0]);
    TEST_ASSERT_EQUAL_INT(2, hal_link_read(&link_, bytes, 4));
    TEST_ASSERT_EQUAL_UINT8(104, bytes[0]);
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, 4));
    TEST_ASSERT_EQUAL_UINT32(HAL_ISOTP_PDU_MAX + 6, hal_link_counters(&link_).bytes_in);
}

void test_a_pdu_longer_than_any_packet_is_refused_and_counted(void) {
    open_it();
    deliver(HAL_ISOTP_PDU_MAX + 1, 1);
    deliver(400, 1);
    deliver(7, 50);
    TEST_ASSERT_EQUAL_INT(7, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_UINT8(50, bytes[0]);
    TEST_ASSERT_EQUAL_UINT32(2, isotp.errors[HAL_ISOTP_TOO_LONG]);
}

void test_errors_of_a_transfer_are_counted_and_survived(void) {
    static const struct {
        int number;
        hal_isotp_error_t error;
    } table[] = {{ECOMM, HAL_ISOTP_NO_FLOW},
                 {EMSGSIZE, HAL_ISOTP_OVERFLOW},
                 {ETIMEDOUT, HAL_ISOTP_TIMEOUT},
                 {EILSEQ, HAL_ISOTP_SEQUENCE},
                 {EBADMSG, HAL_ISOTP_BAD_FRAME}};
    open_it();
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        fake_can_deliver(-table[i].number, "", 0);
        deliver(6, 1);
        TEST_ASSERT_EQUAL_INT(6, hal_link_read(&link_, bytes, sizeof bytes));
        TEST_ASSERT_EQUAL_UINT32(1, isotp.errors[table[i].error]);
    }
    TEST_ASSERT_EQUAL_INT(0, fake_can.closed);
}

void test_a_flood_of_errors_does_not_hold_the_caller(void) {
    open_it();
    for (int i = 0; i < FAKE_CAN_STEPS; i++) {
        fake_can_deliver(-EILSEQ, "", 0);
    }
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_LESS_THAN_INT(FAKE_CAN_STEPS, fake_can.in_next);
}

void test_a_write_is_one_pdu(void) {
    static const uint8_t stop[] = {0xFA, 0xFB, 3, 29, 0, 29};
    open_it();
    TEST_ASSERT_EQUAL_INT(sizeof stop, hal_link_write(&link_, stop, sizeof stop));
    TEST_ASSERT_EQUAL_INT(1, fake_can.sends);
    TEST_ASSERT_EQUAL_size_t(sizeof stop, fake_can.sent_length[0]);
    TEST_ASSERT_EQUAL_MEMORY(stop, fake_can.sent[0], sizeof stop);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_TOO_LONG, hal_link_write(&link_, bytes, HAL_ISOTP_PDU_MAX + 1));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_ARGUMENT, hal_link_write(&link_, bytes, 0));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_ARGUMENT, hal_link_read(&link_, bytes, 0));
    TEST_ASSERT_EQUAL_INT(0, hal_link_flush(&link_));
}

void test_a_transfer_in_progress_is_waited_for_by_poll(void) {
    open_it();
    fake_can_answer_send(-EAGAIN);
    TEST_ASSERT_EQUAL_INT(0, hal_link_write(&link_, bytes, 6));
    TEST_ASSERT_EQUAL_UINT32(0, hal_link_hold_ms(&link_));
    TEST_ASSERT_EQUAL_INT(6, hal_link_write(&link_, bytes, 6));
    TEST_ASSERT_EQUAL_UINT32(1, hal_link_counters(&link_).would_block);
}

void test_a_full_queue_is_waited_for_by_time(void) {
    open_it();
    fake_can_answer_send(-ENOBUFS);
    TEST_ASSERT_EQUAL_INT(0, hal_link_write(&link_, bytes, 6));
    TEST_ASSERT_GREATER_THAN_UINT32(0, hal_link_hold_ms(&link_));
    TEST_ASSERT_EQUAL_UINT32(1, isotp.errors[HAL_ISOTP_NO_BUFFERS]);
    TEST_ASSERT_EQUAL_INT(6, hal_link_write(&link_, bytes, 6));
    TEST_ASSERT_EQUAL_UINT32(0, hal_link_hold_ms(&link_));
}

void test_a_failure_told_by_send_belongs_to_the_packet_before(void) {
    open_it();
    fake_can_answer_send(-ECOMM);
    TEST_ASSERT_EQUAL_INT(0, hal_link_write(&link_, bytes, 6));
    TEST_ASSERT_EQUAL_UINT32(1, isotp.errors[HAL_ISOTP_NO_FLOW]);
    TEST_ASSERT_EQUAL_INT(6, hal_link_write(&link_, bytes, 6));
}

void test_down_and_up_again_on_the_same_socket(void) {
    open_it();
    fake_can_deliver(-ENETDOWN, "", 0);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_DOWN, hal_link_read(&link_, bytes, sizeof bytes));
    hal_link_close(&link_);
    hal_link_close(&link_);
    TEST_ASSERT_EQUAL_INT(-1, hal_link_fd(&link_));
    fake_can.flags = 0;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_DOWN, hal_isotp_open(&isotp, &spec));
    fake_can.flags = IFF_UP;
    deliver(6, 1); // from before: would be a SIP of the past
    open_it();
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(1, fake_can.opened);
    TEST_ASSERT_EQUAL_INT(0, fake_can.closed);
    TEST_ASSERT_EQUAL_UINT32(1, isotp.errors[HAL_ISOTP_DOWN]);
    fake_can_answer_send(-ENETDOWN);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_DOWN, hal_link_write(&link_, bytes, 6));
}

void test_removed_and_made_anew_takes_a_new_socket(void) {
    open_it();
    fake_can_answer_send(-ENXIO);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_GONE, hal_link_write(&link_, bytes, 6));
    hal_link_close(&link_);
    TEST_ASSERT_EQUAL_INT(1, fake_can.closed);
    fake_can.index = 4;
    open_it();
    TEST_ASSERT_EQUAL_INT(2, fake_can.opened);
    // Down first, then removed and made anew while nobody looked.
    fake_can_deliver(-ENETDOWN, "", 0);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_DOWN, hal_link_read(&link_, bytes, sizeof bytes));
    hal_link_close(&link_);
    fake_can.index = 5;
    open_it();
    TEST_ASSERT_EQUAL_INT(3, fake_can.opened);
    TEST_ASSERT_EQUAL_INT(2, fake_can.closed);
    TEST_ASSERT_EQUAL_INT(5, fake_can.address.can_ifindex);
}

void test_open_twice_is_refused(void) {
    open_it();
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BUSY, hal_isotp_open(&isotp, &spec));
}

static void explained(hal_link_error_t error, const char *part) {
    hal_isotp_explain(error, &spec, text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, part), text);
    TEST_ASSERT_NULL(strchr(text, '\n'));
}

void test_explanations_name_the_module_and_the_command(void) {
    explained(HAL_LINK_NO_CAN, "modprobe can-isotp");
    explained(HAL_LINK_NO_PROTOCOL, "module can-isotp is not loaded: modprobe can-isotp");
    explained(HAL_LINK_NOT_FOUND, "modprobe vcan; ip link add vcan0 type vcan; ip link set vcan0 up");
    explained(HAL_LINK_DOWN, "ip link set vcan0 up");
    explained(HAL_LINK_NOT_CAN, "not a CAN interface");
    explained(HAL_LINK_NO_FD, "ip link set vcan0 mtu 72");
    explained(HAL_LINK_DENIED, "vcan0: no permission");
}

void test_every_error_has_a_name_and_a_text(void) {
    for (int i = 0; i < HAL_ISOTP_ERRORS; i++) {
        TEST_ASSERT_GREATER_THAN_size_t(3, strlen(hal_isotp_error_name((hal_isotp_error_t)i)));
        TEST_ASSERT_GREATER_THAN_size_t(10, strlen(hal_isotp_error_text((hal_isotp_error_t)i)));
    }
    TEST_ASSERT_EQUAL_STRING("unknown", hal_isotp_error_name(HAL_ISOTP_ERRORS));
    TEST_ASSERT_EQUAL_STRING("unknown error", hal_isotp_error_text(HAL_ISOTP_ERRORS));
}
