/* No function of the C library but floor, which is exact. */
#include "cloth/physics/curve.h"

#include <math.h>

size_t phys_key_before(size_t n, const double *times, size_t stride, double time)
{
    size_t low = 0, high = n;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (times[stride * middle] <= time)
            low = middle;
        else
            high = middle;
    }
    return low;
}

double phys_curve_at(size_t n, const struct phys_curve_key *curve_key, double time)
{
    const size_t stride = sizeof *curve_key / sizeof(double);
    const struct phys_curve_key *key =
        curve_key + phys_key_before(n, &curve_key->time, stride, time);
    if (key + 1 == curve_key + n || time <= key->time)
        return key->factor;
    const double part = (time - key->time) / (key[1].time - key->time);
    return (1 - part) * key->factor + part * key[1].factor;
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

void phys_turn(double degrees, double *cosine, double *sine)
{
    const double quarters = floor(degrees / 90 + 0.5);
    const double turns = (degrees - 90 * quarters) / 360;
    const double half = phys_sine(turns / 2), s = phys_sine(turns), c = 1 - 2 * half * half;
    const int quarter = (int)(quarters - 4 * floor(quarters / 4));
    *cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
    *sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
}
