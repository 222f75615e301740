// SPDX-License-Identifier: MIT
// Takes a ring and a body of the caller's own.
#include "behaviour/core.h"
#include "knowledge/body.h"
#include "knowledge/config.h"
#include "robot/make.h"

static bool is_safe(const argus_config_t *const config, const argus_robot_t *const robot) {
    const int32_t fault = argus_config_check_for(config, robot).fault;
    return fault != ARGUS_CONFIG_DRIVING && fault != ARGUS_CONFIG_STEP;
}

// Settings that another robot could not be driven with are safe for this one.
static void unlock(argus_orders_t *const orders, const bool active) {
    if (orders->locked && !orders->mended) {
        orders->locked = false;
        orders->passive = !active;
    }
}

argus_ring_report_t argus_set_ring(argus_t *const self, argus_robot_storage_t *const storage,
                                   const argus_ring_t *const ring) {
    argus_own_robot_t *const own = (argus_own_robot_t *)storage;
    const argus_robot_t *const robot = &own->rows[0];
    ARGUS_ASSERT(storage != NULL && ring != NULL && (self == NULL || self->session.sips == 0));
    argus_ring_report_t report = argus_robot_make(own, ring);
    if (report.fault != ARGUS_RING_OK) {
        return report;
    }
    argus_config_t config;
    argus_config_default(&config);
    config = self != NULL ? self->config : config;
    argus_config_follow(&config, self != NULL ? self->follows : argus_config_follows(&config), robot);
    if (!is_safe(&config, robot)) {
        report.fault = ARGUS_RING_UNSAFE;
    } else if (self != NULL) {
        self->config = config;
        argus_body_is(&self->knowledge, robot, self->now_ms);
        unlock(&self->orders, self->config.active != 0);
    }
    return report;
}
