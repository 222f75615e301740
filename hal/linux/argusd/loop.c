// SPDX-License-Identifier: MIT
// The loop.
#include "loop.h"

#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "check.h"
#include "settings.h"
#include "signals.h"

#define SAVE_MS 5000u
#define CLOSE_MAX_MS 4000u
#define WISH_MS 1000u
#define REST_MM_S 5  // encoders tremble
#define ORDERS_MAX 8 // in one wake-up: a flood of them must not keep time from passing

static void take_time(loop_t *self) {
    moment_take(&self->moment, hal_clock_now_ms(&self->driver.clock));
}

static argus_status_t status_of(const loop_t *self) {
    argus_status_t status;
    argus_status(self->driver.core, &status);
    return status;
}

static void say_stranger(loop_t *self, const argus_status_t *status) {
    char text[ARGUSD_MESSAGE_MAX];
    snprintf(text, sizeof text,
             "another robot is at the link now: name '%s', class '%s', subclass '%s', serial number '%s'; it "
             "is not "
             "driven until it is made active and told to go (p, g, or the orders over CAN)",
             status->robot_name, status->robot_class, status->robot_subclass, status->robot_serial);
    voice_notice(&self->voice, text);
}

static void say_event(loop_t *self, const argus_status_t *status, const argus_event_t *event) {
    bus_event(&self->bus, status, event);
    voice_event(&self->voice, &self->moment, event);
    control_event(&self->control, moment_of(&self->moment, event->t_ms), event);
}

// What argusd itself does to the sonars is told like what the manager finds.
static void say_injections(loop_t *self, const argus_status_t *status) {
    inject_change_t change;
    while (inject_change(&self->inject, &change)) {
        const argus_event_t event = {.t_ms = self->moment.now_ms,
                                     .id = ARGUS_EV_INJECTED,
                                     .sonar = (int8_t)change.sonar,
                                     .state = (uint8_t)status->failure,
                                     .value = (int32_t)change.kind};
        tape_injected(&self->tape, change.sonar, change.kind, change.for_ms);
        say_event(self, status, &event);
    }
}

// The arithmetic of the refusal, for the body that was met: the event tells one figure of it.
static void say_unsafe(loop_t *self, const argus_status_t *status) {
    settings_t met = {.config = *self->config};
    char name[ARGUSD_MESSAGE_MAX / 4];
    char why[ARGUSD_MESSAGE_MAX / 2];
    char text[ARGUSD_MESSAGE_MAX];
    if (settings_choose(&met, SETTINGS_robot, status->robot_body, "robot", name, sizeof name) &&
        !settings_check(&met, why, sizeof why)) {
        snprintf(text, sizeof text, "%s: %s", status->robot_body, why);
        voice_notice(&self->voice, text);
    }
}

static void say_events(loop_t *self) {
    argus_event_t event;
    const argus_status_t status = status_of(self);
    say_injections(self, &status);
    while (argus_next_event(self->driver.core, &event)) {
        self->closed =
            event.id == ARGUS_EV_SESSION_CLOSED || (self->closed && event.id != ARGUS_EV_SESSION_OPEN);
        say_event(self, &status, &event);
        if (event.id == ARGUS_EV_OTHER_ROBOT) {
            say_stranger(self, &status);
        } else if (event.id == ARGUS_EV_ROBOT_UNSAFE) {
            say_unsafe(self, &status);
        }
    }
    voice_losses(&self->voice, &self->moment, status.failure);
}

// NULL: the link is none over CAN.
static const hal_isotp_t *isotp_of(const driver_t *driver) {
    return driver->transport == NULL ? NULL : hal_transport_isotp(driver->transport);
}

static void look_at_can(const loop_t *self, view_t *view) {
    const hal_isotp_t *const link = isotp_of(&self->driver);
    view->has_can = link != NULL || self->bus.on;
    if (link != NULL) {
        memcpy(view->can_errors, link->errors, sizeof view->can_errors);
    }
    view->can_sent = self->bus.raw.sent;
    view->can_taken = self->bus.telemetry.verdicts[HAL_TELEMETRY_TAKEN];
    view->can_refused = hal_telemetry_refused(&self->bus.telemetry);
}

