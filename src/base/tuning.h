/* Constants of the numerics, with unit and reason, and what each level sets. */
#ifndef ILSAI_TUNING_H
#define ILSAI_TUNING_H

/* GMRES: vectors kept. A solve takes 3 to 10 iterations as a rule. */
#define ILSAI_GMRES_RESTART 30
/* GMRES: iterations after which a step is given up. */
#define ILSAI_GMRES_ITERATIONS 240
/* GMRES: relative residual of one Newton system. The front and the cube of the width change by more
 * between two systems than a sharper solution would be worth. */
#define ILSAI_GMRES_TOLERANCE 3e-2
/* and while cells are closed: which of them open, and what they leak, are small differences. */
#define ILSAI_GMRES_CONTACT 1e-4
/* Newton: error left in the widths after a relative change d is about NEWTON_CURVATURE d^2. */
#define ILSAI_NEWTON_CURVATURE 2.0
/* and about NEWTON_RESIDUAL d times the relative residual that GMRES has left. */
#define ILSAI_NEWTON_RESIDUAL 6.0
/* Unknowns up to which the dense factorisation is the faster one. */
#define ILSAI_DENSE_UNKNOWNS 100
/* Part of a width that one Newton step may take away. */
#define ILSAI_WIDTH_DROP 0.9
/* Newton iterations of one coupled solve before the step is given up: those in which no cell closed
 * or opened, and all. */
#define ILSAI_NEWTON_MAX  25
#define ILSAI_CONTACT_MAX 60
/* Newton: from this iteration on cells no longer open and close in turn, see contact.h, */
#define ILSAI_CONTACT_LATE 20
/* unless they would leave their bounds by so much of the largest width or net pressure. */
#define ILSAI_CONTACT_FORCED 1e-2
/* Contact: width of a closed cell over the largest that the fracture has had. */
#define ILSAI_CLOSURE 1e-4
/* Contact: width, over that, under which a Newton step may close a cell. */
#define ILSAI_NEARLY_CLOSED 10.0

/* Front: from this pass on the cells at the front no longer answer within the Newton system, and
 * the distances are accelerated instead: a step that has not converged by then goes to and fro. */
#define ILSAI_SENSITIVITY_PASSES 16
/* Front: volume leaking in a step over that in the fracture from which on the front moves with the
 * widths in the first pass too. */
#define ILSAI_LEAK_FAST 3.0
/* Front: from this pass on a change of so many cells will do, if the tolerance is tighter: a cell
 * that turns from tip to channel and back leaves no front that meets it. */
#define ILSAI_SETTLE_PASS 16
#define ILSAI_SETTLE      5e-3
/* Front: the most that the front's move takes away from a self term in Newton's matrix, as a part.
 */
#define ILSAI_SELF_TERM_GIVES 0.1
/* Front: how sharply the widths of a pass are found, as a part of the front's last change; and,
 * over the front's tolerance, where this is below those of the levels: a cell that may be tip or
 * channel remains what the passes have made of it, which then must not depend on the solver. */
#define ILSAI_PASS_SHARE 0.3
#define ILSAI_PASS_SHARP 3e4
/* Front: step of the differences that tell how a cell at the front answers, in cells. */
#define ILSAI_DIFFERENCE 1e-5
/* Front: passes before a step is given up, and the memory of the Anderson acceleration. */
#define ILSAI_FRONT_PASSES_MAX  40
#define ILSAI_NESTED_PASSES_MAX 100
/* Front: from this pass on a cell that has been tip or channel in the pass before stays so unless
 * the front is further than HOLD from filling it, in parts of the full ell: the widths of the two
 * kinds differ by the tip model's error, and the front would go to and fro between them. */
#define ILSAI_HOLD_PASS      4
#define ILSAI_HOLD           0.1
#define ILSAI_ANDERSON_DEPTH 5
/* Front: largest advance in one step, in cells; a cell entered and left in a step is still right.
 */
#define ILSAI_ADVANCE_MAX 2.0
/* Front: a cell counts as wet from this ell on, in cells. */
#define ILSAI_WET_MIN 1e-4
/* Volume: largest correction of the widths that the balance may ask for. */
#define ILSAI_BALANCE_MAX 1e-2
/* Front: how far beyond it distances are kept, in cell diagonals. */
#define ILSAI_BAND 2.0

/* Tip cells: net pressure over the largest in the channel above which it is no first guess. */
#define ILSAI_PRESSURE_WILD 1e3

/* Time: growth of the step after an accepted one, cut after a rejected one. */
#define ILSAI_DT_GROWTH 1.5
#define ILSAI_DT_CUT    0.5
/* Time: longest step where the front stands still, as a part of the time so far. */
#define ILSAI_DT_RESTING 0.1
/* Time: a fracture empties when less than this part of what leaks is injected; part of its volume
 * that it may lose in a step. */
