# What all figures share: the run, units, colours, the terminal. From the environment: RUN, SCRIPTS,
# FORMAT, FIGURE, UNITS.
run = system("echo \"$RUN\"")
scripts = system("echo \"$SCRIPTS\"")
format = system("echo $FORMAT")
figure = system("echo $FIGURE")
load run."/plot.gp"
override = system("echo $UNITS")
if (strlen(override)) units = override

si = units eq "SI"
x_label = si ? "x (m)" : "x"
y_label = si ? "y (m)" : "y"
t_label = si ? "t (s)" : "t"
w_label = si ? "width (mm)" : "width"
p_label = si ? "fluid pressure (MPa)" : "fluid pressure"
w_scale = si ? 1e3 : 1
p_scale = si ? 1e-6 : 1
unit_note = si ? "" : ", in the scene's units"
time_text(i) = "t = ".word(times, i).(si ? " s" : "")

# The numbers of a list in plot.gp are strings.
number(list, i) = real(word(list, i))
table(stem, i) = sprintf("%s/%s_%03d.csv", run, stem, i)

# The colour of a place in the parametric triangle: red k, green m-tilde, blue m.
byte(n) = int(255 * (n < 0 ? 0 : n > 1 ? 1 : n) + 0.5)
rgb(k, mt, m) = 65536 * byte(k) + 256 * byte(mt) + byte(m)

set datafile separator ","
set datafile columnheaders
set encoding utf8

