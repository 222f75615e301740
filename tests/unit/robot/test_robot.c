// SPDX-License-Identifier: MIT
// Rule under attack: every robot's table against facts that are not taken from it: the vendor's body and
// sonar figures, what bearings say of roles and masks, and who is found under which name.
#include "robot/robot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "knowledge/angle.h"
#include "unity.h"

#define DEG (3.14159265358979323846 / 180)

static char text[80];

// RobotLengthFront, RobotLengthRear, RobotWidth, SonarNum of ARIA's params; the PeopleBot's ends are those of
// its upper deck and of half its length.
static const struct {
    const char *name;
    int front, rear, width, sonars;
} body[] = {{"p3dx-sh", 210, 301, 425, 16},
            {"p3at-sh", 313, 313, 505, 16},
            {"amigo-sh", 160, 170, 279, 8},
            {"peoplebot-sh", 257, 290, 425, 32}};

static const int16_t ring[] = {90, 50, 30, 10, -10, -30, -50, -90, -90, -130, -150, -170, 170, 150, 130, 90};
static const int16_t amigo[] = {90, 41, 15, -15, -41, -90, -145, 145};

static int16_t bearing(const argus_robot_t *robot, int sonar) {
    return argus_robot_pose(robot, sonar).heading_deg;
}

static const argus_robot_t *robot_at(int row) {
    const argus_robot_t *robot = argus_robot_chosen(row + 1);
    TEST_ASSERT_NOT_NULL(robot);
    snprintf(text, sizeof text, "%s", robot->name);
    return robot;
}

void test_the_bodies_are_the_vendors(void) {
    TEST_ASSERT_TRUE(sizeof body / sizeof body[0] <= ARGUS_ROBOTS); // one that is added brings its own test
    for (size_t i = 0; i < sizeof body / sizeof body[0]; i++) {
        const argus_robot_t *robot = argus_robot_find(body[i].name);
        TEST_ASSERT_NOT_NULL_MESSAGE(robot, body[i].name);
        TEST_ASSERT_EQUAL_STRING(body[i].name, robot->name);
        TEST_ASSERT_EQUAL_MESSAGE(body[i].front, robot->front_mm, body[i].name);
        TEST_ASSERT_EQUAL_MESSAGE(body[i].rear, robot->rear_mm, body[i].name);
        TEST_ASSERT_EQUAL_MESSAGE(body[i].width, robot->width_mm, body[i].name);
        TEST_ASSERT_EQUAL_MESSAGE(body[i].sonars, robot->sonars, body[i].name);
        const double corner = hypot(fmax(body[i].front, body[i].rear), body[i].width / 2.0);
        TEST_ASSERT_TRUE_MESSAGE(robot->swing_radius_mm >= corner, body[i].name);
        TEST_ASSERT_TRUE_MESSAGE(robot->swing_radius_mm < corner + 10, body[i].name);
        TEST_ASSERT_EQUAL_MESSAGE((body[i].width + 1) / 2, argus_robot_half_width_mm(robot), body[i].name);
    }
}

void test_the_bearings_are_the_vendors(void) {
    for (int row = 0; row < ARGUS_ROBOTS; row++) {
        const argus_robot_t *robot = robot_at(row);
        const bool is_amigo = strcmp(robot->name, "amigo-sh") == 0;
        for (int i = 0; i < argus_robot_sonars(robot); i++) {
            TEST_ASSERT_EQUAL_MESSAGE(is_amigo ? amigo[i] : ring[i % 16], bearing(robot, i), text);
        }
    }
}

void test_every_face_lies_in_its_body_and_looks_outwards(void) {
    for (int row = 0; row < ARGUS_ROBOTS; row++) {
        const argus_robot_t *robot = robot_at(row);
        int foremost = 0;
        for (int i = 0; i < argus_robot_sonars(robot); i++) {
            const argus_sonar_pose_t p = argus_robot_pose(robot, i);
            TEST_ASSERT_TRUE_MESSAGE(p.x_mm <= robot->front_mm && p.x_mm >= -robot->rear_mm, text);
            TEST_ASSERT_TRUE_MESSAGE(2 * abs(p.y_mm) <= robot->width_mm, text);
            TEST_ASSERT_TRUE_MESSAGE(
                p.x_mm * cos(p.heading_deg * DEG) + p.y_mm * sin(p.heading_deg * DEG) > 0, text);
            foremost = p.x_mm > foremost ? p.x_mm : foremost;
        }
        TEST_ASSERT_EQUAL_MESSAGE(robot->sonar_face_mm, foremost, text);
    }
}

