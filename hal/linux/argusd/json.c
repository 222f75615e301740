// SPDX-License-Identifier: MIT
// JSON, written value by value.
#include "json.h"

#include <inttypes.h>

json_t json_in(char *buffer, size_t capacity) {
    return (json_t){.text = text_in(buffer, capacity)};
}

static void separate(json_t *self) {
    if (self->comma) {
        text_add(&self->text, ",");
    }
    self->comma = true;
}

void json_open(json_t *self, char bracket) {
    separate(self);
    text_add(&self->text, "%c", bracket);
    self->comma = false;
}

void json_close(json_t *self, char bracket) {
    text_add(&self->text, "%c", bracket);
    self->comma = true;
}

void json_int(json_t *self, int64_t value) {
    separate(self);
    text_add(&self->text, "%" PRId64, value);
}

void json_bool(json_t *self, bool value) {
    separate(self);
    text_add(&self->text, value ? "true" : "false");
}

void json_null(json_t *self) {
    separate(self);
    text_add(&self->text, "null");
}

void json_thousandths(json_t *self, int64_t value) {
    const uint64_t size = value < 0 ? 0u - (uint64_t)value : (uint64_t)value;
    separate(self);
    text_add(&self->text, "%s%" PRIu64 ".%03" PRIu64, value < 0 ? "-" : "", size / 1000u, size % 1000u);
}

// Whether the bytes from the third on are continuations.
static bool continues(const unsigned char *at, size_t length) {
    for (size_t k = 2; k < length; k++) {
        if ((at[k] & 0xC0) != 0x80) {
            return false;
        }
    }
    return true;
}

// Length of the UTF-8 character at `at`, 0 when there is none: stray, cut, overlong, surrogate or beyond
// U+10FFFF.
static size_t utf8_length(const unsigned char *at) {
    static const struct {
        unsigned char mask, lead, low, high; // low..high: the second byte
    } forms[] = {
        {0xFF, 0xE0, 0xA0, 0xBF}, {0xFF, 0xED, 0x80, 0x9F}, {0xFF, 0xF0, 0x90, 0xBF},
        {0xFF, 0xF4, 0x80, 0x8F}, {0xE0, 0xC0, 0x80, 0xBF}, {0xF0, 0xE0, 0x80, 0xBF},
        {0xFC, 0xF0, 0x80, 0xBF},
    };
    if (at[0] < 0x80) {
        return 1;
    }
    for (size_t i = 0; at[0] >= 0xC2 && i < sizeof forms / sizeof forms[0]; i++) {
        if ((at[0] & forms[i].mask) != forms[i].lead) {
            continue;
        }
        if (at[1] < forms[i].low || at[1] > forms[i].high) {
            return 0;
        }
        const size_t length = at[0] < 0xE0 ? 2 : at[0] < 0xF0 ? 3 : 4;
        return continues(at, length) ? length : 0;
    }
    return 0;
}

static void add_ascii(text_t *text, unsigned char character) {
    if (character == '"' || character == '\\') {
        text_add(text, "\\%c", character);
    } else if (character < 0x20 || character == 0x7F) {
        text_add(text, "\\u%04x", character);
    } else {
        text_add(text, "%c", character);
    }
}

static void add_quoted(text_t *text, const char *value) {
    const unsigned char *at = (const unsigned char *)value;
    text_add(text, "\"");
    while (*at != '\0') {
        const size_t length = utf8_length(at);
        if (length == 1) {
            add_ascii(text, *at);
        } else if (length == 0) {
            text_add(text, "\\ufffd");
        } else {
            text_add(text, "%.*s", (int)length, (const char *)at);
        }
        at += length == 0 ? 1 : length;
    }
    text_add(text, "\"");
}

void json_name(json_t *self, const char *name) {
    separate(self);
    add_quoted(&self->text, name);
    text_add(&self->text, ":");
    self->comma = false;
}

void json_string(json_t *self, const char *value) {
    separate(self);
    add_quoted(&self->text, value);
}

bool json_fits(const json_t *self) {
    return !self->text.cut;
}
