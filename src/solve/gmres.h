/* Restarted, right-preconditioned GMRES on operators given as functions. */
#ifndef ILSAI_GMRES_H
#define ILSAI_GMRES_H

#include <ilsa/status.h>
#include <stdbool.h>
#include <stddef.h>

typedef void gmres_operator(void *context, const double *x, double *y);

typedef struct gmres gmres;

/* restart: vectors kept, >= 1. Storage grows with ilsai_gmres_reserve. NULL on failure. */
gmres *ilsai_gmres_create(int restart);
void ilsai_gmres_destroy(gmres **g);

/* Room for n unknowns; keeps what is there when it is enough. ILSA_ERR_MEMORY. */
ilsa_status ilsai_gmres_reserve(gmres *g, size_t n);

typedef struct gmres_result {
    int iterations;
    double residual; /* |b - A x| / |b| in the 2-norm, 0 for b = 0 */
    bool converged;
} gmres_result;

/*
 * Solves A x = b from x = 0 until |b - A x| <= tolerance |b| or max_iterations products; A and M
 * (the preconditioner's solve, y = M^-1 x; NULL for none) must not write their first vector.
 * Non-finite numbers end it with converged = false. Allocates nothing.
 */
gmres_result ilsai_gmres_solve(gmres *g, size_t n, gmres_operator *A, gmres_operator *M,
                               void *context, const double *b, double *x, double tolerance,
                               int max_iterations);

#endif
