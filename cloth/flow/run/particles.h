#ifndef CLOTH_FLOW_RUN_PARTICLES_H
#define CLOTH_FLOW_RUN_PARTICLES_H

#include "cloth/base/memory.h"
#include "cloth/element/cloths.h"
#include "cloth/flow/state/tables.h"
#include "cloth/mesh/blocks.h"
#include "cloth/model/model.h"

#include <stdbool.h>

/* The vertices of all cloths on rank 0, before they are in blocks: how they are held, pulled,
 * loaded and welded, and where they start. */

/* The number of unusual vertices, and the first of them: in the numbering of its cloth's mesh. */
struct flow_unusual {
    uint32_t n, vertex;
    const struct model_cloth *cloth;
    const char *place; /* of the mesh, pin or load that names it */
};
static inline void flow_unusual_note(struct flow_unusual *unusual, const struct model_cloth *cloth,
                                     uint32_t vertex, const char *place)
{
    if (unusual->n++ == 0)
        *unusual = (struct flow_unusual){1, vertex, cloth, place};
}

/* A vertex that follows a body with frames: a point of a triangle of the body, and where the vertex
 * is from there in the triangle's own axes. Both go with the triangle. */
struct flow_anchor {
    uint32_t obstacle, corner[3]; /* that is the body; vertices of it */
    double weight[3], offset[3];  /* sum 1; m */
};

/* A load that varies, on one vertex. */
struct flow_varying {
    uint32_t at;     /* its vertex, of all cloths; when blocks are there, its place */
    uint32_t number; /* in the scene's order */
    uint32_t curve;  /* of the model, from 1 */
    double force[3]; /* N, times the curve */
};

/* A soft pin of one vertex. */
struct flow_soft {
    uint32_t at;               /* its vertex, of all cloths; when blocks are there, its place */
    uint32_t number;           /* in the scene's order */
    uint32_t motion, curve;    /* of its place and of both numbers, from 1; 0: none */
    double stiffness, damping; /* N/m, kg/s, times the curve */
};

/* Vertices that welds make one. Each of them is a name of it; the lowest, the root, stands for all:
 * it has their masses and loads, and the row. The others have a mass of 0. */
struct flow_welds {
    uint32_t *root; /* by vertex: itself, or the root of its weld; NULL: there are no welds */
    uint32_t n, (*name)[2]; /* root and another name: by root, then by name */
};
static inline uint32_t flow_root(const struct flow_welds *welds, uint32_t vertex)
{
    return welds->root ? welds->root[vertex] : vertex;
}

/* Particles by vertex. Arrays of n. */
struct flow_particles {
    uint32_t n;
    struct flow_unusual unused, pinned, loaded; /* that no face or edge uses: all; pinned; loaded */
    unsigned char *used, *free;                 /* free: 0 where a pin holds */
    uint32_t *motion, *slider;                  /* number from 1, 0: none; NULL: there are none */
    uint32_t n_anchors; /* of vertices that follow bodies with frames: anchor i is motion number */
    struct flow_anchor *anchor; /* n_motions + 1 + i */
    uint32_t *attached; /* obstacle, from 1, that the vertex follows, 0: none; of all names; NULL */
    uint32_t n_pieces, *piece; /* free ones: the same */
    struct flow_welds welds;
    double *mass;              /* kg */
    double *own, *drag;        /* kg, of each name alone; kg/s; NULL: there are no welds */
    phys_vec *load;            /* N, gravity included; NULL: gravity alone */
    struct cloth_list varying; /* struct flow_varying: in the scene's order; then by place */
    struct cloth_list soft;    /* struct flow_soft: the same */
    double (*start)[6];        /* m, m/s; NULL: all start where the meshes have them */
    double (*unwelded)[3];     /* m: before the welds; NULL: no weld is of a seam */
    struct cloth_list joints;  /* struct flow_pair: of all; flow_joints_make uses it up */
    struct cloth_pool memory;  /* of arrays that live as long */
};

/* Errors: CLOTH_E_INPUT for pins and loads outside their mesh, boxes without a vertex, starts
 * beyond FLOW_BOUND and used vertices without mass; CLOTH_E_MEMORY. Local. */
int flow_particles_make(struct flow_particles *particles, const struct model *model,
                        struct cloth_error *error);
void flow_particles_free(struct flow_particles *particles);

/* Sets places and velocities at the start for the vertices of a cloth, the first of which is
 * `first`; a part of flow_particles_make, after `used`. Does nothing unless particles->start.
 * Local. */
int flow_starts_make(struct flow_particles *particles, uint32_t first,
                     const struct model_cloth *cloth, struct cloth_error *error);

/* Where a vertex of a cloth starts, m. Local. */
static inline void flow_start_place(const struct flow_particles *particles,
                                    const struct model_cloth *cloth, uint32_t first,
                                    uint32_t vertex, phys_vec *x)
{
    const double *at = particles->start ? particles->start[first + vertex]
                                        : cloth->mesh.position + 3 * (size_t)vertex;
    *x = PHYS_VEC(at);
}

/* Copies the starts of all vertices, as they have been made. Local. */
void flow_starts_take(const struct flow_particles *particles, const struct model *model,
                      double (*start)[6]);

/* Finds the vertices that follow obstacles, when starts and pins are there. Error: CLOTH_E_MEMORY.
 * Local. */
int flow_follow_make(struct flow_particles *particles, const struct model *model,
                     struct cloth_error *error);
