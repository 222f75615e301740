// SPDX-License-Identifier: MIT
// A client of the control socket with a screen.
#include "attach.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "attach_state.h"
#include "control_port.h"
#include "signals.h"
#include "text.h"

#define TURN_DEG 20
#define WAIT_MS 250
#define PERIOD_MS 200
#define SILENT_MS 1500u // seven states that do not come
#define AGAIN_MS 1000u  // between tries to connect anew
#define MEETS_MS 200    // that one of them may take

bool attach_open(attach_t *self, const control_spec_t *spec, const control_token_t *token,
                 const hal_clock_t *clock, char *message, size_t capacity) {
    const control_port_t far = {.fd = -1, .spec = *spec};
    self->clock = *clock;
    self->token = *token;
    self->spec = *spec;
    control_port_describe(&far, self->place, sizeof self->place);
    self->fd = socket(spec->family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (self->fd < 0 || connect(self->fd, &spec->address.any, spec->length) != 0) {
        const int problem = errno;
        if (self->fd >= 0) {
            close(self->fd);
        }
        return text_refuse(message, capacity, "--attach %s: %s; is argusd running there with --control?",
                           self->place, strerror(problem));
    }
    return true;
}

static void leave(attach_t *self, argusd_exit_t code) {
    self->over = true;
    self->code = code;
}

// A stream ends with its argusd, a screen waits for the next one: control is lost, what is shown is of
// earlier.
static void lose(attach_t *self) {
    close(self->fd);
    self->fd = -1;
    self->used = 0;
    self->grant[0] = '\0';
    self->tried_ms = self->moment.now_ms;
    self->silent = true;
    voice_notice(&self->voice, "argusd has ended the connection; waiting for it, q leaves");
}

static bool meets(int fd, const control_spec_t *spec) {
    int problem = 0;
    socklen_t size = sizeof problem;
    struct pollfd wait = {.fd = fd, .events = POLLOUT};
    if (connect(fd, &spec->address.any, spec->length) == 0) {
        return true;
    }
    return errno == EINPROGRESS && poll(&wait, 1, MEETS_MS) == 1 &&
           getsockopt(fd, SOL_SOCKET, SO_ERROR, &problem, &size) == 0 && problem == 0;
}

static void try_again(attach_t *self) {
    if (self->fd >= 0 || self->moment.now_ms - self->tried_ms < AGAIN_MS) {
        return;
    }
    self->tried_ms = self->moment.now_ms;
    const int fd = socket(self->spec.family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd >= 0 && meets(fd, &self->spec)) {
        self->fd = fd;
    } else if (fd >= 0) {
        close(fd);
    }
}

__attribute__((format(printf, 2, 3))) static void say(attach_t *self, const char *format, ...) {
    char line[1024];
    text_t text = text_in(line, sizeof line);
    va_list arguments;
    va_start(arguments, format);
    text_add_list(&text, format, arguments);
    va_end(arguments);
    text_add(&text, "\n");
    // A line is far smaller than the socket's room: what does not go now means that argusd hangs.
    if (!self->over &&
        send(self->fd, line, text.length, MSG_DONTWAIT | MSG_NOSIGNAL) != (ssize_t)text.length) {
        voice_notice(&self->voice, "argusd does not take what is said to it");
        leave(self, ARGUSD_EXIT_LINK);
    }
}

// Keys
// ---------------------------------------------------------------------------------------------------------

// The order of a key; NULL: it depends on the state.
static const char *fixed_order(tui_key_t key) {
    switch (key) {
    case TUI_AHEAD:
        return "\"step\",\"way\":\"ahead\"";
    case TUI_BACK:
        return "\"step\",\"way\":\"back\"";
    case TUI_GO:
        return "\"go\"";
    case TUI_RECHECK:
        return "\"recheck\"";
    case TUI_STOP:
        return "\"stop\"";
    default:
        return NULL;
    }
}

static const char *sonar_order(const attach_t *self, tui_key_t key) {
    const bool pinned = (self->view.status.pinned >> self->view.sonar & 1u) != 0;
    if (key == TUI_PIN) {
        return pinned ? "unpin" : "pin";
    }
    return key == TUI_RETEST ? "retest" : key == TUI_TAKE_OUT ? "out" : NULL;
}

static void write_order(const attach_t *self, tui_key_t key, char *order, size_t capacity) {
    const char *const fixed = fixed_order(key);
    const char *const of_sonar = sonar_order(self, key);
    if (fixed != NULL) {
        snprintf(order, capacity, "%s", fixed);
    } else if (of_sonar != NULL) {
        snprintf(order, capacity, "\"%s\",\"sonar\":%d", of_sonar, self->view.sonar);
    } else if (key == TUI_PASSIVE) {
        snprintf(order, capacity, "\"%s\"", self->view.status.active ? "passive" : "active");
    } else {
        snprintf(order, capacity, "\"turn\",\"deg\":%d", key == TUI_LEFT ? TURN_DEG : -TURN_DEG);
    }
}

static void send_order(attach_t *self, tui_key_t key) {
    char order[64];
    write_order(self, key, order, sizeof order);
    say(self, "{\"do\":\"order\",\"id\":%d,\"grant\":\"%s\",\"seq\":%u,\"order\":%s}", (int)key, self->grant,
        (unsigned)++self->seq, order);
}

static bool is_order(tui_key_t key) {
    return key >= TUI_AHEAD && key <= TUI_TAKE_OUT && key != TUI_NEXT && key != TUI_PREVIOUS;
}

static void choose(attach_t *self, int step) {
    char answer[64];
    const int sonars = self->view.status.sonars > 0 ? self->view.status.sonars : ARGUS_SONARS;
    self->view.sonar = (uint8_t)((self->view.sonar + sonars + step) % sonars);
    snprintf(answer, sizeof answer, "> sonar %d is chosen", self->view.sonar);
    voice_answer(&self->voice, answer);
}

// Control is taken with the first order; STOP needs none.
static void obey(attach_t *self, tui_key_t key) {
    if (key == TUI_QUIT || key == TUI_GONE) {
        leave(self, ARGUSD_EXIT_OK);
    } else if (self->fd < 0) {
        voice_answer(&self->voice, "> there is no argusd to take this");
    } else if (key == TUI_NEXT || key == TUI_PREVIOUS) {
        choose(self, key == TUI_NEXT ? 1 : -1);
    } else if (!is_order(key)) {
        voice_answer(&self->voice, "> no such key; ? shows the keys");
    } else if (key == TUI_STOP || self->grant[0] != '\0') {
        send_order(self, key);
    } else {
        self->wanted = key;
        say(self, "{\"do\":\"take\",\"id\":\"take\"}");
    }
}

static void take_keys(attach_t *self) {
    for (tui_key_t key = tui_key(&self->voice.tui); key != TUI_NONE && !self->over;
         key = tui_key(&self->voice.tui)) {
        obey(self, key);
    }
}

// What argusd says
// ---------------------------------------------------------------------------------------------

static void begin_watching(attach_t *self) {
    char auth[16] = "";
    json_text(&self->doc, json_member(&self->doc, 0, "auth"), auth, sizeof auth);
    if (strcmp(auth, "token") == 0) {
        say(self, "{\"do\":\"hello\",\"id\":\"hello\",\"token\":\"%s\"}", self->token.text);
    }
    say(self, "{\"do\":\"watch\",\"id\":\"watch\",\"topics\":[\"events\",\"state\"],\"period_ms\":%d}",
        PERIOD_MS);
}

static void take_order_reply(attach_t *self, tui_key_t key, bool ok, const char *why) {
    char answer[ARGUSD_MESSAGE_MAX];
    snprintf(answer, sizeof answer, "> %s: %s%s%s", tui_keys_of(key), tui_effect_of(key), ok ? "" : ": ",
             ok ? "" : why);
    voice_answer(&self->voice, answer);
}

static void take_reply(attach_t *self) {
    char id[16] = "";
    char why[256] = "";
    int64_t key = 0;
    const int re = json_member(&self->doc, 0, "re");
    const bool ok = json_is(&self->doc, json_member(&self->doc, 0, "ok"), JSON_TRUE);
    json_text(&self->doc, json_member(&self->doc, 0, "say"), why, sizeof why);
    if (json_whole(&self->doc, re, TUI_NONE, TUI_GONE, &key)) {
        take_order_reply(self, (tui_key_t)key, ok, why);
        return;
    }
    json_text(&self->doc, re, id, sizeof id);
    if (strcmp(id, "take") == 0 && ok) {
        json_text(&self->doc, json_member(&self->doc, 0, "grant"), self->grant, sizeof self->grant);
        self->seq = 0;
        send_order(self, self->wanted);
    } else if (strcmp(id, "take") == 0) {
        take_order_reply(self, self->wanted, false, why);
    } else if (!ok) {
        voice_notice(&self->voice, why);
        leave(self, ARGUSD_EXIT_LINK);
    }
}

static void take_loss(attach_t *self) {
    char what[16] = "";
    json_text(&self->doc, json_member(&self->doc, 0, "lost"), what, sizeof what);
    if (strcmp(what, "control") == 0) {
        self->grant[0] = '\0';
        voice_notice(&self->voice, "another connection has taken control");
    } else {
        voice_notice(&self->voice, "this screen was too slow: something is missing");
    }
}

static void take_event(attach_t *self, argus_event_t *event, uint64_t t_ms) {
    const moment_t then = {.now_ms = self->moment.now_ms, .t_ms = t_ms};
    event->t_ms = self->moment.now_ms;
    voice_event(&self->voice, &then, event);
}

static void take_line(attach_t *self, const char *line, size_t length) {
    argus_event_t event;
    uint64_t t_ms = 0;
    const json_doc_t *const doc = &self->doc;
    if (!json_read(&self->doc, line, length)) {
        voice_notice(&self->voice, "this is no control socket of argusd");
        leave(self, ARGUSD_EXIT_LINK);
    } else if (json_member(doc, 0, "control") >= 0) {
        begin_watching(self);
    } else if (json_member(doc, 0, "re") >= 0) {
        take_reply(self);
    } else if (json_member(doc, 0, "lost") >= 0) {
        take_loss(self);
    } else if (attach_read_state(doc, &self->view)) {
        self->seen = true;
    } else if (attach_read_event(doc, &event, &t_ms)) {
        take_event(self, &event, t_ms);
    }
}

static void take_lines(attach_t *self) {
    size_t from = 0;
    while (!self->over) {
        const char *const end = memchr(self->in + from, '\n', self->used - from);
        if (end == NULL) {
            break;
        }
        take_line(self, self->in + from, (size_t)(end - self->in) - from);
        from = (size_t)(end - self->in) + 1;
    }
    self->used -= from;
    memmove(self->in, self->in + from, self->used);
}

static void receive(attach_t *self) {
    const ssize_t got = recv(self->fd, self->in + self->used, sizeof self->in - self->used, MSG_DONTWAIT);
    if (got > 0) {
        self->used += (size_t)got;
        self->heard_ms = self->moment.now_ms;
        take_lines(self);
    } else if (got < 0 && (errno == EAGAIN || errno == EINTR)) {
        return;
    } else if (self->seen && self->voice.tui.on) {
        lose(self);
    } else {
        tui_stop(&self->voice.tui);
        voice_notice(&self->voice, "argusd has ended the connection");
        leave(self, self->seen ? ARGUSD_EXIT_OK : ARGUSD_EXIT_LINK);
    }
}

static void wait_for_work(attach_t *self) {
    enum { SOCKET, SIGNALS, KEYS, OUT, COUNT };
    struct pollfd wait[COUNT] = {
        [SOCKET] = {.fd = self->fd, .events = POLLIN},
        [SIGNALS] = {.fd = signals_fd(), .events = POLLIN},
        [KEYS] = {.fd = self->voice.tui.on ? self->voice.tui.fd : -1, .events = POLLIN},
        [OUT] = {.fd = output_waits(&self->voice.out) ? self->voice.out.fd : -1, .events = POLLOUT},
    };
    poll(wait, COUNT, (int)voice_wait_ms(&self->voice, self->moment.now_ms, WAIT_MS));
    moment_take(&self->moment, hal_clock_now_ms(&self->clock));
    if (wait[SOCKET].revents != 0) {
        receive(self);
    }
    try_again(self);
    if (wait[KEYS].revents != 0 && !self->over) {
        take_keys(self);
    }
    if (signals_ends() > 0) {
        leave(self, ARGUSD_EXIT_OK);
    }
    voice_flush(&self->voice);
}

// An argusd that hangs, or a wire that is cut, ends no connection: what is shown is of earlier then.
static void watch_silence(attach_t *self) {
    const bool silent = self->fd < 0 || self->moment.now_ms - self->heard_ms > SILENT_MS;
    if (silent != self->silent && !self->over) {
        self->silent = silent;
        voice_notice(&self->voice, silent ? "argusd reports nothing" : "argusd reports again");
    }
}

static void show(attach_t *self) {
    if (self->silent) {
        voice_show_silence(&self->voice, &self->moment, &self->view);
    } else {
        voice_show(&self->voice, &self->moment, &self->view);
    }
}

argusd_exit_t attach_run(attach_t *self, const voice_options_t *options) {
    self->moment.now_ms = hal_clock_now_ms(&self->clock);
    self->heard_ms = self->moment.now_ms;
    voice_begin(&self->voice, options, &self->moment);
    while (!self->over) {
        if (self->seen && voice_is_due(&self->voice, self->moment.now_ms)) {
            show(self);
        }
        wait_for_work(self);
        watch_silence(self);
    }
    if (self->fd >= 0) {
        close(self->fd);
    }
    tui_stop(&self->voice.tui);
    voice_end(&self->voice, &self->clock);
    return self->code;
}
