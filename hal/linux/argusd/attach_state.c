// SPDX-License-Identifier: MIT
// Reads state and event lines back.
#include "attach_state.h"

#include <string.h>

#include "text.h"

#define NAMES_MAX 32
#define WORD_MAX 96

static int64_t whole(const json_doc_t *doc, const char *name, int64_t otherwise) {
    int64_t value = 0;
    return json_whole(doc, json_member(doc, 0, name), INT32_MIN, UINT32_MAX, &value) ? value : otherwise;
}

static bool flag(const json_doc_t *doc, const char *name) {
    return json_is(doc, json_member(doc, 0, name), JSON_TRUE);
}

static void word(const json_doc_t *doc, const char *name, char *text, size_t capacity) {
    if (!json_text(doc, json_member(doc, 0, name), text, capacity)) {
        text[0] = '\0';
    }
}

static bool is_digit(char character) {
    return character >= '0' && character <= '9';
}

// "12.345" is 12345; 0 when it is no number with three places, as all times are.
static uint64_t thousandths(const json_doc_t *doc, const char *name) {
    const int token = json_member(doc, 0, name);
    uint64_t value = 0;
    if (!json_is(doc, token, JSON_NUMBER)) {
        return 0;
    }
    const char *const text = doc->text + doc->token[token].at;
    const int length = doc->token[token].length;
    if (length < 5 || length > 18 || text[length - 4] != '.') {
        return 0;
    }
    for (int i = 0; i < length; i++) {
        value = is_digit(text[i]) ? value * 10 + (uint64_t)(text[i] - '0') : value;
    }
    return value;
}

static int number_of(argus_name_of_t of, const char *name) {
    for (int i = 0; i < NAMES_MAX; i++) {
        if (strcmp(argus_name(of, i), name) == 0) {
            return i;
        }
    }
    return 0;
}

static int number_at(const json_doc_t *doc, int token, argus_name_of_t of) {
    char text[WORD_MAX];
    return json_text(doc, token, text, sizeof text) ? number_of(of, text) : 0;
}

static int named(const json_doc_t *doc, const char *name, argus_name_of_t of) {
    return number_at(doc, json_member(doc, 0, name), of);
}

// Each element of a list of one value a sonar; `take` is called for each with its sonar.
typedef void (*take_t)(const json_doc_t *doc, int token, int sonar, view_t *view);

static void each(const json_doc_t *doc, const char *name, view_t *view, take_t take) {
    const int list = json_member(doc, 0, name);
    int sonar = 0;
    for (int at = json_first(doc, list); at >= 0 && sonar < ARGUS_SONARS; at = json_next(doc, list, at)) {
        take(doc, at, sonar++, view);
    }
}

static int32_t value_at(const json_doc_t *doc, int token) {
    int64_t value = 0;
    return json_whole(doc, token, INT32_MIN, INT32_MAX, &value) ? (int32_t)value : 0;
}

static void take_reading(const json_doc_t *doc, int token, int sonar, view_t *view) {
    view->status.reading_mm[sonar] = (uint16_t)value_at(doc, token);
}

static void take_age(const json_doc_t *doc, int token, int sonar, view_t *view) {
    const int32_t age_ms = value_at(doc, token);
    view->status.age_ms[sonar] = age_ms < 0 ? UINT32_MAX : (uint32_t)age_ms;
}

static void take_bearing(const json_doc_t *doc, int token, int sonar, view_t *view) {
    view->status.bearing_deg[sonar] = (int16_t)value_at(doc, token);
}

static void take_health(const json_doc_t *doc, int token, int sonar, view_t *view) {
    view->status.health[sonar] = (uint8_t)number_at(doc, token, ARGUS_NAME_HEALTH);
}

static void take_kind(const json_doc_t *doc, int token, int sonar, view_t *view) {
    view->status.kind[sonar] = (uint8_t)number_at(doc, token, ARGUS_NAME_KIND);
}

static void take_injected(const json_doc_t *doc, int token, int sonar, view_t *view) {
    view->injected[sonar] = (uint8_t)number_at(doc, token, ARGUS_NAME_KIND);
}

static void take_pinned(const json_doc_t *doc, int token, int sonar, view_t *view) {
    (void)sonar;
    int64_t pinned = 0;
    if (json_whole(doc, token, 0, ARGUS_SONARS - 1, &pinned)) {
        view->status.pinned = (argus_mask_t)(view->status.pinned | 1u << pinned);
    }
}

static void take_rotation(const json_doc_t *doc, int token, int sonar, view_t *view) {
    argus_plan_t *const plan = &view->status.plan;
    if (sonar < ARGUS_ROTATIONS_MAX) {
        plan->rotation_deg[plan->count++] = (int16_t)value_at(doc, token);
    }
}

// The plan is for those that face forward and are out; that there is one is all that the screen asks.
static void read_plan(const json_doc_t *doc, view_t *view) {
    memset(&view->status.plan, 0, sizeof view->status.plan);
    each(doc, "plan_deg", view, take_rotation);
    view->status.plan.complete = flag(doc, "plan_complete");
    view->status.plan.disabled = view->status.plan.count > 0 || view->status.failure != ARGUS_IS_NORMAL;
}

