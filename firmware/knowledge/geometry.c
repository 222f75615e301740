// SPDX-License-Identifier: MIT
// The P3-DX sonar ring, from the generated table.
#include "knowledge/knowledge.h"

_Static_assert(ARGUS_SONARS >= ARGUS_P3DX_SONAR_COUNT, "ARGUS_SONARS is too small for the robot");
_Static_assert(ARGUS_NO_ECHO_MM == ARGUS_P3DX_SONAR_NO_ECHO_MM, "ARGUS_NO_ECHO_MM is not that of the robot");

const argus_sonar_pose_t argus_sonar_pose[ARGUS_SONARS] = {
#define ARGUS_POSE_ROW(number, x, y, heading) [number] = {(x), (y), (heading)},
    ARGUS_P3DX_SONAR_TABLE(ARGUS_POSE_ROW)
#undef ARGUS_POSE_ROW
};
