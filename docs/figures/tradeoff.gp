# tradeoff.png of docs/speed.md, from the table of bench_tradeoff:
#     build/bin/bench_tradeoff csv >out/tradeoff.csv
#     CSV=out/tradeoff.csv gnuplot docs/figures/tradeoff.gp >docs/figures/tradeoff.png
csv = system("echo $CSV")
set terminal pngcairo size 1240, 760 font "sans,12" background "white"
set encoding utf8
set datafile separator ","
set datafile columnheaders
set multiplot layout 2, 3 margins 0.065, 0.985, 0.085, 0.955 spacing 0.06, 0.125

scenes = "'radial m' 'radial k' 'radial m-tilde' 'radial middle' symmetric"
titles = "'Viscosity (M)' 'Toughness (K)' 'Leak-off (M-tilde)' 'Middle of the triangle' 'Three layers to 900 s'"
colours = "#1b6ca8 #d1661b #2e8b57"
is_scene(n) = strcol(1) eq word(scenes, n)
mesh(n, k) = n < 5 ? word("10 20 40", k) : word("11 21 31", k)
pick(n, k, column) = is_scene(n) && strcol(2) eq mesh(n, k) ? column : NaN

set logscale xy
set format x "10^{%T}"
set format y "%g"
set xrange [0.01:5]
set yrange [0.01:2]
set grid xtics ytics lc rgb "#e4e4e4" lt 1
set border 3
set tics out nomirror
set key top right samplen 1.5 spacing 1.05 width -1
set datafile missing NaN
do for [n = 1:5] {
    set title word(titles, n) offset 0, -0.6
    set xlabel n > 2 ? "CPU time, s" : "" offset 0, 0.4
    set ylabel n == 1 || n == 4 ? "largest error, %" : "" offset 1.2, 0
    unit = n < 5 ? " cells per radius" : ""
    plot for [k = 1:3] csv using (pick(n, k, column("seconds"))):(column("worst")) \
            with lines lw 1.5 lc rgb word(colours, k) notitle, \
        for [k = 1:3] csv using (pick(n, k, column("seconds"))):(column("worst")) \
            with points pt 6 ps 1.1 lw 1.5 lc rgb word(colours, k) \
            title (n < 5 ? "" : "H/").mesh(n, k).unit, \
        for [k = 1:3] csv using (column("pareto") > 0 ? pick(n, k, column("seconds")) : NaN):(column("worst")) \
            with points pt 7 ps 1.1 lc rgb word(colours, k) notitle, \
        for [k = 1:3] csv using (pick(n, k, column("seconds"))):(column("worst")):(sprintf("%d", column("level"))) \
            with labels offset 0, 0.8 font "sans,10" tc rgb word(colours, k) notitle
}

unset border
unset tics
unset xlabel
unset ylabel
unset title
unset grid
unset logscale
set key off
set xrange [0:1]
set yrange [0:1]
set label 1 "1 .. 5: the level" at 0, 0.80 left
set label 2 "filled: no other point of the panel is" at 0, 0.70 left
set label 3 "both faster and more accurate" at 0, 0.62 left
set label 4 "error: the largest of those of the radius" at 0, 0.50 left
set label 5 "(half-length), the width at the source" at 0, 0.42 left
set label 6 "and the efficiency" at 0, 0.34 left
plot NaN notitle
unset multiplot
