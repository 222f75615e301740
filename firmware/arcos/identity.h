// SPDX-License-Identifier: MIT
// Which robot answers: the one of the session before, or another one behind the same wire.
#ifndef ARGUS_IDENTITY_H
#define ARGUS_IDENTITY_H

#include <stdbool.h>
#include <stdint.h>

// What a robot is known by, each as a hash (FNV-1a); the texts themselves are the session's.
typedef enum {
    ARGUS_IDENTITY_NAME,
    ARGUS_IDENTITY_CLASS,
    ARGUS_IDENTITY_SUBCLASS,
    ARGUS_IDENTITY_SERIAL, // of CONFIGpac; not every robot has one
    ARGUS_IDENTITY_PARTS
} argus_identity_part_t;

typedef struct {
    uint32_t part[ARGUS_IDENTITY_PARTS]; // 0: not given
    bool met;
} argus_identity_t;

// Takes what the robot that answers says of itself, NULL or "" for nothing. Returns the number, from 1, of
// the first part that differs from the robot met before; 0 for the same or the first robot. A serial number
// counts only when both have given one. Cost: one pass over the texts.
int argus_identity_meet(argus_identity_t *self, const char *const texts[ARGUS_IDENTITY_PARTS]);

#endif
