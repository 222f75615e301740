// SPDX-License-Identifier: MIT
// Writes events and status.
#include "report.h"

#include <stdlib.h>
#include <string.h>

#include "json.h"

#define ARRAY_SONARS 8
#define LISTED_LEAST 16 // a reader of a fixed width goes on

static const char *const array_names[] = {"front", "rear", "upper_front", "upper_rear"};
static const char *const array_titles[] = {"front", "rear", "upper front", "upper rear"};

static const char *const level_names[] = {"OK", "WARN", "ERROR", "STALE"};

static const char *meaning_of(uint16_t id) {
    switch (id) {
#define MEANING(number, name, level, subject, meaning) \
    case number:                                       \
        return meaning;
        ARGUS_EVENT_TABLE(MEANING)
#undef MEANING
    default:
        return "";
    }
}

static const char *level_name(argus_level_t level) {
    return (size_t)level < sizeof level_names / sizeof level_names[0] ? level_names[level] : "?";
}

void report_name(const argus_event_t *event, char *text, size_t capacity) {
    if (event->sonar >= 0 && event->sonar < ARGUS_SONARS) {
        snprintf(text, capacity, "sonar/%s/%02d", array_names[event->sonar / ARRAY_SONARS], event->sonar);
    } else {
        snprintf(text, capacity, "%s", argus_name(ARGUS_NAME_SUBJECT, event->id));
    }
}

static void put_int(json_t *json, const char *name, int64_t value) {
    json_name(json, name);
    json_int(json, value);
}

static void put_string(json_t *json, const char *name, const char *value) {
    json_name(json, name);
    json_string(json, value);
}

static void put_bool(json_t *json, const char *name, bool value) {
    json_name(json, name);
    json_bool(json, value);
}

// The seven keys that every line has.
static void put_event(json_t *json, const argus_event_t *event, uint64_t t_ms) {
    char name[32];
    report_name(event, name, sizeof name);
    json_name(json, "t");
    json_thousandths(json, (int64_t)t_ms);
    put_string(json, "event", argus_name(ARGUS_NAME_EVENT, event->id));
    put_int(json, "id", event->id);
    put_int(json, "level", argus_event_level(event->id));
    put_string(json, "name", name);
    put_int(json, "value", event->value);
    put_string(json, "state", argus_name(ARGUS_NAME_FAILURE, (int)event->state));
}

static size_t finish(json_t *json) {
    json_close(json, '}');
    return json_fits(json) ? json->text.length : 0;
}

size_t report_event_json(const argus_event_t *event, uint64_t t_ms, char *line, size_t capacity) {
    json_t json = json_in(line, capacity);
    json_open(&json, '{');
    put_event(&json, event, t_ms);
    return finish(&json);
}

static const char *colour_of(argus_level_t level) {
    return level == ARGUS_LEVEL_ERROR ? "\033[31m" : level == ARGUS_LEVEL_WARN ? "\033[33m" : "";
}

// Units as the catalogue words them, the longer ones first; `hil_sim/faults/values.py` has the same.
typedef struct {
    const char *words;
    int parts; // of the unit shown that are one of the catalogue's
    const char *shown;
} unit_t;

static bool has_word(const char *text, const char *word) {
    const size_t length = strlen(word);
    for (const char *at = strstr(text, word); at != NULL; at = strstr(at + 1, word)) {
        const bool begins = at == text || at[-1] == ' ';
        if (begins && (at[length] == '\0' || at[length] == ' ' || at[length] == ',')) {
            return true;
        }
    }
    return false;
}

static void add_amount(text_t *text, const char *words, int32_t value) {
    static const unit_t units[] = {{"hundredths of a degree", 100, "deg"},
                                   {"decivolts", 10, "V"},
                                   {"degrees", 1, "deg"},
                                   {"seconds", 1, "s"},
                                   {"mm/s", 1, "mm/s"},
                                   {"mm", 1, "mm"},
                                   {"ms", 1, "ms"}};
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (!has_word(words, units[i].words)) {
            continue;
        }
        const int parts = units[i].parts;
        if (value == INT32_MAX) {
            text_add(text, " (never)"); // a time since what has not been
        } else if (parts == 1) {
            text_add(text, " %d %s", (int)value, units[i].shown);
        } else {
            text_add(text, " %s%d.%0*d %s", value < 0 ? "-" : "", abs(value / parts), parts == 100 ? 2 : 1,
                     abs(value % parts), units[i].shown);
        }
        return;
    }
    text_add(text, " %d", (int)value);
}

