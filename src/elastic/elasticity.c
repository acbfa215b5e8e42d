#include "elastic/elasticity.h"
#include "elastic/convolution.h"
#include "elastic/convolution_blas.h"

#include "base/error.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* The kernel */

/*
 * (4.6) at (x, y), x >= y >= 0 up to rounding, x > 0, of cells 1 by r around the origin. The four
 * corner terms (X^2 + Y^2)^(1/2) / (X Y) cancel far away; here their difference is taken by hand,
 * so that all that is left to add has one sign. a[s][t] = (1 + Y_s^2 / X_t^2)^(1/2).
 */
static double kernel_off_axis(double i, double j, double r) {
    double xl = i - 0.5, xu = i + 0.5, yl = (j - 0.5) * r, yu = (j + 0.5) * r;
    double ll = sqrt(1 + (yl / xl) * (yl / xl)), lu = sqrt(1 + (yl / xu) * (yl / xu));
    double ul = sqrt(1 + (yu / xl) * (yu / xl)), uu = sqrt(1 + (yu / xu) * (yu / xu));
    double area = xl * xu;
    double front = (2 * i / area) * (2 * j * r * r / area);
    double above = yu / (uu + ul) + yl / (lu + ll);
    double below = (yl * uu + yu * lu) * (yl * ul + yu * ll);
    return -front * above / below / (8 * pi);
}

/* The same at (i, 0), i >= 1, where the corners lie at y = -+ r / 2. */
static double kernel_on_axis(double i, double r) {
    double xl = i - 0.5, xu = i + 0.5, b = 0.5 * r;
    double area = xl * xu;
    double roots = sqrt(1 + (b / xu) * (b / xu)) + sqrt(1 + (b / xl) * (b / xl));
    return -(4 * b / area) * (i / area) / roots / (8 * pi);
}

/*
 * In units of dx, so that nothing overflows, and mirrored about the diagonal where y > x, so that
 * swapping the axes of cell and offset gives the same bits.
 */
double ilsai_kernel(long i, long j, double dx, double dy) {
    double m = fabs((double)i), n = fabs((double)j);
    if (m * dx < n * dy || (m * dx == n * dy && dx < dy)) {
        double swap = m;
        m = n;
        n = swap;
        swap = dx;
        dx = dy;
        dy = swap;
    }
    double r = dy / dx;
    if (m == 0) {
        return sqrt(1 + r * r) / (pi * r) / dx;
    }
    return (n == 0 ? kernel_on_axis(m, r) : kernel_off_axis(m, n, r)) / dx;
}

/* The product */

/* What a box needs; made anew only when the capacity changes. One of the transforms is there. */
typedef struct engine {
    int cx, cy; /* largest box */
    mirror_axis about_x, about_y;
    size_t row;    /* of the table */
    double *table; /* C(i, j) at j * row + i */
    fft *by_fft;
    dft *by_blas;
} engine;

struct elasticity {
    double E_prime, dx, dy;
    int use_fft;
    int bx, by;           /* the box in use */
    self_term_table edge; /* made when first asked for */
    engine engine;
    thread_pool *threads; /* that share a product, or NULL */
};

/*
 * The smallest of 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, ... that is not below b. Transforms of
 * these lengths are fast, sizes between gain little or lose, and plans serve for several cells of
 * growth.
 */
