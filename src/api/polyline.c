/* The front as closed polylines: marching squares on the level at the cell centres. */
#include "base/memory.h"
#include "model/mesh.h"
#include "step/solver.h"
#include "tip/asymptote.h"

#include <math.h>

/*
 * A square has its corners at four cell centres. An edge of the squares is named by the cell at
 * its lower left end and its direction, 2 cell + (0 along x, 1 along y); the front crosses an edge
 * whose ends have different signs.
 */
typedef struct tracer {
    const ilsa_solver *s;
    box squares;       /* lower left corners */
    unsigned char *on; /* per edge in the box: crossed and not yet walked */
    ilsa_front_point *points;
    size_t count, capacity;
} tracer;

static double level_at(const tracer *t, int i, int j) {
    return t->s->fracture.cells.level[j * t->s->model.mesh.nx + i];
}

static bool inside(const tracer *t, int i, int j) {
    return level_at(t, i, j) <= 0;
}

static unsigned char *edge_flag(const tracer *t, int i, int j, int along_y) {
    size_t row = ilsai_box_columns(&t->squares) + 1;
    size_t at = (size_t)(j - t->squares.y0) * row + (size_t)(i - t->squares.x0);
    return &t->on[2 * at + (size_t)along_y];
}

/* Marks the crossed edges. */
static void mark(tracer *t) {
    for (int j = t->squares.y0; j <= t->squares.y1 + 1; j++) {
        for (int i = t->squares.x0; i <= t->squares.x1 + 1; i++) {
            if (i <= t->squares.x1) {
                *edge_flag(t, i, j, 0) = inside(t, i, j) != inside(t, i + 1, j);
            }
            if (j <= t->squares.y1) {
                *edge_flag(t, i, j, 1) = inside(t, i, j) != inside(t, i, j + 1);
            }
        }
    }
}

/* The survey cell nearest to a point, among the cells around (i, j). */
static int nearest_survey(const ilsa_solver *s, int i, int j, double x, double y) {
    int best = -1, reach = 3;
    double least = INFINITY;
    for (int b = j - reach; b <= j + reach; b++) {
        for (int a = i - reach; a <= i + reach; a++) {
            if (a < 0 || a >= s->model.mesh.nx || b < 0 || b >= s->model.mesh.ny ||
                s->fracture.cells.kind[b * s->model.mesh.nx + a] != ILSA_CELL_SURVEY) {
                continue;
            }
            double d =
                hypot(ilsai_mesh_x(&s->model.mesh, a) - x, ilsai_mesh_y(&s->model.mesh, b) - y);
            if (d < least) {
                least = d;
                best = b * s->model.mesh.nx + a;
            }
        }
    }
    return best;
}

/*
 * The place in the triangle of the full asymptote at the cell's distance and velocity. The width of
 * the cell itself is a mean, and holds what is no part of the asymptote.
 */
static ilsa_tip_regime regime_at(const ilsa_solver *s, int cell) {
    ilsa_tip_regime regime = {.N_k = 1, .x = 1};
    if (cell >= 0) {
        double distance = -s->fracture.cells.level[cell], V = s->fracture.cells.speed[cell];
        double w = ilsai_asymptote_width(&s->model.material, V, distance);
        ilsa_tip_triangle(&s->model.material, V, distance, w, &regime);
    }
    return regime;
}

