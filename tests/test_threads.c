/*
 * Threads inside one solver: the team that shares its loops, and that the bits of a step do not
 * depend on how many there are. `make tsan` runs this under ThreadSanitizer.
 */
#include "base/thread_pool.h"
#include "check.h"
#include "failing.h"
#include "host.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* ---- The team ---------------------------------------------------------------------------------
 */

enum { MOST = 5000 };

/* How often each turn was run. */
typedef struct tally {
    int times[MOST];
} tally;

static void count_turns(void *context, int first, int end) {
    tally *t = context;
    for (int k = first; k < end; k++)
        t->times[k]++;
}

static void check_loop(thread_pool *threads, int count, int least) {
    tally *t = calloc(1, sizeof *t);
    assert_non_null(t);
    ilsai_thread_pool_run(threads, count_turns, t, count, least);
    for (int k = 0; k < MOST; k++)
        if (t->times[k] != (k < count))
            fail_msg("%d turns by %d: turn %d was run %d times", count, least, k, t->times[k]);
    free(t);
}

static void every_turn_is_run_once(void **state) {
    (void)state;
    static const int sizes[] = {1, 2, 3, 5, 64};
    for (int s = 0; s < 5; s++) {
        thread_pool *threads = sizes[s] > 1 ? ilsai_thread_pool_create(sizes[s]) : NULL;
        assert_true(threads || sizes[s] == 1);
        for (int count = 0; count < 300; count++)
            check_loop(threads, count, 1);
        for (int least = 1; least < 2 * MOST; least *= 3)
            check_loop(threads, MOST, least);
        ilsai_thread_pool_destroy(&threads);
        assert_null(threads);
    }
}

/* Parts that a loop was handed out in, and turns of the shortest. */
typedef struct division {
    atomic_int parts, shortest;
} division;

static void note_part(void *context, int first, int end) {
    division *d = context;
    int shortest = atomic_load(&d->shortest);
    atomic_fetch_add(&d->parts, 1);
    while (end - first < shortest &&
           !atomic_compare_exchange_weak(&d->shortest, &shortest, end - first)) {
    }
}

/* A loop is shared as soon as it is long enough for two parts, none shorter than the least. */
static void loops_are_shared_from_two_parts_on(void **state) {
    (void)state;
    thread_pool *threads = ilsai_thread_pool_create(2);
    assert_non_null(threads);
    for (int least = 1; least < 100; least += 7)
        for (int count = 1; count < 4 * least; count++) {
            division d = {0, MOST};
            ilsai_thread_pool_run(threads, note_part, &d, count, least);
            assert_int_equal(atomic_load(&d.parts), count < 2 * least ? 1 : count / least);
            assert_true(atomic_load(&d.shortest) >= (count < least ? count : least));
        }
    ilsai_thread_pool_destroy(&threads);
}

static void pause_for(long nanoseconds) {
    struct timespec wait = {0, nanoseconds};
    nanosleep(&wait, NULL);
}

/* Loops that come while the others look for work, go to sleep and sleep. */
static void loops_may_come_at_any_time(void **state) {
    (void)state;
    thread_pool *threads = ilsai_thread_pool_create(3);
    assert_non_null(threads);
    for (int k = 0; k < 200; k++) {
        check_loop(threads, 40, 1);
        if (k % 2)
            pause_for(k * 20000L);
    }
    ilsai_thread_pool_destroy(&threads);
}

/* Sums of one loop are read in the next, each by whoever comes. */
typedef struct chain {
    double from[MOST], to[MOST];
} chain;

static void add_neighbours(void *context, int first, int end) {
    chain *c = context;
    for (int k = first; k < end; k++)
        c->to[k] =
            0.25 * (c->from[(k + MOST - 1) % MOST] + 2 * c->from[k] + c->from[(k + 1) % MOST]);
}

static void hand_back(void *context, int first, int end) {
    chain *c = context;
    memcpy(c->from + first, c->to + first, (size_t)(end - first) * sizeof *c->from);
}

