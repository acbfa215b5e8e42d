#include "flow/leakoff.h"

leakoff ilsai_leakoff_channel(double C_prime, double time, double dt, double trigger,
                              double spread) {
    double age = time - trigger;
    age = age > 0 ? age : 0;
    return (leakoff){ilsai_tip_cell_full_leakoff_step(C_prime, age, dt, spread), 0};
}

leakoff ilsai_leakoff_tip(double C_prime, tip_cell_velocity velocity, const tip_cell_front *front,
                          const tip_cell_history *path) {
    double volume = ilsai_tip_cell_leakoff_last(C_prime, velocity, front, path);
    return (leakoff){volume / (front->dx * front->dy), 0};
}
