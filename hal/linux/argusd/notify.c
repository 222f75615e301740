// SPDX-License-Identifier: MIT
// The notifications.
#include "notify.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "text.h"

#define USEC_PER_MS 1000u
#define PERIODS 2u // systemd advises to call twice in the time that it allows
#define PERIOD_MAX_MS 3600000u

// An abstract name, which no file has, begins with '@' here and with NUL for the kernel.
static socklen_t address_of(const char *name, struct sockaddr_un *to) {
    const size_t length = strlen(name);
    if ((name[0] != '/' && name[0] != '@') || length < 2 || length >= sizeof to->sun_path) {
        return 0;
    }
    memset(to, 0, sizeof *to);
    to->sun_family = AF_UNIX;
    memcpy(to->sun_path, name, length);
    if (name[0] == '@') {
        to->sun_path[0] = '\0';
        return (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    }
    return sizeof *to;
}

static bool whole(const char *text, uint64_t *value) {
    char *end = NULL;
    errno = 0;
    *value = strtoull(text, &end, 10);
    return errno == 0 && text[0] >= '0' && text[0] <= '9' && *end == '\0';
}

// The watchdog may be meant for another process: a wrapper that hands its environment on.
static bool take_watchdog(notify_t *self, char *message, size_t capacity) {
    const char *const wanted = getenv("WATCHDOG_USEC");
    const char *const whose = getenv("WATCHDOG_PID");
    uint64_t usec = 0;
    uint64_t pid = 0;
    if (wanted == NULL || (whose != NULL && (!whole(whose, &pid) || pid != (uint64_t)getpid()))) {
        return true;
    }
    if (!whole(wanted, &usec) || usec < PERIODS * USEC_PER_MS) {
        return text_refuse(message, capacity, "WATCHDOG_USEC=%s: no time in microseconds; ignored", wanted);
    }
    const uint64_t period_ms = usec / USEC_PER_MS / PERIODS;
    self->period_ms = period_ms < PERIOD_MAX_MS ? (uint32_t)period_ms : PERIOD_MAX_MS;
    return true;
}

bool notify_open(notify_t *self, char *message, size_t capacity) {
    const char *const name = getenv("NOTIFY_SOCKET");
    struct sockaddr_un to;
    *self = (notify_t){.on = false};
    if (name == NULL || name[0] == '\0') {
        return true;
    }
    const socklen_t length = address_of(name, &to);
    if (length == 0) {
        return text_refuse(message, capacity, "NOTIFY_SOCKET=%s: no path of a socket; ignored", name);
    }
    self->fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    self->on = self->fd >= 0 && connect(self->fd, (const struct sockaddr *)&to, length) == 0;
    if (!self->on) {
        const int problem = errno;
        close(self->fd);
        return text_refuse(message, capacity, "NOTIFY_SOCKET=%s: %s; ignored", name, strerror(problem));
    }
    return take_watchdog(self, message, capacity);
}

// What the socket does not take now is lost: the next sign of life comes before systemd loses patience.
static void tell(const notify_t *self, const char *text) {
    if (self->on) {
        (void)!send(self->fd, text, strlen(text), MSG_NOSIGNAL);
    }
}

void notify_ready(notify_t *self, uint32_t now_ms, const char *status) {
    if (!self->ready) {
        self->ready = true;
        self->alive_ms = now_ms;
        tell(self, "READY=1");
        notify_status(self, status);
    }
}

void notify_status(notify_t *self, const char *status) {
    char text[sizeof "STATUS=" + NOTIFY_STATUS_MAX];
    if (!self->on || strncmp(self->status, status, sizeof self->status - 1) == 0) {
        return;
    }
    snprintf(self->status, sizeof self->status, "%s", status);
    // A line break would begin another assignment.
    for (char *at = self->status; *at != '\0'; at++) {
        *at = *at < ' ' ? ' ' : *at;
    }
    snprintf(text, sizeof text, "STATUS=%s", self->status);
    tell(self, text);
}

void notify_robot(notify_t *self, const argus_status_t *status, uint32_t injected) {
    char text[NOTIFY_STATUS_MAX];
    int well = 0;
    if (!status->open) {
        notify_status(self, "no robot answers");
        return;
    }
    for (int i = 0; i < status->sonars; i++) {
        well += status->health[i] == ARGUS_HEALTHY;
    }
    snprintf(text, sizeof text, "%s%s (%s): %s, %d of %d sonars healthy, %s, mission %s",
             injected != 0 ? "INJECTED FAULT; " : "", status->robot_name, status->robot_subclass,
             argus_name(ARGUS_NAME_FAILURE, (int)status->failure), well, status->sonars,
             status->active ? "active" : "passive", argus_name(ARGUS_NAME_MISSION, (int)status->mission));
    notify_status(self, text);
}

uint32_t notify_alive(notify_t *self, uint32_t now_ms) {
    if (!self->on || self->period_ms == 0) {
        return UINT32_MAX;
    }
    if (now_ms - self->alive_ms >= self->period_ms) {
        self->alive_ms = now_ms;
        tell(self, "WATCHDOG=1");
    }
    return self->period_ms - (now_ms - self->alive_ms);
}

void notify_stopping(notify_t *self) {
    if (self->ready) {
        self->ready = false;
        notify_status(self, "closing the robot's session");
        tell(self, "STOPPING=1");
    }
}
