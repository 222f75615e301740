// SPDX-License-Identifier: MIT
// The ring of a survey as an SVG: the robot from above, each sonar in the colour of its verdict.
#ifndef ARGUSD_SURVEY_PICTURE_H
#define ARGUSD_SURVEY_PICTURE_H

#include <stdio.h>

typedef enum { SURVEY_HEALTHY, SURVEY_OPEN, SURVEY_SUSPECT, SURVEY_BROKEN, SURVEY_STATES } survey_state_t;

// One sonar, as its row in the table.
typedef struct {
    int number;
    int bearing_deg;
    survey_state_t state;
    const char *verdict;
    const char *sure;
} survey_mark_t;

// `summary` stands below the title. What it holds is plain ASCII without < and &.
void survey_picture_put(FILE *out, const survey_mark_t *marks, int count, const char *summary);

#endif
