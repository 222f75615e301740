// SPDX-License-Identifier: MIT
// Opens and accepts.
#define _GNU_SOURCE // accept4, SO_PEERCRED
#include "control_port.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text.h"

#define BACKLOG 16
#define SEND_BUFFER 65536 // what lies in the system's hands is old when a slow reader gets it

// Whether a program serves the socket file: then connecting works, or would, but for its full queue.
static bool is_served(const control_spec_t *spec, pid_t *process) {
    struct ucred peer = {0};
    socklen_t length = sizeof peer;
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const bool served = fd < 0 || connect(fd, &spec->address.any, spec->length) == 0 || errno != ECONNREFUSED;
    const bool known = served && fd >= 0 && getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &length) == 0;
    *process = known ? peer.pid : 0;
    if (fd >= 0) {
        close(fd);
    }
    return served;
}

// Takes away a socket file that a dead argusd has left.
static bool clear_path(const control_spec_t *spec, char *message, size_t capacity) {
    const char *const path = spec->address.un.sun_path;
    struct stat about;
    if (lstat(path, &about) != 0) {
        return true;
    }
    if (!S_ISSOCK(about.st_mode)) {
        return text_refuse(message, capacity, "--control unix:%s: it exists and is no socket; name another",
                           path);
    }
    pid_t process = 0;
    if (is_served(spec, &process)) {
        return text_refuse(message, capacity,
                           "--control unix:%s: another program serves it (process %d); name another", path,
                           (int)process);
    }
    if (unlink(path) != 0) {
        return text_refuse(message, capacity, "--control unix:%s: left by another program: %s", path,
                           strerror(errno));
    }
    return true;
}

// The mode of the file is settled before there is one, so that no other user can be quicker.
static bool bind_unix(control_port_t *self) {
    struct stat about;
    if (fchmod(self->fd, 0600) != 0 || bind(self->fd, &self->spec.address.any, self->spec.length) != 0) {
        return false;
    }
    if (lstat(self->spec.address.un.sun_path, &about) != 0) {
        return false;
    }
    self->device = about.st_dev;
    self->inode = about.st_ino;
    return (about.st_mode & 0777) == 0600 || chmod(self->spec.address.un.sun_path, 0600) == 0;
}

static bool bind_tcp(const control_port_t *self) {
    const int on = 1;
    setsockopt(self->fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    return bind(self->fd, &self->spec.address.any, self->spec.length) == 0;
}

bool control_port_open(control_port_t *self, const control_spec_t *spec, char *message, size_t capacity) {
    char where[160];
    *self = (control_port_t){.fd = -1, .spec = *spec};
    if (spec->family == AF_UNIX && !clear_path(spec, message, capacity)) {
        return false;
    }
    self->fd = socket(spec->family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (self->fd >= 0 && (spec->family == AF_UNIX ? bind_unix(self) : bind_tcp(self)) &&
        listen(self->fd, BACKLOG) == 0) {
        return true;
    }
    const int problem = errno;
    control_port_describe(self, where, sizeof where);
    control_port_close(self);
    return text_refuse(message, capacity, "--control %s: %s", where, strerror(problem));
}

static bool is_welcome(const control_port_t *self, int fd) {
    struct ucred peer;
    socklen_t length = sizeof peer;
    if (self->spec.family != AF_UNIX) {
        return true; // the token decides
    }
    return getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &length) == 0 &&
           (peer.uid == geteuid() || peer.uid == 0);
}

int control_port_accept(const control_port_t *self) {
    const int size = SEND_BUFFER;
    const int on = 1;
    const int fd = self->fd < 0 ? -1 : accept4(self->fd, NULL, NULL, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) {
        return -1;
    }
    if (!is_welcome(self, fd)) {
        close(fd);
        return -1;
    }
    setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &size, sizeof size);
    if (self->spec.family != AF_UNIX) {
        setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    }
    return fd;
}

void control_port_describe(const control_port_t *self, char *text, size_t capacity) {
    char host[INET6_ADDRSTRLEN] = "?";
    control_spec_t now = self->spec;
    socklen_t length = sizeof now.address;
    if (now.family == AF_UNIX) {
        snprintf(text, capacity, "unix:%s", now.address.un.sun_path);
        return;
    }
    if (self->fd >= 0 && getsockname(self->fd, &now.address.any, &length) != 0) {
        now = self->spec;
    }
    const bool four = now.family == AF_INET;
    inet_ntop(now.family, four ? (void *)&now.address.in.sin_addr : (void *)&now.address.in6.sin6_addr, host,
              sizeof host);
    const unsigned port = ntohs(four ? now.address.in.sin_port : now.address.in6.sin6_port);
    snprintf(text, capacity, four ? "tcp:%s:%u" : "tcp:[%s]:%u", host, port);
}

void control_port_close(control_port_t *self) {
    struct stat about;
    const char *const path = self->spec.address.un.sun_path;
    if (self->fd < 0) {
        return;
    }
    close(self->fd);
    self->fd = -1;
    if (self->spec.family == AF_UNIX && self->inode != 0 && lstat(path, &about) == 0 &&
        about.st_dev == self->device && about.st_ino == self->inode) {
        (void)!unlink(path);
    }
}
