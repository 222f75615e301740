// SPDX-License-Identifier: MIT
// A serial port as a link: 8N1, raw, exclusive; also /dev/serial/by-id names and ptys.
#ifndef HAL_SERIAL_H
#define HAL_SERIAL_H

#include <stdbool.h>
#include <stdint.h>
#include <termios.h>

#include "hal/fd_link.h"

#define HAL_PATH_MAX 256

// The rates of ARCOS, in the order in which they are worth trying.
#define HAL_BAUD_TABLE(X) X(9600) X(38400) X(115200) X(19200) X(57600)
#define HAL_BAUD_DEFAULT 9600
#define HAL_BAUD_LIST "9600, 19200, 38400, 57600, 115200"

extern const uint32_t hal_baud_table[];
extern const uint8_t hal_baud_count;
bool hal_baud_is_known(uint32_t baud);

typedef struct {
    hal_fd_link_t port;
    uint32_t baud;
    bool has_saved;
    bool exclusive;       // TIOCEXCL is set
    struct termios saved; // as found; put back on close
    char path[HAL_PATH_MAX];
    char text[HAL_PATH_MAX + 32];
} hal_serial_t;

// A port that is not open; call once before the first hal_serial_open().
void hal_serial_init(hal_serial_t *self);

// Opens the port: no controlling terminal, non-blocking, locked against a second user, what was waiting is
// thrown away. On an error `self` stays closed and may be opened again. Does not block: carrier is ignored.
hal_link_error_t hal_serial_open(hal_serial_t *self, const char *path, uint32_t baud);

// Changes the rate of an open port; what was waiting in either direction is thrown away.
hal_link_error_t hal_serial_set_baud(hal_serial_t *self, uint32_t baud);

// True when the path now leads to another device than the one that is open: a name whose adapter came back
// elsewhere.
bool hal_serial_moved(const hal_serial_t *self);

hal_link_t hal_serial_link(hal_serial_t *self);

// What to do about an error of hal_serial_open(), on one line: which ports there are, which group is missing,
// which program holds the port. Cost: may scan /proc and /dev, so for start-up only.
void hal_serial_explain(hal_link_error_t error, const char *path, char *text, size_t capacity);

#endif
