// SPDX-License-Identifier: MIT
// Does the robot do what it was given last? A speed above it that does not fall is an order that got lost.
#ifndef ARGUS_HEED_H
#define ARGUS_HEED_H

#include <stdbool.h>
#include <stdint.h>

// All zero: nothing seen yet. One for the way in mm/s, one for the turn in deg/s.
typedef struct {
    int32_t from; // the speed as it was first seen above what was given
    uint8_t sips; // in a row since
} argus_heed_t;

// With each SIP: the speed that was given, the one seen, by how much more is none, and by how much it falls
// at least with each SIP where the robot obeys. Both speeds without sign. `late_ms`: the link's. True: the
// order is to be given again.
bool argus_heed_sip(argus_heed_t *self, int32_t given, int32_t seen, int32_t spare, int32_t falls,
                    int32_t late_ms);

#endif
