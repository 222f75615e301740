// SPDX-License-Identifier: MIT
// Writes readings and evidence.
#include "control_stream.h"

#include "json.h"
#include "report.h"

static void open_line(json_t *json, const char *name, const view_t *view) {
    json_open(json, '{');
    json_name(json, name);
    json_open(json, '{');
    json_name(json, "t");
    json_thousandths(json, (int64_t)view->t_ms);
}

static size_t close_line(json_t *json) {
    json_close(json, '}');
    json_close(json, '}');
    return json_fits(json) ? json->text.length : 0;
}

size_t control_readings_line(const view_t *view, char *line, size_t capacity) {
    json_t json = json_in(line, capacity);
    open_line(&json, "readings", view);
    json_name(&json, "sip");
    json_int(&json, view->status.sips);
    report_readings(&json, "mm", &view->status);
    return close_line(&json);
}

static void put_mask(json_t *json, argus_mask_t mask) {
    json_open(json, '[');
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if ((mask >> i & 1u) != 0) {
            json_int(json, i);
        }
    }
    json_close(json, ']');
}

size_t control_evidence_line(const view_t *view, const argus_suspicions_t *suspicions, char *line,
                             size_t capacity) {
    json_t json = json_in(line, capacity);
    open_line(&json, "evidence", view);
    json_name(&json, "kind");
    json_open(&json, '[');
    for (int i = 0; i < report_sonars(&view->status); i++) {
        json_string(&json, argus_name(ARGUS_NAME_KIND, (int)suspicions->kind[i]));
    }
    json_close(&json, ']');
    json_name(&json, "level");
    json_open(&json, '[');
    for (int i = 0; i < report_sonars(&view->status); i++) {
        json_int(&json, suspicions->percent[i]);
    }
    json_close(&json, ']');
    json_name(&json, "seen_by");
    json_open(&json, '[');
    for (int i = 0; i < report_sonars(&view->status); i++) {
        put_mask(&json, suspicions->against[i]);
    }
    json_close(&json, ']');
    return close_line(&json);
}
