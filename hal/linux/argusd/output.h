// SPDX-License-Identifier: MIT
// Lines to a reader that may be slow or gone: nothing here ever waits; what does not fit is dropped whole and
// counted.
#ifndef ARGUSD_OUTPUT_H
#define ARGUSD_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define OUTPUT_BACKLOG 65536

typedef struct {
    int fd;
    bool own; // fd is our own opening, non-blocking without touching what others share
    bool is_socket;
    bool is_file;     // never makes a writer wait
    bool broken;      // nothing can be written any more,
    int problem;      // ... for this errno
    uint32_t dropped; // lines, monotonic
    size_t used;
    char backlog[OUTPUT_BACKLOG];
} output_t;

void output_init(output_t *self, int fd);

// Takes a line (without its newline) whole, or drops it. Returns false when it was dropped.
bool output_line(output_t *self, const char *line, size_t length);

// Writes what can be written now.
void output_flush(output_t *self);

bool output_waits(const output_t *self); // there is a backlog: poll fd for POLLOUT
void output_close(output_t *self);

#endif
