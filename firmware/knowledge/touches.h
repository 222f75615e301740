// SPDX-License-Identifier: MIT
// Places that the body has touched: they are there for sure, and stay so until the mission ends.
#ifndef ARGUS_TOUCHES_H
#define ARGUS_TOUCHES_H

#include "knowledge/knowledge.h"

#define ARGUS_TOUCHES_MAX 32

typedef struct {
    uint8_t count;
    argus_point_t at[ARGUS_TOUCHES_MAX]; // course frame
} argus_touches_t;

void argus_touches_init(argus_touches_t *self);

// One more; where there is no room for it, the farthest from it is forgotten.
void argus_touches_add(argus_touches_t *self, argus_point_t at);

// What of the body may touch something now, in the order of its numbers: front segments that are pressed; or
// the end that leads a way of `sign`, 1 ahead, -1 back; or, of a turn, its sides.
void argus_touches_bumped(argus_touches_t *self, const argus_knowledge_t *knowledge);
void argus_touches_end(argus_touches_t *self, const argus_knowledge_t *knowledge, int sign);
void argus_touches_sides(argus_touches_t *self, const argus_knowledge_t *knowledge);

// What touches the body at its ends now has gone.
void argus_touches_leave(argus_touches_t *self, const argus_knowledge_t *knowledge);

// How far before the body's end one lies in the way of the body, straight ahead (`sign` 1) or back (-1); 0:
// it is there. INT32_MAX: none.
int32_t argus_touches_before_mm(const argus_touches_t *self, const argus_knowledge_t *knowledge, int sign);

// How far from the robot's centre the first one is in a way of 2 x half_mm along a heading; INT32_MAX: none.
int32_t argus_touches_clear_mm(const argus_touches_t *self, const argus_knowledge_t *knowledge,
                               int32_t heading_cdeg, int32_t half_mm);

// Where one of them lies now, robot frame; 0 <= index < count.
argus_point_t argus_touches_seen(const argus_touches_t *self, const argus_knowledge_t *knowledge, int index);

// The distance of the nearest one to the robot's centre, were it `back_mm` farther back; INT32_MAX: none.
int32_t argus_touches_nearest_mm(const argus_touches_t *self, const argus_knowledge_t *knowledge,
                                 int32_t back_mm);

#endif
