// SPDX-License-Identifier: MIT
// Attacks: one at a time orders, each order once; who may not speak is not heard; who does not read is never
// waited for.
#include "control.h"

#include "control_bench.h"

static bench_client_t a;
static bench_client_t b;

void setUp(void) {
    bench_begin(false, true);
    bench_connect(&a);
    bench_connect(&b);
}

void tearDown(void) {
    bench_end(&a);
    bench_end(&b);
    bench_finish();
}

static void expect_order(bench_client_t *client, int seq, const char *order, const char *part) {
    const char *const said = bench_order(client, seq, order);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, part), said);
}

static bool is_moving(void) {
    return bench_robot.v != 0 || bench_robot.w != 0;
}

// The sonar's robot runs on until the order has made it move.
static bool moves_within(uint32_t ms) {
    for (uint32_t at = 0; at < ms; at += 10) {
        bench_run(10);
        if (is_moving()) {
            return true;
        }
    }
    return false;
}

void test_who_connects_is_greeted(void) {
    bench_serve();
    TEST_ASSERT_TRUE(bench_hear(&a));
    TEST_ASSERT_EQUAL_STRING("{\"control\":1,\"argus\":\"" ARGUS_VERSION "\",\"auth\":\"none\"}\n", a.text);
}

void test_each_request_has_one_reply_with_its_id(void) {
    bench_serve();
    bench_hear(&a);
    TEST_ASSERT_EQUAL_STRING("{\"re\":7,\"ok\":true}\n", bench_ask(&a, "{\"do\":\"hello\",\"id\":7}"));
    TEST_ASSERT_EQUAL_STRING("{\"re\":\"x\\u000a\",\"ok\":true}\n",
                             bench_ask(&a, "{\"id\":\"x\\n\",\"do\":\"hello\"}\r"));
    TEST_ASSERT_EQUAL_STRING("{\"re\":null,\"ok\":true}\n", bench_ask(&a, "{\"do\":\"hello\"}"));
    bench_expect(&a, "{\"do\":\"hello\",\"id\":1.5}", "{\"re\":null,\"ok\":false,\"why\":\"bad_argument\"");
    bench_expect(&a, "{\"do\":\"dance\",\"id\":1}", "{\"re\":1,\"ok\":false,\"why\":\"unknown\"");
    bench_expect(&a, "{\"id\":1}", "{\"re\":1,\"ok\":false,\"why\":\"bad_argument\"");
    bench_expect(&a, "{\"do\":\"hello\",\"id\":1", "{\"re\":null,\"ok\":false,\"why\":\"bad_json\"");
    bench_expect(&a, "", "\"bad_json\"");
    bench_expect(&a, "{\"do\":\"status\",\"id\":3}", "{\"re\":3,\"ok\":true,\"state\":{\"t\":");
    TEST_ASSERT_NOT_NULL(strstr(a.text, "\"controlled\":false,\"injected\":[\"\",\"\""));
    TEST_ASSERT_EQUAL_STRING("}}\n", a.text + a.used - 3);
}

void test_a_line_beyond_the_bound_is_passed_over(void) {
    static char line[CONTROL_LINE_MAX + 100];
    memset(line, ' ', sizeof line);
    line[sizeof line - 1] = '\0';
    bench_expect(&a, line, "\"why\":\"too_long\"");
    TEST_ASSERT_NULL(strstr(strstr(a.text, "too_long"), "bad_json"));
    bench_expect(&a, "{\"do\":\"hello\",\"id\":8}", "{\"re\":8,\"ok\":true}");
    memcpy(line, "{\"do\":\"hello\"}", 14);
    line[CONTROL_LINE_MAX - 1] = '\0'; // with its end it is as long as may be
    bench_expect(&a, line, "\"ok\":true");
}

