/* Scenes with bad values: one test per key and kind of badness, message and exit status. */
#include "csv.h"
#include "program.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A good scene, with the lines that the cases below replace. */
static const char good[] = "[material]\n"        /* 1 */
                           "E = 9.5e9\n"         /* 2 */
                           "nu = 0.2\n"          /* 3 */
                           "mu = 0.1\n"          /* 4 */
                           "K_Ic = 1e6\n"        /* 5 */
                           "C_L = 1e-5\n"        /* 6 */
                           "[mesh]\n"            /* 7 */
                           "nx = 21\n"           /* 8 */
                           "ny = 19\n"           /* 9 */
                           "dx = 1\n"            /* 10 */
                           "dy = 1\n"            /* 11 */
                           "symmetry = auto\n"   /* 12 */
                           "[stress]\n"          /* 13 */
                           "sigma = 7e6\n"       /* 14 */
                           "[injection]\n"       /* 15 */
                           "rate = 0.01\n"       /* 16 */
                           "x = 0\n"             /* 17 */
                           "y = 0\n"             /* 18 */
                           "[initial]\n"         /* 19 */
                           "radius = 5\n"        /* 20 */
                           "[run]\n"             /* 21 */
                           "t_end = 12\n"        /* 22 */
                           "output_times = 10\n" /* 23 */
                           "dt_initial = 1\n"    /* 24 */
                           "dt_max = 5\n"        /* 25 */
                           "level = 3\n"         /* 26 */
                           "coarsen = no\n"      /* 27 */
                           "tip = full\n"        /* 28 */
                           "threads = 2\n"       /* 29 */
                           "closure_width = 1e-6\n";

typedef struct bad_scene {
    const char *name;
    const char *line;    /* of the good scene, replaced by */
    const char *bad;     /* this; both "": the good scene itself */
    const char *message; /* after "scene.ini:", to its end or, with a last "...", its beginning */
} bad_scene;

#define GREATER_ZERO(section, key, line, good_line)                                                \
    {section " " key ": not a number", good_line, key " = a\n",                                    \
     line ": [" section "] " key " = a: not a number; must be > 0"},                               \
        {section " " key ": empty", good_line, key " =\n",                                         \
         line ": [" section "] " key " = : not a number; must be > 0"},                            \
        {section " " key ": more than a number", good_line, key " = 1 m\n",                        \
         line ": [" section "] " key " = 1 m: not a number; must be > 0"},                         \
        {section " " key ": infinite", good_line, key " = inf\n",                                  \
         line ": [" section "] " key " = inf: not a number; must be > 0"},                         \
        {section " " key ": overflow", good_line, key " = 1e999\n",                                \
         line ": [" section "] " key " = 1e999: not a number; must be > 0"},                       \
        {section " " key ": nan", good_line, key " = nan\n",                                       \
         line ": [" section "] " key " = nan: not a number; must be > 0"},                         \
        {section " " key ": zero", good_line, key " = 0\n",                                        \
         line ": [" section "] " key " = 0: must be > 0"},                                         \
    {                                                                                              \
        section " " key ": negative", good_line, key " = -1\n",                                    \
            line ": [" section "] " key " = -1: must be > 0"                                       \
    }

#define NOT_NEGATIVE(section, key, line, good_line)                                                \
    {section " " key ": not a number", good_line, key " = a\n",                                    \
     line ": [" section "] " key " = a: not a number; must be >= 0"},                              \
    {                                                                                              \
        section " " key ": negative", good_line, key " = -1\n",                                    \
            line ": [" section "] " key " = -1: must be >= 0"                                      \
    }

