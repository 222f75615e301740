// SPDX-License-Identifier: MIT
// The main task: a course of waypoints, and a way round what stands in it.
#ifndef ARGUS_TASK_H
#define ARGUS_TASK_H

#include "argus/argus.h"
#include "knowledge/echoes.h"
#include "knowledge/knowledge.h"

typedef struct {
    argus_point_t waypoint[ARGUS_WAYPOINTS_MAX];
    uint16_t count;
    uint16_t next;
    bool avoiding;
    int8_t side;       // +1 left, -1 right, 0 none chosen yet
    argus_point_t leg; // where the robot now heads for
    bool has_leg;
    int32_t refused_cdeg[8]; // headings found blocked in this place
    uint8_t refused;
    bool slanted; // into a wall beside it, on this heading: refused after waiting, too
    int32_t slanted_cdeg;
    argus_point_t refused_at;
} argus_task_t;

void argus_task_init(argus_task_t *self);
bool argus_task_set(argus_task_t *self, const argus_point_t *points, uint16_t count);

// Passes every waypoint that is near enough; true when the goal itself is reached. `passed` counts waypoints
// passed now.
bool argus_task_progress(argus_task_t *self, const argus_knowledge_t *knowledge, const argus_config_t *config,
                         int *passed);

int32_t argus_task_goal_mm(const argus_task_t *self, const argus_knowledge_t *knowledge);

// An object stopped the robot on its present heading: that heading is refused until the robot has moved on.
void argus_task_refuse(argus_task_t *self, const argus_knowledge_t *knowledge);

// A wall beside the robot, which only its flank hears, stopped it: waiting does not take that one away.
void argus_task_refuse_slant(argus_task_t *self, const argus_knowledge_t *knowledge);

// After waiting in one place: every heading may be tried again, but into such a wall while the flank reads
// near.
void argus_task_forgive(argus_task_t *self, const argus_knowledge_t *knowledge);

// Chooses the next leg: the waypoint itself when the way is free, else the nearest free heading. False: no
// way.
bool argus_task_choose(argus_task_t *self, const argus_knowledge_t *knowledge, const argus_echoes_t *echoes);

// Where the robot cannot turn: a leg straight ahead, if the corridor there is free. False: no way that way
// either.
bool argus_task_escape(argus_task_t *self, const argus_knowledge_t *knowledge, const argus_echoes_t *echoes);

// The course was left (operator, reconnect): the next leg is chosen anew.
void argus_task_restart(argus_task_t *self);

// Bearing and distance of the leg.
int32_t argus_task_bearing_cdeg(const argus_task_t *self, const argus_knowledge_t *knowledge);
int32_t argus_task_leg_mm(const argus_task_t *self, const argus_knowledge_t *knowledge);

#endif
