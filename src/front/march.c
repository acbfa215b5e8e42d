#include "front/march.h"

#include "base/error.h"
#include "base/memory.h"
#include <ilsa/solver.h>
#include <math.h>

/* Components of a normal up to which the front runs along the axis: rounding must not decide. */
#define FRONT_ALONG 1e-9
/* And weights that differ by no more than so, in parts, are the same. */
#define FRONT_ALIKE 1e-9

/* A cell's value as seen by its neighbours while the march goes on. */
typedef struct node {
    double T, V, K_num, K_den, curvature;
    front_parents from;
    double cos_a, sin_a;
    int cell;
    int place; /* in the heap, -1 when accepted */
} node;

struct march {
    node *nodes; /* survey_cells first, then every cell touched */
    int *heap;   /* node numbers, smallest T first */
    front_cell *cells;
    int *node_of; /* per cell of the region: node number or -1 */
    int node_count;
    size_t node_capacity;
    int heap_count, cell_count;
    size_t region_capacity;
    box region;
};

march *ilsai_march_create(void) {
    return ilsai_allocate_zeroed(1, sizeof(march));
}

void ilsai_march_destroy(march **f) {
    if (*f) {
        ilsai_release((*f)->nodes);
        ilsai_release((*f)->heap);
        ilsai_release((*f)->cells);
        ilsai_release((*f)->node_of);
        ilsai_release(*f);
        *f = NULL;
    }
}

const front_cell *ilsai_march_cells(const march *f, int *count) {
    *count = f->cell_count;
    return f->cells;
}

static ilsa_status reserve_nodes(march *f, int count) {
    const grown_array arrays[] = {ILSAI_GROWN(f->nodes), ILSAI_GROWN(f->heap),
                                  ILSAI_GROWN(f->cells)};
    return ilsai_grow((size_t)count, &f->node_capacity, arrays, 3);
}

static ilsa_status set_region(march *f, const box *region) {
    size_t size = ilsai_box_columns(region) * ilsai_box_rows(region);
    const grown_array arrays[] = {ILSAI_GROWN(f->node_of)};
    ILSAI_TRY(ilsai_grow(size, &f->region_capacity, arrays, 1));
    for (size_t k = 0; k < size; k++) {
        f->node_of[k] = -1;
    }
    f->region = *region;
    f->node_count = f->heap_count = f->cell_count = 0;
    return ILSA_OK;
}

static int *node_place(const march *f, const grid *g, int cell) {
    int i = cell % g->nx, j = cell / g->nx;
    const box *r = &f->region;
    if (i < r->x0 || i > r->x1 || j < r->y0 || j > r->y1) {
        return NULL;
    }
    return &f->node_of[(j - r->y0) * (r->x1 - r->x0 + 1) + (i - r->x0)];
}

static void place(march *f, int at, int number) {
    f->heap[at] = number;
    f->nodes[number].place = at;
}

/* Order of the march; equal distances go by cell so that the order never depends on the heap. */
static int before(const march *f, int a, int b) {
    const node *p = &f->nodes[a], *q = &f->nodes[b];
    return p->T < q->T || (p->T == q->T && p->cell < q->cell);
}

static void sift_up(march *f, int at) {
    int number = f->heap[at];
    while (at > 0 && before(f, number, f->heap[(at - 1) / 2])) {
        place(f, at, f->heap[(at - 1) / 2]);
        at = (at - 1) / 2;
    }
    place(f, at, number);
}

static void sift_down(march *f, int at) {
    int number = f->heap[at];
    for (;;) {
        int child = 2 * at + 1;
        if (child >= f->heap_count) {
            break;
        }
        if (child + 1 < f->heap_count && before(f, f->heap[child + 1], f->heap[child])) {
            child++;
        }
        if (!before(f, f->heap[child], number)) {
            break;
        }
        place(f, at, f->heap[child]);
        at = child;
    }
    place(f, at, number);
}

static int pop(march *f) {
    int number = f->heap[0];
    f->nodes[number].place = -1;
    f->heap_count--;
    if (f->heap_count > 0) {
        f->heap[0] = f->heap[f->heap_count];
        sift_down(f, 0);
    }
    return number;
}

/* The accepted neighbour with the smaller T on one axis; NULL if neither is accepted. */
static const node *upwind(const march *f, const grid *g, int i, int j, int face_a, int face_b) {
    const node *best = NULL;
    const int faces[2] = {face_a, face_b};
    for (int k = 0; k < 2; k++) {
        int cell = ilsai_grid_neighbour(g, i, j, faces[k]);
        const int *number = cell >= 0 ? node_place(f, g, cell) : NULL;
        if (number && *number >= 0 && f->nodes[*number].place < 0) {
            const node *candidate = &f->nodes[*number];
            best = !best || candidate->T < best->T ? candidate : best;
        }
    }
    return best;
}

