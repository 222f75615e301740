// SPDX-License-Identifier: MIT
// Opens what a link spec names, and says why when it cannot.
#include <stdio.h>

#include "hal/link_spec.h"

void hal_transport_init(hal_transport_t *self) {
    hal_serial_init(&self->serial);
    hal_tcp_init(&self->tcp);
    hal_isotp_init(&self->isotp, &hal_can_sys);
}

hal_link_error_t hal_transport_open(hal_transport_t *self, const hal_link_spec_t *spec, int timeout_ms,
                                    int cancel_fd, hal_link_t *link) {
    hal_link_error_t error = HAL_LINK_OK;
    hal_link_t opened = {0};
    switch (spec->scheme) {
    case HAL_SCHEME_TCP:
        error = hal_tcp_open(&self->tcp, spec->host, spec->port, timeout_ms, cancel_fd);
        opened = hal_tcp_link(&self->tcp);
        break;
    case HAL_SCHEME_CAN:
        error = hal_isotp_open(&self->isotp, &spec->can);
        opened = hal_isotp_link(&self->isotp);
        break;
    case HAL_SCHEME_SERIAL:
    default:
        error = hal_serial_open(&self->serial, spec->path, spec->baud);
        opened = hal_serial_link(&self->serial);
        break;
    }
    if (error == HAL_LINK_OK) {
        *link = opened;
    }
    return error;
}

bool hal_transport_moved(const hal_transport_t *self, const hal_link_spec_t *spec) {
    return spec->scheme == HAL_SCHEME_SERIAL && hal_serial_moved(&self->serial);
}

void hal_transport_explain(const hal_link_spec_t *spec, hal_link_error_t error, char *text, size_t capacity) {
    if (spec->scheme == HAL_SCHEME_SERIAL) {
        hal_serial_explain(error, spec->path, text, capacity);
        return;
    }
    if (spec->scheme == HAL_SCHEME_CAN) {
        hal_isotp_explain(error, &spec->can, text, capacity);
        return;
    }
    const char *advice = "";
    if (error == HAL_LINK_REFUSED) {
        advice = "; start the robot's server or emulator, or check the port";
    } else if (error == HAL_LINK_UNRESOLVED) {
        advice = "; check the name or give the address";
    } else if (error == HAL_LINK_TIMEOUT || error == HAL_LINK_UNREACHABLE) {
        advice = "; check the network and that the robot is on";
    }
    snprintf(text, capacity, "%s port %u: %s%s", spec->host, (unsigned)spec->port, hal_link_error_text(error),
             advice);
}
