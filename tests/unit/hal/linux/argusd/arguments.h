// SPDX-License-Identifier: MIT
// A command line of argusd in a test, from one text.
#ifndef TEST_ARGUMENTS_H
#define TEST_ARGUMENTS_H

#include <stdio.h>
#include <string.h>

#define ARGUMENTS_MAX 24

// Words of `line` are separated by single blanks. They stay until the next call. Returns argc.
static int arguments_of(const char *line, char *argv[ARGUMENTS_MAX]) {
    static char copy[1024];
    static char program[] = "argusd";
    int argc = 1;
    argv[0] = program;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word != NULL && argc < ARGUMENTS_MAX - 1; word = strtok(NULL, " ")) {
        argv[argc++] = word;
    }
    argv[argc] = NULL;
    return argc;
}

#endif
