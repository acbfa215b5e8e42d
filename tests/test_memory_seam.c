/* The seam for memory: what it gives, and what it refuses and leaves alone. */
#include "base/memory.h"
#include "check.h"
#include "failing.h"

#include <stdlib.h>
#include <string.h>

/* Three arrays of different elements that grow together, filled so far as they are known to be. */
typedef struct trio {
    size_t capacity;
    double *wide;
    unsigned char *narrow;
    struct {
        int a, b, c;
    } * odd;
} trio;

static ilsa_status grow(trio *t, size_t count) {
    const grown_array arrays[] = {ILSAI_GROWN(t->wide), ILSAI_GROWN(t->narrow),
                                  ILSAI_GROWN(t->odd)};
    return ilsai_grow(count, &t->capacity, arrays, 3);
}

static void fill(trio *t, size_t from, size_t to) {
    for (size_t k = from; k < to; k++) {
        t->wide[k] = 0.5 * (double)k;
        t->narrow[k] = (unsigned char)(k % 251);
        t->odd[k].a = t->odd[k].b = t->odd[k].c = (int)k;
    }
}

static void check_filled(const trio *t, size_t count) {
    for (size_t k = 0; k < count; k++) {
        assert_true(t->wide[k] == 0.5 * (double)k);
        assert_int_equal(t->narrow[k], k % 251);
        assert_int_equal(t->odd[k].a, k);
        assert_int_equal(t->odd[k].b, k);
        assert_int_equal(t->odd[k].c, k);
    }
}

static void release(trio *t) {
    ilsai_release(t->wide);
    ilsai_release(t->narrow);
    ilsai_release(t->odd);
}

/* ---- Room ------------------------------------------------------------------------------------ */

static void room_is_as_large_as_asked(void **state) {
    (void)state;
    unsigned char *plain = ilsai_allocate(1000, 3), *zeroed = ilsai_allocate_zeroed(1000, 3);
    assert_true(plain && zeroed);
    memset(plain, 0xa5, 3000);
    for (int k = 0; k < 3000; k++)
        assert_int_equal(zeroed[k], 0);
    memset(zeroed, 0xa5, 3000);
    ilsai_release(plain);
    ilsai_release(zeroed);
}

/* Memory that was dirty before is zeroed too. */
static void used_memory_is_zeroed_again(void **state) {
    (void)state;
    for (int time = 0; time < 20; time++) {
        unsigned char *dirty = ilsai_allocate(64, 8);
        assert_non_null(dirty);
        memset(dirty, 0xff, 512);
        ilsai_release(dirty);
        unsigned char *zeroed = ilsai_allocate_zeroed(8, 64);
        assert_non_null(zeroed);
        for (int k = 0; k < 512; k++)
            assert_int_equal(zeroed[k], 0);
        ilsai_release(zeroed);
    }
}

static void room_for_nothing_can_be_released(void **state) {
    (void)state;
    static const size_t none[][2] = {{0, 0}, {0, 8}, {8, 0}, {0, SIZE_MAX}, {SIZE_MAX, 0}};
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        void *plain = ilsai_allocate(none[k][0], none[k][1]);
        void *zeroed = ilsai_allocate_zeroed(none[k][0], none[k][1]);
        assert_true(plain && zeroed && plain != zeroed);
        ilsai_release(plain);
        ilsai_release(zeroed);
    }
    ilsai_release(NULL);
}

/* Products that come round to a small number, to zero or to SIZE_MAX. */
static void overflow_is_refused(void **state) {
    (void)state;
    static const size_t half = SIZE_MAX / 2 + 1;
    const size_t over[][2] = {{half, 2},     {2, half},         {half + 1, 2},
                              {SIZE_MAX, 2}, {SIZE_MAX / 8, 9}, {9, SIZE_MAX / 8},
                              {SIZE_MAX, 1}, {1, SIZE_MAX},     {SIZE_MAX, SIZE_MAX}};
    for (size_t k = 0; k < sizeof over / sizeof *over; k++) {
        assert_null(ilsai_allocate(over[k][0], over[k][1]));
        assert_null(ilsai_allocate_zeroed(over[k][0], over[k][1]));
    }
}

static void refusals_of_the_system_are_passed_on(void **state) {
    (void)state;
    allocations_left = 0;
    void *plain = ilsai_allocate(3, 8), *zeroed = ilsai_allocate_zeroed(3, 8);
    allocations_left = -1;
    assert_true(!plain && !zeroed);
}

