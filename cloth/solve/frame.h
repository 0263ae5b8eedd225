#ifndef CLOTH_SOLVE_FRAME_H
#define CLOTH_SOLVE_FRAME_H

#include "cloth/physics/vec.h"

#include <stddef.h>

/* Places of rows at rest for the coarse space (cloth/solve/coarse.h): the functions 1 u v of a
 * patch, and those of a group in terms of its patches' functions. Pure functions. */

/* The two axes in which a cloud of points is largest, each divided by its extent; zero without one.
 * Extents are roots of eigenvalues. moment: the cloud's second moment about its centre, m^2. */
void solve_axes(double moment[3][3], phys_vec axis[2]);

/* A point of the cloud is about centre + u extent[0] + v extent[1], m. u and v are its distances
 * from the centre along the axes, in extents: 1 in the mean square. */
struct solve_frame {
    double n; /* points */
    double centre[3], extent[2][3];
};

/* The frame of n points, or of n frames, each weighted by its points. All is zero without points.
 */
struct solve_frame solve_frame_of(size_t n, const phys_vec *position);
struct solve_frame solve_frame_of_group(size_t n, const struct solve_frame *frame);

/* The functions 1 U V of a group on a part, in terms of the part's own: function k is the sum of
 * to[3 a + k] times function a. It is exact on a flat part. */
void solve_lift(const struct solve_frame *part, const struct solve_frame *group, double to[9]);

#endif