static void one_sided(node *n, const node *from, double h, int along_x) {
    n->T = from->T + h;
    n->V = from->V;
    n->K_num = from->K_num;
    n->K_den = from->K_den;
    n->curvature = from->curvature;
    n->from = from->from;
    n->cos_a = along_x ? 1 : 0;
    n->sin_a = along_x ? 0 : 1;
}

/*
 * The level of unit slope through two neighbours' levels a and b, (4.12), and its normal. Returns
 * 0 where the front does not come from between them.
 */
static int plane(node *n, double a, double b, double dx, double dy) {
    double diagonal = sqrt(dx * dx + dy * dy), difference = (b - a) / diagonal;
    double root = 1 - difference * difference;
    if (root < 0) {
        return 0;
    }
    double wx = dy * dy / (diagonal * diagonal), wy = dx * dx / (diagonal * diagonal);
    n->T = wx * a + wy * b + dx * dy * sqrt(root) / diagonal;
    n->cos_a = (n->T - a) / dx;
    n->sin_a = (n->T - b) / dy;
    return n->cos_a > FRONT_ALONG && n->sin_a > FRONT_ALONG;
}

/*
 * The same for a level that curves with the front: its second derivatives along the axes are
 * kappa sin^2 a and kappa cos^2 a, kappa the curvature where the cell is. The neighbours' levels
 * less half of these times dx^2 and dy^2 lie on the tangent plane of the cell.
 */
static void bend(node *n, const node *a, const node *b, double dx, double dy) {
    double kappa = n->curvature / fmax(1 + n->curvature * n->T, 0.5);
    for (int k = 0; k < 2; k++) {
        node bent = *n;
        double x = 0.5 * dx * dx * kappa * n->sin_a * n->sin_a;
        double y = 0.5 * dy * dy * kappa * n->cos_a * n->cos_a;
        if (!plane(&bent, a->T - x, b->T - y, dx, dy) || bent.T < fmax(a->T, b->T)) {
            return;
        }
        *n = bent;
    }
}

/*
 * Leaves out the least of count weights, and those that are as small but for rounding: a front that
 * mirrors itself has such, and keeps its mirror. Returns how many are left.
 */
static int drop_least(int count, int *survey, double *weight) {
    double least = INFINITY;
    int kept = 0;
    for (int k = 0; k < count; k++) {
        least = fmin(least, weight[k]);
    }
    for (int k = 0; k < count; k++) {
        if (weight[k] > (1 + FRONT_ALIKE) * least) {
            survey[kept] = survey[k];
            weight[kept++] = weight[k];
        }
    }
    return kept > 0 ? kept : count - 1;
}

/* Joins the parents of b to those of a, with weights; the least are dropped when there are more. */
static front_parents join(const front_parents *a, double weight_a, const front_parents *b,
                          double weight_b) {
    int count = 0, survey[2 * FRONT_PARENTS];
    double weight[2 * FRONT_PARENTS], sum = 0;
    for (int k = 0; k < a->count; k++, count++) {
        survey[count] = a->survey[k];
        weight[count] = weight_a * a->weight[k];
    }
    for (int k = 0; k < b->count; k++) {
        int at = 0;
        while (at < count && survey[at] != b->survey[k]) {
            at++;
        }
        survey[at] = b->survey[k];
        weight[at] = (at < count ? weight[at] : 0) + weight_b * b->weight[k];
        count += at == count;
    }
    while (count > FRONT_PARENTS) {
        count = drop_least(count, survey, weight);
    }
    front_parents joined = {.count = count};
    for (int k = 0; k < count; k++) {
        sum += weight[k];
    }
    for (int k = 0; k < count; k++) {
        joined.survey[k] = survey[k];
        joined.weight[k] = weight[k] / sum;
    }
    return joined;
}

/*
 * The march from two neighbours. The velocity is the derivative of (4.12), so the neighbours weigh
 * by cos a / dx and sin a / dy.
 */
static int two_sided(node *n, const node *a, const node *b, double dx, double dy) {
    if (!plane(n, a->T, b->T, dx, dy)) {
        return 0;
    }
    double wa = n->cos_a / dx, wb = n->sin_a / dy, slope = wa + wb;
    n->V = (wa * a->V + wb * b->V) / slope;
    n->K_num = a->K_num + b->K_num;
    n->K_den = a->K_den + b->K_den;
    n->curvature = (wa * a->curvature + wb * b->curvature) / slope;
    n->from = join(&a->from, wa, &b->from, wb);
    if (n->curvature != 0) {
        bend(n, a, b, dx, dy);
    }
    return 1;
}

