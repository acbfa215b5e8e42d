# Line colours of the output times, early to late, and which of them the key names.
set palette defined (0 "#a5c8e4", 0.35 "#4a90c2", 0.7 "#1f4e8c", 1 "#0a1a3c")
unset colorbox
shade(i) = outputs > 1 ? (i - 1.0) / (outputs - 1) : 1
set cbrange [0:1]
stride = (outputs + 9) / 10
named(i) = (outputs - i) % stride == 0 ? time_text(i) : ""
