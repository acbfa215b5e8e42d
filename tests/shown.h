/*
 * The scenes of examples/scenes as the tests' own, in other units and turned, and how far two
 * fractures are from each other once units and turns are taken away.
 */
#ifndef TESTS_SHOWN_H
#define TESTS_SHOWN_H

#include "check.h"
#include "host.h"

/* A scene with the penny it begins with. */
typedef struct shown {
    const char *name;
    host_scene scene;
    double radius, end; /* of the penny; the time where the scene ends */
} shown;

enum { SHOWN_LAYERED = 9, SHOWN_RADIAL = 7, SHOWN_SCENES = SHOWN_LAYERED + SHOWN_RADIAL };

/* Scene 0 .. SHOWN_SCENES - 1, the layered ones first, on cells of 20 m / cells. */
shown shown_scene(int which, int cells);

/* What the units of another system are in those of the first. */
typedef struct shown_units {
    double length, time, force;
} shown_units;

shown shown_in_units(const shown *s, shown_units u);

/*
 * A turn of the plane, 0 .. SHOWN_TURNS - 1: with bit 2 x and y are exchanged, then with bit 0 x
 * goes to -x, with bit 1 y to -y.
 */
enum { SHOWN_TURNS = 8 };

/*
 * The scene turned. Its stress is one per cell, which the caller frees; of the scene only stresses
 * per cell, or a uniform one, are turned.
 */
shown shown_turned(const shown *s, int turn, double **cells);

/* Where a cell of a mesh comes to lie. */
int shown_turned_cell(const ilsa_mesh_def *mesh, int turn, int cell);

/*
 * Differences, each in parts of the largest there is of its kind: the channel's widths and net
 * pressures, distances of survey cells to the front in cells, the time. INFINITY where the cells
 * are not of the same kinds.
 */
typedef struct shown_difference {
    double width, pressure, front, time;
} shown_difference;

/* That of no states. */
#define SHOWN_NOTHING_YET ((shown_difference){NOTHING_YET, NOTHING_YET, NOTHING_YET, NOTHING_YET})

/* Of b, which was made in the units u and by the turn, to a. */
shown_difference shown_compare(ilsa_solver *a, ilsa_solver *b, shown_units u, int turn);

shown_difference shown_worse(shown_difference a, shown_difference b);
double shown_largest(shown_difference d);

#endif
