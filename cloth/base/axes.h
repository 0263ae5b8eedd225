#ifndef CLOTH_BASE_AXES_H
#define CLOTH_BASE_AXES_H

/* Eigenvalues and eigenvectors of a symmetric 3 x 3 matrix by Jacobi's rotations (12 sweeps over
 * the pairs 01, 02, 12), + - * / and sqrt only. m becomes diagonal: eigenvalue k is m[k][k], in no
 * order; axes: row k is its direction, of length 1. Entries beside the diagonal of at most `small`
 * count as zero: where eigenvalues are equal but for rounding, this keeps the directions from being
 * turned by it. Local. */
void cloth_axes(double small, double m[3][3], double axes[3][3]);

#endif
