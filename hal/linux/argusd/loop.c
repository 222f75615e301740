// SPDX-License-Identifier: MIT
// The loop.
#include "loop.h"

#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "check.h"
#include "report.h"
#include "signals.h"

#define SCREEN_MS 200u
#define SAVE_MS 5000u
#define CLOSE_MAX_MS 4000u
#define DRAIN_MAX_MS 500
#define TURN_DEG 20
#define ORDERS_MAX 8 // in one wake-up: a flood of them must not keep time from passing

static void take_time(loop_t *self) {
    const uint32_t now_ms = hal_clock_now_ms(&self->driver.clock);
    self->t_ms += now_ms - self->now_ms;
    self->now_ms = now_ms;
}

// Time of an event, which may lie a little before or after `now`.
static uint64_t since_start(const loop_t *self, uint32_t ms) {
    const int64_t t_ms = (int64_t)self->t_ms + (int32_t)(ms - self->now_ms);
    return t_ms < 0 ? 0 : (uint64_t)t_ms;
}

static void notice(loop_t *self, const char *text) {
    if (self->tui.on) {
        tui_log(&self->tui, text, TONE_WARN);
        return;
    }
    const int length = snprintf(self->line, sizeof self->line, "argusd: %s", text);
    output_line(&self->err, self->line,
                (size_t)length < sizeof self->line ? (size_t)length : sizeof self->line - 1);
}

static tone_t tone_of(argus_level_t level) {
    return level == ARGUS_LEVEL_ERROR ? TONE_BAD : level == ARGUS_LEVEL_WARN ? TONE_WARN : TONE_PLAIN;
}

static void say(loop_t *self, const argus_event_t *event) {
    const uint64_t t_ms = since_start(self, event->t_ms);
    size_t length = 0;
    if (self->tui.on) {
        report_event_plain(event, t_ms, false, self->line, sizeof self->line);
        tui_log(&self->tui, self->line, tone_of(argus_event_level(event->id)));
        self->shown_ms = self->now_ms - SCREEN_MS;
        return;
    }
    if (self->options.json) {
        length = report_event_json(event, t_ms, self->line, sizeof self->line);
    } else {
        length = report_event_plain(event, t_ms, self->colour, self->line, sizeof self->line);
    }
    if (length > 0) {
        output_line(&self->out, self->line, length);
    }
}

// A reader that was slow is told what it missed as soon as there is room.
static void say_losses(loop_t *self) {
    const uint32_t lost = self->out.dropped - self->lost_said;
    if (lost == 0) {
        return;
    }
    if (self->out.broken && !self->reader_said) {
        self->reader_said = true;
        notice(self, "nobody reads standard output any more; going on without");
    }
    if (self->out.broken || self->out.used > OUTPUT_BACKLOG / 2) {
        return;
    }
    const argus_event_t event = {.t_ms = self->now_ms,
                                 .id = ARGUS_EV_EVENTS_LOST,
                                 .sonar = ARGUS_NO_SONAR,
                                 .state = (uint8_t)self->driver.core.failure,
                                 .value = (int32_t)lost};
    self->lost_said = self->out.dropped;
    say(self, &event);
}

static void say_events(loop_t *self) {
    argus_event_t event;
    while (argus_next_event(&self->driver.core, &event)) {
        bus_event(&self->bus, &self->driver.core, &event);
        say(self, &event);
    }
    say_losses(self);
}

static bool is_link_can(const driver_t *driver) {
    return driver->spec.scheme == HAL_SCHEME_CAN && driver->transport != NULL;
}

static void look_at_can(const loop_t *self, view_t *view) {
    const bool link = is_link_can(&self->driver);
    view->has_can = link || self->bus.on;
    if (link) {
        memcpy(view->can_errors, self->driver.transport->isotp.errors, sizeof view->can_errors);
    }
    view->can_sent = self->bus.raw.sent;
    view->can_taken = self->bus.telemetry.verdicts[HAL_TELEMETRY_TAKEN];
    view->can_refused = hal_telemetry_refused(&self->bus.telemetry);
}

static void look(loop_t *self) {
    view_t *const view = &self->view;
    const driver_t *const driver = &self->driver;
    argus_status(&driver->core, &view->status);
    view->t_ms = self->t_ms;
    snprintf(view->name, sizeof view->name, "%s", view->status.robot_name);
    snprintf(view->robot_class, sizeof view->robot_class, "%s", view->status.robot_class);
    snprintf(view->subclass, sizeof view->subclass, "%s", view->status.robot_subclass);
    snprintf(view->link, sizeof view->link, "%s", hal_link_describe(&driver->link));
    view->link_up = driver->up;
    view->counters = hal_link_counters(&driver->link);
    view->reopened = driver->reopened;
    view->course_mm = self->course_mm;
    view->sonar = self->sonar;
    view->pinned = driver->core.pinned;
    look_at_can(self, view);
}

