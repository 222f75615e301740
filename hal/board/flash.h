// SPDX-License-Identifier: MIT
// The record store in the flash of a microcontroller: two slots that are erased alone and programmed by the
// word.
//
// A port gives the three functions below. A slot's header is programmed after its record. So a save that is
// cut leaves a slot that is not valid, and the other one as it was.
#ifndef BOARD_FLASH_H
#define BOARD_FLASH_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/store.h"

// Of the port, if it has a store. `offset` is from the start of the slot, a multiple of 4. The first two are
// true when what was done reads back as it should.
bool board_flash_erase(int slot);
bool board_flash_program(int slot, uint32_t offset, uint32_t word);
const uint8_t *board_flash_base(int slot); // where the slot can be read; NULL: there is none

hal_medium_t board_flash_medium(void);

#endif
