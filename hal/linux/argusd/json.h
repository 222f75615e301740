// SPDX-License-Identifier: MIT
// Writes one JSON value into a buffer of fixed size; commas and escapes are its job.
#ifndef ARGUSD_JSON_H
#define ARGUSD_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "text.h"

typedef struct {
    text_t text;
    bool comma; // the next value is not the first in its object or array
} json_t;

json_t json_in(char *buffer, size_t capacity);
void json_open(json_t *self, char bracket); // '{' or '['
void json_close(json_t *self, char bracket);
void json_name(json_t *self, const char *name); // the next value's name
void json_int(json_t *self, int64_t value);
void json_bool(json_t *self, bool value);
void json_null(json_t *self);
void json_thousandths(json_t *self, int64_t value); // 1234 is written as 1.234
void json_string(json_t *self, const char *value);  // bytes that are no UTF-8 become U+FFFD

// False when the buffer was too small: the text is of no use then.
bool json_fits(const json_t *self);

#endif
