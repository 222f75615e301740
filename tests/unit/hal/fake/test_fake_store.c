// SPDX-License-Identifier: MIT
// Attacks: the fake medium loses exactly what a power cut at byte N loses, and keeps what was there before.
#include <string.h>

#include "hal/fake_store.h"
#include "unity.h"

void test_cut_at_byte_n(void) {
    for (uint32_t cut = 0; cut <= 8; cut++) {
        hal_fake_store_t fake;
        uint8_t back[16] = {0};
        hal_fake_store_init(&fake);
        const hal_medium_t medium = hal_fake_store_medium(&fake);
        TEST_ASSERT_EQUAL_INT(HAL_STORE_EMPTY, medium.ops->read(medium.context, 0, back, sizeof back));
        TEST_ASSERT_EQUAL_INT(HAL_STORE_OK,
                              medium.ops->write(medium.context, 0, (const uint8_t *)"OLDDATA!", 8));
        fake.cut_after = fake.written + cut;
        const int result = medium.ops->write(medium.context, 0, (const uint8_t *)"newdata?", 8);
        TEST_ASSERT_EQUAL_INT(cut == 8 ? HAL_STORE_OK : HAL_STORE_IO, result);
        if (cut < 8) {
            TEST_ASSERT_EQUAL_INT(HAL_STORE_IO, medium.ops->read(medium.context, 0, back, sizeof back));
        }
        hal_fake_store_power_on(&fake);
        TEST_ASSERT_EQUAL_INT(8, medium.ops->read(medium.context, 0, back, sizeof back));
        char expected[9] = "OLDDATA!";
        memcpy(expected, "newdata?", cut);
        TEST_ASSERT_EQUAL_MEMORY(expected, back, 8);
    }
}

void test_too_long_a_write_is_refused(void) {
    static hal_fake_store_t fake;
    static uint8_t bytes[HAL_STORE_SLOT_MAX + 1];
    hal_fake_store_init(&fake);
    const hal_medium_t medium = hal_fake_store_medium(&fake);
    TEST_ASSERT_EQUAL_INT(HAL_STORE_IO, medium.ops->write(medium.context, 1, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, medium.ops->write(medium.context, 1, bytes, HAL_STORE_SLOT_MAX));
}
