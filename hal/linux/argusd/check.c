// SPDX-License-Identifier: MIT
// Looks at a robot without moving it.
#include "check.h"

#include <poll.h>
#include <string.h>

#include "json.h"

#define LOOK_MS 3000u // long enough for every transducer to fire several times
#define LEAVE_MS 4000u

static bool hears_other_frames(const driver_t *driver) {
    const hal_isotp_t *const link = driver->transport == NULL ? NULL : hal_transport_isotp(driver->transport);
    return link != NULL && link->errors[HAL_ISOTP_FORMAT] > 0;
}

static void explain_silence(const driver_t *driver, uint32_t waited_ms, char *text, size_t capacity) {
    argus_status_t status;
    argus_status(driver->core, &status);
    const hal_scheme_t *const scheme = driver->spec.scheme;
    text_t line = text_in(text, capacity);
    text_add(&line, "%s: no robot answered in %u s: ", hal_link_describe(&driver->link),
             (unsigned)(waited_ms / 1000u));
    if (driver_meets_telnet(driver)) {
        text_add(&line, DRIVER_TELNET);
    } else if (hears_other_frames(driver)) {
        text_add(&line, HAL_ISOTP_FORMAT_TEXT);
    } else if (driver->bytes_in == 0) {
        text_add(&line, "nothing was received; is the robot on and connected?%s", scheme->if_silent);
    } else if (status.packets == 0) {
        text_add(&line, "%u bytes of garbage were received, no packet among them; %s",
                 (unsigned)driver->bytes_in, scheme->if_garbage);
    } else {
        text_add(&line,
                 "%u packets and %u bad checksums were received, but no session opened; another client may "
                 "hold the "
                 "robot, or the line is noisy or looped back",
                 (unsigned)status.packets, (unsigned)status.bad_checksums);
    }
}

argusd_exit_t check_explain_silence(const driver_t *driver, uint32_t waited_ms, char *text, size_t capacity) {
    if (driver_is_turned_away(driver)) {
        driver_explain_turned_away(driver, text, capacity);
        return ARGUSD_EXIT_NO_ROBOT;
    }
    if (!driver->up) {
        hal_transport_explain(&driver->spec, driver->error, text, capacity);
        return ARGUSD_EXIT_LINK;
    }
    explain_silence(driver, waited_ms, text, capacity);
    return ARGUSD_EXIT_NO_ROBOT;
}

bool check_turn(driver_t *driver, int cancel_fd, uint32_t most_ms) {
    argus_event_t event;
    uint32_t wait_ms = driver_process(driver);
    wait_ms = wait_ms < most_ms ? wait_ms : most_ms;
    struct pollfd wait[2] = {{.fd = hal_link_fd(&driver->link), .events = POLLIN},
                             {.fd = cancel_fd, .events = POLLIN}};
    if (driver_wants_write(driver)) {
        wait[0].events |= POLLOUT;
    }
    poll(wait, 2, (int)wait_ms);
    driver_receive(driver);
    while (argus_next_event(driver->core, &event)) {
    }
    return wait[1].revents == 0;
}

static int sonars_seen(const argus_status_t *status) {
    int seen = 0;
    for (int i = 0; i < status->sonars; i++) {
        seen += status->age_ms[i] != UINT32_MAX;
    }
    return seen;
}

static void put_seen(FILE *out, const argus_status_t *status, bool wanted) {
    int count = 0;
    for (int i = 0; i < status->sonars; i++) {
        if ((status->age_ms[i] != UINT32_MAX) == wanted) {
            fprintf(out, " %d", i);
            count++;
        }
    }
    fprintf(out, count == 0 ? " none\n" : "\n");
}

static void tell_plain(const driver_t *driver, const argus_status_t *status, const precedence_t *granted,
                       FILE *out) {
    char precedence[128];
    fprintf(out, "port      %s\n", hal_link_describe(&driver->link));
    if (driver_meets_telnet(driver)) {
        fprintf(out, "telnet    " DRIVER_TELNET "\n");
    }
    if (driver->spec.baud != 0) {
        fprintf(out, "rate      %u bit/s\n", (unsigned)driver->spec.baud);
    }
    fprintf(out, "robot     name '%s', class '%s', subclass '%s'%s\n", status->robot_name,
            status->robot_class, status->robot_subclass,
            status->robot_body[0] != '\0' ? "" : " (its body is not known: name it with --robot)");
    if (status->has_configpac) {
        fprintf(out, "firmware  version '%s', serial number '%s', watchdog %u ms, sonar cycle %u ms\n",
                status->robot_version, status->robot_serial, (unsigned)status->robot_watchdog_ms,
                (unsigned)status->robot_sonar_cycle_ms);
    }
    fprintf(out, "battery   %d.%d V\n", status->battery_dv / 10, status->battery_dv % 10);
    fprintf(out, "sonars    %d of %d seen:", sonars_seen(status), status->sonars);
    put_seen(out, status, true);
    fprintf(out, "silent   ");
    put_seen(out, status, false);
    fprintf(out, "readings ");
    for (int i = 0; i < status->sonars; i++) {
        fprintf(out, " %d", status->reading_mm[i]);
    }
    precedence_describe(granted, precedence, sizeof precedence);
    fprintf(out, " mm\nrealtime  %s\ntraffic   %u SIPs, %u bad checksums, %u stray bytes\n", precedence,
            (unsigned)status->sips, (unsigned)status->bad_checksums, (unsigned)status->skipped_bytes);
    fprintf(out, "not shown while it stands: whether a sonar that reads is right (stuck, wrong, aside); "
                 "--survey turns the\n          robot on the spot for that\n");
}

