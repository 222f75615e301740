// SPDX-License-Identifier: MIT
// Rule under attack: a ring that a caller describes becomes the very row that the generator makes of the same
// figures, and each fault in one is found and told apart.
#include "robot/make.h"

#include <stdio.h>
#include <string.h>

#include "robot/robot.h"
#include "unity.h"

#define EXCESS_WITHIN 64 // 2^-26: two ways to compute a cosine

static argus_sonar_mount_t mounts[ARGUS_SONARS];
static argus_ring_t ring;
static argus_own_robot_t own;

static uint8_t role_of(const argus_robot_t *robot, int sonar) {
    if ((robot->ahead_mask >> sonar & 1u) != 0) {
        return ARGUS_ROLE_AHEAD;
    }
    if ((robot->astern_mask >> sonar & 1u) != 0) {
        return ARGUS_ROLE_ASTERN;
    }
    return ((robot->flank_mask | robot->rear_flank_mask) >> sonar & 1u) != 0 ? ARGUS_ROLE_ABEAM
                                                                             : ARGUS_ROLE_NONE;
}

// The ring of a robot that is known.
static void describe(const argus_robot_t *robot) {
    ring = (argus_ring_t){.name = robot->name, .mounts = mounts, .sonars = robot->sonars};
#define COPY(key, section, def, min, max, meaning) ring.key = robot->key;
    ARGUS_RING_BODY_TABLE(COPY)
#undef COPY
    ring.forward_count = robot->forward_count;
    memcpy(ring.forward, robot->forward, robot->forward_count);
    for (int i = 0; i < argus_robot_sonars(robot); i++) {
        const argus_sonar_pose_t at = argus_robot_pose(robot, i);
        mounts[i] = (argus_sonar_mount_t){at.x_mm, at.y_mm, at.heading_deg, role_of(robot, i)};
    }
}

