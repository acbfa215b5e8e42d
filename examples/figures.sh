#!/bin/sh
# figures.sh DIR...: draws the figures of runs of ilsa-run into their directories, as PNG and SVG:
# footprint, triangle, lines, history. UNITS=none or UNITS=SI overrides the labels' units, which are
# SI for a scene that gives E, nu, mu, ... and not named for one that gives E_prime.
set -eu

scripts=$(dirname "$0")/figures
[ $# -gt 0 ] || { echo "usage: figures.sh DIR..." >&2; exit 2; }
command -v gnuplot >/dev/null || { echo "figures.sh: gnuplot is not installed: make deps" >&2; exit 1; }

# gnuplot warns of signs beyond ASCII where the locale is the bare one of a new machine.
LC_ALL=C.UTF-8
export LC_ALL

for run; do
    [ -f "$run/plot.gp" ] || { echo "figures.sh: $run/plot.gp is missing: no run of ilsa-run" >&2; exit 1; }
    for figure in footprint triangle lines history; do
        for format in png svg; do
            RUN=$run SCRIPTS=$scripts FORMAT=$format FIGURE=$figure UNITS=${UNITS:-} \
                gnuplot "$scripts/$figure.gp"
        done
    done
    echo "figures in $run: footprint, triangle, lines, history (.png, .svg)"
done