/* The place of a vertex with an anchor at a time, s. Local. */
void flow_anchor_place(const struct model *model, const struct flow_anchor *anchor, double time,
                       phys_vec *to);

/* Makes the pins of a cloth, the first vertex of which is `first`; a part of flow_particles_make.
 * Errors: CLOTH_E_INPUT for a vertex that two pins hold otherwise, and as of flow_pick;
 * CLOTH_E_MEMORY. Local. */
int flow_pins_make(struct flow_particles *particles, uint32_t first, const struct model *model,
                   const struct model_cloth *cloth, struct cloth_error *error);

/* Makes the loads of a cloth, the first vertex of which is `first`; a part of flow_particles_make,
 * after weights. Local. */
int flow_loads_make(struct flow_particles *particles, uint32_t first,
                    const struct model_cloth *cloth, struct cloth_error *error);

/* A pair of vertices that the scene names. */
struct flow_pair {
    uint32_t vertex[2];           /* of all cloths */
    uint32_t second;              /* vertex[1] and this one are the ends of an edge, on which the */
    double at;                    /* pair ends `at` of the way from there; UINT32_MAX: there is none
                                   */
    uint32_t number, i;           /* among all that were listed; among those of its entry, */
    const struct model_pairs *of; /* this */
};
/* Adds the pairs of an entry to a list of them. what: "a joint". Errors: CLOTH_E_INPUT for vertices
 * outside their mesh and a vertex with itself; CLOTH_E_MEMORY. Local. */
int flow_pairs_list(struct cloth_list *list, const struct model *model,
                    const struct model_pairs *pairs, const char *what, struct cloth_error *error);
/* Checks that no pair is in the list twice; leaves the list in another order. Error: CLOTH_E_INPUT.
 * Local. */
int flow_pairs_once(struct cloth_list *list, const struct model *model, const char *what,
                    struct cloth_error *error);
/* CLOTH_E_INPUT with a sentence: the thing between the two, then `why`. */
int flow_pair_fail(const struct model *model, const struct flow_pair *pair, const char *what,
                   const char *why, struct cloth_error *error);

/* Finds the vertices that are one; a part of flow_particles_make. Errors: CLOTH_E_INPUT as of
 * flow_pairs_list, for pairs that stand twice, unused vertices, and welds that make two corners of
 * a triangle or two ends of an edge one; CLOTH_E_MEMORY. Local. */
int flow_welds_make(struct flow_particles *particles, const struct model *model,
                    struct cloth_error *error);
bool flow_is_welded(const struct flow_welds *welds, uint32_t root); /* it has several names */
/* Adds the seams of cloths with hinges. Errors: CLOTH_E_INPUT as of element_seams_check;
 * CLOTH_E_MEMORY. Local. */
int flow_seams_make(struct element_cloths *elements, const struct flow_welds *welds,
                    struct cloth_error *error);
/* Checks that welds leave hinges their four corners. Error: CLOTH_E_INPUT. Local. */
int flow_welds_check(const struct flow_welds *welds, const struct element_cloths *elements,
                     struct cloth_error *error);
/* Gives roots their start and drag, when masses and starts are there. Errors: CLOTH_E_INPUT for
 * pairs that start farther from each other than their tolerance; CLOTH_E_MEMORY. Local. */
int flow_welds_settle(struct flow_particles *particles, const struct model *model,
                      struct cloth_error *error);

/* The other names of the vertices in blocks, by place. */
struct flow_names {
    uint32_t n, (*name)[2]; /* place and vertex, ascending */
};
/* Gives the other names the places of their roots, and lists them. Error: CLOTH_E_MEMORY. Local. */
int flow_names_make(struct flow_names *names, const struct flow_welds *welds,
                    struct mesh_blocks *blocks, struct cloth_error *error);
/* Name k of a block's vertices: those that stand for all, then the others. vertex: by place.
 * Returns false behind the last. */
struct flow_name {
    uint32_t row, vertex;
};
bool flow_name_of(const struct flow_names *names, const uint32_t *vertex,
                  const struct flow_table *t, uint32_t k, struct flow_name *name);

/* The thing that picks vertices of a cloth, and those that it found. */
struct flow_picking {
    const struct model_cloth *cloth;
    uint32_t first;            /* vertex of the cloth */
    const unsigned char *used; /* by vertex of all cloths */
    const char *what;          /* in sentences: "a pin" */
    struct cloth_list list;    /* uint32_t: vertices of all cloths */
};
/* Adds to the list. Errors: CLOTH_E_INPUT for vertices outside the mesh and boxes without a vertex;
 * CLOTH_E_MEMORY. Local. */
int flow_pick(const struct model_pick *pick, struct flow_picking *picking,
              struct cloth_error *error);
/* The error of a vertex outside the mesh. */
int flow_no_vertex(const struct model_cloth *cloth, const char *what, uint32_t vertex,
                   const char *place, struct cloth_error *error);

/* One particle, a used vertex, of the cloth that it belongs to: `vertex` in the numbering of all
 * cloths, `first` that of the cloth's first. */
struct flow_particle {
    double mass, drag, free; /* kg; kg/s, viscous + mass damping; 1 or 0 where a pin holds */
    phys_vec position, velocity, load; /* m, m/s, N */
};
void flow_particle_of(const struct flow_particles *particles, const struct model *model,
                      const struct model_cloth *cloth, uint32_t first, uint32_t vertex,
                      struct flow_particle *particle);

#endif
