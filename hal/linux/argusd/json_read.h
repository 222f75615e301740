// SPDX-License-Identifier: MIT
// Reads one JSON object of bounded size into a table of tokens: no memory is asked for, nothing is copied.
#ifndef ARGUSD_JSON_READ_H
#define ARGUSD_JSON_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define JSON_TOKENS_MAX 512
#define JSON_TEXT_MAX 16384
#define JSON_DEPTH_MAX 4
#define JSON_MEMBERS_MAX 96 // of one object

typedef enum {
    JSON_NULL,
    JSON_FALSE,
    JSON_TRUE,
    JSON_NUMBER,
    JSON_STRING,
    JSON_LIST,
    JSON_OBJECT
} json_kind_t;

typedef struct {
    uint8_t kind;
    uint16_t at;     // in the text: of a string, behind its quote
    uint16_t length; // of a string, without its quotes
    uint16_t after;  // the first token that is not part of this one
} json_token_t;

// Token 0 is the object. A member is two tokens, its name and its value.
typedef struct {
    const char *text;
    uint16_t count;
    json_token_t token[JSON_TOKENS_MAX];
} json_doc_t;

// False: the text is not one JSON object and blanks, or is deeper or longer than the bounds. Or an object has
// a name twice. Names are written without escapes. `text` must outlive `self`.
bool json_read(json_doc_t *self, const char *text, size_t length);

// The value of a member of the object `of`; -1: it has none of that name.
int json_member(const json_doc_t *self, int of, const char *name);

// The first token in a list, and the one behind `token`; -1: no more.
int json_first(const json_doc_t *self, int list);
int json_next(const json_doc_t *self, int list, int token);

bool json_is(const json_doc_t *self, int token, json_kind_t kind);

// A whole number without an exponent or a point, from `minimum` to `maximum`.
bool json_whole(const json_doc_t *self, int token, int64_t minimum, int64_t maximum, int64_t *value);

// Decodes a string. False: it is none, does not fit, or has a character that UTF-8 text in C cannot hold.
bool json_text(const json_doc_t *self, int token, char *value, size_t capacity);

#endif
