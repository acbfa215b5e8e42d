/*
 * Elasticity as the rest of the library sees it: the pressures p = C w that the widths of the
 * fracture's cells bring about, Dontsov and Peirce 2017, (4.5).
 *
 * An elasticity is made of a kernel, which is a table of functions. There is one kernel, that of a
 * homogeneous medium (dd_kernel.h), for which C depends on the offset between two cells alone. No
 * caller may rely on that: each function is told which cells it is asked about, so that a kernel
 * of a layered medium fits behind the same table.
 *
 * Cells are given by their column and row on the mesh.
 */
#ifndef ILSAI_ELASTICITY_H
#define ILSAI_ELASTICITY_H

#include "base/grid.h"
#include "base/thread_pool.h"
#include "elastic/self_term.h"
#include <ilsa/solver.h>
#include <stdbool.h>

typedef struct elasticity elasticity;

typedef struct elastic_kernel {
    const char *name;
    ilsa_status (*set_box)(elasticity *e, const box *b, mirror_axis about_x, mirror_axis about_y);
    void (*multiply)(elasticity *e, const double *w, double *p, size_t stride);
    double (*entry)(const elasticity *e, int i, int j, int k, int l);
    double (*self_entry)(const elasticity *e, int i, int j);
    void (*make_self_terms)(elasticity *e);
    self_term (*self_term)(const elasticity *e, int i, int j, const self_term_front *front);
    void (*destroy)(elasticity *e);
} elastic_kernel;

/* The head of every elasticity; what its kernel keeps follows. */
struct elasticity {
    const elastic_kernel *kernel;
    ilsa_product product; /* ILSA_PRODUCT_FFT or _BLAS, whichever computes the products */
    thread_pool *threads; /* that share a product, or NULL; they must outlive their use here */
};

/*
 * Makes the elasticity of a homogeneous medium for cells dx by dy. method is ILSA_PRODUCT_FFT,
 * _BLAS or _AUTO. *e is NULL on failure. ILSA_ERR_MEMORY; ILSA_ERR_MISMATCH when FFT is asked for
 * and not built in.
 */
ilsa_status ilsai_elasticity_create(double E_prime, double dx, double dy, ilsa_product method,
                                    elasticity **e);
void ilsai_elasticity_destroy(elasticity **e);

/* Whether the library was built with an FFT. */
bool ilsai_elasticity_has_fft(void);

/*
 * Makes ready for products and entries on the cells of a box. Where the box is one side of a mirror
 * image about x = 0 or y = 0, the cells beyond the axis, which are images of cells of the box,
 * count in products and need not be there. A call is cheap when the box, with its sides rounded up,
 * has the size of the box in use. Every bit of a product depends on the arguments alone and not on
 * earlier calls. On failure the box in use stays. ILSA_ERR_MEMORY.
 */
static inline ilsa_status ilsai_elasticity_set_box(elasticity *e, const box *b, mirror_axis about_x,
                                                   mirror_axis about_y) {
    return e->kernel->set_box(e, b, about_x, about_y);
}

/*
 * Sets the pressures in the cells of the box from their widths and those of their images. w and p
 * point to the numbers of the first cell of the box, rows are stride numbers apart, and the two may
 * not overlap. Allocates nothing.
 */
static inline void ilsai_elasticity_multiply(elasticity *e, const double *w, double *p,
                                             size_t stride) {
    e->kernel->multiply(e, w, p, stride);
}

/*
 * The pressure in cell (i, j) for a width of 1 in cell (k, l). Both are cells of the box or images
 * of such, or neighbours of these.
 */
static inline double ilsai_elasticity_entry(const elasticity *e, int i, int j, int k, int l) {
    return e->kernel->entry(e, i, j, k, l);
}

/* The entry of a cell of the mesh with itself. It needs no box. */
static inline double ilsai_elasticity_self_entry(const elasticity *e, int i, int j) {
    return e->kernel->self_entry(e, i, j);
}

/* Makes ready for ilsai_elasticity_self_term. Every call but the first is cheap. */
static inline void ilsai_elasticity_make_self_terms(elasticity *e) {
    e->kernel->make_self_terms(e);
}

/*
 * What the entry of cell (i, j) with itself lacks beside the front, see self_term.h, as a pressure
 * per width, and its derivative by the distance of the front.
 */
static inline self_term ilsai_elasticity_self_term(const elasticity *e, int i, int j,
                                                   const self_term_front *front) {
    return e->kernel->self_term(e, i, j, front);
}

#endif
