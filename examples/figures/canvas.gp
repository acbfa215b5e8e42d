# call: the terminal and the file of a figure of ARG1 x ARG2 pixels.
if (format eq "png") {
    set terminal pngcairo size ARG1, ARG2 font "sans,11" background "white"
} else {
    set terminal svg size ARG1, ARG2 font "sans,13" background "white" dynamic
}
set output file.".".format