void test_left_and_right_look_alike(void) {
    for (int row = 0; row < ARGUS_ROBOTS; row++) {
        const argus_robot_t *robot = robot_at(row);
        for (int i = 0; i < argus_robot_sonars(robot); i++) {
            int mirrored = 0;
            for (int k = 0; k < argus_robot_sonars(robot); k++) {
                mirrored += bearing(robot, k) == -bearing(robot, i);
            }
            TEST_ASSERT_TRUE_MESSAGE(mirrored >= 1, text);
        }
    }
}

void test_masks_follow_from_bearings(void) {
    for (int row = 0; row < ARGUS_ROBOTS; row++) {
        const argus_robot_t *robot = robot_at(row);
        unsigned ahead = 0, astern = 0, flank = 0, rear_flank = 0;
        for (int i = 0; i < argus_robot_sonars(robot); i++) {
            const double off = fabs((double)bearing(robot, i));
            const bool front = argus_robot_pose(robot, i).x_mm > 0;
            ahead |= off < 90 ? 1u << i : 0u;
            astern |= off > 90 ? 1u << i : 0u;
            flank |= off == 90 && front ? 1u << i : 0u;
            rear_flank |= off == 90 && !front ? 1u << i : 0u;
        }
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(ahead, argus_robot_ahead(robot), text);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(astern, argus_robot_astern(robot), text);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(flank, argus_robot_flank(robot), text);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(rear_flank, argus_robot_rear_flank(robot), text);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(ahead | astern | flank | rear_flank, argus_robot_all(robot), text);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, argus_robot_forward(robot) & ~ahead, text);
    }
}

void test_the_papers_six(void) {
    const argus_robot_t *robot = argus_robot_default();
    TEST_ASSERT_EQUAL_STRING("p3dx-sh", robot->name);
    TEST_ASSERT_EQUAL_HEX32(0x7E, argus_robot_forward(robot));
    TEST_ASSERT_EQUAL_HEX32(0x1E, argus_robot_forward(argus_robot_find("amigo-sh")));
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL(i >= 1 && i <= 6, argus_robot_faces_forward(robot, i));
    }
}

void test_neighbours_stand_side_by_side(void) {
    for (int row = 0; row < ARGUS_ROBOTS; row++) {
        const argus_robot_t *robot = robot_at(row);
        for (int i = 0; i < argus_robot_sonars(robot); i++) {
            const argus_sonar_pose_t p = argus_robot_pose(robot, i);
            const int left = argus_robot_beside(robot, i, true);
            const int right = argus_robot_beside(robot, i, false);
            TEST_ASSERT_EQUAL_MESSAGE(argus_robot_faces_forward(robot, i), left >= 0 || right >= 0, text);
            if (left >= 0) {
                TEST_ASSERT_EQUAL_MESSAGE(i, argus_robot_beside(robot, left, false), text);
                const int apart = bearing(robot, left) - p.heading_deg;
                TEST_ASSERT_TRUE_MESSAGE(apart >= 20 && apart <= 30, text);
            }
        }
    }
}

void test_the_tolerance_is_that_of_the_widest_neighbours(void) {
    static const struct {
        const char *name;
        double apart;
    } widest[] = {{"p3dx-sh", 20}, {"p3at-sh", 20}, {"amigo-sh", 30}, {"peoplebot-sh", 20}};
    for (size_t i = 0; i < sizeof widest / sizeof widest[0]; i++) {
        const double excess = 1 / cos(widest[i].apart * DEG) - 1;
        TEST_ASSERT_EQUAL_MESSAGE(lround(excess * 4294967296.0),
                                  argus_robot_find(widest[i].name)->tolerance_excess, widest[i].name);
    }
}

