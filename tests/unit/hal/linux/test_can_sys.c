// SPDX-License-Identifier: MIT
// Attacks: what the kernel says about an interface or a socket becomes the link error that names the cause.
#include <errno.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>

#include "fake_can.h"
#include "unity.h"

void setUp(void) {
    fake_can_reset();
}

void test_errno_becomes_a_link_error(void) {
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NO_CAN, hal_can_error_of(-EAFNOSUPPORT));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NO_PROTOCOL, hal_can_error_of(-EPROTONOSUPPORT));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_DOWN, hal_can_error_of(-ENETDOWN));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_GONE, hal_can_error_of(-ENODEV));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_GONE, hal_can_error_of(-ENXIO));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_GONE, hal_can_error_of(-EADDRNOTAVAIL));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_DENIED, hal_can_error_of(-EPERM));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_IO, hal_can_error_of(-E2BIG));
}

void test_an_interface_is_looked_at(void) {
    const int fd = fake_can_sys.socket(0, 0);
    TEST_ASSERT_EQUAL_INT(3, hal_can_interface(&fake_can_sys, fd, "can0", 0));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NO_FD, hal_can_interface(&fake_can_sys, fd, "can0", 1));
    fake_can.mtu = CANFD_MTU;
    TEST_ASSERT_EQUAL_INT(3, hal_can_interface(&fake_can_sys, fd, "can0", 1));
    fake_can.flags = 0;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_DOWN, hal_can_interface(&fake_can_sys, fd, "can0", 0));
    fake_can.hardware = ARPHRD_ETHER;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_CAN, hal_can_interface(&fake_can_sys, fd, "eth0", 0));
    fake_can.index = 0;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_FOUND, hal_can_interface(&fake_can_sys, fd, "can9", 0));
}

// On any kernel: the calls give -errno, never errno itself.
void test_the_systems_own_calls_report_failures_as_negative_numbers(void) {
    uint8_t byte = 0;
    struct ifreq about = {0};
    const struct sockaddr_can address = {.can_family = AF_CAN};
    TEST_ASSERT_LESS_THAN_INT(0, hal_can_sys.socket(9, 99));
    TEST_ASSERT_EQUAL_INT(-EBADF, hal_can_sys.control(-1, SIOCGIFINDEX, &about));
    TEST_ASSERT_EQUAL_INT(-EBADF, hal_can_sys.set(-1, 0, 0, &byte, 1));
    TEST_ASSERT_EQUAL_INT(-EBADF, hal_can_sys.bind(-1, &address));
    TEST_ASSERT_EQUAL_INT(-EBADF, (int)hal_can_sys.send(-1, &byte, 1));
    TEST_ASSERT_EQUAL_INT(-EBADF, (int)hal_can_sys.recv(-1, &byte, 1));
    TEST_ASSERT_EQUAL_INT(-EBADF, hal_can_sys.close(-1));
}
