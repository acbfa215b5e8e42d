# symmetric.png of README, from a run of examples/scenes/symmetric_phi1e-2.ini:
#     make demo && RUN=out/demo gnuplot docs/figures/symmetric.gp >docs/figures/symmetric.png
run = system("echo \"$RUN\"")
load run."/plot.gp"
table(stem, i) = sprintf("%s/%s_%03d.csv", run, stem, i)
byte(n) = int(255 * (n < 0 ? 0 : n > 1 ? 1 : n) + 0.5)
rgb(k, mt, m) = 65536 * byte(k) + 256 * byte(mt) + byte(m)

set terminal pngcairo size 1240, 430 font "sans,12" background "white"
set encoding utf8
set datafile separator ","
set datafile columnheaders
set multiplot

do for [i = 1:outputs] {
    stats table("front", i) using "y":"x" name "F" nooutput
    set label 10 + i word(times, i)." s" at F_max_y - 2.5, 0 right front
}

set lmargin at screen 0.055
set rmargin at screen 0.99
set bmargin at screen 0.135
set tmargin at screen 0.985
set size ratio -1
set xrange [-118:142]
set yrange [-37:37]
set xtics 20 out nomirror
set ytics 10 out nomirror
set xlabel "x (m)" offset 0, 0.5
set ylabel "y (m)" offset 1.5, 0
set border 3
unset key

do for [i = 1:words(interfaces)] {
    set arrow from -118, real(word(interfaces, i)) to 142, real(word(interfaces, i)) nohead lw 1 dt 2 lc rgb "#888888" back
}
set label "7.75 MPa" at 141, 12.5 right tc rgb "#666666"
set label "7 MPa" at 141, 0 right tc rgb "#666666"
set label "7.75 MPa" at 141, -12.5 right tc rgb "#666666"
set label 100 "" at source_x, source_y point pt 2 ps 1.2 lw 2 lc rgb "black" front
set style fill solid 1.0 noborder
plot for [i = 1:outputs] table("survey", i) using "x":"y":(0.5 * real(word(cell_dx, i))):(0.5 * real(word(cell_dy, i))):(rgb(column("N_k"), column("N_mt"), column("N_m"))) with boxxyerror lc rgb variable, \
    for [i = 1:outputs] table("front", i) using "x":"y" with lines lw 1.6 lc rgb "black"

# The parametric triangle (3.19), (3.20): what the colours mean.
unset arrow
unset label
unset xlabel
unset ylabel
unset tics
unset border
set lmargin at screen 0.84
set rmargin at screen 0.995
set bmargin at screen 0.70
set tmargin at screen 0.995
set xrange [-0.35:1.35]
set yrange [-0.25:1.02]
root3 = sqrt(3.0)
tri_mt(x, y) = 2 * y / root3
tri_k(x, y) = x - y / root3
tri_m(x, y) = 1 - tri_k(x, y) - tri_mt(x, y)
inside(x, y) = tri_mt(x, y) >= 0 && tri_k(x, y) >= 0 && tri_m(x, y) >= 0 ? 255 : 0
set label "toughness" at 1, -0.13 center
set label "viscosity" at 0, -0.13 center
set label "leak-off" at 0.5, 0.95 center
set sample 260
set isosample 220
set datafile separator whitespace
unset datafile columnheaders
plot sample [u = 0:1] [v = 0:0.87] '++' using 1:2:(255 * tri_k($1, $2)):(255 * tri_mt($1, $2)):(255 * tri_m($1, $2)):(inside($1, $2)) with rgbalpha
unset multiplot
