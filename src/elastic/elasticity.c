#include "elastic/elasticity.h"

#include "base/error.h"
#include "base/memory.h"
#include "elastic/convolution.h"
#include "elastic/dd_kernel.h"
#include <math.h>
#include <stdlib.h>

/*
 * What depends on the size of the box. It is made anew only when the size, rounded up, changes. The
 * entries of C are tabulated by the offset of two cells, of which one may be an image.
 */
typedef struct engine {
    int cx, cy; /* the largest box */
    mirror_axis about_x, about_y;
    size_t row;        /* length of a row of the table */
    double *table;     /* C of offset (i, j) at j * row + i */
    void *convolution; /* by the method of the elasticity */
} engine;

/* A medium without boundaries or layers, where C depends on offsets alone. */
typedef struct homogeneous {
    elasticity base;
    double E_prime, dx, dy, self_entry;
    const convolution_method *method;
    int bx, by; /* the box in use */
    engine engine;
    self_term_table self_terms; /* made when first asked for */
} homogeneous;

/*
 * The smallest of 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, ... that is not below b. Transforms of
 * these lengths are fast, sizes between gain little or lose, and plans serve for several cells of
 * growth.
 */
static int round_up(int b) {
    int unit = 2;
    while (7 * unit < b) {
        unit *= 2;
    }
    int c = 4;
    while (c * unit < b) {
        c++;
    }
    return c * unit;
}

static double *make_table(const homogeneous *h, size_t columns, size_t rows) {
    double *table = ilsai_allocate(columns * rows, sizeof *table);
    for (size_t j = 0; table && j < rows; j++) {
        for (size_t i = 0; i < columns; i++) {
            table[j * columns + i] = h->E_prime * ilsai_dd_kernel((long)i, (long)j, h->dx, h->dy);
        }
    }
    return table;
}

static void engine_destroy(const homogeneous *h, engine *n) {
    if (n->convolution) {
        h->method->destroy(n->convolution);
    }
    ilsai_release(n->table);
    *n = (engine){0};
}

/* Fills *n, whose cx, cy, about_x and about_y are set. */
static ilsa_status engine_create(const homogeneous *h, engine *n) {
    n->row = (size_t)ilsai_mirror_offsets(n->about_x, n->cx);
    n->table = make_table(h, n->row, (size_t)ilsai_mirror_offsets(n->about_y, n->cy));
    if (n->table) {
        n->convolution = h->method->create(n->cx, n->cy, n->about_x, n->about_y, n->table);
    }
    if (!n->convolution) {
        engine_destroy(h, n);
        return ILSA_ERR_MEMORY;
    }
    return ILSA_OK;
}

static ilsa_status set_box(elasticity *e, const box *b, mirror_axis about_x, mirror_axis about_y) {
    homogeneous *h = (homogeneous *)e;
    const engine *now = &h->engine;
    int bx = (int)ilsai_box_columns(b), by = (int)ilsai_box_rows(b);
    engine made = {.cx = round_up(bx), .cy = round_up(by), .about_x = about_x, .about_y = about_y};
    if (now->cx != made.cx || now->cy != made.cy || now->about_x != about_x ||
        now->about_y != about_y) {
        ILSAI_TRY(engine_create(h, &made));
        engine_destroy(h, &h->engine);
        h->engine = made;
    }
    h->bx = bx;
    h->by = by;
    return ILSA_OK;
}

static void multiply(elasticity *e, const double *w, double *p, size_t stride) {
    const homogeneous *h = (const homogeneous *)e;
    h->method->apply(h->engine.convolution, e->threads, h->bx, h->by, w, p, stride);
}

static double entry(const elasticity *e, int i, int j, int k, int l) {
    const engine *n = &((const homogeneous *)e)->engine;
    return n->table[(size_t)abs(j - l) * n->row + (size_t)abs(i - k)];
}

static double self_entry(const elasticity *e, int i, int j) {
    (void)i;
    (void)j;
    return ((const homogeneous *)e)->self_entry;
}

static void make_self_terms(elasticity *e) {
    homogeneous *h = (homogeneous *)e;
    if (h->self_terms.dx == 0) {
        ilsai_self_term_table(&h->self_terms, h->dx, h->dy);
    }
}

static self_term self_term_at(const elasticity *e, int i, int j, const self_term_front *front) {
    const homogeneous *h = (const homogeneous *)e;
    self_term part = ilsai_self_term_lookup(&h->self_terms, front);
    (void)i;
    (void)j;
    return (self_term){h->self_entry * part.value, h->self_entry * part.slope};
}

static void destroy(elasticity *e) {
    homogeneous *h = (homogeneous *)e;
    engine_destroy(h, &h->engine);
    ilsai_release(h);
}

static const elastic_kernel homogeneous_kernel = {
    "homogeneous", set_box, multiply, entry, self_entry, make_self_terms, self_term_at, destroy};

bool ilsai_elasticity_has_fft(void) {
    return ilsai_convolution_fft != NULL;
}

ilsa_status ilsai_elasticity_create(double E_prime, double dx, double dy, ilsa_product method,
                                    elasticity **e) {
    *e = NULL;
    if (method == ILSA_PRODUCT_FFT && !ilsai_convolution_fft) {
        return ILSA_ERR_MISMATCH;
    }
    homogeneous *made = ilsai_allocate_zeroed(1, sizeof *made);
    if (!made) {
        return ILSA_ERR_MEMORY;
    }
    bool use_fft = method != ILSA_PRODUCT_BLAS && ilsai_convolution_fft;
    made->base.kernel = &homogeneous_kernel;
    made->base.product = use_fft ? ILSA_PRODUCT_FFT : ILSA_PRODUCT_BLAS;
    made->method = use_fft ? ilsai_convolution_fft : ilsai_convolution_blas;
    made->E_prime = E_prime;
    made->dx = dx;
    made->dy = dy;
    made->self_entry = E_prime * ilsai_dd_kernel(0, 0, dx, dy);
    *e = &made->base;
    return ILSA_OK;
}

void ilsai_elasticity_destroy(elasticity **e) {
    if (*e) {
        (*e)->kernel->destroy(*e);
        *e = NULL;
    }
}
