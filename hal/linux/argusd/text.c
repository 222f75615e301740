// SPDX-License-Identifier: MIT
// Text in buffers of fixed size.
#include "text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    if (end[strspn(end, " \t\r\n")] != '\0') {
        return false;
    }
    *value = (int32_t)number;
    return true;
}