static void look(loop_t *self) {
    view_t *const view = &self->view;
    const driver_t *const driver = &self->driver;
    argus_status(driver->core, &view->status);
    view->t_ms = self->moment.t_ms;
    snprintf(view->name, sizeof view->name, "%s", view->status.robot_name);
    snprintf(view->robot_class, sizeof view->robot_class, "%s", view->status.robot_class);
    snprintf(view->subclass, sizeof view->subclass, "%s", view->status.robot_subclass);
    snprintf(view->link, sizeof view->link, "%s", hal_link_describe(&driver->link));
    view->link_up = driver->up;
    view->counters = hal_link_counters(&driver->link);
    view->reopened = driver->reopened;
    view->course_mm = self->course_mm;
    view->sonar = self->operator.sonar;
    view->controlled = control_is_held(&self->control);
    view->inject = self->inject.armed;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        view->injected[i] = (uint8_t)self->inject.of[i].mark;
    }
    look_at_can(self, view);
}

static const view_t *look_for_control(void *context) {
    loop_t *const self = context;
    look(self);
    return &self->view;
}

static void show(loop_t *self) {
    if (voice_is_due(&self->voice, self->moment.now_ms)) {
        look(self);
        voice_show(&self->voice, &self->moment, &self->view);
    }
}

// A moving robot is stopped at once, and its session closed when SIPs show it at rest. A passive robot's is
// closed when its next SIP comes: after CLOSE none does, so nothing else tells that it hears us.
static void shut_down(loop_t *self, const argus_status_t *status) {
    const bool waits = !status->active && status->online && status->sips == self->sips;
    if (!self->shut && !waits) {
        self->shut = true;
        argus_shutdown(self->driver.core, self->moment.now_ms);
        driver_transmit(&self->driver);
    }
}

static bool is_still(int32_t mm_s) {
    return mm_s >= -REST_MM_S && mm_s <= REST_MM_S;
}

// Whether the robot hears the end. To be called before time passes for the manager, which then may leave.
static void hear_end(loop_t *self) {
    const argus_status_t status = status_of(self);
    if (self->ending && status.open) {
        self->heard = status.online && status.sips != self->sips;
        self->rested = !status.active || (is_still(status.vel_left_mm_s) && is_still(status.vel_right_mm_s));
    }
    if (self->ending) {
        shut_down(self, &status);
    }
}

static void end(loop_t *self, argusd_exit_t code) {
    if (!self->ending) {
        self->ending = true;
        self->code = code;
        self->ending_ms = self->moment.now_ms;
        self->sips = status_of(self).sips;
        notify_stopping(&self->notify);
        hear_end(self);
    }
}

static argusd_exit_t code_of_mission(const loop_t *self) {
    return status_of(self).mission == ARGUS_MISSION_FAILED ? ARGUSD_EXIT_MISSION : ARGUSD_EXIT_OK;
}

// A wrapper and the terminal may deliver one Ctrl-C twice, a key repeats, SIGHUP follows SIGTERM.
static void wish_to_end(loop_t *self) {
    if (self->wishes == 0 || self->moment.now_ms - self->wished_ms >= WISH_MS) {
        self->wishes++;
        self->wished_ms = self->moment.now_ms;
    }
    end(self, code_of_mission(self));
}

static void take_signals(loop_t *self) {
    const int signals = signals_ends();
    if (signals != self->signals) {
        self->signals = signals;
        wish_to_end(self);
    }
}

// The client that watched can no longer stop it by hand.
static void lose_screen(loop_t *self) {
    tui_stop(&self->voice.tui);
    voice_notice(&self->voice, "the screen is gone: stopping");
    end(self, ARGUSD_EXIT_INTERNAL);
}

