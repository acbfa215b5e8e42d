#!/bin/sh
# figures.sh DIR...: draws the figures of runs of ilsa-run into their directories, as PNG and SVG:
# footprint, triangle, lines, history. UNITS=none or UNITS=SI overrides the labels' units, which are
# SI for a scene that gives E, nu, mu, ... and not named for one that gives E_prime.
set -eu

scripts=$(dirname "$0")/figures
[ $# -gt 0 ] || { echo "usage: figures.sh DIR..." >&2; exit 2; }
. "$scripts/draw.sh"

for run; do
    for figure in footprint triangle lines history; do
        draw $figure "$run/$figure" "$run"
    done
    echo "figures in $run: footprint, triangle, lines, history (.png, .svg)"
done
