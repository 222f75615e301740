// SPDX-License-Identifier: MIT
// Lines of one client; neither direction ever waits.
#include "control_client.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define HELLO_MS 5000u
#define TLS_GREETING 0x16

void control_client_open(control_client_t *self, int fd, bool authentic, uint32_t now_ms) {
    output_init(&self->out, fd);
    self->on = true;
    self->authentic = authentic;
    self->begun = false;
    self->skips = false;
    self->over = false;
    self->rude = false;
    self->had_control = false;
    self->fd = fd;
    self->since_ms = now_ms;
    self->took_ms = now_ms;
    self->lost_said = 0;
    self->topics = 0;
    self->period_ms = CONTROL_PERIOD_MS;
    self->used = 0;
}

void control_client_close(control_client_t *self) {
    output_close(&self->out);
    close(self->fd);
    self->on = false;
}

// A browser may be led here by a page of anybody's: its first line names a method of HTTP, or greets in TLS.
static bool is_foreign(char first) {
    return (first >= 'A' && first <= 'Z') || first == TLS_GREETING;
}

// The line that is too long has no end in the buffer yet; what is held of it is dropped.
static void skip_line(control_client_t *self) {
    const char *const end = memchr(self->in, '\n', self->used);
    const size_t count = end == NULL ? self->used : (size_t)(end - self->in) + 1;
    self->used -= count;
    memmove(self->in, self->in + count, self->used);
    self->skips = end == NULL;
}

size_t control_client_feed(control_client_t *self, const char *bytes, size_t count) {
    if (!self->begun && count > 0) {
        self->begun = true;
        self->rude = is_foreign(bytes[0]);
    }
    const size_t room = sizeof self->in - self->used;
    const size_t taken = self->rude ? count : count < room ? count : room;
    if (!self->rude) {
        memcpy(self->in + self->used, bytes, taken);
        self->used += taken;
    }
    if (self->skips) {
        skip_line(self);
    }
    return taken;
}

void control_client_read(control_client_t *self) {
    char bytes[CONTROL_LINE_MAX];
    const size_t room = sizeof self->in - self->used;
    if (room == 0 || self->over) {
        return;
    }
    const ssize_t got = recv(self->fd, bytes, room, MSG_DONTWAIT);
    if (got > 0) {
        control_client_feed(self, bytes, (size_t)got);
    } else if (got == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) {
        self->over = true;
    }
}

bool control_client_has_line(const control_client_t *self) {
    return self->used == sizeof self->in || memchr(self->in, '\n', self->used) != NULL;
}

control_line_t control_client_line(control_client_t *self, char *line, size_t *length) {
    const char *const end = memchr(self->in, '\n', self->used);
    if (end == NULL && self->used < sizeof self->in) {
        return CONTROL_NO_LINE;
    }
    if (end == NULL) {
        self->used = 0;
        self->skips = true;
        return CONTROL_TOO_LONG;
    }
    const size_t count = (size_t)(end - self->in);
    *length = count > 0 && self->in[count - 1] == '\r' ? count - 1 : count;
    memcpy(line, self->in, *length);
    line[*length] = '\0';
    self->used -= count + 1;
    memmove(self->in, end + 1, self->used);
    return CONTROL_LINE;
}

void control_client_say(control_client_t *self, const char *line, size_t length) {
    output_line(&self->out, line, length);
}

static void say_losses(control_client_t *self) {
    char line[64];
    const uint32_t lost = self->out.dropped - self->lost_said;
    if (lost == 0 || self->out.broken || self->out.used > OUTPUT_BACKLOG / 2) {
        return;
    }
    const int length = snprintf(line, sizeof line, "{\"lost\":\"lines\",\"count\":%u}", (unsigned)lost);
    if (output_line(&self->out, line, (size_t)length)) {
        self->lost_said = self->out.dropped;
    }
}

void control_client_flush(control_client_t *self, uint32_t now_ms) {
    const size_t before = self->out.used;
    output_flush(&self->out);
    if (self->out.used == 0 || self->out.used < before) {
        self->took_ms = now_ms;
    }
    say_losses(self);
}

bool control_client_is_over(const control_client_t *self, uint32_t now_ms) {
    const bool missing = self->out.dropped != self->lost_said;
    if (self->rude || self->out.broken) {
        return true;
    }
    if (self->over) {
        return (!control_client_has_line(self) && !output_waits(&self->out)) ||
               now_ms - self->took_ms >= CONTROL_PATIENCE_MS;
    }
    if (!self->authentic) {
        return now_ms - self->since_ms >= HELLO_MS;
    }
    return missing && now_ms - self->took_ms >= CONTROL_PATIENCE_MS;
}
