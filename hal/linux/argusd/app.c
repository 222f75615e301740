// SPDX-License-Identifier: MIT
// argusd's start: arguments, files, the link; then the loop.
#include "app.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "argusd.h"
#include "attach.h"
#include "check.h"
#include "claim.h"
#include "course.h"
#include "hal/serial.h"
#include "loop.h"
#include "options.h"
#include "probe.h"
#include "report.h"
#include "ring_file.h"
#include "settings.h"
#include "signals.h"
#include "survey.h"
#include "text.h"

#define OPEN_TIMEOUT_MS 5000
#define OPEN_RETRY_MS 250
#define ANSWER_MS 30000u
#define CHECK_ANSWER_MS 10000u

// Static, not allocated: argusd never asks for memory.
static options_t options;
static settings_t settings;
static ring_file_t ring_file;
static argus_robot_storage_t robot_memory;
static course_t course;
static hal_transport_t transport;
static loop_t loop;
static precedence_t precedence;
static claim_t control_claim;
static claim_t state_claim;
static char message[ARGUSD_MESSAGE_MAX];

static argusd_exit_t complain(argusd_exit_t code) {
    fprintf(stderr, "argusd: %s\n", message);
    return code;
}

// What was printed has arrived, or the code and the reason are that it has not.
static argusd_exit_t flushed(argusd_exit_t code) {
    if (fflush(stdout) == 0 && ferror(stdout) == 0) {
        return code;
    }
    text_refuse(message, sizeof message, "standard output: %s", strerror(errno));
    return complain(ARGUSD_EXIT_INTERNAL);
}

static argusd_exit_t print_list(options_action_t action) {
    switch (action) {
    case OPTIONS_VERSION:
        printf("argusd %s\n", ARGUS_VERSION);
        break;
    case OPTIONS_LIST_EVENTS:
        report_list_events(stdout);
        break;
    case OPTIONS_LIST_CONFIG:
        settings_list(stdout);
        break;
    case OPTIONS_EXAMPLE_CONFIG:
        settings_example(stdout);
        break;
    default:
        options_help(stdout);
        break;
    }
    return flushed(ARGUSD_EXIT_OK);
}

// The rate of the wire: of the link, else of the config file, else the default. They must not contradict each
// other.
static bool settle_baud(void) {
    int32_t *const baud = &settings.config.baud;
    const int line = settings.line[SETTINGS_baud];
    if (!hal_link_spec_has_rate(&options.link)) {
        *baud = line != 0 ? *baud : options.link.scheme->as_baud;
        return true;
    }
    if (line != 0 && !hal_baud_is_known((uint32_t)*baud)) {
        return text_refuse(message, sizeof message,
                           "%s:%d: baud = %d: the rates of a serial link are " HAL_BAUD_LIST,
                           options.config_path, line, (int)*baud);
    }
    if (line != 0 && options.link.has_baud && options.link.baud != (uint32_t)*baud) {
        return text_refuse(message, sizeof message, "%s:%d: baud = %d, but --link says @%u; leave one out",
                           options.config_path, line, (int)*baud, (unsigned)options.link.baud);
    }
    if (line != 0) {
        options.link.baud = (uint32_t)*baud;
    }
    *baud = (int32_t)options.link.baud;
    return true;
}

// NULL, or why the manager starts passive although that was not asked for.
static const char *settle_activity(void) {
    static char why[ARGUSD_MESSAGE_MAX];
    int32_t *const active = &settings.config.active;
    if (options.passive || options.action == OPTIONS_CHECK) {
        *active = 0;
    } else if (options.active || options.action == OPTIONS_SURVEY) {
        *active = 1;
    } else if (!hal_link_spec_stays_here(&options.link)) {
        *active = 0;
        snprintf(why, sizeof why,
                 "passive, since a real robot may be %s: it reports and commands no motion; give --active to "
                 "let it drive",
                 options.link.scheme->robot_place);
        return why;
    }
    return NULL;
}