/* The point of the front on an edge. */
static ilsa_front_point point_on(const tracer *t, int i, int j, int along_y, int loop) {
    const ilsa_solver *s = t->s;
    int i1 = i + !along_y, j1 = j + along_y, nx = s->model.mesh.nx;
    double a = level_at(t, i, j), b = level_at(t, i1, j1);
    double f = isinf(a)   ? 1 + b / (along_y ? s->model.mesh.dy : s->model.mesh.dx)
               : isinf(b) ? -a / (along_y ? s->model.mesh.dy : s->model.mesh.dx)
                          : a / (a - b);
    f = f < 0 ? 0 : f > 1 ? 1 : f;
    ilsa_front_point p = {.loop = loop};
    p.x = ilsai_mesh_x(&s->model.mesh, i) + (along_y ? 0 : f * s->model.mesh.dx);
    p.y = ilsai_mesh_y(&s->model.mesh, j) + (along_y ? f * s->model.mesh.dy : 0);
    double Va = s->fracture.cells.speed[j * nx + i], Vb = s->fracture.cells.speed[j1 * nx + i1];
    p.V = (1 - f) * Va + f * Vb;
    p.regime = regime_at(s, nearest_survey(s, i, j, p.x, p.y));
    return p;
}

static ilsa_status append(tracer *t, ilsa_front_point p) {
    const grown_array arrays[] = {ILSAI_GROWN(t->points)};
    ILSAI_TRY(ilsai_grow(t->count + 1, &t->capacity, arrays, 1));
    t->points[t->count++] = p;
    return ILSA_OK;
}

/* An edge of square (i, j): 0 bottom, 1 right, 2 top, 3 left. */
static unsigned char *side_flag(const tracer *t, int i, int j, int side) {
    return side == 0   ? edge_flag(t, i, j, 0)
           : side == 1 ? edge_flag(t, i + 1, j, 1)
           : side == 2 ? edge_flag(t, i, j + 1, 0)
                       : edge_flag(t, i, j, 1);
}

/*
 * The side by which a walk with the fluid on its left leaves a square. Entering by a side, the
 * sides are tried from the one on the left hand on, which keeps fluid that touches at a corner
 * apart.
 */
static int exit_side(const tracer *t, int i, int j, int entry) {
    static const int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int turn = 3; turn > 0; turn--) {
        int side = (entry + turn) % 4;
        const int *from = corner[side], *to = corner[(side + 1) % 4];
        if (!inside(t, i + from[0], j + from[1]) && inside(t, i + to[0], j + to[1])) {
            return side;
        }
    }
    return -1;
}

