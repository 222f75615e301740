// SPDX-License-Identifier: MIT
// Hears frames of the other format: the kernel's ISO-TP passes over CAN FD frames on a link of classic ones,
// and the reverse, without a word.
#ifndef HAL_CAN_EAR_H
#define HAL_CAN_EAR_H

#include "hal/can_spec.h"
#include "hal/can_sys.h"

typedef struct {
    const hal_can_sys_t *sys;
    int fd;    // -1: closed
    int other; // bytes of a frame of the other format, as the socket gives it
} hal_can_ear_t;

void hal_can_ear_init(hal_can_ear_t *self, const hal_can_sys_t *sys);

// Without a socket to be had it hears nothing: the link is no worse for it.
void hal_can_ear_open(hal_can_ear_t *self, const hal_can_spec_t *spec, int index);

// Frames of the other format with the link's id since the last call.
uint32_t hal_can_ear_hear(hal_can_ear_t *self);

void hal_can_ear_close(hal_can_ear_t *self);

#endif
