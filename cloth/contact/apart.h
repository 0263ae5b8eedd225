#ifndef CLOTH_CONTACT_APART_H
#define CLOTH_CONTACT_APART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Cloths and obstacles that do not meet, since the scene leaves them out. Sides are numbered:
 * cloths, then obstacles. */
struct contact_apart {
    uint32_t n_cloths, n_obstacles;
    uint32_t *end;            /* n_cloths: one behind the last vertex of each, of all cloths */
    unsigned char *apart;     /* n_cloths x (n_cloths + n_obstacles): 1 where the two do not meet;
                               * NULL: all meet. Symmetric for cloths. */
    uint32_t n_vertices;      /* of all cloths */
    const uint32_t *attached; /* by vertex: the obstacle, from 1, that its pin follows, or 0, which
                               * no feature with a corner there meets; NULL: none does */
    uint32_t *joined; /* by vertex of all cloths: the lowest that pulled seams, and edges shorter
                       * than the thickness, join it with, as whose corner it does not meet
                       * features; NULL: there are none */
};

static inline bool contact_is_attached(const struct contact_apart *all, uint32_t n,
                                       const uint32_t *vertex, uint32_t obstacle)
{
    bool is = false;
    for (uint32_t k = 0; k < n && all->attached; k++)
        is = is || all->attached[vertex[k]] == obstacle + 1;
    return is;
}

static inline bool contact_are_apart(const struct contact_apart *all, uint32_t cloth,
                                     uint32_t other)
{
    return all->apart &&
           all->apart[(size_t)cloth * ((size_t)all->n_cloths + all->n_obstacles) + other];
}

/* The cloth of a vertex; looked for from a guess on. */
static inline uint32_t contact_apart_cloth(const struct contact_apart *all, uint32_t vertex,
                                           uint32_t guess)
{
    while (guess && vertex < all->end[guess - 1])
        guess--;
    while (vertex >= all->end[guess])
        guess++;
    return guess;
}

#endif