static void is_same(const argus_robot_t *is, const argus_robot_t *should) {
    argus_robot_t copy = *is;
    TEST_ASSERT_UINT32_WITHIN_MESSAGE(EXCESS_WITHIN, should->tolerance_excess, is->tolerance_excess,
                                      should->name);
    copy.tolerance_excess = should->tolerance_excess;
    copy.other = should->other;
    copy.poses = should->poses;
    TEST_ASSERT_EQUAL_MEMORY_ARRAY_MESSAGE(should->forward, copy.forward, 1, should->forward_count,
                                           should->name);
#define SAME(key, section, def, min, max, meaning) TEST_ASSERT_EQUAL_MESSAGE(should->key, copy.key, #key);
    ARGUS_RING_BODY_TABLE(SAME)
#undef SAME
    TEST_ASSERT_EQUAL_STRING(should->name, copy.name);
    TEST_ASSERT_EQUAL(should->reversed, copy.reversed);
    TEST_ASSERT_EQUAL(should->sonars, copy.sonars);
    TEST_ASSERT_EQUAL(should->arrays, copy.arrays);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(should->forward_mask, copy.forward_mask, should->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(should->ahead_mask, copy.ahead_mask, should->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(should->astern_mask, copy.astern_mask, should->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(should->flank_mask, copy.flank_mask, should->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(should->rear_flank_mask, copy.rear_flank_mask, should->name);
    TEST_ASSERT_EQUAL_MESSAGE(should->rear_overhang_mm, copy.rear_overhang_mm, should->name);
    TEST_ASSERT_EQUAL_MESSAGE(should->deck_behind_mm, copy.deck_behind_mm, should->name);
    TEST_ASSERT_EQUAL_MESSAGE(should->pitch_deg, copy.pitch_deg, should->name);
}

void setUp(void) {
    describe(argus_robot_find("amigo-sh"));
}

void test_a_known_robot_described_is_its_row(void) {
    int ends = 0;
    for (int choice = 1; choice <= ARGUS_ROBOTS; choice++) {
        const argus_robot_t *const robot = argus_robot_chosen(choice);
        describe(robot);
        const argus_ring_report_t report = argus_robot_make(&own, &ring);
        if (robot->sonars > ARGUS_SONARS) {
            TEST_ASSERT_EQUAL(ARGUS_RING_SONARS, report.fault);
            continue;
        }
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_RING_OK, report.fault, robot->name);
        is_same(&own.rows[0], robot);
        const argus_robot_t *const other = argus_robot_other_end(robot);
        const argus_robot_t *const made = argus_robot_other_end(&own.rows[0]);
        TEST_ASSERT_EQUAL_MESSAGE(other != NULL, made != NULL, robot->name);
        for (int i = 0; i < robot->sonars; i++) {
            const argus_sonar_pose_t a = argus_robot_pose(robot, i), b = argus_robot_pose(&own.rows[0], i);
            TEST_ASSERT_EQUAL_MEMORY(&a, &b, sizeof a);
        }
        if (other != NULL) {
            ends++;
            is_same(made, other);
            TEST_ASSERT_EQUAL_PTR(&own.rows[0], argus_robot_built(made));
            TEST_ASSERT_EQUAL_PTR(&own.rows[0], argus_robot_other_end(made));
            const argus_sonar_pose_t a = argus_robot_pose(other, 3), b = argus_robot_pose(made, 3);
            TEST_ASSERT_EQUAL_MEMORY(&a, &b, sizeof a);
        }
    }
    TEST_ASSERT_EQUAL(ARGUS_SONARS >= 32 ? 3 : ARGUS_SONARS >= 16 ? 2 : 0, ends);
}

void test_one_of_the_callers_own_is_no_row_of_the_table(void) {
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
    TEST_ASSERT_TRUE(argus_robot_is_own(&own.rows[0]));
    TEST_ASSERT_EQUAL(0, argus_robot_choice(&own.rows[0]));
    TEST_ASSERT_FALSE(argus_robot_is_own(argus_robot_default()));
    TEST_ASSERT_FALSE(argus_robot_is_own(argus_robot_unknown()));
}

void test_what_is_left_out_is_worked_out(void) {
    ring.swing_radius_mm = ring.sonar_face_mm = ring.tolerance_centre_mm = ring.track_mm = 0;
    ring.decel_mm_s2 = ring.dist_conv_um = ring.min_mm = ring.no_echo_mm = ring.cone_deg = 0;
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
    const argus_robot_t *const robot = &own.rows[0];
    TEST_ASSERT_EQUAL(220, robot->swing_radius_mm); // hypot(170, 139.5) = 219.9
    TEST_ASSERT_EQUAL(144, robot->sonar_face_mm);
    TEST_ASSERT_EQUAL(144, robot->tolerance_centre_mm);
    TEST_ASSERT_EQUAL(279, robot->track_mm);
    TEST_ASSERT_EQUAL(300, robot->decel_mm_s2);
    TEST_ASSERT_EQUAL(1000, robot->dist_conv_um);
    TEST_ASSERT_EQUAL(100, robot->min_mm);
    TEST_ASSERT_EQUAL(5000, robot->no_echo_mm);
    TEST_ASSERT_EQUAL(30, robot->cone_deg);
}

static void refused(argus_ring_fault_t fault, int sonar) {
    const argus_ring_report_t report = argus_robot_make(&own, &ring);
    TEST_ASSERT_EQUAL(fault, report.fault);
    TEST_ASSERT_EQUAL(sonar, report.sonar);
    TEST_ASSERT_EQUAL(fault == ARGUS_RING_FIGURE || fault == ARGUS_RING_SWING, report.key >= 0);
    setUp();
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
}

void test_each_fault_is_told_apart(void) {
    ring.name = NULL, refused(ARGUS_RING_NAME, -1);
    ring.name = "", refused(ARGUS_RING_NAME, -1);
    ring.name = "sixteen-letters!", refused(ARGUS_RING_NAME, -1);
    ring.front_mm = 0, refused(ARGUS_RING_FIGURE, -1);
    ring.no_echo_mm = 5001, refused(ARGUS_RING_FIGURE, -1);
    ring.min_mm = -1, refused(ARGUS_RING_FIGURE, -1);
    ring.sonars = 0, refused(ARGUS_RING_SONARS, -1);
    ring.sonars = ARGUS_SONARS + 1, refused(ARGUS_RING_SONARS, -1);
    mounts[5].x_mm = 161, refused(ARGUS_RING_BESIDE, 5);
    mounts[6].x_mm = -171, refused(ARGUS_RING_BESIDE, 6);
    mounts[0].y_mm = 141, refused(ARGUS_RING_BESIDE, 0);
    mounts[0].y_mm = -141, refused(ARGUS_RING_BESIDE, 0);
    mounts[0].y_mm = INT16_MIN, refused(ARGUS_RING_BESIDE, 0);
    mounts[7].heading_deg = 181, refused(ARGUS_RING_BEARING, 7);
    mounts[7].heading_deg = -180, refused(ARGUS_RING_BEARING, 7);
    mounts[7].role = 4, refused(ARGUS_RING_ROLE, 7);
    mounts[7] = mounts[2], refused(ARGUS_RING_ALIKE, 7);
}

void test_sectors_of_a_laser_follow_the_sonars_from_left_to_right(void) {
    if (ARGUS_SONARS <= 16) {
        TEST_IGNORE_MESSAGE("a small build takes no laser");
    }
    ring.sectors = 12, ring.field_deg = 240, ring.facing_deg = 10, ring.ahead_mm = 50;
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
    const argus_robot_t *const robot = &own.rows[0];
    TEST_ASSERT_EQUAL(20, robot->sonars);
    TEST_ASSERT_EQUAL_HEX32(0xFFF00, argus_robot_sectors(robot));
    TEST_ASSERT_EQUAL(20, argus_robot_cone_deg(robot, 8));
    TEST_ASSERT_EQUAL(robot->cone_deg, argus_robot_cone_deg(robot, 7));
    TEST_ASSERT_EQUAL(120, argus_robot_pose(robot, 8).heading_deg);
    TEST_ASSERT_EQUAL(-100, argus_robot_pose(robot, 19).heading_deg);
    TEST_ASSERT_EQUAL(50, argus_robot_pose(robot, 19).x_mm);
    TEST_ASSERT_EQUAL_HEX32(0xFF, argus_robot_looking(robot)); // at one height only: they cover for none
}

void test_a_laser_alone_guards(void) {
    if (ARGUS_SONARS <= 16) {
        TEST_IGNORE_MESSAGE("a small build takes no laser");
    }
    ring.sonars = 0, ring.sectors = 24, ring.field_deg = 360;
    ring.forward_count = 4;
    const uint8_t forward[] = {10, 11, 12, 13};
    memcpy(ring.forward, forward, sizeof forward);
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
    TEST_ASSERT_EQUAL(172, argus_robot_pose(&own.rows[0], 0).heading_deg);
    TEST_ASSERT_EQUAL_HEX32(0xFF00, argus_robot_ahead(&own.rows[0]));
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFF, argus_robot_looking(&own.rows[0]));
}

void test_what_is_wrong_with_a_laser_is_told_by_its_key(void) {
    if (ARGUS_SONARS <= 16) {
        TEST_IGNORE_MESSAGE("a small build takes no laser");
    }
    static const struct {
        int sonars, sectors, field_deg, ahead_mm, fault;
    } bad[] = {{7, 8, 180, 0, ARGUS_RING_SECTORS},
               {8, 7, 180, 0, ARGUS_RING_SECTORS},
               {8, 25, 180, 0, ARGUS_RING_SONARS},
               {8, 33, 330, 0, ARGUS_RING_FIGURE},
               {8, 12, 180, 171, ARGUS_RING_BESIDE}};
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        ring.sonars = (uint8_t)bad[i].sonars, ring.sectors = bad[i].sectors;
        ring.field_deg = bad[i].field_deg, ring.ahead_mm = bad[i].ahead_mm;
        const argus_ring_report_t report = argus_robot_make(&own, &ring);
        TEST_ASSERT_EQUAL(bad[i].fault, report.fault);
        TEST_ASSERT_TRUE(report.key >= 0);
        TEST_ASSERT_EQUAL(-1, report.sonar);
    }
}
void test_a_small_build_takes_no_laser(void) {
    ring.sectors = 8, ring.field_deg = 160;
    const bool small = ARGUS_SONARS <= 16;
    TEST_ASSERT_EQUAL(small ? ARGUS_RING_SONARS : ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
}

void test_each_fault_of_those_that_face_forward_is_told_apart(void) {
    ring.forward_count = 1, refused(ARGUS_RING_FORWARD, -1);
    ring.forward_count = 7, refused(ARGUS_RING_FORWARD, -1);
    ring.forward[1] = 8, refused(ARGUS_RING_FORWARD, 8);
    ring.forward[1] = 255, refused(ARGUS_RING_FORWARD, 255);
    mounts[3].role = ARGUS_ROLE_NONE, refused(ARGUS_RING_FORWARD, 3);
    ring.forward[1] = 3, ring.forward[2] = 2, refused(ARGUS_RING_ORDER, 2);
    ring.forward[1] = 1, refused(ARGUS_RING_ORDER, 1); // twice
    mounts[4].heading_deg = -75, refused(ARGUS_RING_ORDER, 4);
    mounts[0].heading_deg = 89, mounts[1].heading_deg = 40, mounts[2].heading_deg = 17;
    mounts[5].heading_deg = -93, mounts[6].heading_deg = -144, mounts[7].heading_deg = 151;
    refused(ARGUS_RING_TURNS, -1); // 28 different ones
}

void test_a_body_that_cannot_be_swung_is_refused(void) {
    ring.swing_radius_mm = 169, refused(ARGUS_RING_SWING, -1);
    ring.no_echo_mm = 500, ring.swing_radius_mm = 500, refused(ARGUS_RING_SWING, -1);
}

void test_a_round_body_swings_within_its_own_circle(void) {
    ring.front_mm = ring.rear_mm = 170, ring.width_mm = 340, ring.swing_radius_mm = 170;
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
    TEST_ASSERT_EQUAL(170, own.rows[0].swing_radius_mm);
}

// Two at one place are two as long as they look elsewhere, and one figure apart is apart.
void test_only_one_at_the_same_place_and_bearing_is_the_same(void) {
    static const int16_t apart[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (unsigned i = 0; i < sizeof apart / sizeof apart[0]; i++) {
        setUp();
        mounts[7] = mounts[6];
        mounts[7].x_mm = (int16_t)(mounts[7].x_mm + apart[i][0]);
        mounts[7].y_mm = (int16_t)(mounts[7].y_mm + apart[i][1]);
        mounts[7].heading_deg = (int16_t)(mounts[7].heading_deg + apart[i][2]);
        TEST_ASSERT_EQUAL(i != 0, argus_robot_make(&own, &ring).fault == ARGUS_RING_OK);
    }
}

void test_a_name_as_long_as_there_is_room_for_is_taken_whole(void) {
    char name[ARGUS_ROBOT_NAME_MAX + 1];
    for (size_t length = 1; length <= ARGUS_ROBOT_NAME_MAX; length++) {
        memset(name, 'a', sizeof name);
        name[length] = '\0';
        setUp();
        ring.name = name;
        const bool fits = length < ARGUS_ROBOT_NAME_MAX;
        TEST_ASSERT_EQUAL(fits ? ARGUS_RING_OK : ARGUS_RING_NAME, argus_robot_make(&own, &ring).fault);
        TEST_ASSERT_TRUE(!fits || strcmp(own.rows[0].name, name) == 0);
    }
}

// Eight sonars 30 degrees apart, none of which looks astern; the middle four face forward.
static void fan(void) {
    ring.sonars = 8;
    ring.forward_count = 4;
    for (int i = 0; i < 8; i++) {
        const bool ahead = i >= 2 && i < 6;
        mounts[i] =
            (argus_sonar_mount_t){(int16_t)(ahead ? 100 : -100), (int16_t)(70 - 20 * i),
                                  (int16_t)(105 - 30 * i), ahead ? ARGUS_ROLE_AHEAD : ARGUS_ROLE_NONE};
        ring.forward[i % 4] = (uint8_t)(2 + i % 4);
    }
}

void test_sectors_beside_sonars_guard_where_they_are_told_to(void) {
    if (ARGUS_SONARS <= 16) {
        TEST_IGNORE_MESSAGE("a small build takes no laser");
    }
    fan();
    for (int guards = 0; guards < 2; guards++) {
        ring.sectors = 6, ring.field_deg = 180, ring.guards = guards;
        TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
        const argus_robot_t *const robot = &own.rows[0];
        TEST_ASSERT_EQUAL(guards, (argus_robot_ahead(robot) & argus_robot_sectors(robot)) != 0);
    }
}

// What it backs into head-on is seen so far before its end as the hindmost of those that look astern sits;
// where none looks there, from the centre on.
void test_without_a_sonar_that_looks_astern_the_overhang_is_the_whole_rear(void) {
    fan();
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
    TEST_ASSERT_EQUAL_INT32(ring.rear_mm, own.rows[0].rear_overhang_mm);
    mounts[7].heading_deg = 165;
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
    TEST_ASSERT_EQUAL_INT32(ring.rear_mm - 100, own.rows[0].rear_overhang_mm);
}

// Likewise of a robot that leads with its rear: where none looks back, from the centre on.
void test_without_a_sonar_straight_ahead_the_turned_overhang_is_the_whole_front(void) {
    static const int16_t headings_deg[] = {90, 45, -90, -135};
    ring.sonars = 4;
    ring.forward_count = 2;
    for (int i = 0; i < 4; i++) {
        mounts[i] = (argus_sonar_mount_t){(int16_t)(i < 2 ? 100 : -100), 0, headings_deg[i],
                                          i < 2 ? ARGUS_ROLE_AHEAD : ARGUS_ROLE_ASTERN};
        ring.forward[i % 2] = (uint8_t)(i % 2);
    }
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_robot_make(&own, &ring).fault);
    TEST_ASSERT_NOT_NULL(argus_robot_other_end(&own.rows[0]));
    TEST_ASSERT_EQUAL_INT32(own.rows[1].rear_mm, own.rows[1].rear_overhang_mm);
}