static const bad_scene scenes[] = {
    GREATER_ZERO("material", "E", "2", "E = 9.5e9\n"),
    {"material E: missing", "E = 9.5e9\n", "",
     "1: [material]: missing; must have E (> 0) or E_prime (> 0)"},
    {"material E: with E_prime", "E = 9.5e9\n", "E = 9.5e9\nE_prime = 1e10\n",
     "3: [material] E_prime = 1e10: E is given too, on line 2; must be either E or E_prime"},
    {"material nu: not a number", "nu = 0.2\n", "nu = half\n",
     "3: [material] nu = half: not a number; must be in 0 .. 0.5"},
    {"material nu: too large", "nu = 0.2\n", "nu = 0.7\n",
     "3: [material] nu = 0.7: must be in 0 .. 0.5"},
    {"material nu: negative", "nu = 0.2\n", "nu = -0.1\n",
     "3: [material] nu = -0.1: must be in 0 .. 0.5"},
    {"material nu: missing", "nu = 0.2\n", "", "1: [material] nu: missing; must be in 0 .. 0.5"},
    {"material nu: with E_prime", "E = 9.5e9\n", "E_prime = 1e10\n",
     "3: [material] nu = 0.2: must be given with E only; E_prime contains it"},
    NOT_NEGATIVE("material", "mu", "4", "mu = 0.1\n"),
    {"material mu: missing", "mu = 0.1\n", "",
     "1: [material]: missing; must have mu (>= 0) or mu_prime (>= 0)"},
    {"material mu: with mu_prime", "mu = 0.1\n", "mu_prime = 1.2\nmu = 0.1\n",
     "5: [material] mu = 0.1: mu_prime is given too, on line 4; must be either mu or mu_prime"},
    NOT_NEGATIVE("material", "K_Ic", "5", "K_Ic = 1e6\n"),
    {"material K_Ic: missing", "K_Ic = 1e6\n", "",
     "1: [material]: missing; must have K_Ic (>= 0) or K_prime (>= 0)"},
    {"material K_Ic: with K_prime", "K_Ic = 1e6\n", "K_Ic = 1e6\nK_prime = 3e6\n",
     "6: [material] K_prime = 3e6: K_Ic is given too, on line 5; must be either K_Ic or K_prime"},
    NOT_NEGATIVE("material", "C_L", "6", "C_L = 1e-5\n"),
    {"material C_L: missing", "C_L = 1e-5\n", "",
     "1: [material]: missing; must have C_L (>= 0) or C_prime (>= 0)"},
    {"material C_L: with C_prime", "C_L = 1e-5\n", "C_L = 1e-5\nC_prime = 2e-5\n",
     "7: [material] C_prime = 2e-5: C_L is given too, on line 6; must be either C_L or C_prime"},
    {"material mu: beyond what the library takes", "mu = 0.1\n", "mu = 1e308\n",
     "4: [material] mu = 1e308: beyond 1e60; must be >= 0"},
    {"material mu: beyond it when scaled", "mu = 0.1\n", "mu = 1e60\n",
     "4: [material] mu = 1e60: mu_prime is 1.2e+61; must be in 1e-60 .. 1e+60"},
    {"material mu: all but zero", "mu = 0.1\n", "mu = 1e-300\n",
     "4: [material] mu = 1e-300: mu_prime is 1.2e-299; must be in 1e-60 .. 1e+60"},
    {"material mu_prime: all but zero", "mu = 0.1\n", "mu_prime = 1e-300\n",
     "4: [material] mu_prime = 1e-300: must be in 1e-60 .. 1e+60"},
    {"material E: beyond what the library takes when scaled", "E = 9.5e9\n", "E = 1e60\n",
     "2: [material] E = 1e60: E_prime is 1.041666667e+60; must be in 1e-60 .. 1e+60"},
    {"material E: all but zero", "E = 9.5e9\n", "E = 1e-300\n",
     "2: [material] E = 1e-300: under 1e-60; must be > 0"},
    {"material K_Ic: beyond what the library takes when scaled", "K_Ic = 1e6\n", "K_Ic = 1e60\n",
     "5: [material] K_Ic = 1e60: K_prime is 3.191538243e+60; must be in 0 .. 1e+60"},
    {"material C_L: beyond what the library takes when scaled", "C_L = 1e-5\n", "C_L = 1e60\n",
     "6: [material] C_L = 1e60: C_prime is 2e+60; must be in 0 .. 1e+60"},
    {"material: nothing holds the front", "mu = 0.1\nK_Ic = 1e6\n", "mu = 0\nK_Ic = 0\n",
     "4: [material] mu = 0: must be > 0 where K_Ic = 0 (line 5): nothing holds the front"},
    {"material: nothing holds the front, scaled", "mu = 0.1\nK_Ic = 1e6\n",
     "K_prime = 0\nmu_prime = 0\n",
     "5: [material] mu_prime = 0: must be > 0 where K_prime = 0 (line 4): nothing holds the front"},
    GREATER_ZERO("material", "E_prime", "2", "E = 9.5e9\n"),
    NOT_NEGATIVE("material", "mu_prime", "4", "mu = 0.1\n"),
    NOT_NEGATIVE("material", "K_prime", "5", "K_Ic = 1e6\n"),
    NOT_NEGATIVE("material", "C_prime", "6", "C_L = 1e-5\n"),
    {"material: unknown key", "mu = 0.1\n", "Mu = 0.1\n",
     "4: [material] Mu = 0.1: unknown key; must be one of E, nu, mu, K_Ic, C_L, E_prime, "
     "mu_prime, K_prime, C_prime"},

    {"mesh nx: not a number", "nx = 21\n", "nx = many\n",
     "8: [mesh] nx = many: not a number; must be a whole number in 3 .. 1000000"},
    {"mesh nx: not whole", "nx = 21\n", "nx = 21.5\n",
     "8: [mesh] nx = 21.5: not a whole number; must be a whole number in 3 .. 1000000"},
    {"mesh nx: too small", "nx = 21\n", "nx = 2\n",
     "8: [mesh] nx = 2: must be a whole number in 3 .. 1000000"},
    {"mesh nx: too large", "nx = 21\n", "nx = 1000001\n",
     "8: [mesh] nx = 1000001: must be a whole number in 3 .. 1000000"},
    {"mesh nx: missing", "nx = 21\n", "",
     "7: [mesh] nx: missing; must be a whole number in 3 .. 1000000"},
    {"mesh ny: not a number", "ny = 19\n", "ny = -\n",
     "9: [mesh] ny = -: not a number; must be a whole number in 3 .. 1000000"},
    {"mesh ny: too small", "ny = 19\n", "ny = -19\n",
     "9: [mesh] ny = -19: must be a whole number in 3 .. 1000000"},
    {"mesh ny: too many cells", "nx = 21\nny = 19\n", "nx = 100000\nny = 100000\n",
     "9: [mesh] ny = 100000: must be in 3 .. 2684 with this nx: 2^28 cells in all"},
    {"mesh ny: missing", "ny = 19\n", "",
     "7: [mesh] ny: missing; must be a whole number in 3 .. 1000000"},
    GREATER_ZERO("mesh", "dx", "10", "dx = 1\n"),
    {"mesh dx: missing", "dx = 1\n", "", "7: [mesh] dx: missing; must be > 0"},
    {"mesh dx: beyond what the library takes", "dx = 1\n", "dx = 1e300\n",
     "10: [mesh] dx = 1e300: beyond 1e60; must be > 0"},
    GREATER_ZERO("mesh", "dy", "11", "dy = 1\n"),
    {"mesh dy: too flat", "dy = 1\n", "dy = 0.0005\n",
     "11: [mesh] dy = 0.0005: must be in 0.001 .. 1000, dx / 1000 .. 1000 dx"},
    {"mesh symmetry: another word", "symmetry = auto\n", "symmetry = yes\n",
     "12: [mesh] symmetry = yes: must be auto, none, x, y or xy"},
    {"mesh symmetry: not the scene's", "symmetry = auto\n[stress]\nsigma = 7e6\n",
     "symmetry = y\n[stress]\nsigma = 7e6, 8e6\ninterfaces = 1\n",
     "12: [mesh] symmetry: must be one that stress and sources have, or auto..."},
    {"mesh: unknown key", "dy = 1\n", "dz = 1\n",
     "11: [mesh] dz = 1: unknown key; must be one of nx, ny, dx, dy, symmetry, cells_max"},

    {"stress sigma: not numbers", "sigma = 7e6\n", "sigma = high\n",
     "14: [stress] sigma = high: not a list of numbers; must be numbers separated by commas, each "
     "finite"},
    {"stress sigma: infinite", "sigma = 7e6\n", "sigma = inf\n",
     "14: [stress] sigma = inf: not a list of numbers; must be numbers separated by commas, each "
     "finite"},
    {"stress sigma: beyond what the library takes", "sigma = 7e6\n", "sigma = -1e300\n",
     "14: [stress] sigma = -1e300: beyond 1e60; must be numbers separated by commas, each finite"},
    {"stress sigma: no comma", "sigma = 7e6\n", "sigma = 7e6 8e6\ninterfaces = 1\n",
     "14: [stress] sigma = 7e6 8e6: not a list of numbers; must be numbers separated by commas, "
     "each finite"},
    {"stress sigma: comma at the end", "sigma = 7e6\n", "sigma = 7e6, 8e6,\ninterfaces = 1\n",
     "14: [stress] sigma = 7e6, 8e6,: not a list of numbers; must be numbers separated by commas, "
     "each finite"},
    {"stress sigma: too few", "sigma = 7e6\n", "sigma = 7e6, 8e6\ninterfaces = 1, 2\n",
     "14: [stress] sigma = 7e6, 8e6: must be 3 values, one more than interfaces, not "
     "2"},
    {"stress sigma: without interfaces", "sigma = 7e6\n", "sigma = 7e6, 8e6\n",
     "14: [stress] sigma = 7e6, 8e6: must be one value, or interfaces must be given"},
    {"stress sigma: missing", "sigma = 7e6\n", "",
     "13: [stress]: missing; must have sigma (numbers separated by commas, each finite) or profile "
     "(the path of a file, from the directory of the scene on)"},
    {"stress interfaces: not numbers", "sigma = 7e6\n", "sigma = 7e6, 8e6\ninterfaces = top\n",
     "15: [stress] interfaces = top: not a list of numbers; must be numbers separated by commas, "
     "each finite"},
    {"stress interfaces: falling", "sigma = 7e6\n", "sigma = 7e6, 8e6, 9e6\ninterfaces = 2, 1\n",
     "15: [stress] interfaces = 2, 1: value 2, 1, is below value 1, 2; must be rising, from the "
     "bottom interface up"},
    {"stress interfaces: equal", "sigma = 7e6\n",
     "sigma = 7e6, 8e6, 9e6, 7e6\ninterfaces = -2, 4.25, 4.250\n",
     "15: [stress] interfaces = -2, 4.25, 4.250: values 2 and 3 are both 4.25; must be rising, "
     "from "
     "the bottom interface up"},
    {"stress: unknown key", "sigma = 7e6\n", "sigma = 7e6\nsigma2 = 8e6\n",
     "15: [stress] sigma2 = 8e6: unknown key; must be one of sigma, interfaces, profile, "
     "origin_depth"},

    NOT_NEGATIVE("injection", "rate", "16", "rate = 0.01\n"),
    {"injection rate: zero at first", "rate = 0.01\n", "rate = 0\n",
     "16: [injection] rate = 0: must be > 0 at first: this source made the initial fracture"},
    {"injection rate: beyond what the library takes", "rate = 0.01\n", "rate = 1e300\n",
     "16: [injection] rate = 1e300: beyond 1e60; must be >= 0"},
    {"injection rate: too small for a penny", "rate = 0.01\n", "rate = 1e-300\n",
     "20: [initial] radius = 5, with [material] of line 1 and the rate of line 16: radius = 5: no "
     "penny-shaped fracture can be found"},
    {"injection schedule: a time beyond what the library takes", "rate = 0.01\n",
     "schedule = 0:0.01, 1e300:0\n",
     "16: [injection] schedule = 0:0.01, 1e300:0: beyond 1e60; must be t:Q, t:Q, ... with the "
     "first "
     "t = 0, t rising and Q >= 0"},
    {"injection rate: missing", "rate = 0.01\n", "",
     "15: [injection]: missing; must have rate (>= 0) or schedule (t:Q, t:Q, ... with the first "
     "t = 0, t rising and Q >= 0)"},
    {"injection rate: with schedule", "rate = 0.01\n", "rate = 0.01\nschedule = 0:0.01\n",
     "17: [injection] schedule = 0:0.01: rate is given too, on line 16; must be either rate or "
     "schedule"},
    {"injection schedule: not pairs", "rate = 0.01\n", "schedule = 0.01, 0.02\n",
     "16: [injection] schedule = 0.01, 0.02: not pairs t:Q; must be t:Q, t:Q, ... with the first "
     "t = 0, t rising and Q >= 0"},
    {"injection schedule: half a pair", "rate = 0.01\n", "schedule = 0:0.01, 5:\n",
     "16: [injection] schedule = 0:0.01, 5:: not pairs t:Q; must be t:Q, t:Q, ... with the first "
     "t = 0, t rising and Q >= 0"},
    {"injection schedule: negative rate", "rate = 0.01\n", "schedule = 0:0.01, 11:-1\n",
     "16: [injection] schedule = 0:0.01, 11:-1: must be t:Q, t:Q, ... with the first t = 0, t "
     "rising and Q >= 0"},
    {"injection schedule: starts late", "rate = 0.01\n", "schedule = 1:0.01\n",
     "16: [injection] schedule = 1:0.01: must be t:Q, t:Q, ... with the first t = 0, t rising and "
     "Q >= 0"},
    {"injection schedule: times fall", "rate = 0.01\n", "schedule = 0:0.01, 11:0, 11:1\n",
     "16: [injection] schedule = 0:0.01, 11:0, 11:1: must be t:Q, t:Q, ... with the first t = 0, "
     "t rising and Q >= 0"},
    {"injection schedule: zero at first", "rate = 0.01\n", "schedule = 0:0, 11:1\n",
     "16: [injection] schedule = 0:0, 11:1: must be > 0 at first: this source made the initial "
     "fracture"},
    {"injection schedule: before the start", "rate = 0.01\n", "schedule = 0:0.01, 1e-6:0.02\n",
     "16: [injection] schedule: the second t must be after the initial fracture's own time, > ..."},
    {"injection x: not a number", "x = 0\n", "x = here\n",
     "17: [injection] x = here: not a number; must be finite"},
    {"injection x: off the mesh", "x = 0\n", "x = 11\n",
     "17: [injection] x = 11: must be inside the mesh, in -10.5 .. 10.5"},
    {"injection y: not a number", "y = 0\n", "y = nan\n",
     "18: [injection] y = nan: not a number; must be finite"},
    {"injection y: off the mesh", "y = 0\n", "y = -9.6\n",
     "18: [injection] y = -9.6: must be inside the mesh, in -9.5 .. 9.5"},
    {"injection: unknown key", "x = 0\n", "X = 0\n",
     "17: [injection] X = 0: unknown key; must be one of rate, schedule, x, y"},
    {"injection.2: negative rate", "[initial]\n", "[injection.2]\nrate = -1\n[initial]\n",
     "20: [injection.2] rate = -1: must be >= 0"},
    {"injection.2: off the mesh", "[initial]\n", "[injection.2]\nrate = 1\nx = 99\n[initial]\n",
     "21: [injection.2] x = 99: must be inside the mesh, in -10.5 .. 10.5"},
    {"injection.2: outside the fracture at the start", "[initial]\n",
     "[injection.2]\nschedule = 0:0.5, 11:0\nx = -8\n[initial]\n",
     "20: injection.2 at (-8, 0) is not in the fracture at time 9.5756..."},
    {"injection.3: without the second", "[initial]\n", "[injection.3]\nrate = 1\n[initial]\n",
     "19: [injection.3]: the sources must be numbered without a gap; injection.2 is missing"},
    {"injection.1: not a name", "[initial]\n", "[injection.1]\nrate = 1\n[initial]\n",
     "19: [injection.1]: unknown section; must be material, mesh, stress, injection, injection.2 "
     ".. injection.1000, initial or run"},

    GREATER_ZERO("initial", "radius", "20", "radius = 5\n"),
    {"initial radius: under 2 cells", "radius = 5\n", "radius = 1.9\n",
     "20: [initial] radius = 1.9: must be at least 2, 2 cells, and under 8: inside the mesh"},
    {"initial radius: off the mesh", "radius = 5\n", "radius = 8\n",
     "20: [initial] radius = 8: must be at least 2, 2 cells, and under 8: inside the mesh"},
    {"initial radius: no room around the source", "y = 0\n", "y = 7\n",
     "20: [initial] radius = 5: must be at least 2, 2 cells, for which the mesh is too small "
     "around "
     "the source"},
    {"initial radius: missing", "radius = 5\n", "",
     "19: [initial]: missing; must have radius (> 0) or time (> 0)"},
    {"initial radius: with time", "radius = 5\n", "radius = 5\ntime = 1\n",
     "21: [initial] time = 1: radius is given too, on line 20; must be either radius or time"},
    GREATER_ZERO("initial", "time", "20", "radius = 5\n"),
    {"initial time: too early", "radius = 5\n", "time = 1e-6\n",
     "20: [initial] time = 1e-06, with [material] of line 1 and the rate of line 16: the "
     "radius..."},
    {"initial time: too late", "radius = 5\n", "time = 1e9\n",
     "20: [initial] time = 1000000000, with [material] of line 1 and the rate of line 16: a "
     "fracture of radius..."},
    {"initial: unknown key", "radius = 5\n", "R = 5\n",
     "20: [initial] R = 5: unknown key; must be one of radius, time"},

    GREATER_ZERO("run", "t_end", "22", "t_end = 12\n"),
    {"run t_end: before the start", "t_end = 12\noutput_times = 10\n", "t_end = 1e-3\n",
     "22: [run] t_end: must be after the initial fracture's own time, > ..."},
    {"run t_end: missing", "t_end = 12\n", "", "21: [run] t_end: missing; must be > 0"},
    {"run output_times: not numbers", "output_times = 10\n", "output_times = end\n",
     "23: [run] output_times = end: not a list of numbers; must be numbers separated by commas, "
     "each > 0"},
    {"run output_times: zero", "output_times = 10\n", "output_times = 0, 10\n",
     "23: [run] output_times = 0, 10: must be numbers separated by commas, each > 0"},
    {"run output_times: falling", "output_times = 10\n", "output_times = 11, 10\n",
     "23: [run] output_times = 11, 10: value 2, 10, is below value 1, 11; must be rising"},
    {"run output_times: equal", "output_times = 10\n", "output_times = 10, 10\n",
     "23: [run] output_times = 10, 10: values 1 and 2 are both 10; must be rising"},
    {"run output_times: after the end", "output_times = 10\n", "output_times = 10, 13\n",
     "23: [run] output_times = 10, 13: must be at most t_end = 12"},
    {"run output_times: before the start", "output_times = 10\n", "output_times = 1e-3\n",
     "23: [run] output_times: must be after the initial fracture's own time, > ..."},
    GREATER_ZERO("run", "dt_initial", "24", "dt_initial = 1\n"),
    GREATER_ZERO("run", "dt_max", "25", "dt_max = 5\n"),
    {"run dt_initial: too small for the clock", "dt_initial = 1\n", "dt_initial = 1e-20\n",
     "24: [run] dt_initial = 1e-20: too small to move the clock on from ..."},
    {"run dt_max: too small for the clock", "dt_max = 5\n", "dt_max = 1e-20\n",
     "25: [run] dt_max = 1e-20: too small to move the clock on from 12"},
    GREATER_ZERO("run", "closure_width", "30", "closure_width = 1e-6\n"),
    {"run level: not a number", "level = 3\n", "level = high\n",
     "26: [run] level = high: not a number; must be a whole number in 1 .. 5"},
    {"run level: not whole", "level = 3\n", "level = 2.5\n",
     "26: [run] level = 2.5: not a whole number; must be a whole number in 1 .. 5"},
    {"run level: too small", "level = 3\n", "level = 0\n",
     "26: [run] level = 0: must be a whole number in 1 .. 5"},
    {"run level: too large", "level = 3\n", "level = 6\n",
     "26: [run] level = 6: must be a whole number in 1 .. 5"},
    {"run coarsen: another word", "coarsen = no\n", "coarsen = maybe\n",
     "27: [run] coarsen = maybe: must be no or yes"},
    {"run tip: another word", "tip = full\n", "tip = LEFM\n",
     "28: [run] tip = LEFM: must be full, toughness-viscosity or toughness"},
    {"run tip: empty", "tip = full\n", "tip =\n",
     "28: [run] tip = : must be full, toughness-viscosity or toughness"},
    {"run: unknown key", "coarsen = no\n", "refine = no\n",
     "27: [run] refine = no: unknown key; must be one of t_end, output_times, dt_initial, level, "
     "tip, coarsen, threads, dt_max, closure_width"},
    {"run threads: none", "threads = 2\n", "threads = 0\n",
     "29: [run] threads = 0: must be a whole number in 1 .. 64"},
    {"run threads: too many", "threads = 2\n", "threads = 65\n",
     "29: [run] threads = 65: must be a whole number in 1 .. 64"},
    {"run threads: not whole", "threads = 2\n", "threads = 1.5\n",
     "29: [run] threads = 1.5: not a whole number; must be a whole number in 1 .. 64"},
    {"run threads: not a number", "threads = 2\n", "threads = all\n",
     "29: [run] threads = all: not a number; must be a whole number in 1 .. 64"},

    {"given twice: a key", "mu = 0.1\n", "mu = 0.1\nmu = 0.1\n",
     "5: [material] mu = 0.1: given twice, first on line 4"},
    {"given twice: a section", "[run]\n", "[mesh]\n[run]\n",
     "21: [mesh]: given twice, first on line 7"},
    {"unknown section", "[run]\n", "[rock]\ndensity = 2700\n[run]\n",
     "21: [rock]: unknown section; must be material, mesh, stress, injection, injection.2 .. "
     "injection.1000, initial or run"},
    {"missing section", "[initial]\nradius = 5\n", "", "28: [initial]: missing section"},
    {"key before the first section", "[material]\n", "level = 3\n[material]\n",
     "1: level stands before the first [section]"},
    {"neither heading nor key", "mu = 0.1\n", "viscous\nmu = 0.1\n",
     "4: neither [section] nor key = value"},
    {"heading not closed", "[run]\n", "[run\n", "21: a heading must be [section]"},
    {"scalar on two lines", "mu = 0.1\n", "mu = 0.1\n  0.2\n",
     "4: [material] mu = 0.1 0.2: not a number; must be >= 0"},
    {"line number after a continued list", "sigma = 7e6\n[injection]\nrate = 0.01\n",
     "sigma = 7e6,\n  8e6,\n  9e6\ninterfaces = -1, 1\n[injection]\nrate = -1\n",
     "19: [injection] rate = -1: must be >= 0"},
    {"line number after comments", "mu = 0.1\n", "# = one\n  ; two\nmu = -1 # three\n",
     "6: [material] mu = -1: must be >= 0"},
    {"two errors, two lines", "nu = 0.2\nmu = 0.1\n", "nu = 2\nmu = -1\n",
     "3: [material] nu = 2: must be in 0 .. 0.5\n"
     "scene.ini:4: [material] mu = -1: must be >= 0"},
};

