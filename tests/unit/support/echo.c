// SPDX-License-Identifier: MIT
// Puts echoes into what is remembered, as a reading would or at a place.
#include "echo.h"

void see_echo(argus_echoes_t *echoes, argus_knowledge_t *knowledge, int sonar, int mm) {
    knowledge->sonar[sonar].reported = true;
    knowledge->sonar[sonar].reading_mm = (uint16_t)mm;
    knowledge->fresh = (argus_mask_t)(1u << sonar);
    argus_echoes_see(echoes, knowledge, knowledge->sip_ms);
}

void place_echo(argus_echoes_t *echoes, const argus_knowledge_t *knowledge, int x_mm, int y_mm) {
    echoes->at[echoes->count].x_mm = (int16_t)x_mm;
    echoes->at[echoes->count].y_mm = (int16_t)y_mm;
    echoes->at[echoes->count].seen_ms = knowledge->sip_ms;
    echoes->count++;
}
