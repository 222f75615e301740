// SPDX-License-Identifier: MIT
// Parses serial:PATH[@BAUD], tcp:HOST[:PORT] and can:IFACE[,options].
#include "hal/link_spec.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define FORMS "serial:/dev/ttyUSB0@9600, tcp:HOST:8101 or can:can0"

typedef struct {
    char *text;
    size_t capacity;
} message_t;

__attribute__((format(printf, 2, 3))) static bool refuse(const message_t *message, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message->text, message->capacity, format, arguments);
    va_end(arguments);
    return false;
}

// A decimal number of 1 to 6 digits and nothing else.
static bool number(const char *text, uint32_t *value) {
    const size_t digits = strspn(text, "0123456789");
    if (digits == 0 || digits > 6 || text[digits] != '\0') {
        return false;
    }
    *value = 0;
    for (size_t i = 0; i < digits; i++) {
        *value = *value * 10u + (uint32_t)(text[i] - '0');
    }
    return true;
}

static bool copy(char *to, size_t capacity, const char *from, size_t length) {
    if (length == 0 || length >= capacity) {
        return false;
    }
    memcpy(to, from, length);
    to[length] = '\0';
    return true;
}

static bool parse_serial(hal_link_spec_t *spec, const char *text, const message_t *message) {
    const char *const at = strrchr(text, '@');
    // A '@' may belong to the name of the file: only what follows the last '/' can be a rate.
    const bool has_baud = at != NULL && strchr(at, '/') == NULL;
    const size_t length = has_baud ? (size_t)(at - text) : strlen(text);
    spec->scheme = HAL_SCHEME_SERIAL;
    spec->has_baud = has_baud;
    spec->baud = HAL_BAUD_DEFAULT;
    if (length == 0) {
        return refuse(message, "link serial:%s: no port is named; write serial:/dev/ttyUSB0@9600", text);
    }
    if (!copy(spec->path, sizeof spec->path, text, length)) {
        return refuse(message, "link serial:...: the path is longer than %d characters", HAL_PATH_MAX - 1);
    }
    if (has_baud && (!number(at + 1, &spec->baud) || !hal_baud_is_known(spec->baud))) {
        return refuse(message,
                      "link serial:%s: '%s' is not a rate of the robot; the rates are " HAL_BAUD_LIST, text,
                      at + 1);
    }
    return true;
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

static bool parse_tcp(hal_link_spec_t *spec, const char *text, const message_t *message) {
    const char *host = NULL;
    const char *port = NULL;
    size_t length = 0;
    uint32_t value = HAL_TCP_PORT_DEFAULT;
    spec->scheme = HAL_SCHEME_TCP;
    if (!split_host(text, &host, &length, &port)) {
        return refuse(message, "link tcp:%s: an IPv6 address goes in brackets; write tcp:[::1]:8101", text);
    }
    if (length == 0) {
        return refuse(message, "link tcp:%s: no host is named; write tcp:HOST:8101", text);
    }
    if (!copy(spec->host, sizeof spec->host, host, length)) {
        return refuse(message, "link tcp:...: the host name is longer than %d characters", HAL_HOST_MAX - 1);
    }
    if (port != NULL && port[0] == '\0') {
        return refuse(message, "link tcp:%s: the port after ':' is missing; write tcp:%s:8101", text,
                      spec->host);
    }
    if (port != NULL && (!number(port, &value) || value == 0 || value > 65535)) {
        return refuse(message, "link tcp:%s: '%s' is not a port; give a number from 1 to 65535", text, port);
    }
    spec->port = (uint16_t)value;
    return true;
}

bool hal_link_spec_parse(hal_link_spec_t *spec, const char *text, char *message_text, size_t capacity) {
    const message_t message = {.text = message_text, .capacity = capacity};
    memset(spec, 0, sizeof *spec);
    if (strncmp(text, "serial:", 7) == 0) {
        return parse_serial(spec, text + 7, &message);
    }
    if (strncmp(text, "tcp:", 4) == 0) {
        return parse_tcp(spec, text + 4, &message);
    }
    if (strncmp(text, "can:", 4) == 0) {
        spec->scheme = HAL_SCHEME_CAN;
        return hal_can_spec_parse(&spec->can, text + 4, message_text, capacity);
    }
    if (strncmp(text, "/dev/", 5) == 0) {
        return refuse(&message, "link '%s': the scheme is missing; write serial:%s", text, text);
    }
    return refuse(&message, "link '%s': unknown scheme; write " FORMS, text);
}

const char *hal_link_spec_target(const hal_link_spec_t *spec) {
    switch (spec->scheme) {
    case HAL_SCHEME_TCP:
        return spec->host;
    case HAL_SCHEME_CAN:
        return spec->can.interface;
    case HAL_SCHEME_SERIAL:
    default:
        return spec->path;
    }
}