// The ring of --ring, handed to a manager with the settings at hand. True where none is given, too.
static bool give_ring(argus_t *core) {
    if (options.ring_path == NULL) {
        return true;
    }
    const argus_ring_report_t report = argus_set_ring(core, &robot_memory, &ring_file.ring);
    if (report.fault != ARGUS_RING_OK) {
        ring_file_explain(&ring_file, options.ring_path, report, message, sizeof message);
    }
    return report.fault == ARGUS_RING_OK;
}

static bool load_ring(void) {
    if (options.ring_path == NULL) {
        return true;
    }
    if (options.robot != NULL) {
        return text_refuse(message, sizeof message,
                           "--ring and --robot both say which body it has; keep one");
    }
    return ring_file_load(&ring_file, options.ring_path, message, sizeof message) &&
           give_ring(argus_init(&loop.driver.memory, &settings.config, 0));
}

static bool start_driver(hal_clock_t clock) {
    driver_init(&loop.driver, &settings.config, clock, &options.link, &transport);
    return give_ring(loop.driver.core);
}

static bool load_course(void) {
    if (options.course_path != NULL) {
        return course_load(&course, options.course_path, message, sizeof message);
    }
    if (options.has_goal) {
        const char *const note = course_near(options.goal, (argus_point_t){0, 0});
        if (note != NULL) {
            fprintf(stderr, "argusd: --goal %d,%d: %s\n", (int)options.goal.x_mm, (int)options.goal.y_mm,
                    note);
        }
        course.point[0] = options.goal;
        course.count = 1;
    }
    return true;
}

static bool load_files(void) {
    settings_default(&settings);
    if (options.config_path != NULL &&
        !settings_load(&settings, options.config_path, message, sizeof message)) {
        return false;
    }
    if (options.robot != NULL &&
        !settings_choose(&settings, SETTINGS_robot, options.robot, "--robot", message, sizeof message)) {
        return false;
    }
    if (!settle_baud()) {
        return false;
    }
    char problem[ARGUSD_MESSAGE_MAX / 2];
    const bool own = options.ring_path != NULL; // its body says later what is safe
    if (!(own ? settings_check_ranges : settings_check)(&settings, problem, sizeof problem)) {
        return text_refuse(message, sizeof message, "%s: %s",
                           options.config_path != NULL ? options.config_path : "config", problem);
    }
    return load_ring() && load_course();
}

static bool is_worth_waiting_for(hal_link_error_t error) {
    switch (error) {
    case HAL_LINK_NOT_FOUND:
    case HAL_LINK_GONE:
    case HAL_LINK_BUSY:
    case HAL_LINK_DOWN:
    case HAL_LINK_REFUSED:
    case HAL_LINK_UNREACHABLE:
    case HAL_LINK_TIMEOUT:
    case HAL_LINK_UNRESOLVED:
        return true;
    default:
        return false;
    }
}

static bool is_time_left(const hal_clock_t *clock, uint32_t start_ms) {
    if (!options.has_wait || signals_ends() > 0) {
        return false;
    }
    return options.wait_ms == OPTIONS_WAIT_FOREVER || hal_clock_now_ms(clock) - start_ms < options.wait_ms;
}

static void pause_for(int ms) {
    struct pollfd wait = {.fd = signals_fd(), .events = POLLIN};
    poll(&wait, 1, ms);
}

// What is waited for may not be there yet: what might be wrong is told when the wait is over.
static void explain_wait(hal_link_error_t error) {
    if (error == HAL_LINK_NOT_FOUND) {
        text_refuse(message, sizeof message, "%s: no such file yet", options.link.target);
    } else {
        hal_transport_explain(&options.link, error, message, sizeof message);
    }
}

static hal_link_error_t open_link(const hal_clock_t *clock, hal_link_t *link) {
    const uint32_t start_ms = hal_clock_now_ms(clock);
    hal_link_error_t told = HAL_LINK_OK;
    for (;;) {
        const hal_link_error_t error =
            hal_transport_open(&transport, &options.link, OPEN_TIMEOUT_MS, signals_fd(), link);
        if (!is_worth_waiting_for(error) || !is_time_left(clock, start_ms)) {
            return error;
        }
        if (error != told) {
            told = error;
            explain_wait(error);
            fprintf(stderr, "argusd: %s; waiting for it\n", message);
            notify_status(&loop.notify, message);
            message[0] = '\0';
        }
        notify_alive(&loop.notify, hal_clock_now_ms(clock));
        pause_for(OPEN_RETRY_MS);
    }
}

