// SPDX-License-Identifier: MIT
// Takes a heading to return to, and drops it.
#include "adjustment/base.h"

void argus_base_renew(argus_base_t *const self, const int32_t heading_cdeg) {
    self->cdeg = heading_cdeg;
    self->taken = true;
}

void argus_base_take(argus_base_t *const self, const int32_t heading_cdeg) {
    if (!self->taken) {
        argus_base_renew(self, heading_cdeg);
    }
}

void argus_base_drop(argus_base_t *const self) {
    self->taken = false;
}
