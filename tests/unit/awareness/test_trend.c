// SPDX-License-Identifier: MIT
// Rule under attack: what grows over the way driven is foretold before it convicts, once; what stays, comes
// and goes or befalls all alike is not.
#include "awareness/trend.h"

#include <stdio.h>
#include <string.h>

#include "health.h"
#include "unity.h"

#define PING_MM 65 // way between two readings of a sonar

static argus_trend_t trend;
static argus_knowledge_t k;
static uint32_t seed;

void setUp(void) {
    argus_trend_init(&trend);
    argus_knowledge_init(&k);
    seed = 7;
}

static double chance(void) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0;
}

// One reading of every sonar, of a wall at 2 m; `lost` is the part that `sonar` does not hear, -1: all of
// them lose it.
static void ping(int sonar, double lost) {
    k.odometer_mm += PING_MM;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const bool misses = (i == sonar || sonar < 0) && chance() < lost;
        k.sonar[i].reading_mm = misses ? 5000 : (uint16_t)(2000 + (int)(chance() * 20));
        argus_trend_reading(&trend, &k, i);
    }
    argus_trend_sip(&trend, &k);
}

// Drives so far; the first sonar that is foretold to fail, its horizon and where; -1: none.
typedef struct {
    int sonar;
    int32_t metres;
    double at_m;
} news_t;

static void look(news_t *news, double at_m) {
    const int sonar = argus_trend_news(&trend, &k);
    if (sonar >= 0 && news->sonar < 0) {
        *news = (news_t){sonar, argus_trend_horizon_m(&trend, sonar), at_m};
    }
}

static news_t drive_dropouts(int sonar, double metres, double from, double to) {
    news_t news = {-1, 0, 0};
    for (double at = 0; at < metres; at += PING_MM / 1000.0) {
        ping(sonar, from + (to - from) * at / metres);
        look(&news, at);
    }
    return news;
}

void test_growing_dropouts_are_foretold_in_time(void) {
    for (int sonar = 0; sonar < ARGUS_SONARS; sonar++) {
        setUp();
        drive_dropouts(sonar, 20, 0, 0);
        const news_t news = drive_dropouts(sonar, 100, 0, 0.2);
        TEST_ASSERT_EQUAL(sonar, news.sonar);
        char text[80];
        snprintf(text, sizeof text, "sonar %d: at %.0f m, %d m to go", sonar, news.at_m, (int)news.metres);
        TEST_ASSERT_TRUE_MESSAGE(news.at_m < 45, text); // 10 % are reached at 50 m
        const double truth = 50 - news.at_m;
        TEST_ASSERT_TRUE_MESSAGE(news.metres > truth / 3 && news.metres < truth * 3, text);
    }
}

void test_steady_dropouts_are_no_trend(void) {
    for (int percent = 0; percent <= 20; percent += percent < 5 ? 1 : 5) {
        setUp();
        const news_t news = drive_dropouts(3, 1000, percent / 100.0, percent / 100.0);
        char text[80];
        snprintf(text, sizeof text, "%d %%: at %.0f m, %d m to go", percent, news.at_m, (int)news.metres);
        TEST_ASSERT_EQUAL_MESSAGE(-1, news.sonar, text);
    }
}

void test_what_befalls_all_is_the_place(void) {
    TEST_ASSERT_EQUAL(-1, drive_dropouts(-1, 100, 0, 0.2).sonar);
}

// One bad place of a few metres, again and again.
void test_a_bad_place_is_no_trend(void) {
    news_t news = {-1, 0, 0};
    for (int round = 0; round < 10; round++) {
        for (double at = 0; at < 30; at += PING_MM / 1000.0) {
            ping(3, at < 3 ? 0.5 : 0);
            look(&news, at);
        }
    }
    TEST_ASSERT_EQUAL(-1, news.sonar);
}

static int32_t bias_of(int sonar) {
    return trend.of[sonar].slope[ARGUS_TREND_BIAS].fast;
}

static news_t drive_bias(int sonar, double metres, double from_mm, double to_mm) {
    news_t news = {-1, 0, 0};
    for (double at = 0; at < metres; at += 0.25) {
        k.odometer_mm += 250;
        const int32_t bias = (int32_t)(from_mm + (to_mm - from_mm) * at / metres);
        for (int i = 0; i < ARGUS_SONARS; i++) {
            const int next = (i + 1) % ARGUS_SONARS;
            const int32_t noise = (int32_t)(chance() * 60) - 30;
            argus_trend_pair(&trend, &k, i, 2000 + noise + (i == sonar ? bias : 0), next,
                             2030 + (next == sonar ? bias : 0), 30);
        }
        argus_trend_sip(&trend, &k);
        look(&news, at);
    }
    return news;
}

