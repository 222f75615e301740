// SPDX-License-Identifier: MIT
// Keeps what argus/argus.h promises of memory and bounds.
#include "analysis/record.h"
#include "supervisor/manager.h"

_Static_assert(sizeof(argus_t) <= sizeof(argus_storage_t), "ARGUS_STORAGE_BYTES is too small for argus_t");
_Static_assert(_Alignof(argus_t) <= _Alignof(argus_storage_t), "argus_storage_t is aligned too loosely");
_Static_assert(ARGUS_RECORD_BYTES <= ARGUS_RECORD_MAX, "ARGUS_RECORD_MAX is too small");
_Static_assert(ARCOS_FRAME_SEND_TOTAL_MAX == ARGUS_PACKET_MAX, "ARGUS_PACKET_MAX is not that of ARCOS");

argus_t *argus_init(argus_storage_t *const storage, const argus_config_t *const config,
                    const uint32_t now_ms) {
    argus_t *const self = (argus_t *)storage;
    ARGUS_ASSERT(storage != NULL && config != NULL);
    argus_manager_init(self, config, now_ms);
    return self;
}
