# call: the ARG1-th of the runs is the one to draw from.
run = word(runs, int(ARG1))
load run."/plot.gp"
units = strlen(override) ? override : units

si = units eq "SI"
x_label = si ? "x (m)" : "x"
y_label = si ? "y (m)" : "y"
t_label = si ? "t (s)" : "t"
length_unit = si ? " (m)" : ""
w_label = si ? "width (mm)" : "width"
p_label = si ? "fluid pressure (MPa)" : "fluid pressure"
w_scale = si ? 1e3 : 1
p_scale = si ? 1e-6 : 1
stress_text(i) = sprintf(si ? "σ = %g MPa" : "σ = %g", p_scale * number(sigma, i))