static void obey(loop_t *self, tui_key_t key) {
    if (key == TUI_QUIT) {
        wish_to_end(self);
    } else if (key == TUI_GONE) {
        lose_screen(self);
    } else if (self->ending) {
        voice_answer(&self->voice, "> it is ending");
    } else {
        char answer[ARGUSD_MESSAGE_MAX];
        operator_key(&self->operator, key, self->moment.now_ms, answer, sizeof answer);
        voice_answer(&self->voice, answer);
    }
}

static void take_keys(loop_t *self) {
    for (tui_key_t key = tui_key(&self->voice.tui); key != TUI_NONE; key = tui_key(&self->voice.tui)) {
        obey(self, key);
    }
}

static void obey_order(loop_t *self, const hal_dbc_command_t *order) {
    if (!self->ending) {
        operator_order(&self->operator, order, self->moment.now_ms);
    }
}

static void take_orders(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    hal_dbc_command_t order;
    hal_telemetry_verdict_t verdict = HAL_TELEMETRY_TAKEN;
    for (int i = 0; i < ORDERS_MAX && bus_order(&self->bus, self->moment.now_ms, &verdict, &order); i++) {
        if (verdict == HAL_TELEMETRY_TAKEN) {
            obey_order(self, &order);
        } else if (bus_refusal(&self->bus, verdict, self->moment.now_ms, text, sizeof text)) {
            voice_notice(&self->voice, text);
        }
    }
}

static void take_control(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    self->control.world.hands.ending = self->ending;
    control_serve(&self->control, &self->moment);
    if (control_is_quit(&self->control) && !self->ending) {
        end(self, code_of_mission(self));
    }
    if (control_notice(&self->control, text, sizeof text)) {
        voice_notice(&self->voice, text);
    }
}

// A robot that comes back may be another one, or stand elsewhere: nothing is altered any more.
static void watch_injection(loop_t *self) {
    if (!self->inject.armed) {
        return;
    }
    const argus_status_t status = status_of(self);
    inject_expire(&self->inject, !self->driver.up || self->ending, self->moment.now_ms);
    inject_settle(&self->inject, &status, self->moment.now_ms);
}

// Returns the ms until it has something to send.
static uint32_t tell_bus(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    const argus_status_t status = status_of(self);
    self->bus.telemetry.injected = (argus_mask_t)inject_marked(&self->inject);
    const uint32_t wait_ms = bus_process(&self->bus, &status, self->moment.now_ms);
    if (bus_notice(&self->bus, text, sizeof text)) {
        voice_notice(&self->voice, text);
    }
    const hal_isotp_t *const link = isotp_of(&self->driver);
    if (link != NULL && bus_link_notice(&self->bus, link, self->moment.now_ms, text, sizeof text)) {
        voice_notice(&self->voice, text);
    }
    return wait_ms;
}

static void watch_mission(loop_t *self) {
    const argus_mission_t mission = status_of(self).mission;
    // On a screen the operator says when it is over, and so does a client that gives orders at the control
    // socket.
    const bool operated = self->voice.tui.on || self->control.world.hands.ordered;
    if (!operated && (mission == ARGUS_MISSION_REACHED || mission == ARGUS_MISSION_FAILED)) {
        end(self, code_of_mission(self));
    }
}

static void watch_answer(loop_t *self) {
    const uint32_t waited_ms = self->moment.now_ms - self->start_ms;
    self->met = self->met || status_of(self).open;
    if (self->met || self->ending || self->options.answer_ms == UINT32_MAX ||
        waited_ms < self->options.answer_ms) {
        return;
    }
    char text[ARGUSD_MESSAGE_MAX];
    const argusd_exit_t code = check_explain_silence(&self->driver, waited_ms, text, sizeof text);
    tui_stop(&self->voice.tui);
    voice_notice(&self->voice, text);
    end(self, code);
}

