// SPDX-License-Identifier: MIT
// A name on disk belongs to one living program: a lock beside it, NAME.lock, which dies with its holder.
#ifndef ARGUSD_CLAIM_H
#define ARGUSD_CLAIM_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

// All zero: nothing is claimed.
typedef struct {
    bool held;
    int fd;
    char lock[PATH_MAX];
} claim_t;

// Until it is released, or this process is dead. False: `message` says who has it. `option`: as "--state".
bool claim_take(claim_t *self, const char *option, const char *path, char *message, size_t capacity);

void claim_release(claim_t *self);

// Which program holds the lock of this file, as far as the system tells: "argusd, process 42".
void claim_holder(const char *path, char *text, size_t capacity);

#endif
