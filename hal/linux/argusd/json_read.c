// SPDX-License-Identifier: MIT
// A JSON reader for lines of a bounded form.
#include "json_read.h"

#include <string.h>

typedef struct {
    json_doc_t *doc;
    size_t at;
    size_t length;
} scan_t;

static bool read_value(scan_t *scan, int depth);

static int peek(const scan_t *scan) {
    return scan->at < scan->length ? (unsigned char)scan->doc->text[scan->at] : -1;
}

static bool skip(scan_t *scan, char wanted) {
    if (peek(scan) != (unsigned char)wanted) {
        return false;
    }
    scan->at++;
    return true;
}

static void skip_blanks(scan_t *scan) {
    while (peek(scan) == ' ' || peek(scan) == '\t' || peek(scan) == '\r' || peek(scan) == '\n') {
        scan->at++;
    }
}

static json_token_t *add(scan_t *scan, json_kind_t kind) {
    if (scan->doc->count >= JSON_TOKENS_MAX) {
        return NULL;
    }
    json_token_t *const token = &scan->doc->token[scan->doc->count++];
    *token = (json_token_t){.kind = (uint8_t)kind, .at = (uint16_t)scan->at, .after = scan->doc->count};
    return token;
}

static bool is_hex(int character) {
    return (character >= '0' && character <= '9') || (character >= 'a' && character <= 'f') ||
           (character >= 'A' && character <= 'F');
}

static bool skip_escape(scan_t *scan) {
    const int character = peek(scan);
    scan->at++;
    if (character != 'u') {
        return character > 0 && strchr("\"\\/bfnrt", character) != NULL;
    }
    for (int i = 0; i < 4; i++, scan->at++) {
        if (!is_hex(peek(scan))) {
            return false;
        }
    }
    return true;
}

static bool read_string(scan_t *scan) {
    if (!skip(scan, '"')) {
        return false;
    }
    json_token_t *const token = add(scan, JSON_STRING);
    if (token == NULL) {
        return false;
    }
    while (!skip(scan, '"')) {
        if (peek(scan) < 0x20) { // the end, too
            return false;
        }
        if (!skip(scan, '\\')) {
            scan->at++;
        } else if (!skip_escape(scan)) {
            return false;
        }
    }
    token->length = (uint16_t)(scan->at - 1 - token->at);
    return true;
}

static bool skip_digits(scan_t *scan) {
    const size_t before = scan->at;
    while (peek(scan) >= '0' && peek(scan) <= '9') {
        scan->at++;
    }
    return scan->at > before;
}

static bool read_number(scan_t *scan) {
    json_token_t *const token = add(scan, JSON_NUMBER);
    if (token == NULL) {
        return false;
    }
    skip(scan, '-');
    if (!skip(scan, '0') && !skip_digits(scan)) {
        return false;
    }
    if (skip(scan, '.') && !skip_digits(scan)) {
        return false;
    }
    if (skip(scan, 'e') || skip(scan, 'E')) {
        (void)(skip(scan, '+') || skip(scan, '-'));
        if (!skip_digits(scan)) {
            return false;
        }
    }
    token->length = (uint16_t)(scan->at - token->at);
    return true;
}

static bool read_word(scan_t *scan, const char *word, json_kind_t kind) {
    const size_t length = strlen(word);
    if (scan->length - scan->at < length || memcmp(scan->doc->text + scan->at, word, length) != 0) {
        return false;
    }
    json_token_t *const token = add(scan, kind);
    scan->at += length;
    return token != NULL;
}

static bool read_list(scan_t *scan, int depth) {
    json_token_t *const token = add(scan, JSON_LIST);
    scan->at++;
    if (token == NULL) {
        return false;
    }
    skip_blanks(scan);
    if (!skip(scan, ']')) {
        do {
            if (!read_value(scan, depth)) {
                return false;
            }
        } while (skip(scan, ','));
        if (!skip(scan, ']')) {
            return false;
        }
    }
    token->after = scan->doc->count;
    return true;
}

static bool same_text(const json_doc_t *doc, const json_token_t *a, const json_token_t *b) {
    return a->length == b->length && memcmp(doc->text + a->at, doc->text + b->at, a->length) == 0;
}

// A name that the object has not had yet, and its colon.
static bool read_name(scan_t *scan, const json_token_t *object, int members) {
    const json_doc_t *const doc = scan->doc;
    const uint16_t at = doc->count;
    skip_blanks(scan);
    if (members >= JSON_MEMBERS_MAX || !read_string(scan)) {
        return false;
    }
    const json_token_t *const name = &doc->token[at];
    if (memchr(doc->text + name->at, '\\', name->length) != NULL) {
        return false;
    }
    for (uint16_t i = object->after; i < at; i = doc->token[i + 1].after) {
        if (same_text(doc, &doc->token[i], name)) {
            return false;
        }
    }
    skip_blanks(scan);
    return skip(scan, ':');
}

static bool read_object(scan_t *scan, int depth) {
    json_token_t *const token = add(scan, JSON_OBJECT);
    scan->at++;
    if (token == NULL) {
        return false;
    }
    skip_blanks(scan);
    if (!skip(scan, '}')) {
        int members = 0;
        do {
            if (!read_name(scan, token, members++) || !read_value(scan, depth)) {
                return false;
            }
        } while (skip(scan, ','));
        if (!skip(scan, '}')) {
            return false;
        }
    }
    token->after = scan->doc->count;
    return true;
}