// ARCOS: eight transducers to an array, numbered in a row.
void test_arrays_hold_eight_in_a_row(void) {
    for (int row = 0; row < ARGUS_ROBOTS; row++) {
        const argus_robot_t *robot = robot_at(row);
        TEST_ASSERT_EQUAL_MESSAGE(robot->sonars, robot->arrays * 8, text);
        for (int array = 0; array < robot->arrays && array * 8 < ARGUS_SONARS; array++) {
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(0xFFu << 8 * array, argus_robot_array(robot, array), text);
        }
    }
}

void test_who_is_found_under_which_name(void) {
    TEST_ASSERT_EQUAL_PTR(argus_robot_default(), argus_robot_find("p3dx-sh"));
    TEST_ASSERT_EQUAL_PTR(argus_robot_default(), argus_robot_find("P3DX-sh"));
    TEST_ASSERT_EQUAL_PTR(argus_robot_default(),
                          argus_robot_find("p3dx")); // the older controller on that body
    TEST_ASSERT_EQUAL_STRING("amigo-sh", argus_robot_find("AmigO-Sh")->name);
    static const char *const strange[] = {"",     "p3dx-s", "p3dx-shx", "powerbot-sh",
                                          "p3at", "amigo",  "p2de",     "by-subclass"};
    for (size_t i = 0; i < sizeof strange / sizeof strange[0]; i++) {
        TEST_ASSERT_NULL_MESSAGE(argus_robot_find(strange[i]), strange[i]);
    }
}

