/* A pixel shows a plane: through the surface at its middle, across the normal there. So the gap of
 * a point is right to second order in its distance from the middle of the pixel. */
#include "cloth/contact/image.h"

#include <math.h>

enum { AT_ONCE = 32 }; /* points, whose places are on the stack */

/* Values that all points share. low: where the maps begin along columns, rows and the axis, m. */
struct looking {
    const struct contact_image *image;
    uint32_t u, v, axis, shift;
    double low[3], pitch, per;
};

static void contact_image_look_along(const struct contact_image *image, struct looking *at)
{
    const struct contact_view *view = &image->view;
    const double *low = image->body->low;
    *at = (struct looking){.image = image,
                           .u = (view->axis + 1) % 3,
                           .v = (view->axis + 2) % 3,
                           .axis = view->axis,
                           .pitch = view->pitch,
                           .per = 1 / view->pitch};
    at->low[0] = low[at->u];
    at->low[1] = low[at->v];
    at->low[2] = low[at->axis];
    while (UINT32_C(1) << at->shift < view->rows)
        at->shift++;
}

static void contact_image_miss(struct contact_hit *hit)
{
    *hit = (struct contact_hit){.gap = INFINITY, .normal = {0, 1, 0, 0}};
}

/* The gap of one map. away: from the middle of the pixel to the point, m; along the axis from where
 * depths begin. */
PHYS_INLINE double map_gap(const struct looking *at, const struct contact_pixel *pixel, int side,
                           const double away[3])
{
    const float *n = pixel->normal[side];
    return (double)n[at->u] * away[0] + (double)n[at->v] * away[1] +
           (double)n[at->axis] * (away[2] - (double)pixel->depth[side]);
}

/* The velocities of a strip, behind its pixels. */
static const struct contact_pixel_velocity *
strip_velocities(const struct contact_view *view, uint32_t strip, const struct contact_pixel *pixel)
{
    const size_t rows = contact_view_rows(view, strip);
    return (const void *)(pixel + rows * view->width);
}

/* The pixel that a point is in. */
struct place {
    const struct contact_pixel *pixel; /* NULL: the point is beside the maps */
    uint32_t strip;
    size_t number; /* in its strip */
    double away[3];
};

PHYS_INLINE void find_place(const struct looking *at, const double x[3], struct place *place)
{
    const struct contact_view *view = &at->image->view;
    const double across = x[at->u] - at->low[0], up = x[at->v] - at->low[1];
    const double column = across * at->per, row = up * at->per;
    place->pixel = NULL;
    if (!(column >= 0 && column < view->width && row >= 0 && row < view->height))
        return;
    const uint32_t i = (uint32_t)column, j = (uint32_t)row;
    place->strip = j >> at->shift;
    place->number = (size_t)(j & (view->rows - 1)) * view->width + i;
    place->away[0] = across - (i + 0.5) * at->pitch;
    place->away[1] = up - (j + 0.5) * at->pitch;
    place->away[2] = x[at->axis] - at->low[2];
    place->pixel = (const struct contact_pixel *)at->image->strip[place->strip] + place->number;
    phys_fetch(place->pixel, 0, 0);
}

PHYS_INLINE void look_up(const struct looking *at, const struct place *place,
                         struct contact_hit *hit)
{
    const struct contact_pixel *pixel = place->pixel;
    if (!pixel || !(pixel->depth[0] > -INFINITY)) {
        contact_image_miss(hit);
        return;
    }
    const double front = map_gap(at, pixel, 0, place->away);
    const double back = map_gap(at, pixel, 1, place->away);
    const int side = front >= back ? 0 : 1;
    const float *n = pixel->normal[side];
    hit->gap = side ? back : front;
    hit->normal = (phys_vec){(double)n[0], (double)n[1], (double)n[2], 0};
    hit->velocity = (phys_vec){0};
    if (at->image->body->n_frames) {
        const float *v =
            strip_velocities(&at->image->view, place->strip, pixel - place->number)[place->number]
                .of[side];
        hit->velocity = (phys_vec){(double)v[0], (double)v[1], (double)v[2], 0};
    }
}

/* Memory is asked for all pixels of some points before the first is looked at. */
void contact_image_closest(const struct contact_image *image, size_t n, const phys_vec *x,
                           struct contact_hit *hit)
{
    struct looking at;
    struct place place[AT_ONCE];
    contact_image_look_along(image, &at);
    for (size_t from = 0; from < n; from += AT_ONCE) {
        const size_t some = n - from < AT_ONCE ? n - from : AT_ONCE;
        for (size_t i = 0; i < some; i++)
            find_place(&at, (const double *)(x + from + i), place + i);
        for (size_t i = 0; i < some; i++)
            look_up(&at, place + i, hit + from + i);
    }
}
