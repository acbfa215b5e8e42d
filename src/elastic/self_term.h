/*
 * Constant elements beside the front. There the width goes as a power of the distance, and the
 * pressure that its cell means bring about differs from that of the width itself: by up to a fifth
 * of the self term in a cell that has just filled, by nothing two cells further in.
 *
 * For a straight front and w = s^lambda on all of its half-plane the pressure is known exactly,
 *
 *     p = E' (lambda / 4) cot(pi lambda) s^(lambda - 1),
 *
 * and so is what the means give on the lattice of cells around one at distance s: the difference
 * over the cell's own mean width is what its self term lacks, a function of s, of the direction of
 * the front, of lambda and of the shape of the cells.
 */
#ifndef ILSAI_SELF_TERM_H
#define ILSAI_SELF_TERM_H

/* A straight front as a cell sees it. */
typedef struct self_term_front {
    double s;            /* distance from the cell's centre, > 0 */
    double cos_a, sin_a; /* normal, reflected into 0 .. pi/2 */
    double exponent;     /* lambda, 1/2 .. 2/3 */
} self_term_front;

/* What the self term lacks, as a part of it, and its derivative by s. */
typedef struct self_term {
    double value, slope;
} self_term;

/* Mean of s^lambda over the cell as a part of its value at the centre. */
double ilsai_self_term_mean(double dx, double dy, const self_term_front *front);

/* The term by summing over the lattice: tens of microseconds. */
double ilsai_self_term_exact(double dx, double dy, const self_term_front *front);

/* The term for one shape of cells, interpolated to 1e-3 of the self term. */
enum { SELF_TERM_DISTANCES = 27, SELF_TERM_ANGLES = 13, SELF_TERM_EXPONENTS = 3 };
typedef struct self_term_table {
    double dx, dy; /* 0: not made yet */
    double at[SELF_TERM_EXPONENTS][SELF_TERM_ANGLES][SELF_TERM_DISTANCES];
} self_term_table;

void ilsai_self_term_table(self_term_table *table, double dx, double dy);
self_term ilsai_self_term_lookup(const self_term_table *table, const self_term_front *front);

#endif
