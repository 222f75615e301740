// SPDX-License-Identifier: MIT
// Attacks: a shortest reading that the robot goes away from is taken for a fault, or is not; walls really
// there and who walks by are called faults; what was proved once never ends.
#include "awareness/extremes.h"

#include <string.h>

#include "awareness/numbers.h"
#include "knowledge/body.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_extremes_t extremes;

void setUp(void) {
    argus_knowledge_init(&k);
    argus_body_is(&k, argus_robot_default(), 0);
    argus_extremes_init(&extremes);
}

static void read_at(int sonar, int32_t x_mm, int reading_mm) {
    k.pose.x_mm = x_mm;
    k.fresh = (argus_mask_t)(1u << sonar);
    k.sonar[sonar].reading_mm = (uint16_t)reading_mm;
    k.sonar[sonar].reported = true;
    argus_extremes_sip(&extremes, &k);
}

void test_it_stays_while_the_robot_backs_away(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        setUp();
        for (int x = 0; x >= -120; x -= 20) {
            read_at(sonar, x, 100);
        }
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, sonar));
        for (int x = -140; x >= -450; x -= 20) {
            read_at(sonar, x, 100);
        }
        TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus_extremes_convicts(&extremes, sonar));
    }
}

void test_a_rear_one_while_the_robot_drives_ahead(void) {
    for (int x = 0; x <= 300; x += 20) {
        read_at(12, x, 103);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus_extremes_convicts(&extremes, 12));
}

void test_to_and_fro_is_no_way(void) {
    for (int i = 0; i < 200; i++) {
        read_at(3, i % 8 < 4 ? -20 * (i % 8) : -20 * (8 - i % 8), 100);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
}

void test_what_really_stands_there_grows(void) {
    for (int x = 0; x >= -450; x -= 20) {
        read_at(3, x, x > -40 ? 100 : 60 - x);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
    TEST_ASSERT_FALSE(argus_extremes_keeps_out(&extremes, 3));
}

void test_a_turn_begins_it_anew(void) {
    for (int i = 0; i < 20; i++) {
        k.pose.heading_cdeg = i * 1100;
        read_at(3, -40 * i, 100);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
}

// Abeam it takes a greater turn: so near, another on that side would still hear what is there.
void test_how_far_a_turn_may_go_depends_on_where_it_looks(void) {
    for (int sonar = 0; sonar < 16; sonar++) {
        const unsigned abeam =
            argus_robot_flank(argus_robot_default()) | argus_robot_rear_flank(argus_robot_default());
        const int most_cdeg =
            (abeam >> sonar & 1u) != 0 ? ARGUS_SHORTEST_TURNED_ABEAM_CDEG : ARGUS_SHORTEST_TURNED_CDEG;
        for (int beyond = 0; beyond < 2; beyond++) {
            setUp();
            read_at(sonar, 0, 100);
            k.pose.heading_cdeg = most_cdeg + beyond;
            read_at(sonar, 0, 100);
            TEST_ASSERT_EQUAL(beyond != 0 ? most_cdeg + 1 : 0, extremes.of[sonar].from_cdeg);
        }
    }
}

static void pass_by(int way_mm, int mate_mm) {
    for (int x = 0; x <= way_mm; x += 20) {
        k.sonar[15].reported = mate_mm > 0;
        k.sonar[15].reading_mm = (uint16_t)mate_mm;
        read_at(0, x, 100);
    }
}

void test_abeam_the_mate_on_the_same_side_tells(void) {
    pass_by(640, 1900);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus_extremes_convicts(&extremes, 0));
    setUp();
    pass_by(6000, 120); // both hear the wall
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 0));
    setUp();
    pass_by(1500, 5000); // the mate hears nothing: it cannot tell
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 0));
    pass_by(2100, 0);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus_extremes_convicts(&extremes, 0));
}

// A mate that reads its shortest, too, hears the wall for all that is known.
void test_two_that_read_their_shortest_prove_nothing_by_a_way_along(void) {
    pass_by(6000, 100);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 0));
}