void test_the_choices_are_the_rows(void) {
    const char *choices = "";
    int most = 0;
#define FIND(key, def, min, max, unit, names, meaning) \
    if (strcmp(#key, "robot") == 0) {                  \
        choices = names;                               \
        most = max;                                    \
    }
    ARGUS_CONFIG_TABLE(FIND)
    const char *at = strchr(choices, '|');
    TEST_ASSERT_EQUAL(ARGUS_ROBOTS, most);
    TEST_ASSERT_NULL(argus_robot_chosen(0));
    for (int choice = 1; choice <= ARGUS_ROBOTS; choice++) {
        const argus_robot_t *robot = argus_robot_chosen(choice);
        TEST_ASSERT_NOT_NULL(at);
        TEST_ASSERT_EQUAL(strlen(robot->name), strcspn(at + 1, "|"));
        TEST_ASSERT_EQUAL_MEMORY(robot->name, at + 1, strlen(robot->name));
        TEST_ASSERT_EQUAL(choice, argus_robot_choice(robot));
        at = strchr(at + 1, '|');
    }
    TEST_ASSERT_NULL(at);
    TEST_ASSERT_NULL(argus_robot_chosen(ARGUS_ROBOTS + 1));
    TEST_ASSERT_NULL(argus_robot_chosen(-1));
}

void test_nothing_is_known_of_an_unknown_one(void) {
    const argus_robot_t *robot = argus_robot_unknown();
    TEST_ASSERT_FALSE(argus_robot_is_known(robot));
    TEST_ASSERT_TRUE(argus_robot_is_known(argus_robot_default()));
    TEST_ASSERT_EQUAL(0, argus_robot_choice(robot));
    TEST_ASSERT_EQUAL(0, argus_robot_sonars(robot));
    TEST_ASSERT_EQUAL_HEX32(0, argus_robot_all(robot));
    TEST_ASSERT_TRUE(robot->swing_radius_mm > 5000); // it turns nowhere
}

void test_a_build_manages_as_many_as_it_was_made_for(void) {
    TEST_ASSERT_EQUAL(32 < ARGUS_SONARS ? 32 : ARGUS_SONARS,
                      argus_robot_sonars(argus_robot_find("peoplebot-sh")));
    TEST_ASSERT_EQUAL(8, argus_robot_sonars(argus_robot_find("amigo-sh")));
    TEST_ASSERT_EQUAL(ARGUS_SONARS, argus_count_bits(argus_robot_all(argus_robot_find("peoplebot-sh"))));
}

// The other end
// ------------------------------------------------------------------------------------------------

static void is_turned(const argus_robot_t *robot, const argus_robot_t *end) {
    TEST_ASSERT_EQUAL_STRING(robot->name, end->name);
    TEST_ASSERT_EQUAL(robot->front_mm, end->rear_mm);
    TEST_ASSERT_EQUAL(robot->rear_mm, end->front_mm);
    TEST_ASSERT_EQUAL(robot->front_bumpers, end->rear_bumpers);
    TEST_ASSERT_EQUAL(robot->swing_radius_mm, end->swing_radius_mm);
    TEST_ASSERT_EQUAL(robot->ahead_mask, end->astern_mask);
    TEST_ASSERT_EQUAL(robot->astern_mask, end->ahead_mask);
    TEST_ASSERT_EQUAL(robot->flank_mask, end->rear_flank_mask);
    TEST_ASSERT_EQUAL(robot->rear_flank_mask, end->flank_mask);
    TEST_ASSERT_EQUAL(0, end->forward_mask & ~end->ahead_mask);
    for (int i = 0; i < argus_robot_sonars(robot); i++) {
        const argus_sonar_pose_t a = argus_robot_pose(robot, i), b = argus_robot_pose(end, i);
        TEST_ASSERT_EQUAL_MESSAGE(-a.x_mm, b.x_mm, robot->name);
        TEST_ASSERT_EQUAL_MESSAGE(-a.y_mm, b.y_mm, robot->name);
        TEST_ASSERT_EQUAL_MESSAGE(18000, argus_angle_abs_diff(a.heading_deg * 100, b.heading_deg * 100),
                                  robot->name);
    }
}

void test_the_other_end_is_the_robot_turned_by_180_degrees(void) {
    int ends = 0;
    for (int row = 0; row < ARGUS_ROBOTS; row++) {
        const argus_robot_t *robot = robot_at(row), *end = argus_robot_other_end(robot);
        TEST_ASSERT_FALSE(robot->reversed);
        TEST_ASSERT_EQUAL_PTR(robot, argus_robot_built(robot));
        if (end == NULL) {
            continue;
        }
        ends++;
        is_turned(robot, end);
        TEST_ASSERT_TRUE(end->reversed);
        TEST_ASSERT_EQUAL_PTR(robot, argus_robot_other_end(end));
        TEST_ASSERT_EQUAL_PTR(robot, argus_robot_built(end));
        TEST_ASSERT_EQUAL(argus_robot_choice(robot), argus_robot_choice(end));
        TEST_ASSERT_EQUAL(robot->forward_count, end->forward_count);
        for (int i = 0; i < end->forward_count; i++) {
            TEST_ASSERT_EQUAL(bearing(robot, robot->forward[i]), bearing(end, end->forward[i]));
        }
    }
    const argus_robot_t *const amigo_bot = argus_robot_find("amigo-sh"); // which has two sonars astern
    TEST_ASSERT_NULL(argus_robot_other_end(amigo_bot));
    TEST_ASSERT_TRUE(ARGUS_SONARS > 8 ? ends >= 3 : ends == 0);
    TEST_ASSERT_NULL(argus_robot_other_end(argus_robot_unknown()));
}

// Only the arrays of those that face forward fire in an order of ours, whichever end that is.
void test_who_is_polled(void) {
    const argus_robot_t *const robot = argus_robot_default();
    TEST_ASSERT_EQUAL_HEX32(0x00FF, argus_robot_polled(robot));
    TEST_ASSERT_EQUAL_HEX32(0xFF00, argus_robot_polled(argus_robot_other_end(robot)));
}

// Of an array that looks to both ends those astern do not lead.
void test_who_leads(void) {
    const argus_robot_t *const robot = argus_robot_default();
    const argus_robot_t *const amigo_bot = argus_robot_find("amigo-sh");
    TEST_ASSERT_EQUAL_HEX32(0x00FF, argus_robot_leading(robot));
    TEST_ASSERT_EQUAL_HEX32(0x00FF, argus_robot_polled(amigo_bot));
    TEST_ASSERT_EQUAL_HEX32(0x003F, argus_robot_leading(amigo_bot));
    if (ARGUS_SONARS > 8) {
        TEST_ASSERT_EQUAL_HEX32(0xFF00, argus_robot_leading(argus_robot_other_end(robot)));
    }
}
