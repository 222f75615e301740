// SPDX-License-Identifier: MIT
// Plain CAN frames through a socket that outlives its interface: down, full, gone and back.
#ifndef HAL_CAN_RAW_H
#define HAL_CAN_RAW_H

#include <stdbool.h>

#include "hal/can_spec.h"
#include "hal/can_sys.h"

#define HAL_CAN_RAW_RETRY_MS 1000u // between two attempts to open the interface again
#define HAL_CAN_RAW_HOLD_MS 5u     // while its queue is full

typedef struct {
    const hal_can_sys_t *sys;
    int fd; // -1: none
    int index;
    uint16_t rx_id; // the one id that is received
    char interface[HAL_CAN_NAME_MAX];
    hal_link_error_t error; // why nothing can be sent, HAL_LINK_OK: nothing is known to be wrong
    uint32_t tried_ms;
    bool is_full;
    uint32_t sent; // monotonic counters
    uint32_t full; // refused because the interface's queue was full
    uint32_t failed;
    uint32_t bus_off; // reports of the controller
} hal_can_raw_t;

void hal_can_raw_init(hal_can_raw_t *self, const hal_can_sys_t *sys);

// HAL_LINK_NO_CAN and HAL_LINK_NO_PROTOCOL: the kernel lacks it or its module is not loaded.
hal_link_error_t hal_can_raw_open(hal_can_raw_t *self, const char *interface, uint16_t rx_id,
                                  uint32_t now_ms);

// True when the frame was taken; else it may be tried again after hal_can_raw_wait_ms().
bool hal_can_raw_send(hal_can_raw_t *self, uint16_t id, const uint8_t *data, uint8_t length, uint32_t now_ms);

// A frame with rx_id: its length 0..8; -1: none.
int hal_can_raw_receive(hal_can_raw_t *self, uint8_t data[8], uint32_t now_ms);

// Looks whether an interface that was lost is there again.
void hal_can_raw_process(hal_can_raw_t *self, uint32_t now_ms);

uint32_t hal_can_raw_wait_ms(const hal_can_raw_t *self, uint32_t now_ms); // 0: send now
int hal_can_raw_fd(const hal_can_raw_t *self);                            // to poll for reading
void hal_can_raw_close(hal_can_raw_t *self);

void hal_can_raw_explain(hal_link_error_t error, const char *interface, char *text, size_t capacity);

#endif
