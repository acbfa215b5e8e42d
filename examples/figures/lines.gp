# Width and pressure along x and y through the source at the output times; AXES: of these.
load system("echo \"$SCRIPTS\"")."/common.gp"
load scripts."/times.gp"
if (!strlen(axes)) axes = "x y"
both = words(axes) > 1
call scripts."/canvas.gp" "1100" (both ? "860" : "520")

# Rows of width and pressure, columns of x and y of one scale; one axis: one row.
set multiplot layout (both ? 2 : 1), 2 margins 0.085, 0.97, (both ? 0.15 : 0.25), (both ? 0.92 : 0.88) spacing 0.1, 0.1 \
    title title_or("Width and fluid pressure through the source, ".scene) noenhanced font ",13"
set tics out nomirror
set border 3
set grid lt 1 lw 0.5 lc rgb "#d0d0d0"
unset key
do for [quantity in "width pressure"] {
    wide = quantity eq "width"
    scale = wide ? w_scale : p_scale
    set ylabel wide ? w_label : p_label
    low = 1e300
    high = -1e300
    set xrange [*:*]
    set yrange [*:*]
    do for [axis in axes] {
        do for [i = 1:outputs] {
            stats table("line_".axis, i) using (scale * column(quantity)) name "Q" nooutput
            low = Q_min < low ? Q_min : low
            high = Q_max > high ? Q_max : high
        }
    }
    set yrange [*<(wide ? 0 : low):high<*]
    do for [axis in axes] {
        set xlabel axis eq "x" ? x_label : y_label
        stats table("line_".axis, outputs) using axis name "R" nooutput
        do for [i = 1:axis eq "y" ? words(interfaces) : 0] {
            if (number(interfaces, i) < R_min || number(interfaces, i) > R_max) { continue }
            set arrow i from number(interfaces, i), graph 0 to number(interfaces, i), graph 1 nohead lw 1.5 lc rgb "black" dt 2
        }
        plot for [i = 1:outputs] table("line_".axis, i) using axis:(scale * column(quantity)) with lines lw 2 lc palette frac shade(i)
        unset arrow
    }
}

# The key has a strip of its own.
load scripts."/strip.gp"
plot for [i = 1:outputs] NaN with lines lw 2 lc palette frac shade(i) title named(i), \
    words(interfaces) ? NaN : 1 / 0 with lines lw 1.5 lc rgb "black" dt 2 title words(interfaces) ? "interface of layers" : ""
unset multiplot
