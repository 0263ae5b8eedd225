/* No function of the C library but floor, which is exact. */
#include "cloth/physics/course.h"

#include <math.h>

double phys_course_at(size_t n, const struct phys_beat *beat, double time)
{
    size_t low = 0, high = n;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (beat[middle].time <= time)
            low = middle;
        else
            high = middle;
    }
    if (high == n || time <= beat[low].time)
        return beat[low].factor;
    const double part = (time - beat[low].time) / (beat[high].time - beat[low].time);
    return (1 - part) * beat[low].factor + part * beat[high].factor;
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