void test_one_at_a_time_has_control(void) {
    bench_expect(&a, "{\"do\":\"order\",\"order\":\"go\"}", "\"not_in_control\"");
    bench_expect(&a, "{\"do\":\"take\"}", "\"grant\":\"");
    TEST_ASSERT_EQUAL_size_t(32, strlen(bench.grant));
    bench_expect(&b, "{\"do\":\"take\"}", "\"taken\"");
    bench_expect(&b, "{\"do\":\"take\",\"force\":1}", "\"bad_argument\"");
    TEST_ASSERT_TRUE(control_is_held(&bench));
    bench_expect(&b, "{\"do\":\"take\",\"force\":true}", "\"grant\":\"");
    bench_hear(&a);
    TEST_ASSERT_NOT_NULL(strstr(a.text, "{\"lost\":\"control\"}\n"));
    expect_order(&a, 1, "\"recheck\"", "\"stale_grant\"");
    expect_order(&b, 1, "\"recheck\"", "\"ok\":true");
    bench_expect(&a, "{\"do\":\"release\"}", "\"not_in_control\"");
    bench_expect(&b, "{\"do\":\"release\"}", "\"ok\":true");
    TEST_ASSERT_FALSE(control_is_held(&bench));
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    bench_end(&a);
    bench_serve();
    TEST_ASSERT_FALSE(control_is_held(&bench));
}

void test_an_order_counts_once_and_for_its_grant(void) {
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    expect_order(&a, 5, "\"recheck\"", "\"ok\":true");
    expect_order(&a, 5, "\"recheck\"", "\"replayed\"");
    expect_order(&a, 4, "\"recheck\"", "\"replayed\"");
    expect_order(&a, 6, "\"recheck\"", "\"ok\":true");
    char old[40];
    strcpy(old, bench.grant);
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    TEST_ASSERT_TRUE(strcmp(old, bench.grant) != 0);
    expect_order(&a, 1, "\"recheck\"", "\"ok\":true");
    strcpy(bench.grant + 31, bench.grant[31] == '0' ? "1" : "0"); // it is another now
    char line[128];
    snprintf(line, sizeof line, "{\"do\":\"order\",\"grant\":\"%s\",\"seq\":9,\"order\":\"recheck\"}", old);
    bench_expect(&a, line, "\"stale_grant\"");
    bench_expect(&a, "{\"do\":\"order\",\"seq\":9,\"order\":\"recheck\"}", "\"bad_argument\"");
}

void test_everybody_may_stop_it(void) {
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    expect_order(&a, 1, "\"goto\",\"x_mm\":2000,\"y_mm\":0", "\"ok\":true");
    TEST_ASSERT_TRUE(moves_within(8000));
    bench_expect(&b, "{\"do\":\"order\",\"order\":\"stop\"}", "\"ok\":true");
    bench_run(3000);
    TEST_ASSERT_FALSE(is_moving());
    TEST_ASSERT_TRUE(bench_look(NULL)->status.paused);
    TEST_ASSERT_TRUE(control_is_held(&bench));
}

void test_a_hand_that_lets_go_stops_the_robot(void) {
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    expect_order(&a, 1, "\"turn\",\"deg\":170", "\"ok\":true");
    TEST_ASSERT_TRUE(moves_within(3000));
    bench_end(&a);
    bench_run(1000);
    TEST_ASSERT_TRUE(bench_look(NULL)->status.paused);
    bench_run(3000);
    TEST_ASSERT_FALSE(is_moving());
    TEST_ASSERT_TRUE(robot_heading_deg(&bench_robot) < 150);
}

void test_a_course_goes_on_without_a_hand(void) {
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    expect_order(&a, 1, "\"course\",\"points\":[[600,0],[1200,100]]", "\"ok\":true");
    TEST_ASSERT_TRUE(moves_within(8000));
    bench_end(&a);
    bench_run(20000);
    TEST_ASSERT_EQUAL_INT(ARGUS_MISSION_REACHED, bench_look(NULL)->status.mission);
}

void test_a_turn_that_is_over_leaves_nothing_to_stop(void) {
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    expect_order(&a, 1, "\"turn\",\"deg\":20", "\"ok\":true");
    bench_run(8000);
    bench_expect(&a, "{\"do\":\"release\"}", "\"ok\":true");
    TEST_ASSERT_FALSE(bench_look(NULL)->status.paused);
    TEST_ASSERT_TRUE(robot_heading_deg(&bench_robot) > 15);
}