static void smooth(chain *c, thread_pool *threads) {
    for (int k = 0; k < MOST; k++)
        c->from[k] = k % 17;
    for (int k = 0; k < 300; k++) {
        ilsai_thread_pool_run(threads, add_neighbours, c, MOST, 100);
        ilsai_thread_pool_run(threads, hand_back, c, MOST, 100);
    }
}

static void loops_see_what_came_before(void **state) {
    (void)state;
    chain *alone = malloc(sizeof *alone), *shared = malloc(sizeof *shared);
    assert_true(alone && shared);
    smooth(alone, NULL);
    for (int size = 2; size <= 4; size++) {
        thread_pool *threads = ilsai_thread_pool_create(size);
        assert_non_null(threads);
        smooth(shared, threads);
        assert_memory_equal(alone->from, shared->from, sizeof alone->from);
        ilsai_thread_pool_destroy(&threads);
    }
    free(alone);
    free(shared);
}

static void a_team_may_end_at_once(void **state) {
    (void)state;
    thread_pool *threads = NULL;
    ilsai_thread_pool_destroy(&threads);
    for (int k = 0; k < 50; k++) {
        threads = ilsai_thread_pool_create(2 + k % 5);
        assert_non_null(threads);
        if (k % 3 == 0)
            pause_for(300000);
        ilsai_thread_pool_destroy(&threads);
    }
}

/* ---- Solvers ----------------------------------------------------------------------------------
 */

/* Layers and leak-off, and cells enough for parts: 2 800 unknowns. */
static host_scene layers(int threads, ilsa_symmetry symmetry) {
    int cells = symmetry == ILSA_SYMMETRY_NONE ? 81 : 141;
    host_scene scene = host_three_layers(cells, cells);
    scene.interface_y[0] = symmetry == ILSA_SYMMETRY_NONE ? -19.7 : -40;
    scene.interface_y[1] = symmetry == ILSA_SYMMETRY_NONE ? 24.1 : 40;
    scene.options.symmetry = symmetry;
    scene.options.threads = threads;
    return scene;
}

static host_image run(const host_scene *scene, int steps) {
    ilsa_solver *solver = host_started(scene, 0.37 * scene->mesh.nx * scene->mesh.dx);
    host_steps(solver, steps);
    host_image image = host_save(solver);
    ilsa_solver_destroy(&solver);
    return image;
}

static void bits_do_not_depend_on_threads(void **state) {
    (void)state;
    for (int symmetry = ILSA_SYMMETRY_AUTO; symmetry <= ILSA_SYMMETRY_NONE; symmetry++) {
        host_image alone;
        for (int threads = 1; threads <= 3; threads++) {
            host_scene scene = layers(threads, (ilsa_symmetry)symmetry);
            host_image image = run(&scene, 3);
            if (threads == 1) {
                alone = image;
                continue;
            }
            if (!host_same(&image, &alone))
                fail_msg("%d threads, symmetry %d", threads, symmetry);
            host_free(&image);
        }
        host_free(&alone);
    }
}

/* A snapshot goes from a solver to one with another number of threads, and on with the same bits.
 */
static void snapshots_do_not_know_of_threads(void **state) {
    (void)state;
    host_scene scene = layers(2, ILSA_SYMMETRY_AUTO);
    ilsa_solver *two = host_started(&scene, 40);
    scene.options.threads = 3;
    ilsa_solver *three = host_solver(&scene);
    host_steps(two, 2);
    host_image image = host_save(two);
    host_restore(three, &image);
    host_steps(two, 2);
    host_steps(three, 2);
    host_free(&image);
    image = host_save(two);
    assert_true(host_is(three, &image));
    host_free(&image);
    ilsa_solver_destroy(&two);
    ilsa_solver_destroy(&three);
}

