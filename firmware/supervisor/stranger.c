// SPDX-License-Identifier: MIT
// Another robot behind the wire of the one before.
#include <string.h>

#include "supervisor/manager_internal.h"

static void forget(argus_t *const self) {
    argus_knowledge_init(&self->knowledge);
    argus_awareness_init(&self->awareness);
    argus_verify_init(&self->verify);
    argus_evidence_init(&self->evidence);
    argus_evidence_set_caution(&self->evidence, self->config.caution);
    argus_inquiry_init(&self->inquiry);
    memset(self->hold, 0, sizeof self->hold);
    self->looked_once = false;
    self->pinned = 0;
    self->recorded = 0;
    argus_task_restart(&self->task);
}

void argus_meet_stranger(argus_t *const self) {
    argus_say(self, ARGUS_EV_OTHER_ROBOT, ARGUS_NO_SONAR, self->session.differs);
    argus_stop(self, ARCOS_CMD_STOP); // it may still do what an earlier client asked
    self->passive = true;
    self->session.motors = false;
    self->paused = true;
    self->stay = true;
    self->jog_mm = 0;
    forget(self);
    argus_replan(self);
    argus_enter_checking(self, true);
}
