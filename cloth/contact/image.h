#ifndef CLOTH_CONTACT_IMAGE_H
#define CLOTH_CONTACT_IMAGE_H

#include "cloth/contact/shape.h"

/* The second way to meet a body: two maps of it, parallel views from the front and from the back
 * along an axis (Vassilev, Spanlang, Chrysanthou, Fast Cloth Animation on Walking Avatars, 2001). A
 * pixel has the depth and the normal of the surface there, and for bodies with frames its velocity.
 * A point between both maps counts as inside. So a lookup costs the same for every body. All
 * between the two surfaces is solid: maps are blind at armpits and wherever a part of the body
 * hides another. They certify no contact.
 *
 * Maps are in the body's axes; callers that move it bring points there. They are drawn in strips of
 * rows, each on its own, to bits that do not depend on how they are cut. Pure functions; nothing is
 * allocated. */

/* Front 0, back 1; where there is nothing, their depths are -INFINITY and INFINITY. */
struct contact_pixel {
    float depth[2]; /* m, along the axis, from the low corner of the body's box */
    float normal[2][3];
};
struct contact_pixel_velocity {
    float of[2][3]; /* m/s */
};

/* Bytes of a strip: its pixels, row after row, then of a body with frames their velocities. */
size_t contact_strip_bytes(const struct contact_body *body, const struct contact_view *view,
                           uint32_t strip);

/* Draws a strip of the body as it is now (contact_bodies_move). A triangle has a pixel if it has
 * its middle, by the top-left rule: both maps have the same pixels, and edges no holes. Normals are
 * interpolated from the vertices; where the body bends much, they are the triangle's. */
void contact_strip_draw(const struct contact_body *body, const struct contact_view *view,
                        uint32_t strip, void *memory);

/* Maps that are drawn, of a body that has not moved since. */
struct contact_image {
    const struct contact_body *body;
    struct contact_view view;
    const void *strip[CONTACT_STRIPS];
};

/* Finds for n points (m), in the body's axes, the surface in the point's pixel, as a plane through
 * the pixel's middle. It takes front or back, whichever has the larger gap: the nearer for points
 * inside. Beside both maps the gap is INFINITY. All of each hit is written. */
void contact_image_closest(const struct contact_image *image, size_t n, const phys_vec *x,
                           struct contact_hit *hit);

#endif