static void coarsening_keeps_the_threads(void **state) {
    (void)state;
    host_image image[2];
    for (int k = 0; k < 2; k++) {
        host_scene scene = layers(k + 1, ILSA_SYMMETRY_AUTO);
        ilsa_solver *solver = host_started(&scene, 45);
        host_steps(solver, 1);
        assert_int_equal(ilsa_coarsen(solver), ILSA_OK);
        host_steps(solver, 2);
        image[k] = host_save(solver);
        ilsa_solver_destroy(&solver);
    }
    assert_true(host_same(&image[0], &image[1]));
    host_free(&image[0]);
    host_free(&image[1]);
}

static void *run_in_thread(void *image) {
    host_scene scene = layers(2, ILSA_SYMMETRY_NONE);
    *(host_image *)image = run(&scene, 1);
    return NULL;
}

/* Two solvers of two threads each, stepped at once. */
static void solvers_with_threads_do_not_disturb_each_other(void **state) {
    (void)state;
    pthread_t thread[2];
    host_image alone, image[2];
    for (int t = 0; t < 2; t++)
        assert_int_equal(pthread_create(&thread[t], NULL, run_in_thread, &image[t]), 0);
    for (int t = 0; t < 2; t++)
        assert_int_equal(pthread_join(thread[t], NULL), 0);
    run_in_thread(&alone);
    for (int t = 0; t < 2; t++) {
        assert_true(host_same(&alone, &image[t]));
        host_free(&image[t]);
    }
    host_free(&alone);
}

static void bad_numbers_are_refused(void **state) {
    (void)state;
    static const int bad[] = {-1, 65, 1000, -2147483647 - 1, 2147483647};
    for (int k = 0; k < 5; k++) {
        host_scene scene = layers(bad[k], ILSA_SYMMETRY_NONE);
        ilsa_solver *solver;
        assert_int_equal(host_try(&scene, &solver), ILSA_ERR_VALUE);
        assert_non_null(strstr(ilsa_last_error(NULL), "threads = "));
        assert_null(solver);
    }
}

static void the_model_has_the_number(void **state) {
    (void)state;
    for (int threads = 0; threads <= 64; threads += 16) {
        host_scene scene = layers(threads, ILSA_SYMMETRY_NONE);
        ilsa_solver *solver = host_started(&scene, 20);
        ilsa_model model;
        assert_int_equal(ilsa_get_model(solver, &model), ILSA_OK);
        assert_int_equal(model.threads, threads ? threads : 1);
        ilsa_solver_destroy(&solver);
    }
}

static void create_survives_no_memory(void **state) {
    (void)state;
    host_scene scene = layers(3, ILSA_SYMMETRY_NONE);
    ilsa_solver *solver = NULL;
    int said = 0;
    ilsa_status status = ILSA_ERR_MEMORY;
    for (int most = 0; status != ILSA_OK; most++) {
        allocations_left = most;
        status = host_try(&scene, &solver);
        allocations_left = -1;
        assert_true(status == ILSA_OK || (status == ILSA_ERR_MEMORY && !solver));
        said += status != ILSA_OK && strstr(ilsa_last_error(NULL), "no memory for 3 threads");
    }
    assert_int_equal(said, 3); /* the team, and two threads beside the caller */
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_turn_is_run_once),
        cmocka_unit_test(loops_are_shared_from_two_parts_on),
        cmocka_unit_test(loops_may_come_at_any_time),
        cmocka_unit_test(loops_see_what_came_before),
        cmocka_unit_test(a_team_may_end_at_once),
        cmocka_unit_test(bits_do_not_depend_on_threads),
        cmocka_unit_test(snapshots_do_not_know_of_threads),
        cmocka_unit_test(coarsening_keeps_the_threads),
        cmocka_unit_test(solvers_with_threads_do_not_disturb_each_other),
        cmocka_unit_test(bad_numbers_are_refused),
        cmocka_unit_test(the_model_has_the_number),
        cmocka_unit_test(create_survives_no_memory),
    };
    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
