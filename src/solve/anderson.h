/* Anderson acceleration of a fixed-point iteration x <- g(x). */
#ifndef ILSAI_ANDERSON_H
#define ILSAI_ANDERSON_H

#include <ilsa/status.h>

typedef struct anderson anderson;

/* depth is the number of earlier iterates kept, 0 .. 10; 0 is the plain iteration. NULL on failure.
 */
anderson *ilsai_anderson_create(int depth);
void ilsai_anderson_destroy(anderson **a);

/* Forgets the iterates and makes room for n unknowns. ILSA_ERR_MEMORY. */
ilsa_status ilsai_anderson_begin(anderson *a, int n);

/*
 * Replaces x, at which g was evaluated, by the next iterate. When the residual g - x has grown to
 * more than twice the smallest so far, the earlier iterates are forgotten and the next one is g.
 */
void ilsai_anderson_next(anderson *a, const double *g, double *x);

#endif
