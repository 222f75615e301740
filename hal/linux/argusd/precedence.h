// SPDX-License-Identifier: MIT
// --realtime: before all other programs on a busy machine, in memory that stays there, on chosen processors.
#ifndef ARGUSD_PRECEDENCE_H
#define ARGUSD_PRECEDENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PRECEDENCE_CPUS 64 // processors that can be chosen, from 0
#define PRECEDENCE_PRIORITY 40

typedef struct {
    bool on;
    int32_t priority; // of SCHED_FIFO, 1..99; 0: PRECEDENCE_PRIORITY
    uint64_t cpus;    // a mask; 0: any
} precedence_options_t;

// What the system has granted.
typedef struct {
    bool asked;
    int32_t priority; // 0: none
    bool locked;
    uint64_t cpus; // on which it may run, of the first PRECEDENCE_CPUS
} precedence_t;

// "1", "0,2-3"; false: it is none.
bool precedence_parse_cpus(const char *text, uint64_t *cpus);

// Takes what is granted of what is asked for. `message`: what is missing and how to grant it; "": nothing.
// Processors that there are not are an error of the caller: false.
bool precedence_take(const precedence_options_t *options, precedence_t *granted, char *message,
                     size_t capacity);

// As "SCHED_FIFO 40, memory locked, processors 0-1".
void precedence_describe(const precedence_t *granted, char *text, size_t capacity);

#endif