void test_growing_bias_is_laid_to_the_one_that_has_it(void) {
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        drive_bias(4, 30, 0, 0);
        const news_t news = drive_bias(4, 150, 0, sign * 300);
        TEST_ASSERT_EQUAL(4, news.sonar);
        TEST_ASSERT_TRUE(news.at_m < 60);
        TEST_ASSERT_TRUE(sign * bias_of(4) > 1440); // of what may differ, as the rule has it
        TEST_ASSERT_INT_WITHIN(1440, 0, bias_of(9));
    }
}

void test_a_constant_bias_is_no_trend(void) {
    TEST_ASSERT_EQUAL(-1, drive_bias(4, 300, 60, 60).sonar);
    TEST_ASSERT_TRUE(bias_of(4) > 1440);
}

void test_shrinking_range_is_foretold(void) {
    news_t news = {-1, 0, 0};
    for (int at = 0; at < 200; at++) {
        k.odometer_mm += 1000;
        for (int i = 0; i < ARGUS_SONARS; i++) {
            const bool deaf = i == 2 && chance() < (at - 60) / 200.0;
            argus_trend_pair(&trend, &k, i, deaf ? 5000 : 3000, (i + 8) % ARGUS_SONARS, 3000,
                             0); // and heard as the other
        }
        argus_trend_sip(&trend, &k);
        look(&news, at);
    }
    TEST_ASSERT_EQUAL(2, news.sonar);
    char text[80];
    snprintf(text, sizeof text, "at %.0f m, %d m to go", news.at_m, (int)news.metres);
    const double truth = 180 - news.at_m; // where 30 % are reached
    TEST_ASSERT_TRUE_MESSAGE(news.at_m > 60 && truth > 20, text);
    TEST_ASSERT_TRUE_MESSAGE(news.metres > truth / 3 && news.metres < truth * 3, text);
}

// A sonar that is out is no witness.
void test_one_that_is_out_biases_no_other(void) {
    put_health(&k.sonar[4], ARGUS_DISABLED, ARGUS_KIND_WRONG, 0);
    TEST_ASSERT_EQUAL(-1, drive_bias(4, 150, 0, 300).sonar);
    TEST_ASSERT_INT_WITHIN(1440, 0, bias_of(5));
}

void test_said_once_and_again_after_it_was_over(void) {
    drive_dropouts(3, 20, 0, 0);
    int said = 0;
    for (int round = 0; round < 2; round++) {
        for (double at = 0; at < 60; at += PING_MM / 1000.0) {
            ping(3, at * 0.2 / 60);
            said += argus_trend_news(&trend, &k) == 3;
        }
        TEST_ASSERT_EQUAL(round + 1, said);
        for (double at = 0; at < 100; at += PING_MM / 1000.0) {
            ping(3, 0);
            said += argus_trend_news(&trend, &k) >= 0;
        }
        TEST_ASSERT_EQUAL(round + 1, said);
        TEST_ASSERT_EQUAL(0, argus_trend_horizon_m(&trend, 3));
    }
}

void test_neither_turns_nor_rest_nor_a_lost_thing_count(void) {
    for (int i = 0; i < 400; i++) {
        k.rotating = i % 3 == 0;
        k.still_sips = i % 3 == 1 ? 5 : 0;
        k.odometer_mm += PING_MM;
        k.sonar[3].reading_mm = i % 3 == 2 ? 5000 : 2000;
        argus_trend_reading(&trend, &k, 3);
    }
    TEST_ASSERT_EQUAL(0, trend.of[3].count[ARGUS_TREND_DROPOUT]);
    k.rotating = false;
    k.still_sips = 0;
    for (int i = 0; i < 400; i++) { // a thing passed, then another one at another distance
        k.odometer_mm += PING_MM;
        k.sonar[3].reading_mm = i % 4 == 3 ? 5000 : (uint16_t)(i % 8 < 4 ? 1000 : 2500);
        argus_trend_reading(&trend, &k, 3);
    }
    TEST_ASSERT_EQUAL(0, trend.of[3].sum[ARGUS_TREND_DROPOUT]);
    TEST_ASSERT_TRUE(trend.of[3].count[ARGUS_TREND_DROPOUT] > 100);
}

void test_forgetting_one_leaves_the_others(void) {
    drive_dropouts(3, 60, 0, 0.2);
    argus_trend_forget(&trend, 3);
    TEST_ASSERT_EQUAL(0, argus_trend_horizon_m(&trend, 3));
    TEST_ASSERT_EQUAL(0, trend.of[3].slope[0].segments);
    TEST_ASSERT_TRUE(trend.of[2].slope[0].segments > 5);
    argus_trend_restart(&trend);
    TEST_ASSERT_EQUAL(0, trend.of[2].count[0]);
    TEST_ASSERT_TRUE(trend.of[2].slope[0].segments > 5);
}
