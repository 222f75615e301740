// SPDX-License-Identifier: MIT
// Which robot has answered, and whether it may be driven: its body must be known and the settings safe for
// it.
#include "supervisor/body.h"

#include "behaviour/state.h"
#include "knowledge/body.h"
#include "knowledge/config.h"
#include "supervisor/faults.h"
#include "supervisor/journey.h"

#define STRANGE_SIPS 5 // one SIP may say anything

// The caller's ring stands above the operator's word, and that above what the robot says of itself.
static const argus_robot_t *robot_met(const argus_t *const self) {
    const argus_robot_t *const built = argus_robot_built(self->knowledge.robot);
    if (argus_robot_is_own(built)) {
        return built;
    }
    const argus_robot_t *const chosen = argus_robot_chosen(self->config.robot);
    return chosen != NULL ? chosen : argus_robot_find(self->session.subclass);
}

// How many sonars a robot of this subclass has, where the ring has more: that is of another one. Else 0.
static int short_of(const char *const subclass, const argus_robot_t *const ring) {
    const argus_robot_t *const said = argus_robot_find(subclass);
    return argus_robot_is_own(ring) && said != NULL && said->sonars < ring->sonars ? said->sonars : 0;
}

// What was found out about the sonars of another body says nothing of this one's, but what its record says.
static void forget_sonars(argus_knowledge_t *const knowledge, argus_events_t *const events,
                          const argus_mask_t recorded) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((recorded >> i & 1u) == 0) { // none of a robot's sonars is absent, and any other may be forgotten
            argus_emit_change(events, knowledge, i, ARGUS_CHANGE_FORGOTTEN, ARGUS_KIND_NONE, 0);
        }
    }
}

static void change_to(argus_t *const self, const argus_robot_t *const robot) {
    ARGUS_ASSERT(robot != NULL);
    const argus_robot_t *const before = argus_robot_built(self->knowledge.robot);
    if (before == robot) {
        return;
    }
    if (before != self->knowledge.robot) {
        argus_knowledge_turn_about(&self->knowledge, before);
    }
    argus_body_is(&self->knowledge, robot, self->now_ms);
    argus_config_follow(&self->config, self->follows, robot);
    forget_sonars(&self->knowledge, &self->events, self->history.recorded);
    argus_algorithm1_init(&self->algorithm1);
    argus_journey_restart(&self->travel);
    self->plan = argus_plan(robot, argus_policy(self), 0, 0);
    argus_replan(self);
}

bool argus_find_bar(const argus_t *const self, argus_orders_t *const orders, argus_events_t *const events) {
    orders->bar = orders->locked ? ARGUS_BAR_UNSAFE : ARGUS_BAR_NONE;
    if (!argus_robot_is_known(self->knowledge.robot)) {
        orders->bar = ARGUS_BAR_UNKNOWN;
        argus_emit(events, ARGUS_EV_SUBCLASS_UNKNOWN, 0);
        return true;
    }
    const argus_config_report_t report = argus_config_check_for(&self->config, self->knowledge.robot);
    if (report.fault != ARGUS_CONFIG_OK) {
        orders->bar = ARGUS_BAR_UNSAFE;
        const bool driving = report.fault == ARGUS_CONFIG_DRIVING;
        argus_emit(events, ARGUS_EV_ROBOT_UNSAFE, driving ? report.driving_mm : report.stepping_mm);
    }
    return report.fault != ARGUS_CONFIG_OK;
}

// One that was only barred by the robot before drives again with a robot that it may drive.
void argus_meet_body(argus_t *const self) {
    ARGUS_ASSERT(argus_is_open(self));
    const argus_robot_t *const met = robot_met(self);
    const argus_robot_t *const robot = met != NULL ? met : argus_robot_unknown();
    const bool active = !self->orders.passive || self->orders.barred;
    if (robot->sonars > ARGUS_SONARS) { // GCOV_EXCL_BR_LINE: in a small build only
        argus_emit(&self->events, ARGUS_EV_SONARS_BEYOND, robot->sonars); // GCOV_EXCL_LINE: likewise
    }
    change_to(self, robot);
    self->orders.barred = argus_find_bar(self, &self->orders, &self->events) && active;
    if (self->orders.bar == ARGUS_BAR_NONE && short_of(self->session.subclass, robot) > 0) {
        self->orders.bar = ARGUS_BAR_SONARS;
        self->orders.barred = active;
        argus_emit(&self->events, ARGUS_EV_SONARS_BEYOND, short_of(self->session.subclass, robot));
    }
    self->orders.passive = self->orders.locked || self->orders.barred || !active;
    ARGUS_ASSERT(!self->orders.barred || self->orders.passive);
}

bool argus_sees_through_body(const argus_t *const self, argus_orders_t *const orders,
                             argus_events_t *const events) {
    const argus_robot_t *const robot = self->knowledge.robot;
    if (self->knowledge.strange_sips != STRANGE_SIPS || !argus_robot_is_known(robot)) {
        return false;
    }
    argus_emit(events, ARGUS_EV_SONARS_BEYOND, robot->sonars);
    if (robot->sonars < ARGUS_SONARS) {
        orders->passive = true;
        orders->bar = ARGUS_BAR_SONARS;
    }
    return orders->passive;
}

void argus_turn_about(argus_t *const self) {
    const argus_robot_t *const other = argus_robot_other_end(self->knowledge.robot);
    ARGUS_ASSERT(other != NULL && argus_at_rest(&self->knowledge));
    argus_knowledge_turn_about(&self->knowledge, other);
    self->reverse = (argus_reverse_t){.odometer_mm = self->knowledge.odometer_mm, .done = true};
    self->reflexes.touched_unheard = false;
    argus_algorithm1_init(&self->algorithm1);
    argus_extremes_restart(&self->extremes);
    argus_common_turned_about(&self->common, self->now_ms);
    argus_slip_restart(&self->slip);
    argus_base_drop(&self->base);
    self->checked = false;
    self->plan = argus_plan(other, argus_policy(self), 0, 0);
    argus_emit(&self->events, ARGUS_EV_REVERSED, other->reversed ? 1 : 0);
    argus_replan(self);
}
