/* A spring's values depend on the difference of its ends only, and swapping the ends changes signs
 * but no other bit. Springs are worked on in order, four at a time. */
#include "cloth/physics/spring.h"

#include "cloth/physics/detail/lanes.h"

/* ---- Four springs at once (detail/lanes.h) ---- */

struct four_springs {
    phys_vec k, c, rest;    /* N/m, kg/s, m */
    phys_vec length;        /* m */
    phys_vec inverse;       /* of the length, or 0 */
    struct phys_wide u, dv; /* direction from end 0 to end 1; difference of speeds, m/s */
};

/* The order of phys_dot, to the same bits. */
PHYS_INLINE void dot(const struct phys_wide *a, const struct phys_wide *b, phys_vec *y)
{
    *y = (a->c[0] * b->c[0] + a->c[2] * b->c[2]) + a->c[1] * b->c[1];
}

/* y of end 1 minus y of end 0. */
PHYS_INLINE void differences(const struct phys_springs *s, const struct phys_four *four,
                             const phys_vec *own, const phys_vec *other, struct phys_wide *d)
{
    phys_vec row[PHYS_WIDE], column[PHYS_WIDE];
    PHYS_UNROLL
    for (int i = 0; i < PHYS_WIDE; i++)
        row[i] = other[s->end[four->at[i]][1]] - own[s->end[four->at[i]][0]];
    phys_turn(row, column);
    PHYS_UNROLL
    for (int i = 0; i < 3; i++)
        d->c[i] = column[i];
}

/* All but dv. */
PHYS_INLINE void four_make(const struct phys_springs *s, const struct phys_four *four,
                           const phys_vec *x, const phys_vec *x_other, struct four_springs *springs)
{
    phys_vec square;
    struct phys_wide d;
    differences(s, four, x, x_other, &d);
    dot(&d, &d, &square);
    phys_sqrt(&square, &springs->length);
    phys_inverse(&springs->length, &springs->inverse);
    phys_wide_scale(&springs->inverse, &d, &springs->u);
    phys_take_numbers(four, s->stiffness, &springs->k);
    phys_take_numbers(four, s->damping, &springs->c);
    phys_take_numbers(four, s->length, &springs->rest);
}

/* Share t of the stiffness that acts across a spring. */
PHYS_INLINE void transverse(const struct four_springs *springs, int full, phys_vec *t)
{
    const phys_vec one = {1, 1, 1, 1}, none = {0};
    const phys_vec share = one - springs->rest * springs->inverse;
    const phys_mask longer = springs->length > (full == PHYS_FULL ? none : springs->rest);
    phys_choose(&longer, &share, &none, t);
    if (full != PHYS_ABSOLUTE)
        return;
    const phys_mask shorter = springs->length < springs->rest;
    const phys_mask half = springs->length + springs->length < springs->rest;
    const phys_vec turned = -share;
    phys_choose(&shorter, &turned, t, t);
    phys_choose(&half, &one, t, t);
}

/* k (l - L) + c (u . dv), the pull along u. */
PHYS_INLINE void pull_of(const struct four_springs *springs, const phys_vec *speed, phys_vec *pull)
{
    *pull = springs->k * (springs->length - springs->rest) + springs->c * *speed;
}

/* Adds to the rows of end 0 and, unless it is elsewhere, takes from those of end 1. */
PHYS_INLINE void add_rows(const struct phys_springs *s, const struct phys_four *four, int cut,
                          const struct phys_wide *add, phys_vec *y)
{
    const phys_vec column[PHYS_WIDE] = {add->c[0], add->c[1], add->c[2], {0}};
    phys_vec row[PHYS_WIDE];
    phys_turn(column, row);
    PHYS_UNROLL
    for (size_t i = 0; i < four->valid; i++) {
        y[s->end[four->at[i]][0]] += row[i];
        if (!cut)
            y[s->end[four->at[i]][1]] -= row[i];
    }
}

/* The ends of springs: end 1 is in arrays of another block, or in the same. */
struct where {
    const phys_vec *x, *v, *x_other, *v_other;
    int cut;
};

/* Prefetches springs beyond i, and the rows of x at their ends; springs inside a block go through
 * its rows in order. */
