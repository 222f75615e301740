// SPDX-License-Identifier: MIT
// The scan of a laser as a whole: its sectors fail together, so what is common to them is found here.
#ifndef ARGUS_LASER_H
#define ARGUS_LASER_H

#include "awareness/numbers.h"
#include "knowledge/knowledge.h"

// The values of the event LASER_FAULT.
typedef enum {
    ARGUS_SCAN_SOUND,
    ARGUS_SCAN_FROZEN,
    ARGUS_SCAN_DARK,
    ARGUS_SCAN_CUT,
    ARGUS_SCAN_LATE,
    ARGUS_SCAN_TURNED,
    ARGUS_SCAN_SCALED
} argus_scan_fault_t;

typedef struct {
    uint32_t t_ms;
    int32_t heading_cdeg;
    uint16_t mm[ARGUS_SONARS];
} argus_scan_t;

// The foot of a wall, over a stretch of way.
typedef struct {
    argus_point_t at;     // of the laser, where the stretch began
    int32_t bearing_cdeg; // of the foot, then, course frame
    int32_t aside_cdeg;   // ... and since, summed up
    uint16_t from_mm;
    uint16_t last_mm;
    uint8_t scans;  // 0: none is followed
    uint8_t missed; // scans since the last that shows it
} argus_wall_t;

// Sums of products: changes of walls' ranges (y), and those that the way explains with the axis as it is (c)
// and turned by a quarter (t).
typedef struct {
    int32_t cc;
    int32_t ct;
    int32_t tt;
    int32_t yc;
    int32_t yt;
} argus_slopes_t;

// How much scans misfit when the heading is that of a lag ago, and with the present one; as mean of sectors.
typedef struct {
    int32_t late_mm;
    int32_t prompt_mm;
    uint8_t scans;
} argus_misfit_t;

typedef struct {
    argus_mask_t sectors; // of the scans
    argus_scan_t scan[ARGUS_SCANS];
    uint8_t next;
    uint8_t count;
    uint8_t fault; // argus_scan_fault_t
    bool news;     // in this SIP
    bool dark;     // nothing returned since dark_ms
    uint32_t dark_ms;
    uint32_t same_ms; // no sector has changed since
    uint32_t same_odometer_mm;
    int32_t same_cdeg;        // turned since
    uint32_t cut_odometer_mm; // where the stretch for the cut began
    uint16_t most_mm;         // the farthest return on it
    uint8_t edges;            // returns that began or ended at about that
    uint8_t inner;            // ... or nearer
    argus_wall_t wall[ARGUS_SCAN_WALLS];
    argus_slopes_t slopes;
    argus_misfit_t misfit[ARGUS_SCAN_LAGS]; // of 1, 2, ... steps
} argus_laser_t;

// After each SIP; a scan is one in which all sectors are fresh. Cost: some passes over the sectors.
void argus_laser_sip(argus_laser_t *self, const argus_knowledge_t *knowledge);

// What its sectors are out for; NONE: it is sound.
argus_fault_kind_t argus_laser_kind(const argus_laser_t *self);

#endif
