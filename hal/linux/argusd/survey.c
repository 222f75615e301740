// SPDX-License-Identifier: MIT
// Turns the robot on the spot through a circle, lets the fault manager judge, and reports what it found.
#include "survey.h"

#include <stdarg.h>
#include <unistd.h>

#include "check.h"
#include "json.h"
#include "survey_picture.h"
#include "survey_views.h"
#include "text.h"

#define STEPS 12
#define STEP_DEG 30
#define DWELL_SIPS 15u  // at rest on each heading: every transducer fires several times
#define SETTLE_SIPS 3u  // an order shows in the state
#define READY_MS 60000u // until the manager stands idle, at the start and behind each turn
#define VERIFY_MS 180000u
#define FLAT_MM 25 // readings of all headings within so much are told as flat
#define NEVER 0xFFFFu
#define LIKELY 90 // percent of a verdict
#define SUMMARY_MAX 96

typedef enum { PHASE_MEET, PHASE_READY, PHASE_TURN, PHASE_DWELL, PHASE_VERIFY, PHASE_DONE } phase_t;

// What one sonar gave in the course of the survey.
typedef struct {
    uint16_t least_mm; // NEVER: no echo
    uint16_t most_mm;
    uint16_t echoed;   // headings on which an echo came
    uint16_t reported; // headings on which it reported at all
    uint32_t readings; // up to the heading before
} trace_t;

typedef struct {
    driver_t *driver;
    phase_t phase;
    uint32_t since_ms;
    uint32_t since_sips;
    int32_t from_cdeg; // heading of the last order to turn
    uint32_t start_ms;
    int headings; // that it stood on
    bool ran_out;
    trace_t trace[ARGUS_SONARS];
    survey_views_t views;
    argus_status_t status;
    argus_suspicions_t doubts;
    const char *refusal; // NULL: none
} survey_t;

// The fault of a sonar that can be told, else NULL.
static const char *refusal_of(const argus_status_t *status) {
    static const char *const waits[] = {
        [ARGUS_WAIT_NONE] = NULL,
        [ARGUS_WAIT_BUMPER] = "a bumper is pressed; free the robot",
        [ARGUS_WAIT_MOTORS] = "its motors are off; release the stop button, or press the motor button",
        [ARGUS_WAIT_TURN] = "something is within its swing circle (S7); give it room",
        [ARGUS_WAIT_WAY] = "every heading is blocked; give it room",
        [ARGUS_WAIT_CATASTROPHIC] = "all sonars that face forward are out, so nothing sees the way",
        [ARGUS_WAIT_ECHO] = "it touched something that no sonar had seen; free the robot"};
    static const char *const bars[] = {
        [ARGUS_BAR_NONE] = NULL,
        [ARGUS_BAR_UNKNOWN] = "its body is not known; name it with --robot",
        [ARGUS_BAR_UNSAFE] = "the settings are unsafe for it (S5); see --list-config",
        [ARGUS_BAR_SONARS] =
            "it has other sonars than its subclass or the ring; name it with --robot or --ring"};
    if (status->bumpers_front != 0 || status->bumpers_rear != 0) {
        return waits[ARGUS_WAIT_BUMPER];
    }
    if (status->bar != ARGUS_BAR_NONE) {
        return status->bar < sizeof bars / sizeof bars[0] ? bars[status->bar] : "it may not be driven";
    }
    if (status->paused) {
        return "the operator has stopped it";
    }
    if (!status->active) {
        return "the fault manager is passive";
    }
    if (status->mode == ARGUS_MODE_WAITING) {
        return status->wait < sizeof waits / sizeof waits[0] ? waits[status->wait] : "it cannot go on";
    }
    return NULL;
}

static uint32_t now_of(const survey_t *self) {
    return hal_clock_now_ms(&self->driver->clock);
}

static void enter(survey_t *self, phase_t phase) {
    self->phase = phase;
    self->since_ms = now_of(self);
    self->since_sips = self->status.sips;
}

static bool is_late(const survey_t *self, uint32_t most_ms) {
    return now_of(self) - self->since_ms >= most_ms;
}

// The heading that ends: what each sonar gave while the robot stood on it.
static void note_heading(survey_t *self) {
    argus_mask_t fresh = 0;
    self->headings++;
    for (int i = 0; i < self->status.sonars; i++) {
        trace_t *const trace = &self->trace[i];
        const bool came = self->status.readings[i] != trace->readings;
        const uint16_t mm = self->status.reading_mm[i];
        trace->readings = self->status.readings[i];
        trace->reported = (uint16_t)(trace->reported + came);
        fresh |= (argus_mask_t)(came ? 1u << i : 0u);
        if (!came || mm == 0 || mm >= ARGUS_NO_ECHO_MM) {
            continue;
        }
        trace->echoed++;
        trace->least_mm = mm < trace->least_mm ? mm : trace->least_mm;
        trace->most_mm = mm > trace->most_mm ? mm : trace->most_mm;
    }
    survey_views_note(&self->views, (int16_t)(self->status.pose.heading_cdeg / 100), &self->status, fresh);
}