static bool read_bare(scan_t *scan) {
    switch (peek(scan)) {
    case '"':
        return read_string(scan);
    case 't':
        return read_word(scan, "true", JSON_TRUE);
    case 'f':
        return read_word(scan, "false", JSON_FALSE);
    case 'n':
        return read_word(scan, "null", JSON_NULL);
    default:
        return read_number(scan);
    }
}

// A value with the blanks around it. The depth is bounded, so the recursion is.
static bool read_value(scan_t *scan, int depth) {
    bool read = false;
    skip_blanks(scan);
    const int character = peek(scan);
    if (character != '{' && character != '[') {
        read = read_bare(scan);
    } else if (depth < JSON_DEPTH_MAX) {
        read = character == '{' ? read_object(scan, depth + 1) : read_list(scan, depth + 1);
    }
    skip_blanks(scan);
    return read;
}

bool json_read(json_doc_t *self, const char *text, size_t length) {
    scan_t scan = {.doc = self, .length = length};
    self->text = text;
    self->count = 0;
    return length <= JSON_TEXT_MAX && read_value(&scan, 0) && scan.at == length &&
           self->token[0].kind == JSON_OBJECT;
}

bool json_is(const json_doc_t *self, int token, json_kind_t kind) {
    return token >= 0 && token < self->count && self->token[token].kind == kind;
}

int json_member(const json_doc_t *self, int of, const char *name) {
    const size_t length = strlen(name);
    if (!json_is(self, of, JSON_OBJECT)) {
        return -1;
    }
    for (int i = of + 1; i < self->token[of].after; i = self->token[i + 1].after) {
        if (self->token[i].length == length && memcmp(self->text + self->token[i].at, name, length) == 0) {
            return i + 1;
        }
    }
    return -1;
}

int json_first(const json_doc_t *self, int list) {
    return json_is(self, list, JSON_LIST) && list + 1 < self->token[list].after ? list + 1 : -1;
}

int json_next(const json_doc_t *self, int list, int token) {
    const int after = self->token[token].after;
    return after < self->token[list].after ? after : -1;
}

bool json_whole(const json_doc_t *self, int token, int64_t minimum, int64_t maximum, int64_t *value) {
    if (!json_is(self, token, JSON_NUMBER)) {
        return false;
    }
    const char *at = self->text + self->token[token].at;
    const char *const end = at + self->token[token].length;
    const bool negative = *at == '-';
    int64_t number = 0;
    for (at += negative ? 1 : 0; at < end; at++) {
        if (*at < '0' || *at > '9' || number > INT64_MAX / 100) {
            return false;
        }
        number = number * 10 + (*at - '0');
    }
    number = negative ? -number : number;
    *value = number;
    return number >= minimum && number <= maximum;
}

static uint32_t hex4(const char *at) {
    uint32_t value = 0;
    for (int i = 0; i < 4; i++) {
        const int character = at[i];
        const int digit = character <= '9' ? character - '0' : (character | 0x20) - 'a' + 10;
        value = value << 4 | (uint32_t)digit;
    }
    return value;
}

// The code point of the escape behind `\u`, 0 for one that is refused; `*at` moves behind it.
static uint32_t code_point(const char **at, const char *end) {
    const uint32_t first = hex4(*at);
    *at += 4;
    if (first < 0xD800 || first > 0xDFFF) {
        return first;
    }
    if (first > 0xDBFF || end - *at < 6 || (*at)[0] != '\\' || (*at)[1] != 'u') {
        return 0;
    }
    const uint32_t second = hex4(*at + 2);
    *at += 6;
    return second < 0xDC00 || second > 0xDFFF ? 0 : 0x10000 + ((first - 0xD800) << 10) + (second - 0xDC00);
}

static size_t encode(uint32_t point, char *out) {
    if (point < 0x80) {
        out[0] = (char)point;
        return 1;
    }
    const size_t length = point < 0x800 ? 2 : point < 0x10000 ? 3 : 4;
    static const uint32_t leads[] = {0, 0, 0xC0, 0xE0, 0xF0};
    for (size_t i = length - 1; i > 0; i--) {
        out[i] = (char)(0x80 | (point & 0x3F));
        point >>= 6;
    }
    out[0] = (char)(leads[length] | point);
    return length;
}

// One character of a string, at most 4 bytes; 0: it is refused.
static size_t decode(const char **at, const char *end, char *out) {
    static const char plain[] = "\"\\/bfnrt";
    static const char meant[] = "\"\\/\b\f\n\r\t";
    if (**at != '\\') {
        out[0] = *(*at)++;
        return 1;
    }
    const char escape = (*at)[1];
    *at += 2;
    if (escape != 'u') {
        out[0] = meant[strchr(plain, escape) - plain];
        return 1;
    }
    const uint32_t point = code_point(at, end);
    return point == 0 ? 0 : encode(point, out);
}

bool json_text(const json_doc_t *self, int token, char *value, size_t capacity) {
    size_t used = 0;
    if (!json_is(self, token, JSON_STRING)) {
        return false;
    }
    const char *at = self->text + self->token[token].at;
    const char *const end = at + self->token[token].length;
    while (at < end) {
        char character[4];
        const size_t length = decode(&at, end, character);
        if (length == 0 || used + length >= capacity) {
            return false;
        }
        memcpy(value + used, character, length);
        used += length;
    }
    value[used] = '\0';
    return true;
}
