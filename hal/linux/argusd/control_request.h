// SPDX-License-Identifier: MIT
// A request at the control socket as it was read, and its answer as it will be written.
#ifndef ARGUSD_CONTROL_REQUEST_H
#define ARGUSD_CONTROL_REQUEST_H

#include "json.h"
#include "json_read.h"

#define CONTROL_ID_MAX 64
#define CONTROL_WORD_MAX 32
#define CONTROL_SAY_MAX 256

typedef enum { CONTROL_NO_ID, CONTROL_NUMBER_ID, CONTROL_TEXT_ID } control_id_kind_t;

typedef struct {
    json_doc_t doc;
    control_id_kind_t id_kind;
    int64_t number;
    char text[CONTROL_ID_MAX + 1];
    char word[CONTROL_WORD_MAX]; // what `do` says
} control_request_t;

// `why` NULL: ok, with a note in `say` or nothing.
typedef struct {
    const char *why;
    char say[CONTROL_SAY_MAX];
} control_answer_t;

// Reads a line. False: `answer` says why not.
bool control_request_read(control_request_t *self, const char *line, size_t length, control_answer_t *answer);

// Members of the request. False, with `answer`: missing, of another type or out of range.
bool control_request_whole(const control_request_t *self, const char *name, int64_t minimum, int64_t maximum,
                           int64_t *value, control_answer_t *answer);
bool control_request_word(const control_request_t *self, const char *name, char *value, size_t capacity,
                          control_answer_t *answer);
// May be missing: false then.
bool control_request_flag(const control_request_t *self, const char *name, bool *value,
                          control_answer_t *answer);

// Returns false, so that a failing function can end with it.
__attribute__((format(printf, 3, 4))) bool control_refuse(control_answer_t *answer, const char *why,
                                                          const char *format, ...);

// Opens the reply's object with `re`, `ok` and, if it is not, `why` and `say`; the caller may add members and
// closes it.
void control_reply(json_t *json, const control_request_t *request, const control_answer_t *answer);

#endif
