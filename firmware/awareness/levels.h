// SPDX-License-Identifier: MIT
// Every number of the evidence that was set by hand. Scores are hundredths of a nat (DESIGN.md, Evidence).
#ifndef ARGUS_LEVELS_H
#define ARGUS_LEVELS_H

// Of one thing: places, bearings, readings ----------------------------------------------------------------
#define ARGUS_SAME_CDEG 300      // pings closer than this are on one bearing
#define ARGUS_BESIDE_CDEG 500    // at a step of what is seen a reading may be of either side
#define ARGUS_SAME_LATERAL_MM 60 // ... and from one place
#define ARGUS_SAME_ALONG_MM 200
#define ARGUS_AGREE_MM 80      // by so much two echoes of one thing differ,
#define ARGUS_AGREE_PERCENT 5  // ... and by this part of the range
#define ARGUS_NEAREST_MM 150   // what would be nearer tells nothing
#define ARGUS_SURE_MM 4000     // from here on the air decides whether an echo is heard,
#define ARGUS_FARTHEST_MM 4600 // ... beyond no sonar need hear it
#define ARGUS_LEAP_MM 450      // no person walks so far between two firings
#define ARGUS_STILL_MM 12      // less way and turn than this may leave a reading as it is
#define ARGUS_STILL_CDEG 150

// Independence: one place and one moment are one piece of evidence ------------------------------------------
#define ARGUS_PLACE_MM 200
#define ARGUS_PLACE_CDEG 800
#define ARGUS_PLACE_MS 4000
#define ARGUS_EPISODE_MS 6000u
#define ARGUS_FADES_S 60 // what the others say fades

// Disturbance
// ------------------------------------------------------------------------------------------------
#define ARGUS_UNREST_MS 8000u
#define ARGUS_CALM_MS 30000u
#define ARGUS_UNREST_PERCENT 25  // of what contradicts counts
#define ARGUS_CROWD_PERMILLE 350 // of all readings contradicted: people are about
#define ARGUS_WALK_MM 70         // between two readings at rest

// Bounds of the sums
// -----------------------------------------------------------------------------------------
#define ARGUS_CEILING 3000
#define ARGUS_OUT_TIMES 4 // what speaks for a sonar that is out counts so often

// A sonar's own readings
// -------------------------------------------------------------------------------------
#define ARGUS_CLIPPED_MM 105 // the shortest readings are all alike
#define ARGUS_FAMILIAR_MM 100
#define ARGUS_SILENT_RUN 4
#define ARGUS_ALIKE_MM 20
#define ARGUS_DROPOUT_MOVING_MAX 1100

// Names
// ------------------------------------------------------------------------------------------------------
#define ARGUS_SUSPECT_PERCENT 75 // of a name's level: a look is called for
#define ARGUS_BESIDE_MS 10000
#define ARGUS_LATE_NAMING 500
#define ARGUS_LATE_ALONE 750
#define ARGUS_LATE_CONVINCING 1375
#define ARGUS_LATE_LEAD 430
#define ARGUS_OFFSET_NAMING 1100
#define ARGUS_OFFSET_LEAD 300
#define ARGUS_OFFSET_CONTRADICTED 300
#define ARGUS_SILENT_CONTRADICTED 380
#define ARGUS_HELD_PERCENT 25 // of a name's level: a suspect is cleared below

#endif
