/* Energies against values worked out by hand. */
#include "cloth/physics/energy.h"
#include "tests/support/unit.h"

#include <math.h>

static const phys_vec X[3] = {{1, 2, 3, 0}, {4, 6, 3, 0}, {0, 0, 0, 0}};
static const double MASS[3] = {2, 3, 4}, GRAVITY[3] = {0, -10, 1};

UNIT_TEST(particles)
{
    const phys_vec load[3] = {{5, -20, 2, 0}, {0, -30, 3, 0}, {0, -40, 4, 0}};
    ck_assert_double_eq(phys_energy_weight(3, MASS, GRAVITY, X), 40 - 6 + 180 - 9);
    ck_assert_double_eq(phys_energy_load(3, MASS, GRAVITY, load, X), -5);
}

UNIT_TEST(springs)
{
    const uint32_t end[2][2] = {{0, 1}, {2, 0}};
    const double stiffness[2] = {10, 1}, damping[2] = {0}, length[2] = {3, 0.5};
    const struct phys_springs both = {2, end, stiffness, damping, length, 0},
                              one = {1, end, stiffness, damping, length, 0};
    const double second = 0.5 * (14 - sqrt(14.0) + 0.25);
    ck_assert_double_eq_tol(phys_energy_springs(&both, X, X), 0.5 * 10 * 4 + second, 1e-14);
    const phys_vec other[2] = {{0}, {1, 2, 4.5, 0}};
    ck_assert_double_eq(phys_energy_springs(&one, X, other), 0.5 * 10 * 2.25);
}
