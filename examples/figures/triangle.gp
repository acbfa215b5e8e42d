# The parametric triangle with the survey cells of the last output time.
load system("echo \"$SCRIPTS\"")."/common.gp"
call scripts."/canvas.gp" "700" "600"
set multiplot title "Survey cells in the parametric triangle\n".scene.", ".time_text(outputs) noenhanced
set lmargin at screen 0.02
set rmargin at screen 0.98
set bmargin at screen 0.02
set tmargin at screen 0.9
side = 0.14
load scripts."/colours.gp"
plot table("survey", outputs) using "triangle_x":"triangle_y" with points pt 7 ps 0.9 lc rgb "white", \
    '' using "triangle_x":"triangle_y" with points pt 6 ps 0.9 lw 1.2 lc rgb "black"
unset multiplot