static void say_status(loop_t *self) {
    size_t length = 0;
    if (self->tui.on || self->options.status_ms == 0 ||
        self->now_ms - self->status_ms < self->options.status_ms) {
        return;
    }
    self->status_ms = self->now_ms;
    look(self);
    if (self->options.json) {
        struct timespec wall = {0};
        clock_gettime(CLOCK_REALTIME, &wall);
        const int64_t unix_ms = (int64_t)wall.tv_sec * 1000 + wall.tv_nsec / 1000000;
        length = report_status_json(&self->view, unix_ms, self->line, sizeof self->line);
    } else {
        length = report_status_plain(&self->view, self->line, sizeof self->line);
    }
    if (length > 0) {
        output_line(&self->out, self->line, length);
    }
}

static void show(loop_t *self) {
    if (self->tui.on && self->now_ms - self->shown_ms >= SCREEN_MS) {
        self->shown_ms = self->now_ms;
        look(self);
        tui_show(&self->tui, &self->view);
    }
}

static void end(loop_t *self, argusd_exit_t code) {
    if (!self->ending) {
        self->ending = true;
        self->code = code;
        self->ending_ms = self->now_ms;
        argus_shutdown(&self->driver.core, self->now_ms);
        driver_transmit(&self->driver);
    }
}

static argusd_exit_t code_of_mission(const loop_t *self) {
    return self->driver.core.mission == ARGUS_MISSION_FAILED ? ARGUSD_EXIT_MISSION : ARGUSD_EXIT_OK;
}

static void operate(loop_t *self, argus_op_t op, int32_t argument) {
    if (!self->ending) {
        argus_operator(&self->driver.core, self->now_ms, op, argument);
        driver_transmit(&self->driver);
    }
}

static void quit(loop_t *self) {
    self->quits++;
    end(self, code_of_mission(self));
}

// Whoever watched can no longer stop it by hand.
static void lose_screen(loop_t *self) {
    tui_stop(&self->tui);
    notice(self, "the screen is gone: stopping");
    end(self, ARGUSD_EXIT_INTERNAL);
}

static void jog(loop_t *self, tui_key_t key) {
    const argus_config_t *const config = &self->driver.core.config;
    const bool turns = key == TUI_LEFT || key == TUI_RIGHT;
    const int32_t move_mm = key == TUI_AHEAD ? config->step_mm : -config->backoff_mm;
    const int32_t turn_deg = key == TUI_LEFT ? TURN_DEG : -TURN_DEG;
    operate(self, turns ? ARGUS_OP_TURN : ARGUS_OP_MOVE, turns ? turn_deg : move_mm);
}

// True when the key was for the chosen sonar.
static bool serve_sonar(loop_t *self, tui_key_t key) {
    const bool pinned = (self->driver.core.pinned >> self->sonar & 1) != 0;
    switch (key) {
    case TUI_NEXT:
        self->sonar = (uint8_t)((self->sonar + 1) % ARGUS_SONARS);
        return true;
    case TUI_PREVIOUS:
        self->sonar = (uint8_t)((self->sonar + ARGUS_SONARS - 1) % ARGUS_SONARS);
        return true;
    case TUI_RETEST:
        operate(self, ARGUS_OP_RETEST, self->sonar);
        return true;
    case TUI_PIN:
        operate(self, pinned ? ARGUS_OP_UNPIN : ARGUS_OP_PIN, self->sonar);
        return true;
    case TUI_TAKE_OUT:
        operate(self, ARGUS_OP_DISABLE, self->sonar);
        return true;
    default:
        return false;
    }
}

static void obey(loop_t *self, tui_key_t key) {
    if (serve_sonar(self, key)) {
        return;
    }
    switch (key) {
    case TUI_STOP:
        operate(self, ARGUS_OP_STOP, 0);
        break;
    case TUI_GO:
        operate(self, ARGUS_OP_GO, 0);
        break;
    case TUI_RECHECK:
        operate(self, ARGUS_OP_RECHECK, 0);
        break;
    case TUI_PASSIVE:
        operate(self, self->driver.core.passive ? ARGUS_OP_ACTIVE : ARGUS_OP_PASSIVE, 0);
        break;
    case TUI_QUIT:
        quit(self);
        break;
    case TUI_GONE:
        lose_screen(self);
        break;
    case TUI_NONE:
        break;
    default:
        jog(self, key);
        break;
    }
}