static int capacity(int b) {
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

static double *make_table(const elasticity *e, size_t columns, size_t rows) {
    double *table = ilsai_allocate(columns * rows, sizeof *table);
    if (!table) {
        return NULL;
    }
    for (size_t j = 0; j < rows; j++) {
        for (size_t i = 0; i < columns; i++) {
            table[j * columns + i] = e->E_prime * ilsai_kernel((long)i, (long)j, e->dx, e->dy);
        }
    }
    return table;
}

static void engine_destroy(engine *n) {
    ilsai_fft_destroy(&n->by_fft);
    ilsai_dft_destroy(&n->by_blas);
    ilsai_release(n->table);
    *n = (engine){0};
}

/* Of a size and kind: cx, cy, about_x, about_y of *n. */
static ilsa_status engine_create(const elasticity *e, engine *n) {
    n->row = (size_t)ilsai_mirror_offsets(n->about_x, n->cx);
    n->table = make_table(e, n->row, (size_t)ilsai_mirror_offsets(n->about_y, n->cy));
    if (n->table && e->use_fft) {
        n->by_fft = ilsai_fft_create(n->cx, n->cy, n->about_x, n->about_y, n->table);
    } else if (n->table) {
        n->by_blas = ilsai_dft_create(n->cx, n->cy, n->about_x, n->about_y, n->table);
    }
    if (!n->by_fft && !n->by_blas) {
        engine_destroy(n);
        return ILSA_ERR_MEMORY;
    }
    return ILSA_OK;
}

static int serves(const engine *n, const engine *other) {
    return n->cx == other->cx && n->cy == other->cy && n->about_x == other->about_x &&
           n->about_y == other->about_y;
}

int ilsai_elasticity_has_fft(void) {
    return ilsai_fft_available();
}

ilsa_status ilsai_elasticity_create(double E_prime, double dx, double dy, ilsa_product method,
                                    elasticity **e) {
    *e = NULL;
    if (method == ILSA_PRODUCT_FFT && !ilsai_fft_available()) {
        return ILSA_ERR_MISMATCH;
    }
    elasticity *made = ilsai_allocate_zeroed(1, sizeof *made);
    if (!made) {
        return ILSA_ERR_MEMORY;
    }
    made->E_prime = E_prime;
    made->dx = dx;
    made->dy = dy;
    made->use_fft = method != ILSA_PRODUCT_BLAS && ilsai_fft_available();
    *e = made;
    return ILSA_OK;
}

void ilsai_elasticity_destroy(elasticity **e) {
    if (!*e) {
        return;
    }
    engine_destroy(&(*e)->engine);
    ilsai_release(*e);
    *e = NULL;
}

ilsa_status ilsai_elasticity_set_box(elasticity *e, int bx, int by, mirror_axis about_x,
                                     mirror_axis about_y) {
    engine made = {.cx = capacity(bx), .cy = capacity(by), .about_x = about_x, .about_y = about_y};
    if (!serves(&e->engine, &made)) {
        ILSAI_TRY(engine_create(e, &made));
        engine_destroy(&e->engine);
        e->engine = made;
    }
    e->bx = bx;
    e->by = by;
    return ILSA_OK;
}

ilsa_product ilsai_elasticity_method(const elasticity *e) {
    return e->use_fft ? ILSA_PRODUCT_FFT : ILSA_PRODUCT_BLAS;
}

void ilsai_elasticity_share(elasticity *e, thread_pool *threads) {
    e->threads = threads;
}

void ilsai_elasticity_make_self_terms(elasticity *e) {
    if (e->edge.dx == 0) {
        ilsai_self_term_table(&e->edge, e->dx, e->dy);
    }
}

self_term ilsai_elasticity_self_term(const elasticity *e, const self_term_front *front) {
    const double self = e->E_prime * ilsai_kernel(0, 0, e->dx, e->dy);
    self_term term = ilsai_self_term_lookup(&e->edge, front);
    return (self_term){self * term.value, self * term.slope};
}

double ilsai_elasticity_entry(const elasticity *e, int i, int j) {
    return e->engine.table[(size_t)abs(j) * e->engine.row + (size_t)abs(i)];
}

void ilsai_elasticity_multiply(elasticity *e, const double *w, double *p, size_t stride) {
    if (e->use_fft) {
        ilsai_fft_convolve(e->engine.by_fft, e->threads, e->bx, e->by, w, p, stride);
    } else {
        ilsai_dft_convolve(e->engine.by_blas, e->bx, e->by, w, p, stride);
    }
}
