// SPDX-License-Identifier: MIT
// A wall is told by the sectors beside it: they see it farther off, by as much as its foot lies aside.
#include "awareness/scan.h"

#include "awareness/numbers.h"
#include "knowledge/angle.h"

#define SQUARE_RADIAN ((int64_t)ARGUS_RADIAN_CDEG * ARGUS_RADIAN_CDEG)

static bool is_sector(const argus_knowledge_t *const knowledge, const int sector) {
    return sector >= 0 && sector < knowledge->sonars && argus_robot_is_sector(knowledge->robot, sector);
}

// What a sector returns, mm; ARGUS_NO_ECHO_MM where there is no such sector.
static int32_t return_mm(const argus_knowledge_t *const knowledge, const int sector) {
    return is_sector(knowledge, sector) ? argus_min(knowledge->sonar[sector].reading_mm, ARGUS_NO_ECHO_MM)
                                        : ARGUS_NO_ECHO_MM;
}

// The foot of a wall lies towards the sector that sees it nearer. Sectors take what is nearest in them, so
// those beside it see it at their near rims.
static argus_shape_t within(const int32_t mm, const int32_t left_mm, const int32_t right_mm,
                            const int32_t width_cdeg, int32_t *const aside_cdeg) {
    const int64_t aside = (right_mm - left_mm) * SQUARE_RADIAN / ((int64_t)mm * width_cdeg);
    const int64_t bent_mm = (int64_t)mm * width_cdeg * width_cdeg / SQUARE_RADIAN;
    const bool wall = left_mm < ARGUS_NO_ECHO_MM && right_mm < ARGUS_NO_ECHO_MM &&
                      3 * argus_abs((int32_t)aside) <= 2 * width_cdeg &&
                      left_mm + right_mm - 2 * mm <= bent_mm + ARGUS_FAMILIAR_MM / 2;
    *aside_cdeg = wall ? (int32_t)aside : 0;
    return wall ? ARGUS_SHAPE_WALL : ARGUS_SHAPE_EDGE;
}

// The last sector of a field has one beside it: that and the next tell where the foot of the wall is, towards
// the rim, and how far.
static argus_shape_t at_rim(const int32_t mm, const int32_t next_mm, const int32_t second_mm,
                            const int32_t width_cdeg, int32_t *const outwards_cdeg) {
    if (next_mm >= ARGUS_NO_ECHO_MM || second_mm >= ARGUS_NO_ECHO_MM) {
        return ARGUS_SHAPE_NONE;
    }
    const int64_t outwards =
        (second_mm - next_mm) * SQUARE_RADIAN / ((int64_t)next_mm * width_cdeg) - width_cdeg;
    const int64_t beyond = argus_max((int32_t)outwards + width_cdeg / 2, 0); // the near rim of the next
    const int64_t foot_mm = next_mm - next_mm * beyond * beyond / (2 * SQUARE_RADIAN);
    *outwards_cdeg = (int32_t)outwards;
    return 3 * outwards >= -2 * width_cdeg && outwards <= width_cdeg &&
                   argus_abs((int32_t)(foot_mm - mm)) <= ARGUS_FAMILIAR_MM / 2
               ? ARGUS_SHAPE_WALL
               : ARGUS_SHAPE_NONE;
}

argus_shape_t argus_scan_shape(const argus_knowledge_t *const knowledge, const int sector,
                               int32_t *const aside_cdeg) {
    const int32_t width_cdeg = knowledge->robot->sector_deg * 100;
    const int32_t mm = return_mm(knowledge, sector);
    const int32_t left_mm = return_mm(knowledge, sector - 1);
    const int32_t right_mm = return_mm(knowledge, sector + 1);
    *aside_cdeg = 0;
    if (mm < ARGUS_NEAREST_MM || mm > ARGUS_SURE_MM || left_mm < mm || right_mm < mm) {
        return ARGUS_SHAPE_NONE;
    }
    if (is_sector(knowledge, sector - 1) && is_sector(knowledge, sector + 1)) {
        return within(mm, left_mm, right_mm, width_cdeg, aside_cdeg);
    }
    const int inwards = is_sector(knowledge, sector + 1) ? 1 : -1;
    const argus_shape_t shape = at_rim(mm, return_mm(knowledge, sector + inwards),
                                       return_mm(knowledge, sector + 2 * inwards), width_cdeg, aside_cdeg);
    *aside_cdeg *= inwards;
    return shape;
}

// How far a return is from a transducer, mm, and how far off its axis; half a turn: behind it.
static int32_t seen_mm(const argus_knowledge_t *const knowledge, const int sonar, const int sector,
                       const int32_t aside_cdeg, int32_t *const off_cdeg) {
    const argus_sonar_pose_t eye = argus_robot_pose(knowledge->robot, sector);
    const argus_pose_t axis = {eye.x_mm, eye.y_mm, eye.heading_deg * 100 + aside_cdeg};
    const argus_point_t at = argus_to_course(&axis, (argus_point_t){knowledge->sonar[sector].reading_mm, 0});
    const argus_point_t seen = argus_from_sonar(knowledge, sonar, at);
    *off_cdeg = seen.x_mm > 0 ? (int32_t)((int64_t)argus_abs(seen.y_mm) * ARGUS_RADIAN_CDEG / seen.x_mm)
                              : ARGUS_HALF_TURN_CDEG;
    return argus_hypot(seen.x_mm, seen.y_mm);
}

static bool is_scanned(const argus_knowledge_t *const knowledge, const int sector) {
    return is_sector(knowledge, sector) && (knowledge->fresh >> sector & 1u) != 0 &&
           !argus_is_out(knowledge, sector);
}

int argus_scan_heard(const argus_knowledge_t *const knowledge, const int sonar, int32_t *const mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < knowledge->sonars);
    const int32_t well_cdeg = knowledge->robot->cone_deg * 50 - ARGUS_SCAN_FAINT_CDEG;
    int nearest = -1;
    for (int i = 0; i < knowledge->sonars; i++) {
        int32_t aside_cdeg = 0;
        const argus_shape_t shape =
            is_scanned(knowledge, i) ? argus_scan_shape(knowledge, i, &aside_cdeg) : ARGUS_SHAPE_NONE;
        if (shape == ARGUS_SHAPE_NONE) {
            continue;
        }
        int32_t off_cdeg = 0;
        const int32_t far_mm = seen_mm(knowledge, sonar, i, aside_cdeg, &off_cdeg);
        const int32_t unsure_cdeg = shape == ARGUS_SHAPE_EDGE ? knowledge->robot->sector_deg * 50 : 0;
        if (off_cdeg + unsure_cdeg <= well_cdeg && (nearest < 0 || far_mm < *mm)) {
            nearest = i;
            *mm = far_mm;
        }
    }
    return nearest;
}
