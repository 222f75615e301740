// SPDX-License-Identifier: MIT
// The P3-DX sonar ring, from the generated table.
#include "knowledge/knowledge.h"

const argus_sonar_pose_t argus_sonar_pose[ARGUS_SONARS] = {
#define ARGUS_POSE_ROW(number, x, y, heading) [number] = {(x), (y), (heading)},
    ARGUS_P3DX_SONAR_TABLE(ARGUS_POSE_ROW)
#undef ARGUS_POSE_ROW
};
