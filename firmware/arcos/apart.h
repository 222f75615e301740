// SPDX-License-Identifier: MIT
// What many places ask for, or what takes many registers: calls are smaller than copies, which a compiler
// does not see.
#ifndef ARGUS_APART_H
#define ARGUS_APART_H

#ifdef __GNUC__
#define ARGUS_APART __attribute__((noinline))
#else
#define ARGUS_APART
#endif

#endif
