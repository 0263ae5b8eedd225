#ifndef CLOTH_FLOW_RUN_SOURCE_H
#define CLOTH_FLOW_RUN_SOURCE_H

#include "cloth/base/memory.h"
#include "cloth/element/cloths.h"
#include "cloth/flow/joints/ties.h"
#include "cloth/flow/state/tables.h"
#include "cloth/mesh/blocks.h"
#include "cloth/mesh/lattice.h"
#include "cloth/model/model.h"

#include <stdbool.h>

/* The data from which rank 0 makes the tables. It never has all tables, nor all springs, at once:
 * each group of blocks goes through the springs again, and a table is made when it is wanted. */

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

/* Springs of all cloths, by vertex, cloth after cloth in the order of their meshes; then joints. A
 * link is a spring without stiffness: it says that an element joins two vertices. */
struct flow_spring {
    uint32_t a, b;                     /* a < b */
    double stiffness, damping, length; /* N/m, kg/s, m */
    unsigned char stretch;             /* counts for the largest stretch */
    uint32_t seam;                     /* of those that pull, from 1; 0: it is no joint of one */
    const struct model_correction *correction; /* of such a one; NULL: it has none */
    struct element_size size;                  /* how it changes */
};
/* A spring, by its number among all springs of the cloths, that welds make parallel to others of
 * the same rest length. The first of them stands for all; the others are gone. */
struct flow_merged {
    uint64_t number;
    double stiffness, damping;
    bool gone;
};
/* A joint that begins or ends during the run, or that ends on an edge: a tie, and none of the
 * springs. Its vertices make two points by their weights, whose sum is 0. Its spring goes from the
 * point of the weights above 0 to that of those below. a and b of the spring are not used. */
struct flow_timed {
    struct flow_spring spring;
    uint32_t n, vertex[SOLVE_TIE_CORNERS]; /* of all cloths */
    double weight[SOLVE_TIE_CORNERS];
    uint64_t begin, end; /* ticks: steps that begin from .. to - 1 have it */
};
struct flow_springs {
    const struct model *model;
    struct mesh_lattice *lattice; /* a cloth; none of one that is made of triangles */
    struct mesh_regions *regions; /* a cloth; moduli NULL: none */
    const struct element_cloths *elements;
    uint32_t n_joints;
    struct flow_spring *joint; /* the scene's joints but for timed ones; NULL: there are none */
    uint32_t n_timed;
    struct flow_timed *timed; /* in the scene's order; NULL: there are none */
    const struct flow_welds *welds;
    size_t n_merged;
    struct flow_merged *merged; /* by number; NULL: none */
    struct cloth_pool memory;
};
/* Welds and elements must outlive them; links of elements come after the springs of their cloth.
 * Errors: CLOTH_E_INPUT as of mesh_lattice_build, with the place; CLOTH_E_MEMORY. Local. */
int flow_springs_make(struct flow_springs *springs, const struct model *model,
                      const struct flow_welds *welds, const struct element_cloths *elements,
                      struct cloth_error *error);
void flow_springs_each(const struct flow_springs *springs,
                       void (*visit)(void *to, const struct flow_spring *spring), void *to);
void flow_springs_free(struct flow_springs *springs);
/* Finds those that welds make parallel. Error: CLOTH_E_MEMORY. Local. */
int flow_springs_merge(struct flow_springs *springs, struct cloth_error *error);

struct flow_source;

/* Adds the model's joints to the springs, which free them, when particles are there. Errors:
 * CLOTH_E_INPUT for two joints between the same vertices and one between a vertex and itself;
 * CLOTH_E_MEMORY. Local. */
int flow_joints_make(struct flow_springs *springs, struct flow_particles *particles,
                     struct cloth_error *error);
/* True if a step of the model's h has a timed joint. Local. */
bool flow_joints_act(const struct model *model, const struct flow_timed *timed);
/* A timed joint as a tie between rows of blocks, when these are there. Local. */
struct flow_tie flow_joints_tie(const struct flow_source *source, const struct flow_timed *timed);
/* Lists the pairs of all joints and marks their vertices as used; a part of flow_particles_make.
 * Errors: as of flow_pairs_list. Local. */
int flow_joints_use(struct flow_particles *particles, const struct model *model,
                    struct cloth_error *error);

/* The neighbours of all blocks, block after block, and the rows read of them, as every rank knows
 * them. */
