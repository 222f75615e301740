// SPDX-License-Identifier: MIT
// Chooses between the screen and the streams, and keeps their times.
#include "voice.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "report.h"

#define SCREEN_MS 200u
#define DRAIN_MAX_MS 500

// There is a terminal, but not one to draw on.
static bool misses_screen(const voice_t *self) {
    return !self->tui.on && tui_is_built() && isatty(STDIN_FILENO) && isatty(STDOUT_FILENO);
}

void voice_begin(voice_t *self, const voice_options_t *options, const moment_t *moment) {
    const char *const no_colour = getenv("NO_COLOR");
    self->options = *options;
    self->status_ms = moment->now_ms;
    output_init(&self->err, STDERR_FILENO);
    if (!options->json && !options->plain) {
        tui_start(&self->tui);
    }
    output_init(&self->out, STDOUT_FILENO);
    if (!options->json && !options->plain && misses_screen(self)) {
        voice_notice(self,
                     "no screen can be drawn on this terminal (see TERM): a line per event, as with --plain");
    }
    self->colour = isatty(STDOUT_FILENO) && (no_colour == NULL || no_colour[0] == '\0');
}

void voice_notice(voice_t *self, const char *text) {
    if (self->tui.on) {
        tui_log(&self->tui, text, TONE_WARN, 0);
        return;
    }
    const int length = snprintf(self->line, sizeof self->line, "argusd: %s", text);
    output_line(&self->err, self->line,
                (size_t)length < sizeof self->line ? (size_t)length : sizeof self->line - 1);
}

void voice_answer(voice_t *self, const char *text) {
    tui_log(&self->tui, text, TONE_OPERATOR, 0);
    self->shown_ms -= SCREEN_MS; // at once
}

// What follows from an operator's order is no verdict.
static bool is_by_operator(voice_t *self, const argus_event_t *event) {
    if (event->id == ARGUS_EV_OPERATOR) {
        self->taken_out = event->value == ARGUS_OP_DISABLE;
        self->taken_out_ms = event->t_ms;
    }
    return event->id == ARGUS_EV_SONAR_DISABLED && self->taken_out && self->taken_out_ms == event->t_ms;
}

static tone_t tone_of(const argus_event_t *event) {
    const argus_level_t level = argus_event_level(event->id);
    if (strcmp(argus_name(ARGUS_NAME_SUBJECT, event->id), "operator") == 0) {
        return TONE_OPERATOR;
    }
    return level == ARGUS_LEVEL_ERROR ? TONE_BAD : level == ARGUS_LEVEL_WARN ? TONE_WARN : TONE_PLAIN;
}

// Lines with the same key are one line on the screen, which counts. A suspicion that comes and goes is one
// thing.
static uint16_t key_of(const argus_event_t *event) {
    const uint16_t id = event->id == ARGUS_EV_SUSPICION_DROPPED ? ARGUS_EV_SONAR_SUSPECT : event->id;
    const int which =
        event->id == ARGUS_EV_OPERATOR ? event->value : event->sonar; // each order is a thing apart
    return (uint16_t)((unsigned)id << 5 | ((unsigned)which & 0x1Fu));
}

// Returns the length of the line, for people.
static size_t plain_line(voice_t *self, uint64_t t_ms, const argus_event_t *event, bool by_operator) {
    static const char note[] = " (by the operator)";
    const bool colour = self->colour && !self->tui.on;
    const size_t length =
        report_event_plain(event, t_ms, colour, self->line, sizeof self->line - sizeof note);
    if (length == 0 || !by_operator) {
        return length;
    }
    memcpy(self->line + length, note, sizeof note);
    return length + sizeof note - 1;
}

void voice_event(voice_t *self, const moment_t *moment, const argus_event_t *event) {
    const uint64_t t_ms = moment_of(moment, event->t_ms);
    const bool by_operator = is_by_operator(self, event);
    size_t length = 0;
    if (self->tui.on) {
        plain_line(self, t_ms, event, by_operator);
        tui_log(&self->tui, self->line, by_operator ? TONE_OPERATOR : tone_of(event), key_of(event));
        self->shown_ms = moment->now_ms - SCREEN_MS;
        return;
    }
    if (self->options.json) {
        length = report_event_json(event, t_ms, self->line, sizeof self->line);
    } else {
        length = plain_line(self, t_ms, event, by_operator);
    }
    if (length > 0) {
        output_line(&self->out, self->line, length);
    }
}

