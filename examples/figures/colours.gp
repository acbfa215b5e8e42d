# Draws the parametric triangle: its colours, the names of its corners, and the survey cells of the
# run's last output time. Within multiplot. side: the room for the names at its left and right;
# note: what stands below.
unset border
unset tics
unset key
unset label
unset arrow
unset xlabel
unset ylabel
set size ratio -1
set xrange [-side:1 + side]
set yrange [-0.12:0.98]
root3 = sqrt(3.0)
tri_mt(x, y) = 2 * y / root3
tri_k(x, y) = x - y / root3
tri_m(x, y) = 1 - tri_k(x, y) - tri_mt(x, y)
inside(x, y) = tri_mt(x, y) >= 0 && tri_k(x, y) >= 0 && tri_m(x, y) >= 0 ? 255 : 0
set sample 300
set isosample 260
set label 101 "k, toughness" at 1, -0.07 center
set label 102 "m, viscosity" at 0, -0.07 center
set label 103 "m̃, leak-off" at 0.5, 0.93 center
set label 104 note at 0.5, -0.19 center noenhanced
set object 101 polygon from 0, 0 to 1, 0 to 0.5, root3 / 2 to 0, 0 front fillstyle empty border lc rgb "black" lw 1

# gnuplot 5.4 applies separator and header line to sampled points too.
set datafile separator whitespace
unset datafile columnheaders
plot sample [u = 0:1] [v = 0:0.87] '++' using 1:2:(255 * tri_k($1, $2)):(255 * tri_mt($1, $2)):(255 * tri_m($1, $2)):(inside($1, $2)) with rgbalpha
set datafile separator ","
set datafile columnheaders
unset label
unset object 101
plot table("survey", outputs) using "triangle_x":"triangle_y" with points pt 7 ps point_size lc rgb "white", \
    '' using "triangle_x":"triangle_y" with points pt 6 ps point_size lw 1.2 lc rgb "black"