static void take_keys(loop_t *self) {
    for (tui_key_t key = tui_key(&self->tui); key != TUI_NONE; key = tui_key(&self->tui)) {
        obey(self, key);
    }
}

static void obey_order(loop_t *self, const hal_dbc_command_t *order) {
    static const argus_op_t ops[] = {[HAL_DBC_ORDER_STOP] = ARGUS_OP_STOP,
                                     [HAL_DBC_ORDER_GO] = ARGUS_OP_GO,
                                     [HAL_DBC_ORDER_PASSIVE] = ARGUS_OP_PASSIVE,
                                     [HAL_DBC_ORDER_ACTIVE] = ARGUS_OP_ACTIVE,
                                     [HAL_DBC_ORDER_RETEST] = ARGUS_OP_RETEST};
    operate(self, ops[order->order], order->sonar);
}

static void take_orders(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    hal_dbc_command_t order;
    hal_telemetry_verdict_t verdict = HAL_TELEMETRY_TAKEN;
    for (int i = 0; i < ORDERS_MAX && bus_order(&self->bus, self->now_ms, &verdict, &order); i++) {
        if (verdict == HAL_TELEMETRY_TAKEN) {
            obey_order(self, &order);
        } else if (bus_refusal(&self->bus, verdict, self->now_ms, text, sizeof text)) {
            notice(self, text);
        }
    }
}

// Returns the ms until it has something to send.
static uint32_t tell_bus(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    const uint32_t wait_ms = bus_process(&self->bus, &self->driver.core, self->now_ms);
    if (bus_notice(&self->bus, text, sizeof text)) {
        notice(self, text);
    }
    if (is_link_can(&self->driver) &&
        bus_link_notice(&self->bus, &self->driver.transport->isotp, self->now_ms, text, sizeof text)) {
        notice(self, text);
    }
    return wait_ms;
}

static void watch_mission(loop_t *self) {
    const argus_mission_t mission = self->driver.core.mission;
    // On a screen the operator says when it is over.
    if (!self->tui.on && (mission == ARGUS_MISSION_REACHED || mission == ARGUS_MISSION_FAILED)) {
        end(self, code_of_mission(self));
    }
}

static void watch_answer(loop_t *self) {
    const uint32_t waited_ms = self->now_ms - self->start_ms;
    self->met = self->met || argus_session_is_open(&self->driver.core.session);
    if (self->met || self->ending || self->options.answer_ms == UINT32_MAX ||
        waited_ms < self->options.answer_ms) {
        return;
    }
    char text[ARGUSD_MESSAGE_MAX];
    check_explain_silence(&self->driver, waited_ms, text, sizeof text);
    tui_stop(&self->tui);
    notice(self, text);
    end(self, ARGUSD_EXIT_NO_ROBOT);
}

static bool is_at_rest(const argus_t *core) {
    const bool may_move = core->mode != ARGUS_MODE_IDLE && core->mode != ARGUS_MODE_WAITING &&
                          core->mode != ARGUS_MODE_OFFLINE && core->mode != ARGUS_MODE_CLOSED;
    return !may_move && core->knowledge.vel_left_mm_s == 0 && core->knowledge.vel_right_mm_s == 0;
}

static void save(loop_t *self, bool now) {
    char text[ARGUSD_MESSAGE_MAX];
    if (!now && (self->now_ms - self->saved_ms < SAVE_MS || !is_at_rest(&self->driver.core))) {
        return;
    }
    self->saved_ms = self->now_ms;
    if (!state_save(&self->state, &self->driver.core, text, sizeof text)) {
        notice(self, text);
        self->state.on = false; // once is enough
    }
}

static void watch_tape(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    if (tape_problem(&self->tape, text, sizeof text)) {
        notice(self, text);
    }
}

static void close_tape(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    if (tape_close(&self->tape, text, sizeof text)) {
        notice(self, text);
    }
}

static bool is_over(loop_t *self) {
    if (!self->ending) {
        return false;
    }
    if (argus_closed(&self->driver.core) && !driver_wants_write(&self->driver)) {
        return true;
    }
    if (self->now_ms - self->ending_ms >= CLOSE_MAX_MS || signals_ends() + self->quits > 1) {
        notice(self, "the session was not closed in order; the robot's watchdog stops it");
        return true;
    }
    return false;
}

static uint32_t sooner(uint32_t wait_ms, uint32_t period_ms, uint32_t since_ms) {
    const uint32_t left_ms = since_ms < period_ms ? period_ms - since_ms : 0;
    return left_ms < wait_ms ? left_ms : wait_ms;
}

