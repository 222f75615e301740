// SPDX-License-Identifier: MIT
// Attacks: the fake medium loses exactly what a power cut at byte N loses, and keeps what was there before.
#include <string.h>

#include "hal/fake_store.h"
#include "unity.h"

static const uint8_t old_header[HAL_STORE_HEADER] = "OLD HEADER";
static const uint8_t new_header[HAL_STORE_HEADER] = "new header";

static int put(hal_medium_t medium, int slot, const uint8_t *header, const char *record, size_t count) {
    return medium.ops->write(medium.context, slot, header, (const uint8_t *)record, count);
}

static int get(hal_medium_t medium, size_t offset, uint8_t *bytes, size_t count) {
    return medium.ops->read(medium.context, 0, offset, bytes, count);
}

void test_cut_at_byte_n(void) {
    const uint32_t whole = HAL_STORE_HEADER + 8;
    for (uint32_t cut = 0; cut <= whole; cut++) {
        static hal_fake_store_t fake;
        uint8_t back[64] = {0};
        hal_fake_store_init(&fake);
        const hal_medium_t medium = hal_fake_store_medium(&fake);
        TEST_ASSERT_EQUAL_INT(HAL_STORE_EMPTY, get(medium, 0, back, sizeof back));
        TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, put(medium, 0, old_header, "OLDDATA!", 8));
        fake.cut_after = fake.written + cut;
        const int result = put(medium, 0, new_header, "newdata?", 8);
        TEST_ASSERT_EQUAL_INT(cut == whole ? HAL_STORE_OK : HAL_STORE_IO, result);
        if (cut < whole) {
            TEST_ASSERT_EQUAL_INT(HAL_STORE_IO, get(medium, 0, back, sizeof back));
        }
        hal_fake_store_power_on(&fake);
        TEST_ASSERT_EQUAL_INT((int)whole, get(medium, 0, back, sizeof back));
        uint8_t expected[HAL_STORE_HEADER + 8];
        uint8_t wanted[HAL_STORE_HEADER + 8];
        memcpy(expected, old_header, HAL_STORE_HEADER);
        memcpy(expected + HAL_STORE_HEADER, "OLDDATA!", 8);
        memcpy(wanted, new_header, HAL_STORE_HEADER);
        memcpy(wanted + HAL_STORE_HEADER, "newdata?", 8);
        memcpy(expected, wanted, cut);
        TEST_ASSERT_EQUAL_MEMORY(expected, back, whole);
        TEST_ASSERT_EQUAL_INT(3, get(medium, whole - 3, back, sizeof back));
        TEST_ASSERT_EQUAL_MEMORY(expected + whole - 3, back, 3);
    }
}

void test_too_long_a_write_is_refused(void) {
    static hal_fake_store_t fake;
    static char bytes[HAL_STORE_RECORD_MAX + 1];
    hal_fake_store_init(&fake);
    const hal_medium_t medium = hal_fake_store_medium(&fake);
    TEST_ASSERT_EQUAL_INT(HAL_STORE_IO, put(medium, 1, old_header, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, put(medium, 1, old_header, bytes, HAL_STORE_RECORD_MAX));
}
