/*
 * What the self term of a cell, its entry of C with itself, lacks beside the front.
 *
 * Elasticity takes the width of a cell as constant. Beside the front the width goes as a power of
 * the distance, and the pressure that constant cells give is not that of the width. In a cell that
 * has just filled the difference is up to a fifth of the self term; two cells further in there is
 * none.
 *
 * For a straight front and w = s^lambda on the whole half-plane behind it the pressure is known,
 *
 *     p = E' (lambda / 4) cot(pi lambda) s^(lambda - 1).
 *
 * The pressure that the cell means of this width give on the lattice of cells is known as well. The
 * difference of the two, over the cell's own mean width, is what its self term lacks. It depends on
 * s, on the direction of the front, on lambda and on the shape of the cells.
 */
#ifndef ILSAI_SELF_TERM_H
#define ILSAI_SELF_TERM_H

/* A straight front as a cell sees it. */
typedef struct self_term_front {
    double s;            /* distance from the cell's centre, > 0 */
    double cos_a, sin_a; /* normal, reflected into 0 .. pi/2 */
    double exponent;     /* lambda, 1/2 .. 2/3 */
} self_term_front;

/* What the self term lacks and its derivative by s, both as parts of the self term. */
typedef struct self_term {
    double value, slope;
} self_term;

/* The mean of s^lambda over the cell, over its value at the centre. */
double ilsai_self_term_mean(double dx, double dy, const self_term_front *front);

/* What the self term lacks, as a part of it, by the sum over the lattice. It takes tens of
 * microseconds. */
double ilsai_self_term_exact(double dx, double dy, const self_term_front *front);

/* The table for one shape of cells. Interpolation in it is good to 1e-3 of the self term. */
enum { SELF_TERM_DISTANCES = 27, SELF_TERM_ANGLES = 13, SELF_TERM_EXPONENTS = 3 };
typedef struct self_term_table {
    double dx, dy; /* 0: not made yet */
    double at[SELF_TERM_EXPONENTS][SELF_TERM_ANGLES][SELF_TERM_DISTANCES];
} self_term_table;

void ilsai_self_term_table(self_term_table *table, double dx, double dy);
self_term ilsai_self_term_lookup(const self_term_table *table, const self_term_front *front);

#endif
