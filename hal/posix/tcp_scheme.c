// SPDX-License-Identifier: MIT
// The scheme tcp:HOST[:PORT]; an IPv6 address goes in brackets, as in tcp:[::1]:8101.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "hal/links.h"
#include "hal/tcp.h"

typedef struct {
    uint16_t port;
} address_t;

HAL_LINK_FITS(address_t, HAL_LINK_ADDRESS_BYTES);
HAL_LINK_FITS(hal_tcp_t, HAL_LINK_STATE_BYTES);

static uint16_t port_of(const hal_link_spec_t *spec) {
    address_t address;
    memcpy(&address, spec->address.bytes, sizeof address);
    return address.port;
}

// Splits HOST, HOST:PORT, [V6] and [V6]:PORT. `*port` is NULL without one.
static bool split_host(const char *text, const char **host, size_t *length, const char **port) {
    *host = text;
    *port = NULL;
    if (text[0] == '[') {
        const char *const end = strchr(text, ']');
        if (end == NULL || (end[1] != '\0' && end[1] != ':')) {
            return false;
        }
        *host = text + 1;
        *length = (size_t)(end - *host);
        *port = end[1] == ':' ? end + 2 : NULL;
        return true;
    }
    const char *const colon = strchr(text, ':');
    if (colon != NULL && strchr(colon + 1, ':') != NULL) {
        return false;
    }
    *length = colon == NULL ? strlen(text) : (size_t)(colon - text);
    *port = colon == NULL ? NULL : colon + 1;
    return true;
}

static bool take_port(hal_link_spec_t *spec, const char *text, const char *port, char *message,
                      size_t capacity) {
    uint32_t value = HAL_TCP_PORT_DEFAULT;
    if (port != NULL && port[0] == '\0') {
        return hal_link_refuse(message, capacity,
                               "link tcp:%s: the port after ':' is missing; write tcp:%s:8101", text,
                               spec->target);
    }
    if (port != NULL && (!hal_link_number(port, &value) || value == 0 || value > 65535)) {
        return hal_link_refuse(message, capacity,
                               "link tcp:%s: '%s' is not a port; give a number from 1 to 65535", text, port);
    }
    const address_t address = {.port = (uint16_t)value};
    memcpy(spec->address.bytes, &address, sizeof address);
    return true;
}

static bool parse(hal_link_spec_t *spec, const char *text, char *message, size_t capacity) {
    const char *host = NULL;
    const char *port = NULL;
    size_t length = 0;
    if (!split_host(text, &host, &length, &port)) {
        return hal_link_refuse(message, capacity,
                               "link tcp:%s: an IPv6 address goes in brackets; write tcp:[::1]:8101", text);
    }
    if (length == 0) {
        return hal_link_refuse(message, capacity, "link tcp:%s: no host is named; write tcp:HOST:8101", text);
    }
    if (!hal_link_take_target(spec, host, length, HAL_HOST_MAX)) {
        return hal_link_refuse(message, capacity, "link tcp:...: the host name is longer than %d characters",
                               HAL_HOST_MAX - 1);
    }
    return take_port(spec, text, port, message, capacity);
}

static void name(const hal_link_spec_t *spec, char *text, size_t capacity) {
    snprintf(text, capacity, "%s port %u", spec->target, (unsigned)port_of(spec));
}

// A box that joins Ethernet and a serial line looks like an emulator, but is another machine. Of names only
// localhost is believed, since what answers for any other may change.
static bool stays_here(const hal_link_spec_t *spec) {
    struct in_addr v4;
    struct in6_addr v6;
    if (inet_pton(AF_INET, spec->target, &v4) == 1) {
        return ntohl(v4.s_addr) >> 24 == 127;
    }
    if (inet_pton(AF_INET6, spec->target, &v6) == 1) {
        return IN6_IS_ADDR_LOOPBACK(&v6);
    }
    return strcasecmp(spec->target, "localhost") == 0;
}

static void init(void *state) {
    hal_tcp_init(state);
}

static hal_link_error_t open_socket(void *state, const hal_link_spec_t *spec, int timeout_ms, int cancel_fd) {
    return hal_tcp_open(state, spec->target, port_of(spec), timeout_ms, cancel_fd);
}

static hal_link_t link_of(void *state) {
    return hal_tcp_link(state);
}

static void explain(const hal_link_spec_t *spec, hal_link_error_t error, char *text, size_t capacity) {
    char target[HAL_LINK_NAME_MAX];
    const char *advice = "";
    if (error == HAL_LINK_REFUSED) {
        advice = "; start the robot's server or emulator, or check the port";
    } else if (error == HAL_LINK_UNRESOLVED) {
        advice = "; check the name or give the address";
    } else if (error == HAL_LINK_TIMEOUT || error == HAL_LINK_UNREACHABLE) {
        advice = "; check the network and that the robot is on";
    }
    name(spec, target, sizeof target);
    snprintf(text, capacity, "%s: %s%s", target, hal_link_error_text(error), advice);
}

const hal_scheme_t hal_tcp_scheme = {
    .word = "tcp",
    .form = "tcp:HOST:8101",
    .help = "tcp:HOST[:PORT] (default 8101)",
    .robot_place = "at the end of a TCP link that leaves this machine",
    .if_silent = " Is another client using it?",
    .if_garbage = "this is no ARCOS server: check the port",
    .if_turned_away = "another client may be using the robot; end that one, or check the port",
    .parse = parse,
    .name = name,
    .stays_here = stays_here,
    .init = init,
    .open = open_socket,
    .link = link_of,
    .explain = explain,
};
