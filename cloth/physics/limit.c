/* Limits of the step, for reports only: the motion does not use them. */
#include "cloth/physics/limit.h"

#include <complex.h>
#include <math.h>

double phys_limit_euler(double omega, double a)
{
    const double square = omega * omega, over = a * a - 4 * square;
    const double swings = a / square; /* determinant 1 - h a + h^2 omega^2 <= 1 */
    if (over <= 0)
        return swings;
    return fmin(swings, 4 / (a + sqrt(over))); /* 1 + trace + determinant >= 0 */
}

double phys_limit_symplectic(double omega, double a)
{
    return 4 / (a + sqrt(a * a + 4 * omega * omega)); /* 4 - 2 h a - h^2 omega^2 >= 0 */
}

double phys_limit_verlet(double omega, double a)
{
    return 2 / (a + sqrt(a * a + omega * omega)); /* 4 - 4 h a - h^2 omega^2 >= 0 */
}

/* Bisects along the ray of the mode's faster root, where the region of stability ends once. */
double phys_limit_rk4(double omega, double a)
{
    const double complex root = csqrt(a * a / 4 - omega * omega), fast = -a / 2 - root;
    double low = 2 / cabs(fast), high = 4 / cabs(fast);
    for (int i = 0; i < 60; i++) {
        const double middle = (low + high) / 2;
        const double complex z = middle * fast;
        const double complex grown = 1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)));
        if (cabs(grown) <= 1)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* By powers: the trace of m^128 is at most three times the largest eigenvalue's 128th power. */
double phys_largest(const double m[6])
{
    double largest = m[0] + m[1] + m[2], power = 1;
    if (!(largest > 0))
        return 0;
    double xx = m[0] / largest, yy = m[1] / largest, zz = m[2] / largest;
    double xy = m[3] / largest, yz = m[4] / largest, zx = m[5] / largest;
    for (int i = 0; i < 7; i++) {
        const double a = xx * xx + xy * xy + zx * zx, b = xy * xy + yy * yy + yz * yz,
                     c = zx * zx + yz * yz + zz * zz, d = xx * xy + xy * yy + zx * yz,
                     e = xy * zx + yy * yz + yz * zz, f = xx * zx + xy * yz + zx * zz;
        const double trace = a + b + c;
        power /= 2;
        largest *= pow(trace, power);
        xx = a / trace;
        yy = b / trace;
        zz = c / trace;
        xy = d / trace;
        yz = e / trace;
        zx = f / trace;
    }
    return largest;
}
