// SPDX-License-Identifier: MIT
// The way to a waypoint over the grid: a wave from the waypoint to the robot, followed back, and its first
// straight part. What is too much for one SIP goes on with the next.
#ifndef ARGUS_WAY_H
#define ARGUS_WAY_H

#include "task/wave.h"

typedef struct {
    argus_point_t to;
    int32_t to_go_mm; // from its end to the waypoint, about
    bool direct;      // `to` is the waypoint
    bool narrow;      // there is no room to turn on all of it
} argus_leg_t;

// The way back along the wave.
typedef struct {
    argus_cell_t at;
    int32_t steps;  // of the wave, from there to the waypoint
    int32_t narrow; // samples that may be narrow on a straight line there
    bool wide_end;  // the robot can turn where the leg ends so far
    bool straight;  // the line to `at` will do
    bool first;     // the leg is so short yet that it would be done at once
} argus_pull_t;

typedef struct {
    bool stopped;
    bool is_on;
    bool is_there;       // the wave has come to the robot
    argus_point_t robot; // where it began
    argus_point_t waypoint;
    argus_pull_t pull;
    argus_leg_t leg; // found when the news says so
    int32_t work;    // in this SIP
    uint32_t sip;    // the last one that it went on in
    argus_wave_t wave;
} argus_search_t;

typedef enum { ARGUS_SEARCH_NO_WAY, ARGUS_SEARCH_FOUND, ARGUS_SEARCH_GOES_ON } argus_search_news_t;

// Looks for the first leg of the way. What is not known is free. A waypoint outside the window is made for
// from that cell of its border from which the whole way is shortest. GOES_ON: to be called on the next SIP
// again; a call for another waypoint, or after a SIP without one, begins anew. Cost: at most some 290,000
// instructions of a Cortex-M4 a call; a straight way takes one, most others two or three.
argus_search_news_t argus_way_find(argus_search_t *self, const argus_ground_t *ground,
                                   argus_point_t waypoint);

// Whether what is known by now leaves the next metre of a leg free. Cost: at most 11 places of 37 cells.
bool argus_way_is_free(const argus_ground_t *ground, const argus_leg_t *leg);

#endif
