#ifndef CLOTH_BASE_AXES_H
#define CLOTH_BASE_AXES_H

#include <stdbool.h>

/* Finds eigenvalues and eigenvectors of a symmetric 3 x 3 matrix by Jacobi's rotations (12 sweeps
 * over the pairs 01, 02, 12), with + - * / and sqrt only. Makes m diagonal: eigenvalue k is
 * m[k][k], in no order. Row k of axes is its direction, of length 1. Entries beside the diagonal of
 * at most `small` count as zero. So rounding does not rotate the directions of eigenvalues that are
 * equal but for rounding. Local. */
void cloth_axes(double small, double m[3][3], double axes[3][3]);

/* The matrix of a rotation by a quaternion (w, x, y, z) of any length but 0; false: it has none. */
bool cloth_rotation(const double quaternion[4], double turn[3][3]);

#endif