void voice_losses(voice_t *self, const moment_t *moment, argus_failure_t failure) {
    const uint32_t lost = self->out.dropped - self->lost_said;
    if (lost == 0) {
        return;
    }
    if (self->out.broken && !self->reader_said) {
        self->reader_said = true;
        char text[128];
        const bool gone = self->out.problem == 0 || self->out.problem == EPIPE;
        snprintf(text, sizeof text, "standard output: %s; going on without",
                 gone ? "nobody reads it any more" : strerror(self->out.problem));
        voice_notice(self, text);
    }
    if (self->out.broken || self->out.used > OUTPUT_BACKLOG / 2) {
        return;
    }
    const argus_event_t event = {.t_ms = moment->now_ms,
                                 .id = ARGUS_EV_EVENTS_LOST,
                                 .sonar = ARGUS_NO_SONAR,
                                 .state = (uint8_t)failure,
                                 .value = (int32_t)lost};
    self->lost_said = self->out.dropped;
    voice_event(self, moment, &event);
}

bool voice_is_due(const voice_t *self, uint32_t now_ms) {
    if (self->tui.on) {
        return now_ms - self->shown_ms >= SCREEN_MS;
    }
    return self->options.status_ms > 0 && now_ms - self->status_ms >= self->options.status_ms;
}

static size_t status_line(voice_t *self, const view_t *view) {
    if (!self->options.json) {
        return report_status_plain(view, self->line, sizeof self->line);
    }
    struct timespec wall = {0};
    clock_gettime(CLOCK_REALTIME, &wall);
    const int64_t unix_ms = (int64_t)wall.tv_sec * 1000 + wall.tv_nsec / 1000000;
    return report_status_json(view, unix_ms, self->line, sizeof self->line);
}

void voice_summary(voice_t *self, const view_t *view) {
    size_t length = 0;
    if (!self->options.json) {
        length = report_summary(view, self->line, sizeof self->line);
    } else if (self->options.status_ms > 0) {
        length = status_line(self, view);
    }
    if (length > 0) {
        output_line(&self->out, self->line, length);
    }
}

void voice_show(voice_t *self, const moment_t *moment, const view_t *view) {
    if (self->tui.on) {
        self->shown_ms = moment->now_ms;
        tui_show(&self->tui, view);
        return;
    }
    self->status_ms = moment->now_ms;
    const size_t length = status_line(self, view);
    if (length > 0) {
        output_line(&self->out, self->line, length);
    }
}

void voice_show_silence(voice_t *self, const moment_t *moment, const view_t *view) {
    if (self->tui.on) {
        view_t old = *view;
        old.silent = true;
        voice_show(self, moment, &old);
    }
    self->status_ms = moment->now_ms;
}

static uint32_t sooner(uint32_t wait_ms, uint32_t period_ms, uint32_t since_ms) {
    const uint32_t left_ms = since_ms < period_ms ? period_ms - since_ms : 0;
    return left_ms < wait_ms ? left_ms : wait_ms;
}

uint32_t voice_wait_ms(const voice_t *self, uint32_t now_ms, uint32_t wait_ms) {
    if (self->tui.on) {
        return sooner(wait_ms, SCREEN_MS, now_ms - self->shown_ms);
    }
    if (self->options.status_ms > 0) {
        return sooner(wait_ms, self->options.status_ms, now_ms - self->status_ms);
    }
    return wait_ms;
}

void voice_flush(voice_t *self) {
    output_flush(&self->out);
    output_flush(&self->err);
}

void voice_end(voice_t *self, const hal_clock_t *clock) {
    const uint32_t start_ms = hal_clock_now_ms(clock);
    uint32_t waited_ms = 0;
    while (output_waits(&self->out) && waited_ms < DRAIN_MAX_MS) {
        struct pollfd wait = {.fd = self->out.fd, .events = POLLOUT};
        poll(&wait, 1, (int)(DRAIN_MAX_MS - waited_ms));
        output_flush(&self->out);
        waited_ms = hal_clock_now_ms(clock) - start_ms;
    }
    output_close(&self->out);
    output_close(&self->err);
}
