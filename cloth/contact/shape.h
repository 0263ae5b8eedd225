#ifndef CLOTH_CONTACT_SHAPE_H
#define CLOTH_CONTACT_SHAPE_H

#include "cloth/contact/view.h"
#include "cloth/physics/motion.h"
#include "cloth/physics/vec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Rigid shapes that cloth meets, still or moving by key frames. A shape is a row of a table of
 * kinds and the parameters that its kind has, or a body. Pure functions of + - * / and sqrt;
 * nothing is allocated. */

enum { CONTACT_VALUES = 12 };

/* m: squares of shorter lengths lose digits or vanish, so that no direction follows from them. */
#define CONTACT_TINY 1e-150

struct contact_shape {
    uint32_t kind;     /* row of contact_kinds */
    uint32_t first, n; /* key frames of its motion, among those of the scene; n 0: it is still */
    uint32_t body;   /* number of a body of the scene, from 1; 0: its parameters are all there is */
    double about[3]; /* m: the point that its motion rotates about */
    double friction; /* coefficient, >= 0: of contact that is certified */
    double thickness; /* m, >= 0: of contact, half of it on its side; 0: that of all contact */
    struct contact_view view; /* of a body that is met by maps (image.h); width 0: by its tree */
    double value[CONTACT_VALUES]; /* its parameters, one after the other as its kind lists them */
};

struct contact_image;

/* The places of a shape at the begin and at the end of a step, and its body. */
struct contact_pose {
    const struct contact_body *body; /* NULL: it is none */
    bool moves; /* else the poses are unused: the shape is where its parameters put it */
    struct phys_pose from, to;
    double begin, end;                 /* s: of the step */
    double rate;                       /* 1/s: 1 over the length of the step; 0: it has none */
    const struct contact_image *image; /* maps that are met in place of the body; NULL: none */
};

/* The point of a surface that is nearest to a given one. */
struct contact_hit {
    phys_vec normal;   /* the gradient of the gap, of length 1, out of the shape */
    phys_vec velocity; /* m/s: of the shape there, by the chord of its way in the step */
    double gap;        /* m: signed distance, below 0 inside */
};

/* The meaning of a parameter, which also sets its count of numbers. */
enum contact_role {
    CONTACT_POINT,     /* 3, m */
    CONTACT_DIRECTION, /* 3, of length 1 */
    CONTACT_LENGTH,    /* 1, m, > 0 */
    CONTACT_LENGTHS,   /* 3, m, > 0 */
    CONTACT_ROTATION   /* 4, quaternion w x y z of length 1 */
};
size_t contact_role_size(enum contact_role role);

struct contact_parameter {
    const char *name; /* in scenes and in scene.json */
    enum contact_role role;
};

/* A convex shape as distances and certificates take it: all points within a radius of its core. */
struct contact_core {
    struct phys_pose axes; /* of the core, its middle at their origin */
    double half[3];        /* m: half the size of the box that is the core, each 0 or more */
    double radius;         /* m */
    bool round;            /* the core is the cylinder in that box, along its first axis */
    bool endless;          /* the shape is all that is below the middle along the first axis */
};

/* A kind of shape: a file of this folder. */
struct contact_kind {
    const char *name;                          /* in scenes and in scene.json */
    const struct contact_parameter *parameter; /* ended by a name that is NULL */
    /* Fills gap and normal of n points (m), in the axes that the parameters are in; of bodies with
     * frames the velocity, too. body: NULL but for bodies. */
    void (*closest)(const double *value, const struct contact_body *body, size_t n,
                    const phys_vec *x, struct contact_hit *hit);
    /* True if the gaps of n points are all above 0: a cheap test, as most rows of a cloth touch no
     * shape. NULL: there is no cheaper way. */
    bool (*apart)(const double *value, const struct contact_body *body, size_t n,
                  const phys_vec *x);
    /* A box around it: its own axes and middle, half its size (m); the shape is star-shaped as seen
     * from there. NULL: the shape has no bounds, or is a body. */
    void (*around)(const double *value, struct phys_pose *axes, double half[3]);
    /* The shape itself, of a body the box around it; in the axes that the parameters are in. */
    void (*core)(const double *value, const struct contact_body *body, struct contact_core *core);
    bool round; /* pictures take for that box the cylinder in it, along its first axis */
};
extern const struct contact_kind contact_plane, contact_sphere, contact_box, contact_capsule,
    contact_cylinder, contact_body_kind;
extern const struct contact_kind *const contact_kinds[];
extern const uint32_t contact_n_kinds;

/* For kinds with an axis. A direction of length 1 across it, for points on it: all are as short a
 * way out. Axes about a point, the first one by the shortest rotation along a vector, which is not
 * zero or else leaves them as they are. */
void contact_aside(const phys_vec *axis, phys_vec *aside);
void contact_axes(const double point[3], const double along[3], struct phys_pose *axes);

/* The pose of a shape over a step between two times, s, without maps. keys, bodies: of the scene.
 */
void contact_pose_over(const struct contact_shape *shape, const struct phys_key *keys,
                       const struct contact_bodies *bodies, double from, double to,
                       struct contact_pose *pose);

/* Finds the hits of n points (m) at the end of the step. Beside maps the gap is INFINITY, and the
 * rest is meaningless. */
void contact_closest(const struct contact_shape *shape, const struct contact_pose *pose, size_t n,
                     const phys_vec *x, struct contact_hit *hit);

#endif
