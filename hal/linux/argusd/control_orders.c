// SPDX-License-Identifier: MIT
// Carries out orders.
#include "control_orders.h"

#include <stdio.h>
#include <string.h>

#include "course.h"

typedef bool (*act_t)(control_hands_t *self, const control_request_t *request, control_answer_t *answer);

static argus_status_t status_of(const control_hands_t *self) {
    argus_status_t status;
    argus_status(self->op->driver->core, &status);
    return status;
}

static bool ask(control_hands_t *self, argus_op_t op, int32_t argument, control_answer_t *answer) {
    static const char *const words[] = {
        [OPERATOR_FREE] = "",
        [OPERATOR_PASSIVE] = "it is passive; order active first",
        [OPERATOR_NO_ROBOT] = "there is no robot at the link",
        [OPERATOR_NO_COURSE] = "there is no course; order goto or course",
        [OPERATOR_CHECKING] = "it turns or checks its sonars, as after each stop; order it again in a moment",
        [OPERATOR_BUSY] = "it is busy; order stop first",
        [OPERATOR_PINNED] = "the sonar is pinned; order unpin first",
        [OPERATOR_PAPER] = "profile paper cannot do this",
        [OPERATOR_REFUSED] = "the fault manager refuses it: no such sonar, or it is that already"};
    const operator_obstacle_t obstacle = operator_ask(self->op, op, argument, self->now_ms);
    const char *const why = obstacle == OPERATOR_CHECKING ? "checking" : "refused";
    return obstacle == OPERATOR_FREE || control_refuse(answer, why, "%s", words[obstacle]);
}

void control_let_go(control_hands_t *self) {
    const argus_status_t status = status_of(self);
    const bool rests =
        status.mode == ARGUS_MODE_IDLE && status.vel_left_mm_s == 0 && status.vel_right_mm_s == 0;
    if (self->by_hand && !rests) {
        operator_ask(self->op, ARGUS_OP_STOP, 0, self->now_ms);
    }
    self->by_hand = false;
}

static bool stop(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    (void)request;
    return ask(self, ARGUS_OP_STOP, 0, answer);
}

static bool go(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    (void)request;
    return ask(self, ARGUS_OP_GO, 0, answer);
}

static bool activate(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    (void)request;
    if (!ask(self, ARGUS_OP_ACTIVE, 0, answer)) {
        return false;
    }
    return status_of(self).active ||
           control_refuse(answer, "refused",
                          "this robot is not known, or the settings are unsafe for it: see the events");
}

static bool passivate(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    (void)request;
    return ask(self, ARGUS_OP_PASSIVE, 0, answer);
}

static bool recheck(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    (void)request;
    return ask(self, ARGUS_OP_RECHECK, 0, answer);
}

static bool step(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    char way[CONTROL_WORD_MAX];
    if (!control_request_word(request, "way", way, sizeof way, answer)) {
        return false;
    }
    const bool ahead = strcmp(way, "ahead") == 0;
    if (!ahead && strcmp(way, "back") != 0) {
        return control_refuse(answer, "bad_argument", "way must be ahead or back");
    }
    return ask(self, ARGUS_OP_MOVE, ahead ? self->op->ahead_mm : self->op->back_mm, answer);
}

static bool turn(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    int64_t deg = 0;
    return control_request_whole(request, "deg", -180, 180, &deg, answer) &&
           ask(self, ARGUS_OP_TURN, (int32_t)deg, answer);
}

static bool drive(control_hands_t *self, const argus_point_t *points, uint16_t count,
                  control_answer_t *answer) {
    const argus_status_t status = status_of(self);
    if (!status.active || !status.online) {
        return control_refuse(answer, "refused",
                              !status.active ? "it is passive; order active first"
                                             : "there is no robot at the link");
    }
    const char *const note =
        course_near(points[count - 1], (argus_point_t){status.pose.x_mm, status.pose.y_mm});
    snprintf(answer->say, sizeof answer->say, "%s", note == NULL ? "" : note);
    if (!argus_set_course(self->op->driver->core, points, count)) {
        return control_refuse(answer, "refused", "the course does not fit the fault manager");
    }
    if (status.paused) {
        return ask(self, ARGUS_OP_GO, 0, answer);
    }
    driver_transmit(self->op->driver);
    return true;
}

static bool go_to(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    int64_t x_mm = 0;
    int64_t y_mm = 0;
    if (!control_request_whole(request, "x_mm", -ARGUS_COURSE_LIMIT_MM, ARGUS_COURSE_LIMIT_MM, &x_mm,
                               answer) ||
        !control_request_whole(request, "y_mm", -ARGUS_COURSE_LIMIT_MM, ARGUS_COURSE_LIMIT_MM, &y_mm,
                               answer)) {
        return false;
    }
    const argus_point_t point = {(int32_t)x_mm, (int32_t)y_mm};
    return drive(self, &point, 1, answer);
}