/* Walks one loop from the square above (or right of) a crossed edge; 0 fluid on the left. */
static ilsa_status walk(tracer *t, int i, int j, int entry, int loop) {
    static const int step[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    while (*side_flag(t, i, j, entry)) {
        unsigned char *flag = side_flag(t, i, j, entry);
        int along_y = entry % 2, ei = i + (entry == 1), ej = j + (entry == 2);
        *flag = 0;
        ILSAI_TRY(append(t, point_on(t, ei, ej, along_y, loop)));
        int side = exit_side(t, i, j, entry);
        if (side < 0) {
            break;
        }
        i += step[side][0];
        j += step[side][1];
        entry = (side + 2) % 4;
    }
    return ILSA_OK;
}

/*
 * Loops start on edges along x, entered from below with the fluid on the left: inside on the left
 * end, outside on the right one. Every closed curve has such an edge.
 */
static ilsa_status trace(tracer *t) {
    int loop = 0;
    for (int j = t->squares.y0; j <= t->squares.y1; j++) {
        for (int i = t->squares.x0; i <= t->squares.x1; i++) {
            if (*edge_flag(t, i, j, 0) && inside(t, i, j)) {
                ILSAI_TRY(walk(t, i, j, 0, loop++));
            }
        }
    }
    return ILSA_OK;
}

static size_t loop_length(const ilsa_front_point *points, size_t count, size_t first) {
    size_t end = first;
    while (end < count && points[end].loop == points[first].loop) {
        end++;
    }
    return end - first;
}

static void reverse(ilsa_front_point *points, size_t count) {
    for (size_t k = 0; k < count / 2; k++) {
        ilsa_front_point p = points[k];
        points[k] = points[count - 1 - k];
        points[count - 1 - k] = p;
    }
}

/* Brings the longest loop to the front, by rotating the array, and numbers the loops anew. */
static void longest_first(ilsa_front_point *points, size_t count) {
    size_t best = 0, length = 0;
    for (size_t first = 0; first < count;) {
        size_t n = loop_length(points, count, first);
        best = n > length ? first : best;
        length = n > length ? n : length;
        first += n;
    }
    reverse(points, best);
    reverse(points + best, length);
    reverse(points, best + length);
    int loop = -1, last = -1;
    for (size_t k = 0; k < count; k++) {
        loop += points[k].loop != last;
        last = points[k].loop;
        points[k].loop = loop;
    }
}

/* The checks of the two calls that hand out a list. */
static ilsa_status check_list(ilsa_solver *s, const void *points, const size_t *count) {
    error_text *error = s ? &s->error : ilsai_thread_error();
    if (!s || !points || !count) {
        return ilsai_check_pointer(error, !s ? "solver" : !points ? "points" : "count", NULL);
    }
    return ilsai_fracture_check(&s->fracture, error);
}

ilsa_status ilsa_get_front(ilsa_solver *solver, const ilsa_front_point **points, size_t *count) {
    ILSAI_TRY(check_list(solver, points, count));
    const box *b = &solver->fracture.footprint;
    tracer t = {.s = solver,
                .squares = {b->x0 - 1, b->x1, b->y0 - 1, b->y1},
                .points = solver->handed_out.front,
                .capacity = solver->handed_out.front_capacity};
    size_t edges = 2 * (size_t)(b->x1 - b->x0 + 3) * (size_t)(b->y1 - b->y0 + 3);
    t.on = ilsai_allocate_zeroed(edges, 1);
    ilsa_status status = t.on ? ILSA_OK : ILSA_ERR_MEMORY;
    if (status == ILSA_OK) {
        mark(&t);
        status = trace(&t);
    }
    ilsai_release(t.on);
    solver->handed_out.front = t.points;
    solver->handed_out.front_capacity = t.capacity;
    if (status != ILSA_OK) {
        return ilsai_fail(&solver->error, status, "no memory for the front");
    }
    longest_first(t.points, t.count);
    *points = t.points;
    *count = t.count;
    return ILSA_OK;
}

static ilsa_survey_point survey_point(const ilsa_solver *s, int i, int j) {
    int cell = j * s->model.mesh.nx + i;
    ilsa_survey_point p = {.cell = cell,
                           .x = ilsai_mesh_x(&s->model.mesh, i),
                           .y = ilsai_mesh_y(&s->model.mesh, j),
                           .s = -s->fracture.cells.level[cell],
                           .w = s->fracture.cells.width[cell],
                           .V = s->fracture.cells.speed[cell]};
    p.regime = regime_at(s, cell);
    return p;
}

static size_t count_survey(const ilsa_solver *s) {
    const box *b = &s->fracture.footprint;
    size_t count = 0;
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            count += s->fracture.cells.kind[j * s->model.mesh.nx + i] == ILSA_CELL_SURVEY;
        }
    }
    return count;
}

ilsa_status ilsa_get_survey(ilsa_solver *solver, const ilsa_survey_point **points, size_t *count) {
    ILSAI_TRY(check_list(solver, points, count));
    handed_out *out = &solver->handed_out;
    size_t total = count_survey(solver), filled = 0;
    const grown_array arrays[] = {ILSAI_GROWN(out->survey)};
    if (ilsai_grow(total, &out->survey_capacity, arrays, 1) != ILSA_OK) {
        return ilsai_fail(&solver->error, ILSA_ERR_MEMORY, "no memory for the survey cells");
    }
    const box *b = &solver->fracture.footprint;
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            if (solver->fracture.cells.kind[j * solver->model.mesh.nx + i] == ILSA_CELL_SURVEY) {
                out->survey[filled++] = survey_point(solver, i, j);
            }
        }
    }
    *points = out->survey;
    *count = total;
    return ILSA_OK;
}
