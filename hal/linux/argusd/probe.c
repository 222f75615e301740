// SPDX-License-Identifier: MIT
// Probes the rates.
#include "probe.h"

#include <poll.h>

#include "arcos/frame.h"
#include "hal/serial.h"

#define LISTEN_MS 300u
#define ANSWER_MS 350u
#define ASKS 2

typedef struct {
    const hal_link_t *link;
    const hal_clock_t *clock;
    int cancel_fd;
} place_t;

static void hear(probe_t *probe, argus_parser_t *parser, uint32_t now_ms, const uint8_t *bytes, size_t count,
                 uint32_t baud) {
    argus_packet_t packet;
    size_t taken = 0;
    probe->bytes += (uint32_t)count;
    do {
        taken += argus_parser_push(parser, now_ms, bytes + taken, count - taken);
        while (argus_parser_next(parser, now_ms, &packet)) {
            probe->baud = baud;
            probe->reporting =
                packet.data[0] == ARCOS_TYPE_SIP_STATIONARY || packet.data[0] == ARCOS_TYPE_SIP_MOVING;
        }
    } while (taken < count);
}

// Listens until a packet came, time is up, or somebody gave up.
static void listen_for(probe_t *probe, const place_t *place, uint32_t baud, uint32_t ms) {
    argus_parser_t parser;
    const hal_clock_t *const clock = place->clock;
    const uint32_t start_ms = hal_clock_now_ms(clock);
    uint32_t now_ms = start_ms;
    argus_parser_init(&parser);
    while (probe->baud == 0 && !probe->cancelled && probe->error == HAL_LINK_OK && now_ms - start_ms < ms) {
        uint8_t bytes[256];
        struct pollfd wait[2] = {{.fd = hal_link_fd(place->link), .events = POLLIN},
                                 {.fd = place->cancel_fd, .events = POLLIN}};
        poll(wait, 2, (int)(ms - (now_ms - start_ms)));
        probe->cancelled = wait[1].revents != 0;
        now_ms = hal_clock_now_ms(clock);
        const int got = hal_link_read(place->link, bytes, sizeof bytes);
        if (got < 0) {
            probe->error = (hal_link_error_t)got;
        } else if (got > 0) {
            hear(probe, &parser, now_ms, bytes, (size_t)got, baud);
        }
    }
}

static void try_rate(probe_t *probe, const place_t *place, uint32_t baud) {
    static const uint8_t sync0 = ARCOS_SYNC_SYNC0;
    uint8_t packet[16];
    const size_t count = argus_frame_encode(packet, sizeof packet, &sync0, 1);
    listen_for(probe, place, baud, LISTEN_MS);
    for (int i = 0; i < ASKS && probe->baud == 0; i++) {
        hal_link_write(place->link, packet, count);
        listen_for(probe, place, baud, ANSWER_MS);
    }
}

probe_t probe_baud(hal_transport_t *transport, const hal_link_t *link, const hal_clock_t *clock,
                   int cancel_fd) {
    const place_t place = {.link = link, .clock = clock, .cancel_fd = cancel_fd};
    probe_t probe = {.error = HAL_LINK_OK};
    for (int i = 0; i < hal_baud_count && probe.baud == 0 && !probe.cancelled; i++) {
        probe.error = hal_transport_set_baud(transport, hal_baud_table[i]);
        if (probe.error == HAL_LINK_OK) {
            try_rate(&probe, &place, hal_baud_table[i]);
        }
        if (probe.error != HAL_LINK_OK && probe.error != HAL_LINK_BAD_BAUD) {
            break; // this port cannot do the rate: try the others; anything else ends it
        }
        probe.error = HAL_LINK_OK;
    }
    return probe;
}