#define ILSAI_EMPTIES 0.5
#define ILSAI_DT_LOSS 0.1
/* Time: smallest step relative to the time so far before an advance gives up. */
#define ILSAI_DT_SMALLEST 1e-12

/* Time: refused steps, while the time grows by this factor, after which an advance gives up: it
 * would take for ever. */
#define ILSAI_CRAWL_REFUSED 400
#define ILSAI_CRAWL_TIME    1.1

/* Source: the most that one solver may have. */
#define ILSAI_SOURCES 1000
/* Source: closer to a cell edge than this, in cells, it feeds the cells on both sides. */
#define ILSAI_EDGE_CELLS 1e-9
/* Shape of the front: how far along it a parabola is fitted, in cells; cosine above which normals
 * belong to the same stretch; largest curvature, per cell. */
#define ILSAI_GEOMETRY_REACH 3.5
#define ILSAI_GEOMETRY_ALIKE 0.3
/* Least number of points of such a fit, and how far to both sides they must go, as a part of it. */
#define ILSAI_GEOMETRY_POINTS    4
#define ILSAI_GEOMETRY_SPAN      0.4
#define ILSAI_GEOMETRY_CURVATURE 0.5
/* Survey: secant steps to the distance that agrees with the second term, the same where the stress
 * jumps, the change at which they end, in tolerances of the front, and the largest slope that they
 * believe. */
#define ILSAI_SURVEY_SECANTS 3
#define ILSAI_SURVEY_GUESSES 20
#define ILSAI_SURVEY_CLOSE   1e-3
#define ILSAI_SURVEY_SLOPE   0.7
/* Survey: how far behind the cell steps of the stress are looked for, in cells. */
#define ILSAI_STRESS_STEP_REACH 6.0
/* Survey: how far beyond such a step the front feels half of its depth, in cells. */
#define ILSAI_STRESS_STEP_SOFT 0.05
/* Survey: least part of a width that is left for the asymptote once such steps have theirs. */
#define ILSAI_STRESS_STEP_LEFT 0.02
/* Front: part of a survey cell's width that a predicted front's stress steps may add, and the
 * halvings that find how far that is. */
#define ILSAI_STRESS_STEP_PREDICTED  0.3
#define ILSAI_STRESS_STEP_BISECTIONS 30
/* Width behind the tip: largest part that the term after the asymptote may have. */
#define ILSAI_NEXT_TERM_MAX 0.3

/* Start: viscosity that stands for none, as a part of what a penny of one cell would feel. Widths
 * and pressures differ by about that part; from 1e-17 on rounding is felt. */
#define ILSAI_INVISCID 1e-10
/* Start: smallest radius of the penny, in cells. */
#define ILSAI_START_CELLS 2.0

/* Coarsening: new cells that a footprint must have across, and how far behind the survey cells
 * distances are measured anew, in new cell diagonals. */
#define ILSAI_COARSEN_LEAST 4
#define ILSAI_COARSEN_REACH 3.0

/* Levels 1 .. 5: advance of the front per step and tolerance of the front, both in cells. */
#define ILSAI_LEVELS        5
#define ILSAI_LEVEL_DEFAULT 3
#define ILSAI_LEVEL_STEP                                                                           \
    { 0.75, 0.6, 0.5, 0.25, 0.1 }
#define ILSAI_LEVEL_TOLERANCE                                                                      \
    { 3e-2, 5e-3, 1e-3, 1e-4, 1e-5 }
/* Threads: the most that one solver may have. */
#define ILSAI_THREADS 64
/* Threads: turns of a loop over cells, and over cells at the front, below which a part of it is not
 * worth sharing: a few microseconds. */
#define ILSAI_SHARE_CELLS 512
#define ILSAI_SHARE_FRONT 8

/* Smallest part of the tolerance of the front that a step which hardly moves it asks for. */
#define ILSAI_TOLERANCE_PART 1e-4
/* Magnitude: the most that a length, a time, a stress, a rate may be, and the least where it may
 * not be zero. Cubes of lengths times what else there is stay in the double range. */
#define ILSAI_MAGNITUDE_MOST  1e60
#define ILSAI_MAGNITUDE_LEAST 1e-60

/* Smallest tolerance of the front, in cells: rounding of a distance. */
#define ILSAI_TOLERANCE_LEAST 1e-12
/* Tolerance of the widths relative to that of the front: w changes half as much as s. */
#define ILSAI_WIDTH_TOLERANCE 0.1

#endif
