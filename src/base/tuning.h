/*
 * The constants of the numerics, each with its unit and its reason, and what each level sets. None
 * of them is physics. A change of most of them changes results within the tolerances.
 */
#ifndef ILSAI_TUNING_H
#define ILSAI_TUNING_H

/* ---- Levels and tolerances ---------------------------------------------------------------- */

/* Levels are 1 .. ILSAI_LEVELS. Each sets the advance of the front in a step and the tolerance of
 * the front, both in cells. */
#define ILSAI_LEVELS        5
#define ILSAI_LEVEL_DEFAULT 3
#define ILSAI_LEVEL_STEP                                                                           \
    { 0.75, 0.6, 0.5, 0.25, 0.1 }
#define ILSAI_LEVEL_TOLERANCE                                                                      \
    { 3e-2, 5e-3, 1e-3, 1e-4, 1e-5 }
/* A step that hardly moves the front asks for a tolerance in proportion to its advance, but for no
 * smaller part of the level's tolerance than this. */
#define ILSAI_TOLERANCE_PART 1e-4
/* The smallest tolerance of the front, in cells, because a distance is rounded. */
#define ILSAI_TOLERANCE_LEAST 1e-12
/* The tolerance of the widths over that of the front: w changes half as much as s in relative
 * terms, and the rest is a margin. */
#define ILSAI_WIDTH_TOLERANCE 0.1
/* A length, a time, a stress or a rate may be no more than the first, and no less than the second
 * where it may not be zero. Cubes of lengths times all other factors then stay in the range of a
 * double. */
#define ILSAI_MAGNITUDE_MOST  1e60
#define ILSAI_MAGNITUDE_LEAST 1e-60

/* ---- Linear solver ------------------------------------------------------------------------ */

/* GMRES keeps this many vectors before it restarts. A solve takes 3 to 10 iterations as a rule. */
#define ILSAI_GMRES_RESTART 30
/* After this many iterations of GMRES a step is given up. */
#define ILSAI_GMRES_ITERATIONS 240
/* The relative residual to which GMRES solves a Newton system. The front and the cube of the width
 * change by more between two systems than a sharper solution would be worth. */
#define ILSAI_GMRES_TOLERANCE 3e-2
/* The relative residual while more than this part of the cells is closed. Which of them open, and
 * what they leak, depends on small differences. */
#define ILSAI_GMRES_CONTACT 1e-4
#define ILSAI_GMRES_CLOSED  0.01
/* Up to this many unknowns the dense factorisation is faster than GMRES. */
#define ILSAI_DENSE_UNKNOWNS 100

/* ---- Newton's method ---------------------------------------------------------------------- */

/* A Newton step that changes the widths by a relative d leaves an error of about
 * d (NEWTON_CURVATURE d + NEWTON_RESIDUAL r), where r is the relative residual that GMRES left. */
#define ILSAI_NEWTON_CURVATURE 2.0
#define ILSAI_NEWTON_RESIDUAL  6.0
/* A Newton step may take away this part of a width. */
#define ILSAI_WIDTH_DROP 0.9
/* The furthest that a Newton step moves a front, in cells. */
#define ILSAI_NEWTON_ADVANCE 0.5
/* From this iteration on a Newton step that leaves more volume unaccounted for than there was is
 * cut by this factor, so many times at most: cells that close and open far apart in width send it
 * to and fro. */
#define ILSAI_NEWTON_GUARDED 6
#define ILSAI_NEWTON_CUT     0.25
#define ILSAI_NEWTON_CUTS    8
/* A coupled solve is given up after so many iterations in which no cell closed or opened, or after
 * so many in all. */
#define ILSAI_NEWTON_MAX  25
#define ILSAI_CONTACT_MAX 60

/* ---- Contact ------------------------------------------------------------------------------ */

/* The width of a closed cell, over the largest width that the fracture has had. */
#define ILSAI_CLOSURE 1e-4
/* A Newton step may close a cell whose width is less than this many closure widths. */
#define ILSAI_NEARLY_CLOSED 10.0

/* ---- Iteration on the front --------------------------------------------------------------- */

