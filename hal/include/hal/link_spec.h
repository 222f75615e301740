// SPDX-License-Identifier: MIT
// The text form of a link: serial:PATH[@BAUD], tcp:HOST[:PORT] or can:IFACE[,options].
#ifndef HAL_LINK_SPEC_H
#define HAL_LINK_SPEC_H

#include <stdbool.h>

#include "hal/can_spec.h"
#include "hal/isotp.h"
#include "hal/serial.h"
#include "hal/tcp.h"

typedef enum { HAL_SCHEME_SERIAL, HAL_SCHEME_TCP, HAL_SCHEME_CAN } hal_scheme_t;

typedef struct {
    hal_scheme_t scheme;
    bool has_baud; // the rate was given, not defaulted
    uint32_t baud;
    uint16_t port;
    char path[HAL_PATH_MAX];
    char host[HAL_HOST_MAX];
    hal_can_spec_t can;
} hal_link_spec_t;

// Reads a spec. False: `message` says on one line what is wrong and what to write instead; `spec` is
// unspecified. IPv6 addresses go in brackets: tcp:[::1]:8101.
bool hal_link_spec_parse(hal_link_spec_t *spec, const char *text, char *message, size_t capacity);

// What the spec leads to: path, host or interface; "" for one that was never read.
const char *hal_link_spec_target(const hal_link_spec_t *spec);

// Room for each transport.
typedef struct {
    hal_serial_t serial;
    hal_tcp_t tcp;
    hal_isotp_t isotp;
} hal_transport_t;

void hal_transport_init(hal_transport_t *self);

// Opens what the spec names; `link` is set on HAL_LINK_OK only. `cancel_fd` as in hal_tcp_open().
hal_link_error_t hal_transport_open(hal_transport_t *self, const hal_link_spec_t *spec, int timeout_ms,
                                    int cancel_fd, hal_link_t *link);

// True when opening the spec again would lead to another device.
bool hal_transport_moved(const hal_transport_t *self, const hal_link_spec_t *spec);

// One line about a failed opening: what, why, what to do.
void hal_transport_explain(const hal_link_spec_t *spec, hal_link_error_t error, char *text, size_t capacity);

#endif
