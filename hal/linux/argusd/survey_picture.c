// SPDX-License-Identifier: MIT
#include "survey_picture.h"

#include <stdbool.h>
#include <stdlib.h>

#define WIDTH 760
#define HEIGHT 640
#define CENTRE_X 380
#define CENTRE_Y 320
#define ASIDE_DEG 5   // two that look on one bearing stand so far beside it
#define UPRIGHT_DEG 5 // a label nearer to straight ahead or astern is centred
#define LEGEND_Y 600
#define LEGEND_STEP 170
#define INK "#222222"

static const struct {
    const char *colour;
    const char *label;
} states[SURVEY_STATES] = {[SURVEY_HEALTHY] = {"#1f5fa8", "healthy"},
                           [SURVEY_OPEN] = {"#777777", "not told"},
                           [SURVEY_SUSPECT] = {"#f2a900", "suspect"},
                           [SURVEY_BROKEN] = {"#d62728", "broken"}};

// Of two on one bearing the first is nearer to straight ahead.
static int drawn_deg(const survey_mark_t *marks, int count, int at) {
    const int bearing_deg = marks[at].bearing_deg;
    const int outwards = bearing_deg < 0 ? -ASIDE_DEG : ASIDE_DEG;
    for (int i = 0; i < count; i++) {
        if (i != at && marks[i].bearing_deg == bearing_deg) {
            return bearing_deg + (at < i ? -outwards : outwards);
        }
    }
    return bearing_deg;
}

static const char *anchor_of(int deg) {
    if (abs(deg) <= UPRIGHT_DEG || abs(deg) >= 180 - UPRIGHT_DEG) {
        return "middle";
    }
    return deg > 0 ? "end" : "start"; // counter-clockwise is left
}

// Drawn as if it looked ahead, and turned; what is written is turned back.
static void put_sonar(FILE *out, const survey_mark_t *mark, int deg) {
    const bool told = mark->state != SURVEY_HEALTHY;
    fprintf(out,
            "<g transform=\"translate(%d %d) rotate(%d)\"><polygon points=\"-4,-50 4,-50 13,-180 -13,-180\" "
            "fill=\"%s\"/><text transform=\"translate(0 -196) rotate(%d)\" text-anchor=\"%s\" dy=\"5\">",
            CENTRE_X, CENTRE_Y, -deg, states[mark->state].colour, deg, anchor_of(deg));
    told ? fprintf(out, "%d: %s", mark->number, mark->verdict) : fprintf(out, "%d", mark->number);
    fprintf(out, "</text><title>%d: %s, %s</title></g>\n", mark->number, mark->verdict, mark->sure);
}

static bool is_drawn(const survey_mark_t *marks, int count, survey_state_t state) {
    for (int i = 0; i < count; i++) {
        if (marks[i].state == state) {
            return true;
        }
    }
    return false;
}

static void put_legend(FILE *out, const survey_mark_t *marks, int count) {
    int x = CENTRE_X / 4;
    for (int i = 0; i < SURVEY_STATES; i++) {
        if (is_drawn(marks, count, (survey_state_t)i)) {
            fprintf(out, "<rect x=\"%d\" y=\"%d\" width=\"28\" height=\"12\" fill=\"%s\"/>", x, LEGEND_Y,
                    states[i].colour);
            fprintf(out, "<text x=\"%d\" y=\"%d\">%s</text>\n", x + 36, LEGEND_Y + 11, states[i].label);
            x += LEGEND_STEP;
        }
    }
}

void survey_picture_put(FILE *out, const survey_mark_t *marks, int count, const char *summary) {
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" "
            "font-family=\"sans-serif\" font-size=\"14\" fill=\"" INK "\">\n<title>Survey: %s</title>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            WIDTH, HEIGHT, summary);
    fprintf(out,
            "<text x=\"%d\" y=\"32\" text-anchor=\"middle\" font-size=\"18\">The sonar ring, up is "
            "ahead</text>\n<text x=\"%d\" y=\"56\" text-anchor=\"middle\">%s</text>\n",
            CENTRE_X, CENTRE_X, summary);
    for (int i = 0; i < count; i++) {
        put_sonar(out, &marks[i], drawn_deg(marks, count, i));
    }
    fprintf(out,
            "<rect x=\"%d\" y=\"%d\" width=\"50\" height=\"56\" rx=\"8\" fill=\"#555555\"/>"
            "<polygon points=\"%d,%d %d,%d %d,%d\" fill=\"white\"/>\n",
            CENTRE_X - 25, CENTRE_Y - 28, CENTRE_X - 8, CENTRE_Y - 8, CENTRE_X + 8, CENTRE_Y - 8, CENTRE_X,
            CENTRE_Y - 22);
    put_legend(out, marks, count);
    fprintf(out, "</svg>\n");
}
