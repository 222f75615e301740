// SPDX-License-Identifier: MIT
// Attacks: slots are files that are replaced whole, nothing else is left behind, and refusals of the system
// are named.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/store.h"
#include "unity.h"

static char folder[64];
static char path[96];
static hal_file_medium_t files;
static hal_store_t store;

static void remove_all(void) {
    static const char *const ends[] = {".a", ".b", ".tmp"};
    for (int i = 0; i < 3; i++) {
        char name[128];
        snprintf(name, sizeof name, "%s%s", path, ends[i]);
        unlink(name);
        rmdir(name);
    }
}

void setUp(void) {
    strcpy(folder, "/tmp/argus-store-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/state", folder);
    TEST_ASSERT_TRUE(hal_file_medium_init(&files, path));
    hal_store_init(&store, hal_file_medium(&files));
}

void tearDown(void) {
    remove_all();
    rmdir(folder);
}

static int exists(const char *end) {
    char name[128];
    snprintf(name, sizeof name, "%s%s", path, end);
    return access(name, F_OK) == 0;
}

void test_saves_alternate_and_leave_no_scratch(void) {
    char record[16];
    size_t count = 0;
    TEST_ASSERT_EQUAL_INT(HAL_STORE_EMPTY, hal_store_load(&store, record, sizeof record, &count));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, "one", 3));
    TEST_ASSERT_TRUE(exists(".a") && !exists(".b"));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, "two!", 4));
    TEST_ASSERT_TRUE(exists(".a") && exists(".b") && !exists(".tmp"));
    hal_store_init(&store, hal_file_medium(&files));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_load(&store, record, sizeof record, &count));
    TEST_ASSERT_EQUAL_size_t(4, count);
    TEST_ASSERT_EQUAL_MEMORY("two!", record, 4);
}

void test_cut_and_lengthened_files_are_damage(void) {
    char record[16];
    char name[128];
    size_t count = 0;
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, "one", 3));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, "two", 3));
    snprintf(name, sizeof name, "%s.b", path);
    for (int size = 0; size <= 8000; size += size < 20 ? 1 : 997) {
        TEST_ASSERT_EQUAL_INT(0, truncate(name, size));
        hal_store_init(&store, hal_file_medium(&files));
        TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_load(&store, record, sizeof record, &count));
        TEST_ASSERT_EQUAL_MEMORY("one", record, 3);
        TEST_ASSERT_TRUE(store.damaged[1]);
    }
}

void test_relative_path_without_a_folder(void) {
    char here[256];
    TEST_ASSERT_NOT_NULL(getcwd(here, sizeof here));
    TEST_ASSERT_EQUAL_INT(0, chdir(folder));
    TEST_ASSERT_TRUE(hal_file_medium_init(&files, "state"));
    const hal_store_error_t result = hal_store_save(&store, "x", 1);
    TEST_ASSERT_EQUAL_INT(0, chdir(here));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, result);
    TEST_ASSERT_TRUE(exists(".a"));
}

void test_refusals_are_named(void) {
    char name[128];
    char long_path[HAL_STORE_PATH_MAX + 1];
    memset(long_path, 'p', sizeof long_path);
    long_path[HAL_STORE_PATH_MAX] = '\0';
    TEST_ASSERT_FALSE(hal_file_medium_init(&files, long_path));
    TEST_ASSERT_FALSE(hal_file_medium_init(&files, ""));

    snprintf(name, sizeof name, "%s/missing/state", folder);
    TEST_ASSERT_TRUE(hal_file_medium_init(&files, name));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_NO_PLACE, hal_store_save(&store, "x", 1));

    TEST_ASSERT_TRUE(hal_file_medium_init(&files, path));
    snprintf(name, sizeof name, "%s.a", path);
    TEST_ASSERT_EQUAL_INT(0, mkdir(name, 0700));
    hal_store_init(&store, hal_file_medium(&files));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_IO, hal_store_save(&store, "x", 1));
}

void test_a_link_in_place_of_the_scratch_file_is_not_followed(void) {
    char name[128];
    char victim[128];
    snprintf(victim, sizeof victim, "%s/victim", folder);
    snprintf(name, sizeof name, "%s.tmp", path);
    TEST_ASSERT_EQUAL_INT(0, symlink(victim, name));
    TEST_ASSERT_NOT_EQUAL(HAL_STORE_OK, hal_store_save(&store, "x", 1));
    TEST_ASSERT_NOT_EQUAL(0, access(victim, F_OK));
}