static bool read_point(const json_doc_t *doc, int token, argus_point_t *point) {
    int64_t value[2] = {0, 0};
    int at = json_first(doc, token);
    for (int i = 0; i < 2; i++) {
        if (!json_whole(doc, at, -ARGUS_COURSE_LIMIT_MM, ARGUS_COURSE_LIMIT_MM, &value[i])) {
            return false;
        }
        at = json_next(doc, token, at);
    }
    *point = (argus_point_t){(int32_t)value[0], (int32_t)value[1]};
    return at < 0;
}

static bool follow(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    argus_point_t points[ARGUS_WAYPOINTS_MAX];
    const json_doc_t *const doc = &request->doc;
    const int list = json_member(doc, 0, "points");
    uint16_t count = 0;
    for (int at = json_first(doc, list); at >= 0; at = json_next(doc, list, at)) {
        if (count == ARGUS_WAYPOINTS_MAX || !read_point(doc, at, &points[count])) {
            count = 0;
            break;
        }
        count++;
    }
    if (count == 0) {
        return control_refuse(answer, "bad_argument",
                              "points must be 1 to %d pairs [x_mm, y_mm] within %d mm", ARGUS_WAYPOINTS_MAX,
                              ARGUS_COURSE_LIMIT_MM);
    }
    return drive(self, points, count, answer);
}

static bool ask_of_sonar(control_hands_t *self, argus_op_t op, const control_request_t *request,
                         control_answer_t *answer) {
    int64_t sonar = 0;
    return control_request_whole(request, "sonar", 0, ARGUS_SONARS - 1, &sonar, answer) &&
           ask(self, op, (int32_t)sonar, answer);
}

static bool retest(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    return ask_of_sonar(self, ARGUS_OP_RETEST, request, answer);
}

static bool pin(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    return ask_of_sonar(self, ARGUS_OP_PIN, request, answer);
}

static bool unpin(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    return ask_of_sonar(self, ARGUS_OP_UNPIN, request, answer);
}

static bool take_out(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    return ask_of_sonar(self, ARGUS_OP_DISABLE, request, answer);
}

static bool fail(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    char word[CONTROL_WORD_MAX];
    int64_t sonar = 0;
    int64_t for_ms = 0;
    argus_fault_kind_t kind = ARGUS_KIND_NONE;
    if (!self->inject->armed) {
        return control_refuse(answer, "refused", "injection is not armed; start argusd with --inject");
    }
    if (!control_request_whole(request, "sonar", 0, ARGUS_SONARS - 1, &sonar, answer) ||
        !control_request_word(request, "kind", word, sizeof word, answer)) {
        return false;
    }
    if (!inject_kind(word, &kind)) {
#define WORD(name, number, text, meaning) text ", "
        return control_refuse(answer, "bad_argument",
                              "kind must be " ARGUS_FAULT_KIND_TABLE(WORD) "delayed or ok");
#undef WORD
    }
    if (kind != ARGUS_KIND_NONE &&
        !control_request_whole(request, "for_ms", INJECT_MIN_MS, INJECT_MAX_MS, &for_ms, answer)) {
        return false;
    }
    if (sonar >= status_of(self).sonars) {
        return control_refuse(answer, "refused",
                              "this robot has no such sonar, or there is none at the link");
    }
    inject_set(self->inject, (int)sonar, kind, (uint32_t)for_ms, self->now_ms);
    return true;
}

static bool quit(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    (void)request;
    (void)answer;
    self->quits = true;
    return true;
}

// What an order says of the motion: the controller's own hand, something that goes on without, or nothing.
typedef enum { BY_HAND, BY_ITSELF, NO_MOTION } motion_t;

static const struct {
    const char *word;
    act_t act;
    motion_t motion;
} orders[] = {
    {"stop", stop, BY_ITSELF},         {"go", go, BY_ITSELF},      {"active", activate, BY_ITSELF},
    {"passive", passivate, BY_ITSELF}, {"step", step, BY_HAND},    {"recheck", recheck, BY_ITSELF},
    {"turn", turn, BY_HAND},           {"goto", go_to, BY_ITSELF}, {"course", follow, BY_ITSELF},
    {"retest", retest, BY_ITSELF},     {"pin", pin, NO_MOTION},    {"unpin", unpin, NO_MOTION},
    {"out", take_out, NO_MOTION},      {"fail", fail, NO_MOTION},  {"quit", quit, NO_MOTION},
};

bool control_order(control_hands_t *self, const control_request_t *request, control_answer_t *answer) {
    char word[CONTROL_WORD_MAX];
    if (!control_request_word(request, "order", word, sizeof word, answer)) {
        return false;
    }
    for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++) {
        if (strcmp(orders[i].word, word) != 0) {
            continue;
        }
        if (self->ending) {
            return control_refuse(answer, "refused", "argusd is ending");
        }
        const bool done = orders[i].act(self, request, answer);
        self->ordered = self->ordered || done;
        if (done && orders[i].motion != NO_MOTION) {
            self->by_hand = orders[i].motion == BY_HAND;
        }
        return done;
    }
    return control_refuse(answer, "unknown", "there is no such order");
}