struct flow_neighbours {
    uint32_t n_neighbours, n_ghosts;
    uint32_t *neighbour;   /* n_neighbours: blocks, ascending in a block, */
    uint32_t *joins;       /* and which patches are joined with theirs */
    uint32_t *ghost_start; /* n_neighbours + blocks: of a block, where each neighbour's ghosts
                         begin, and the end */
    uint32_t *ghost;       /* n_ghosts: places in the halo of the neighbour's block, ascending */
};

/* The vertices of probes. A row of the table of probes has step and time, then n_columns numbers:
 * FLOW_RUN_COLUMNS of the run, then those of each probe. A probe has position, velocity and
 * reaction of each of its vertices, as far as they are wanted, then the sum of reactions, if it is.
 * Without probes n_columns is 0. */
enum {
    FLOW_COLUMN_ITERATIONS,
    FLOW_COLUMN_LONGEST,
    FLOW_COLUMN_SHORTEST,
    FLOW_COLUMN_ENERGY, /* kinetic, elastic, of weights, of loads */
    FLOW_RUN_COLUMNS = FLOW_COLUMN_ENERGY + 4
};
struct flow_watched {
    uint32_t n, *place;   /* ascending, each once */
    uint32_t *first;      /* a probe, and one more: its entries */
    uint32_t *entry;      /* where its place is in the list */
    uint32_t *vertex;     /* an entry: its vertex, of all cloths */
    unsigned char *again; /* an entry: whether one before it, of its probe, is another name of it */
    size_t n_columns;
    struct cloth_pool memory;
};

/* What is so near to a place at rest, along the cloth, that it would be a contact (contact/kin.c).
 * Places that pulled seams join are one of them: `joined` of struct flow_skins. */
struct flow_kin {
    uint32_t *start; /* by place, and one more; NULL: triangles are so high that there is none */
    uint32_t *of;    /* corners of triangles that are so near, ascending from start[place] */
    double *clear;   /* by place: the distance at rest to the nearest edge that does not end there,
                      * m; INFINITY: there is none in reach */
};

/* The triangles of skins (contact/skin_tables.c), block after block: numbers among those of all
 * cloths. */
struct flow_skins {
    uint32_t *start; /* a block, and one more: its triangles; NULL: there are no skins */
    uint32_t *triangle;
    unsigned char *stands; /* a triangle of this list: for which vertices and edges it stands, as
                            * contact_skin_source has it; */
    unsigned char *shared; /* and which of those edges others have, too */
    uint32_t
        *joined;  /* by place: one of those that pulled seams join it with; NULL: there are none */
    double *area; /* by place: a third of its triangles' areas at rest, m^2 */
    struct flow_kin kin;
};

/* The sides of a block's springs, while its table is due. */
struct flow_side;

struct flow_source {
    const struct model *model;
    struct flow_particles particles;
    struct element_cloths elements;
    struct flow_springs springs;
    struct mesh_blocks blocks; /* place: of other names, too */
    struct flow_names names;
    uint32_t patches; /* of a block */
    uint32_t *halo;   /* by place: its number in the halo of its block */
    uint32_t *cut;    /* by place: how many edges with a correction other blocks have there; NULL:
                       * there are none */
    struct flow_neighbours neighbours;
    struct flow_watched watched;
    struct flow_skins skins;  /* of a model whose contact is certified */
    struct flow_table *shape; /* a block: shapes, which point into the neighbours */
    uint32_t from;            /* the group of blocks whose sides are gathered begins there */
    struct flow_side *side;   /* all of the group; NULL: none are gathered */
    size_t *start;            /* a block of the group: where its sides begin */
    struct element *member;   /* its elements, */
    size_t *member_start;     /* a block and kind: where they begin */
    struct cloth_pool gathered, memory; /* of the group; of the others that live as long */
};

/* Cuts the model into blocks and finds their shapes. The model must outlive it. Errors: as of the
 * functions above; too many ranks for the blocks (CLOTH_E_INPUT); CLOTH_E_LIBRARY. Local. */
int flow_source_make(struct flow_source *source, const struct model *model, int ranks,
                     struct cloth_error *error);

/* Counts the elements of each block, in its shape. Local. */
void flow_source_count(struct flow_source *source);

/* The part of flow_source_gather, and of flow_source_table, that is about elements. */
int flow_source_collect(struct flow_source *source, uint32_t from, uint32_t to,
                        struct cloth_error *error);
void flow_source_members(const struct flow_source *source, uint32_t block,
                         const struct flow_layout *layout);

/* Gathers the sides of the springs, and the elements, of the blocks from .. to - 1, in place of
 * those before. Error: CLOTH_E_MEMORY. Local. */
int flow_source_gather(struct flow_source *source, uint32_t from, uint32_t to,
                       struct cloth_error *error);