static argusd_exit_t find_baud(const hal_clock_t *clock, const hal_link_t *link) {
    const uint32_t start_ms = hal_clock_now_ms(clock);
    probe_t probe;
    do {
        notify_alive(&loop.notify, hal_clock_now_ms(clock));
        probe = probe_baud(&transport, link, clock, signals_fd());
    } while (probe.baud == 0 && probe.error == HAL_LINK_OK && !probe.cancelled &&
             is_time_left(clock, start_ms));
    if (probe.baud != 0) {
        fprintf(stderr, "argusd: auto-baud: a robot %s at %u bit/s\n",
                probe.reporting ? "is still reporting to an earlier client" : "answers",
                (unsigned)probe.baud);
        options.link.baud = probe.baud;
        settings.config.baud = (int32_t)probe.baud;
        return ARGUSD_EXIT_OK;
    }
    if (probe.error != HAL_LINK_OK) {
        hal_transport_explain(&options.link, probe.error, message, sizeof message);
        return ARGUSD_EXIT_LINK;
    }
    text_refuse(
        message, sizeof message, "%s: no robot answered at any of " HAL_BAUD_LIST "; %u bytes were heard; %s",
        options.link.target, (unsigned)probe.bytes,
        probe.bytes == 0 ? "is the robot on and connected?" : "the line is noisy or this is no robot");
    return ARGUSD_EXIT_NO_ROBOT;
}

static argusd_exit_t connect_robot(const hal_clock_t *clock, hal_link_t *link) {
    hal_transport_init(&transport);
    const hal_link_error_t error = open_link(clock, link);
    if (signals_ends() > 0) {
        text_refuse(message, sizeof message, "ended before the link was open");
        return ARGUSD_EXIT_OK;
    }
    if (error != HAL_LINK_OK) {
        hal_transport_explain(&options.link, error, message, sizeof message);
        return ARGUSD_EXIT_LINK;
    }
    const argusd_exit_t found = options.auto_baud ? find_baud(clock, link) : ARGUSD_EXIT_OK;
    if (found != ARGUSD_EXIT_OK) {
        hal_link_close(link);
    }
    return found;
}

static bool open_tape(void) {
    if (options.record_path == NULL) {
        return true;
    }
    return tape_open(&loop.tape, options.record_path, hal_link_spec_target(&options.link),
                     options.record_max_bytes, message, sizeof message);
}

// For when nothing was recorded yet, so nothing can be missing.
static void drop_tape(void) {
    char unused[ARGUSD_MESSAGE_MAX];
    tape_close(&loop.tape, unused, sizeof unused);
}

// Ends the picture; one of a survey that did not come about is not left behind.
static bool close_picture(FILE *picture, const char *path) {
    struct stat it;
    const bool is_empty = fflush(picture) == 0 && fstat(fileno(picture), &it) == 0 && it.st_size == 0;
    if (is_empty) {
        unlink(path);
    }
    const bool is_good = ferror(picture) == 0;
    return fclose(picture) == 0 && is_good;
}

// A picture that cannot be written is told before the robot turns.
static argusd_exit_t run_survey(uint32_t wait_ms) {
    survey_output_t output = {.table = stdout, .json = options.json};
    const char *const path = options.picture_path;
    if (path != NULL && (output.picture = fopen(path, "ae")) == NULL) {
        text_refuse(message, sizeof message, "--picture %s: %s", path, strerror(errno));
        return ARGUSD_EXIT_USAGE;
    }
    argusd_exit_t code = survey_run(&loop.driver, wait_ms, signals_fd(), &output, message, sizeof message);
    if (path != NULL && !close_picture(output.picture, path)) {
        text_refuse(message, sizeof message, "--picture %s: %s", path, strerror(errno));
        code = ARGUSD_EXIT_INTERNAL;
    }
    return code;
}

