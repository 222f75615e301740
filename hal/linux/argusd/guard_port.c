// SPDX-License-Identifier: MIT
// Opens the TCP ports and ptys at which clients connect.
#define _GNU_SOURCE // accept4, posix_openpt, ptsname_r
#include "guard_port.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "text.h"

#define PTS "/dev/pts/"

// Spec -----------------------------------------------------------------------------------------------------

static bool take_name(guard_spec_t *spec, const char *from, size_t count) {
    if (count == 0 || count >= sizeof spec->name) {
        return false;
    }
    memcpy(spec->name, from, count);
    spec->name[count] = '\0';
    return true;
}

static bool take_host(guard_spec_t *spec, const char *text) {
    const char *const colon = strrchr(text, ':');
    int32_t port = 0;
    if (colon == NULL || !text_number(colon + 1, &port) || port < 1 || port > 65535) {
        return false;
    }
    spec->port = (uint16_t)port;
    const bool bracketed = text[0] == '[' && colon > text + 1 && colon[-1] == ']';
    return bracketed ? take_name(spec, text + 1, (size_t)(colon - text) - 2)
                     : take_name(spec, text, (size_t)(colon - text));
}

bool guard_spec_parse(guard_spec_t *spec, const char *text, char *message, size_t capacity) {
    memset(spec, 0, sizeof *spec);
    spec->text = text;
    bool right = false;
    if (strncmp(text, "tcp:", 4) == 0) {
        spec->kind = GUARD_TCP;
        right = take_host(spec, text + 4);
    } else if (strncmp(text, "pty:", 4) == 0) {
        spec->kind = GUARD_PTY;
        right = take_name(spec, text + 4, strlen(text + 4));
    }
    return right || text_refuse(message, capacity,
                                "--guard %s: give tcp:HOST:PORT, as tcp:127.0.0.1:8101, or pty:PATH", text);
}

// TCP ------------------------------------------------------------------------------------------------------

static bool is_loopback(const struct sockaddr *address) {
    if (address->sa_family == AF_INET) {
        struct sockaddr_in in;
        memcpy(&in, address, sizeof in);
        return ntohl(in.sin_addr.s_addr) >> 24 == 127;
    }
    if (address->sa_family == AF_INET6) {
        struct sockaddr_in6 in6;
        memcpy(&in6, address, sizeof in6);
        return IN6_IS_ADDR_LOOPBACK(&in6.sin6_addr);
    }
    return false;
}

