// SPDX-License-Identifier: MIT
// The stored record is the settings' part, then the manager's own.
#include "board/memory.h"

#include "board/board.h"
#include "board/config.h"
#include "board/flash.h"
#include "hal/crc32.h"

#define RECORD_MAX (BOARD_CONFIG_PACKED_MAX + ARGUS_RECORD_MAX)

_Static_assert(RECORD_MAX <= HAL_STORE_RECORD_MAX, "the store takes what a board remembers");

void board_memory_init(board_memory_t *self) {
    hal_store_init(&self->store, board_flash_medium());
    self->digest = 0;
}

// Passive unless the settings say otherwise: a real robot may be at the end of the line.
static bool set_built(argus_config_t *config) {
    unsigned line = 0;
    argus_config_default(config);
    config->active = 0;
    return board_config_ini(config, board_built_config, &line) == BOARD_CONFIG_TAKEN;
}

// Where the newest record lies in flash; NULL: `*found` says why there is none.
static const uint8_t *find(board_memory_t *self, size_t *count, hal_store_error_t *found) {
    int slot = 0;
    *found = hal_store_find(&self->store, &slot, count);
    return *found == HAL_STORE_OK ? board_flash_base(slot) + HAL_STORE_HEADER : NULL;
}

static board_settings_t set_stored(board_memory_t *self, argus_config_t *config) {
    size_t count = 0;
    hal_store_error_t found = HAL_STORE_OK;
    const uint8_t *const record = find(self, &count, &found);
    if (found == HAL_STORE_EMPTY || found == HAL_STORE_NO_PLACE) {
        return BOARD_SETTINGS_BUILT;
    }
    if (record == NULL) {
        return BOARD_SETTINGS_DAMAGED;
    }
    self->digest = hal_crc32(0, record, count);
    bool outdated = false;
    const size_t length = board_config_unpack(config, record, count, &outdated);
    if (outdated) {
        config->active = 0; // whose body it is, and whether it may drive, somebody must say anew
        return BOARD_SETTINGS_OUTDATED;
    }
    return length > 2 ? BOARD_SETTINGS_STORED : length == 2 ? BOARD_SETTINGS_BUILT : BOARD_SETTINGS_DAMAGED;
}

board_settings_t board_memory_settings(board_memory_t *self, argus_config_t *config) {
    const bool is_good = set_built(config);
    const board_settings_t from = set_stored(self, config);
    if (is_good && argus_config_check(config).fault == ARGUS_CONFIG_OK) {
        return from;
    }
    argus_config_default(config);
    config->active = 0;
    return BOARD_SETTINGS_REFUSED;
}

void board_memory_load(board_memory_t *self, argus_t *core) {
    size_t count = 0;
    hal_store_error_t found = HAL_STORE_OK;
    const uint8_t *const record = find(self, &count, &found);
    const size_t at = record == NULL ? 0 : board_config_length(record, count);
    if (at > 0 && at < count) {
        argus_record_load(core, record + at, count - at);
    }
}

static BOARD_APART size_t pack(const argus_config_t *config, uint8_t *record) {
    argus_config_t built;
    set_built(&built);
    return board_config_pack(&built, config, record);
}

BOARD_APART hal_store_error_t board_memory_save(board_memory_t *self, const argus_t *core,
                                                const argus_config_t *config) {
    uint8_t record[RECORD_MAX];
    const size_t at = pack(config, record);
    const size_t count = at + argus_record_save(core, record + at, sizeof record - at);
    const uint32_t digest = hal_crc32(0, record, count);
    if (digest == self->digest) {
        return HAL_STORE_EMPTY;
    }
    const hal_store_error_t saved = hal_store_save(&self->store, record, count);
    if (saved == HAL_STORE_OK) {
        self->digest = digest;
    }
    return saved;
}