// --check and --survey.
static argusd_exit_t run_check(hal_link_t link, hal_clock_t clock) {
    const uint32_t wait_ms = options.has_wait ? options.wait_ms : CHECK_ANSWER_MS;
    const argusd_exit_t guarded = start_driver(clock) ? guards_open(&loop.guards, &options.guards,
                                                                    &loop.driver, message, sizeof message)
                                                      : ARGUSD_EXIT_USAGE;
    if (guarded != ARGUSD_EXIT_OK) {
        hal_link_close(&link);
        drop_tape();
        return complain(guarded);
    }
    loop.driver.after = guards_tap(&loop.guards);
    loop.driver.tap = tape_tap(&loop.tape);
    driver_attach(&loop.driver, link);
    message[0] = '\0';
    const argusd_exit_t code = options.action == OPTIONS_SURVEY
                                   ? run_survey(wait_ms)
                                   : check_run(&loop.driver, &precedence, wait_ms, signals_fd(), options.json,
                                               stdout, message, sizeof message);
    if (message[0] != '\0') {
        complain(code);
    }
    if (tape_close(&loop.tape, message, sizeof message)) {
        complain(code);
    }
    return flushed(code);
}

// Saves once at the start: a place that cannot be written is better known now than after the mission. Faults
// that are injected are no history of the sonars: then nothing is saved later.
static bool open_state(void) {
    if (!claim_take(&state_claim, "--state", options.state_path, message, sizeof message) ||
        !state_open(&loop.state, options.state_path, loop.driver.core, message, sizeof message)) {
        return false;
    }
    if (message[0] != '\0') {
        complain(ARGUSD_EXIT_OK);
    }
    const bool saved = state_save(&loop.state, loop.driver.core, message, sizeof message);
    if (saved && options.inject) {
        loop.state.on = false;
        snprintf(message, sizeof message, "--state %s: read, not written, for faults may be injected",
                 options.state_path);
        complain(ARGUSD_EXIT_OK);
    }
    return saved;
}

// No client is served before the loop runs, but a place that cannot be used is told before the robot is
// spoken to.
static bool open_control(void) {
    static control_token_t token;
    if (options.control.family == 0) {
        return true;
    }
    if (options.token_path != NULL &&
        !control_token_load(&token, options.token_path, message, sizeof message)) {
        return false;
    }
    if (options.control.family == AF_UNIX &&
        !claim_take(&control_claim, "--control", options.control.address.un.sun_path, message,
                    sizeof message)) {
        return false;
    }
    inject_init(&loop.inject, options.inject, (uint32_t)bus_seed());
    return control_open(&loop.control, &options.control, &token, message, sizeof message);
}

// With a link over CAN the telemetry is on the same bus, for the same robot, unless something else is wanted.
static bool open_bus(const hal_clock_t *clock) {
    const bool given = options.telemetry.interface[0] != '\0';
    const hal_can_spec_t *const spec = given ? &options.telemetry : hal_link_spec_bus(&options.link);
    if (options.no_telemetry || spec == NULL) {
        return true;
    }
    char problem[ARGUSD_MESSAGE_MAX / 2];
    if (!bus_open(&loop.bus, spec, &hal_can_sys, (uint32_t)settings.config.stale_ms, bus_seed(),
                  hal_clock_now_ms(clock), problem, sizeof problem)) {
        return text_refuse(message, sizeof message, "telemetry: %s", problem);
    }
    return true;
}

static voice_options_t voice_of_options(void) {
    return (voice_options_t){.json = options.json,
                             .plain = options.plain,
                             .status_ms = options.has_status ? options.status_ms
                                          : options.json     ? 500u
                                                             : 2000u};
}

// Before anything was recorded or a client served.
static argusd_exit_t give_up(hal_link_t *link, argusd_exit_t code) {
    hal_link_close(link);
    control_close(&loop.control);
    drop_tape();
    return complain(code);
}

// What the loop needs besides the link; `message` says what is wrong.
static argusd_exit_t prepare_loop(const hal_clock_t *clock) {
    if (options.state_path != NULL && !open_state()) {
        return ARGUSD_EXIT_USAGE;
    }
    if (course.count > 0 && !argus_set_course(loop.driver.core, course.point, course.count)) {
        text_refuse(message, sizeof message, "the course does not fit the fault manager");
        return ARGUSD_EXIT_INTERNAL;
    }
    if (!open_bus(clock)) {
        return ARGUSD_EXIT_LINK;
    }
    return guards_open(&loop.guards, &options.guards, &loop.driver, message, sizeof message);
}