static void put_precedence(json_t *json, const precedence_t *granted) {
    json_name(json, "realtime");
    json_open(json, '{');
    json_name(json, "asked");
    json_bool(json, granted->asked);
    json_name(json, "priority"); // 0: not granted
    json_int(json, granted->priority);
    json_name(json, "locked");
    json_bool(json, granted->locked);
    json_name(json, "cpus");
    json_open(json, '[');
    for (int cpu = 0; cpu < PRECEDENCE_CPUS; cpu++) {
        if ((granted->cpus >> cpu & 1u) != 0) {
            json_int(json, cpu);
        }
    }
    json_close(json, ']');
    json_close(json, '}');
}

static void tell_json(const driver_t *driver, const argus_status_t *status, const precedence_t *granted,
                      FILE *out) {
    char line[2048];
    json_t json = json_in(line, sizeof line);
    json_open(&json, '{');
    json_name(&json, "port");
    json_string(&json, hal_link_describe(&driver->link));
    json_name(&json, "baud"); // 0: no rate, as over TCP
    json_int(&json, (int64_t)driver->spec.baud);
    json_name(&json, "name");
    json_string(&json, status->robot_name);
    json_name(&json, "class");
    json_string(&json, status->robot_class);
    json_name(&json, "subclass");
    json_string(&json, status->robot_subclass);
    json_name(&json, "version");
    json_string(&json, status->robot_version);
    json_name(&json, "battery_dv");
    json_int(&json, status->battery_dv);
    json_name(&json, "sonars");
    json_open(&json, '[');
    for (int i = 0; i < status->sonars; i++) {
        if (status->age_ms[i] != UINT32_MAX) {
            json_int(&json, i);
        }
    }
    json_close(&json, ']');
    json_name(&json, "sips");
    json_int(&json, status->sips);
    json_name(&json, "bad_checksums");
    json_int(&json, status->bad_checksums);
    json_name(&json, "skipped_bytes");
    json_int(&json, status->skipped_bytes);
    put_precedence(&json, granted);
    json_close(&json, '}');
    fprintf(out, "%s\n", line);
}

void check_leave(driver_t *driver) {
    const uint32_t start_ms = hal_clock_now_ms(&driver->clock);
    argus_shutdown(driver->core, start_ms);
    while (driver->up && hal_clock_now_ms(&driver->clock) - start_ms < LEAVE_MS) {
        if (argus_closed(driver->core) && driver->held == 0) {
            break;
        }
        check_turn(driver, -1, 100);
    }
    driver_close(driver);
}

argusd_exit_t check_run(driver_t *driver, const precedence_t *granted, uint32_t wait_ms, int cancel_fd,
                        bool json, FILE *out, char *message, size_t capacity) {
    const uint32_t start_ms = hal_clock_now_ms(&driver->clock);
    argus_status_t status;
    argusd_exit_t code = ARGUSD_EXIT_OK;
    uint32_t met_ms = 0;
    bool met = false;
    bool going_on = true;
    while (going_on) {
        going_on = check_turn(driver, cancel_fd, 100);
        const uint32_t now_ms = hal_clock_now_ms(&driver->clock);
        argus_status(driver->core, &status);
        if (!met && status.open) {
            met = true;
            met_ms = now_ms;
        }
        going_on = going_on && (met ? now_ms - met_ms < LOOK_MS : now_ms - start_ms < wait_ms);
    }
    if (met) {
        json ? tell_json(driver, &status, granted, out) : tell_plain(driver, &status, granted, out);
    } else {
        code = check_explain_silence(driver, hal_clock_now_ms(&driver->clock) - start_ms, message, capacity);
    }
    check_leave(driver);
    return code;
}
