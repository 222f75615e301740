// SPDX-License-Identifier: MIT
// TCP links.
#include "hal/tcp.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Unsent commands older than this are worthless: better to lose the connection than to send them late.
#define UNSENT_MAX_MS 4000

void hal_tcp_init(hal_tcp_t *self) {
    memset(self, 0, sizeof *self);
    hal_fd_link_init(&self->socket);
}

static hal_link_error_t resolve(hal_tcp_t *self) {
    const struct addrinfo hints = {
        .ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM, .ai_flags = AI_NUMERICSERV};
    struct addrinfo *list = NULL;
    char service[8];
    snprintf(service, sizeof service, "%u", (unsigned)self->port);
    if (getaddrinfo(self->host, service, &hints, &list) != 0) {
        return HAL_LINK_UNRESOLVED;
    }
    for (const struct addrinfo *at = list; at != NULL && self->addresses < HAL_TCP_ADDRESSES_MAX;
         at = at->ai_next) {
        memcpy(&self->address[self->addresses], at->ai_addr, at->ai_addrlen);
        self->length[self->addresses] = at->ai_addrlen;
        self->addresses++;
    }
    freeaddrinfo(list);
    return self->addresses > 0 ? HAL_LINK_OK : HAL_LINK_UNRESOLVED;
}

static hal_link_error_t wait_connected(int fd, int timeout_ms, int cancel_fd) {
    struct pollfd wait[2] = {{.fd = fd, .events = POLLOUT}, {.fd = cancel_fd, .events = POLLIN}};
    const int ready = poll(wait, 2, timeout_ms);
    if (wait[1].revents != 0 || (ready < 0 && errno == EINTR)) {
        return HAL_LINK_CANCELLED;
    }
    if (ready < 0) {
        return hal_link_error_of(errno);
    }
    if (ready == 0) {
        return HAL_LINK_TIMEOUT;
    }
    int problem = 0;
    socklen_t size = sizeof problem;
    if (getsockopt(fd, SOL_SOCKET, SO_ERROR, &problem, &size) != 0) {
        problem = errno;
    }
    return problem == 0 ? HAL_LINK_OK : hal_link_error_of(problem);
}

static hal_link_error_t connect_one(int fd, const struct sockaddr_storage *address, socklen_t length,
                                    int timeout_ms, int cancel_fd) {
    const int yes = 1;
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
#ifdef TCP_USER_TIMEOUT
    const unsigned unsent_ms = UNSENT_MAX_MS;
    setsockopt(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, &unsent_ms, sizeof unsent_ms);
#endif
    if (fcntl(fd, F_SETFL, O_NONBLOCK) != 0) {
        return HAL_LINK_IO;
    }
    if (connect(fd, (const struct sockaddr *)address, length) == 0) {
        return HAL_LINK_OK;
    }
    return errno == EINPROGRESS ? wait_connected(fd, timeout_ms, cancel_fd) : hal_link_error_of(errno);
}

static hal_link_error_t connect_any(hal_tcp_t *self, int timeout_ms, int cancel_fd) {
    hal_link_error_t error = HAL_LINK_UNRESOLVED;
    for (int i = 0; i < self->addresses; i++) {
        const int fd = socket(self->address[i].ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (fd < 0) {
            error = hal_link_error_of(errno);
            continue;
        }
        error = connect_one(fd, &self->address[i], self->length[i], timeout_ms, cancel_fd);
        // A reset after the handshake may be seen here already: it was accepted, and reading tells the rest.
        if (error == HAL_LINK_OK || error == HAL_LINK_CLOSED) {
            self->socket.fd = fd;
            return HAL_LINK_OK;
        }
        close(fd);
        if (error == HAL_LINK_CANCELLED) {
            return error;
        }
    }
    return error;
}

static void tcp_close(void *context) {
    hal_tcp_t *const self = context;
    if (self->socket.fd >= 0) {
        close(self->socket.fd);
        self->socket.fd = -1;
    }
}

hal_link_error_t hal_tcp_open(hal_tcp_t *self, const char *host, uint16_t port, int timeout_ms,
                              int cancel_fd) {
    if (host == NULL || host[0] == '\0' || strlen(host) >= sizeof self->host || port == 0) {
        return HAL_LINK_BAD_ARGUMENT;
    }
    tcp_close(self);
    self->socket.kept = 0;
    if (self->addresses == 0 || self->port != port || strcmp(self->host, host) != 0) {
        snprintf(self->host, sizeof self->host, "%s", host);
        self->port = port;
        self->addresses = 0;
        const int is_v6 = strchr(host, ':') != NULL;
        snprintf(self->text, sizeof self->text, is_v6 ? "tcp:[%s]:%u" : "tcp:%s:%u", host, (unsigned)port);
        const hal_link_error_t error = resolve(self);
        if (error != HAL_LINK_OK) {
            return error;
        }
    }
    return connect_any(self, timeout_ms, cancel_fd);
}

static int tcp_read(void *context, uint8_t *bytes, size_t capacity) {
    hal_tcp_t *const self = context;
    return hal_fd_link_read(&self->socket, bytes, capacity);
}

static int tcp_write(void *context, const uint8_t *packet, size_t count) {
    hal_tcp_t *const self = context;
    return hal_fd_link_write(&self->socket, packet, count);
}

static int tcp_flush(void *context) {
    hal_tcp_t *const self = context;
    return hal_fd_link_flush(&self->socket);
}

static int tcp_fd(const void *context) {
    const hal_tcp_t *const self = context;
    return self->socket.fd;
}

static const char *tcp_describe(const void *context) {
    const hal_tcp_t *const self = context;
    return self->text;
}

static const hal_link_counters_t *tcp_counters(const void *context) {
    const hal_tcp_t *const self = context;
    return &self->socket.counters;
}

hal_link_t hal_tcp_link(hal_tcp_t *self) {
    static const hal_link_ops_t ops = {.read = tcp_read,
                                       .write = tcp_write,
                                       .flush = tcp_flush,
                                       .fd = tcp_fd,
                                       .describe = tcp_describe,
                                       .counters = tcp_counters,
                                       .close = tcp_close};
    return (hal_link_t){.ops = &ops, .context = self};
}