// "value" in words where a number alone says nothing, and only where the catalogue gives it a meaning.
static void add_value(text_t *text, const argus_event_t *event) {
    const char *const words = strstr(meaning_of(event->id), "value: ");
    if (event->id == ARGUS_EV_INJECTED && event->value == ARGUS_KIND_NONE) {
        text_add(text, " (over)");
    } else if (event->id == ARGUS_EV_OPERATOR) {
        text_add(text, " %s", argus_name(ARGUS_NAME_OP, (int)event->value));
    } else if (words != NULL && strstr(words, "fault kind") != NULL) {
        text_add(text, " (%s)", argus_name(ARGUS_NAME_KIND, (int)event->value));
    } else if (words != NULL) {
        add_amount(text, words + strlen("value: "), event->value);
    }
}

size_t report_event_plain(const argus_event_t *event, uint64_t t_ms, bool colour, char *line,
                          size_t capacity) {
    char name[32];
    const argus_level_t level = argus_event_level(event->id);
    const char *const meaning = meaning_of(event->id);
    const char *const end = strstr(meaning, "; value:");
    const char *const tint = colour ? colour_of(level) : "";
    text_t text = text_in(line, capacity);
    report_name(event, name, sizeof name);
    text_add(&text, "%5u.%03u %s%-5s%s %-14s %s", (unsigned)(t_ms / 1000u), (unsigned)(t_ms % 1000u), tint,
             level_name(level), tint[0] != '\0' ? "\033[0m" : "", name,
             argus_name(ARGUS_NAME_EVENT, event->id));
    add_value(&text, event);
    text_add(&text, ": %.*s", end == NULL ? (int)strlen(meaning) : (int)(end - meaning), meaning);
    return text.cut ? 0 : text.length;
}

int report_sonars(const argus_status_t *status) {
    const int sonars = status->sonars < LISTED_LEAST ? LISTED_LEAST : status->sonars;
    return sonars < ARGUS_SONARS ? sonars : ARGUS_SONARS;
}

void report_readings(json_t *json, const char *name, const argus_status_t *status) {
    json_name(json, name);
    json_open(json, '[');
    for (int i = 0; i < report_sonars(status); i++) {
        json_int(json, status->reading_mm[i]);
    }
    json_close(json, ']');
    json_name(json, "age_ms"); // -1: never reported
    json_open(json, '[');
    for (int i = 0; i < report_sonars(status); i++) {
        json_int(json, status->age_ms[i] == UINT32_MAX ? -1 : (int64_t)status->age_ms[i]);
    }
    json_close(json, ']');
}

static void put_sonars(json_t *json, const argus_status_t *status) {
    report_readings(json, "reading_mm", status);
    json_name(json, "health");
    json_open(json, '[');
    for (int i = 0; i < report_sonars(status); i++) {
        json_string(json, argus_name(ARGUS_NAME_HEALTH, (int)status->health[i]));
    }
    json_close(json, ']');
    json_name(json, "kind");
    json_open(json, '[');
    for (int i = 0; i < report_sonars(status); i++) {
        json_string(json, argus_name(ARGUS_NAME_KIND, (int)status->kind[i]));
    }
    json_close(json, ']');
}

static void put_plan(json_t *json, const argus_plan_t *plan) {
    json_name(json, "plan_deg");
    json_open(json, '[');
    for (int i = 0; i < plan->count && i < ARGUS_ROTATIONS_MAX; i++) {
        json_int(json, plan->rotation_deg[i]);
    }
    json_close(json, ']');
    put_bool(json, "plan_complete", plan->complete);
}