void flow_source_forget(struct flow_source *source);

/* Makes the table of a block of the group: writes every byte of its memory. Several threads may
 * make different blocks at once. Local. */
void flow_source_table(const struct flow_source *source, uint32_t block, void *memory);

/* Finds the block of each triangle, and adds the sizes of skins to the shapes, when these are
 * there. The other makes the skin of a block, as the field `skin` has it: writes every byte of it.
 * Errors: CLOTH_E_MEMORY. Local. */
int flow_skins_make(struct flow_source *source, struct cloth_error *error);
void flow_skins_free(struct flow_skins *skins);
int flow_source_skin(const struct flow_source *source, uint32_t block, void *memory,
                     struct cloth_error *error);

/* Finds the kin of all places, when the rest of the skins is there. Errors: CLOTH_E_INPUT where the
 * mesh is far too fine for the thickness; CLOTH_E_MEMORY. Local. */
int flow_kin_make(struct flow_source *source, uint32_t n_triangles, struct cloth_error *error);
void flow_kin_free(struct flow_kin *kin);

/* Finds the neighbours, and the numbers of rows in halos (source->halo), when blocks and springs
 * are there. Adds both to the shapes. Error: CLOTH_E_MEMORY. Local. */
int flow_source_meet(struct flow_source *source, struct cloth_error *error);

/* Finds the watched vertices, when blocks are there. Errors: as of flow_pick, and CLOTH_E_INPUT for
 * vertices that no face or edge uses; CLOTH_E_MEMORY. Local. */
int flow_watched_make(struct flow_watched *watched, const struct flow_source *source,
                      struct cloth_error *error);
/* Names of the columns, with units and commas; the caller frees it. NULL: no probes. Error:
 * CLOTH_E_MEMORY. Local. */
int flow_watched_header(const struct flow_watched *watched, const struct model *model, char **text,
                        struct cloth_error *error);
/* The fastest vibration that a model can have where it starts, from above, and where it is. */
struct flow_limit {
    double omega; /* rad/s; 0: there are no springs */
    double drag;  /* 1/s: drag over mass there */
    double along; /* 1/s: damping of springs in that vibration over the mass */
    uint32_t vertex;
    const struct model_cloth *cloth; /* that vertex is of its mesh */
};
/* Error: CLOTH_E_MEMORY. Local. */
int flow_limit_find(const struct flow_source *source, struct flow_limit *limit,
                    struct cloth_error *error);
/* The longest step, s, in which an integrator does not let it grow; infinite for implicit ones. */
double flow_limit_of(const struct flow_limit *limit, enum model_integrator integrator);

/* The scale of residuals, kg m^2: the mass of all vertices that no pin holds times the square of
 * the mean rest length of stretchable edges; 0 without these. Local. */
double flow_source_inertia(const struct flow_source *source);

/* A scale of the energy, J: twice the sum of |force| times distance from the cloth's centre at the
 * start, over weights and constant loads of free vertices. These forces do no more work where each
 * vertex moves to the centre and as far on. At least that of a motion too slow to be seen. Local.
 */
double flow_source_release(const struct flow_source *source);

/* The scales of contacts (contact/scales.c): the stiffness of a contact, N/m; the mean mass of a
 * vertex, kg. Local. */
double flow_source_stiffness(const struct flow_source *source);
double flow_source_mass(const struct flow_source *source);
/* True if contact is certified, and solids may press on both sides of a cloth: several obstacles,
 * one that is not convex, or pins. (contact/pinch.c) */
bool flow_source_may_pinch(const struct flow_source *source);

/* Lists whose items begin with a vertex of all cloths and their number: when blocks are there,
 * makes vertices places and orders items by place; those of unused vertices are dropped. Then: the
 * first item at or after a place. size: of an item, bytes. Local. */
void flow_placed_settle(const struct flow_source *source, struct cloth_list *list, size_t size);
uint32_t flow_placed_from(const struct cloth_list *list, size_t size, uint32_t place);

/* The cloth of a vertex, and its first vertex; looked for from the last one found, zero at first.
 * The particle there. */
struct flow_cloths {
    uint32_t cloth, first;
};
void flow_source_cloth(struct flow_cloths *at, const struct model *model, uint32_t vertex);
void flow_particle_at(const struct flow_particles *particles, const struct model *model,
                      struct flow_cloths *at, uint32_t vertex, struct flow_particle *particle);

/* The block of a place; looked for in block `guess` first. */
uint32_t flow_source_block(const struct mesh_blocks *blocks, uint32_t place, uint32_t guess);

void flow_source_free(struct flow_source *source);

#endif
