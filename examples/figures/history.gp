# Half-length, height, width at the source and efficiency against time.
load system("echo \"$SCRIPTS\"")."/common.gp"
call scripts."/canvas.gp" "1100" "860"

history = run."/history.csv"
length_unit = si ? " (m)" : ""
set multiplot layout 2, 2 margins 0.085, 0.97, 0.08, 0.92 spacing 0.1, 0.1 \
    title "History of ".scene.unit_note noenhanced
set tics out nomirror
set border 3
set grid lt 1 lw 0.5 lc rgb "#d0d0d0"
set xlabel t_label
set xrange [0:*]
set yrange [0:*]
set key bottom right
set ylabel "half-length along x".length_unit
plot history using "t":(0.5 * (column("x_max") - column("x_min"))) with lines lw 2 lc rgb "#1f4e8c" title "through the source", \
    '' using "t":(0.5 * (column("extent_x_max") - column("extent_x_min"))) with lines lw 2 lc rgb "#d95f02" dt 2 title "whole footprint"
set ylabel "height along y".length_unit
plot history using "t":(column("y_max") - column("y_min")) with lines lw 2 lc rgb "#1f4e8c" title "through the source", \
    '' using "t":(column("extent_y_max") - column("extent_y_min")) with lines lw 2 lc rgb "#d95f02" dt 2 title "whole footprint"
unset key
set ylabel "width at the source".(si ? " (mm)" : "")
plot history using "t":(w_scale * column("width_source")) with lines lw 2 lc rgb "#1f4e8c"
set yrange [0:1]
set ylabel "efficiency"
plot history using "t":"efficiency" with lines lw 2 lc rgb "#1f4e8c"
unset multiplot
