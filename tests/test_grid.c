/* The folded mesh: representatives, images and neighbours agree with mirrored coordinates. */
#include "base/grid.h"
#include "check.h"

#include <math.h>
#include <stdlib.h>

enum { LEAST = 3, MOST = 8, MESHES = (MOST - LEAST + 1) * (MOST - LEAST + 1) * 4 };

/* Every mesh of LEAST .. MOST by LEAST .. MOST cells with every mirror. */
static grid nth_grid(int n) {
    int span = MOST - LEAST + 1;
    ilsa_mesh_def def = {LEAST + n / 4 % span, LEAST + n / 4 / span, 0.5, 2};
    return ilsai_grid(&def, n % 2, n / 2 % 2);
}

static int column(const grid *g, int cell) {
    return cell % g->nx;
}

static int row(const grid *g, int cell) {
    return cell / g->nx;
}

/* The column to the right of a mirror that x = columns - 1 - i and i share. */
static int unmirrored(int mirror, int n, int i) {
    int image = n - 1 - i;
    return mirror && image > i ? image : i;
}

static void fold_finds_the_cell_on_the_positive_side(void **state) {
    (void)state;
    for (int n = 0; n < MESHES; n++) {
        grid g = nth_grid(n);
        for (int j = 0; j < g.ny; j++) {
            for (int i = 0; i < g.nx; i++) {
                int fi = unmirrored(g.mirror_x, g.nx, i), fj = unmirrored(g.mirror_y, g.ny, j);
                int cell = ilsai_grid_fold(&g, i, j);
                assert_int_equal(cell, fj * g.nx + fi);
                assert_true(column(&g, cell) >= g.lo_x && row(&g, cell) >= g.lo_y);
                assert_int_equal(ilsai_grid_fold(&g, column(&g, cell), row(&g, cell)), cell);
            }
        }
    }
}

static void without_mirror_nothing_is_folded(void **state) {
    (void)state;
    for (int n = 0; n < MESHES; n += 4) {
        grid g = nth_grid(n);
        int image[4];
        assert_true(g.lo_x == 0 && g.lo_y == 0);
        for (int cell = 0; cell < g.nx * g.ny; cell++) {
            int i = column(&g, cell), j = row(&g, cell);
            assert_int_equal(ilsai_grid_cell(&g, i, j), cell);
            assert_int_equal(ilsai_grid_fold(&g, i, j), cell);
            assert_int_equal(ilsai_grid_images(&g, i, j, image), 1);
            assert_int_equal(image[0], cell);
        }
    }
}

/* Together the representatives stand for every cell of the mesh, and for none twice. */
static void images_partition_the_mesh(void **state) {
    (void)state;
    for (int n = 0; n < MESHES; n++) {
        grid g = nth_grid(n);
        int seen[MOST * MOST] = {0}, image[4];
        for (int j = g.lo_y; j < g.ny; j++) {
            for (int i = g.lo_x; i < g.nx; i++) {
                int count = ilsai_grid_images(&g, i, j, image);
                assert_int_equal(image[0], ilsai_grid_cell(&g, i, j));
                for (int k = 0; k < count; k++) {
                    seen[image[k]]++;
                    int fold = ilsai_grid_fold(&g, column(&g, image[k]), row(&g, image[k]));
                    assert_int_equal(fold, image[0]);
                }
            }
        }
        for (int cell = 0; cell < g.nx * g.ny; cell++) {
            assert_int_equal(seen[cell], 1);
        }
    }
}

/* Images lie at (+-x, +-y), to the last bit. */
static void images_are_mirrored_points(void **state) {
    (void)state;
    for (int n = 0; n < MESHES; n++) {
        grid g = nth_grid(n);
        int image[4];
        for (int cell = 0; cell < g.nx * g.ny; cell++) {
            int i = column(&g, cell), j = row(&g, cell);
            int count = ilsai_grid_images(&g, i, j, image);
            double x = ilsai_grid_x(&g, i), y = ilsai_grid_y(&g, j);
            int expected = (g.mirror_x && x != 0 ? 2 : 1) * (g.mirror_y && y != 0 ? 2 : 1);
            assert_int_equal(count, expected);
            for (int k = 0; k < count; k++) {
                assert_true(fabs(ilsai_grid_x(&g, column(&g, image[k]))) == fabs(x));
                assert_true(fabs(ilsai_grid_y(&g, row(&g, image[k]))) == fabs(y));
            }
        }
    }
}

static const int step_x[GRID_FACES] = {[GRID_LEFT] = -1, [GRID_RIGHT] = 1};
static const int step_y[GRID_FACES] = {[GRID_DOWN] = -1, [GRID_UP] = 1};

/* One cell on, the mirrored point has the same distances from the axes; beyond the edge is none. */
static void neighbours_are_one_cell_away(void **state) {
    (void)state;
    for (int n = 0; n < MESHES; n++) {
        grid g = nth_grid(n);
        for (int cell = 0; cell < g.nx * g.ny; cell++) {
            for (int face = 0; face < GRID_FACES; face++) {
                int i = column(&g, cell), j = row(&g, cell);
                int to_i = i + step_x[face], to_j = j + step_y[face];
                int other = ilsai_grid_neighbour(&g, i, j, face);
                if (to_i < 0 || to_i == g.nx || to_j < 0 || to_j == g.ny) {
                    assert_int_equal(other, -1);
                    continue;
                }
                assert_true(column(&g, other) >= g.lo_x && row(&g, other) >= g.lo_y);
                double x = ilsai_grid_x(&g, to_i), y = ilsai_grid_y(&g, to_j);
                double x_found = ilsai_grid_x(&g, column(&g, other));
                double y_found = ilsai_grid_y(&g, row(&g, other));
                assert_true(g.mirror_x ? fabs(x_found) == fabs(x) : x_found == x);
                assert_true(g.mirror_y ? fabs(y_found) == fabs(y) : y_found == y);
            }
        }
    }
}

