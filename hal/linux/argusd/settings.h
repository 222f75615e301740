// SPDX-License-Identifier: MIT
// The config file: every key of the firmware's table, checked for name, form and range, with the line named.
#ifndef ARGUSD_SETTINGS_H
#define ARGUSD_SETTINGS_H

#include <stdbool.h>
#include <stdio.h>

#include "argus/argus.h"

enum {
#define SETTINGS_ROW(key, def, min, max, unit, choices, meaning) SETTINGS_##key,
    ARGUS_CONFIG_TABLE(SETTINGS_ROW)
#undef SETTINGS_ROW
        SETTINGS_COUNT
};

typedef struct {
    argus_config_t config;
    int line[SETTINGS_COUNT]; // where a key was given; 0: it has its default
} settings_t;

void settings_default(settings_t *self);

// Reads an INI file over the defaults. False: `message` is FILE:LINE: what is wrong, what to do.
bool settings_read(settings_t *self, FILE *file, const char *path, char *message, size_t capacity);
bool settings_load(settings_t *self, const char *path, char *message, size_t capacity);

// Sets what is picked by name from the command line. False: `message` names `option` and the choices.
bool settings_choose(settings_t *self, int row, const char *text, const char *option, char *message,
                     size_t capacity);

// The firmware's verdict, with S5's arithmetic when it refuses.
bool settings_check(const settings_t *self, char *message, size_t capacity);

// The ranges alone: S5 is asked when the body is known.
bool settings_check_ranges(const settings_t *self, char *message, size_t capacity);

void settings_list(FILE *out);
void settings_example(FILE *out);

#endif