static bool is_at_rest(const argus_status_t *status) {
    const bool may_move = status->mode != ARGUS_MODE_IDLE && status->mode != ARGUS_MODE_WAITING &&
                          status->mode != ARGUS_MODE_OFFLINE && status->mode != ARGUS_MODE_CLOSED;
    return !may_move && status->vel_left_mm_s == 0 && status->vel_right_mm_s == 0;
}

static void save(loop_t *self, bool now) {
    char text[ARGUSD_MESSAGE_MAX];
    const argus_status_t status = status_of(self);
    if (!now && (self->moment.now_ms - self->saved_ms < SAVE_MS || !is_at_rest(&status))) {
        return;
    }
    self->saved_ms = self->moment.now_ms;
    if (!state_save(&self->state, self->driver.core, text, sizeof text)) {
        voice_notice(&self->voice, text);
        self->state.on = false; // once is enough
    }
}

// Returns the ms until the next sign of life is due.
static uint32_t tell_service(loop_t *self) {
    const argus_status_t status = status_of(self);
    if (!self->ending) {
        notify_robot(&self->notify, &status, inject_marked(&self->inject));
    }
    return notify_alive(&self->notify, self->moment.now_ms);
}

static uint32_t sooner(uint32_t a_ms, uint32_t b_ms) {
    return a_ms < b_ms ? a_ms : b_ms;
}

static void watch_link(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    if (driver_reason(&self->driver, text, sizeof text)) {
        voice_notice(&self->voice, text);
    }
}

static void watch_tape(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    if (tape_problem(&self->tape, text, sizeof text)) {
        voice_notice(&self->voice, text);
    }
}

static void close_tape(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    if (tape_close(&self->tape, text, sizeof text)) {
        voice_notice(&self->voice, text);
    }
}

static void say_unclean(loop_t *self, const char *why) {
    char text[ARGUSD_MESSAGE_MAX];
    snprintf(text, sizeof text, "the session was not closed in order, %s; the robot's watchdog stops it",
             why);
    voice_notice(&self->voice, text);
    if (self->code == ARGUSD_EXIT_OK || self->code == ARGUSD_EXIT_MISSION) {
        self->code = ARGUSD_EXIT_UNCLEAN;
    }
}

// All is written; whether the robot can have heard it is another matter.
static void judge_end(loop_t *self) {
    if (self->met && !self->closed) {
        say_unclean(self, self->driver.up ? "since no robot answered" : "since the link was down");
    } else if (self->met && !self->heard) {
        say_unclean(self, "since the robot had gone silent, and may not have heard the end");
    } else if (self->met && !self->rested) {
        say_unclean(self, "since the robot did not come to rest in time");
    }
}

static bool is_over(loop_t *self) {
    if (!self->ending) {
        return false;
    }
    if (argus_closed(self->driver.core) && !driver_wants_write(&self->driver)) {
        judge_end(self);
        return true;
    }
    if (self->moment.now_ms - self->ending_ms >= CLOSE_MAX_MS) {
        say_unclean(self, "since it took too long");
        return true;
    }
    if (self->wishes > 1) {
        say_unclean(self, "since the end was asked for again");
        return true;
    }
    return false;
}

static void serve_guards(loop_t *self) {
    char text[ARGUSD_MESSAGE_MAX];
    guards_serve(&self->guards, self->moment.now_ms);
    if (guards_notice(&self->guards, text, sizeof text)) {
        voice_notice(&self->voice, text);
    }
}