/* Stress logs that are no good: the scene's [stress], the file, and what is said from the start. */
typedef struct bad_log {
    const char *name, *stress, *log, *message;
} bad_log;

#define PROFILE "profile = logs/a.csv\n"
#define HEAD    "y (m), sigma (Pa)\n"
#define ROWS    "-20, 7e6\n20, 8e6\n"

static const bad_log logs[] = {
    {"profile: missing file", "profile = logs/b.csv\n", HEAD ROWS,
     "scene.ini:14: [stress] profile = logs/b.csv: No such file or directory"},
    {"profile: a directory", "profile = logs\n", HEAD ROWS,
     "scene.ini:14: [stress] profile = logs: Is a directory"},
    {"profile: no name", "profile =\n", HEAD ROWS,
     "scene.ini:14: [stress] profile = : must be the path of a file, from the directory of the "
     "scene "
     "on"},
    {"profile: with sigma", "sigma = 7e6\n" PROFILE, HEAD ROWS,
     "scene.ini:15: [stress] profile = logs/a.csv: sigma is given too, on line 14; must be either "
     "sigma or profile"},
    {"profile: with interfaces", PROFILE "interfaces = 1\n", HEAD ROWS,
     "scene.ini:15: [stress] interfaces = 1: profile is given too, on line 14; must be either "
     "interfaces or profile"},
    {"origin_depth: without profile", "sigma = 7e6\norigin_depth = 3000\n", HEAD ROWS,
     "scene.ini:15: [stress] origin_depth = 3000: must be given with profile only"},
    {"origin_depth: missing", PROFILE, "depth (m), sigma (Pa)\n" ROWS,
     "scene.ini:13: [stress] origin_depth: missing; must be the depth of y = 0: logs/a.csv gives "
     "depths"},
    {"origin_depth: with y", PROFILE "origin_depth = 3000\n", HEAD ROWS,
     "scene.ini:15: [stress] origin_depth = 3000: must be given with depths only: logs/a.csv gives "
     "y"},
    {"origin_depth: far from the log", PROFILE "origin_depth = 1e30\n",
     "depth (m), sigma (Pa)\n" ROWS,
     "scene.ini:15: [stress] origin_depth = 1e+30: so far from the depths of logs/a.csv that its "
     "rows fall together"},
    {"profile: off the source", PROFILE "origin_depth = 3000\n",
     "TVD (ft), sigma (psi)\n9900, 7000\n10000, 8000\n",
     "scene.ini:14: [stress] profile = logs/a.csv: reaches from y = -48 to -17.52; must cover "
     "every "
     "source, y = 0"},
    {"profile: too fine a mesh for it", PROFILE, "y (km), sigma (Pa)\n-1e6, 1\n1e6, 1\n",
     "scene.ini:14: [stress] profile = logs/a.csv: reaches over 2000000000 cells of dy; must be at "
     "most 1000000"},
    {"profile: empty", PROFILE, "\n# nothing\n",
     "./logs/a.csv:2: empty; must begin with names and units, as in \"y (m), sigma (Pa)\""},
    {"profile: not text", PROFILE, NULL, "./logs/a.csv:1: not a text file"},
    {"profile: no names", PROFILE, ROWS,
     "./logs/a.csv:1: -20: no unit that is known; a name and one of m, km, cm, mm, ft, in, - must "
     "stand there, as in \"y (m), sigma (Pa)\"; - is the scene's own"},
    {"profile: no unit", PROFILE, "y, sigma (Pa)\n" ROWS,
     "./logs/a.csv:1: y: no unit that is known; a name and one of m, km, cm, mm, ft, in, - must "
     "stand there, as in \"y (m), sigma (Pa)\"; - is the scene's own"},
    {"profile: unknown unit", PROFILE, "y (m), sigma (kg/m3)\n" ROWS,
     "./logs/a.csv:1: sigma (kg/m3): no unit that is known; a name and one of Pa, kPa, MPa, GPa, "
     "bar, psi, ksi, - must stand there, as in \"y (m), sigma (Pa)\"; - is the scene's own"},
    {"profile: unknown first column", PROFILE, "MD (m), sigma (Pa)\n" ROWS,
     "./logs/a.csv:1: MD: the first column must be y (upwards), depth or TVD (downwards)"},
    {"profile: one column", PROFILE, "y (m)\n" ROWS,
     "./logs/a.csv:1: 1 column; must be 2, depth or y and stress"},
    {"profile: three columns in a row", PROFILE, HEAD "-20, 7e6\n20, 8e6, 9e6\n",
     "./logs/a.csv:3: 3 columns; must be 2, depth or y and stress"},
    {"profile: one row", PROFILE, HEAD "0, 7e6\n",
     "./logs/a.csv:2: 1 row below the names; must be 2 or more"},
    {"profile: not a number", PROFILE, HEAD ROWS "30, high\n",
     "./logs/a.csv:4: sigma = high: not a number"},
    {"profile: a number and more", PROFILE, HEAD "20 m, 7e6\n",
     "./logs/a.csv:2: y = 20 m: not a number"},
    {"profile: no number", PROFILE, HEAD ", 7e6\n", "./logs/a.csv:2: y = : not a number"},
    {"profile: nan", PROFILE, HEAD "1, nan\n", "./logs/a.csv:2: sigma = nan: not a number"},
    {"profile: decimal comma between commas", PROFILE, HEAD "1,5, 7e6\n",
     "./logs/a.csv:2: 3 columns; must be 2, depth or y and stress"},
    {"profile: beyond what the library takes", PROFILE, HEAD "1, 1e300\n",
     "./logs/a.csv:2: sigma = 1e300: beyond 1e60"},
    {"profile: not measured", PROFILE, "y (m), sigma (MPa)\n1, -999.25\n",
     "./logs/a.csv:2: sigma = -999.25: marks what was not measured; such rows must be left out"},
    {"profile: the same depth twice", PROFILE, "depth (m), sigma (Pa)\n1, 7\n\n2.5, 8\n2.50, 9\n",
     "./logs/a.csv:5: depth = 2.5 after 2.5 on line 4: must rise from row to row, or fall"},
    {"profile: depth turns back", PROFILE, "depth (m), sigma (Pa)\n1, 7\n2, 8\n1.5, 9\n",
     "./logs/a.csv:4: depth = 1.5 after 2 on line 3: must rise from row to row, or fall"},
};

