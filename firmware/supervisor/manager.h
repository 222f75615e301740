// SPDX-License-Identifier: MIT
// The loop of the fault manager, for code that has the memory of an argus_t already.
#ifndef ARGUS_MANAGER_H
#define ARGUS_MANAGER_H

#include "behaviour/core.h"

// argus_init() in memory that is an argus_t already.
void argus_manager_init(argus_t *self, const argus_config_t *config, uint32_t now_ms);

#endif
