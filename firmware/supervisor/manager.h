// SPDX-License-Identifier: MIT
// The whole fault manager: bytes and time go in, packets and events come out.
//
// Not thread-safe: one thread (or one interrupt level) owns an argus_t. The caller owns the memory; nothing
// is allocated, no clock is read, no I/O is done. Times are milliseconds of any free-running counter,
// uint32_t, and may wrap.
//
// A port does, for ever: read bytes -> argus_receive() -> argus_transmit() until 0 -> argus_next_event()
// until false -> argus_process() -> argus_transmit() until 0 -> wait for bytes, at most as long as
// argus_process() said.
#ifndef ARGUS_MANAGER_H
#define ARGUS_MANAGER_H

#include "adjustment/drive.h"
#include "adjustment/motion.h"
#include "adjustment/plan.h"
#include "analysis/inquiry.h"
#include "analysis/verify.h"
#include "arcos/session.h"
#include "awareness/awareness.h"
#include "knowledge/knowledge.h"
#include "supervisor/config.h"
#include "supervisor/events.h"
#include "task/task.h"

// What the manager is doing. Order is not severity.
typedef enum {
    ARGUS_MODE_OFFLINE,   // no session with a robot
    ARGUS_MODE_CHECKING,  // at rest: every sonar of 1..6 must report before anything moves (S6)
    ARGUS_MODE_VERIFYING, // Algorithm 2 turns neighbours onto a suspect's bearing
    ARGUS_MODE_IDLE,      // healthy enough, nothing to do
    ARGUS_MODE_DRIVING,   // normal driving
    ARGUS_MODE_SWEEPING,  // failure mode, at rest: turns through the plan's rotations
    ARGUS_MODE_STEPPING,  // failure mode: one step ahead
    ARGUS_MODE_BACKING,   // backs away from a pressed bumper or a blocked swing circle
    ARGUS_MODE_WAITING,   // cannot go on by itself: bumper, motors off, no way, catastrophic
    ARGUS_MODE_CLOSING,   // shutdown: stopping, then closing the session
    ARGUS_MODE_CLOSED     // over
} argus_mode_t;

typedef enum {
    ARGUS_MISSION_NONE,
    ARGUS_MISSION_RUNNING,
    ARGUS_MISSION_REACHED,
    ARGUS_MISSION_FAILED
} argus_mission_t;

// What an operator may ask. The argument is mm for MOVE, degrees for TURN, a sonar (0..15) for RETEST and
// what follows it, else ignored. PIN, UNPIN and DISABLE are for profile argus; what cannot be done is refused
// without an event.
typedef enum {
    ARGUS_OP_STOP = 1, // stop and stay: the course is paused
    ARGUS_OP_GO,       // (re)start the course
    ARGUS_OP_RECHECK,  // full health check, suspects verified
    ARGUS_OP_MOVE,     // jog: at most step_mm ahead or backoff_mm back, with every safety rule in force
    ARGUS_OP_TURN,     // jog: turn on the spot, -180..180
    ARGUS_OP_PASSIVE,  // stop, then only report
    ARGUS_OP_ACTIVE,
    ARGUS_OP_RETEST, // forget the evidence against a sonar and look at it again
    ARGUS_OP_PIN,    // a sonar keeps its health, whatever it reads, until it is unpinned or yields nothing
    ARGUS_OP_UNPIN,  // the evidence decides again
    ARGUS_OP_DISABLE // take a sonar out of use (wrong) and pin it
} argus_op_t;

