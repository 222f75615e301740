// SPDX-License-Identifier: MIT
// Reads requests and writes the head of replies.
#include "control_request.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define SAFE_WHOLE ((int64_t)1 << 53)

bool control_refuse(control_answer_t *answer, const char *why, const char *format, ...) {
    text_t text = text_in(answer->say, sizeof answer->say);
    va_list arguments;
    va_start(arguments, format);
    text_add_list(&text, format, arguments);
    va_end(arguments);
    answer->why = why;
    return false;
}

static bool read_id(control_request_t *self, control_answer_t *answer) {
    const int token = json_member(&self->doc, 0, "id");
    if (token < 0 || json_is(&self->doc, token, JSON_NULL)) {
        return true;
    }
    if (json_whole(&self->doc, token, -SAFE_WHOLE, SAFE_WHOLE, &self->number)) {
        self->id_kind = CONTROL_NUMBER_ID;
        return true;
    }
    if (json_text(&self->doc, token, self->text, sizeof self->text)) {
        self->id_kind = CONTROL_TEXT_ID;
        return true;
    }
    return control_refuse(answer, "bad_argument", "id must be a whole number or a string of at most %d bytes",
                          CONTROL_ID_MAX);
}

bool control_request_read(control_request_t *self, const char *line, size_t length,
                          control_answer_t *answer) {
    self->id_kind = CONTROL_NO_ID;
    self->word[0] = '\0';
    answer->why = NULL;
    answer->say[0] = '\0';
    if (!json_read(&self->doc, line, length)) {
        return control_refuse(answer, "bad_json",
                              "this line is no JSON object of the form that is read here");
    }
    return read_id(self, answer) && control_request_word(self, "do", self->word, sizeof self->word, answer);
}

bool control_request_whole(const control_request_t *self, const char *name, int64_t minimum, int64_t maximum,
                           int64_t *value, control_answer_t *answer) {
    return json_whole(&self->doc, json_member(&self->doc, 0, name), minimum, maximum, value) ||
           control_refuse(answer, "bad_argument", "%s must be a whole number from %" PRId64 " to %" PRId64,
                          name, minimum, maximum);
}

bool control_request_word(const control_request_t *self, const char *name, char *value, size_t capacity,
                          control_answer_t *answer) {
    return json_text(&self->doc, json_member(&self->doc, 0, name), value, capacity) ||
           control_refuse(answer, "bad_argument", "%s must be a string of at most %d bytes", name,
                          (int)capacity - 1);
}

bool control_request_flag(const control_request_t *self, const char *name, bool *value,
                          control_answer_t *answer) {
    const int token = json_member(&self->doc, 0, name);
    *value = json_is(&self->doc, token, JSON_TRUE);
    return token < 0 || *value || json_is(&self->doc, token, JSON_FALSE) ||
           control_refuse(answer, "bad_argument", "%s must be true or false", name);
}

void control_reply(json_t *json, const control_request_t *request, const control_answer_t *answer) {
    json_open(json, '{');
    json_name(json, "re");
    if (request->id_kind == CONTROL_NUMBER_ID) {
        json_int(json, request->number);
    } else if (request->id_kind == CONTROL_TEXT_ID) {
        json_string(json, request->text);
    } else {
        json_null(json);
    }
    json_name(json, "ok");
    json_bool(json, answer->why == NULL);
    if (answer->why != NULL) {
        json_name(json, "why");
        json_string(json, answer->why);
    }
    if (answer->say[0] != '\0') {
        json_name(json, "say");
        json_string(json, answer->say);
    }
}
