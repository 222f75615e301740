// SPDX-License-Identifier: MIT
// Keeps the manager's record.
#include "state.h"

#include <string.h>

#include "text.h"

bool state_open(state_t *self, const char *path, argus_t *core, char *message, size_t capacity) {
    memset(self, 0, sizeof *self);
    message[0] = '\0';
    if (!hal_file_medium_init(&self->files, path)) {
        return text_refuse(message, capacity, "--state: the path is empty or longer than %d characters",
                           HAL_STORE_PATH_MAX - 1);
    }
    hal_store_init(&self->store, hal_file_medium(&self->files));
    const hal_store_error_t found =
        hal_store_load(&self->store, self->record, sizeof self->record, &self->length);
    if (found == HAL_STORE_DAMAGED) {
        text_refuse(message, capacity, "%s.a and %s.b are damaged: the history begins anew", path, path);
    } else if (found != HAL_STORE_OK && found != HAL_STORE_EMPTY) {
        return text_refuse(message, capacity, "--state %s: %s; give a file in a folder that can be written",
                           path, hal_file_error_text(found));
    } else if (self->store.damaged[0] || self->store.damaged[1]) {
        text_refuse(message, capacity, "%s.%c is damaged: the other copy is used", path,
                    self->store.damaged[0] ? 'a' : 'b');
    }
    if (found == HAL_STORE_OK) {
        argus_record_load(core, self->record, self->length);
    }
    self->on = true;
    return true;
}

bool state_save(state_t *self, const argus_t *core, char *message, size_t capacity) {
    uint8_t record[HAL_STORE_RECORD_MAX];
    if (!self->on) {
        return true;
    }
    const size_t length = argus_record_save(core, record, sizeof record);
    if (length == 0 || (length == self->length && memcmp(record, self->record, length) == 0)) {
        return true;
    }
    const hal_store_error_t saved = hal_store_save(&self->store, record, length);
    if (saved != HAL_STORE_OK) {
        return text_refuse(message, capacity, "--state %s: not saved: %s", self->files.path,
                           hal_file_error_text(saved));
    }
    memcpy(self->record, record, length);
    self->length = length;
    return true;
}
