#ifndef TESTS_CLOTH_CONTACT_IMAGES_H
#define TESTS_CLOTH_CONTACT_IMAGES_H

#include "cloth/contact/image.h"
#include "tests/cloth/contact/bodies.h"

#include <string.h>

/* Bodies with their maps drawn, for tests: what a pixel shows, and a point by the maps and by the
 * tree. */

enum { RESOLUTION = 200, POINTS = 20000 };
static const double R = 0.5; /* m */

/* A body and its maps. */
struct shown {
    struct contact_bodies bodies;
    const struct contact_body *body;
    struct contact_view view;
    struct contact_image image;
    void *memory[CONTACT_STRIPS];
};

static inline void draw(struct shown *s)
{
    const uint32_t n = contact_view_strips(&s->view);
    s->image = (struct contact_image){.body = s->body, .view = s->view};
    for (uint32_t k = 0; k < n; k++) {
        const size_t bytes = contact_strip_bytes(s->body, &s->view, k);
        s->memory[k] = realloc(s->memory[k], bytes);
        ck_assert_ptr_nonnull(s->memory[k]);
        memset(s->memory[k], 0xa5, bytes);
        contact_strip_draw(s->body, &s->view, k, s->memory[k]);
        s->image.strip[k] = s->memory[k];
    }
}

static inline void show(struct shown *s, const struct surface *of,
                        const struct contact_frames *frames, uint32_t axis, uint32_t strips)
{
    struct mesh mesh;
    bool turned;
    *s = (struct shown){0};
    surface_mesh(of, &mesh);
    UNIT_FINE(contact_bodies_add_frames(&s->bodies, &mesh, frames, &turned, &error));
    mesh_free(&mesh);
    s->body = contact_bodies_at(&s->bodies, 1);
    contact_view_make(s->body, axis, RESOLUTION, &s->view);
    contact_view_cut(&s->view, strips);
    ck_assert_uint_le(contact_view_strips(&s->view), strips);
    draw(s);
}

static inline void drop(struct shown *s)
{
    for (int k = 0; k < CONTACT_STRIPS; k++)
        free(s->memory[k]);
    free(s->bodies.memory);
}

static inline double random_in(double low, double high)
{
    return low + (high - low) * rand() / RAND_MAX;
}

static inline void pick(double reach, phys_vec *x)
{
    for (int c = 0; c < 4; c++)
        (*x)[c] = c < 3 ? random_in(-reach, reach) : 0;
}

static inline const struct contact_pixel *pixel_of(const struct shown *s, uint32_t i, uint32_t j)
{
    const struct contact_pixel *strip = s->image.strip[j / s->view.rows];
    return strip + (size_t)(j % s->view.rows) * s->view.width + i;
}

/* The middle of a pixel: its place along the axes of columns and rows. */
static inline void pixel_middle(const struct shown *s, uint32_t i, uint32_t j, double at[2])
{
    at[0] = s->body->low[(s->view.axis + 1) % 3] + (i + 0.5) * s->view.pitch;
    at[1] = s->body->low[(s->view.axis + 2) % 3] + (j + 0.5) * s->view.pitch;
}

static inline bool is_covered(const struct contact_pixel *pixel)
{
    const bool covered = pixel->depth[0] > -INFINITY;
    ck_assert_msg(covered == (pixel->depth[1] < INFINITY), "covered from one side");
    ck_assert(!covered || pixel->depth[0] >= pixel->depth[1]);
    return covered;
}

static inline void closest(const struct shown *s, const phys_vec *x, struct contact_hit *map,
                           struct contact_hit *tree)
{
    contact_image_closest(&s->image, 1, x, map);
    tree->velocity = (phys_vec){0};
    contact_body_kind.closest(NULL, s->body, 1, x, tree);
}

#endif