// The link comes first: what a SIP calls for is on the wire before anything else is looked at.
static void wait_for_work(loop_t *self, uint32_t wait_ms) {
    enum { LINK, SIGNALS, KEYS, OUT, ERR, BUS, GUARDS };
    enum { COUNT = GUARDS + GUARDS_FDS };
    struct pollfd wait[COUNT + CONTROL_POLL_MAX] = {
        [LINK] = {.fd = self->driver.up ? hal_link_fd(&self->driver.link) : -1, .events = POLLIN},
        [SIGNALS] = {.fd = signals_fd(), .events = POLLIN},
        [KEYS] = {.fd = self->voice.tui.on ? self->voice.tui.fd : -1, .events = POLLIN},
        [OUT] = {.fd = output_waits(&self->voice.out) ? self->voice.out.fd : -1, .events = POLLOUT},
        [ERR] = {.fd = output_waits(&self->voice.err) ? self->voice.err.fd : -1, .events = POLLOUT},
        [BUS] = {.fd = bus_fd(&self->bus), .events = POLLIN},
    };
    char bytes[16];
    if (driver_wants_write(&self->driver)) {
        wait[LINK].events |= POLLOUT;
    }
    guards_wait(&self->guards, &wait[GUARDS]);
    const int controls = control_poll(&self->control, wait + COUNT);
    poll(wait, (nfds_t)COUNT + (nfds_t)controls, (int)wait_ms);
    // Also where nothing made it readable: a CAN link counts frames of the other format on the way.
    driver_receive(&self->driver);
    take_time(self);
    serve_guards(self);
    if (wait[SIGNALS].revents != 0) {
        (void)!read(signals_fd(), bytes, sizeof bytes);
    }
    if (wait[KEYS].revents != 0) {
        take_keys(self);
    }
    if (wait[BUS].revents != 0) {
        take_orders(self);
    }
    take_control(self);
    voice_flush(&self->voice);
}

static void begin_control(loop_t *self) {
    char where[ARGUSD_MESSAGE_MAX / 2];
    char text[ARGUSD_MESSAGE_MAX];
    const control_world_t world = {.hands = {.op = &self->operator, .inject = & self->inject },
                                             .look = look_for_control,
                                             .context = self};
    if (!self->control.on) {
        return;
    }
    control_begin(&self->control, &world);
    control_port_describe(&self->control.port, where, sizeof where);
    snprintf(text, sizeof text, "control socket at %s%s%s", where,
             self->control.port.spec.loopback ? "" : ", which other machines reach, and hear what is said",
             self->inject.armed ? "; faults can be injected" : "");
    voice_notice(&self->voice, text);
}

static void begin(loop_t *self, const loop_options_t *options) {
    self->config = options->config;
    const int32_t goal_mm = status_of(self).goal_mm;
    self->options = *options;
    self->moment.now_ms = hal_clock_now_ms(&self->driver.clock);
    self->start_ms = self->moment.now_ms;
    self->saved_ms = self->moment.now_ms;
    self->driver.cancel_fd = signals_fd();
    operator_init(&self->operator, & self->driver, options->config);
    voice_begin(&self->voice, &options->voice, &self->moment);
    begin_control(self);
    if (options->notice != NULL) {
        voice_notice(&self->voice, options->notice);
    }
    self->course_mm = goal_mm > 0 ? (uint32_t)goal_mm : 0;
}

argusd_exit_t loop_run(loop_t *self, const loop_options_t *options) {
    begin(self, options);
    for (;;) {
        hear_end(self);
        const uint32_t wait_ms = driver_process(&self->driver);
        take_time(self);
        say_events(self);
        watch_link(self);
        watch_answer(self);
        watch_mission(self);
        take_signals(self);
        show(self);
        save(self, false);
        watch_tape(self);
        watch_injection(self);
        if (is_over(self)) {
            break;
        }
        const uint32_t told_ms =
            sooner(sooner(tell_bus(self), tell_service(self)), control_tell(&self->control, &self->moment));
        wait_for_work(self, voice_wait_ms(&self->voice, self->moment.now_ms, sooner(wait_ms, told_ms)));
        say_events(self);
    }
    say_events(self);
    const argus_status_t status = status_of(self);
    control_close(&self->control);
    bus_close(&self->bus, &status, self->moment.now_ms);
    guards_close(&self->guards, self->moment.now_ms);
    driver_close(&self->driver);
    tui_stop(&self->voice.tui);
    look(self);
    voice_summary(&self->voice, &self->view);
    save(self, true);
    close_tape(self);
    voice_end(&self->voice, &self->driver.clock);
    return self->code;
}
