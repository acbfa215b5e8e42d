# What all figures share: runs, units, colours, the terminal. From the environment: RUNS, their
# directories, each in quotes; SCRIPTS; FILE without its ending; FORMAT. And where they are set:
# TITLE; LABELS, what the runs are called where there are several; UNITS; AXES of lines; PANELS of
# history.
runs = system("echo \"$RUNS\"")
scripts = system("echo \"$SCRIPTS\"")
file = system("echo \"$FILE\"")
format = system("echo $FORMAT")
title = system("echo \"$TITLE\"")
labels = system("echo \"$LABELS\"")
override = system("echo $UNITS")
axes = system("echo $AXES")
panels = system("echo $PANELS")

several = words(runs) > 1
title_or(own) = strlen(title) ? title : own.(si ? "" : ", in the scene's units")
label_of(r) = r <= words(labels) ? word(labels, r) : word(runs, r)

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
set format "%h"
call scripts."/run.gp" "1"
