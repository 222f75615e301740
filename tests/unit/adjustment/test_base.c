// SPDX-License-Identifier: MIT
// Rule under attack: S4: the first heading that is taken stays the one to return to, until it is dropped or a
// new one is wanted.
#include "adjustment/base.h"

#include "unity.h"

void test_the_first_one_stays_until_it_is_dropped(void) {
    argus_base_t base = {0, false};
    argus_base_take(&base, 4500);
    TEST_ASSERT_TRUE(base.taken);
    TEST_ASSERT_EQUAL_INT32(4500, base.cdeg);
    argus_base_take(&base, -9000);
    TEST_ASSERT_EQUAL_INT32(4500, base.cdeg);
    argus_base_drop(&base);
    TEST_ASSERT_FALSE(base.taken);
    argus_base_take(&base, -9000);
    TEST_ASSERT_TRUE(base.taken);
    TEST_ASSERT_EQUAL_INT32(-9000, base.cdeg);
}

void test_a_new_one_replaces_it(void) {
    argus_base_t base = {100, true};
    argus_base_renew(&base, 200);
    TEST_ASSERT_EQUAL_INT32(200, base.cdeg);
    TEST_ASSERT_TRUE(base.taken);
}
