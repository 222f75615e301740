// SPDX-License-Identifier: MIT
// argusd's recording.
#include "tape.h"

#include <errno.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "argusd.h"
#include "claim.h"
#include "text.h"

static const char *advice(int problem) {
    switch (problem) {
    case EEXIST:
        return "it exists and is no recording; name another file";
    case EINVAL:
        return "it is no regular file; name another";
    case ENAMETOOLONG:
        return "the path is empty or too long; name another";
    default:
        return NULL;
    }
}

bool tape_open(tape_t *self, const char *path, const char *link, uint64_t max_bytes, char *message,
               size_t capacity) {
    char source[HAL_RECORDER_SOURCE_MAX];
    signal(SIGXFSZ, SIG_IGN); // a file that may not grow is like a full disk, no reason to die
    snprintf(source, sizeof source, "argusd %s %s", ARGUS_VERSION, link);
    self->on = false;
    self->said = false;
    int problem = hal_recorder_open(&self->recorder, path, source, max_bytes > 0 ? max_bytes : TAPE_MAX_BYTES,
                                    hal_recorder_ops());
    if (problem == 0) {
        problem = hal_recorder_start(&self->recorder);
    }
    if (problem == EBUSY) {
        char who[ARGUSD_MESSAGE_MAX / 4];
        claim_holder(path, who, sizeof who);
        hal_recorder_close(&self->recorder);
        return text_refuse(message, capacity, "--record %s: %s records there; name another file", path, who);
    }
    if (problem != 0) {
        const char *const known = advice(problem);
        hal_recorder_close(&self->recorder);
        return known != NULL ? text_refuse(message, capacity, "--record %s: %s", path, known)
                             : text_refuse(message, capacity,
                                           "--record %s: %s; give a file in a folder that can be written",
                                           path, strerror(problem));
    }
    self->on = true;
    return true;
}

static void see(void *context, bool from_robot, const uint8_t *bytes, size_t count) {
    tape_t *const self = context;
    hal_recorder_note(&self->recorder, from_robot ? HAL_RECORD_FROM_ROBOT : HAL_RECORD_TO_ROBOT, bytes,
                      count);
}

driver_tap_t tape_tap(tape_t *self) {
    return self->on ? (driver_tap_t){.see = see, .context = self} : (driver_tap_t){0};
}

void tape_injected(tape_t *self, int sonar, argus_fault_kind_t kind, uint32_t for_ms) {
    const uint8_t bytes[] = {(uint8_t)sonar,           (uint8_t)kind,
                             (uint8_t)(for_ms & 0xFF), (uint8_t)(for_ms >> 8 & 0xFF),
                             (uint8_t)(for_ms >> 16),  (uint8_t)(for_ms >> 24)};
    if (self->on) {
        hal_recorder_note(&self->recorder, HAL_RECORD_INJECTED, bytes, sizeof bytes);
    }
}

bool tape_problem(tape_t *self, char *message, size_t capacity) {
    const int problem = self->on ? atomic_load(&self->recorder.problem) : 0;
    if (problem == 0 || self->said) {
        return false;
    }
    self->said = true;
    text_refuse(message, capacity, "--record %s: %s; going on without, until there is room again",
                self->recorder.path, strerror(problem));
    return true;
}

bool tape_close(tape_t *self, char *message, size_t capacity) {
    if (!self->on) {
        return false;
    }
    self->on = false;
    hal_recorder_close(&self->recorder);
    const uint32_t held = atomic_load(&self->recorder.head) - atomic_load(&self->recorder.tail);
    if (self->recorder.lost == 0 && held == 0 && self->recorder.block_used == 0) {
        return false;
    }
    text_refuse(message, capacity,
                "--record %s: the disk did not take everything, %" PRIu64 " bytes are missing",
                self->recorder.path, self->recorder.lost + held + self->recorder.block_used);
    return true;
}
