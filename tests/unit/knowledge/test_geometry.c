// SPDX-License-Identifier: MIT
// Rule under attack: the ring of the firmware is the P3-DX's: angles, neighbours 20 degrees apart, left and
// right alike.
#include "knowledge/knowledge.h"

#include <math.h>

#include "unity.h"

void test_angles_of_the_ring(void) {
    static const int16_t angle[] = {90,  50,   30,   10,   -10, -30, -50, -90,
                                    -90, -130, -150, -170, 170, 150, 130, 90};
    for (int i = 0; i < ARGUS_SONARS; i++) {
        TEST_ASSERT_EQUAL(angle[i], argus_sonar_pose[i].heading_deg);
    }
}

void test_left_and_right_mirror_each_other(void) {
    for (int i = 0; i < 8; i++) {
        for (int array = 0; array < 16; array += 8) {
            const argus_sonar_pose_t *a = &argus_sonar_pose[array + i], *b = &argus_sonar_pose[array + 7 - i];
            TEST_ASSERT_EQUAL(a->x_mm, b->x_mm);
            TEST_ASSERT_EQUAL(a->y_mm, -b->y_mm);
            TEST_ASSERT_EQUAL(a->heading_deg, -b->heading_deg);
        }
    }
}

void test_every_face_looks_outwards(void) {
    for (int i = 1; i <= 6; i++) {
        const argus_sonar_pose_t *p = &argus_sonar_pose[i];
        TEST_ASSERT_TRUE(fabs(atan2(p->y_mm, p->x_mm) * 180 / 3.14159265 - p->heading_deg) < 6);
        TEST_ASSERT_TRUE(hypot(p->x_mm, p->y_mm) > 160 && hypot(p->x_mm, p->y_mm) < 175);
    }
}
