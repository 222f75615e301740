// SPDX-License-Identifier: MIT
// Holds the speed that a SIP shows against the order that was given last.
#include "guardian/heed.h"

#include "arcos/gen_arcos.h"

#define SIPS 3  // from an order to its effect, on a link that takes no time
#define SHARE 8 // an eighth more is how a robot keeps a speed

bool argus_heed_sip(argus_heed_t *const self, const int32_t given, const int32_t seen, const int32_t spare,
                    const int32_t falls, const int32_t late_ms) {
    const int32_t waits = SIPS + late_ms / ARCOS_TIMING_SIP_CYCLE_MS;
    if (seen <= given + given / SHARE + spare) {
        *self = (argus_heed_t){0};
        return false;
    }
    if (self->sips == 0) {
        self->from = seen;
    }
    self->sips++;
    if (self->sips <= waits && self->sips < UINT8_MAX) {
        return false;
    }
    const bool obeys = seen <= self->from - falls * (self->sips - 1);
    *self = (argus_heed_t){.from = seen, .sips = 1};
    return !obeys;
}
