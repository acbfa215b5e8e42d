# The fracture at the output times: front, survey cells in their colours, interfaces of the layers.
load system("echo \"$SCRIPTS\"")."/common.gp"

x_low = y_low = 1e300
x_high = y_high = -1e300
do for [i = 1:outputs] {
    stats table("front", i) using "y":"x" name "F" nooutput
    x_low = F_min_y < x_low ? F_min_y : x_low
    x_high = F_max_y > x_high ? F_max_y : x_high
    y_low = F_min_x < y_low ? F_min_x : y_low
    y_high = F_max_x > y_high ? F_max_x : y_high
}
# Each front is named inside its rightmost point, where there is room.
do for [i = 1:outputs * (outputs > 1 && outputs <= 10)] {
    stats table("front", i) using "y":"x" name "F" nooutput
    if (F_max_y - F_min_y > 0.1 * (x_high - x_low)) {
        set label i word(times, i).(si ? " s" : "") at F_max_y - 3 * number(cell_dx, i), F_pos_max_y right boxed front
    }
}
gap = 0.06 * (x_high - x_low > y_high - y_low ? x_high - x_low : y_high - y_low)
x_low = x_low - gap
x_high = x_high + gap
y_low = y_low - gap
y_high = y_high + gap

# A plot of at most 900 x 900 pixels at the true ratio; the triangle stands at its right.
aspect = (y_high - y_low) / (x_high - x_low)
plot_w = aspect > 1 ? 900 / aspect : 900
plot_w = plot_w < 400 ? 400 : plot_w
plot_h = aspect > 1 ? 900 : 900 * aspect
plot_h = plot_h < 260 ? 260 : plot_h
full_w = int(plot_w + 390)
full_h = int(plot_h + 130)
call scripts."/canvas.gp" sprintf("%d", full_w) sprintf("%d", full_h)

set multiplot title "Footprint of ".scene." at ".(outputs > 1 ? "the output times" : time_text(1)).unit_note noenhanced
set lmargin at screen 80.0 / full_w
set rmargin at screen (80.0 + plot_w) / full_w
set bmargin at screen 75.0 / full_h
set tmargin at screen (75.0 + plot_h) / full_h
set size ratio -1
set xrange [x_low:x_high]
set yrange [y_low:y_high]
set xlabel x_label
set ylabel y_label
set tics out nomirror
unset key
do for [i = 1:words(interfaces)] {
    if (number(interfaces, i) > y_low && number(interfaces, i) < y_high) {
        set arrow from x_low, number(interfaces, i) to x_high, number(interfaces, i) nohead lw 3 lc rgb "black"
    }
}
set style textbox opaque noborder fillcolor rgb "white" margins 0.5, 0.5
set label 100 "" at source_x, source_y point pt 2 ps 1 lw 1.5 lc rgb "black" front
set style fill solid 1.0 border rgb "#555555"
plot for [i = 1:outputs] table("survey", i) using "x":"y":(0.5 * number(cell_dx, i)):(0.5 * number(cell_dy, i)):(rgb(column("N_k"), column("N_mt"), column("N_m"))) with boxxyerror lw 0.4 lc rgb variable, \
    for [i = 1:outputs] for [l = 0:number(loops, i) - 1] table("front", i) using (number(loops, i) < 2 || column("loop") == l ? column("x") : NaN):"y" with lines lw 1.5 lc rgb "black"

unset label
unset arrow
unset xlabel
unset ylabel
set lmargin at screen (full_w - 270.0) / full_w
set rmargin at screen (full_w - 10.0) / full_w
set bmargin at screen 75.0 / full_h
set tmargin at screen 255.0 / full_h
side = 0.3
load scripts."/colours.gp"
unset multiplot