// All is counted in packets: those of a busy machine come late, and tell of the time before the order.
static bool has_heard(const survey_t *self, uint32_t sips) {
    return self->status.sips - self->since_sips >= sips;
}

static bool has_turned(const survey_t *self) {
    const int32_t by_cdeg = (self->status.pose.heading_cdeg - self->from_cdeg + 36000) % 36000;
    return self->phase != PHASE_TURN || (by_cdeg >= STEP_DEG * 50 && by_cdeg < 18000);
}

static bool is_idle(const survey_t *self) {
    return self->status.mode == ARGUS_MODE_IDLE && self->status.vel_left_mm_s == 0 &&
           self->status.vel_right_mm_s == 0;
}

// Behind the last heading the manager looks at what it still doubts.
static void go_on(survey_t *self) {
    if (self->headings > STEPS) {
        enter(self, argus_operator(self->driver->core, now_of(self), ARGUS_OP_RECHECK, 0) ? PHASE_VERIFY
                                                                                          : PHASE_DONE);
        return;
    }
    self->from_cdeg = self->status.pose.heading_cdeg;
    if (argus_operator(self->driver->core, now_of(self), ARGUS_OP_TURN, STEP_DEG)) {
        enter(self, PHASE_TURN);
    }
}

// Where it neither stands idle nor moves in time, the survey ends with what it has.
static void await_idle(survey_t *self, phase_t then, uint32_t most_ms) {
    if (has_heard(self, SETTLE_SIPS) && has_turned(self) && is_idle(self)) {
        enter(self, then);
        return;
    }
    const char *const refusal = refusal_of(&self->status);
    if (refusal != NULL || is_late(self, most_ms)) {
        self->refusal = refusal;
        self->ran_out = true;
        self->phase = PHASE_DONE;
    }
}

// Readings that do not come on a heading in time end the survey, too.
static void dwell(survey_t *self) {
    if (has_heard(self, DWELL_SIPS)) {
        note_heading(self);
        go_on(self);
    } else if (is_late(self, READY_MS)) {
        self->ran_out = true;
        self->phase = PHASE_DONE;
    }
}

static void step(survey_t *self, uint32_t wait_ms) {
    switch (self->phase) {
    case PHASE_MEET:
        if (self->status.open && self->status.online) {
            enter(self, PHASE_READY);
        } else if (is_late(self, wait_ms)) {
            self->phase = PHASE_DONE;
        }
        break;
    case PHASE_READY:
    case PHASE_TURN:
        await_idle(self, PHASE_DWELL, READY_MS);
        break;
    case PHASE_DWELL:
        dwell(self);
        break;
    case PHASE_VERIFY:
        await_idle(self, PHASE_DONE, VERIFY_MS);
        break;
    default:
        break;
    }
}

// Verdicts
// ---------------------------------------------------------------------------------------------------

typedef struct {
    char verdict[64];
    char sure[32];
    survey_state_t state;
} verdict_t;

static bool is_fault(const verdict_t *verdict) {
    return verdict->state >= SURVEY_SUSPECT;
}

static bool is_flat(const trace_t *trace) {
    return trace->echoed > STEPS / 2 && trace->most_mm - trace->least_mm <= FLAT_MM;
}

__attribute__((format(printf, 4, 5))) static verdict_t found_as(survey_state_t state, const char *sure,
                                                                int percent, const char *format, ...) {
    verdict_t found = {.state = state};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(found.verdict, sizeof found.verdict, format, arguments);
    va_end(arguments);
    if (sure != NULL) {
        snprintf(found.sure, sizeof found.sure, "%s", sure);
    } else {
        snprintf(found.sure, sizeof found.sure, "%d %%", percent);
    }
    return found;
}

static survey_match_t match_of(const survey_t *self, int sonar) {
    argus_mask_t trusted = 0;
    for (int i = 0; i < self->status.sonars; i++) {
        trusted |= (argus_mask_t)(self->status.health[i] == ARGUS_HEALTHY ? 1u << i : 0u);
    }
    return survey_views_match(&self->views, &self->status, sonar, trusted);
}