static void bad_log_is_refused(void **state) {
    const bad_log *log = *state;
    char text[2048], expected[512], output[4096];
    const char *at = strstr(good, "sigma = 7e6\n");
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, log->stress,
             at + strlen("sigma = 7e6\n"));
    program_write("scene.ini", text);
    assert_int_equal(program_run("mkdir -p logs", output, sizeof output), 0);
    if (log->log)
        program_write("logs/a.csv", log->log);
    else
        program_run("printf 'y (m)\\0' >logs/a.csv", output, sizeof output);
    int of_file = strncmp(log->message, "./", 2) == 0;
    snprintf(expected, sizeof expected, "%s%s\n", of_file ? "" : "./", log->message);
    int status = program_run("ilsa-run ./scene.ini --out out", output, sizeof output);
    assert_string_equal(output, expected);
    assert_int_equal(status, 2);
    assert_false(program_exists("out"));
}

static void write_scene(const bad_scene *scene) {
    char text[2048];
    const char *at = strstr(good, scene->line);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, scene->bad,
             at + strlen(scene->line));
    program_write("scene.ini", text);
}

static void bad_scene_is_refused(void **state) {
    const bad_scene *scene = *state;
    char expected[512], output[4096];
    write_scene(scene);
    int status = program_run("ilsa-run scene.ini --out out", output, sizeof output);
    size_t length = strlen(scene->message);
    int whole = length < 3 || strcmp(scene->message + length - 3, "...") != 0;
    snprintf(expected, sizeof expected, "scene.ini:%.*s%s", (int)(whole ? length : length - 3),
             scene->message, whole ? "\n" : "");
    if (!whole && strlen(output) > strlen(expected))
        output[strlen(expected)] = '\0';
    assert_string_equal(output, expected);
    assert_int_equal(status, 2);
    assert_false(program_exists("out"));
}

