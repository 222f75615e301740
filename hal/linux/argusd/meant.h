// SPDX-License-Identifier: MIT
// The option that a mistyped one was meant to be.
#ifndef ARGUSD_MEANT_H
#define ARGUSD_MEANT_H

#include <getopt.h>

// Returns the name in the table that is nearest to the option as given ("--lnik=x"), NULL when none is near.
const char *option_meant(const struct option *table, const char *given);

#endif
