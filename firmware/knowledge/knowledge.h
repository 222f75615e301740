// SPDX-License-Identifier: MIT
// Knowledge (the K of MAPE-K): which robot it is, readings and their age, the health of every sonar, where
// the robot is.
#ifndef ARGUS_KNOWLEDGE_H
#define ARGUS_KNOWLEDGE_H

#include "arcos/sip.h"
#include "argus/argus.h"
#include "knowledge/odometry.h"
#include "robot/robot.h"

#define ARGUS_REFRESH_MS 320u   // a server that lists every sonar in every SIP lists one ping for so long
#define ARGUS_FLANK_NEAR_MM 350 // what a flank sonar reads of a wall that the way may slant into

typedef struct {
    uint16_t reading_mm;
    bool reported;
    bool steady; // taken while the robot did not rotate
    argus_health_t health;
    argus_fault_kind_t kind;
    argus_fault_kind_t kind_before; // in an earlier mission, from the record
    uint8_t relapses;               // disabled again, less missions without a fault
    bool named;                     // a fault of it was named, or it was disabled, in this mission
    uint8_t missions_named;         // ... in so many earlier ones, one after the other, from the record
    uint16_t disabled_times;        // this mission
    uint16_t disabled_before;       // earlier missions, from the record
    uint32_t sip;                   // index of the SIP that listed it last
    uint32_t heard_ms;              // time of that SIP
    uint32_t odometer_mm;           // way driven by then
    uint32_t echo_mm;               // ... when it heard its last echo, if it has heard one
    uint32_t readings;              // monotonic
    uint32_t since_ms;              // entry into `health`
} argus_sonar_t;

// A moment after which readings count: those listed in later SIPs, and no earlier than `from_ms` where a
// server lists every sonar in every SIP.
typedef struct {
    uint32_t sip;
    uint32_t from_ms;
} argus_mark_t;

// While the rear leads (`robot` is a row that is reversed) the rear counts as the front. That goes for
// heading, speeds of the wheels, bumpers, stalls, and echoes in the robot's frame. The place is the same.
typedef struct {
    const argus_robot_t *robot; // its geometry holds, never NULL
    uint8_t sonars;             // argus_robot_sonars() of it: those beyond are absent
    bool lists_all;             // the server lists every sonar in every SIP
    bool rotating;
    bool has_raw;
    bool origin_due; // the robot may have set its odometry to zero, since these
    bool leapt;      // in the last SIP, as no robot moves: left out of the pose
    bool stall_left;
    bool stall_right;
    uint8_t bumpers_front;
    uint8_t bumpers_rear;
    uint16_t still_sips; // consecutive SIPs at rest
    uint16_t flags;
    int16_t vel_left_mm_s;
    int16_t vel_right_mm_s;
    uint16_t battery_dv;
    uint16_t x_raw;
    uint16_t y_raw;
    argus_mask_t fresh;   // sonars listed in the last SIP
    argus_mask_t heard;   // sonars that have heard an echo since the readings began, or began anew
    argus_mask_t listed;  // sonars that this robot has ever listed
    uint8_t strange_sips; // in a row with sonars that such a robot has not got
    argus_pose_t pose;
    uint32_t odometer_mm; // way driven, monotonic
    uint32_t sips;
    uint32_t sip_ms;             // time of the last SIP
    uint32_t reopened_ms;        // when the session began
    uint32_t online_ms;          // when SIPs began to come, or came again after a gap
    int32_t heading_offset_cdeg; // heading of the robot as it is built - what it says itself
    int32_t x_um;                // remainders of the pose, below a mm
    int32_t y_um;
    int32_t odometer_um;
    int32_t turn_deg_s;    // by the headings of the last two SIPs; 0 after a leap
    uint32_t moved_ms;     // time of the SIP of x_raw, y_raw
    uint32_t late_ms;      // by which SIPs may be late now
    argus_order_t order;   // since then
    argus_excess_t excess; // beyond what the wheels say
    uint32_t leaps;        // monotonic
    uint32_t leaps_unseen; // ... of these after a gap in which it moved: its place is lost
    int32_t leap_mm;
    int32_t leap_cdeg; // >= 0
    argus_sonar_t sonar[ARGUS_SONARS];
} argus_knowledge_t;

// Nothing is known but that the robot is the default one.
void argus_knowledge_init(argus_knowledge_t *self);

// A session opened: the robot's odometry starts anew, our pose goes on from where it was; every sonar must
// report anew.
void argus_knowledge_reopen(argus_knowledge_t *self, uint32_t now_ms);

// One SIP. `distance_um`: thousandths of a mm per position unit.
void argus_knowledge_sip(argus_knowledge_t *self, const argus_sip_t *sip, int32_t distance_um,
                         uint32_t now_ms);

// Only the odometry of a SIP (a session that is about to be closed).
void argus_knowledge_odometry(argus_knowledge_t *self, const argus_sip_t *sip, int32_t distance_um,
                              uint32_t now_ms);

// The readings begin anew: that a sonar heard something before does not show that it lives.
void argus_knowledge_unhear(argus_knowledge_t *self);