/* A step is given up after so many passes. */
#define ILSAI_FRONT_PASSES_MAX  40
#define ILSAI_NESTED_PASSES_MAX 100
/* From this pass on the front no longer follows the widths within the Newton system. The distances
 * are accelerated instead, because a step that has not converged by then goes to and fro. */
#define ILSAI_SENSITIVITY_PASSES 16
/* The number of differences that Anderson's acceleration keeps. */
#define ILSAI_ANDERSON_DEPTH 5
/* The front follows the widths in the first pass too, where a step leaks more than this many times
 * the fluid in the fracture. */
#define ILSAI_LEAK_FAST 3.0
/* The front may take away at most this part of a self term in Newton's matrix. */
#define ILSAI_SELF_TERM_GIVES 0.3
/* The derivatives of leak-off are differences over this advance of the front, in cells. */
#define ILSAI_DIFFERENCE 1e-5
/* The widths of a pass are found to a part of the front's last change, the smaller of PASS_SHARE
 * and PASS_SHARP times the front's tolerance. The second is the smaller one where the tolerance is
 * below those of the levels. A cell that may be tip or channel stays what the passes have made of
 * it, which then must not depend on the linear solver. */
#define ILSAI_PASS_SHARE 0.3
#define ILSAI_PASS_SHARP 3e4
/* From this pass on a change of SETTLE cells is taken for agreement if the tolerance is tighter: a
 * cell that turns from tip to channel and back leaves no front that meets the tolerance. */
#define ILSAI_SETTLE_PASS 16
#define ILSAI_SETTLE      5e-3
/* From this pass on a tip or channel cell of the pass before keeps its kind unless the front is
 * further than HOLD from filling it, as a part of the full ell. The widths of the two kinds differ
 * by the tip model's error, and the front would go to and fro between them. */
#define ILSAI_HOLD_PASS 4
#define ILSAI_HOLD      0.1
/* The largest advance of the front in a step, in cells. Cells that are entered and left within one
 * step are still right. */
#define ILSAI_ADVANCE_MAX 2.0
/* The largest part by which the volume balance may correct the widths. */
#define ILSAI_BALANCE_MAX 1e-2

/* ---- Tip cells ---------------------------------------------------------------------------- */

/* A cell is wet from this ell on, in cells. */
#define ILSAI_WET_MIN 1e-4
/* Distances are kept up to this far beyond the front, in cell diagonals. */
#define ILSAI_BAND 2.0
/* How far the pressure of a tip cell may be from those of the channel and from its stress, in what
 * a cell of the largest width so far presses on itself. A front that moves as the asymptote has it
 * does not come near that. */
#define ILSAI_TIP_REACH 3.0
/* The pressure that a tip cell had is no first guess where its net pressure is more than this many
 * times the largest in the channel. */
#define ILSAI_PRESSURE_WILD 1e3

/* ---- Survey cells ------------------------------------------------------------------------- */

/* The distance of a survey cell agrees with the term after the asymptote after at most so many
 * secant steps. SURVEY_GUESSES holds where the stress has steps. */
#define ILSAI_SURVEY_SECANTS 3
#define ILSAI_SURVEY_GUESSES 20
/* These end at a change of this many tolerances of the front, and take no slope larger than this.
 */
#define ILSAI_SURVEY_CLOSE 1e-3
#define ILSAI_SURVEY_SLOPE 0.7
/* The term after the asymptote may be at most this part of the width. */
#define ILSAI_NEXT_TERM_MAX 0.3
/* Steps of the stress are looked for up to so many cells behind a survey cell, and count in full up
 * to the second number of cells. */
#define ILSAI_STRESS_STEP_REACH 6.0
#define ILSAI_STRESS_STEP_FULL  3.0
/* Distance of a stress step from the front, over the length of the fracture on the normal, up to
 * which the fracture is a half-plane to the step, and from which on the step is the other front's.
 */