/* ---- Growth ---------------------------------------------------------------------------------- */

static void contents_are_kept(void **state) {
    (void)state;
    trio t = {0};
    size_t filled = 0;
    int moves = 0;
    for (size_t count = 1; count < 20000; count += 1 + count / 7) {
        const size_t before = t.capacity;
        assert_int_equal(grow(&t, count), ILSA_OK);
        assert_true(t.capacity >= count && t.capacity >= before);
        assert_true(count > before || t.capacity == before);
        moves += t.capacity != before;
        check_filled(&t, filled);
        fill(&t, filled, t.capacity);
        filled = t.capacity;
    }
    check_filled(&t, filled);
    assert_true(moves > 5 && moves < 30);
    release(&t);
}

/* Half as much again as is asked for, not much more. */
static void growth_is_by_half(void **state) {
    (void)state;
    static const size_t count[] = {1, 10, 1000, 100000};
    for (size_t k = 0; k < sizeof count / sizeof *count; k++) {
        trio t = {0};
        assert_int_equal(grow(&t, count[k]), ILSA_OK);
        assert_true(2 * t.capacity >= 3 * count[k] && 2 * t.capacity <= 3 * count[k] + 64);
        release(&t);
    }
}

static void enough_room_is_left_alone(void **state) {
    (void)state;
    trio t = {0};
    assert_int_equal(grow(&t, 0), ILSA_OK);
    assert_true(t.capacity == 0 && !t.wide && !t.narrow && !t.odd);
    assert_int_equal(grow(&t, 100), ILSA_OK);
    const trio before = t;
    allocations_left = 0; /* none is asked for */
    const ilsa_status less = grow(&t, 7), same = grow(&t, t.capacity);
    allocations_left = -1;
    assert_int_equal(less, ILSA_OK);
    assert_int_equal(same, ILSA_OK);
    assert_memory_equal(&t, &before, sizeof t);
    release(&t);
}

/* Whichever of the three is refused: all that they held is there, and they can grow later. */
static void refused_growth_changes_nothing(void **state) {
    (void)state;
    for (int allowed = 0; allowed < 3; allowed++) {
        trio t = {0};
        assert_int_equal(grow(&t, 50), ILSA_OK);
        const size_t capacity = t.capacity;
        fill(&t, 0, capacity);
        allocations_left = allowed;
        const ilsa_status status = grow(&t, 5000);
        allocations_left = -1;
        assert_int_equal(status, ILSA_ERR_MEMORY);
        assert_int_equal(t.capacity, capacity);
        check_filled(&t, capacity);
        assert_int_equal(grow(&t, 5000), ILSA_OK);
        assert_true(t.capacity >= 5000);
        check_filled(&t, capacity);
        release(&t);
    }
}

/* Counts whose bytes, or whose half as much again, are beyond what a size can say. */
static void growth_beyond_all_sizes_is_refused(void **state) {
    (void)state;
    static const size_t count[] = {SIZE_MAX,         SIZE_MAX - 1,
                                   SIZE_MAX / 3 * 2, SIZE_MAX / 3 * 2 + 40,
                                   SIZE_MAX / 8 + 1, SIZE_MAX / 12 + 1};
    trio t = {0};
    assert_int_equal(grow(&t, 50), ILSA_OK);
    const size_t capacity = t.capacity;
    fill(&t, 0, capacity);
    for (size_t k = 0; k < sizeof count / sizeof *count; k++) {
        assert_int_equal(grow(&t, count[k]), ILSA_ERR_MEMORY);
        assert_int_equal(t.capacity, capacity);
        check_filled(&t, capacity);
    }
    release(&t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(room_is_as_large_as_asked),
        cmocka_unit_test(used_memory_is_zeroed_again),
        cmocka_unit_test(room_for_nothing_can_be_released),
        cmocka_unit_test(overflow_is_refused),
        cmocka_unit_test(refusals_of_the_system_are_passed_on),
        cmocka_unit_test(contents_are_kept),
        cmocka_unit_test(growth_is_by_half),
        cmocka_unit_test(enough_room_is_left_alone),
        cmocka_unit_test(refused_growth_changes_nothing),
        cmocka_unit_test(growth_beyond_all_sizes_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
