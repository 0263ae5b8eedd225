/* A triangle's force depends on its corners alone, in their order: blocks that share it find the
 * same bits. */
#include "cloth/physics/air.h"
#include "cloth/physics/curve.h"

#include <math.h>

struct corner {
    phys_vec x, v;
};

PHYS_INLINE struct corner corner_of(const struct phys_sight *sight, uint32_t i)
{
    if (i < sight->n)
        return (struct corner){sight->x[i], sight->v[i]};
    return (struct corner){sight->x_ghost[i - sight->n], sight->v_ghost[i - sight->n]};
}

PHYS_INLINE double length_of(const phys_vec *a)
{
    return sqrt(phys_dot(a, a));
}

/* ---- Gusts ---- */

/* Random numbers by their place in the seed's sequence (splitmix64: Steele, Lea, Flood 2014). */
struct draws {
    uint64_t state;
};

/* From 0 to below 1. */
static double draw(struct draws *draws)
{
    uint64_t z = draws->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

/* k L. With k L = tan a the density of a is that of sin^4 a. */
static double draw_number(struct draws *draws)
{
    for (;;) {
        const double turns = draw(draws) / 4, sine = phys_sine(turns);
        if (draw(draws) < sine * sine * sine * sine)
            return sine / phys_sine(turns + 0.25);
    }
}

/* One of length 1. */
static void draw_direction(struct draws *draws, phys_vec *to)
{
    const double z = 2 * draw(draws) - 1, turns = draw(draws), r = sqrt(1 - z * z);
    *to = (phys_vec){r * phys_sine(turns + 0.25), r * phys_sine(turns), z};
}

void phys_gusts_make(const struct phys_turbulence *turbulence, double sigma,
                     struct phys_gusts *gusts)
{
    const double two_pi = 6.283185307179586;
    const double amplitude = sigma * sqrt(6.0 / PHYS_WAVES);
    struct draws draws = {(uint64_t)turbulence->seed << 32};
    for (int i = 0; i < PHYS_WAVES; i++) {
        phys_vec along, other, across;
        const double number = draw_number(&draws);
        draw_direction(&draws, &along);
        do { /* what is left of another one across the first has any direction there alike */
            draw_direction(&draws, &other);
            phys_cross(&along, &other, &across);
        } while (!(length_of(&across) > 0));
        gusts->across[i] = amplitude / length_of(&across) * across;
        gusts->wave[i] = number / (turbulence->length * two_pi) * along;
        gusts->wave[i][3] = draw(&draws);
    }
}

void phys_gusts_at(const struct phys_gusts *gusts, const phys_vec *place, phys_vec *to)
{
    phys_vec at = *place;
    at[3] = 1;
    *to = (phys_vec){0};
    for (int i = 0; i < PHYS_WAVES; i++) {
        const phys_vec turns = gusts->wave[i] * at;
        *to += phys_sine(turns[0] + turns[1] + turns[2] + turns[3]) * gusts->across[i];
    }
}

/* ---- The force ---- */

/* The part of the force on a triangle that each of so many corners takes. */
static void push(const struct phys_air *air, const phys_vec *wind, const struct corner c[3],
                 int corners, phys_vec *part)
{
    const phys_vec u = *wind - (c[0].v + c[1].v + c[2].v) / 3;
    const phys_vec a = c[1].x - c[0].x, b = c[2].x - c[0].x;
    phys_vec normal;
    phys_cross(&a, &b, &normal);
    const double twice = length_of(&normal);
    *part = (phys_vec){0};
    if (!(twice > 0))
        return;
    normal /= twice;
    const phys_vec across = phys_dot(&u, &normal) * normal, along = u - across;
    *part = air->density * twice / (4 * corners) *
            (air->normal * length_of(&across) * across + air->tangent * length_of(&along) * along);
}

void phys_air_force(const struct phys_elements *faces, const struct phys_air *air,
                    const struct phys_sight *sight, phys_vec *f)
{
    const phys_vec mean = PHYS_VEC(air->wind), way = PHYS_VEC(air->turbulence.way);
    const double sigma = air->turbulence.intensity * length_of(&mean);
    struct phys_gusts gusts;
    if (sigma > 0)
        phys_gusts_make(&air->turbulence, sigma, &gusts);
    for (uint32_t e = 0; e < faces->n; e++) {
        const uint32_t *corner = faces->corner[e];
        const int corners = corner[3] == PHYS_NO_CORNER ? 3 : 4;
        struct corner c[3];
        phys_vec part, wind = mean;
        for (int i = 0; i < 3; i++)
            c[i] = corner_of(sight, corner[i]);
        if (sigma > 0) {
            const phys_vec middle = (c[0].x + c[1].x + c[2].x) / 3 - way;
            phys_vec gust;
            phys_gusts_at(&gusts, &middle, &gust);
            wind += gust;
        }
        push(air, &wind, c, corners, &part);
        for (int i = 0; i < corners; i++)
            if (corner[i] < sight->n)
                f[corner[i]] += part;
    }
}

/* ---- Pressure ---- */

void phys_pressure_force(const struct phys_elements *list, const struct phys_air *air,
                         const struct phys_sight *sight, phys_vec *f)
{
    (void)air;
    for (uint32_t e = 0; e < list->n; e++) {
        const uint32_t *corner = list->corner[e];
        phys_vec x[3], push;
        for (int i = 0; i < 3; i++)
            x[i] =
                corner[i] < sight->n ? sight->x[corner[i]] : sight->x_ghost[corner[i] - sight->n];
        const phys_vec a = x[1] - x[0], b = x[2] - x[0];
        phys_cross(&a, &b, &push);
        push *= list->number[PHYS_PRESSURE][e] / 6; /* of p A n, a third; the product is 2 A n */
        for (int i = 0; i < 3; i++)
            if (corner[i] < sight->n)
                f[corner[i]] += push;
    }
}