// The other end leads from now on: `robot` is argus_robot_other_end() of the present one. The robot is at
// rest.
void argus_knowledge_turn_about(argus_knowledge_t *self, const argus_robot_t *robot);

// Of the robot as it is built, whichever end leads; what is said outside.
int32_t argus_built_heading_cdeg(const argus_knowledge_t *self);
uint16_t argus_built_bumpers(const argus_knowledge_t *self); // front << 8 | rear
int32_t argus_built_stalls(const argus_knowledge_t *self);   // 1 left, 2 right, 3 both
argus_wheels_t argus_built_wheels(const argus_knowledge_t *self);

// What must be added to the robot's own heading, as it says it, for the pose's heading.
int32_t argus_heading_offset_cdeg(const argus_knowledge_t *self);

// The robot was ordered to set its odometry to zero, and may not have heard it. SIPs that are nearer to zero
// than to the last one are counted from there, until the session opens.
void argus_knowledge_origin_due(argus_knowledge_t *self);

// The robot is here: its wheels turned and it did not move.
void argus_knowledge_set_back(argus_knowledge_t *self, const argus_pose_t *to);

// Bit masks over sonar numbers.
argus_mask_t argus_disabled(const argus_knowledge_t *self);
argus_mask_t argus_out(const argus_knowledge_t *self); // not used: DISABLED or on PROBATION
static inline bool argus_is_out(const argus_knowledge_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_health_t health = self->sonar[sonar].health;
    return health == ARGUS_DISABLED || health == ARGUS_PROBATION || health == ARGUS_ABSENT;
}
argus_mask_t argus_with_health(const argus_knowledge_t *self, argus_health_t health);
argus_mask_t argus_named(const argus_knowledge_t *self);      // SUSPECT, with the kind of a fault
bool argus_trusted(const argus_knowledge_t *self, int sonar); // neither out nor named nor unheard
bool argus_usable(const argus_knowledge_t *self, int sonar);  // reported, not out, not 5000

// Which may be relied on to look along another's bearing: none that is out or unheard. One with the name of a
// fault may only where no other is left.
argus_mask_t argus_living(const argus_knowledge_t *self, uint32_t stale_ms, uint32_t now_ms);

// Of the sonars in use that look ahead the one that reads least; -1: none.
int argus_nearest_ahead(const argus_knowledge_t *self);

// A reading as it counts for the way: of one that looks ahead from an upper deck what it would be at the
// faces of those that face forward, since it stands behind them.
int32_t argus_reading_ahead_mm(const argus_knowledge_t *self, int sonar);

// It looks ahead, on whichever deck, and what it read last holds: one that does not face forward is passed
// over while it is STALE, since no other is asked to look there.
bool argus_counts_ahead(const argus_knowledge_t *self, int sonar);

// The way driven since one of these heard an echo; UINT32_MAX: none has since the readings began.
uint32_t argus_unheard_mm(const argus_knowledge_t *self, argus_mask_t sonars);

// The nearest echo, in mm, of the flank sonars, those that are out and `except` left aside; INT32_MAX: none.
int32_t argus_flank_mm(const argus_knowledge_t *self, argus_mask_t except);

argus_mark_t argus_mark_now(const argus_knowledge_t *self);
bool argus_fresh_since(const argus_knowledge_t *self, int sonar, const argus_mark_t *mark);
bool argus_all_fresh_since(const argus_knowledge_t *self, argus_mask_t sonars, const argus_mark_t *mark);

uint32_t argus_age_ms(const argus_knowledge_t *self, int sonar,
                      uint32_t now_ms); // UINT32_MAX: never reported
uint32_t argus_silent_ms(const argus_knowledge_t *self,
                         int sonar);               // how long it has missed its slots, as of the last SIP
bool argus_at_rest(const argus_knowledge_t *self); // two consecutive SIPs within 5 mm/s

// Where the echo of a sonar lies, robot frame and course frame, beam axis taken.
argus_point_t argus_echo_robot(const argus_knowledge_t *self, int sonar);
argus_point_t argus_to_course(const argus_pose_t *pose, argus_point_t robot);

// A place, robot frame, as a transducer has it: ahead along its axis, and to the left.
argus_point_t argus_from_sonar(const argus_knowledge_t *self, int sonar, argus_point_t at);

// The same of many points: the direction of the pose is worked out once.
typedef struct {
    argus_point_t at;
    int32_t cos;
    int32_t sin;
} argus_frame_t;
argus_frame_t argus_frame_at(const argus_pose_t *pose);
argus_point_t argus_from_frame(const argus_frame_t *frame, argus_point_t point);
argus_point_t argus_into_frame(const argus_frame_t *frame, argus_point_t point); // at most 60,000 mm off

// From the echo of this sonar to the robot's centre, mm, were the robot `back_mm` farther back; INT32_MAX
// when it is DISABLED or reads 5000. The nearest of all.
int32_t argus_echo_to_centre_mm(const argus_knowledge_t *self, int sonar, int32_t back_mm);
int32_t argus_nearest_to_centre_mm(const argus_knowledge_t *self, int32_t back_mm);

#endif