static void put_robot(json_t *json, const view_t *view) {
    const argus_status_t *const status = &view->status;
    put_string(json, "mode", argus_name(ARGUS_NAME_MODE, (int)status->mode));
    put_string(json, "mission", argus_name(ARGUS_NAME_MISSION, (int)status->mission));
    put_string(json, "barred", argus_name(ARGUS_NAME_BAR, (int)status->bar));
    put_bool(json, "active", status->active);
    put_bool(json, "paused", status->paused);
    put_bool(json, "online", status->online);
    put_bool(json, "reversed", status->reversed);
    put_int(json, "x_mm", status->pose.x_mm);
    put_int(json, "y_mm", status->pose.y_mm);
    put_int(json, "heading_cdeg", status->pose.heading_cdeg);
    put_int(json, "goal_mm", status->goal_mm);
    put_int(json, "course_mm", view->course_mm);
    put_int(json, "waypoint", status->waypoint);
    put_int(json, "waypoints", status->waypoints);
    put_int(json, "battery_dv", status->battery_dv);
    put_int(json, "vel_left_mm_s", status->vel_left_mm_s);
    put_int(json, "vel_right_mm_s", status->vel_right_mm_s);
    put_int(json, "flags", status->flags);
    put_int(json, "bumpers_front", status->bumpers_front);
    put_int(json, "bumpers_rear", status->bumpers_rear);
}

static void put_link(json_t *json, const view_t *view) {
    put_int(json, "sips", view->status.sips);
    put_int(json, "bad_checksums", view->status.bad_checksums);
    put_int(json, "skipped_bytes", view->status.skipped_bytes);
    put_int(json, "stops", view->status.stops);
    put_int(json, "bytes_in", view->counters.bytes_in);
    put_int(json, "bytes_out", view->counters.bytes_out);
    put_int(json, "would_block", view->counters.would_block);
    put_int(json, "reopened", view->reopened);
    put_string(json, "link", view->link);
    put_bool(json, "link_up", view->link_up);
    put_string(json, "robot", view->name);
    put_string(json, "subclass", view->subclass);
}

static void put_ring(json_t *json, const argus_status_t *status) {
    put_int(json, "sonars", status->sonars);
    json_name(json, "bearing_deg");
    json_open(json, '[');
    for (int i = 0; i < report_sonars(status); i++) {
        json_int(json, status->bearing_deg[i]);
    }
    json_close(json, ']');
    json_name(json, "pinned");
    json_open(json, '[');
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if ((status->pinned >> i & 1u) != 0) {
            json_int(json, i);
        }
    }
    json_close(json, ']');
    put_bool(json, "motors", status->motors);
}

static void put_control(json_t *json, const view_t *view) {
    put_bool(json, "controlled", view->controlled);
    json_name(json, "injected");
    json_open(json, '[');
    for (int i = 0; i < report_sonars(&view->status); i++) {
        json_string(json, argus_name(ARGUS_NAME_KIND, view->injected[i]));
    }
    json_close(json, ']');
    put_bool(json, "inject", view->inject);
}

static void put_can(json_t *json, const view_t *view) {
    if (!view->has_can) {
        return;
    }
    json_name(json, "can");
    json_open(json, '{');
    for (int i = 0; i < HAL_ISOTP_ERRORS; i++) {
        put_int(json, hal_isotp_error_name((hal_isotp_error_t)i), view->can_errors[i]);
    }
    put_int(json, "sent", view->can_sent);
    put_int(json, "taken", view->can_taken);
    put_int(json, "refused", view->can_refused);
    json_close(json, '}');
}

size_t report_status_json(const view_t *view, int64_t unix_ms, char *line, size_t capacity) {
    const argus_event_t event = {.id = ARGUS_EV_STATUS,
                                 .sonar = ARGUS_NO_SONAR,
                                 .state = (uint8_t)view->status.failure,
                                 .value = (int32_t)view->status.sips};
    json_t json = json_in(line, capacity);
    json_open(&json, '{');
    put_event(&json, &event, view->t_ms);
    json_name(&json, "unix");
    json_thousandths(&json, unix_ms);
    put_robot(&json, view);
    put_plan(&json, &view->status.plan);
    put_sonars(&json, &view->status);
    put_link(&json, view);
    put_ring(&json, &view->status);
    put_control(&json, view);
    put_can(&json, view);
    return finish(&json);
}