PHYS_INLINE void fetch(const struct phys_springs *s, size_t i, const struct where *at)
{
    if (!at->cut)
        phys_fetch(at->x + s->end[i][1], PHYS_FETCH, 0);
    phys_fetch(s->end + i, PHYS_FETCH, 0);
    phys_fetch(s->stiffness + i, PHYS_FETCH, 0);
    phys_fetch(s->damping + i, PHYS_FETCH, 0);
    phys_fetch(s->length + i, PHYS_FETCH, 0);
}

/* ---- Forces ---- */

PHYS_INLINE void force_four(const struct phys_springs *s, size_t first, size_t end,
                            const struct where *at, phys_vec *f)
{
    struct phys_four four;
    struct four_springs springs;
    struct phys_wide add;
    phys_vec speed, pull;
    phys_four_from(first, end, &four);
    four_make(s, &four, at->x, at->x_other, &springs);
    differences(s, &four, at->v, at->v_other, &springs.dv);
    dot(&springs.u, &springs.dv, &speed);
    pull_of(&springs, &speed, &pull);
    phys_wide_scale(&pull, &springs.u, &add);
    add_rows(s, &four, at->cut, &add, f);
}

PHYS_INLINE void force_all(const struct phys_springs *s, const struct where *at, phys_vec *f)
{
    const size_t whole = s->n - s->n % PHYS_WIDE;
    for (size_t i = 0; i < whole; i += PHYS_WIDE) {
        fetch(s, i, at);
        force_four(s, i, i + PHYS_WIDE, at, f);
    }
    if (whole < s->n)
        force_four(s, whole, s->n, at, f);
}

PHYS_KERNEL(phys_springs_force,
            (const struct phys_springs *springs, const phys_vec *x, const phys_vec *v,
             const phys_vec *x_other, const phys_vec *v_other, phys_vec *f),
            (springs, x, v, x_other, v_other, f))
{
    const struct where inner = {x, v, x, v, 0}, cut = {x, v, x_other, v_other, 1};
    if (x_other)
        force_all(springs, &cut, f);
    else
        force_all(springs, &inner, f);
}

/* ---- Matrix and right side ---- */

/* Parts of the matrix: h^2 k t; h^2 k (1 - t). */
struct stiff {
    phys_vec across, along;
};

PHYS_INLINE void stiff_of(const struct four_springs *springs, int full, double h,
                          struct stiff *stiff)
{
    const phys_vec one = {1, 1, 1, 1}, k = h * h * springs->k;
    phys_vec t;
    transverse(springs, full, &t);
    stiff->across = k * t;
    stiff->along = k * (one - t);
}

PHYS_INLINE void write_values(const struct phys_four *four, const struct four_springs *springs,
                              const struct stiff *stiff, double h, phys_vec *value)
{
    const phys_vec square = stiff->along + h * springs->c;
    phys_vec row[PHYS_WIDE], column[PHYS_WIDE], size;
    phys_sqrt(&square, &size);
    PHYS_UNROLL
    for (int i = 0; i < 3; i++)
        column[i] = size * springs->u.c[i];
    column[3] = stiff->across;
    phys_turn(column, row);
    PHYS_UNROLL
    for (size_t i = 0; i < four->valid; i++)
        value[i] = row[i];
}

PHYS_INLINE void system_four(const struct phys_springs *s, size_t first, size_t end, double h,
                             double push, const struct where *at, phys_vec *b, phys_vec *value)
{
    struct phys_four four;
    struct four_springs springs;
    struct stiff stiff;
    struct phys_wide add;
    phys_vec speed, pull;
    phys_four_from(first, end, &four);
    four_make(s, &four, at->x, at->x_other, &springs);
    stiff_of(&springs, s->full, h, &stiff);
    write_values(&four, &springs, &stiff, h, value);
    differences(s, &four, at->v, at->v_other, &springs.dv);
    dot(&springs.u, &springs.dv, &speed);
    pull_of(&springs, &speed, &pull);
    pull = push * pull + stiff.along * speed;
    phys_wide_mix(&pull, &springs.u, &stiff.across, &springs.dv, &add);
    add_rows(s, &four, at->cut, &add, b);
}

