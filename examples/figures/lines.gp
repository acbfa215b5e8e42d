# Width and pressure along x and y through the source at the output times.
load system("echo \"$SCRIPTS\"")."/common.gp"
call scripts."/canvas.gp" "1100" "860"
load scripts."/times.gp"

set multiplot layout 2, 2 margins 0.085, 0.97, 0.15, 0.92 spacing 0.1, 0.1 \
    title "Width and fluid pressure through the source, ".scene.unit_note noenhanced
set tics out nomirror
set border 3
set grid lt 1 lw 0.5 lc rgb "#d0d0d0"
unset key
set xlabel x_label
set ylabel w_label
set yrange [0:*]
plot for [i = 1:outputs] table("line_x", i) using "x":(w_scale * column("width")) with lines lw 2 lc palette frac shade(i)

set xlabel y_label
do for [i = 1:words(interfaces)] {
    set arrow i from number(interfaces, i), graph 0 to number(interfaces, i), graph 1 nohead lw 1.5 lc rgb "black" dt 2
}
plot for [i = 1:outputs] table("line_y", i) using "y":(w_scale * column("width")) with lines lw 2 lc palette frac shade(i)

unset arrow
set yrange [*:*]
set xlabel x_label
set ylabel p_label
plot for [i = 1:outputs] table("line_x", i) using "x":(p_scale * column("pressure")) with lines lw 2 lc palette frac shade(i)

set xlabel y_label
do for [i = 1:words(interfaces)] {
    set arrow i from number(interfaces, i), graph 0 to number(interfaces, i), graph 1 nohead lw 1.5 lc rgb "black" dt 2
}
plot for [i = 1:outputs] table("line_y", i) using "y":(p_scale * column("pressure")) with lines lw 2 lc palette frac shade(i)

# The key has a strip of its own.
unset arrow
unset border
unset tics
unset grid
unset xlabel
unset ylabel
set lmargin at screen 0.05
set rmargin at screen 0.95
set bmargin at screen 0
set tmargin at screen 0.08
set xrange [0:1]
set yrange [0:1]
set key center center horizontal samplen 2 width 1
plot for [i = 1:outputs] NaN with lines lw 2 lc palette frac shade(i) title named(i), \
    words(interfaces) ? NaN : 1 / 0 with lines lw 1.5 lc rgb "black" dt 2 title words(interfaces) ? "interface of layers" : ""
unset multiplot
