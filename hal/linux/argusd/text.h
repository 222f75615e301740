// SPDX-License-Identifier: MIT
// Text in buffers of fixed size: appended, cut when full, always terminated.
#ifndef ARGUSD_TEXT_H
#define ARGUSD_TEXT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct {
    char *at;
    size_t capacity; // at least 1
    size_t length;
    bool cut; // something did not fit
} text_t;

text_t text_in(char *buffer, size_t capacity);
__attribute__((format(printf, 2, 3))) void text_add(text_t *self, const char *format, ...);
__attribute__((format(printf, 2, 0))) void text_add_list(text_t *self, const char *format, va_list arguments);

// Replaces the buffer's text; returns false, so that a failing function can end with it.
__attribute__((format(printf, 3, 4))) bool text_refuse(char *buffer, size_t capacity, const char *format,
                                                       ...);

// A whole decimal number, sign allowed, blanks around it allowed, nothing else; false when it is none or does
// not fit.
bool text_number(const char *text, int32_t *value);

// A length in mm: a whole number, or a decimal one with its unit, as 1500, 2m, 1.5m, -20cm or 300mm, rounded
// to whole mm; else as above.
bool text_length_mm(const char *text, int32_t *mm);

typedef enum { TEXT_LINE, TEXT_END, TEXT_LONG, TEXT_NUL } text_read_t;

// Reads a line of a file to its end, without that. Of one that is no text, or too long, it returns the first
// reason, and `line` has what fits.
text_read_t text_read_line(FILE *file, char *line, size_t capacity);

// A mark of UTF-8, as some editors write it at the beginning of a file, is none of its text.
void text_drop_mark(char *line);

#endif
