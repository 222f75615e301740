// SPDX-License-Identifier: MIT
// The sonars' history over restarts: the manager's record in a file store.
#ifndef ARGUSD_STATE_H
#define ARGUSD_STATE_H

#include "argus/argus.h"
#include "hal/store.h"

typedef struct {
    bool on;
    hal_file_medium_t files;
    hal_store_t store;
    size_t length; // of the record saved last
    uint8_t record[HAL_STORE_RECORD_MAX];
} state_t;

// Loads the record into the manager. False: the place cannot be used, `message` says why. True with a message
// that is not empty: something was damaged and what could be used was.
bool state_open(state_t *self, const char *path, argus_t *core, char *message, size_t capacity);

// Saves when the record has changed. It waits for the disk: call it at rest. False: `message` says why.
bool state_save(state_t *self, const argus_t *core, char *message, size_t capacity);

#endif
