/* The order of rotations is fixed, so that all ranks find the same bits. */
#include "cloth/base/axes.h"

#include <math.h>
#include <string.h>

/* Makes entry (i, j) of m zero. */
static void base_axes_turn(double small, double m[3][3], double axes[3][3], int i, int j)
{
    if (fabs(m[i][j]) <= small)
        return;
    const double theta = (m[j][j] - m[i][i]) / (2 * m[i][j]);
    const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double a = m[k][i], b = m[k][j];
        m[k][i] = c * a - s * b;
        m[k][j] = s * a + c * b;
    }
    for (int k = 0; k < 3; k++) {
        const double a = m[i][k], b = m[j][k];
        m[i][k] = c * a - s * b;
        m[j][k] = s * a + c * b;
    }
    for (int k = 0; k < 3; k++) {
        const double a = axes[i][k], b = axes[j][k];
        axes[i][k] = c * a - s * b;
        axes[j][k] = s * a + c * b;
    }
}

void cloth_axes(double small, double m[3][3], double axes[3][3])
{
    const double start[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memcpy(axes, start, sizeof start);
    for (int sweep = 0; sweep < 12; sweep++) {
        base_axes_turn(small, m, axes, 0, 1);
        base_axes_turn(small, m, axes, 0, 2);
        base_axes_turn(small, m, axes, 1, 2);
    }
}

bool cloth_rotation(const double quaternion[4], double turn[3][3])
{
    const double *q = quaternion;
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double w = q[0] / length, x = q[1] / length, y = q[2] / length, z = q[3] / length;
    const double rows[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)},
    };
    memcpy(turn, rows, sizeof rows);
    return length > 0;
}