static void expect_good(const char *text) {
    char output[4096];
    program_write("scene.ini", text);
    int status = program_run("ilsa-run scene.ini --out good --quiet", output, sizeof output);
    assert_string_equal(output, "");
    assert_int_equal(status, 0);
}

static void good_scene_runs(void **state) {
    (void)state;
    expect_good(good);
}

/* Byte order mark, CR LF, comments, indented keys, continued lists, blanks: all as people type. */
static void free_form_is_read(void **state) {
    (void)state;
    expect_good("\xEF\xBB\xBF; a comment with = and [ in it\r\n\r\n"
                "[material] # as scaled\r\n  E_prime=9.9e9\r\n\tmu_prime\t= 1.2 # thin\r\n"
                "  K_prime =  3.2e6 ; tough\r\n  C_prime = 0\r\n"
                "   # another = comment\r\n"
                " [mesh]\r\nnx = 2.1e1\r\nny = 21\r\n# more\r\ndx = 1\t# m\r\n"
                "[stress]\r\ninterfaces = -4,\r\n   4\r\nsigma = 7.5e6,\r\n"
                "   7e6, # the middle\r\n   # not this, 9e6\r\n   7.5e6\r\n"
                "[injection]\r\nschedule = 0:0.01,\r\n   11 : 0.02\r\n"
                "[injection.2]\r\nrate = 0\r\nx = 1\r\n"
                "[initial]\r\nradius = 5\r\n[run]\r\nt_end = 12");
}

