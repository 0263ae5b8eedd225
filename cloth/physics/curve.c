/* No function of the C library but floor, which is exact. */
#include "cloth/physics/curve.h"

#include <math.h>

double phys_curve_at(size_t n, const struct phys_curve_key *curve_key, double time)
{
    size_t low = 0, high = n;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (curve_key[middle].time <= time)
            low = middle;
        else
            high = middle;
    }
    if (high == n || time <= curve_key[low].time)
        return curve_key[low].factor;
    const double part = (time - curve_key[low].time) / (curve_key[high].time - curve_key[low].time);
    return (1 - part) * curve_key[low].factor + part * curve_key[high].factor;
}

double phys_sine(double turns)
{
    enum { TERMS = 11 }; /* the next one is below 1e-18 */
    const double two_pi = 6.283185307179586;
    double t = turns - floor(turns + 0.5);
    if (t > 0.25)
        t = 0.5 - t;
    if (t < -0.25)
        t = -0.5 - t;
    const double x = two_pi * t, square = x * x;
    double sum = 1;
    for (int k = TERMS - 1; k > 0; k--)
        sum = 1 - square / (2 * k * (2 * k + 1)) * sum;
    return x * sum;
}
