// SPDX-License-Identifier: MIT
// Attacks: the history outlives a restart, is saved only when it changed, and damage is said and survived.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "state.h"
#include "supervisor/manager.h"
#include "unity.h"

static argus_t core;
static state_t state;
static char folder[64];
static char path[96];
static char message[512];

static void remove_slot(const char *end) {
    char name[128];
    snprintf(name, sizeof name, "%s%s", path, end);
    unlink(name);
}

static void new_core(void) {
    argus_config_t config;
    argus_config_default(&config);
    argus_manager_init(&core, &config, 0);
}

static void open_state(void) {
    new_core();
    TEST_ASSERT_TRUE_MESSAGE(state_open(&state, path, &core, message, sizeof message), message);
}

static void disable(int sonar) {
    core.knowledge.sonar[sonar].health = ARGUS_DISABLED;
    core.knowledge.sonar[sonar].kind = ARGUS_KIND_OFF;
    core.knowledge.sonar[sonar].disabled_times++;
}

void setUp(void) {
    strcpy(folder, "/tmp/argus-state-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/state", folder);
}

void tearDown(void) {
    remove_slot(".a");
    remove_slot(".b");
    rmdir(folder);
}

void test_history_outlives_a_restart(void) {
    open_state();
    TEST_ASSERT_EQUAL_STRING("", message);
    disable(3);
    TEST_ASSERT_TRUE_MESSAGE(state_save(&state, &core, message, sizeof message), message);
    open_state();
    TEST_ASSERT_EQUAL_STRING("", message);
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_OFF, core.knowledge.sonar[3].kind_before);
    TEST_ASSERT_EQUAL_UINT16(1, core.knowledge.sonar[3].disabled_before);
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_NONE, core.knowledge.sonar[2].kind_before);
}

void test_saved_only_when_changed(void) {
    open_state();
    disable(3);
    TEST_ASSERT_TRUE(state_save(&state, &core, message, sizeof message));
    const uint32_t sequence = state.store.sequence;
    TEST_ASSERT_TRUE(state_save(&state, &core, message, sizeof message));
    TEST_ASSERT_EQUAL_UINT32(sequence, state.store.sequence);
    disable(5);
    TEST_ASSERT_TRUE(state_save(&state, &core, message, sizeof message));
    TEST_ASSERT_EQUAL_UINT32(sequence + 1, state.store.sequence);
}

static void damage(const char *end) {
    char name[128];
    snprintf(name, sizeof name, "%s%s", path, end);
    FILE *const file = fopen(name, "r+");
    TEST_ASSERT_NOT_NULL(file);
    fseek(file, 20, SEEK_SET);
    fputc('!', file);
    fclose(file);
}

void test_damage_is_said(void) {
    open_state();
    disable(3);
    TEST_ASSERT_TRUE(state_save(&state, &core, message, sizeof message));
    disable(5);
    TEST_ASSERT_TRUE(state_save(&state, &core, message, sizeof message));
    damage(".b");
    open_state();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "state.b is damaged: the other copy is used"), message);
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_OFF, core.knowledge.sonar[3].kind_before);
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_NONE, core.knowledge.sonar[5].kind_before);
    damage(".a");
    open_state();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "begins anew"), message);
}

void test_a_place_that_cannot_be_used(void) {
    new_core();
    char long_path[400];
    memset(long_path, 'p', sizeof long_path);
    long_path[sizeof long_path - 1] = '\0';
    TEST_ASSERT_FALSE(state_open(&state, long_path, &core, message, sizeof message));
    TEST_ASSERT_NOT_NULL(strstr(message, "longer than"));
    TEST_ASSERT_TRUE(state_open(&state, "/no/such/folder/state", &core, message, sizeof message));
    disable(3);
    TEST_ASSERT_FALSE(state_save(&state, &core, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "not saved: the folder is missing"), message);
}

void test_off_by_default(void) {
    static state_t none;
    new_core();
    disable(3);
    TEST_ASSERT_TRUE(state_save(&none, &core, message, sizeof message));
}
