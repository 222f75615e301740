// SPDX-License-Identifier: MIT
// The whole state of the fault manager; what a port sees of it is argus/argus.h.
#ifndef ARGUS_CORE_H
#define ARGUS_CORE_H

#include "adjustment/base.h"
#include "adjustment/drive.h"
#include "adjustment/firing.h"
#include "adjustment/guard.h"
#include "adjustment/motion.h"
#include "adjustment/pace.h"
#include "adjustment/plan.h"
#include "adjustment/trim.h"
#include "adjustment/weave.h"
#include "analysis/inquiry.h"
#include "analysis/looked.h"
#include "analysis/verify.h"
#include "arcos/session.h"
#include "argus/argus.h"
#include "awareness/alarms.h"
#include "awareness/common.h"
#include "awareness/extremes.h"
#include "knowledge/bend.h"
#include "knowledge/config.h"
#include "knowledge/events.h"
#include "knowledge/knowledge.h"
#include "knowledge/latency.h"
#include "knowledge/profile.h"
#include "knowledge/rays.h"
#include "knowledge/slip.h"
#include "paper/algorithm1.h"
#include "task/task.h"

// CHECKING.
typedef struct {
    argus_mark_t mark; // readings after this count
    bool marked;
    uint8_t rounds; // of fresh readings still wanted
    bool all_round; // ... of all sonars, for a turn, not only of those that look ahead
} argus_checking_t;

// VERIFYING: by Algorithm 2, or by looks.
typedef struct {
    argus_verify_t verify;
    argus_inquiry_t inquiry;
} argus_verifying_t;

// DRIVING, SWEEPING, STEPPING and CREEPING: the course and the way along it.
typedef struct {
    argus_weave_t weave; // while a bearing is blind
    bool aimed;          // the leg's bearing was turned to
    bool stopped_short;  // on the way, which was not seen far enough
    bool arriving;       // at the goal, stopping
    bool swept;          // the end of this sweep is said
    uint16_t unsaid;     // waypoints passed and not said
    int32_t jog_mm;      // the operator's step, 0: the course decides
    uint32_t heeded_ms;  // since then the robot has stood, one MOVE after the other
    uint32_t beside_sip; // the SIP in which the health check beside the task was made
    argus_drive_t drive; // the sweep
    argus_task_t task;
} argus_travel_t;

// WAITING; what it waited for last counts on until the robot has driven.
typedef struct {
    argus_wait_t why;
    argus_wait_t last;
    uint32_t since_ms;
    uint32_t said_s;   // waiting time said so far
    uint32_t tried_ms; // last attempt to get out
} argus_waiting_t;

// Attempts to turn in this place.
typedef struct {
    uint8_t backed; // back-offs
    bool again;     // an echo that forbade to turn has been waited out for a round
} argus_turning_t;

// An echo within the swing circle, course frame.
typedef struct {
    argus_point_t at;
    uint32_t t_ms;
    bool valid;
} argus_near_t;

// What the reflexes remember.
typedef struct {
    uint8_t unsound;      // leaps and slips of the odometry, one soon after the other
    uint8_t battery_low;  // SIPs in a row
    uint8_t battery_odd;  // likewise: a voltage that no battery of a robot has
    bool touched_unheard; // by the end that leads, while no sonar ahead had heard an echo: they do not live
    bool motors_said;     // off
    uint32_t active_ms;   // when an operator made it active, which switches the motors on
    bool battery_said;
    uint8_t stalls;   // wheels that stalled in the last SIP
    uint16_t bumpers; // bumper bits answered already, front << 8 | rear
    uint32_t bumped_odometer_mm;
    uint32_t leaps;       // of the odometry, answered already
    uint32_t unseen;      // ... of these, where its place is lost
    uint32_t slips;       // likewise
    uint32_t unsound_ms;  // a leap or slip of the odometry, the last one
    argus_near_t near[2]; // the last echoes within the swing circle in a turn, right and left
} argus_reflexes_t;

#define ARGUS_STAY_OPERATOR 1u // also against a client of a guard port
#define ARGUS_STAY_CLIENT 2u   // until it drives
#define ARGUS_STAY_HELD \
    4u // a client alone: an operator stopped the robot, and has ordered something else since

// What operators and the configuration have settled.
typedef struct {
    argus_mask_t pinned; // sonars with a health that an operator has fixed
    bool locked;         // the configuration is unsafe: never active
    bool barred;         // would be active, but not with this robot
    bool unbegun;        // the course failed for that
    bool mended;         // a setting was out of its range: locked whatever the robot is
    argus_bar_t bar;     // why this robot may not be driven
    bool passive;
    bool paused;
    uint8_t stay; // after a STOP: no turn either, until another order; by whom and whom, ARGUS_STAY_
    bool shutdown;
} argus_orders_t;

// The record of earlier missions.
typedef struct {
    uint32_t
        robot; // identity (analysis/record.h) of the robot, or of the record before a session; 0: unknown
    argus_mask_t recorded; // sonars on PROBATION by the record
    bool loaded;           // a record was taken, its robot is not compared yet
} argus_history_t;

// What is small and asked for everywhere comes first: Cortex-M reaches 4 KB from a pointer in one
// instruction.
struct argus {
    const argus_profile_t *rules; // of the configuration
    argus_mission_t mission;
    argus_mode_t mode;
    bool stalled; // the link: no SIPs for a while
    bool checked; // a full health check has passed since the session opened or resumed (S6)
    uint8_t invariant_said;
    argus_turning_t turning;
    argus_orders_t orders;
    argus_motion_t motion;
    argus_pace_t pace;
    uint32_t now_ms;
    uint32_t since_ms; // entry into the mode
    argus_firing_t firing;
    uint32_t stops; // STOP and E_STOP sent, monotonic
    argus_knowledge_t knowledge;
    argus_plan_t plan;
    argus_base_t base;
    argus_checking_t checking;
    argus_waiting_t waiting;
    argus_config_t config;   // in force with the robot at hand: nothing is ARGUS_AUTO
    argus_follows_t follows; // ... but was, as it was given
    argus_reverse_t reverse;
    argus_history_t history;
    argus_reflexes_t reflexes;
    argus_latency_t latency;
    argus_wheel_t wheel;
    argus_bend_t bend;
    argus_slip_t slip;
    argus_verifying_t verifying;
    argus_looks_t looks;
    argus_common_t common;     // profile argus
    argus_extremes_t extremes; // profile argus
    argus_algorithm1_t algorithm1;
    argus_travel_t travel;
    argus_session_t session;
    argus_events_t events;
    argus_rays_t rays;
    argus_echoes_t echoes;
    argus_evidence_t evidence; // profile argus
};

// At the start of each call from outside.
static inline void argus_set_now(argus_t *const self, const uint32_t now_ms) {
    self->now_ms = now_ms;
    self->events.now_ms = now_ms;
}

#endif
