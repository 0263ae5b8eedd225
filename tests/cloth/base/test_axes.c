/* Directions and eigenvalues of symmetric 3 x 3 matrices. */
#include "cloth/base/axes.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>

/* The sum of value[k] axis[k] axis[k]' less m, and axes times axes' less the unit matrix. */
static double wrong_by(const double m[3][3], const double value[3][3], const double axis[3][3])
{
    double worst = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double sum = -m[i][j], product = i == j ? -1 : 0;
            for (int k = 0; k < 3; k++) {
                sum += value[k][k] * axis[k][i] * axis[k][j];
                product += axis[i][k] * axis[j][k];
            }
            worst = fmax(worst, fmax(fabs(sum), fabs(product)));
        }
    return worst;
}

UNIT_TEST(are_those_of_the_matrix)
{
    static const double MATRIX[][3][3] = {{{2, -1, 0.5}, {-1, 3, 0.25}, {0.5, 0.25, -1}},
                                          {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
                                          {{1, 1e-9, 0}, {1e-9, 1, 0}, {0, 0, 1e-6}}};
    for (size_t i = 0; i < sizeof MATRIX / sizeof *MATRIX; i++) {
        double m[3][3], axes[3][3];
        memcpy(m, MATRIX[i], sizeof m);
        cloth_axes(1e-300, m, axes);
        ck_assert_double_le(wrong_by(MATRIX[i], (const double(*)[3])m, (const double(*)[3])axes),
                            1e-14);
        ck_assert_double_le(fabs(m[0][1]) + fabs(m[0][2]) + fabs(m[1][2]), 1e-14);
    }
}

UNIT_TEST(small_entries_turn_nothing)
{
    const double moments[3][3] = {{1, 1e-17, 0}, {1e-17, 1, 0}, {0, 0, 0}};
    double m[3][3], axes[3][3];
    memcpy(m, moments, sizeof m);
    cloth_axes(2e-15, m, axes);
    ck_assert_double_eq(axes[0][0], 1);
    ck_assert_double_eq(axes[1][1], 1);
    memcpy(m, moments, sizeof m);
    cloth_axes(1e-300, m, axes);
    ck_assert_double_eq_tol(fabs(axes[0][0]), sqrt(0.5), 1e-15);
}
