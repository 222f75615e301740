// SPDX-License-Identifier: MIT
// Any short packet is decoded as a CONFIGpac, or refused, within its bytes, wherever its texts are cut.
// Bounds: packets of 0 to 12 bytes, any content: no text behind the third is whole then
// Sources: firmware/arcos/configpac.c
// Unwind: 14
// Ci: yes
// Mutant: firmware/arcos/configpac.c | packet->count == 0 || packet->data[0] | packet->data[0]
#include "proof.h"

#include "arcos/configpac.h"

void proof(void) {
    const uint8_t count = nondet_u8();
    ASSUME(count <= 12);
    uint8_t data[count];
    const argus_packet_t packet = {.data = data, .count = count};
    argus_configpac_t config;
    if (argus_configpac_decode(&config, &packet)) {
        PROVE(count >= 4 && data[0] == ARCOS_TYPE_CONFIGPAC, "its type, and three texts");
        PROVE(config.name[0] == 0 && config.watchdog_ms == 0, "nothing beyond the packet");
    }
}
