#ifndef CLOTH_APP_CHECK_INTERSECTIONS_H
#define CLOTH_APP_CHECK_INTERSECTIONS_H

#include "cloth/base/error.h"
#include "cloth/contact/apart.h"
#include "cloth/contact/shape.h"
#include "cloth/mesh/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Frame by frame, which triangles of cloth go through each other and through obstacles, by
 * cloth/verify. Local functions, on one rank. */
struct intersections;

/* All but the soup and the names outlives the check. */
struct contact_soup;
struct intersections_setup {
    const char *program;       /* that messages begin with; NULL: nothing is printed */
    struct contact_soup *soup; /* of all cloths and bodies; taken over, and left empty */
    const char *const *names;  /* of its cloths; NULL: they are not known */
    const struct contact_shape *obstacles;
    const struct phys_key *keys; /* of their motions */
    const struct contact_bodies *bodies;
    const struct contact_apart *apart; /* pairs that do not meet, also triangles of joined vertices
                                        */
    bool self_off;                     /* nor does any cloth meet itself */
};

/* Results of all frames so far. */
struct intersections_found {
    uint64_t frames;      /* that were checked */
    uint64_t bad;         /* frames with any of the following */
    uint64_t first;       /* the number of the first of these, if there is one */
    uint64_t pairs;       /* most in a frame: pairs of triangles of cloth that intersect */
    uint64_t with_shapes; /* most in a frame, the sum of: triangles of cloth in each convex shape;
                           * their intersecting pairs with triangles of bodies; parts of cloth
                           * inside a body */
};

/* Triangles count that are deeper than this in a convex shape, m: of the state, whose positions
 * are doubles, and of frames as they are written, in floats. */
#define INTERSECTIONS_DEPTH       1e-9
#define INTERSECTIONS_DEPTH_FLOAT 1e-6

/* Error: CLOTH_E_MEMORY. */
int intersections_open(struct intersections **intersections,
                       const struct intersections_setup *setup, struct cloth_error *error);

struct model;
/* The same for a model, while it has its meshes. apart: pairs that do not meet. Both outlive it
 * all. program, self_off: as above. */
int intersections_of(struct intersections **intersections, const struct model *model,
                     const struct contact_apart *apart, const char *program, bool self_off,
                     struct cloth_error *error);

/* Puts time 0 of motions and bodies at the frames' time `begin`, s, from now on. */
void intersections_begin(struct intersections *intersections, double begin);

/* Checks a frame: position as of flow_output.frame; written: as floats, else as doubles. A frame
 * may be checked both ways, one after the other. Prints the first few findings on standard error,
 * unless `program` was NULL. Errors: as of verify_pairs. */
int intersections_frame(struct intersections *intersections, uint64_t frame, double time,
                        const double *position, bool written, struct cloth_error *error);

struct intersections_found intersections_found(const struct intersections *intersections);

/* Checks all frames of a folder, as they are written. Vertices that are in the same place in each
 * frame count as one: welds. Errors: of output_cache_frame, too. */
struct output_cache;
int intersections_of_folder(struct output_cache *cache, const char *program,
                            struct intersections_found *found, struct cloth_error *error);

/* Prints a sentence about the findings on standard error, if there are any. */
void intersections_say(const struct intersections_found *found, const char *program);

/* *intersections becomes NULL; nothing is done if it is. */
void intersections_close(struct intersections **intersections);

#endif
