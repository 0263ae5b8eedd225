#ifndef CLOTH_CONTACT_SOUP_H
#define CLOTH_CONTACT_SOUP_H

#include "cloth/contact/body.h"
#include "cloth/contact/shape.h"
#include "cloth/mesh/mesh.h"

/* One soup of triangles: those of all cloths, then those of the obstacles that are bodies. Points
 * are numbered likewise. Local. */
struct contact_surface {
    uint32_t point, triangle; /* its first ones */
};
struct contact_soup {
    uint32_t n_cloths, n_obstacles;
    struct contact_surface *surface; /* n_cloths + n_obstacles + 1: each cloth, each obstacle (one
                                      * that is no body has no triangles), the end */
    uint32_t *same;        /* of each point of cloth: the lowest that it is welded to, or itself */
    uint32_t (*corner)[3]; /* of each triangle, as its mesh has them */
    uint32_t (*welded)[3]; /* the same, where welded points are the lowest of them */
};

/* same: as above, its owner is the soup from then on, also after an error; NULL: nothing is welded.
 * The soup belongs to the caller (contact_soup_free), also after an error. Errors: CLOTH_E_INPUT
 * for more than 2^32 points or triangles, CLOTH_E_MEMORY. */
int contact_soup_make(struct contact_soup *soup, uint32_t n_cloths, const struct mesh *const *mesh,
                      uint32_t *same, uint32_t n_obstacles, const struct contact_shape *obstacles,
                      const struct contact_bodies *bodies, struct cloth_error *error);
void contact_soup_free(struct contact_soup *soup);

/* The number of cloths' points and triangles, and of all. */
static inline struct contact_surface contact_soup_cloths(const struct contact_soup *soup)
{
    return soup->surface[soup->n_cloths];
}
static inline struct contact_surface contact_soup_all(const struct contact_soup *soup)
{
    return soup->surface[soup->n_cloths + soup->n_obstacles];
}

/* The surface of a triangle: a cloth, or n_cloths plus an obstacle. */
static inline uint32_t contact_soup_owner(const struct contact_soup *soup, uint32_t triangle)
{
    uint32_t i = 0;
    while (triangle >= soup->surface[i + 1].triangle)
        i++;
    return i;
}

/* The cloth of a point of cloth. */
static inline uint32_t contact_soup_cloth(const struct contact_soup *soup, uint32_t point)
{
    uint32_t i = 0;
    while (point >= soup->surface[i + 1].point)
        i++;
    return i;
}

#endif
