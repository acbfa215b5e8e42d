# Draws the run's fronts, survey cells in their colours and layers over x_low .. x_high,
# y_low .. y_high. Within multiplot.
# Each front is named inside its rightmost point, where there is room, clear of the source's cross.
# stats leaves out what is not within the ranges.
set xrange [*:*]
set yrange [*:*]
before = source_x
do for [i = 1:outputs * (outputs > 1 && outputs <= 10)] {
    stats table("front", i) using "y":"x" name "F" nooutput
    if (F_max_y - before > (several ? 0.038 : 0.05) * (x_high - x_low)) {
        set label i word(times, i).(si && !several ? " s" : "") at F_max_y - 2.5 * number(cell_dx, i), F_pos_max_y right offset 0, 1 boxed front
    }
    before = F_max_y
}

set style textbox opaque noborder fillcolor rgb "white" margins 0.3, 0.3
set border
set size ratio -1
set xrange [x_low:x_high]
set yrange [y_low:y_high]
set xlabel x_label
set ylabel y_label
set xtics out nomirror
set ytics out nomirror
unset key

# A line at each interface; under it the stress of the layer below, over the last that of the top.
seen(i) = number(interfaces, i) > y_low && number(interfaces, i) < y_high
do for [i = 1:words(interfaces)] {
    if (seen(i)) {
        set arrow i from x_low, number(interfaces, i) to x_high, number(interfaces, i) nohead lw 2.5 lc rgb "black"
        set label 20 + 2 * i stress_text(i) at graph 0.993, first number(interfaces, i) right offset 0, -0.8 tc rgb "#555555"
        if (i == words(interfaces)) { set label 21 + 2 * i stress_text(i + 1) at graph 0.993, first number(interfaces, i) right offset 0, 0.8 tc rgb "#555555" }
    }
}
set label 100 "" at source_x, source_y point pt 2 ps 1 lw 1.5 lc rgb "black" front
set style fill solid 1.0 border rgb "#555555"
plot for [i = 1:outputs] table("survey", i) using "x":"y":(0.5 * number(cell_dx, i)):(0.5 * number(cell_dy, i)):(rgb(column("N_k"), column("N_mt"), column("N_m"))) with boxxyerror lw 0.4 lc rgb variable, \
    for [i = 1:outputs] for [l = 0:number(loops, i) - 1] table("front", i) using (number(loops, i) < 2 || column("loop") == l ? column("x") : NaN):"y" with lines lw 1.5 lc rgb "black"
unset label
unset arrow
