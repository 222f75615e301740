// SPDX-License-Identifier: MIT
// Puts echoes into what is remembered, as a reading would or at a place.
#ifndef TEST_ECHO_H
#define TEST_ECHO_H

#include "knowledge/echoes.h"

// One fresh reading of `sonar`, and no other.
void see_echo(argus_echoes_t *echoes, argus_knowledge_t *knowledge, int sonar, int mm);

// One more echo at a place of the course, seen now.
void place_echo(argus_echoes_t *echoes, const argus_knowledge_t *knowledge, int x_mm, int y_mm);

#endif
