# The fracture at the output times: front, survey cells in their colours, layers; beside it the
# survey cells of the last time in the parametric triangle. Several runs stand under one another, at
# the same scale.
load system("echo \"$SCRIPTS\"")."/common.gp"

x_low = y_low = 1e300
x_high = y_high = -1e300
do for [r = 1:words(runs)] {
    call scripts."/run.gp" sprintf("%d", r)
    load scripts."/extent.gp"
}
gap = 0.06 * (x_high - x_low > y_high - y_low ? x_high - x_low : y_high - y_low)
x_low = x_low - gap
x_high = x_high + (words(interfaces) ? 2 * gap : gap)
y_low = y_low - gap
y_high = y_high + gap

# Plots of at most 900 x 900 pixels at the true ratio, room for their axes; triangles at their right.
aspect = (y_high - y_low) / (x_high - x_low)
plot_w = aspect > 1 ? 900 / aspect : 900
plot_w = plot_w < 400 ? 400 : plot_w
plot_h = aspect > 1 ? 900 : 900 * aspect
plot_h = plot_h < 260 ? 260 : plot_h
row_h = plot_h + (several ? 95 : 70)
full_w = int(plot_w + 420)
full_h = int(words(runs) * row_h + 60)
call scripts."/canvas.gp" sprintf("%d", full_w) sprintf("%d", full_h)

set multiplot title title_or("Footprint of ".scene." at ".(outputs > 1 ? "the output times" : time_text(1))) noenhanced font ",13"
side = 0.3
point_size = 0.7
do for [r = 1:words(runs)] {
    call scripts."/run.gp" sprintf("%d", r)
    bottom = (words(runs) - r) * row_h + 65.0
    set lmargin at screen 80.0 / full_w
    set rmargin at screen (80.0 + plot_w) / full_w
    set bmargin at screen bottom / full_h
    set tmargin at screen (bottom + plot_h) / full_h
    if (several) { set label 99 label_of(r).(si ? ", t in s beside the fronts" : "") at graph 0, 1 offset 0, 0.8 left noenhanced font ",12" }
    load scripts."/map.gp"

    set lmargin at screen (full_w - 300.0) / full_w
    set rmargin at screen (full_w - 10.0) / full_w
    set bmargin at screen bottom / full_h
    set tmargin at screen (bottom + 220.0) / full_h
    note = outputs > 1 ? "○ survey cells at ".time_text(outputs) : "○ survey cells"
    load scripts."/colours.gp"
}
unset multiplot
