// SPDX-License-Identifier: MIT
// The output that never waits.
#include "output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

// O_NONBLOCK on the descriptor that we were given would hit every program that shares it, such as a shell. A
// second opening of the same pipe or terminal has flags of its own.
static void open_own(output_t *self, int fd) {
    char path[32];
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    const int own = open(path, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (own >= 0) {
        self->fd = own;
        self->own = true;
    }
}

void output_init(output_t *self, int fd) {
    struct stat about;
    memset(self, 0, sizeof *self);
    self->fd = fd;
    if (fstat(fd, &about) != 0) {
        self->broken = true;
        return;
    }
    self->is_socket = S_ISSOCK(about.st_mode);
    self->is_file = S_ISREG(about.st_mode);
    if (S_ISFIFO(about.st_mode) || S_ISCHR(about.st_mode)) {
        open_own(self, fd);
    }
}

static ssize_t put(const output_t *self) {
    if (self->is_socket) {
        return send(self->fd, self->backlog, self->used, MSG_DONTWAIT | MSG_NOSIGNAL);
    }
    if (self->own || self->is_file) {
        return write(self->fd, self->backlog, self->used);
    }
    // A pipe that polls writable takes this much without waiting.
    struct pollfd wait = {.fd = self->fd, .events = POLLOUT};
    if (poll(&wait, 1, 0) != 1 || (wait.revents & POLLOUT) == 0) {
        errno = (wait.revents & (POLLERR | POLLHUP)) != 0 ? EPIPE : EAGAIN;
        return -1;
    }
    return write(self->fd, self->backlog, self->used < PIPE_BUF ? self->used : PIPE_BUF);
}

void output_flush(output_t *self) {
    while (self->used > 0 && !self->broken) {
        const ssize_t written = put(self);
        if (written < 0) {
            self->problem = errno;
            self->broken = errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR;
            return;
        }
        self->used -= (size_t)written;
        memmove(self->backlog, self->backlog + written, self->used);
    }
}

bool output_line(output_t *self, const char *line, size_t length) {
    if (self->broken || length + 1 > sizeof self->backlog - self->used) {
        self->dropped++;
        return false;
    }
    memcpy(self->backlog + self->used, line, length);
    self->backlog[self->used + length] = '\n';
    self->used += length + 1;
    output_flush(self);
    return true;
}

bool output_waits(const output_t *self) {
    return self->used > 0 && !self->broken;
}

void output_close(output_t *self) {
    output_flush(self);
    if (self->own) {
        close(self->fd);
        self->own = false;
    }
    self->broken = true;
}
