/*
 * libilsa: planar hydraulic fractures by the multiscale Implicit Level Set Algorithm.
 *
 * A number in brackets such as (4.9), and a section such as 5.1, is one of the paper
 *
 *     E. V. Dontsov and A. P. Peirce, A multiscale Implicit Level Set Algorithm (ILSA) to model
 *     hydraulic fracture propagation incorporating combined viscous, toughness, and leak-off
 *     asymptotics, Computer Methods in Applied Mechanics and Engineering 313 (2017) 53-84,
 *
 * to which docs/theory.md lists corrections.
 *
 *     mesh, material, stress  ->  ilsa_solver_create  ->  ilsa_start_radial
 *     your loop               ->  ilsa_step(solver, dt, &report)
 *     results                 ->  ilsa_get_width, ilsa_get_front, ilsa_get_summary
 *     taking a step back      ->  ilsa_snapshot_save, ilsa_snapshot_restore
 */
#ifndef ILSA_ILSA_H
#define ILSA_ILSA_H

#include <ilsa/material.h>
#include <ilsa/mesh.h>
#include <ilsa/snapshot.h>
#include <ilsa/solver.h>
#include <ilsa/status.h>
#include <ilsa/stress.h>
#include <ilsa/tip.h>
#include <ilsa/version.h>

#endif
