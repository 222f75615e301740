// SPDX-License-Identifier: MIT
// Whatever a client sends, its command is read within its bytes; a number that passes is one that a robot
// takes.
// Bounds: packets of 1 to 253 bytes, any content: all that there are
// Sources: firmware/guardian/admit.c
// Unwind: 60
// Ci: yes
// Mutant: firmware/guardian/admit.c | index < packet->count ? | index <= packet->count ?
// Mutant: firmware/guardian/admit.c | form == ARGUS_FORM_WORD || magnitude <= INT_MOST | form == ARGUS_FORM_INT || magnitude <= INT_MOST
#include "proof.h"

#include "guardian/admit.h"

void proof(void) {
    const uint8_t count = nondet_u8();
    ASSUME(count >= 1 && count <= ARCOS_FRAME_COUNT_MAX - 2);
    uint8_t data[count];
    const argus_packet_t packet = {.data = data, .count = count};
    argus_said_t said;
    const bool passed = argus_admit(&packet, &said);
    PROVE(passed == (said.topic != ARGUS_TOPIC_REFUSED), "refused or not");
    PROVE(said.command == data[0], "the command");
    PROVE(!passed || (said.argument >= -65535 && said.argument <= 65535), "16 bits at most");
    const bool moves = said.topic == ARGUS_TOPIC_WAY || said.topic == ARGUS_TOPIC_TURN;
    PROVE(!moves || (said.argument >= -32767 && said.argument <= 32767), "15 bits and a sign");
}