static uint32_t time_to_wait(const loop_t *self, uint32_t wait_ms) {
    if (self->tui.on) {
        return sooner(wait_ms, SCREEN_MS, self->now_ms - self->shown_ms);
    }
    if (self->options.status_ms > 0) {
        return sooner(wait_ms, self->options.status_ms, self->now_ms - self->status_ms);
    }
    return wait_ms;
}

// The link comes first: what a SIP calls for is on the wire before anything else is looked at.
static void wait_for_work(loop_t *self, uint32_t wait_ms) {
    enum { LINK, SIGNALS, KEYS, OUT, ERR, BUS, COUNT };
    struct pollfd wait[COUNT] = {
        [LINK] = {.fd = self->driver.up ? hal_link_fd(&self->driver.link) : -1, .events = POLLIN},
        [SIGNALS] = {.fd = signals_fd(), .events = POLLIN},
        [KEYS] = {.fd = self->tui.on ? self->tui.fd : -1, .events = POLLIN},
        [OUT] = {.fd = output_waits(&self->out) ? self->out.fd : -1, .events = POLLOUT},
        [ERR] = {.fd = output_waits(&self->err) ? self->err.fd : -1, .events = POLLOUT},
        [BUS] = {.fd = bus_fd(&self->bus), .events = POLLIN},
    };
    char bytes[16];
    if (driver_wants_write(&self->driver)) {
        wait[LINK].events |= POLLOUT;
    }
    poll(wait, COUNT, (int)wait_ms);
    if (wait[LINK].revents != 0) {
        driver_receive(&self->driver);
    }
    take_time(self);
    if (wait[SIGNALS].revents != 0) {
        (void)!read(signals_fd(), bytes, sizeof bytes);
    }
    if (wait[KEYS].revents != 0) {
        take_keys(self);
    }
    if (wait[BUS].revents != 0) {
        take_orders(self);
    }
    output_flush(&self->out);
    output_flush(&self->err);
}

static void begin(loop_t *self, const loop_options_t *options) {
    const char *const no_colour = getenv("NO_COLOR");
    argus_status_t status;
    self->options = *options;
    self->now_ms = hal_clock_now_ms(&self->driver.clock);
    self->start_ms = self->now_ms;
    self->status_ms = self->now_ms;
    self->saved_ms = self->now_ms;
    self->driver.cancel_fd = signals_fd();
    output_init(&self->err, STDERR_FILENO);
    if (!options->json && !options->plain) {
        tui_start(&self->tui);
    }
    output_init(&self->out, STDOUT_FILENO);
    self->colour = isatty(STDOUT_FILENO) && (no_colour == NULL || no_colour[0] == '\0');
    if (options->notice != NULL) {
        notice(self, options->notice);
    }
    argus_status(&self->driver.core, &status);
    self->course_mm = status.goal_mm > 0 ? (uint32_t)status.goal_mm : 0;
}

// The last lines may still wait for their reader, but not for long.
static void drain(loop_t *self) {
    const uint32_t start_ms = hal_clock_now_ms(&self->driver.clock);
    uint32_t waited_ms = 0;
    while (output_waits(&self->out) && waited_ms < DRAIN_MAX_MS) {
        struct pollfd wait = {.fd = self->out.fd, .events = POLLOUT};
        poll(&wait, 1, (int)(DRAIN_MAX_MS - waited_ms));
        output_flush(&self->out);
        waited_ms = hal_clock_now_ms(&self->driver.clock) - start_ms;
    }
    output_close(&self->out);
    output_close(&self->err);
}

argusd_exit_t loop_run(loop_t *self, const loop_options_t *options) {
    begin(self, options);
    for (;;) {
        const uint32_t wait_ms = driver_process(&self->driver);
        take_time(self);
        say_events(self);
        watch_answer(self);
        watch_mission(self);
        if (signals_ends() > 0) {
            end(self, code_of_mission(self));
        }
        say_status(self);
        show(self);
        save(self, false);
        watch_tape(self);
        if (is_over(self)) {
            break;
        }
        const uint32_t bus_ms = tell_bus(self);
        wait_for_work(self, time_to_wait(self, wait_ms < bus_ms ? wait_ms : bus_ms));
        say_events(self);
    }
    say_events(self);
    bus_close(&self->bus, &self->driver.core, self->now_ms);
    driver_close(&self->driver);
    tui_stop(&self->tui);
    save(self, true);
    close_tape(self);
    drain(self);
    return self->code;
}
