// SPDX-License-Identifier: MIT
// Classes the failure over the forward-facing six (paper: Fig. 6).
#include "analysis/failure.h"

#include "knowledge/angle.h"

#define FORWARD_MASK 0x7Eu

argus_failure_t argus_failure_of(const uint16_t disabled) {
    static const argus_failure_t by_count[] = {ARGUS_IS_NORMAL,      ARGUS_IS_MINOR, ARGUS_IS_MINOR,
                                               ARGUS_IS_MAJOR,       ARGUS_IS_MAJOR, ARGUS_IS_MAJOR,
                                               ARGUS_IS_CATASTROPHIC};
    return by_count[argus_count_bits(disabled & FORWARD_MASK)];
}
