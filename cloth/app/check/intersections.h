#ifndef CLOTH_APP_CHECK_INTERSECTIONS_H
#define CLOTH_APP_CHECK_INTERSECTIONS_H

#include "cloth/base/error.h"
#include "cloth/contact/apart.h"
#include "cloth/contact/shape.h"
#include "cloth/mesh/mesh.h"

#include <stdbool.h>
#include <stdint.h>

/* Frame by frame, which triangles of cloth go through each other and through obstacles, by
 * cloth/verify. Local functions, on one rank. */
struct intersections;

/* Results of all frames so far, of several checks if they add to one. */
struct intersections_found {
    uint64_t frames;      /* that were checked */
    uint64_t bad;         /* frames with any of the following */
    uint64_t first;       /* the number of the first of these, if there is one */
    uint64_t pairs;       /* most in a frame: pairs of triangles of cloth that intersect */
    uint64_t with_shapes; /* most in a frame, the sum of: triangles of cloth in each convex shape;
                           * their intersecting pairs with triangles of bodies; parts of cloth
                           * inside a body */
};

/* All of it outlives the check. */
struct model;
struct intersections_setup {
    const char *program;       /* that messages begin with; NULL: nothing is printed */
    const struct model *model; /* names its cloths; NULL: they are not known */
    const struct contact_shape *obstacles;
    const struct phys_key *keys; /* of their motions */
    const struct contact_bodies *bodies;
    const struct contact_apart *apart; /* pairs that do not meet, also triangles of joined vertices
                                        */
    bool self_off;                     /* nor does any cloth meet itself */
    double begin; /* s, on the frames' clock: when motions and bodies are at time 0 */
    struct intersections_found *found; /* to be added to */
};

/* Triangles count that are deeper than this in a convex shape, m: of the state, whose positions
 * are doubles, and of frames as they are written, in floats. */
#define INTERSECTIONS_DEPTH       1e-9
#define INTERSECTIONS_DEPTH_FLOAT 1e-6

/* soup: of all cloths and bodies; taken over, and left empty. Error: CLOTH_E_MEMORY. */
struct contact_soup;
int intersections_open(struct intersections **intersections, const struct intersections_setup *of,
                       struct contact_soup *soup, struct cloth_error *error);

/* The same for a model, while it has its meshes: it fills the model and what the model has. */
int intersections_of(struct intersections **intersections, const struct model *model,
                     struct intersections_setup of, struct cloth_error *error);

/* Checks a frame: position as of flow_output.frame; written: as floats, else as doubles. A frame
 * may be checked both ways, one after the other. Prints the first few findings of the check on
 * standard error, unless `program` was NULL. Errors: as of verify_pairs. */
int intersections_frame(struct intersections *intersections, uint64_t frame, double time,
                        const double *position, bool written, struct cloth_error *error);

/* Prints a sentence about the findings on standard error, if there are any. */
void intersections_say(const struct intersections_found *found, const char *program);

/* *intersections becomes NULL; nothing is done if it is. */
void intersections_close(struct intersections **intersections);

#endif
