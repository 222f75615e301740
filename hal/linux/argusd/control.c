// SPDX-License-Identifier: MIT
// Serves the clients of the control socket.
#include "control.h"

#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

#include "control_stream.h"
#include "report.h"

#define REQUESTS_MAX 8 // in one wake-up, of all: a flood of them must not keep the robot waiting
#define PERIOD_MIN_MS 50
#define PERIOD_MAX_MS 10000
#define SEQ_MAX (((int64_t)1 << 53) - 1)
#define NOTICE_MS 10000u
#define LINE(text) (text), sizeof(text) - 1

bool control_open(control_t *self, const control_spec_t *spec, const control_token_t *token, char *message,
                  size_t capacity) {
    self->token = *token;
    self->needs_token = token->on;
    self->holder = -1;
    self->on = control_port_open(&self->port, spec, message, capacity);
    return self->on;
}

void control_begin(control_t *self, const control_world_t *world) {
    self->world = *world;
}

static void say_to(control_client_t *client, const char *line, size_t length) {
    if (length > 0) {
        control_client_say(client, line, length);
    }
}

// Control
// ----------------------------------------------------------------------------------------------------

// The client that moves the robot by hand no longer can: it must not go on.
static void lose_control(control_t *self) {
    if (self->holder >= 0) {
        control_let_go(&self->world.hands);
    }
    self->holder = -1;
    memset(self->grant, 0, sizeof self->grant);
}

static bool draw_grant(control_t *self) {
    uint8_t bytes[CONTROL_GRANT_BYTES];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes) {
        return false;
    }
    for (size_t i = 0; i < sizeof bytes; i++) {
        snprintf(self->grant + 2 * i, 3, "%02x", bytes[i]);
    }
    return true;
}

static bool take(control_t *self, int place, control_answer_t *answer) {
    static const char lost[] = "{\"lost\":\"control\"}";
    bool force = false;
    if (!control_request_flag(&self->request, "force", &force, answer)) {
        return false;
    }
    if (self->holder >= 0 && self->holder != place) {
        if (!force) {
            return control_refuse(answer, "taken", "another connection has control; force takes it");
        }
        control_client_say(&self->client[self->holder], LINE(lost));
        lose_control(self);
    }
    if (!draw_grant(self)) {
        return control_refuse(answer, "refused", "the system has no random numbers");
    }
    self->holder = place;
    self->seq = -1;
    self->client[place].had_control = true;
    return true;
}

static bool release(control_t *self, int place, control_answer_t *answer) {
    if (self->holder != place) {
        return control_refuse(answer, "not_in_control", "this connection has no control");
    }
    lose_control(self);
    return true;
}

// Whether the order is of the client that has control, and none that was heard before.
static bool is_entitled(control_t *self, int place, control_answer_t *answer) {
    char grant[sizeof self->grant];
    int64_t seq = 0;
    if (self->holder != place) {
        return self->client[place].had_control
                   ? control_refuse(answer, "stale_grant", "this connection has lost control; take it again")
                   : control_refuse(answer, "not_in_control", "take control first");
    }
    if (!control_request_word(&self->request, "grant", grant, sizeof grant, answer) ||
        !control_request_whole(&self->request, "seq", 0, SEQ_MAX, &seq, answer)) {
        return false;
    }
    if (strcmp(grant, self->grant) != 0) {
        return control_refuse(answer, "stale_grant", "this is not the grant of this connection");
    }
    if (seq <= self->seq) {
        return control_refuse(answer, "replayed", "seq must be above that of the last order");
    }
    self->seq = seq;
    return true;
}

// Nobody must be kept from stopping the robot.
static bool is_stop(const control_t *self) {
    char word[CONTROL_WORD_MAX];
    const int token = json_member(&self->request.doc, 0, "order");
    return json_text(&self->request.doc, token, word, sizeof word) && strcmp(word, "stop") == 0;
}

static bool order(control_t *self, int place, control_answer_t *answer) {
    control_answer_t ignored;
    if (is_stop(self)) {
        (void)is_entitled(self, place, &ignored); // notes its seq
    } else if (!is_entitled(self, place, answer)) {
        return false;
    }
    return control_order(&self->world.hands, &self->request, answer);
}

