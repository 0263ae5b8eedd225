#ifndef TESTS_CLOTH_CONTACT_SHAPES_H
#define TESTS_CLOTH_CONTACT_SHAPES_H

#include "cloth/contact/shape.h"
#include "tests/support/random.h"

#include <math.h>

/* Random numbers, points and convex shapes: the same in each run. */

static inline void pick_point(double reach, phys_vec *x)
{
    *x = (phys_vec){uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach), 0};
}

static inline double length(const phys_vec *a)
{
    return sqrt(phys_dot(a, a));
}

static inline void make_unit(size_t n, double *value)
{
    double square = 0;
    for (size_t i = 0; i < n; i++)
        square += value[i] * value[i];
    for (size_t i = 0; i < n; i++)
        value[i] /= sqrt(square);
}

/* Near the origin, its lengths from `least` to 1 m, with two key frames of its motion to be. */
static inline void pick_shape(uint32_t kind, double least, struct contact_shape *shape)
{
    double *value = shape->value;
    *shape = (struct contact_shape){.kind = kind, .n = 2};
    for (const struct contact_parameter *p = contact_kinds[kind]->parameter; p->name; p++) {
        const size_t n = contact_role_size(p->role);
        const bool is_length = p->role == CONTACT_LENGTH || p->role == CONTACT_LENGTHS;
        for (size_t i = 0; i < n; i++)
            value[i] = is_length ? uniform(least, 1) : uniform(-1, 1);
        if (p->role == CONTACT_DIRECTION || p->role == CONTACT_ROTATION)
            make_unit(n, value);
        value += n;
    }
}

/* Where it is then, in any way. */
static inline void pick_turn(double rotate[4])
{
    for (int i = 0; i < 4; i++)
        rotate[i] = uniform(-1, 1);
    make_unit(4, rotate);
}

#endif
