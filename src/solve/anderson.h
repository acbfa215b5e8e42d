/* Anderson acceleration of a fixed-point iteration x <- g(x). */
#ifndef ILSAI_ANDERSON_H
#define ILSAI_ANDERSON_H

#include <ilsa/status.h>

typedef struct anderson anderson;

/* depth: earlier iterates kept, 0 (plain iteration) .. 10. NULL on failure. */
anderson *ilsai_anderson_create(int depth);
void ilsai_anderson_destroy(anderson **a);

/* Forgets the iterates and makes room for n unknowns. ILSA_ERR_MEMORY. */
ilsa_status ilsai_anderson_begin(anderson *a, int n);

/*
 * x: the iterate that g was evaluated at; on return the next one. When the residual g - x has grown
 * to more than twice the smallest so far the memory is dropped and the next iterate is g.
 */
void ilsai_anderson_next(anderson *a, const double *g, double *x);

#endif