// What was proved ends with the first reading that is another one, be it as near.
void test_a_reading_that_changes_takes_the_proof_back(void) {
    for (int x = 0; x >= -450; x -= 20) {
        read_at(3, x, 100);
    }
    TEST_ASSERT_TRUE(argus_extremes_keeps_out(&extremes, 3));
    read_at(3, -470, 160);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
    TEST_ASSERT_FALSE(argus_extremes_keeps_out(&extremes, 3));
}

void test_below_the_least_needs_no_way(void) {
    for (int reading = 0; reading < 100; reading += 11) {
        setUp();
        for (int i = 0; i < 4; i++) {
            read_at(3, 0, reading);
        }
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3)); // four may be the line
        read_at(3, 0, reading);
        TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus_extremes_convicts(&extremes, 3));
    }
}

void test_the_least_at_rest_proves_nothing(void) {
    for (int i = 0; i < 1000; i++) {
        read_at(3, 0, 100 + i % 5);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
    TEST_ASSERT_FALSE(argus_extremes_keeps_out(&extremes, 3));
}

void test_leaps_to_the_least_name_it_and_good_readings_let_it_return(void) {
    for (int i = 0; i < 40; i++) {
        read_at(3, 0, i % 4 == 0 ? 100 : 1500);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, argus_extremes_convicts(&extremes, 3));
    for (int i = 0; i < 120; i++) {
        read_at(3, 0, 1500);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
    TEST_ASSERT_FALSE(argus_extremes_keeps_out(&extremes, 3));
}

void test_who_walks_by_close_is_no_fault(void) {
    for (int i = 0; i < 400; i++) { // twice in 60 readings, for three readings each
        read_at(3, 0, i % 30 < 3 ? 180 : 2000);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
}

// What comes so near that one sonar reads its least is heard as near by one beside it, a round later at the
// latest.
void test_what_one_beside_it_hears_as_near_is_no_leap(void) {
    static const int beside[] = {2, 4, 1, 5};
    for (unsigned n = 0; n < sizeof beside / sizeof *beside; n++) {
        for (int late = 0; late < 2; late++) {
            setUp();
            for (int i = 0; i < 200; i++) {
                const bool here = i % 4 == 0 || (late != 0 && i % 4 == 1);
                k.sonar[beside[n]].reported = true;
                k.sonar[beside[n]].reading_mm = here ? 250 : 1500;
                read_at(3, 0, i % 4 == 0 ? 100 : 1500);
            }
            TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
        }
    }
}

// One that looks elsewhere, that is far, or that reads its own least, bears nothing out.
void test_a_leap_that_nobody_bears_out_counts(void) {
    static const struct {
        int sonar;
        int reading_mm;
    } other[] = {{12, 250}, {4, 900}, {4, 100}, {4, 5000}};
    for (unsigned n = 0; n < sizeof other / sizeof *other; n++) {
        setUp();
        for (int i = 0; i < 40; i++) {
            k.sonar[other[n].sonar].reported = true;
            k.sonar[other[n].sonar].reading_mm = (uint16_t)other[n].reading_mm;
            read_at(3, 0, i % 4 == 0 ? 100 : 1500);
        }
        TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, argus_extremes_convicts(&extremes, 3));
    }
}

// A person beside the robot holds the least for as long as he likes; once he is gone the way counts.
void test_who_goes_along_beside_the_robot_is_no_fault(void) {
    for (int x = 0; x <= 3000; x += 20) {
        k.sonar[15].reported = k.sonar[1].reported = true;
        k.sonar[15].reading_mm = 1900; // the mate behind hears the wall
        k.sonar[1].reading_mm = 180;   // the one before it hears him
        read_at(0, x, 100);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 0));
    k.sonar[1].reading_mm = 1900;
    for (int x = 3020; x <= 3400; x += 20) {
        read_at(0, x, 100);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus_extremes_convicts(&extremes, 0));
}

void test_a_gap_of_the_link_begins_it_anew(void) {
    for (int x = 0; x > -1000; x -= 150) {
        read_at(3, x, 100);
        argus_extremes_restart(&extremes);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
}

void test_an_operator_forgets_it(void) {
    test_below_the_least_needs_no_way();
    argus_extremes_forget(&extremes, 3);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_extremes_convicts(&extremes, 3));
}