/* Each tip model runs; that of toughness needs some. */
static void tip_models_are_read(void **state) {
    (void)state;
    static const char *const words[] = {"full", "toughness-viscosity", "toughness"};
    static const char form[] = "[material]\nE_prime = 1\nmu_prime = 1e-4\nK_prime = %d\n"
                               "C_prime = 0\n[mesh]\nnx = 21\nny = 21\ndx = 0.1\n"
                               "[stress]\nsigma = 0\n[injection]\nrate = 1\n"
                               "[initial]\nradius = 0.5\n[run]\nt_end = 0.3\ntip = %s\n";
    char text[1024], output[4096];
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text, form, 1, words[k]);
        expect_good(text);
    }
    snprintf(text, sizeof text, form, 0, words[2]);
    program_write("scene.ini", text);
    assert_int_equal(program_run("ilsa-run scene.ini", output, sizeof output), 2);
    assert_string_equal(output, "scene.ini:18: [run] tip = toughness: must be full or "
                                "toughness-viscosity where the toughness is 0\n");
}

/* A log of 5000 layers on one line; the same on as many lines. */
static void lines_of_any_length_are_read(void **state) {
    (void)state;
    enum { LAYERS = 5000 };
    static char text[40 * LAYERS], output[40 * LAYERS];
    const char *at = strstr(good, "sigma = 7e6\n");
    for (int lines = 0; lines < 2; lines++) {
        int used = snprintf(text, sizeof text, "%.*sinterfaces = ", (int)(at - good), good);
        for (int i = 1; i < LAYERS; i++)
            used += snprintf(text + used, sizeof text - (size_t)used, "%s%s%.2f", i > 1 ? "," : "",
                             lines ? "\n   " : "", 0.01 * i - 25);
        used += snprintf(text + used, sizeof text - (size_t)used, " # %0300d\nsigma = ", 0);
        for (int i = 0; i < LAYERS; i++)
            used += snprintf(text + used, sizeof text - (size_t)used, "%s%d", i ? ", " : "",
                             7000000 + i % 7);
        snprintf(text + used, sizeof text - (size_t)used, "\n%s", at + strlen("sigma = 7e6\n"));
        expect_good(text);
    }
    char *nines = strstr(text, "7000003");
    nines[3] = 'x';
    program_write("scene.ini", text);
    assert_int_equal(program_run("ilsa-run scene.ini", output, sizeof output), 2);
    assert_non_null(strstr(output, ": [stress] sigma = 7000000, 7000001, 7000002, 700x003, "));
    assert_non_null(strstr(output, "...: entry 4: not a list of numbers; must be numbers"));
    assert_true(strlen(output) < 300);
}