static int faces_between(const grid *g, int from, int to) {
    int count = 0;
    for (int face = 0; face < GRID_FACES; face++) {
        count += ilsai_grid_neighbour(g, column(g, from), row(g, from), face) == to;
    }
    return count;
}

/* As many faces lead from the images of one cell to those of another as back: what flows out of
 * the ones is what flows into the others. */
static void faces_are_shared(void **state) {
    (void)state;
    for (int n = 0; n < MESHES; n++) {
        grid g = nth_grid(n);
        int image[4];
        for (int a = 0; a < g.nx * g.ny; a++) {
            for (int b = 0; b < a; b++) {
                if (ilsai_grid_fold(&g, column(&g, a), row(&g, a)) != a ||
                    ilsai_grid_fold(&g, column(&g, b), row(&g, b)) != b) {
                    continue;
                }
                int images_a = ilsai_grid_images(&g, column(&g, a), row(&g, a), image);
                int images_b = ilsai_grid_images(&g, column(&g, b), row(&g, b), image);
                assert_int_equal(images_a * faces_between(&g, a, b),
                                 images_b * faces_between(&g, b, a));
            }
        }
    }
}

static void coordinates_are_odd_and_evenly_spaced(void **state) {
    (void)state;
    for (int nx = 3; nx < 60; nx++) {
        ilsa_mesh_def def = {nx, 3, 0.1, 0.7};
        grid g = ilsai_grid(&def, 0, 0);
        for (int i = 0; i < nx; i++) {
            assert_true(ilsai_grid_x(&g, i) == -ilsai_grid_x(&g, nx - 1 - i));
            assert_true(fabs(ilsai_grid_x(&g, i) - ilsai_grid_x(&g, 0) - i * 0.1) < 1e-14);
        }
        assert_true(ilsai_grid_y(&g, 0) == -0.7 && ilsai_grid_y(&g, 1) == 0);
    }
    ilsa_mesh_def flat = {3, 3, 2, 0.5}, tall = {3, 3, 0.25, 4};
    grid f = ilsai_grid(&flat, 0, 0), t = ilsai_grid(&tall, 0, 0);
    assert_true(ilsai_grid_h(&f) == 0.5 && ilsai_grid_h(&t) == 0.25);
}

static void assert_box(box b, int x0, int x1, int y0, int y1) {
    assert_true(b.x0 == x0 && b.x1 == x1 && b.y0 == y0 && b.y1 == y1);
}

static void box_holds_what_was_added(void **state) {
    (void)state;
    box b = {1000, -1, 1000, -1};
    assert_true(ilsai_box_columns(&b) == 0 && ilsai_box_rows(&b) == 0);
    ilsai_box_add(&b, 5, 7);
    assert_box(b, 5, 5, 7, 7);
    assert_true(ilsai_box_columns(&b) > 0 && ilsai_box_rows(&b) > 0);
    ilsai_box_add(&b, 3, 9);
    ilsai_box_add(&b, 4, 8);
    assert_box(b, 3, 5, 7, 9);
    ilsai_box_add(&b, 8, 2);
    assert_box(b, 3, 8, 2, 9);
    box flat = {2, 4, 3, 2}, thin = {2, 1, 3, 9};
    assert_true(ilsai_box_rows(&flat) == 0 && ilsai_box_columns(&thin) == 0);
}

static void box_widens_within_the_mesh(void **state) {
    (void)state;
    ilsa_mesh_def def = {20, 10, 1, 1};
    grid g = ilsai_grid(&def, 0, 0);
    box b = {8, 11, 4, 5};
    assert_box(ilsai_box_widen(&g, &b, 3, 2), 5, 14, 2, 7);
    assert_box(ilsai_box_widen(&g, &b, 0, 4), 8, 11, 0, 9);
    assert_box(ilsai_box_widen(&g, &b, 9, 0), 0, 19, 4, 5);
    assert_box(ilsai_box_widen(&g, &b, 8, 5), 0, 19, 0, 9);
    assert_box(b, 8, 11, 4, 5);
}

/* The representatives of a symmetric box stand for each of its cells once. */
static void folded_box_stands_for_the_box(void **state) {
    (void)state;
    for (int n = 0; n < MESHES; n++) {
        grid g = nth_grid(n);
        int image[4];
        for (int cut = 0; 2 * cut < g.nx && 2 * cut < g.ny; cut++) {
            box b = {cut, g.nx - 1 - cut, cut, g.ny - 1 - cut};
            box part = ilsai_box_fold(&g, &b);
            int cells = 0;
            for (int j = part.y0; j <= part.y1; j++) {
                for (int i = part.x0; i <= part.x1; i++) {
                    assert_int_equal(ilsai_grid_fold(&g, i, j), ilsai_grid_cell(&g, i, j));
                    cells += ilsai_grid_images(&g, i, j, image);
                }
            }
            assert_int_equal(cells, (b.x1 - b.x0 + 1) * (b.y1 - b.y0 + 1));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fold_finds_the_cell_on_the_positive_side),
        cmocka_unit_test(without_mirror_nothing_is_folded),
        cmocka_unit_test(images_partition_the_mesh),
        cmocka_unit_test(images_are_mirrored_points),
        cmocka_unit_test(neighbours_are_one_cell_away),
        cmocka_unit_test(faces_are_shared),
        cmocka_unit_test(coordinates_are_odd_and_evenly_spaced),
        cmocka_unit_test(box_holds_what_was_added),
        cmocka_unit_test(box_widens_within_the_mesh),
        cmocka_unit_test(folded_box_stands_for_the_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