// stop && turn: what is asked meanwhile is refused with a word of its own, by which a client knows that it
// passes.
void test_after_a_stop_a_motion_is_refused_only_until_the_sonars_are_checked(void) {
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    expect_order(&a, 1, "\"goto\",\"x_mm\":2000,\"y_mm\":0", "\"ok\":true");
    TEST_ASSERT_TRUE(moves_within(8000));
    expect_order(&a, 2, "\"turn\",\"deg\":20", "\"why\":\"refused\",\"say\":\"it is busy; order stop first");
    expect_order(&a, 3, "\"stop\"", "\"ok\":true");
    expect_order(&a, 4, "\"turn\",\"deg\":20", "\"why\":\"checking\"");
    expect_order(&a, 5, "\"step\",\"way\":\"back\"", "\"why\":\"checking\"");
    bench_run(5000);
    expect_order(&a, 6, "\"turn\",\"deg\":20", "\"ok\":true");
    expect_order(&a, 7, "\"turn\",\"deg\":20", "\"why\":\"checking\"");
}

void test_a_goal_nearer_than_the_robot_is_long_gets_a_note(void) {
    static const char near[] = "\"ok\":true,\"say\":\"the goal is within 500 mm of the robot";
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    expect_order(&a, 1, "\"goto\",\"x_mm\":2,\"y_mm\":0", near);
    expect_order(&a, 2, "\"goto\",\"x_mm\":-499,\"y_mm\":0", near);
    expect_order(&a, 3, "\"goto\",\"x_mm\":400,\"y_mm\":400", "\"ok\":true}"); // 566 mm
    expect_order(&a, 4, "\"course\",\"points\":[[5000,0],[2,0]]", near);
    expect_order(&a, 5, "\"course\",\"points\":[[2,0],[5000,0]]", "\"ok\":true}");
    expect_order(&a, 6, "\"goto\",\"x_mm\":2000,\"y_mm\":0", "\"ok\":true}");
    TEST_ASSERT_TRUE(moves_within(8000));
    bench_run(30000);
    expect_order(&a, 7, "\"goto\",\"x_mm\":2000,\"y_mm\":200", near); // from where it is, not from the start
    expect_order(&a, 8, "\"goto\",\"x_mm\":0,\"y_mm\":0", "\"ok\":true}");
}

void test_orders_say_why_not(void) {
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    expect_order(&a, 1, "\"passive\"", "\"ok\":true");
    expect_order(&a, 2, "\"go\"", "it is passive; order active first");
    expect_order(&a, 3, "\"goto\",\"x_mm\":1,\"y_mm\":1", "it is passive");
    expect_order(&a, 4, "\"active\"", "\"ok\":true");
    expect_order(&a, 5, "\"go\"", "there is no course");
    expect_order(&a, 6, "\"turn\"", "deg must be a whole number from -180 to 180");
    expect_order(&a, 7, "\"turn\",\"deg\":181", "\"bad_argument\"");
    expect_order(&a, 8, "\"step\",\"way\":\"up\"", "\"bad_argument\"");
    expect_order(&a, 9, "\"goto\",\"x_mm\":30001,\"y_mm\":0", "\"bad_argument\"");
    expect_order(&a, 10, "\"course\",\"points\":[]", "\"bad_argument\"");
    expect_order(&a, 11, "\"course\",\"points\":[[1,2,3]]", "\"bad_argument\"");
    expect_order(&a, 12, "\"course\",\"points\":[[1]]", "\"bad_argument\"");
    expect_order(&a, 13, "\"pin\",\"sonar\":32", "\"bad_argument\"");
    expect_order(&a, 14, "\"unpin\",\"sonar\":2", "\"refused\"");
    expect_order(&a, 15, "\"out\",\"sonar\":2", "\"ok\":true");
    expect_order(&a, 16, "\"retest\",\"sonar\":2", "order unpin first");
    expect_order(&a, 17, "\"jump\"", "\"unknown\"");
    expect_order(&a, 18, "\"fail\",\"sonar\":2,\"kind\":\"mad\",\"for_ms\":5000", "kind must be");
    expect_order(&a, 19, "\"fail\",\"sonar\":2,\"kind\":\"off\"", "for_ms must be");
    expect_order(&a, 20, "\"fail\",\"sonar\":2,\"kind\":\"off\",\"for_ms\":600001", "for_ms must be");
    expect_order(&a, 21, "\"fail\",\"sonar\":2,\"kind\":\"off\",\"for_ms\":5000", "\"ok\":true");
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_OFF, bench_inject.of[2].kind);
    expect_order(&a, 22, "\"fail\",\"sonar\":2,\"kind\":\"ok\"", "\"ok\":true");
    TEST_ASSERT_FALSE(inject_is_on(&bench_inject));
    bench_inject.armed = false;
    expect_order(&a, 23, "\"fail\",\"sonar\":2,\"kind\":\"off\",\"for_ms\":5000",
                 "start argusd with --inject");
    expect_order(&a, 24, "\"quit\"", "\"ok\":true");
    TEST_ASSERT_TRUE(control_is_quit(&bench));
}