static bool listen_at(guard_port_t *self, const struct addrinfo *where) {
    const int on = 1;
    self->listener = socket(where->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (self->listener < 0) {
        return false;
    }
    (void)setsockopt(self->listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    return bind(self->listener, where->ai_addr, where->ai_addrlen) == 0 && listen(self->listener, 4) == 0;
}

static bool open_tcp(guard_port_t *self, bool beyond, char *message, size_t capacity) {
    const struct addrinfo hints = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE};
    struct addrinfo *found = NULL;
    char service[8];
    snprintf(service, sizeof service, "%u", (unsigned)self->spec.port);
    const int problem = getaddrinfo(self->spec.name, service, &hints, &found);
    if (problem != 0) {
        return text_refuse(message, capacity, "--guard %s: no such host (%s)", self->spec.text,
                           gai_strerror(problem));
    }
    if (!beyond && !is_loopback(found->ai_addr)) {
        freeaddrinfo(found);
        self->refused = true;
        return text_refuse(message, capacity,
                           "--guard %s: not this machine alone: whoever reaches it can drive the robot; give "
                           "127.0.0.1, or --guard-beyond-loopback if that is meant",
                           self->spec.text);
    }
    const bool listens = listen_at(self, found);
    const int why = errno;
    freeaddrinfo(found);
    return listens || text_refuse(message, capacity, "--guard %s: %s", self->spec.text, strerror(why));
}

static void accept_tcp(guard_port_t *self, int *other) {
    const int on = 1;
    const int fd = accept4(self->listener, NULL, NULL, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) {
        return;
    }
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (self->client < 0) {
        self->client = fd;
    } else {
        *other = fd;
    }
}

// Pty ------------------------------------------------------------------------------------------------------

// One that an argusd which was killed has left leads nowhere, or to a terminal that was given to others.
static bool clear_name(const char *path) {
    char target[PATH_MAX];
    struct stat there;
    if (lstat(path, &there) != 0) {
        return errno == ENOENT;
    }
    const ssize_t count = S_ISLNK(there.st_mode) ? readlink(path, target, sizeof target) : -1;
    errno = EEXIST;
    return count >= (ssize_t)strlen(PTS) && strncmp(target, PTS, strlen(PTS)) == 0 && unlink(path) == 0;
}

static bool name_pty(guard_port_t *self) {
    char device[64];
    if (grantpt(self->listener) != 0 || unlockpt(self->listener) != 0 ||
        ptsname_r(self->listener, device, sizeof device) != 0) {
        return false;
    }
    // A master hangs up only after its other side was open once.
    const int other_side = open(device, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (other_side >= 0) {
        close(other_side);
    }
    self->linked = clear_name(self->spec.name) && symlink(device, self->spec.name) == 0;
    return self->linked;
}

static bool open_pty(guard_port_t *self, char *message, size_t capacity) {
    if (!claim_take(&self->claim, "--guard", self->spec.name, message, capacity)) {
        return false;
    }
    self->listener = posix_openpt(O_RDWR | O_NOCTTY);
    if (self->listener >= 0) {
        (void)fcntl(self->listener, F_SETFD, FD_CLOEXEC);
        (void)fcntl(self->listener, F_SETFL, O_NONBLOCK);
        // Bytes, not lines, and no echo, also before the client has said so.
        struct termios raw;
        if (tcgetattr(self->listener, &raw) == 0) {
            cfmakeraw(&raw);
            (void)tcsetattr(self->listener, TCSANOW, &raw);
        }
        if (name_pty(self)) {
            return true;
        }
    }
    const int why = errno;
    return text_refuse(message, capacity, "--guard %s: %s%s", self->spec.text, strerror(why),
                       why == EEXIST ? "; it is no name of a pty, so it stays" : "");
}

// No program has the other side open: the master hangs up.
static bool is_pty_free(const guard_port_t *self) {
    struct pollfd wait = {.fd = self->listener, .events = POLLIN};
    return poll(&wait, 1, 0) > 0 && (wait.revents & POLLHUP) != 0;
}

// ----------------------------------------------------------------------------------------------------------

bool guard_port_open(guard_port_t *self, const guard_spec_t *spec, bool beyond, char *message,
                     size_t capacity) {
    *self = (guard_port_t){.spec = *spec, .listener = -1, .client = -1};
    const bool open = spec->kind == GUARD_TCP ? open_tcp(self, beyond, message, capacity)
                                              : open_pty(self, message, capacity);
    if (!open) {
        guard_port_close(self);
    }
    return open;
}

void guard_port_accept(guard_port_t *self, int *other) {
    *other = -1;
    if (self->listener < 0) {
        return;
    }
    if (self->spec.kind == GUARD_TCP) {
        accept_tcp(self, other);
    } else if (self->client < 0 && !is_pty_free(self)) {
        self->client = self->listener;
    }
}

size_t guard_port_read(guard_port_t *self, uint8_t *bytes, size_t capacity) {
    if (self->client < 0) {
        return 0;
    }
    const ssize_t got = read(self->client, bytes, capacity);
    if (got > 0) {
        return (size_t)got;
    }
    if (got == 0 || (errno != EAGAIN && errno != EINTR)) {
        guard_port_drop(self);
    }
    return 0;
}

size_t guard_port_write(guard_port_t *self, const uint8_t *bytes, size_t count) {
    if (self->client < 0) {
        return 0;
    }
    const ssize_t put = self->spec.kind == GUARD_TCP ? send(self->client, bytes, count, MSG_NOSIGNAL)
                                                     : write(self->client, bytes, count);
    return put > 0 ? (size_t)put : 0;
}

int guard_port_fd(const guard_port_t *self) {
    return self->client >= 0 ? self->client : -1;
}

void guard_port_drop(guard_port_t *self) {
    if (self->client >= 0 && self->client != self->listener) {
        close(self->client);
    } else if (self->client >= 0) {
        (void)tcflush(self->listener, TCIOFLUSH); // what it did not read is not for the next one
    }
    self->client = -1;
}

void guard_port_close(guard_port_t *self) {
    guard_port_drop(self);
    if (self->linked) {
        (void)unlink(self->spec.name);
    }
    if (self->listener >= 0) {
        close(self->listener);
    }
    claim_release(&self->claim);
    self->listener = -1;
    self->linked = false;
}
