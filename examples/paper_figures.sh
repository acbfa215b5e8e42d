#!/bin/sh
# paper_figures.sh DIR: draws Figs. 8 to 20 of the paper into DIR, fig08.png and .svg and so on, from
# runs of examples/scenes/{symmetric,asymmetric,drop}_phi{1e-4,1e-2,1}.ini in directories of these
# names in DIR.
set -eu

scripts=$(dirname "$0")/figures
[ $# -eq 1 ] || { echo "usage: paper_figures.sh DIR" >&2; exit 2; }
. "$scripts/draw.sh"

dir=$1
symmetric='symmetric stress barriers'
asymmetric='asymmetric stress barriers'
drop='stress drop'
low='φ = 10⁻⁴' middle='φ = 10⁻²' high='φ = 1'
LABELS="\"$low\" \"$middle\" \"$high\"" AXES= PANELS=
export LABELS AXES PANELS TITLE

# three SCRIPT FIGURE GROUP: one figure of the three runs of a group.
three() {
    draw "$1" "$dir/$2" "$dir/$3_phi1e-4" "$dir/$3_phi1e-2" "$dir/$3_phi1"
}

# footprints FIRST GROUP NAME: the figures FIRST, FIRST + 1, FIRST + 2, one for each phi.
footprints() {
    n=$1
    for phi in "1e-4 $low" "1e-2 $middle" "1 $high"; do
        TITLE="Fig. $n. Footprints, $3, ${phi#* }"
        draw footprint "$dir/fig$n" "$dir/$2_phi${phi%% *}"
        n=$((n + 1))
    done
}

TITLE="Fig. 8. Footprints, $symmetric"
three footprint fig08 symmetric
TITLE="Fig. 9. Width and fluid pressure, $symmetric, $middle"
draw lines "$dir/fig09" "$dir/symmetric_phi1e-2"
TITLE="Fig. 10. Histories, $symmetric"
three history fig10 symmetric

footprints 11 asymmetric "$asymmetric"
TITLE="Fig. 14. Width and fluid pressure, $asymmetric, $middle"
draw lines "$dir/fig14" "$dir/asymmetric_phi1e-2"
TITLE="Fig. 15. Histories, $asymmetric"
three history fig15 asymmetric

footprints 16 drop "$drop"
TITLE="Fig. 19. Width and fluid pressure along y at x = 0, $drop, $middle" AXES=y
draw lines "$dir/fig19" "$dir/drop_phi1e-2"
TITLE="Fig. 20. Histories, $drop" PANELS='width efficiency'
three history fig20 drop

echo "figures in $dir: fig08 to fig20 (.png, .svg)"
