// SPDX-License-Identifier: MIT
// What the sonars of a robot that turns on the spot give on one bearing of the world: the proof of a survey.
#ifndef ARGUSD_SURVEY_VIEWS_H
#define ARGUSD_SURVEY_VIEWS_H

#include "argus/argus.h"

#define SURVEY_HEADINGS 13

typedef struct {
    int headings;
    int16_t heading_deg[SURVEY_HEADINGS];
    uint16_t mm[SURVEY_HEADINGS][ARGUS_SONARS]; // ARGUS_NO_ECHO_MM: no echo; 0: no reading
} survey_views_t;

// Of one sonar: on how many headings others heard an echo on its bearing, and what it gave on those.
typedef struct {
    int compared;
    int agreed;
    int unheard; // no echo, where the others heard one
} survey_match_t;

// Notes the readings of one heading; `fresh`: the sonars that reported on it.
void survey_views_note(survey_views_t *self, int16_t heading_deg, const argus_status_t *status,
                       argus_mask_t fresh);

// `trusted`: the sonars that may bear witness.
survey_match_t survey_views_match(const survey_views_t *self, const argus_status_t *status, int sonar,
                                  argus_mask_t trusted);

// The fault that the comparison proves; ARGUS_KIND_NONE: none.
argus_fault_kind_t survey_proves(const survey_match_t *match);

#endif