PHYS_INLINE void system_all(const struct phys_springs *s, double h, double push,
                            const struct where *at, phys_vec *b, phys_vec *value)
{
    const size_t whole = s->n - s->n % PHYS_WIDE;
    for (size_t i = 0; i < whole; i += PHYS_WIDE)
        system_four(s, i, i + PHYS_WIDE, h, push, at, b, value + i);
    if (whole < s->n)
        system_four(s, whole, s->n, h, push, at, b, value + whole);
}

PHYS_KERNEL(phys_springs_system,
            (const struct phys_springs *springs, double h, double push, const phys_vec *x,
             const phys_vec *v, const phys_vec *x_other, const phys_vec *v_other, phys_vec *b,
             phys_vec *value),
            (springs, h, push, x, v, x_other, v_other, b, value))
{
    const struct where inner = {x, v, x, v, 0}, cut = {x, v, x_other, v_other, 1};
    if (x_other)
        system_all(springs, h, push, &cut, b, value);
    else
        system_all(springs, h, push, &inner, b, value);
}

PHYS_KERNEL(phys_springs_matrix,
            (const struct phys_springs *springs, double h, const phys_vec *x,
             const phys_vec *x_other, phys_vec *value),
            (springs, h, x, x_other, value))
{
    for (size_t i = 0; i < springs->n; i += PHYS_WIDE) {
        struct phys_four four;
        struct four_springs some;
        struct stiff stiff;
        phys_four_from(i, springs->n, &four);
        four_make(springs, &four, x, x_other, &some);
        stiff_of(&some, springs->full, h, &stiff);
        write_values(&four, &some, &stiff, h, value + i);
    }
}

/* ---- Stretch ---- */

/* Widens range, lane by lane, to l / L of four springs. */
PHYS_INLINE void widen(const struct phys_springs *s, const struct phys_four *four,
                       const unsigned char *chosen, const phys_vec *x, const phys_vec *x_other,
                       phys_vec range[2])
{
    uint32_t is[PHYS_WIDE];
    phys_vec rest, stretch;
    struct phys_wide d;
    differences(s, four, x, x_other, &d);
    dot(&d, &d, &stretch);
    phys_sqrt(&stretch, &stretch);
    phys_take_numbers(four, s->length, &rest);
    stretch /= rest;
    PHYS_UNROLL
    for (int i = 0; i < PHYS_WIDE; i++)
        is[i] = chosen[four->at[i]] != 0;
    const phys_mask counts = -(phys_mask){is[0], is[1], is[2], is[3]};
    const phys_mask less = counts & (stretch < range[0]), more = counts & (stretch > range[1]);
    phys_choose(&less, &stretch, range, range);
    phys_choose(&more, &stretch, range + 1, range + 1);
}

PHYS_KERNEL(phys_springs_range,
            (const struct phys_springs *springs, const unsigned char *chosen, const phys_vec *x,
             const phys_vec *x_other, double range[2]),
            (springs, chosen, x, x_other, range))
{
    phys_vec lanes[2] = {{range[0], range[0], range[0], range[0]},
                         {range[1], range[1], range[1], range[1]}};
    for (size_t i = 0; i < springs->n; i += PHYS_WIDE) {
        struct phys_four four;
        phys_four_from(i, springs->n, &four);
        widen(springs, &four, chosen, x, x_other, lanes);
    }
    for (int i = 0; i < PHYS_WIDE; i++) {
        range[0] = lanes[0][i] < range[0] ? lanes[0][i] : range[0];
        range[1] = lanes[1][i] > range[1] ? lanes[1][i] : range[1];
    }
}

/* The same bits whichever of a spring's ends comes first. */
double phys_energy_springs(const struct phys_springs *springs, const phys_vec *x,
                           const phys_vec *x_other)
{
    double sum = 0;
    for (size_t i = 0; i < springs->n; i++) {
        const phys_vec d = x_other[springs->end[i][1]] - x[springs->end[i][0]];
        const double longer = sqrt(phys_dot(&d, &d)) - springs->length[i];
        sum += 0.5 * springs->stiffness[i] * (longer * longer);
    }
    return sum;
}
