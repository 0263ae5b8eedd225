/* Subnormal numbers are zero between phys_tiny_off and phys_tiny_back, and nowhere else. */
#include "cloth/physics/tiny.h"
#include "cloth/physics/vec.h"
#include "tests/support/unit.h"

#include <stdio.h>

#if defined(__x86_64__) || defined(__aarch64__)

/* Their results, in scalars and in vectors: volatile and by a call, so that no compiler knows or
 * moves it. */
__attribute__((noinline)) static double scaled(double value, double factor)
{
    volatile double a = value, b = factor;
    return a * b;
}
__attribute__((noinline)) static double vector_scaled(double value, double factor)
{
    volatile phys_vec a = {value, value, value, value};
    const phys_vec product = a * scaled(factor, 1);
    return product[0] + product[1] + product[2] + product[3];
}

UNIT_TEST(made_and_met_as_zero)
{
    const double least = 2.3e-308;
    for (int again = 0; again < 2; again++) {
        const phys_tiny before = phys_tiny_off();
        ck_assert(!(scaled(least, 0.5) > 0));
        ck_assert(!(vector_scaled(least, 0.5) > 0));
        ck_assert(scaled(least, 2) > least);
        phys_tiny_back(before);
        ck_assert(scaled(least, 0.5) > 0);
        ck_assert(vector_scaled(least, 0.5) > 0);
    }
    const double subnormal = scaled(least, 0.5);
    const phys_tiny before = phys_tiny_off();
    const double met = scaled(subnormal, 4);
    phys_tiny_back(before);
    ck_assert(!(met > 0));
    ck_assert(scaled(subnormal, 4) > 0);
}

#else

int main(void)
{
    puts("1..0 # SKIP this processor has no such switch");
    return 77;
}

#endif