// What the manager names, or else what the others prove that the robot turned onto its bearing.
static argus_fault_kind_t kind_of(const survey_t *self, int sonar) {
    const survey_match_t match = match_of(self, sonar);
    const argus_fault_kind_t proved = survey_proves(&match);
    if (self->status.health[sonar] == ARGUS_DISABLED) {
        return (argus_fault_kind_t)self->status.kind[sonar];
    }
    const argus_fault_kind_t doubted = (argus_fault_kind_t)self->doubts.kind[sonar];
    const bool at_rest = doubted != ARGUS_KIND_SLOW; // no lag shows on a robot that stands
    if (doubted != ARGUS_KIND_NONE && (proved == ARGUS_KIND_NONE || at_rest)) {
        return doubted;
    }
    return proved == ARGUS_KIND_WRONG && is_flat(&self->trace[sonar]) ? ARGUS_KIND_STUCK : proved;
}

// Of a sonar that the manager has no complaint of.
static verdict_t unblamed(const survey_t *self, int sonar) {
    const trace_t *const trace = &self->trace[sonar];
    const bool judged = self->status.health[sonar] == ARGUS_HEALTHY;
    if (trace->reported == 0 || self->status.health[sonar] == ARGUS_STALE) {
        return found_as(SURVEY_BROKEN, "certain", 0, "gives no reading");
    }
    if (is_flat(trace)) {
        return found_as(SURVEY_SUSPECT, "same reading", 0, "suspect, perhaps stuck");
    }
    if (trace->echoed == 0) {
        return found_as(SURVEY_OPEN, "open", 0, "hears nothing, which may be right here");
    }
    return judged ? found_as(SURVEY_HEALTHY, NULL, 100 - self->doubts.percent[sonar], "healthy")
                  : found_as(SURVEY_OPEN, "open", 0, "not judged");
}

static verdict_t verdict_of(const survey_t *self, int sonar) {
    const int percent = self->doubts.percent[sonar];
    const argus_fault_kind_t kind = kind_of(self, sonar);
    const survey_match_t match = match_of(self, sonar);
    if (survey_proves(&match) != ARGUS_KIND_NONE) {
        verdict_t found =
            found_as(SURVEY_BROKEN, "", 0, "broken: %s", argus_name(ARGUS_NAME_KIND, (int)kind));
        snprintf(found.sure, sizeof found.sure, "proven, %d of %d differ", match.compared - match.agreed,
                 match.compared);
        return found;
    }
    switch (self->status.health[sonar]) {
    case ARGUS_DISABLED:
        return found_as(SURVEY_BROKEN, "proven", 0, "broken: %s", argus_name(ARGUS_NAME_KIND, (int)kind));
    case ARGUS_SUSPECT:
        return found_as(SURVEY_SUSPECT, NULL, percent, "suspect, %s %s",
                        percent >= LIKELY ? "likely" : "perhaps",
                        kind == ARGUS_KIND_NONE ? "anything" : argus_name(ARGUS_NAME_KIND, (int)kind));
    default:
        return unblamed(self, sonar);
    }
}

static bool is_there(const survey_t *self, int sonar) {
    return self->status.health[sonar] != ARGUS_ABSENT;
}

static void put_row(const survey_t *self, int sonar, FILE *out) {
    const verdict_t found = verdict_of(self, sonar);
    const trace_t *const trace = &self->trace[sonar];
    char range[32] = "-";
    if (trace->echoed > 0) {
        snprintf(range, sizeof range, "%u to %u", (unsigned)trace->least_mm, (unsigned)trace->most_mm);
    }
    fprintf(out, "%5d  %5d  %2u of %-2d  %-14s  %-40s  %s\n", sonar, self->status.bearing_deg[sonar],
            (unsigned)trace->echoed, self->headings, range, found.verdict, found.sure);
}

static int faults_of(const survey_t *self) {
    int faults = 0;
    for (int i = 0; i < self->status.sonars; i++) {
        const verdict_t found = verdict_of(self, i);
        faults += is_there(self, i) && is_fault(&found);
    }
    return faults;
}

static void summarize(const survey_t *self, char *text, size_t capacity) {
    const int faults = faults_of(self);
    char found[48] = "no sonar is broken";
    if (faults > 0) {
        snprintf(found, sizeof found, "%d sonar%s %s broken or a suspect", faults, faults == 1 ? "" : "s",
                 faults == 1 ? "is" : "are");
    }
    snprintf(text, capacity, "%d headings of %d; %s", self->headings, STEPS + 1, found);
}

static void tell_plain(const survey_t *self, FILE *out) {
    fprintf(out, "%5s  %5s  %8s  %-14s  %-40s  %s\n", "sonar", "deg", "echoes", "mm", "verdict", "how sure");
    for (int i = 0; i < self->status.sonars; i++) {
        if (is_there(self, i)) {
            put_row(self, i, out);
        }
    }
    char summary[SUMMARY_MAX];
    summarize(self, summary, sizeof summary);
    fprintf(out, "%s\n", summary);
}

