// SPDX-License-Identifier: MIT
// Attacks: a parsed spec opens the transport that it names, and a failure is explained on one line.
#include <pty.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "hal/links.h"
#include "unity.h"

static hal_transport_t transport;
static hal_link_spec_t spec;
static char message[512];

static void parse(const char *text) {
    hal_transport_init(&transport);
    TEST_ASSERT_TRUE(hal_link_spec_parse(&spec, text, message, sizeof message));
}

static void explained(hal_link_error_t error, const char *part) {
    hal_transport_explain(&spec, error, message, sizeof message);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, part), message);
    TEST_ASSERT_NULL(strchr(message, '\n'));
}

void test_serial_spec_opens_the_port(void) {
    char name[64];
    char text[96];
    int master = -1;
    int slave = -1;
    hal_link_t link = {0};
    TEST_ASSERT_EQUAL_INT(0, openpty(&master, &slave, name, NULL, NULL));
    snprintf(text, sizeof text, "serial:%s@38400", name);
    parse(text);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_transport_open(&transport, &spec, 100, -1, &link));
    TEST_ASSERT_EQUAL_STRING(text, hal_link_describe(&link));
    hal_link_close(&link);
    close(master);
    close(slave);
}

void test_failures_are_explained(void) {
    hal_link_t link = {0};
    parse("serial:/dev/no-such-port");
    const hal_link_error_t missing = hal_transport_open(&transport, &spec, 100, -1, &link);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_FOUND, missing);
    TEST_ASSERT_NULL(link.ops);
    explained(missing, "/dev/no-such-port: no such file");
    parse("tcp:127.0.0.1:1");
    const hal_link_error_t refused = hal_transport_open(&transport, &spec, 100, -1, &link);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_REFUSED, refused);
    explained(refused, "127.0.0.1 port 1: nobody listens there; start the robot's server");
    explained(HAL_LINK_UNRESOLVED, "check the name");
    explained(HAL_LINK_TIMEOUT, "check the network");
}

void test_can_spec_opens_the_interface_or_says_what_to_load(void) {
    hal_link_t link = {0};
    parse("can:no-such-if");
    const hal_link_error_t missing = hal_transport_open(&transport, &spec, 100, -1, &link);
    // A kernel without CAN says so before it looks for the interface.
    TEST_ASSERT_TRUE(missing == HAL_LINK_NOT_FOUND || missing == HAL_LINK_NO_CAN ||
                     missing == HAL_LINK_NO_PROTOCOL);
    TEST_ASSERT_NULL(link.ops);
    explained(missing, "modprobe");
    explained(HAL_LINK_DOWN, "ip link set no-such-if up");
    TEST_ASSERT_FALSE(hal_transport_moved(&transport));
}

// argusd has one transport: what one scheme left in it is not another's.
void test_one_memory_serves_one_scheme_after_the_other(void) {
    char name[64];
    char text[96];
    int master = -1;
    int slave = -1;
    hal_link_t link = {0};
    parse("serial:/dev/null");
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_BAUD, hal_transport_set_baud(&transport, 9600));
    TEST_ASSERT_NULL(hal_transport_isotp(&transport));
    TEST_ASSERT_FALSE(hal_transport_moved(&transport));
    memset(transport.state.bytes, 0xA5, sizeof transport.state.bytes);
    TEST_ASSERT_EQUAL_INT(0, openpty(&master, &slave, name, NULL, NULL));
    snprintf(text, sizeof text, "serial:%s@38400", name);
    TEST_ASSERT_TRUE(hal_link_spec_parse(&spec, text, message, sizeof message));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_transport_open(&transport, &spec, 100, -1, &link));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_transport_set_baud(&transport, 9600));
    TEST_ASSERT_FALSE(hal_transport_moved(&transport));
    hal_link_close(&link);
    TEST_ASSERT_TRUE(hal_link_spec_parse(&spec, "tcp:127.0.0.1:1", message, sizeof message));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_REFUSED, hal_transport_open(&transport, &spec, 100, -1, &link));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_BAUD, hal_transport_set_baud(&transport, 9600));
    TEST_ASSERT_TRUE(hal_link_spec_parse(&spec, "can:no-such-if", message, sizeof message));
    TEST_ASSERT_TRUE(hal_transport_open(&transport, &spec, 100, -1, &link) != HAL_LINK_OK);
    TEST_ASSERT_EQUAL_UINT32(0, hal_transport_isotp(&transport)->errors[0]);
    close(master);
    close(slave);
}
