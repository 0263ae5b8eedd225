#ifndef CLOTH_VERIFY_ORIENT_H
#define CLOTH_VERIFY_ORIENT_H

/* Exact signs of determinants. Each coordinate is 0, or its magnitude is from VERIFY_LEAST to
 * VERIFY_MOST: then no product underflows or overflows. Local, pure. */

#define VERIFY_LEAST 0x1p-200
#define VERIFY_MOST  0x1p200

/* A coordinate that is too small becomes 0. */
static inline double verify_coordinate(double x)
{
    return x > -VERIFY_LEAST && x < VERIFY_LEAST ? 0 : x;
}

/* The sign of det [a - d, b - d, c - d]: 1 if a, b, c are clockwise as seen from d, 0 if the
 * four points lie in a plane, else -1. */
int verify_orient(const double a[3], const double b[3], const double c[3], const double d[3]);

/* The sign of det [a - c, b - c] in the coordinates i and j: 0 if the points lie on a line as
 * seen along the third axis. */
int verify_orient_seen(const double a[3], const double b[3], const double c[3], int i, int j);

#endif