void test_topics_are_streamed_as_asked(void) {
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":[\"readings\"],\"id\":1}", "{\"re\":1,\"ok\":true}");
    const uint32_t before = bench_look(NULL)->status.sips;
    a.used = 0;
    bench_run(1000);
    bench_hear(&a);
    const uint32_t sips = bench_look(NULL)->status.sips - before;
    uint32_t lines = 0;
    for (const char *at = strstr(a.text, "{\"readings\":"); at != NULL;
         at = strstr(at + 1, "{\"readings\":")) {
        lines++;
    }
    TEST_ASSERT_UINT32_WITHIN(1, sips, lines);
    TEST_ASSERT_NULL(strstr(a.text, "STATUS"));
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":[\"state\",\"evidence\"],\"period_ms\":200}",
                 "\"ok\":true");
    a.used = 0;
    bench_run(1000);
    bench_hear(&a);
    TEST_ASSERT_NULL(strstr(a.text, "readings\":{"));
    TEST_ASSERT_NOT_NULL(strstr(a.text, "\"event\":\"STATUS\""));
    TEST_ASSERT_NOT_NULL(strstr(a.text, "{\"evidence\":{\"t\":"));
    TEST_ASSERT_NOT_NULL(strstr(a.text, "\"seen_by\":[["));
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":[]}", "\"ok\":true");
    a.used = 0;
    bench_run(1000);
    bench_hear(&a);
    TEST_ASSERT_EQUAL_size_t(0, a.used);
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":[\"news\"]}", "\"unknown\"");
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":\"state\"}", "\"bad_argument\"");
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":[\"state\"],\"period_ms\":49}", "\"bad_argument\"");
    const argus_event_t event = {.id = ARGUS_EV_INJECTED, .sonar = 3, .value = 3};
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":[\"events\"]}", "\"ok\":true");
    a.used = 0;
    control_event(&bench, 1500, &event);
    bench_hear(&a);
    TEST_ASSERT_EQUAL_STRING(
        "{\"t\":1.500,\"event\":\"INJECTED\",\"id\":74,\"level\":1,\"name\":\"sonar/front/03\","
        "\"value\":3,\"state\":\"IsNormal\"}\n",
        a.text);
}

// The other one is served as ever, and the one that reads again is told what it missed.
void test_a_reader_that_stalls_loses_lines_and_is_closed(void) {
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":[\"state\"],\"period_ms\":50}", "\"ok\":true");
    const control_client_t *const stalled = &bench.client[a.place];
    for (int i = 0; i < 400 && stalled->out.dropped == 0; i++) {
        bench_run(1000);
    }
    TEST_ASSERT_TRUE(stalled->on && stalled->out.dropped > 0);
    bench_expect(&b, "{\"do\":\"hello\",\"id\":1}", "{\"re\":1,\"ok\":true}");
    for (int i = 0; i < 20; i++) { // it reads, line by whole line
        a.used = 0;
        bench_hear(&a);
        bench_serve();
        TEST_ASSERT_TRUE(a.used == 0 || a.text[0] == '{' || i > 0);
    }
    const uint32_t told = stalled->lost_said;
    TEST_ASSERT_TRUE(told > 0);
    TEST_ASSERT_EQUAL_UINT32(stalled->out.dropped, told);
    for (int i = 0; i < 400 && stalled->on; i++) {
        bench_run(1000);
    }
    TEST_ASSERT_FALSE(stalled->on);
    TEST_ASSERT_TRUE(bench.client[b.place].on);
}

