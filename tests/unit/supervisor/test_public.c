// SPDX-License-Identifier: MIT
// Attacks: the memory that a port gives is enough and its contents before do not matter; instances are apart;
// what cannot be done is refused.
#include <stdio.h>
#include <string.h>

#include "supervisor/manager.h"
#include "unity.h"

static argus_storage_t storage[2];
static argus_config_t config;

void setUp(void) {
    argus_config_default(&config);
}

void test_what_was_in_the_memory_does_not_matter(void) {
    argus_status_t first;
    argus_status_t second;
    memset(&storage[0], 0x00, sizeof storage[0]);
    memset(&storage[1], 0xFF, sizeof storage[1]);
    argus_status(argus_init(&storage[0], &config, 5), &first);
    argus_t *const other = argus_init(&storage[1], &config, 5);
    argus_status(other, &second);
    TEST_ASSERT_EQUAL_PTR(&storage[1], other);
    TEST_ASSERT_EQUAL_INT(0, argus_invariants_broken(other));
    TEST_ASSERT_EQUAL_STRING(first.robot_name, second.robot_name);
    TEST_ASSERT_EQUAL_MEMORY(first.health, second.health, sizeof first.health);
    TEST_ASSERT_EQUAL_MEMORY(&first.pose, &second.pose, sizeof first.pose);
    TEST_ASSERT_FALSE(second.open);
}

void test_instances_are_apart(void) {
    argus_event_t event;
    argus_t *const one = argus_init(&storage[0], &config, 0);
    argus_t *const other = argus_init(&storage[1], &config, 0);
    argus_link_up(one, 10);
    TEST_ASSERT_TRUE(argus_next_event(one, &event));
    TEST_ASSERT_EQUAL_UINT16(ARGUS_EV_LINK_UP, event.id);
    TEST_ASSERT_FALSE(argus_next_event(other, &event));
}

void test_what_cannot_be_done_is_refused_without_an_event(void) {
    argus_event_t event;
    argus_t *const argus = argus_init(&storage[0], &config, 0);
    TEST_ASSERT_FALSE(argus_operator(argus, 1, ARGUS_OP_RETEST, 3)); // no session
    TEST_ASSERT_FALSE(argus_operator(argus, 1, ARGUS_OP_PIN, ARGUS_SONARS));
    TEST_ASSERT_FALSE(argus_operator(argus, 1, ARGUS_OP_PIN, -1));
    TEST_ASSERT_FALSE(argus_next_event(argus, &event));
    TEST_ASSERT_TRUE(argus_operator(argus, 1, ARGUS_OP_PIN, 3));
    argus_shutdown(argus, 2);
    TEST_ASSERT_TRUE(argus_closed(argus));
    TEST_ASSERT_FALSE(argus_operator(argus, 3, ARGUS_OP_GO, 0));
}

void test_an_unsafe_configuration_starts_passive_and_stays_so(void) {
    argus_status_t status;
    config.speed_mm_s = 750;
    argus_t *const argus = argus_init(&storage[0], &config, 0);
    argus_operator(argus, 1, ARGUS_OP_ACTIVE, 0);
    argus_status(argus, &status);
    TEST_ASSERT_FALSE(status.active);
}

// What a port gives is what it pays in RAM: room for other compilers, but not more.
void test_the_memory_asked_of_a_port_is_what_the_manager_needs(void) {
    char message[96];
    snprintf(message, sizeof message, "lower ARGUS_STORAGE_BYTES (argus/argus.h) to %u",
             (unsigned)((sizeof(argus_t) + 2048) / 1024 * 1024));
    TEST_ASSERT_LESS_OR_EQUAL_size_t_MESSAGE(sizeof(argus_t) + 4096, sizeof(argus_storage_t), message);
}
