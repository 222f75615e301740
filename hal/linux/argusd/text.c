// SPDX-License-Identifier: MIT
// Text in buffers of fixed size.
#include "text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char blanks[] = " \t\r\n"; // around a number

text_t text_in(char *buffer, size_t capacity) {
    buffer[0] = '\0';
    return (text_t){.at = buffer, .capacity = capacity};
}

void text_add_list(text_t *self, const char *format, va_list arguments) {
    const size_t room = self->capacity - self->length;
    const int wanted = vsnprintf(self->at + self->length, room, format, arguments);
    if (wanted < 0 || (size_t)wanted >= room) {
        self->cut = true;
        self->length = strlen(self->at);
        return;
    }
    self->length += (size_t)wanted;
}

void text_add(text_t *self, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    text_add_list(self, format, arguments);
    va_end(arguments);
}

bool text_refuse(char *buffer, size_t capacity, const char *format, ...) {
    text_t text = text_in(buffer, capacity);
    va_list arguments;
    va_start(arguments, format);
    text_add_list(&text, format, arguments);
    va_end(arguments);
    return false;
}

bool text_number(const char *text, int32_t *value) {
    char *end = NULL;
    errno = 0;
    const long number = strtol(text, &end, 10);
    if (end == text || errno != 0 || number < INT32_MIN || number > INT32_MAX) {
        return false;
    }
    if (end[strspn(end, blanks)] != '\0') {
        return false;
    }
    *value = (int32_t)number;
    return true;
}

// A unit at the end of a number, without blanks behind it; 1 where there is none. Its length, too.
static int32_t unit_of(const char *text, size_t length, size_t *unit_length) {
    static const struct {
        const char *name;
        int32_t mm;
    } units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}};
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        *unit_length = strlen(units[i].name);
        if (length >= *unit_length &&
            memcmp(text + length - *unit_length, units[i].name, *unit_length) == 0) {
            return units[i].mm;
        }
    }
    *unit_length = 0;
    return 1;
}

#define PART_DIGITS 6
#define PARTS 1000000

// Millionths of a number without a sign; what is less is cut. false: none, or 1e9 and more.
static bool read_millionths(const char *text, int64_t *millionths) {
    static const char digits[] = "0123456789";
    const size_t whole = strspn(text, digits);
    const bool point = text[whole] == '.';
    const char *const part = text + whole + point;
    const size_t parts = point ? strspn(part, digits) : 0;
    if (whole + parts == 0 || whole > 9 || part[parts] != '\0') {
        return false;
    }
    char number[32];
    snprintf(number, sizeof number, "%.*s%.*s000000", (int)whole, text,
             (int)(parts < PART_DIGITS ? parts : PART_DIGITS), part);
    number[whole + PART_DIGITS] = '\0';
    *millionths = strtoll(number, NULL, 10);
    return true;
}

// The text without blanks around it.
static const char *bare(const char *text, size_t *length) {
    text += strspn(text, blanks);
    *length = strlen(text);
    while (*length > 0 && strchr(blanks, text[*length - 1]) != NULL) {
        (*length)--;
    }
    return text;
}

bool text_length_mm(const char *text, int32_t *mm) {
    char number[32];
    size_t length = 0;
    size_t unit_length = 0;
    int64_t millionths = 0;
    const char *const given = bare(text, &length);
    const int32_t unit_mm = unit_of(given, length, &unit_length);
    if (unit_length == 0) {
        return text_number(text, mm);
    }
    const size_t sign = *given == '-' || *given == '+' ? 1 : 0;
    if (length < unit_length + sign || length - unit_length - sign >= sizeof number) {
        return false;
    }
    memcpy(number, given + sign, length - unit_length - sign);
    number[length - unit_length - sign] = '\0';
    if (!read_millionths(number, &millionths) || millionths > INT32_MAX / unit_mm * (int64_t)PARTS) {
        return false;
    }
    const int64_t rounded = (millionths * unit_mm + PARTS / 2) / PARTS;
    *mm = (int32_t)(*given == '-' ? -rounded : rounded);
    return true;
}

text_read_t text_read_line(FILE *const file, char *const line, const size_t capacity) {
    text_read_t result = TEXT_LINE;
    size_t length = 0;
    int byte = getc(file);
    if (byte == EOF) {
        return TEXT_END;
    }
    for (; byte != EOF && byte != '\n'; byte = getc(file)) {
        if (byte != '\0' && length + 1 < capacity) {
            line[length++] = (char)byte;
        } else if (result == TEXT_LINE) {
            result = byte == '\0' ? TEXT_NUL : TEXT_LONG;
        }
    }
    line[length] = '\0';
    return result;
}

void text_drop_mark(char *line) {
    static const char mark[] = "\xEF\xBB\xBF";
    if (strncmp(line, mark, sizeof mark - 1) == 0) {
        memmove(line, line + sizeof mark - 1, strlen(line) - (sizeof mark - 1) + 1);
    }
}