void test_a_browser_is_turned_away_without_a_word(void) {
    static const char *const first[] = {
        "GET / HTTP/1.1\r\nHost: x\r\n\r\n{\"do\":\"order\",\"order\":\"stop\"}\n",
        "POST /x HTTP/1.1\r\n\r\n{\"do\":\"take\",\"force\":true}\n", "OPTIONS * HTTP/1.1\r\n",
        "\x16\x03\x01"};
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++) {
        bench_client_t *const browser = &a;
        bench_end(browser);
        bench_serve();
        bench_connect(browser);
        bench_serve();
        bench_hear(browser);
        browser->used = 0;
        send(browser->fd, first[i], strlen(first[i]), MSG_NOSIGNAL);
        bench_serve();
        bench_hear(browser);
        TEST_ASSERT_EQUAL_size_t(0, browser->used);
        TEST_ASSERT_FALSE(bench.client[browser->place].on);
        TEST_ASSERT_FALSE(control_is_held(&bench));
        TEST_ASSERT_FALSE(bench_look(NULL)->status.paused);
    }
}

void test_without_the_token_nothing_is_heard(void) {
    bench_end(&a);
    bench_end(&b);
    bench_finish();
    bench_begin(true, true);
    bench_connect(&a);
    bench_expect(&a, "{\"do\":\"take\"}", "\"auth\"");
    bench_expect(&a, "{\"do\":\"order\",\"order\":\"stop\"}", "\"auth\"");
    bench_expect(&a, "{\"do\":\"status\"}", "\"auth\"");
    bench_expect(&a, "{\"do\":\"watch\",\"topics\":[\"state\"]}", "\"auth\"");
    TEST_ASSERT_FALSE(bench_look(NULL)->status.paused);
    bench_expect(&a, "{\"do\":\"hello\",\"token\":\"" BENCH_TOKEN "\"}", "\"ok\":true");
    bench_expect(&a, "{\"do\":\"take\"}", "\"ok\":true");
    bench_connect(&b);
    bench_expect(&b, "{\"do\":\"hello\",\"token\":\"" BENCH_TOKEN "x\"}", "\"auth\"");
    TEST_ASSERT_FALSE(bench.client[b.place].on);
    TEST_ASSERT_FALSE(bench_hear(&b));
    char text[256];
    TEST_ASSERT_TRUE(control_notice(&bench, text, sizeof text));
    TEST_ASSERT_EQUAL_STRING("control socket: 1 wrong token, turned away", text);
    TEST_ASSERT_FALSE(control_notice(&bench, text, sizeof text));
    bench_end(&b);
    bench_connect(&b);
    bench_run(4900);
    TEST_ASSERT_TRUE(bench.client[b.place].on);
    bench_run(200);
    TEST_ASSERT_FALSE(bench.client[b.place].on);
}

void test_places_go_to_who_may_speak(void) {
    static bench_client_t many[CONTROL_CLIENTS];
    bench_end(&a);
    bench_end(&b);
    bench_finish();
    bench_begin(true, false);
    bench_connect(&a);
    bench_expect(&a, "{\"do\":\"hello\",\"token\":\"" BENCH_TOKEN "\"}", "\"ok\":true");
    for (int i = 0; i < CONTROL_CLIENTS; i++) { // one more than there is room for
        bench_moment.now_ms += 10;
        bench_connect(&many[i]);
        TEST_ASSERT_TRUE(many[i].place != a.place);
    }
    TEST_ASSERT_FALSE(bench_hear(&many[0])); // the oldest of those who have said nothing
    TEST_ASSERT_TRUE(bench_hear(&many[1]));
    for (int i = 1; i < CONTROL_CLIENTS; i++) {
        bench_expect(&many[i], "{\"do\":\"hello\",\"token\":\"" BENCH_TOKEN "\"}", "\"ok\":true");
    }
    TEST_ASSERT_EQUAL_INT(-1, control_admit(&bench, -1, bench_moment.now_ms));
    for (int i = 0; i < CONTROL_CLIENTS; i++) {
        bench_end(&many[i]);
    }
}
