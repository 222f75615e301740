// SPDX-License-Identifier: MIT
// argusd: from arguments to exit code.
#ifndef ARGUSD_APP_H
#define ARGUSD_APP_H

int app_main(int argc, char **argv);

#endif
