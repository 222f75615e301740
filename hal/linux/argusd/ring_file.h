// SPDX-License-Identifier: MIT
// A ring and a body out of a TOML file, as hil_sim/tables/robots has them (docs/ring.md).
#ifndef ARGUSD_RING_FILE_H
#define ARGUSD_RING_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "argus/argus.h"

enum {
#define RING_FILE_ROW(key, section, def, min, max, meaning) RING_FILE_##key,
    ARGUS_RING_TABLE(RING_FILE_ROW)
#undef RING_FILE_ROW
        RING_FILE_FIGURES
};

typedef struct {
    argus_ring_t ring;
    char name[ARGUS_NAME_MAX];
    argus_sonar_mount_t mounts[ARGUS_SONARS];
    unsigned given[ARGUS_SONARS]; // of each sonar's keys
    int line[RING_FILE_FIGURES];  // where each stands; 0: in no file, or in one that is inherited
    int pose_line[ARGUS_SONARS];
    int forward_line;
} ring_file_t;

// False: `message` is FILE:LINE: what is wrong. `self->ring` points into `self`. Of TOML it takes comments,
// sections, whole numbers, decimals, plain strings and lists; argus-log ring --whole writes any other so.
bool ring_file_load(ring_file_t *self, const char *path, char *message, size_t capacity);

// Says what argus_set_ring() found in it.
void ring_file_explain(const ring_file_t *self, const char *path, argus_ring_report_t report, char *message,
                       size_t capacity);

#endif
