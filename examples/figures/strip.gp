# The next plot of multiplot is a key alone, below the others.
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
set key center center horizontal samplen 3 width 1
