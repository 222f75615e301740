// SPDX-License-Identifier: MIT
// A TCP connection as a link, as the vendor's emulator serves it.
#ifndef HAL_TCP_H
#define HAL_TCP_H

#include <sys/socket.h>

#include "hal/fd_link.h"

#define HAL_TCP_PORT_DEFAULT 8101
#define HAL_HOST_MAX 128
#define HAL_TCP_ADDRESSES_MAX 4

typedef struct {
    hal_fd_link_t socket;
    uint16_t port;
    uint8_t addresses; // resolved once, kept for reconnecting: a name server may allocate and take long
    socklen_t length[HAL_TCP_ADDRESSES_MAX];
    struct sockaddr_storage address[HAL_TCP_ADDRESSES_MAX];
    char host[HAL_HOST_MAX];
    char text[HAL_HOST_MAX + 16];
} hal_tcp_t;

void hal_tcp_init(hal_tcp_t *self);

// Connects to host:port (name, IPv4 or IPv6 without brackets), trying each address for at most `timeout_ms`.
// Returns early with HAL_LINK_CANCELLED when `cancel_fd` (-1: none) becomes readable. A second call with the
// same host and port reconnects without asking the name server.
hal_link_error_t hal_tcp_open(hal_tcp_t *self, const char *host, uint16_t port, int timeout_ms,
                              int cancel_fd);

hal_link_t hal_tcp_link(hal_tcp_t *self);

#endif
