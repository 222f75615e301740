// SPDX-License-Identifier: MIT
// What a board remembers over restarts: settings that differ from those compiled in, and what is known of the
// sonars.
#ifndef BOARD_MEMORY_H
#define BOARD_MEMORY_H

#include "argus/argus.h"
#include "hal/store.h"

// The settings compiled in, as an INI text; the build makes it (ARGUS_CONFIG).
extern const char board_built_config[];

typedef struct {
    hal_store_t store;
    uint32_t digest; // of what is stored
} board_memory_t;

// Where the settings are from.
typedef enum {
    BOARD_SETTINGS_BUILT,
    BOARD_SETTINGS_STORED,
    BOARD_SETTINGS_DAMAGED,  // what was stored is of no use: those compiled in are taken
    BOARD_SETTINGS_OUTDATED, // what was stored means nothing to this build: those compiled in, and passive
    BOARD_SETTINGS_REFUSED   // they are unsafe, or the text compiled in is wrong: defaults, and passive
} board_settings_t;

void board_memory_init(board_memory_t *self);
board_settings_t board_memory_settings(board_memory_t *self, argus_config_t *config);
void board_memory_load(board_memory_t *self, argus_t *core);

// Saves what is new, which may take half a second: at rest only. HAL_STORE_EMPTY: there was nothing new.
hal_store_error_t board_memory_save(board_memory_t *self, const argus_t *core, const argus_config_t *config);

#endif
