/* The median of what was measured, and where it lies with 95 %. */
#include "tools/compare/compare.h"

#include <math.h>
#include <stdlib.h>

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* The largest k with P(fewer than k heads in n tosses) <= 0.025. */
static size_t rank_of_interval(size_t n)
{
    double term = pow(0.5, (double)n), sum = 0;
    size_t k = 0;
    while (k < n && sum + term <= 0.025) {
        sum += term;
        k++;
        term *= (double)(n - k + 1) / (double)k;
    }
    return k;
}

double compare_median(double *values, size_t n, double *low, double *high)
{
    if (!n)
        return *low = *high = NAN;
    qsort(values, n, sizeof *values, compare_doubles);
    size_t k = rank_of_interval(n);
    *low = values[k ? k - 1 : 0];
    *high = values[k ? n - k : n - 1];
    return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}
