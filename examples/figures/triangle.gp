# The parametric triangle with the survey cells of the last output time.
load system("echo \"$SCRIPTS\"")."/common.gp"
call scripts."/canvas.gp" "700" "600"
set multiplot title title_or("Survey cells in the parametric triangle\n".scene.", ".time_text(outputs)) noenhanced font ",13"
set lmargin at screen 0.02
set rmargin at screen 0.98
set bmargin at screen 0.02
set tmargin at screen 0.9
side = 0.14
note = ""
point_size = 0.9
load scripts."/colours.gp"
unset multiplot
