/* Restarted GMRES, preconditioned from the right, on operators that are functions. */
#ifndef ILSAI_GMRES_H
#define ILSAI_GMRES_H

#include <ilsa/status.h>
#include <stdbool.h>
#include <stddef.h>

typedef void gmres_operator(void *context, const double *x, double *y);

typedef struct gmres gmres;

/* restart is the number of vectors kept, >= 1. NULL on failure. */
gmres *ilsai_gmres_create(int restart);
void ilsai_gmres_destroy(gmres **g);

/* Makes room for n unknowns. ILSA_ERR_MEMORY. */
ilsa_status ilsai_gmres_reserve(gmres *g, size_t n);

typedef struct gmres_result {
    int iterations;
    double residual; /* |b - A x| / |b| in the 2-norm, 0 for b = 0 */
    bool converged;
} gmres_result;

/*
 * Solves A x = b from x = 0 until |b - A x| <= tolerance |b| or after max_iterations products. M is
 * the preconditioner's solve, y = M^-1 x, or NULL. Neither A nor M may write its first vector.
 * Numbers that are not finite end the solve with converged = false. Allocates nothing.
 */
gmres_result ilsai_gmres_solve(gmres *g, size_t n, gmres_operator *A, gmres_operator *M,
                               void *context, const double *b, double *x, double tolerance,
                               int max_iterations);

#endif