static void update(const march *f, const grid *g, node *n) {
    int i = n->cell % g->nx, j = n->cell / g->nx;
    const node *a = upwind(f, g, i, j, GRID_LEFT, GRID_RIGHT);
    const node *b = upwind(f, g, i, j, GRID_DOWN, GRID_UP);
    if (a && b && two_sided(n, a, b, g->dx, g->dy)) {
        return;
    }
    if (a && (!b || a->T + g->dx <= b->T + g->dy)) {
        one_sided(n, a, g->dx, 1);
    } else {
        one_sided(n, b, g->dy, 0);
    }
}

static ilsa_status add_seed(march *f, const grid *g, const survey_cell *survey_cells, int k) {
    const survey_cell *survey = &survey_cells[k];
    int *number = node_place(f, g, survey->cell);
    if (!number) {
        return ILSA_OK;
    }
    if (reserve_nodes(f, f->node_count + 1) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    node n = {
        .T = -survey->s, .V = survey->V, .K_den = survey->s, .cell = survey->cell, .place = -1};
    n.K_num = survey->w * sqrt(fabs(survey->s));
    n.curvature = survey->curvature;
    n.from = (front_parents){.count = 1, .survey = {k}, .weight = {1}};
    *number = f->node_count;
    f->nodes[f->node_count++] = n;
    return ILSA_OK;
}

/* Takes cell (i, j)'s neighbour across a face into the heap, or improves it there. */
static ilsa_status touch(march *f, const grid *g, const unsigned char *kind, int i, int j,
                         int face) {
    int cell = ilsai_grid_neighbour(g, i, j, face);
    int *number = cell >= 0 ? node_place(f, g, cell) : NULL;
    if (!number || kind[cell] >= ILSA_CELL_SURVEY) {
        return ILSA_OK;
    }
    if (*number < 0) {
        if (reserve_nodes(f, f->node_count + 1) != ILSA_OK) {
            return ILSA_ERR_MEMORY;
        }
        *number = f->node_count++;
        f->nodes[*number] = (node){.T = INFINITY, .cell = cell, .place = f->heap_count};
        f->heap[f->heap_count++] = *number;
    }
    node *n = &f->nodes[*number];
    if (n->place >= 0) {
        update(f, g, n);
        sift_up(f, n->place);
        sift_down(f, n->place);
    }
    return ILSA_OK;
}

static ilsa_status touch_all(march *f, const grid *g, const unsigned char *kind, int cell) {
    for (int face = 0; face < GRID_FACES; face++) {
        ilsa_status status = touch(f, g, kind, cell % g->nx, cell / g->nx, face);
        if (status != ILSA_OK) {
            return status;
        }
    }
    return ILSA_OK;
}

static void accept(march *f, const grid *g, const node *n, double *level) {
    front_cell c = {.cell = n->cell, .T = n->T, .cos_a = n->cos_a, .sin_a = n->sin_a};
    c.ell = 0.5 * ilsai_march_full(g, n->cos_a, n->sin_a) - n->T;
    c.V = n->V;
    c.from = n->from;
    c.K_num = n->K_num;
    c.K_den = n->K_den;
    f->cells[f->cell_count++] = c;
    level[n->cell] = n->T;
}

static void clear_level(const grid *g, const box *region, const unsigned char *kind,
                        double *level) {
    for (int j = region->y0; j <= region->y1; j++) {
        for (int i = region->x0; i <= region->x1; i++) {
            int cell = ilsai_grid_cell(g, i, j);
            if (kind[cell] < ILSA_CELL_SURVEY) {
                level[cell] = INFINITY;
            }
        }
    }
}

ilsa_status ilsai_march_run(march *f, const grid *g, const box *region, const unsigned char *kind,
                            const survey_cell *survey_cells, int survey_count, double limit,
                            double *level) {
    ilsa_status status = set_region(f, region);
    clear_level(g, region, kind, level);
    for (int k = 0; k < survey_count && status == ILSA_OK; k++) {
        status = add_seed(f, g, survey_cells, k);
        level[survey_cells[k].cell] = -survey_cells[k].s;
    }
    for (int k = 0; k < survey_count && status == ILSA_OK; k++) {
        const int *number = node_place(f, g, survey_cells[k].cell);
        status = number ? touch_all(f, g, kind, survey_cells[k].cell) : ILSA_OK;
    }
    while (status == ILSA_OK && f->heap_count > 0) {
        node n = f->nodes[pop(f)];
        if (n.T > limit) {
            break;
        }
        accept(f, g, &n, level);
        status = touch_all(f, g, kind, n.cell);
    }
    return status;
}