// Requests
// ---------------------------------------------------------------------------------------------------

static bool hello(control_t *self, int place, control_answer_t *answer) {
    char token[CONTROL_TOKEN_MAX + 1];
    if (!self->needs_token) {
        return true;
    }
    if (!control_request_word(&self->request, "token", token, sizeof token, answer)) {
        return false;
    }
    self->client[place].authentic = control_token_is(&self->token, token);
    memset(token, 0, sizeof token);
    if (!self->client[place].authentic) {
        self->client[place].over = true;
        self->wrong_tokens++;
        return control_refuse(answer, "auth", "the token is wrong");
    }
    return true;
}

static bool read_topics(const json_doc_t *doc, unsigned *topics, control_answer_t *answer) {
    static const char *const names[] = {"events", "state", "readings", "evidence"};
    const int list = json_member(doc, 0, "topics");
    *topics = 0;
    if (!json_is(doc, list, JSON_LIST)) {
        return control_refuse(answer, "bad_argument", "topics must be a list");
    }
    for (int at = json_first(doc, list); at >= 0; at = json_next(doc, list, at)) {
        char word[CONTROL_WORD_MAX];
        unsigned bit = 0;
        for (unsigned i = 0; i < 4 && json_text(doc, at, word, sizeof word); i++) {
            bit |= strcmp(word, names[i]) == 0 ? 1u << i : 0;
        }
        if (bit == 0) {
            return control_refuse(answer, "unknown", "the topics are events, state, readings and evidence");
        }
        *topics |= bit;
    }
    return true;
}

static bool watch(control_t *self, int place, control_answer_t *answer) {
    control_client_t *const client = &self->client[place];
    unsigned topics = 0;
    int64_t period_ms = CONTROL_PERIOD_MS;
    if (!read_topics(&self->request.doc, &topics, answer)) {
        return false;
    }
    if (json_member(&self->request.doc, 0, "period_ms") >= 0 &&
        !control_request_whole(&self->request, "period_ms", PERIOD_MIN_MS, PERIOD_MAX_MS, &period_ms,
                               answer)) {
        return false;
    }
    client->topics = topics;
    client->period_ms = (uint32_t)period_ms;
    client->state_ms = self->moment.now_ms - client->period_ms; // the first one at once
    client->evidence_ms = client->state_ms;
    return true;
}

static bool answer_request(control_t *self, int place, control_answer_t *answer) {
    const char *const word = self->request.word;
    if (strcmp(word, "hello") == 0) {
        return hello(self, place, answer);
    }
    if (!self->client[place].authentic) {
        return control_refuse(answer, "auth", "say hello with the token first");
    }
    if (strcmp(word, "watch") == 0) {
        return watch(self, place, answer);
    }
    if (strcmp(word, "take") == 0) {
        return take(self, place, answer);
    }
    if (strcmp(word, "release") == 0) {
        return release(self, place, answer);
    }
    if (strcmp(word, "order") == 0) {
        return order(self, place, answer);
    }
    return strcmp(word, "status") == 0 || control_refuse(answer, "unknown", "there is no such request");
}

static int64_t unix_ms(void) {
    struct timespec wall = {0};
    clock_gettime(CLOCK_REALTIME, &wall);
    return (int64_t)wall.tv_sec * 1000 + wall.tv_nsec / 1000000;
}

static size_t state_line(control_t *self, char *line, size_t capacity) {
    return report_status_json(self->world.look(self->world.context), unix_ms(), line, capacity);
}

// What a request brings besides ok.
static void add_result(control_t *self, json_t *json) {
    if (strcmp(self->request.word, "take") == 0) {
        json_name(json, "grant");
        json_string(json, self->grant);
    } else if (strcmp(self->request.word, "status") == 0) {
        json_name(json, "state");
        char *const at = json->text.at + json->text.length;
        const size_t length = state_line(self, at, json->text.capacity - json->text.length);
        json->text.length += length;
        json->text.cut = json->text.cut || length == 0;
        json->comma = true;
    }
}

