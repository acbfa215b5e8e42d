/*
 * The displacement-discontinuity kernel (4.6) and its Toeplitz product on a box of cells.
 *
 * The one interface behind which another kernel fits: the product, the near-field entries, what the
 * self term lacks beside the front.
 * E' is a factor of every entry.
 */
#ifndef ILSAI_ELASTICITY_H
#define ILSAI_ELASTICITY_H

#include "base/mirror.h"
#include "base/thread_pool.h"
#include "elastic/self_term.h"
#include <ilsa/solver.h>

/* C of (4.6) divided by E' for a cell offset (i, j) of cells dx by dy, free of cancellation. */
double ilsai_kernel(long i, long j, double dx, double dy);

typedef struct elasticity elasticity;

/*
 * method: ILSA_PRODUCT_FFT, _BLAS or _AUTO. NULL *e on failure. ILSA_ERR_MEMORY;
 * ILSA_ERR_MISMATCH when FFT is asked for and not built in.
 */
ilsa_status ilsai_elasticity_create(double E_prime, double dx, double dy, ilsa_product method,
                                    elasticity **e);
void ilsai_elasticity_destroy(elasticity **e);

/* Nonzero if the library was built with an FFT. */
int ilsai_elasticity_has_fft(void);

/*
 * Makes ready for boxes of bx by by cells: kernel table, transform sizes, plans and buffers. Where
 * the box is one side of a mirror image about x or y, the cells beyond the axis, images of those
 * within, count in products and need not be there. Cheap when the rounded-up size is the one in
 * use. Which transform is used, and so every bit of a product, depends on the arguments alone and
 * not on earlier calls. On failure the box in use stays. ILSA_ERR_MEMORY.
 */
ilsa_status ilsai_elasticity_set_box(elasticity *e, int bx, int by, mirror_axis about_x,
                                     mirror_axis about_y);

/*
 * p[j * stride + i] = sum over the box, and its images, of C(i - k, j - l) w[l * stride + k], for
 * all 0 <= i < bx, 0 <= j < by. w and p may not overlap. Allocates nothing.
 */
void ilsai_elasticity_multiply(elasticity *e, const double *w, double *p, size_t stride);

/* ILSA_PRODUCT_FFT or _BLAS, whichever computes the products. */
ilsa_product ilsai_elasticity_method(const elasticity *e);

/* From now on the team, which must outlive e or the next call of this, shares the products. */
void ilsai_elasticity_share(elasticity *e, thread_pool *threads);

/*
 * What C(0, 0) lacks in a cell beside the front, and its derivative by the distance of the front;
 * after ilsai_elasticity_make_self_terms, which is cheap but for the first call.
 */
void ilsai_elasticity_make_self_terms(elasticity *e);
self_term ilsai_elasticity_self_term(const elasticity *e, const self_term_front *front);

/* Entry C(i, j) between two cells of the box, or one and an image, from the table of the box. */
double ilsai_elasticity_entry(const elasticity *e, int i, int j);

#endif