static void draw(const survey_t *self, FILE *out) {
    verdict_t found[ARGUS_SONARS];
    survey_mark_t marks[ARGUS_SONARS];
    char summary[SUMMARY_MAX];
    int count = 0;
    for (int i = 0; i < self->status.sonars; i++) {
        if (is_there(self, i)) {
            found[i] = verdict_of(self, i);
            marks[count++] = (survey_mark_t){i, self->status.bearing_deg[i], found[i].state, found[i].verdict,
                                             found[i].sure};
        }
    }
    summarize(self, summary, sizeof summary);
    if (ftruncate(fileno(out), 0) != 0) { // what was there before
        return;
    }
    survey_picture_put(out, marks, count, summary);
}

static void tell_json(const survey_t *self, FILE *out) {
    char line[512];
    for (int i = 0; i < self->status.sonars; i++) {
        if (!is_there(self, i)) {
            continue;
        }
        const verdict_t found = verdict_of(self, i);
        json_t json = json_in(line, sizeof line);
        json_open(&json, '{');
        json_name(&json, "sonar");
        json_int(&json, i);
        json_name(&json, "bearing_deg");
        json_int(&json, self->status.bearing_deg[i]);
        json_name(&json, "headings");
        json_int(&json, self->headings);
        json_name(&json, "echoes");
        json_int(&json, self->trace[i].echoed);
        json_name(&json, "health");
        json_string(&json, argus_name(ARGUS_NAME_HEALTH, self->status.health[i]));
        json_name(&json, "kind");
        json_string(&json, argus_name(ARGUS_NAME_KIND, (int)kind_of(self, i)));
        json_name(&json, "percent");
        json_int(&json, self->doubts.percent[i]);
        json_name(&json, "compared");
        json_int(&json, match_of(self, i).compared);
        json_name(&json, "agreed");
        json_int(&json, match_of(self, i).agreed);
        json_name(&json, "verdict");
        json_string(&json, found.verdict);
        json_name(&json, "sure");
        json_string(&json, found.sure);
        json_name(&json, "fault");
        json_bool(&json, is_fault(&found));
        json_close(&json, '}');
        fprintf(out, "%s\n", line);
    }
}

// The exit code, and why the survey did not come to its end.
static argusd_exit_t conclude(const survey_t *self, const survey_output_t *output, char *message,
                              size_t capacity) {
    const char *const address = hal_link_describe(&self->driver->link);
    const char *const why = self->refusal != NULL ? self->refusal : "it did not come to rest in time";
    if (self->headings <= 1 && self->ran_out) {
        text_refuse(message, capacity, "%s: no survey, as the robot may not turn: %s", address, why);
        return ARGUSD_EXIT_MISSION;
    }
    output->json ? tell_json(self, output->table) : tell_plain(self, output->table);
    if (output->picture != NULL) {
        draw(self, output->picture);
    }
    if (self->ran_out || self->headings <= STEPS) {
        text_refuse(message, capacity, "%s: the survey ended on heading %d of %d: %s", address,
                    self->headings, STEPS + 1, self->ran_out ? why : "it was ended");
        return ARGUSD_EXIT_MISSION;
    }
    return faults_of(self) > 0 ? ARGUSD_EXIT_FAULTS : ARGUSD_EXIT_OK;
}

argusd_exit_t survey_run(driver_t *driver, uint32_t wait_ms, int cancel_fd, const survey_output_t *output,
                         char *message, size_t capacity) {
    survey_t self = {.driver = driver, .start_ms = hal_clock_now_ms(&driver->clock)};
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self.trace[i].least_mm = NEVER;
    }
    enter(&self, PHASE_MEET);
    bool going_on = true;
    while (going_on && self.phase != PHASE_DONE) {
        going_on = check_turn(driver, cancel_fd, 100);
        argus_status(driver->core, &self.status);
        argus_suspicions(driver->core, &self.doubts);
        if (self.phase > PHASE_MEET && !self.status.open) {
            self.ran_out = true;
            self.refusal = "the robot is gone";
            self.phase = PHASE_DONE;
        }
        step(&self, wait_ms);
    }
    argusd_exit_t code = ARGUSD_EXIT_NO_ROBOT;
    if (self.phase == PHASE_DONE && self.headings == 0 && !self.ran_out) {
        code = check_explain_silence(driver, now_of(&self) - self.start_ms, message, capacity);
    } else {
        code = conclude(&self, output, message, capacity);
    }
    check_leave(driver);
    return code;
}