// "injected: 3 stuck" where a reader must not take it for the robot's own.
static void add_injected(text_t *text, const view_t *view) {
    int count = 0;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (view->injected[i] != 0) {
            text_add(text, "%s %d %s", count == 0 ? " INJECTED:" : ",", i,
                     argus_name(ARGUS_NAME_KIND, view->injected[i]));
            count++;
        }
    }
}

static void add_readings(text_t *text, const char *title, const argus_status_t *status, int first) {
    text_add(text, " %s", title);
    for (int i = first; i < first + ARRAY_SONARS; i++) {
        const char *mark = "";
        if (status->health[i] == ARGUS_DISABLED) {
            mark = "!";
        } else if (status->health[i] == ARGUS_SUSPECT) {
            mark = "?";
        }
        if (status->age_ms[i] == UINT32_MAX) {
            text_add(text, " -");
        } else {
            text_add(text, " %d%s", status->reading_mm[i], mark);
        }
    }
}

size_t report_status_plain(const view_t *view, char *line, size_t capacity) {
    const argus_status_t *const status = &view->status;
    text_t text = text_in(line, capacity);
    text_add(&text, "%5u.%03u STATUS %s %s", (unsigned)(view->t_ms / 1000u), (unsigned)(view->t_ms % 1000u),
             argus_name(ARGUS_NAME_MODE, (int)status->mode),
             argus_name(ARGUS_NAME_FAILURE, (int)status->failure));
    if (!status->online) {
        text_add(&text, " no robot");
        return text.length;
    }
    text_add(&text, " %s%s%s at %d,%d mm %d deg", status->active ? "active" : "passive",
             status->paused ? ", paused," : "", status->reversed ? ", rear ahead," : "",
             (int)status->pose.x_mm, (int)status->pose.y_mm, (int)(status->pose.heading_cdeg / 100));
    if (status->waypoints > 0) {
        text_add(&text, " goal %d mm", (int)status->goal_mm);
    }
    text_add(&text, " %d.%d V", status->battery_dv / 10, status->battery_dv % 10);
    for (int first = 0; first < report_sonars(status); first += ARRAY_SONARS) {
        add_readings(&text, array_titles[first / ARRAY_SONARS], status, first);
    }
    add_injected(&text, view);
    return text.cut ? 0 : text.length;
}

static void add_out_of_use(text_t *text, const argus_status_t *status) {
    int count = 0;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (status->health[i] == ARGUS_DISABLED || status->health[i] == ARGUS_PROBATION) {
            text_add(text, "%s %d (%s)", count == 0 ? "out of use: sonar" : ",", i,
                     argus_name(ARGUS_NAME_KIND, (int)status->kind[i]));
            count++;
        }
    }
    if (count == 0) {
        text_add(text, "no sonar out of use");
    }
}

size_t report_summary(const view_t *view, char *line, size_t capacity) {
    const argus_status_t *const status = &view->status;
    text_t text = text_in(line, capacity);
    text_add(&text, "%5u.%03u SUMMARY mission %s", (unsigned)(view->t_ms / 1000u),
             (unsigned)(view->t_ms % 1000u), argus_name(ARGUS_NAME_MISSION, (int)status->mission));
    if (status->waypoints > 0) {
        text_add(&text, ", %d mm from the goal", (int)status->goal_mm);
    }
    text_add(&text, "; %s; ", argus_name(ARGUS_NAME_FAILURE, (int)status->failure));
    add_out_of_use(&text, status);
    text_add(&text, "; %u stops; %u SIPs, %u bad checksums, link opened again %u times",
             (unsigned)status->stops, (unsigned)status->sips, (unsigned)status->bad_checksums,
             (unsigned)view->reopened);
    return text.cut ? 0 : text.length;
}

void report_list_events(FILE *out) {
    fprintf(out, "%-3s %-18s %-6s %-9s %s\n", "ID", "EVENT", "LEVEL", "ABOUT", "MEANING");
#define EVENT_LINE(id, name, level, subject, meaning) \
    fprintf(out, "%-3d %-18s %-6s %-9s %s\n", id, #name, #level, #subject, meaning);
    ARGUS_EVENT_TABLE(EVENT_LINE)
#undef EVENT_LINE
}
