// SPDX-License-Identifier: MIT
// The scheme serial:PATH[@BAUD].
#include <string.h>

#include "hal/links.h"
#include "hal/serial.h"

HAL_LINK_FITS(hal_serial_t, HAL_LINK_STATE_BYTES);

static bool parse(hal_link_spec_t *spec, const char *text, char *message, size_t capacity) {
    const char *const at = strrchr(text, '@');
    // A '@' may belong to the name of the file: only what follows the last '/' can be a rate.
    const bool has_baud = at != NULL && strchr(at, '/') == NULL;
    const size_t length = has_baud ? (size_t)(at - text) : strlen(text);
    spec->has_baud = has_baud;
    spec->baud = HAL_BAUD_DEFAULT;
    if (length == 0) {
        return hal_link_refuse(message, capacity,
                               "link serial:%s: no port is named; write serial:/dev/ttyUSB0@9600", text);
    }
    if (!hal_link_take_target(spec, text, length, HAL_PATH_MAX)) {
        return hal_link_refuse(message, capacity, "link serial:...: the path is longer than %d characters",
                               HAL_PATH_MAX - 1);
    }
    if (has_baud && (!hal_link_number(at + 1, &spec->baud) || !hal_baud_is_known(spec->baud))) {
        return hal_link_refuse(
            message, capacity,
            "link serial:%s: '%s' is not a rate of the robot; the rates are " HAL_BAUD_LIST, text, at + 1);
    }
    return true;
}

static void init(void *state) {
    hal_serial_init(state);
}

static hal_link_error_t open_port(void *state, const hal_link_spec_t *spec, int timeout_ms, int cancel_fd) {
    (void)timeout_ms; // opening a port does not wait
    (void)cancel_fd;
    return hal_serial_open(state, spec->target, spec->baud);
}

static hal_link_t link_of(void *state) {
    return hal_serial_link(state);
}

static void explain(const hal_link_spec_t *spec, hal_link_error_t error, char *text, size_t capacity) {
    hal_serial_explain(error, spec->target, text, capacity);
}

static bool moved(const void *state) {
    return hal_serial_moved(state);
}

static hal_link_error_t set_baud(void *state, uint32_t baud) {
    return hal_serial_set_baud(state, baud);
}

const hal_scheme_t hal_serial_scheme = {
    .word = "serial",
    .form = "serial:/dev/ttyUSB0@9600",
    .help = "serial:PATH[@BAUD] (default 9600)",
    .bare = "/dev/",
    .robot_place = "at the end of a serial link",
    .if_silent = " At another rate it is silent too: try --auto-baud",
    .if_garbage = "the rate is wrong or it is no robot: try --auto-baud",
    .if_turned_away = "is the device in order, and is nobody else at it?",
    .parse = parse,
    .init = init,
    .open = open_port,
    .link = link_of,
    .explain = explain,
    .moved = moved,
    .set_baud = set_baud,
};