static double stress_of(const char *directory, double y) {
    char name[64];
    double found = NAN;
    snprintf(name, sizeof name, "%s/line_y_001.csv", directory);
    csv_table *t = csv_read(program_path(name));
    for (size_t i = 0; i < csv_rows(t); i++)
        if (csv_get(t, i, "y") == y)
            found = csv_get(t, i, "stress");
    csv_free(t);
    return found;
}

static void expect_log(const char *stress, const char *log) {
    char text[2048];
    const char *at = strstr(good, "sigma = 7e6\n");
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, stress,
             at + strlen("sigma = 7e6\n"));
    program_write("logs.csv", log);
    expect_good(text);
}

/* The mean over each cell of what runs straight between the rows and stays beyond them. */
static void profile_gives_cell_means(void **state) {
    (void)state;
    expect_log("profile = logs.csv\n", "y (m), sigma (Pa)\n-1, 6e6\n0.25, 7e6\n1, 7.6e6\n");
    assert_true(fabs(stress_of("good", -3) - 6e6) < 1e-6);
    assert_true(fabs(stress_of("good", -1) - (0.5 * 6e6 + 0.5 * 6.2e6)) < 1e-3);
    assert_true(fabs(stress_of("good", 0) - (0.75 * 6.7e6 + 0.25 * 7.1e6)) < 1e-3);
    assert_true(fabs(stress_of("good", 1) - (0.5 * 7.4e6 + 0.5 * 7.6e6)) < 1e-3);
    assert_true(stress_of("good", 2) == 7.6e6);
}

