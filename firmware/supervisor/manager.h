// SPDX-License-Identifier: MIT
// The whole state of the fault manager; what a port sees of it is argus/argus.h.
#ifndef ARGUS_MANAGER_H
#define ARGUS_MANAGER_H

#include "adjustment/drive.h"
#include "adjustment/motion.h"
#include "adjustment/plan.h"
#include "analysis/inquiry.h"
#include "analysis/verify.h"
#include "arcos/session.h"
#include "argus/argus.h"
#include "awareness/awareness.h"
#include "knowledge/knowledge.h"
#include "supervisor/config.h"
#include "supervisor/events.h"
#include "task/task.h"

// After an acquittal a sonar is not looked at again for a while.
typedef struct {
    uint32_t odometer_mm;
    uint8_t acquittals;
} argus_hold_t;

// An echo, course frame.
typedef struct {
    argus_point_t at;
    uint32_t t_ms;
    bool valid;
} argus_near_t;

struct argus {
    argus_config_t config;
    argus_session_t session;
    argus_knowledge_t knowledge;
    argus_awareness_t awareness;
    argus_verify_t verify;
    argus_evidence_t evidence; // profile argus
    argus_inquiry_t inquiry;
    argus_hold_t hold[ARGUS_SONARS];
    uint32_t looked_ms; // last active look
    uint32_t looked_odometer_mm;
    argus_mask_t pinned;   // sonars whose health an operator has fixed
    argus_mask_t recorded; // sonars on PROBATION by the record
    uint32_t
        robot;   // identity (analysis/record.h) of the robot, or of the record before a session; 0: unknown
    bool loaded; // a record was taken whose robot is not compared yet
    bool looked_once;
    argus_plan_t plan;
    bool ordered; // the sonars fire in an order of ours, in this session, begun anew at ordered_ms
    uint32_t ordered_ms;
    argus_motion_t motion;
    argus_drive_t drive;
    argus_task_t task;
    argus_events_t events;
    argus_mode_t mode;
    argus_wait_t wait;
    argus_mission_t mission;
    argus_failure_t failure;
    uint32_t now_ms;
    uint32_t since_ms;      // entry into the mode
    uint32_t check_ms;      // last health check while driving
    argus_wait_t wait_last; // what it waited for last, since it drove
    uint32_t wait_since_ms;
    uint32_t waited_s;  // waiting time said so far
    uint32_t tried_ms;  // last attempt to get out of WAITING
    uint32_t heeded_ms; // DRIVING: since then the robot has stood, one MOVE after the other
    uint32_t stops;     // STOP and E_STOP sent, monotonic
    argus_mark_t mark;  // CHECKING: readings after this count
    bool marked;
    uint8_t rounds;       // CHECKING: rounds of fresh readings still wanted
    bool all_round;       // ... of all sonars, for a turn, not only of those that look ahead
    int32_t base_cdeg;    // heading to return to after verification and sweeps (S4)
    int32_t jog_mm;       // the operator's step, 0: the course decides
    uint16_t bumpers;     // bumper bits answered already, front << 8 | rear
    uint8_t backed;       // back-offs in this place
    bool swing_again;     // an echo that forbade to turn has been waited out for a round
    argus_near_t near[2]; // the last echoes within the swing circle in a turn, right and left
    bool has_base;
    bool aimed;    // DRIVING: the leg's bearing was turned to
    bool arriving; // at the goal, stopping
    bool locked;   // the configuration is unsafe: never active
    bool barred;   // would be active, but not with this robot: unknown, or unsafe with these settings
    bool passive;
    bool paused;
    bool stay;    // after the operator's STOP: no turn either, until another order
    bool checked; // a full health check has passed since the session opened or resumed (S3, S6)
    bool motors_said;
    bool battery_said;
    bool stalled;
    bool stall_said;
    bool shutdown;
    uint8_t invariant_said;
};

// argus_init() in memory that is an argus_t already.
void argus_manager_init(argus_t *self, const argus_config_t *config, uint32_t now_ms);

#endif