static void reply(control_t *self, control_client_t *client, const control_answer_t *answer) {
    json_t json = json_in(self->line, sizeof self->line);
    control_reply(&json, &self->request, answer);
    if (answer->why == NULL) {
        add_result(self, &json);
    }
    json_close(&json, '}');
    if (json_fits(&json)) {
        say_to(client, self->line, json.text.length);
    }
}

static bool take_request(control_t *self, int place) {
    char line[CONTROL_LINE_MAX];
    size_t length = 0;
    control_client_t *const client = &self->client[place];
    control_answer_t answer = {.why = NULL};
    const control_line_t got = control_client_line(client, line, &length);
    if (got == CONTROL_NO_LINE) {
        return false;
    }
    self->world.hands.now_ms = self->moment.now_ms;
    if (got == CONTROL_TOO_LONG) {
        self->request.id_kind = CONTROL_NO_ID;
        control_refuse(&answer, "too_long", "a line has at most %d bytes", CONTROL_LINE_MAX);
    } else if (control_request_read(&self->request, line, length, &answer)) {
        (void)answer_request(self, place, &answer);
    }
    reply(self, client, &answer);
    return true;
}

// Connections
// ------------------------------------------------------------------------------------------------

static void drop(control_t *self, int place) {
    if (self->holder == place) {
        self->world.hands.now_ms = self->moment.now_ms;
        lose_control(self);
    }
    control_client_close(&self->client[place]);
}

// A place for a new client: a free one, else that of the client that has not said the token for the longest
// time.
static int find_place(control_t *self) {
    int oldest = -1;
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        const control_client_t *const c = &self->client[i];
        if (!c->on) {
            return i;
        }
        if (!c->authentic && (oldest < 0 || (int32_t)(c->since_ms - self->client[oldest].since_ms) < 0)) {
            oldest = i;
        }
    }
    if (oldest >= 0) {
        drop(self, oldest);
    }
    return oldest;
}

int control_admit(control_t *self, int fd, uint32_t now_ms) {
    const int place = find_place(self);
    if (place < 0) {
        return -1;
    }
    control_client_t *const client = &self->client[place];
    control_client_open(client, fd, !self->needs_token, now_ms);
    json_t json = json_in(self->line, sizeof self->line);
    json_open(&json, '{');
    json_name(&json, "control");
    json_int(&json, 1);
    json_name(&json, "argus");
    json_string(&json, ARGUS_VERSION);
    json_name(&json, "auth");
    json_string(&json, self->needs_token ? "token" : "none");
    json_close(&json, '}');
    say_to(client, self->line, json.text.length);
    return place;
}

static void let_in(control_t *self) {
    static const char full[] =
        "{\"re\":null,\"ok\":false,\"why\":\"refused\",\"say\":\"all places are taken\"}\n";
    const int fd = control_port_accept(&self->port);
    if (fd >= 0 && control_admit(self, fd, self->moment.now_ms) < 0) {
        (void)!write(fd, full, sizeof full - 1);
        close(fd);
    }
}

int control_poll(const control_t *self, struct pollfd *wait) {
    int count = 0;
    if (!self->on) {
        return 0;
    }
    wait[count++] = (struct pollfd){.fd = self->port.fd, .events = POLLIN};
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        const control_client_t *const c = &self->client[i];
        if (c->on) {
            const bool reads = !c->over && c->used < sizeof c->in;
            wait[count++] = (struct pollfd){
                .fd = c->fd, .events = (short)((reads ? POLLIN : 0) | (output_waits(&c->out) ? POLLOUT : 0))};
        }
    }
    return count;
}

void control_serve(control_t *self, const moment_t *moment) {
    int left = REQUESTS_MAX;
    if (!self->on) {
        return;
    }
    self->moment = *moment;
    let_in(self);
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        const int place = (self->first + i) % CONTROL_CLIENTS;
        control_client_t *const client = &self->client[place];
        if (!client->on) {
            continue;
        }
        control_client_read(client);
        if (left > 0 && !client->rude && take_request(self, place)) {
            left--;
        }
        control_client_flush(client, moment->now_ms);
        if (control_client_is_over(client, moment->now_ms)) {
            drop(self, place);
        }
    }
    self->first = (self->first + 1) % CONTROL_CLIENTS;
}

// Streams
// ----------------------------------------------------------------------------------------------------

