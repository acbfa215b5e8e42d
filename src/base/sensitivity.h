/*
 * How a cell at the front changes with the widths of the cells that the front is found from, the
 * survey cells and cells behind them. The front follows these widths within a Newton iteration, see
 * docs/theory.md, section 9.
 */
#ifndef ILSAI_SENSITIVITY_H
#define ILSAI_SENSITIVITY_H

enum { SENSITIVITY_PARENTS = 8 };

/*
 * One array a derivative, each with `count` elements. Element p is the derivative by the width of
 * mesh cell from[p].
 */
typedef struct sensitivity {
    int cell; /* of the mesh: the one that changes */
    int count;
    int from[SENSITIVITY_PARENTS];
    double width[SENSITIVITY_PARENTS];       /* of the width of a tip cell */
    double source_term[SENSITIVITY_PARENTS]; /* of the source term, by the leak-off */
    double pressure[SENSITIVITY_PARENTS];    /* of the pressure of a channel cell at its own width,
                                                by what its self term lacks beside the front */
    double advance[SENSITIVITY_PARENTS];     /* of the distance from a survey cell to the front, in
                                                cells; 0 for other cells */
} sensitivity;

#endif
