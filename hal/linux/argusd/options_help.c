// SPDX-License-Identifier: MIT
// argusd --help.
#include "argusd.h"
#include "options.h"

#define INDENT "                     "

// All forms of a link, one below the other.
static void print_links(FILE *out) {
    for (size_t i = 0; hal_scheme_at(i) != NULL; i++) {
        const char *const after = hal_scheme_at(i + 1) == NULL   ? ""
                                  : hal_scheme_at(i + 2) == NULL ? ", or"
                                                                 : ",";
        fputs(i == 0 ? "  --link LINK        " : INDENT, out);
        for (const char *at = hal_scheme_at(i)->help; *at != '\0'; at++) {
            fputc(*at, out);
            fputs(*at == '\n' ? INDENT : "", out);
        }
        fprintf(out, "%s\n", after);
    }
}

static void print_head(FILE *out) {
    fputs("argusd " ARGUS_VERSION ": keeps a Pioneer P3-DX seeing and driving safely when its sonars fail\n"
          "\n"
          "usage: argusd --link LINK [options]\n"
          "\n",
          out);
}

static void print_options(FILE *out) {
    fputs(
        "  --can-telemetry IFACE[,robot=K] | none\n"
        "                     health and readings as CAN frames, orders from there (tools/argus.dbc); with "
        "a\n"
        "                     can link its interface is the default\n"
        "  --auto-baud        serial: try 9600 38400 115200 19200 57600 and say what was found\n"
        "  --config FILE      settings (see --list-config)\n"
        "  --course FILE      drive this course: x_mm,y_mm per line, # comments\n"
        "  --goal X,Y         drive to this one point; mm, or as 2m,0; x ahead and y left of where the robot "
        "stands\n"
        "  --robot NAME       whose body and sonars it has, where it does not say so itself: a word of the "
        "setting\n"
        "                     robot (see --list-config); one that is not known is never driven\n"
        "  --ring FILE.toml   a ring and body of your own instead (docs/ring.md)\n"
        "  --guard PORT       pty:PATH or tcp:HOST:PORT, up to 4 times: there an ARCOS client (ARIA, p2os, "
        "...)\n"
        "                     finds the robot; its motion is bounded by what trusted sonars see "
        "(docs/guardian.md)\n"
        "  --guard-readings withhold|cover|pass\n"
        "                     what it gets of sonars that are out: nothing (default), what others have "
        "heard\n"
        "                     there lately, or what they say\n"
        "  --guard-beyond-loopback\n"
        "                     let a guard port listen where other machines reach it\n"
        "  --passive          diagnose and report, never command a motion\n"
        "  --active           drive. Only a TCP link to this machine drives at once; every other link only\n"
        "                     watches until you give --active\n"
        "  --state FILE       keep the sonars' history over restarts in FILE.a and FILE.b\n"
        "  --record FILE      append all bytes of the link, both directions, with their times (see "
        "argus-log)\n"
        "  --record-max MB    size at which FILE becomes FILE.1 and so on to FILE.4 (default 64)\n"
        "  --control unix:PATH | tcp:127.0.0.1:PORT\n"
        "                     a socket on which programs of this user watch and order (see argusctl)\n"
        "  --control-token FILE\n"
        "                     whoever connects must say its first line; needed with tcp\n"
        "  --control-beyond-loopback\n"
        "                     allow an address that other machines reach\n"
        "  --inject           arm argusctl fail: faults of sonars made by argusd itself, for tests\n"
        "  --attach PLACE     no robot of its own: the screen of the argusd whose --control is at "
        "PLACE\n",
        out);
}

static void print_running(FILE *out) {
    fputs(
        "  --realtime         before all other programs (SCHED_FIFO), in locked memory; without the right to "
        "that\n"
        "                     it tells what is missing and drives on\n"
        "  --realtime-priority P\n"
        "                     of SCHED_FIFO, 1 to 99 (default 40)\n"
        "  --cpus LIST        ... on these processors only: 1, or 0,2-3\n"
        "  --wait SECONDS     at start, how long to try for the port and for a robot's answer; or 'forever'\n"
        "                     (default: the port must be there, a robot has 30 s)\n"
        "  --check            connect, tell what is there, leave; the robot stays where it is\n"
        "  --survey           which sonar is broken: turn on the spot through a circle, print a verdict for "
        "each\n"
        "                     sonar and how sure it is, leave; where the robot may not turn it says why. Any "
        "link\n"
        "                     but TCP to this machine needs --active\n"
        "  --picture FILE.svg ... and draw the ring, each sonar in the colour of its verdict\n"
        "  --json             one JSON object per line on standard output\n"
        "  --plain            no screen on a terminal, a line per event instead\n"
        "  --status MS        time between status lines, 0 for none (default 500 with --json, else 2000)\n"
        "  --list-events      the event catalogue\n"
        "  --list-config      every setting: type, range, default, unit, meaning\n"
        "  --example-config   a config file with every setting\n"
        "  --version          print the version\n"
        "  --help             print this\n"
        "\n",
        out);
}

static void print_examples(FILE *out) {
    fputs("keys on the screen: arrows or w a s d drive, space stops, g goes on, r checks again, p "
          "passive/active,\n  n b choose a sonar, t re-tests it, k pins it or ends that, x takes it out; q "
          "ends\n"
          "\n"
          "examples:\n"
          "  argusd --link serial:/dev/ttyUSB0@9600 --check\n"
          "  argusd --link serial:/dev/ttyUSB0@9600 --survey --active\n"
          "  argusd --link serial:/dev/ttyUSB0 --auto-baud\n"
          "  argusd --link serial:/dev/ttyUSB0@9600 --active --goal 3000,0 --config argusd.conf\n"
          "  argusd --link tcp:localhost --course course.csv --json\n"
          "  argusd --link serial:/dev/ttyUSB0@9600 --guard tcp:127.0.0.1:8101 --guard pty:/run/argus/robot\n"
          "  argusd --link can:can0 --active --goal 3000,0\n"
          "  argusd --link serial:/dev/ttyUSB0@9600 --can-telemetry can0,robot=2\n"
          "  argusd --link tcp:localhost --control unix:/tmp/argus.sock --inject\n"
          "  argusd --attach unix:/tmp/argus.sock\n"
          "\n"
          "exit codes:\n",
          out);
}

void options_help(FILE *out) {
    print_head(out);
    print_links(out);
    print_options(out);
    print_running(out);
    print_examples(out);
#define EXIT_LINE(name, code, meaning) fprintf(out, "  %d  %s\n", code, meaning);
    ARGUSD_EXIT_TABLE(EXIT_LINE)
#undef EXIT_LINE
}