static void say_to_all(control_t *self, control_topic_t topic, const char *line, size_t length) {
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        if (self->client[i].on && (self->client[i].topics & (unsigned)topic) != 0) {
            say_to(&self->client[i], line, length);
        }
    }
}

static bool is_watched(const control_t *self, control_topic_t topic) {
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        if (self->client[i].on && (self->client[i].topics & (unsigned)topic) != 0) {
            return true;
        }
    }
    return false;
}

void control_event(control_t *self, uint64_t t_ms, const argus_event_t *event) {
    if (self->on && is_watched(self, CONTROL_EVENTS)) {
        const size_t length = report_event_json(event, t_ms, self->line, sizeof self->line);
        say_to_all(self, CONTROL_EVENTS, self->line, length);
    }
}

static void tell_readings(control_t *self) {
    if (!is_watched(self, CONTROL_READINGS)) {
        return;
    }
    const view_t *const view = self->world.look(self->world.context);
    if (view->status.sips != self->sips) {
        self->sips = view->status.sips;
        const size_t length = control_readings_line(view, self->line, sizeof self->line);
        say_to_all(self, CONTROL_READINGS, self->line, length);
    }
}

static size_t evidence_line(control_t *self) {
    argus_suspicions_t suspicions;
    argus_suspicions(self->world.hands.op->driver->core, &suspicions);
    return control_evidence_line(self->world.look(self->world.context), &suspicions, self->line,
                                 sizeof self->line);
}

// To the clients that have a period that is over; the line is written once for all of them. Returns the ms
// until the next one is over.
static uint32_t tell_periodic(control_t *self, control_topic_t topic) {
    uint32_t wait_ms = UINT32_MAX;
    size_t length = 0;
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        control_client_t *const c = &self->client[i];
        uint32_t *const told_ms = topic == CONTROL_STATE ? &c->state_ms : &c->evidence_ms;
        if (!c->on || (c->topics & (unsigned)topic) == 0) {
            continue;
        }
        if (self->moment.now_ms - *told_ms >= c->period_ms) {
            if (length == 0) {
                length = topic == CONTROL_STATE ? state_line(self, self->line, sizeof self->line)
                                                : evidence_line(self);
            }
            say_to(c, self->line, length);
            *told_ms = self->moment.now_ms;
        }
        const uint32_t left_ms = c->period_ms - (self->moment.now_ms - *told_ms);
        wait_ms = left_ms < wait_ms ? left_ms : wait_ms;
    }
    return wait_ms;
}

// Whether a request waits that was not looked at for now.
static bool is_behind(const control_t *self) {
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        if (self->client[i].on && control_client_has_line(&self->client[i])) {
            return true;
        }
    }
    return false;
}

uint32_t control_tell(control_t *self, const moment_t *moment) {
    if (!self->on) {
        return UINT32_MAX;
    }
    self->moment = *moment;
    tell_readings(self);
    const uint32_t state_ms = tell_periodic(self, CONTROL_STATE);
    const uint32_t evidence_ms = tell_periodic(self, CONTROL_EVIDENCE);
    return is_behind(self) ? 0 : state_ms < evidence_ms ? state_ms : evidence_ms;
}

bool control_is_held(const control_t *self) {
    return self->on && self->holder >= 0;
}

bool control_is_quit(const control_t *self) {
    return self->on && self->world.hands.quits;
}

bool control_notice(control_t *self, char *text, size_t capacity) {
    const uint32_t count = self->wrong_tokens - self->wrong_said;
    if (count == 0 || (self->wrong_said > 0 && self->moment.now_ms - self->wrong_ms < NOTICE_MS)) {
        return false;
    }
    self->wrong_said = self->wrong_tokens;
    self->wrong_ms = self->moment.now_ms;
    snprintf(text, capacity, "control socket: %u wrong token%s, turned away", (unsigned)count,
             count == 1 ? "" : "s");
    return true;
}

void control_close(control_t *self) {
    if (!self->on) {
        return;
    }
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        if (self->client[i].on) {
            control_client_close(&self->client[i]);
        }
    }
    self->holder = -1;
    self->on = false;
    control_port_close(&self->port);
}
