// SPDX-License-Identifier: MIT
// The main task: a course of waypoints, the way round what stands in it, and when to give it up.
#ifndef ARGUS_TASK_H
#define ARGUS_TASK_H

#include "argus/argus.h"
#include "knowledge/echoes.h"
#include "knowledge/knowledge.h"
#include "task/way.h"

// Progress is a way to go that is shorter than it ever was. It may grow when something is found in the way,
// but only so often.
typedef struct {
    int32_t least_mm;  // way to go since it has grown last, 0: not known yet
    uint32_t last_ms;  // the last SIP
    uint32_t vain_ms;  // driven, or waited for a way, without progress
    uint8_t set_backs; // the way to go has grown so often since the waypoint was made for
    uint8_t closed;    // the map has shown no way so often
} argus_progress_t;

typedef struct {
    uint16_t count;
    uint16_t next;
    bool avoiding; // the leg does not end at the waypoint
    bool has_leg;  // where the robot now heads for
    bool refused;  // something has stopped the robot on its way to this waypoint
    argus_leg_t leg;
    argus_progress_t progress;
    argus_point_t waypoint[ARGUS_WAYPOINTS_MAX];
    argus_search_t search;
} argus_task_t;

bool argus_task_set(argus_task_t *self, const argus_point_t *points, uint16_t count);

// Passes every waypoint that is near enough; true when the goal itself is reached. `passed` counts waypoints
// passed now.
bool argus_task_progress(argus_task_t *self, const argus_knowledge_t *knowledge, const argus_config_t *config,
                         int *passed);

// The robot has been moved away from its goal since, to make room for a turn: it is to go there again.
void argus_task_return(argus_task_t *self);

int32_t argus_task_goal_mm(const argus_task_t *self, const argus_knowledge_t *knowledge);

// Something stopped the robot: what is heard near, or the place just ahead where nothing is, is taken as
// occupied until beams pass there.
void argus_task_refuse(argus_task_t *self, const argus_knowledge_t *knowledge, argus_echoes_t *echoes);

// Chooses the next leg: the first straight part of the way to the waypoint. `stopped`: something is so near
// that the robot cannot go on ahead. There is a leg only when it is FOUND. Cost: argus_way_find().
argus_search_news_t argus_task_choose(argus_task_t *self, const argus_knowledge_t *knowledge,
                                      const argus_echoes_t *echoes, bool stopped);

// Where the robot cannot turn: a leg ahead, but for so much of a turn, if the corridor there is free. False:
// no way that way either.
bool argus_task_escape(argus_task_t *self, const argus_knowledge_t *knowledge, const argus_echoes_t *echoes,
                       int32_t by_cdeg);

// Gives up a leg that is done, or on which something is seen by now.
void argus_task_keep(argus_task_t *self, const argus_knowledge_t *knowledge, const argus_echoes_t *echoes);

// On each SIP: `drives`, or waits for a way or for room. True: the waypoint cannot be reached; 60 s without
// progress.
bool argus_task_is_hopeless(argus_task_t *self, const argus_knowledge_t *knowledge, bool drives);

// The course was left (operator, reconnect): the next leg is chosen anew.
void argus_task_restart(argus_task_t *self);

// Bearing and distance of the leg.
int32_t argus_task_bearing_cdeg(const argus_task_t *self, const argus_knowledge_t *knowledge);
int32_t argus_task_leg_mm(const argus_task_t *self, const argus_knowledge_t *knowledge);

#endif
