// SPDX-License-Identifier: MIT
// argusd --check: connect, look, tell, leave.
#ifndef ARGUSD_CHECK_H
#define ARGUSD_CHECK_H

#include <stdio.h>

#include "argusd.h"
#include "driver.h"
#include "precedence.h"

// Why no robot answered, on one line: no link, silence, garbage, or packets that lead nowhere; and the exit
// code for that.
argusd_exit_t check_explain_silence(const driver_t *driver, uint32_t waited_ms, char *text, size_t capacity);

// The driver's link is open and it is passive. Writes the findings to `out`, or the reason for none to
// `message`.
argusd_exit_t check_run(driver_t *driver, const precedence_t *granted, uint32_t wait_ms, int cancel_fd,
                        bool json, FILE *out, char *message, size_t capacity);

// One turn of the loop, which waits at most so long; false when somebody gave up.
bool check_turn(driver_t *driver, int cancel_fd, uint32_t most_ms);

// Ends the session and closes the link.
void check_leave(driver_t *driver);

#endif
