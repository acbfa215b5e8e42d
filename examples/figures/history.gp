# Half-length, height, width at the source and efficiency against time; PANELS: of these. One run:
# also the extents of the whole footprint; several: a curve for each.
load system("echo \"$SCRIPTS\"")."/common.gp"
if (!strlen(panels)) panels = "length height width efficiency"
two_rows = words(panels) > 2
call scripts."/canvas.gp" "1100" (two_rows ? "900" : "520")

ylabel_of(panel) = panel eq "length" ? "half-length along x".length_unit \
    : panel eq "height" ? "height along y".length_unit \
    : panel eq "width" ? "width at the source".(si ? " (mm)" : "") : "efficiency"
through(panel) = panel eq "length" ? 0.5 * (column("x_max") - column("x_min")) \
    : panel eq "height" ? column("y_max") - column("y_min") \
    : panel eq "width" ? w_scale * column("width_source") : column("efficiency")
whole(panel) = panel eq "length" ? 0.5 * (column("extent_x_max") - column("extent_x_min")) \
    : panel eq "height" ? column("extent_y_max") - column("extent_y_min") : NaN
history(r) = word(runs, r)."/history.csv"
colour(r) = word("#0072b2 #009e73 #d55e00 #cc79a7 #e69f00 #56b4e9", (r - 1) % 6 + 1)
name(r) = several ? label_of(r) : "through the source"

set multiplot layout (two_rows ? 2 : 1), 2 margins 0.085, 0.97, (two_rows ? 0.15 : 0.25), (two_rows ? 0.92 : 0.88) spacing 0.1, 0.1 \
    title title_or("History of ".scene) noenhanced font ",13"
set tics out nomirror
set border 3
set grid lt 1 lw 0.5 lc rgb "#d0d0d0"
set xlabel t_label
set autoscale xfixmax
set xrange [0:*]
unset key
do for [panel in panels] {
    set ylabel ylabel_of(panel)
    if (panel eq "efficiency") { set yrange [0:1] } else { set yrange [0:*] }
    plot for [r = 1:words(runs)] history(r) using "t":(through(panel)) with lines lw 2 lc rgb colour(r), \
        for [r = 1:several ? 0 : 1] history(r) using "t":(whole(panel)) with lines lw 2 lc rgb colour(3) dt 2
}

load scripts."/strip.gp"
plot for [r = 1:words(runs)] NaN with lines lw 2 lc rgb colour(r) title name(r) noenhanced, \
    for [r = 1:several ? 0 : 1] NaN with lines lw 2 lc rgb colour(3) dt 2 title "whole footprint"
unset multiplot