/* However it is exported: the same log in other words, the same file of fields. */
static void profiles_are_read_as_exported(void **state) {
    (void)state;
    static const char *const same[][2] = {
        {"", "y (m), sigma (Pa)\n-8, 6e6\n0.5, 7e6\n8, 6.5e6"},
        {"", "\xEF\xBB\xBF# a log\r\n\r\n\"Y [M]\"\t\"Shmin [MPA]\"\r\n-8\t6\r\n"
             "0,5\t7,0 # pay\r\n8\t6,5\r\n\r\n"},
        {"origin_depth = 1024\n", "depth (m);sigma (kPa)\n1016;6500\n1023,5;7e3\n1032;6,0e3\n"},
        {"origin_depth = 1024\n", "TVD (cm), S (bar)\n103200, 60\n102350, 70\n101600, 65\n"},
        {"", "y (-), sigma (-)\n8, 6.5e6\n0.5, 7e6\n-8, 6e6\n"},
    };
    char stress[128], output[4096];
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        snprintf(stress, sizeof stress, "profile = logs.csv\n%s", same[i][0]);
        expect_log(stress, same[i][1]);
        assert_int_equal(program_run(i ? "cmp good/line_y_001.csv first.csv"
                                       : "cp good/line_y_001.csv first.csv",
                                     output, sizeof output),
                         0);
    }
}

/* The scene's last line may lack its end; a file may not be text. */
static void odd_files_are_refused(void **state) {
    (void)state;
    char output[4096];
    assert_int_equal(program_run("ilsa-run none.ini", output, sizeof output), 2);
    assert_string_equal(output, "none.ini: No such file or directory\n");
    assert_int_equal(
        program_run("printf '[run]\\nlevel = \\0003\\n' >scene.ini", output, sizeof output), 0);
    assert_int_equal(program_run("ilsa-run scene.ini", output, sizeof output), 2);
    assert_non_null(strstr(output, "scene.ini:2: not a text file\n"));
    assert_int_equal(program_run("ilsa-run .", output, sizeof output), 2);
    assert_string_equal(output, ".: Is a directory\n");
}

static void bad_usage_is_refused(void **state) {
    (void)state;
    char output[4096];
    program_write("scene.ini", good);
    assert_int_equal(program_run("ilsa-run", output, sizeof output), 2);
    assert_non_null(strstr(output, "ilsa-run: one scene file must be given\nusage: ilsa-run "));
    assert_int_equal(program_run("ilsa-run scene.ini scene.ini", output, sizeof output), 2);
    assert_non_null(strstr(output, "ilsa-run: one scene file must be given\n"));
    assert_int_equal(program_run("ilsa-run scene.ini --level 6", output, sizeof output), 2);
    assert_non_null(strstr(output, "ilsa-run: --level must be in 1 .. 5, not 6\n"));
    static const char *const threads[] = {"0", "65", "two", "2x", "-1", "''"};
    for (int k = 0; k < 6; k++) {
        char command[80];
        snprintf(command, sizeof command, "ilsa-run scene.ini --threads %s", threads[k]);
        assert_int_equal(program_run(command, output, sizeof output), 2);
        assert_non_null(strstr(output, "ilsa-run: --threads must be in 1 .. 64, not "));
    }
    assert_int_equal(program_run("ilsa-run scene.ini --out ''", output, sizeof output), 2);
    assert_non_null(strstr(output, "ilsa-run: --out must name a directory\n"));
    assert_int_equal(program_run("ilsa-run scene.ini --fast", output, sizeof output), 2);
    assert_non_null(strstr(output, "usage: ilsa-run "));
    assert_int_equal(program_run("ilsa-run --help", output, sizeof output), 0);
    assert_int_equal(strncmp(output, "usage: ilsa-run SCENE.ini", 25), 0);
}

int main(void) {
    enum { BAD = sizeof scenes / sizeof *scenes, LOGS = sizeof logs / sizeof *logs };
    static const struct CMUnitTest others[] = {cmocka_unit_test(good_scene_runs),
                                               cmocka_unit_test(free_form_is_read),
                                               cmocka_unit_test(lines_of_any_length_are_read),
                                               cmocka_unit_test(profile_gives_cell_means),
                                               cmocka_unit_test(profiles_are_read_as_exported),
                                               cmocka_unit_test(tip_models_are_read),
                                               cmocka_unit_test(odd_files_are_refused),
                                               cmocka_unit_test(bad_usage_is_refused)};
    static struct CMUnitTest tests[BAD + LOGS + sizeof others / sizeof *others];
    for (size_t i = 0; i < BAD; i++)
        tests[i] = (struct CMUnitTest){.name = scenes[i].name,
                                       .test_func = bad_scene_is_refused,
                                       .initial_state = (void *)(uintptr_t)&scenes[i]};
    for (size_t i = 0; i < LOGS; i++)
        tests[BAD + i] = (struct CMUnitTest){.name = logs[i].name,
                                             .test_func = bad_log_is_refused,
                                             .initial_state = (void *)(uintptr_t)&logs[i]};
    memcpy(tests + BAD + LOGS, others, sizeof others);
    return cmocka_run_group_tests_name("scene", tests, NULL, NULL);
}
