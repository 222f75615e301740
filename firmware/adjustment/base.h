// SPDX-License-Identifier: MIT
// The heading to return to after verification and sweeps (S4); base.c is its only writer.
#ifndef ARGUS_BASE_H
#define ARGUS_BASE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int32_t cdeg;
    bool taken;
} argus_base_t;

// A heading becomes the base: unless there is one, or whatever there is.
void argus_base_take(argus_base_t *self, int32_t heading_cdeg);
void argus_base_renew(argus_base_t *self, int32_t heading_cdeg);

void argus_base_drop(argus_base_t *self);

#endif
