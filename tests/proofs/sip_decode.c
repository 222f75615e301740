// SPDX-License-Identifier: MIT
// Any packet is decoded as a SIP, or refused, without a byte outside of it being read or one outside of the
// result written.
// Bounds: packets of 1 to 253 bytes, any content: all that there are
// Sources: firmware/arcos/sip.c
// Unwind: 86
// Ci: yes
// Mutant: firmware/arcos/sip.c | tail_offset > packet->count | tail_offset > packet->count + 1u
// Mutant: firmware/arcos/sip.c | AFTER_SONAR(FAULTFLAGS) + 2 | AFTER_SONAR(FAULTFLAGS) + 1
#include "proof.h"

#include "arcos/sip.h"

void proof(void) {
    uint8_t count = nondet_u8();
    ASSUME(count >= 1 && count <= ARCOS_FRAME_COUNT_MAX - 2);
    uint8_t data[count]; // as long as it says: a byte more read is outside
    const argus_packet_t packet = {.data = data, .count = count};
    argus_sip_t sip;
    if (argus_sip_decode(&sip, &packet)) {
        PROVE(data[0] == ARCOS_TYPE_SIP_STATIONARY || data[0] == ARCOS_TYPE_SIP_MOVING, "a SIP");
        PROVE(sip.sonar_count <= ARGUS_SIP_SONARS_MAX, "no more than fit");
        PROVE((sip.bumpers_front & 1) == 0 && (sip.bumpers_rear & 1) == 0, "bit 0 is the stall's");
        PROVE(!sip.has_faultflags || sip.has_rotvel, "a tail has what comes before");
    }
}
