// SPDX-License-Identifier: MIT
// Stops another robot than the one before, forgets that one, and waits for an operator.
#include "supervisor/robot_changed.h"

#include <string.h>

#include "behaviour/looks.h"
#include "knowledge/body.h"
#include "supervisor/faults.h"
#include "supervisor/journey.h"
#include "supervisor/modes.h"

// Which body it has is found out when its session opens; until then the one before holds.
static void forget(argus_t *const self) {
    const argus_robot_t *const before = argus_robot_built(self->knowledge.robot);
    argus_knowledge_init(&self->knowledge);
    argus_body_is(&self->knowledge, before, self->now_ms);
    argus_echoes_init(&self->echoes);
    argus_algorithm1_init(&self->algorithm1);
    argus_evidence_init(&self->evidence);
    argus_evidence_set_caution(&self->evidence, self->config.caution);
    argus_extremes_init(&self->extremes);
    argus_common_init(&self->common);
    argus_slip_restart(&self->slip);
    memset(&self->verifying, 0, sizeof self->verifying);
    argus_looks_init(&self->looks);
    self->reflexes.unseen = 0;
    self->reflexes.touched_unheard = false;
    self->orders.pinned = 0;
    self->history.recorded = 0;
    argus_journey_restart(&self->travel);
}

void argus_robot_changed(argus_t *const self) {
    argus_emit(&self->events, ARGUS_EV_OTHER_ROBOT, self->session.differs);
    // It may still do what an earlier client asked.
    argus_stop_and_do(self, ARGUS_STOP_STOP, ARGUS_DO_NOTHING, false);
    self->orders.passive = true;
    self->orders.paused = true;
    self->orders.stay = ARGUS_STAY_OPERATOR;
    self->orders.barred = false;
    forget(self);
    argus_replan(self);
    argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_CHECK, true);
}
