// SPDX-License-Identifier: MIT
// Finds the rate of a robot on a serial port.
#ifndef ARGUSD_PROBE_H
#define ARGUSD_PROBE_H

#include "hal/clock.h"
#include "hal/links.h"

typedef struct {
    uint32_t baud;  // found, or 0
    bool reporting; // an old session was still sending SIPs
    bool cancelled;
    hal_link_error_t error;
    uint32_t bytes; // heard over all rates
} probe_t;

// Tries each rate of an open link: listens, then asks with SYNC0. At most about 1 s a rate; gives up when
// `cancel_fd` becomes readable. A robot that is found is left at SYNC, which the next SYNC0 starts anew.
probe_t probe_baud(hal_transport_t *transport, const hal_link_t *link, const hal_clock_t *clock,
                   int cancel_fd);

#endif
