/* Why a run ended early, in the scene's own terms: file, line and key, and what to try. */
#ifndef ILSA_RUN_REASON_H
#define ILSA_RUN_REASON_H

#include "scene.h"

/* Says which sources inject outside the fracture, a line each; how many do. */
int reason_outside(const scene *sc, const ilsa_solver *solver, FILE *out);

/* The lines for a status that ended a run; last is what the step that failed reports. */
void reason_write(const scene *sc, const ilsa_solver *solver, ilsa_status status,
                  const ilsa_report *last, FILE *out);

#endif
