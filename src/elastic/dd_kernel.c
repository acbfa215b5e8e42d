#include "elastic/dd_kernel.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/*
 * The entry at offset (i, j), i >= j >= 1 up to rounding, of cells 1 by r. The four corner terms
 * (X^2 + Y^2)^(1/2) / (X Y) of (4.6) cancel far away. Here their difference is taken by hand, so
 * that all terms that are left to add have one sign. ll to uu are (1 + Y^2 / X^2)^(1/2) at the
 * corners, y first: l is the lower coordinate and u the upper one.
 */
static double kernel_off_axis(double i, double j, double r) {
    double xl = i - 0.5, xu = i + 0.5, yl = (j - 0.5) * r, yu = (j + 0.5) * r;
    double ll = sqrt(1 + (yl / xl) * (yl / xl)), lu = sqrt(1 + (yl / xu) * (yl / xu));
    double ul = sqrt(1 + (yu / xl) * (yu / xl)), uu = sqrt(1 + (yu / xu) * (yu / xu));
    double area = xl * xu;
    double front = (2 * i / area) * (2 * j * r * r / area);
    double above = yu / (uu + ul) + yl / (lu + ll);
    double below = (yl * uu + yu * lu) * (yl * ul + yu * ll);
    return -front * above / below / (8 * pi);
}

/* The entry at offset (i, 0), i >= 1, where the corners lie at y = -+ r / 2. */
static double kernel_on_axis(double i, double r) {
    double xl = i - 0.5, xu = i + 0.5, b = 0.5 * r;
    double area = xl * xu;
    double roots = sqrt(1 + (b / xu) * (b / xu)) + sqrt(1 + (b / xl) * (b / xl));
    return -(4 * b / area) * (i / area) / roots / (8 * pi);
}

/*
 * Lengths are in units of dx, so that nothing overflows. An offset above the diagonal is mirrored
 * about it, so that an exchange of the axes of cell and offset gives the same bits.
 */
double ilsai_dd_kernel(long i, long j, double dx, double dy) {
    double m = fabs((double)i), n = fabs((double)j);
    if (m * dx < n * dy || (m * dx == n * dy && dx < dy)) {
        double swap = m;
        m = n;
        n = swap;
        swap = dx;
        dx = dy;
        dy = swap;
    }
    double r = dy / dx;
    if (m == 0) {
        return sqrt(1 + r * r) / (pi * r) / dx;
    }
    return (n == 0 ? kernel_on_axis(m, r) : kernel_off_axis(m, n, r)) / dx;
}