static argusd_exit_t run_loop(hal_link_t link, hal_clock_t clock, const char *notice) {
    const loop_options_t wishes = {
        .voice = voice_of_options(),
        .config = &settings.config,
        .answer_ms = options.has_wait ? options.wait_ms : ANSWER_MS,
        .notice = notice,
    };
    const argusd_exit_t prepared = start_driver(clock) ? prepare_loop(&clock) : ARGUSD_EXIT_USAGE;
    if (prepared != ARGUSD_EXIT_OK) {
        return give_up(&link, prepared);
    }
    loop.driver.after = guards_tap(&loop.guards);
    loop.driver.tap = tape_tap(&loop.tape);
    loop.driver.filter = inject_filter(&loop.inject);
    driver_attach(&loop.driver, link);
    return loop_run(&loop, &wishes);
}

static argusd_exit_t run_attached(const hal_clock_t *clock) {
    static attach_t attach;
    const voice_options_t voice = voice_of_options();
    control_token_t token = {.on = false};
    if (options.token_path != NULL &&
        !control_token_load(&token, options.token_path, message, sizeof message)) {
        return complain(ARGUSD_EXIT_USAGE);
    }
    if (!signals_open()) {
        text_refuse(message, sizeof message, "no pipe or signal handler could be had from the system");
        return complain(ARGUSD_EXIT_INTERNAL);
    }
    if (!attach_open(&attach, &options.attach, &token, clock, message, sizeof message)) {
        return complain(ARGUSD_EXIT_LINK);
    }
    return attach_run(&attach, &voice);
}

// An argusd that waits for a robot is up as well: it says what it waits for.
static void tell_service(const hal_clock_t *clock) {
    if (!notify_open(&loop.notify, message, sizeof message)) {
        complain(ARGUSD_EXIT_OK);
    }
    notify_ready(&loop.notify, hal_clock_now_ms(clock), "opening the link");
}

static bool take_precedence(void) {
    if (!precedence_take(&options.precedence, &precedence, message, sizeof message)) {
        return false;
    }
    if (message[0] != '\0') {
        complain(ARGUSD_EXIT_OK);
    }
    return true;
}

static argusd_exit_t run_robot(hal_clock_t clock) {
    hal_link_t link = {0};
    if (!load_files() || !take_precedence()) {
        return complain(ARGUSD_EXIT_USAGE);
    }
    const char *const notice = settle_activity();
    if (!signals_open()) {
        text_refuse(message, sizeof message, "no pipe or signal handler could be had from the system");
        return complain(ARGUSD_EXIT_INTERNAL);
    }
    if (!open_control() || !open_tape()) {
        control_close(&loop.control);
        return complain(ARGUSD_EXIT_USAGE);
    }
    if (options.action == OPTIONS_RUN) {
        tell_service(&clock);
    }
    message[0] = '\0';
    const argusd_exit_t connected = connect_robot(&clock, &link);
    if (connected != ARGUSD_EXIT_OK || message[0] != '\0') {
        control_close(&loop.control);
        drop_tape();
        return complain(connected);
    }
    return options.action == OPTIONS_RUN ? run_loop(link, clock, notice) : run_check(link, clock);
}

static argusd_exit_t run(int argc, char **argv) {
    const hal_clock_t clock = hal_clock_monotonic();
    if (!options_parse(&options, argc, argv, message, sizeof message)) {
        return complain(ARGUSD_EXIT_USAGE);
    }
    switch (options.action) {
    case OPTIONS_RUN:
    case OPTIONS_CHECK:
    case OPTIONS_SURVEY:
        return run_robot(clock);
    case OPTIONS_ATTACH:
        return run_attached(&clock);
    default:
        return print_list(options.action);
    }
}

int app_main(int argc, char **argv) {
    const argusd_exit_t code = run(argc, argv);
    claim_release(&control_claim);
    claim_release(&state_claim);
    return (int)code;
}
