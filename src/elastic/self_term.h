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
typedef struct edge_front {
    double s;            /* distance from the cell's centre, > 0 */
    double cos_a, sin_a; /* normal, reflected into 0 .. pi/2 */
    double exponent;     /* lambda, 1/2 .. 2/3 */
} edge_front;

/* What the self term lacks, as a part of it, and its derivative by s. */
typedef struct edge_term {
    double value, slope;
} edge_term;

/* Mean of s^lambda over the cell as a part of its value at the centre. */
double ilsai_edge_mean(double dx, double dy, const edge_front *front);

/* The term by summing over the lattice: tens of microseconds. */
double ilsai_edge_exact(double dx, double dy, const edge_front *front);

/* The term for one shape of cells, interpolated to 1e-3 of the self term. */
enum { EDGE_DISTANCES = 27, EDGE_ANGLES = 13, EDGE_EXPONENTS = 3 };
typedef struct edge_table {
    double dx, dy; /* 0: not made yet */
    double at[EDGE_EXPONENTS][EDGE_ANGLES][EDGE_DISTANCES];
} edge_table;

void ilsai_edge_table(edge_table *table, double dx, double dy);
edge_term ilsai_edge_lookup(const edge_table *table, const edge_front *front);

#endif