#define ILSAI_STRESS_STEP_NEAR 0.25
#define ILSAI_STRESS_STEP_FAR  0.5
/* A front this far beyond a stress step, in cells, feels half of its depth. */
#define ILSAI_STRESS_STEP_SOFT 0.05
/* At least this part of a width is left for the asymptote when stress steps have taken theirs. */
#define ILSAI_STRESS_STEP_LEFT 0.02
/* Stress steps that a predicted front passes may add this part of the survey cell's width. How far
 * the front may go for that is found by so many halvings. */
#define ILSAI_STRESS_STEP_PREDICTED  0.3
#define ILSAI_STRESS_STEP_BISECTIONS 30

/* ---- Shape of the front ------------------------------------------------------------------- */

/* A parabola is fitted to the front within this distance, in cells. */
#define ILSAI_GEOMETRY_REACH 3.5
/* Points belong to one stretch of the front where the cosine of their normals is above this. */
#define ILSAI_GEOMETRY_ALIKE 0.3
/* A fit needs so many points, which reach this part of the distance to both sides. */
#define ILSAI_GEOMETRY_POINTS 4
#define ILSAI_GEOMETRY_SPAN   0.4
/* The largest curvature, per cell. */
#define ILSAI_GEOMETRY_CURVATURE 0.5

/* ---- Time --------------------------------------------------------------------------------- */

/* The limit of the step grows by the first after an accepted step. A refused step is cut by the
 * second. */
#define ILSAI_DT_GROWTH 1.5
#define ILSAI_DT_CUT    0.5
/* The longest step where the front stands still, as a part of the time so far. */
#define ILSAI_DT_RESTING 0.1
/* A fracture empties when less than the first part of its leak-off is injected. It may then lose
 * the second part of its volume in a step. */
#define ILSAI_EMPTIES 0.5
#define ILSAI_DT_LOSS 0.1
/* An advance gives up when the step is less than this part of the time so far. */
#define ILSAI_DT_SMALLEST 1e-12
/* An advance gives up after so many refused steps while the time grows by this factor, because it
 * would take for ever. */
#define ILSAI_CRAWL_REFUSED 400
#define ILSAI_CRAWL_TIME    1.1

/* ---- Sources, start, coarsening ----------------------------------------------------------- */

/* The largest number of sources of one solver. */
#define ILSAI_SOURCES 1000
/* A source closer to an edge of a cell than this, in cells, feeds the cells on both sides. */
#define ILSAI_EDGE_CELLS 1e-9
/* The viscosity that stands for none, over the one that a penny of one cell would feel. Widths and
 * pressures differ by about that part, and from 1e-17 on rounding is felt. */
#define ILSAI_INVISCID 1e-10
/* The smallest radius of the penny at the start, in cells. */
#define ILSAI_START_CELLS 2.0
/* A footprint must have this many new cells across to be coarsened. */
#define ILSAI_COARSEN_LEAST 4
/* The cells that a mesh may grow to where the definition does not say. */
#define ILSAI_GROW_CELLS 100000.0
/* At the edge of the mesh: the cells that coarsening must leave across half of the footprint, and
 * across the layer of a source. */
#define ILSAI_EDGE_CELLS_ACROSS 10.0
/* The ratio of sides up to which cells are coarsened along one direction alone, and the cells of
 * that length which must stay across the footprint the other way. Sides of 8 to 1 put a half-length
 * off by 0.8 %, and with four and a half cells across a footprint no step was accepted. */
#define ILSAI_EDGE_OBLONG     4.0
#define ILSAI_EDGE_LENGTHWISE 5.0
/* The free cells of a direction that counts as full; the fewest cells worth being added on a side;
 * the fewest that stay beside the footprint where others are taken away. */
#define ILSAI_EDGE_FREE  3
#define ILSAI_EDGE_ADDED 4
#define ILSAI_EDGE_KEPT  8.0
/* Distances are measured anew this far behind the survey cells, in diagonals of the new cells. */
#define ILSAI_COARSEN_REACH 3.0

/* ---- Threads ------------------------------------------------------------------------------ */

/* The largest number of threads of one solver. */
#define ILSAI_THREADS 64
/* The smallest part of a loop that is worth sharing, in cells and in cells at the front: a few
 * microseconds of work. */
#define ILSAI_SHARE_CELLS 512
#define ILSAI_SHARE_FRONT 8

#endif
