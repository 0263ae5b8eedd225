#ifndef CLOTH_APP_CHECK_INTERSECTIONS_SOUP_H
#define CLOTH_APP_CHECK_INTERSECTIONS_SOUP_H

#include "cloth/app/check/intersections.h"
#include "cloth/verify/verify.h"

/* Shared by intersections.c and intersections_soup.c. One soup has the triangles of all cloths,
 * then those of all obstacles that are bodies, whose vertices follow those of the cloths. */

/* The first triangle and the first vertex of a cloth or of a body in the soup. */
struct surface {
    uint32_t triangle, point;
    char *name; /* of a cloth; NULL: it is not known */
};

/* cloth and obstacle have one more item, their end. */
struct intersections {
    const char *program;
    const struct contact_shape *obstacles;
    const struct phys_key *keys;
    const struct contact_bodies *bodies;
    const struct contact_apart *apart;
    bool self_off;
    double begin; /* s: when motions and bodies are at time 0 */
    size_t n_cloths, n_obstacles;
    phys_vec *place;                  /* room for the vertices of a body */
    struct surface *cloth, *obstacle; /* n_cloths + 1; n_obstacles + 1: empty unless a body */
    uint32_t *part;                   /* by vertex of all cloths (intersections_parts.h) */
    unsigned char *seen;              /* by part, while a body is looked at: a vertex of it was */
    double (*x)[3];
    uint32_t (*corner)[3]; /* of a triangle, as its mesh has them */
    uint32_t (*joined)[3]; /* the same, welded: the lowest vertex that each is one with */
    uint32_t *sewn;        /* by point: as of struct verify_soup; NULL: no seams are pulled */
    struct verify_soup soup;
    struct cloth_list pairs, entered;
    struct intersections_found found;
    uint64_t last; /* the last frame that had any */
};

#endif
