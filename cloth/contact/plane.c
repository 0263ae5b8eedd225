/* A plane: its gap is the height of a point above it. */
#include "cloth/contact/shape.h"

enum { POINT = 0, NORMAL = 3 };

static void plane_closest(const double *value, const struct contact_body *body, size_t n,
                          const phys_vec *x, struct contact_hit *hit)
{
    (void)body;
    const phys_vec origin = {value[POINT], value[POINT + 1], value[POINT + 2], 0};
    const phys_vec up = {value[NORMAL], value[NORMAL + 1], value[NORMAL + 2], 0};
    for (size_t i = 0; i < n; i++) {
        const phys_vec from = x[i] - origin;
        hit[i].gap = phys_dot(&from, &up);
        hit[i].normal = up;
    }
}

static bool plane_apart(const double *value, const struct contact_body *body, size_t n,
                        const phys_vec *x)
{
    (void)body;
    const phys_vec origin = {value[POINT], value[POINT + 1], value[POINT + 2], 0};
    const phys_vec up = {value[NORMAL], value[NORMAL + 1], value[NORMAL + 2], 0};
    size_t above = 0;
    for (size_t i = 0; i < n; i++) {
        const phys_vec from = x[i] - origin;
        above += phys_dot(&from, &up) > 0;
    }
    return above == n;
}

static void plane_core(const double *value, const struct contact_body *body,
                       struct contact_core *core)
{
    (void)body;
    *core = (struct contact_core){.endless = true};
    contact_axes(value + POINT, value + NORMAL, &core->axes);
}

static const struct contact_parameter parameters[] = {
    {"point", CONTACT_POINT}, {"normal", CONTACT_DIRECTION}, {NULL, 0}};
const struct contact_kind contact_plane = {.name = "plane",
                                           .parameter = parameters,
                                           .closest = plane_closest,
                                           .apart = plane_apart,
                                           .core = plane_core};
