#include "solve/near_field.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/tuning.h"
#include <math.h>
#include <string.h>

/* Steps of the iteration: one more takes the error down by 2.4 on square cells. */
#define NEARFIELD_STEPS 4
/* The most that extra adds to self, and the least of the spectrum that is aimed at. */
#define NEARFIELD_EXTRA 0.2
#define NEARFIELD_LEAST 0.1

enum { NEARFIELD_ARRAYS = 5 };

void ilsai_near_field_destroy(near_field *f) {
    ilsai_release(f->extra);
    memset(f, 0, sizeof *f);
}

ilsa_status ilsai_near_field_shape(near_field *f, int nx, int ny) {
    size_t size = ((size_t)nx + 2) * ((size_t)ny + 2);
    const grown_array pool = {&f->extra, NEARFIELD_ARRAYS * sizeof *f->extra};
    ILSAI_TRY(ilsai_grow(size, &f->capacity, &pool, 1));
    f->nx = nx;
    f->ny = ny;
    f->stride = nx + 2;
    f->open = f->extra + size;
    f->x = f->extra + 2 * size;
    f->y = f->extra + 3 * size;
    f->step = f->extra + 4 * size;
    memset(f->extra, 0, NEARFIELD_ARRAYS * size * sizeof *f->extra);
    return ILSA_OK;
}

/* The images of a folded scene, in the border. */
static void set_border(const near_field *f, double *v) {
    size_t stride = (size_t)f->stride;
    for (size_t j = 1; f->about_x != MIRROR_NONE && j <= (size_t)f->ny; j++) {
        v[j * stride] = v[j * stride + 1 + (f->about_x == MIRROR_CENTRE)];
    }
    if (f->about_y != MIRROR_NONE) {
        memcpy(v, v + (1 + (size_t)(f->about_y == MIRROR_CENTRE)) * stride, stride * sizeof *v);
    }
}

static void share_rows(const near_field *f, pool_function *function, void *context) {
    ilsai_thread_pool_run(f->threads, function, context, f->ny, 1 + ILSAI_SHARE_CELLS / f->nx);
}

static size_t row(const near_field *f, int j) {
    return ((size_t)j + 1) * (size_t)f->stride + 1;
}

static void subtract_rows(void *context, int first, int end) {
    const near_field *f = context;
    for (int j = first; j < end; j++) {
        size_t at = row(f, j), stride = (size_t)f->stride;
        const double *s = f->step + at, *below = s - stride, *above = s + stride;
        const double *extra = f->extra + at, *open = f->open + at;
        double *y = f->y + at;
        for (int i = 0; i < f->nx; i++) {
            double sum = (f->self + extra[i]) * s[i] + f->beside * (s[i - 1] + s[i + 1]) +
                         f->above * (below[i] + above[i]) +
                         f->corner * (below[i - 1] + below[i + 1] + above[i - 1] + above[i + 1]);
            y[i] -= open[i] * sum;
        }
    }
}

/* y -= C step in the open cells. */
static void subtract_product(near_field *f) {
    set_border(f, f->step);
    share_rows(f, subtract_rows, f);
}

/* A step of the iteration. */
typedef struct move {
    near_field *f;
    double a, b;
} move;

/* x = step = b y. */
static void begin_rows(void *context, int first, int end) {
    const move *m = context;
    for (int j = first; j < end; j++) {
        size_t at = row(m->f, j);
        double *s = m->f->step + at, *x = m->f->x + at;
        const double *y = m->f->y + at;
        for (int i = 0; i < m->f->nx; i++) {
            x[i] = s[i] = m->b * y[i];
        }
    }
}

/* step = a step + b y; x += step. */
static void advance_rows(void *context, int first, int end) {
    const move *m = context;
    for (int j = first; j < end; j++) {
        size_t at = row(m->f, j);
        double *s = m->f->step + at, *x = m->f->x + at;
        const double *y = m->f->y + at;
        for (int i = 0; i < m->f->nx; i++) {
            s[i] = m->a * s[i] + m->b * y[i];
            x[i] += s[i];
        }
    }
}

/* Least and largest value of the stencil's symbol, which bound its eigenvalues on any cells. */
static void bound_spectrum(const near_field *f, double *least, double *most) {
    double x = 2 * f->beside, y = 2 * f->above, xy = 4 * f->corner;
    double at_pi = fmax(fmax(y - x - xy, x - y - xy), xy - x - y);
    *most = (1 + NEARFIELD_EXTRA) * f->self + at_pi;
    *least = fmax(f->self + x + y + xy, NEARFIELD_LEAST * *most);
}

void ilsai_near_field_solve(near_field *f) {
    double least, most;
    bound_spectrum(f, &least, &most);
    double middle = 0.5 * (most + least), half = 0.5 * (most - least), ratio = middle / half;
    double rho = 1 / ratio;
    move first = {f, 0, 1 / middle};
    share_rows(f, begin_rows, &first);
    for (int k = 1; k < NEARFIELD_STEPS; k++) {
        subtract_product(f);
        double next = 1 / (2 * ratio - rho);
        move on = {f, next * rho, 2 * next / half};
        share_rows(f, advance_rows, &on);
        rho = next;
    }
}
