#ifndef CLOTH_FLOW_RUN_SOURCE_H
#define CLOTH_FLOW_RUN_SOURCE_H

#include "cloth/base/memory.h"
#include "cloth/element/cloths.h"
#include "cloth/flow/joints/ties.h"
#include "cloth/flow/run/particles.h"
#include "cloth/flow/state/tables.h"
#include "cloth/mesh/blocks.h"
#include "cloth/mesh/lattice.h"
#include "cloth/model/model.h"

#include <stdbool.h>

/* The data from which rank 0 makes the tables. It never has all tables, nor all springs, at once:
 * each group of blocks goes through the springs again, and a table is made when it is wanted. */

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

/* The kin of a place: cloth so near to it at rest, along the cloth, that it would be a contact
 * (contact/kin.c). Places that pulled seams join are one of them: `joined` of struct flow_skins. */
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

/* The first item at or after a place of a list whose items begin with their place. size: of an
 * item, bytes. Local. */
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
