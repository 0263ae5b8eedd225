#ifndef CLOTH_APP_CHECK_INTERSECTIONS_STATE_H
#define CLOTH_APP_CHECK_INTERSECTIONS_STATE_H

#include "cloth/app/check/intersections.h"
#include "cloth/contact/soup.h"
#include "cloth/verify/verify.h"

/* Shared by intersections.c and intersections_open.c. */

#define INTERSECTIONS_NO_PART UINT32_MAX

struct intersections {
    const char *program;
    const struct contact_shape *obstacles;
    const struct phys_key *keys;
    const struct contact_bodies *bodies;
    const struct contact_apart *apart;
    bool self_off;
    double begin; /* s: when motions and bodies are at time 0 */
    struct contact_soup soup;
    char **name;         /* by cloth; NULL: they are not known */
    phys_vec *place;     /* room for the vertices of a body */
    uint32_t *part;      /* by point of cloth: the lowest that triangles join it to, directly or
                          * through others; INTERSECTIONS_NO_PART: no triangle has it */
    unsigned char *seen; /* by part, while a body is looked at: a vertex of it was */
    double (*x)[3];
    uint32_t *sewn;             /* by point: as of struct verify_soup; NULL: no seams are pulled */
    struct verify_soup checked; /* the soup, welded, with its places */
    struct cloth_list pairs, entered;
    struct intersections_found found;
    uint64_t last; /* the last frame that had any */
};

#endif