static void read_sonars(const json_doc_t *doc, view_t *view) {
    view->status.pinned = 0;
    view->status.sonars = (uint8_t)whole(doc, "sonars", ARGUS_SONARS);
    if (view->status.sonars > ARGUS_SONARS) {
        view->status.sonars = ARGUS_SONARS;
    }
    for (int i = 0; i < ARGUS_SONARS; i++) { // those that are not listed
        view->status.health[i] = ARGUS_ABSENT;
        view->status.age_ms[i] = UINT32_MAX;
    }
    each(doc, "reading_mm", view, take_reading);
    each(doc, "age_ms", view, take_age);
    each(doc, "bearing_deg", view, take_bearing);
    each(doc, "health", view, take_health);
    each(doc, "kind", view, take_kind);
    each(doc, "injected", view, take_injected);
    each(doc, "pinned", view, take_pinned);
}

static void read_robot(const json_doc_t *doc, argus_status_t *status) {
    status->mode = (uint8_t)named(doc, "mode", ARGUS_NAME_MODE);
    status->mission = (uint8_t)named(doc, "mission", ARGUS_NAME_MISSION);
    status->failure = (uint8_t)named(doc, "state", ARGUS_NAME_FAILURE);
    status->active = flag(doc, "active");
    status->paused = flag(doc, "paused");
    status->online = flag(doc, "online");
    status->reversed = flag(doc, "reversed");
    status->motors = flag(doc, "motors");
    status->pose.x_mm = (int32_t)whole(doc, "x_mm", 0);
    status->pose.y_mm = (int32_t)whole(doc, "y_mm", 0);
    status->pose.heading_cdeg = (int32_t)whole(doc, "heading_cdeg", 0);
    status->goal_mm = (int32_t)whole(doc, "goal_mm", 0);
    status->waypoint = (uint16_t)whole(doc, "waypoint", 0);
    status->waypoints = (uint16_t)whole(doc, "waypoints", 0);
    status->battery_dv = (uint16_t)whole(doc, "battery_dv", 0);
    status->vel_left_mm_s = (int16_t)whole(doc, "vel_left_mm_s", 0);
    status->vel_right_mm_s = (int16_t)whole(doc, "vel_right_mm_s", 0);
    status->bumpers_front = (uint8_t)whole(doc, "bumpers_front", 0);
    status->bumpers_rear = (uint8_t)whole(doc, "bumpers_rear", 0);
}

static void read_link(const json_doc_t *doc, view_t *view) {
    view->status.sips = (uint32_t)whole(doc, "sips", 0);
    view->status.bad_checksums = (uint32_t)whole(doc, "bad_checksums", 0);
    view->status.skipped_bytes = (uint32_t)whole(doc, "skipped_bytes", 0);
    view->status.stops = (uint32_t)whole(doc, "stops", 0);
    view->course_mm = (uint32_t)whole(doc, "course_mm", 0);
    view->reopened = (uint32_t)whole(doc, "reopened", 0);
    view->link_up = flag(doc, "link_up");
    view->controlled = flag(doc, "controlled");
    word(doc, "link", view->link, sizeof view->link);
    word(doc, "robot", view->name, sizeof view->name);
    word(doc, "subclass", view->subclass, sizeof view->subclass);
}

bool attach_read_state(const json_doc_t *doc, view_t *view) {
    if (whole(doc, "id", 0) != ARGUS_EV_STATUS) {
        return false;
    }
    view->t_ms = thousandths(doc, "t");
    read_robot(doc, &view->status);
    read_sonars(doc, view);
    read_plan(doc, view);
    read_link(doc, view);
    return true;
}

// "sonar/front/03" is 3.
static int8_t sonar_of(const char *name) {
    int32_t sonar = -1;
    const char *const slash = strrchr(name, '/');
    if (strncmp(name, "sonar/", 6) != 0 || slash == NULL || !text_number(slash + 1, &sonar) || sonar < 0 ||
        sonar >= ARGUS_SONARS) {
        return ARGUS_NO_SONAR;
    }
    return (int8_t)sonar;
}

bool attach_read_event(const json_doc_t *doc, argus_event_t *event, uint64_t *t_ms) {
    char name[WORD_MAX];
    const int64_t id = whole(doc, "id", 0);
    if (id <= 0 || id > UINT16_MAX || id == ARGUS_EV_STATUS || json_member(doc, 0, "event") < 0) {
        return false;
    }
    word(doc, "name", name, sizeof name);
    *t_ms = thousandths(doc, "t");
    *event = (argus_event_t){.id = (uint16_t)id,
                             .sonar = sonar_of(name),
                             .state = (uint8_t)named(doc, "state", ARGUS_NAME_FAILURE),
                             .value = (int32_t)whole(doc, "value", 0)};
    return true;
}
