# Widens x_low .. x_high, y_low .. y_high to the run's fronts.
do for [i = 1:outputs] {
    stats table("front", i) using "y":"x" name "F" nooutput
    x_low = F_min_y < x_low ? F_min_y : x_low
    x_high = F_max_y > x_high ? F_max_y : x_high
    y_low = F_min_x < y_low ? F_min_x : y_low
    y_high = F_max_x > y_high ? F_max_x : y_high
}
