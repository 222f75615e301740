// SPDX-License-Identifier: MIT
// Attacks: every form of a link spec is understood, every malformed one is refused with a line that says what
// to write.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/links.h"
#include "hal/tcp.h"
#include "unity.h"

static hal_link_spec_t spec;
static char message[256];

static bool parse(const char *text) {
    message[0] = '\0';
    return hal_link_spec_parse(&spec, text, message, sizeof message);
}

static void refused(const char *text, const char *part) {
    TEST_ASSERT_FALSE_MESSAGE(parse(text), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, part), message);
    TEST_ASSERT_NULL_MESSAGE(strchr(message, '\n'), message);
}

static void serial(const char *text, const char *path, uint32_t baud, bool has_baud) {
    TEST_ASSERT_TRUE_MESSAGE(parse(text), message);
    TEST_ASSERT_EQUAL_PTR(&hal_serial_scheme, spec.scheme);
    TEST_ASSERT_EQUAL_STRING(path, spec.target);
    TEST_ASSERT_EQUAL_UINT32(baud, spec.baud);
    TEST_ASSERT_EQUAL_INT(has_baud, spec.has_baud);
}

static void tcp(const char *text, const char *host, uint16_t port) {
    char expected[160];
    char name[HAL_LINK_NAME_MAX];
    TEST_ASSERT_TRUE_MESSAGE(parse(text), message);
    TEST_ASSERT_EQUAL_PTR(&hal_tcp_scheme, spec.scheme);
    TEST_ASSERT_EQUAL_STRING(host, spec.target);
    TEST_ASSERT_EQUAL_UINT32(0, spec.baud);
    snprintf(expected, sizeof expected, "%s port %u", host, (unsigned)port);
    hal_link_spec_name(&spec, name, sizeof name);
    TEST_ASSERT_EQUAL_STRING(expected, name);
}

void test_serial_forms(void) {
    serial("serial:/dev/ttyUSB0@9600", "/dev/ttyUSB0", 9600, true);
    serial("serial:/dev/ttyUSB0", "/dev/ttyUSB0", 9600, false);
    serial("serial:/dev/ttyS1@115200", "/dev/ttyS1", 115200, true);
    serial("serial:rel/pty@38400", "rel/pty", 38400, true);
    serial("serial:/dev/serial/by-id/usb-Prolific_2303-if00-port0@57600",
           "/dev/serial/by-id/usb-Prolific_2303-if00-port0", 57600, true);
    serial("serial:/dev/ttyUSB0@19200", "/dev/ttyUSB0", 19200, true);
    serial("serial:/tmp/a@b/pty", "/tmp/a@b/pty", 9600, false);
    serial("serial:/tmp/a@b/pty@9600", "/tmp/a@b/pty", 9600, true);
}

void test_tcp_forms(void) {
    tcp("tcp:robot:9000", "robot", 9000);
    tcp("tcp:robot", "robot", HAL_TCP_PORT_DEFAULT);
    tcp("tcp:127.0.0.1:1", "127.0.0.1", 1);
    tcp("tcp:[::1]:65535", "::1", 65535);
    tcp("tcp:[fe80::1]", "fe80::1", HAL_TCP_PORT_DEFAULT);
}

void test_can_forms(void) {
    TEST_ASSERT_TRUE_MESSAGE(parse("can:vcan0,robot=3"), message);
    TEST_ASSERT_EQUAL_PTR(&hal_can_scheme, spec.scheme);
    TEST_ASSERT_EQUAL_STRING("vcan0", hal_link_spec_bus(&spec)->interface);
    TEST_ASSERT_EQUAL_HEX16(0x643, hal_link_spec_bus(&spec)->tx_id);
}

void test_every_scheme_has_a_target(void) {
    TEST_ASSERT_TRUE(parse("serial:/dev/ttyUSB0@9600"));
    TEST_ASSERT_EQUAL_STRING("/dev/ttyUSB0", hal_link_spec_target(&spec));
    TEST_ASSERT_TRUE(parse("tcp:robot:9000"));
    TEST_ASSERT_EQUAL_STRING("robot", hal_link_spec_target(&spec));
    TEST_ASSERT_TRUE(parse("can:can1"));
    TEST_ASSERT_EQUAL_STRING("can1", hal_link_spec_target(&spec));
    hal_link_spec_name(&spec, message, sizeof message);
    TEST_ASSERT_EQUAL_STRING("can1", message);
    memset(&spec, 0, sizeof spec);
    TEST_ASSERT_EQUAL_STRING("", hal_link_spec_target(&spec));
}

// A scheme that leaves one out would fail only once argusd asks.
void test_every_row_is_whole(void) {
    size_t count = 0;
    for (const hal_scheme_t *row = NULL; (row = hal_scheme_at(count)) != NULL; count++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(row->word, "word");
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(row->word, row->form, strlen(row->word), "form");
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(row->word, row->help, strlen(row->word), "help");
        TEST_ASSERT_TRUE_MESSAGE(strcspn(row->help, "\n") <= 79, row->help);
        TEST_ASSERT_TRUE_MESSAGE(row->robot_place != NULL && row->if_silent != NULL, row->word);
        TEST_ASSERT_TRUE_MESSAGE(row->if_garbage != NULL && row->if_turned_away != NULL, row->word);
        TEST_ASSERT_TRUE_MESSAGE(row->parse != NULL && row->init != NULL && row->open != NULL, row->word);
        TEST_ASSERT_TRUE_MESSAGE(row->link != NULL && row->explain != NULL, row->word);
        TEST_ASSERT_TRUE_MESSAGE((row->bus == NULL) == (row->isotp == NULL), row->word);
        TEST_ASSERT_TRUE_MESSAGE(parse(row->form), message);
        TEST_ASSERT_EQUAL_PTR_MESSAGE(row, spec.scheme, "no word begins like another's");
        TEST_ASSERT_EQUAL_INT_MESSAGE(row->set_baud != NULL, spec.baud != 0, row->word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(row->set_baud != NULL, hal_link_spec_has_rate(&spec), row->word);
    }
    TEST_ASSERT_GREATER_OR_EQUAL_size_t(3, count);
    TEST_ASSERT_NULL(hal_scheme_at(count));
}

void test_the_forms_are_all_told_and_fit_any_room(void) {
    char forms[256];
    for (size_t capacity = 1; capacity <= sizeof forms; capacity++) {
        memset(forms, 'x', sizeof forms);
        hal_scheme_forms(forms, capacity);
        TEST_ASSERT_LESS_THAN_size_t(capacity, strlen(forms));
    }
    TEST_ASSERT_EQUAL_STRING_LEN("serial:/dev/ttyUSB0@9600, tcp:HOST:8101", forms, 39);
    for (size_t i = 0; hal_scheme_at(i) != NULL; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(forms, hal_scheme_at(i)->form), forms);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(forms, " or "), forms);
}

