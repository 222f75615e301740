// SPDX-License-Identifier: MIT
// The fields behind the name are read within a packet of any length, and read as 0 where it is cut before
// them.
// Bounds: packets of up to 100 bytes, any content; any place of the fields up to 100; the version is not read here
// Unwind: 102
// Ci: yes
// Mutant: firmware/arcos/configpac.c | at + 1 < packet->count ? | at < packet->count ?
#include "proof.h"

#include "arcos/configpac.c"

void proof(void) {
    const uint8_t count = nondet_u8();
    ASSUME(count <= 100);
    uint8_t data[count];
    const argus_packet_t packet = {.data = data, .count = count};
    const size_t from = nondet_size();
    ASSUME(from <= 100);
    ASSUME(from + VERSION >= count); // the text is packet_string.c's
    argus_configpac_t config;
    take_rest(&config, &packet, from);
    PROVE(from + WATCHDOG + 1 < count || config.watchdog_ms == 0, "0 where there is none");
    PROVE(from + TRANSDECEL + 1 < count || config.decel_mm_s2 == 0, "0 where there is none");
    PROVE(from + SONARCYCLE < count || config.sonar_cycle_ms == 0, "0 where there is none");
}
