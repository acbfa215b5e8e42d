# Sourced by figures.sh and paper_figures.sh, which set scripts, the directory of the .gp files.
command -v gnuplot >/dev/null || { echo "${0##*/}: gnuplot is not installed: make deps" >&2; exit 1; }

# gnuplot warns of signs beyond ASCII where the locale is the bare one of a new machine.
LC_ALL=C.UTF-8
export LC_ALL

# draw SCRIPT FILE RUN...: FILE.png and FILE.svg by SCRIPT.gp from runs of ilsa-run. TITLE, LABELS,
# AXES, PANELS and UNITS of the environment are said in common.gp.
draw() {
    draw_script=$1
    draw_file=$2
    shift 2
    draw_runs=
    for draw_run; do
        [ -f "$draw_run/plot.gp" ] ||
            { echo "${0##*/}: $draw_run/plot.gp is missing: no run of ilsa-run" >&2; exit 1; }
        draw_runs="$draw_runs \"$draw_run\""
    done
    for draw_format in png svg; do
        RUNS=$draw_runs SCRIPTS=$scripts FORMAT=$draw_format FILE=$draw_file \
            gnuplot "$scripts/$draw_script.gp"
    done
}
