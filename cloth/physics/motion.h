#ifndef CLOTH_PHYSICS_MOTION_H
#define CLOTH_PHYSICS_MOTION_H

#include "cloth/physics/vec.h"

#include <stddef.h>

/* Rigid motion by key frames: x(t) = R(t) (x0 - about) + about + T(t). Between two keys T is
 * interpolated linearly, and so are the quaternions of R, along the shorter way, then normalised;
 * before the first key and after the last nothing moves. Pure functions; nothing is allocated. */
struct phys_key {
    double time;         /* s, ascending */
    double translate[3]; /* T, m */
    double rotate[4];    /* w x y z, of length 1 */
};

/* A motion at one time. */
struct phys_pose {
    double turn[3][3];             /* R, row after row */
    double about[3], translate[3]; /* m */
};
void phys_pose_at(size_t n, const struct phys_key *keys, const double about[3], double time,
                  struct phys_pose *pose);

/* The place of a point that begins at x0; a direction, turned. to may be from. */
void phys_pose_point(const struct phys_pose *pose, const phys_vec *from, phys_vec *to);
void phys_pose_direction(const struct phys_pose *pose, const phys_vec *from, phys_vec *to);
/* Back from there. */
void phys_pose_back(const struct phys_pose *pose, const phys_vec *from, phys_vec *to);
void phys_pose_direction_back(const struct phys_pose *pose, const phys_vec *from, phys_vec *to);

#endif
