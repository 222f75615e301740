// SPDX-License-Identifier: MIT
// Echoes of the last minute as points of the course frame: what stands about the robot, also where no sonar
// looks now.
#ifndef ARGUS_ECHOES_H
#define ARGUS_ECHOES_H

#include "knowledge/grid.h"
#include "knowledge/knowledge.h"
#include "knowledge/touches.h"

#define ARGUS_POINTS_MAX 128
#define ARGUS_FORGET_MS 60000u // what was heard twice is remembered so long

// Echoes seen lately, course frame: what the way round an obstacle is planned from.
typedef struct {
    int16_t x_mm;
    int16_t y_mm;
    uint8_t sonar;
    bool again;  // by two echoes at least: one may be crosstalk
    bool stands; // likewise, and no sonar has heard past it since
    uint32_t seen_ms;
} argus_echo_t;

typedef struct {
    uint16_t count;
    uint16_t next; // oldest, once full
    argus_echo_t at[ARGUS_POINTS_MAX];
    argus_grid_t grid;
    argus_touches_t touches;
} argus_echoes_t;

// What the body did when it met something.
typedef enum {
    ARGUS_CONTACT_NONE,
    ARGUS_CONTACT_BUMPER, // the segments tell where it is
    ARGUS_CONTACT_AHEAD,  // it came to a stand on its way ahead,
    ARGUS_CONTACT_BACK,   // ... back,
    ARGUS_CONTACT_TURN,   // ... or in a turn
    ARGUS_CONTACT_GONE    // a bumper is free again, and it is not the robot that has moved away
} argus_contact_t;

void argus_echoes_init(argus_echoes_t *self);

// Remembers the fresh echoes of sonars not DISABLED and no suspects; forgets those of a sonar that is out,
// where it has told what was not there. Marks what the body met, which stays; or a place in the course frame
// where something is, however it was found.
void argus_echoes_see(argus_echoes_t *self, const argus_knowledge_t *knowledge, uint32_t now_ms);
void argus_echoes_forget(argus_echoes_t *self, int sonar, bool lied);
void argus_echoes_met(argus_echoes_t *self, const argus_knowledge_t *knowledge, argus_contact_t how);
void argus_echoes_touched(argus_echoes_t *self, argus_point_t at, uint32_t now_ms);

// Length of the corridor of 2 x half_mm that is free of remembered echoes along a heading; INT32_MAX without
// any.
int32_t argus_echoes_clear_mm(const argus_echoes_t *self, const argus_knowledge_t *knowledge,
                              int32_t heading_cdeg, int32_t half_mm);

// Whether two echoes may be of one thing: at most 150 mm apart along x and along y.
bool argus_are_one_thing(argus_point_t a, argus_point_t b);

// Whether an echo there, course frame, would be the second one of a thing. Both lie `within_mm` of the
// robot's centre. The first one is of the last 5 s and at most 150 mm from there. Or two echoes of the last
// minute lie at most 80 mm from there. Cost: one pass over the points.
bool argus_echoes_have_seen(const argus_echoes_t *self, const argus_knowledge_t *knowledge, argus_point_t at,
                            int32_t within_mm);

// Where the robot stands now: worked out once for all echoes.
typedef struct {
    argus_frame_t robot;
    const argus_knowledge_t *knowledge;
} argus_view_t;
argus_view_t argus_view(const argus_knowledge_t *knowledge);

// Whether this one was seen more than once, lately and near the robot; where, robot frame. 0 <= index <
// count. `beside`, what a turn is asked of: also one of the last minute that no sonar has heard past since.
// What stands between two cones does not go away because none looks there. `stands`, what the body itself is
// asked of: such a one wherever it lies, as the sonar that looks there may be out.
bool argus_echoes_near(const argus_echoes_t *self, const argus_view_t *from, int index, argus_point_t *at);
bool argus_echoes_beside(const argus_echoes_t *self, const argus_view_t *from, int index, argus_point_t *at);
bool argus_echoes_stands(const argus_echoes_t *self, const argus_view_t *from, int index, argus_point_t *at);

// The distance of what would be nearest to the robot's centre, were it `back_mm` farther back. What was seen
// more than once in the last seconds counts, also where no sonar sees it now. INT32_MAX: nothing. Cost: one
// pass over the points.
int32_t argus_echoes_nearest_mm(const argus_echoes_t *self, const argus_knowledge_t *knowledge,
                                int32_t back_mm);

// How far ahead of the robot's centre the first of them lies in a straight way of 2 x half_mm. INT32_MAX:
// none. Cost: one pass over the points.
int32_t argus_echoes_ahead_mm(const argus_echoes_t *self, const argus_knowledge_t *knowledge,
                              int32_t half_mm);

#endif
