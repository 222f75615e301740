// SPDX-License-Identifier: MIT
// Attacks: every form of a CAN spec is understood with its defaults, every malformed one is refused on one
// line that says what to write.
#include <string.h>

#include "hal/can_spec.h"
#include "unity.h"

static hal_can_spec_t spec;
static char message[256];

static void taken(const char *text) {
    message[0] = '\0';
    TEST_ASSERT_TRUE_MESSAGE(hal_can_spec_parse(&spec, text, message, sizeof message), message);
}

static void refused(const char *text, const char *part) {
    TEST_ASSERT_FALSE_MESSAGE(hal_can_spec_parse(&spec, text, message, sizeof message), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, part), message);
    TEST_ASSERT_NULL_MESSAGE(strchr(message, '\n'), message);
}

void test_defaults(void) {
    taken("vcan0");
    TEST_ASSERT_EQUAL_STRING("vcan0", spec.interface);
    TEST_ASSERT_EQUAL_HEX16(0x640, spec.tx_id);
    TEST_ASSERT_EQUAL_HEX16(0x648, spec.rx_id);
    TEST_ASSERT_TRUE(spec.pads);
    TEST_ASSERT_EQUAL_HEX8(0xCC, spec.padding);
    TEST_ASSERT_EQUAL_UINT8(0, spec.stmin);
    TEST_ASSERT_EQUAL_UINT8(0, spec.blocksize);
    TEST_ASSERT_FALSE(spec.fd);
}

void test_every_robot_has_its_pair_of_ids(void) {
    for (char k = '0'; k <= '7'; k++) {
        char text[] = "can0,robot=0";
        text[11] = k;
        taken(text);
        TEST_ASSERT_EQUAL_UINT8(k - '0', spec.robot);
        TEST_ASSERT_EQUAL_HEX16(0x640 + k - '0', spec.tx_id);
        TEST_ASSERT_EQUAL_HEX16(0x648 + k - '0', spec.rx_id);
    }
}

void test_everything_can_be_given(void) {
    taken("can1,fd,pad=0x55,stmin=5,bs=8,tx=0x7FF,rx=0,robot=2");
    TEST_ASSERT_EQUAL_HEX16(0x7FF, spec.tx_id);
    TEST_ASSERT_EQUAL_HEX16(0, spec.rx_id);
    TEST_ASSERT_EQUAL_HEX8(0x55, spec.padding);
    TEST_ASSERT_EQUAL_UINT8(5, spec.stmin);
    TEST_ASSERT_EQUAL_UINT8(8, spec.blocksize);
    TEST_ASSERT_EQUAL_UINT8(2, spec.robot);
    TEST_ASSERT_TRUE(spec.fd);
    taken("can1,pad=none");
    TEST_ASSERT_FALSE(spec.pads);
    taken("fifteen-letters,tx=1600"); // 0x640 in decimal
    TEST_ASSERT_EQUAL_HEX16(0x640, spec.tx_id);
}

void test_refusals_say_what_to_write(void) {
    refused("", "no interface is named");
    refused(",fd", "no interface is named");
    refused("sixteen-letters-", "cannot be the name");
    refused("a/b", "cannot be the name");
    refused("can0:1", "cannot be the name");
    refused("can0,", "is no option; write can:can0");
    refused("can0,quick", "'quick' is no option");
    refused("can0,speed=5", "'speed' is no key");
    refused("can0,robot=8", "robot=8: give a number from 0 to 7");
    refused("can0,robot=", "robot=: give a number");
    refused("can0,robot=-1", "give a number");
    refused("can0,tx=0x800", "tx=0x800: give a number from 0 to 2047");
    refused("can0,tx=0x", "give a number");
    refused("can0,tx=64A", "give a number");
    refused("can0,pad=256", "from 0 to 255");
    refused("can0,stmin=128", "from 0 to 127");
    refused("can0,bs=256", "from 0 to 255");
    refused("can0,bs=99999999999", "from 0 to 255");
    refused("can0,tx=0x648", "tx and rx are both 0x648");
    refused("can0,an-option-that-is-much-too-long-for-any-use", "is no option");
}

void test_telemetry_takes_interface_and_robot_only(void) {
    TEST_ASSERT_TRUE(hal_can_spec_parse_telemetry(&spec, "can0", message, sizeof message));
    TEST_ASSERT_TRUE(hal_can_spec_parse_telemetry(&spec, "can0,robot=3", message, sizeof message));
    TEST_ASSERT_EQUAL_UINT8(3, spec.robot);
    TEST_ASSERT_FALSE(hal_can_spec_parse_telemetry(&spec, "can0,fd", message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "'fd' is not for the telemetry"), message);
    TEST_ASSERT_FALSE(hal_can_spec_parse_telemetry(&spec, "can0,robot=3,fd", message, sizeof message));
    TEST_ASSERT_FALSE(hal_can_spec_parse_telemetry(&spec, "can0,robot=9", message, sizeof message));
}

void test_a_message_that_does_not_fit_is_cut(void) {
    char small[12];
    TEST_ASSERT_FALSE(hal_can_spec_parse(&spec, "can0,speed=5", small, sizeof small));
    TEST_ASSERT_EQUAL_size_t(sizeof small - 1, strlen(small));
}