// A copy of everything a screen, a log or a test wants to see.
typedef struct {
    argus_mode_t mode;
    argus_mission_t mission;
    argus_failure_t failure;
    argus_plan_t plan;
    argus_pose_t pose;
    int32_t goal_mm;   // straight-line distance to the last waypoint, 0 without a course
    uint16_t waypoint; // next waypoint, from 0
    uint16_t waypoints;
    bool active;        // false: passive
    bool online;        // SIPs are coming
    int16_t battery_dv; // decivolts
    int16_t vel_left_mm_s;
    int16_t vel_right_mm_s;
    uint16_t flags;
    uint8_t bumpers_front; // bits 1..5, bit 1 leftmost
    uint8_t bumpers_rear;
    int16_t reading_mm[ARGUS_SONARS]; // 0: never reported
    uint32_t age_ms[ARGUS_SONARS];    // UINT32_MAX: never reported
    argus_health_t health[ARGUS_SONARS];
    argus_fault_kind_t kind[ARGUS_SONARS];
    uint32_t sips; // monotonic counters
    uint32_t bad_checksums;
    uint32_t skipped_bytes;
    uint32_t stops;
    const char *robot_name; // identity from the SYNC2 reply, "" before
    const char *robot_class;
    const char *robot_subclass;
    uint8_t body;   // whose geometry holds: argus_robot_chosen() of it, 0: not known
    uint8_t sonars; // that are managed: the others are ABSENT
} argus_status_t;

// Why the manager waits (mode WAITING).
typedef enum {
    ARGUS_WAIT_NONE,
    ARGUS_WAIT_BUMPER,
    ARGUS_WAIT_MOTORS,
    ARGUS_WAIT_TURN,        // the swing circle is blocked (S7)
    ARGUS_WAIT_WAY,         // every heading is blocked
    ARGUS_WAIT_CATASTROPHIC // all six are disabled
} argus_wait_t;

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

typedef struct {
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
} argus_t;

// Starts from nothing: no robot, every sonar UNKNOWN, no course. `config` must have passed
// argus_config_check(); otherwise the manager starts passive and stays so. Call once, then argus_link_up()
// when the transport is open.
void argus_init(argus_t *self, const argus_config_t *config, uint32_t now_ms);

// The course: 1..ARGUS_WAYPOINTS_MAX points in the frame of the robot's odometry at connection (x ahead, y
// left, mm, each |v| <= 30000). False, and nothing changed, when it does not fit. Driving starts by itself
// when active and checked.
bool argus_set_course(argus_t *self, const argus_point_t *points, uint16_t count);

void argus_link_up(argus_t *self, uint32_t now_ms);
void argus_link_lost(argus_t *self, uint32_t now_ms);

// Takes any number of received bytes. A STOP that they call for is ready in argus_transmit() when this
// returns.
void argus_receive(argus_t *self, uint32_t now_ms, const uint8_t *bytes, size_t count);

// Does what time alone makes due; returns the ms (1..100) after which it wants to be called again.
uint32_t argus_process(argus_t *self, uint32_t now_ms);

// Next packet to write, whole, at most ARCOS_FRAME_SEND_TOTAL_MAX bytes; 0 when there is none. A buffer too
// small: 0.
size_t argus_transmit(argus_t *self, uint8_t *buffer, size_t capacity);

bool argus_next_event(argus_t *self, argus_event_t *event);

void argus_operator(argus_t *self, uint32_t now_ms, argus_op_t op, int32_t argument);

// Tests one sonar (0..15) anew, at rest; under `paper` by a full health check. False: no such sonar, no
// session, or it is pinned.
bool argus_retest(argus_t *self, uint8_t sonar, uint32_t now_ms);

// Stop the robot, then SONAR 0, STOP, CLOSE; argus_closed() tells when the last byte is out (within 3 s).
void argus_shutdown(argus_t *self, uint32_t now_ms);
bool argus_closed(const argus_t *self);

void argus_status(const argus_t *self, argus_status_t *status);

// The persistent record: what is known of every sonar (SPEC.md). save returns its length, 0 if it does not
// fit. load takes a record, before a session opens; under `argus` a sonar that was out in it starts on
// PROBATION. A damaged or foreign one is said by an event and ignored; one of another robot is, and taken
// back, once a session is open.
size_t argus_record_save(const argus_t *self, uint8_t *buffer, size_t capacity);
bool argus_record_load(argus_t *self, const uint8_t *record, size_t length);

// 0 when every internal invariant holds, else the number of the first that does not. For supervisors, tests,
// fuzzers.
int argus_invariants_broken(const argus_t *self);

const char *argus_mode_name(argus_mode_t mode);
const char *argus_mission_name(argus_mission_t mission);

#endif