// What is not certain to be this machine may have a robot behind it.
void test_only_tcp_to_this_machine_stays_here(void) {
    static const char *const here[] = {
        "tcp:127.0.0.1:8101", "tcp:127.0.0.1",  "tcp:127.255.255.254:1", "tcp:localhost",
        "tcp:LocalHost:8101", "tcp:[::1]:8101", "tcp:[0:0::1]",
    };
    static const char *const away[] = {
        "serial:/dev/ttyUSB0",
        "serial:/tmp/p3dx@9600",
        "serial:localhost",
        "can:can0",
        "can:vcan0,robot=1",
        "tcp:robot:8101",
        "tcp:192.168.1.20",
        "tcp:10.0.0.1:8101",
        "tcp:0.0.0.0",
        "tcp:128.0.0.1",
        "tcp:126.255.255.255",
        "tcp:1.0.0.127",
        "tcp:[::]",
        "tcp:[fe80::1]",
        "tcp:[::2]",
        "tcp:[::ffff:10.0.0.1]",
        "tcp:localhost.lan",
        "tcp:localhostile",
        "tcp:127.0.0.1.lan",
        "tcp:127.0.0.1 ",
        "tcp:local",
        "tcp:127.example.org",
    };
    for (size_t i = 0; i < sizeof here / sizeof here[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(parse(here[i]), message);
        TEST_ASSERT_TRUE_MESSAGE(hal_link_spec_stays_here(&spec), here[i]);
    }
    for (size_t i = 0; i < sizeof away / sizeof away[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(parse(away[i]), message);
        TEST_ASSERT_FALSE_MESSAGE(hal_link_spec_stays_here(&spec), away[i]);
    }
}

void test_refusals_say_what_to_write(void) {
    refused("", "unknown scheme");
    refused("serail:/dev/ttyS0", "unknown scheme; did you mean serial? write serial:/dev/ttyUSB0@9600");
    refused("tpc:robot", "; did you mean tcp?");
    refused("udp:robot:1", "unknown scheme; write serial:/dev/ttyUSB0@9600, tcp:HOST:8101");
    refused("can:", "no interface is named");
    refused("can:can0,quick", "is no option");
    refused("/dev/ttyUSB0", "write serial:/dev/ttyUSB0");
    refused("serial:", "no port is named");
    refused("serial:@9600", "no port is named");
    refused("serial:/dev/ttyUSB0@9601", "9600, 19200, 38400, 57600, 115200");
    refused("serial:/dev/ttyUSB0@", "'' is not a rate");
    refused("serial:/dev/ttyUSB0@9600x", "'9600x' is not a rate");
    refused("serial:/dev/ttyUSB0@-9600", "is not a rate");
    refused("serial:/dev/ttyUSB0@99999999999999999999", "is not a rate");
    refused("tcp:", "no host is named");
    refused("tcp::8101", "no host is named");
    refused("tcp:robot:", "port after ':' is missing");
    refused("tcp:robot:0", "from 1 to 65535");
    refused("tcp:robot:65536", "from 1 to 65535");
    refused("tcp:robot:80 ", "is not a port");
    refused("tcp:robot:http", "is not a port");
    refused("tcp:::1:8101", "in brackets");
    refused("tcp:[::1", "in brackets");
    refused("tcp:[::1]8101", "in brackets");
    refused("tcp:[]:8101", "no host is named");
}

void test_too_long_names_are_refused(void) {
    char text[600];
    memset(text, 'a', sizeof text);
    text[sizeof text - 1] = '\0';
    memcpy(text, "serial:", 7);
    refused(text, "longer than");
    memcpy(text, "tcp:aaa", 7);
    refused(text, "longer than");
}

void test_any_text_is_survived_and_messages_fit(void) {
    srand(7);
    for (int round = 0; round < 100000; round++) {
        char text[48];
        static const char alphabet[] = "serialtcpan=,xfd:/@[]0123456789.\xff%";
        const int length = rand() % (int)(sizeof text - 1);
        for (int i = 0; i < length; i++) {
            text[i] = alphabet[rand() % (int)(sizeof alphabet - 1)];
        }
        text[length] = '\0';
        const char *const heads[] = {"", "serial:", "tcp:", "tcp:[", "can:", "can:can0,"};
        char whole[64];
        char small[16];
        snprintf(whole, sizeof whole, "%s%s", heads[round % 6], text);
        small[15] = 'x';
        if (!hal_link_spec_parse(&spec, whole, small, 15)) {
            TEST_ASSERT_LESS_THAN_size_t(15, strlen(small));
        }
        TEST_ASSERT_EQUAL_CHAR('x', small[15]);
    }
}
