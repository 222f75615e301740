// SPDX-License-Identifier: MIT
// Checks a board's settings before they are compiled in, with the code that the board itself runs.
#include <stdio.h>

#include "board/config.h"

#define TEXT_MAX 16384

static const char usage[] = "usage: board_config FILE\n"
                            "Checks the settings of an INI file as a board does and prints their digest, "
                            "which the board tells at its start.\n"
                            "example: build/release/board_config board.ini\n"
                            "exit codes: 0 good, 1 refused (FILE:LINE: why), 2 no such file\n";

static int check(const char *path, const char *text) {
    argus_config_t config;
    unsigned line = 0;
    argus_config_default(&config);
    config.active = 0; // as on a board: passive unless the file says otherwise
    const board_config_answer_t answer = board_config_ini(&config, text, &line);
    if (answer != BOARD_CONFIG_TAKEN) {
        fprintf(stderr, "board_config: %s:%u: %s\n", path, line, board_config_explain(answer));
        return 1;
    }
    const argus_config_report_t report = argus_config_check(&config);
    if (report.fault != ARGUS_CONFIG_OK) {
        fprintf(stderr, "board_config: %s: %s\n", path,
                board_config_fault_text((argus_config_fault_t)report.fault));
        return 1;
    }
    printf("%08x\n", (unsigned)board_config_digest(&config));
    return 0;
}

int main(int argc, char **argv) {
    static char text[TEXT_MAX + 1];
    if (argc != 2 || argv[1][0] == '-') {
        fputs(usage, argc == 2 ? stdout : stderr);
        return argc == 2 ? 0 : 2;
    }
    FILE *const file = fopen(argv[1], "re");
    if (file == NULL) {
        fprintf(stderr, "board_config: %s: cannot be opened\n", argv[1]);
        return 2;
    }
    const size_t count = fread(text, 1, TEXT_MAX, file);
    const int failed = ferror(file) != 0 || count == TEXT_MAX;
    fclose(file);
    if (failed) {
        fprintf(stderr, "board_config: %s: cannot be read, or is longer than %d bytes\n", argv[1], TEXT_MAX);
        return 2;
    }
    return check(argv[1], text);
}
