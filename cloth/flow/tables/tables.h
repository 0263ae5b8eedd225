#ifndef CLOTH_FLOW_TABLES_TABLES_H
#define CLOTH_FLOW_TABLES_TABLES_H

#include "cloth/flow/model.h"
#include "cloth/mesh/blocks.h"
#include "cloth/physics/spring.h"
#include "cloth/solve/block.h"

#include <stdbool.h>

/* What does not change during a run, for all blocks, on every rank. All cloths of a model together:
 * vertices are numbered cloth after cloth in the input's order, places block after block
 * (cloth/mesh/blocks.h). */

/* Positions and speeds of this size (m, m/s, along an axis) are no cloth's: a run does not start
 * with them, and a run that comes to them diverged. */
#define FLOW_BOUND 1e6

/* How many vertices are odd, and the first of them: in the numbering of its cloth's mesh. */
struct flow_odd {
    uint32_t n, vertex;
    const struct model_cloth *cloth;
    const char *place; /* of the mesh, pin or load that names it */
};

/* Particles by vertex, before the cut. Arrays of n. */
struct flow_particles {
    uint32_t n;
    struct flow_odd unused, pinned, loaded; /* that no face or edge uses: all; pinned; loaded */
    unsigned char *used;
    double *mass, *drag, *free; /* kg; kg/s, viscous + mass damping; 1 or 0 where a pin holds */
    phys_vec *position, *velocity, *load; /* m, m/s, N (gravity included) */
};

/* Errors: CLOTH_E_INPUT for pins and loads outside their mesh, boxes without a vertex, starts
 * beyond FLOW_BOUND and used vertices without mass; CLOTH_E_MEMORY. Local. */
int flow_particles_make(struct flow_particles *particles, const struct model *model,
                        struct cloth_error *error);
void flow_particles_free(struct flow_particles *particles);

/* Springs of all cloths, by vertex. */
struct flow_spring {
    uint32_t a, b;
    double stiffness, damping, length;
    unsigned char stretch; /* counts for the largest stretch */
};
struct flow_springs {
    size_t n;
    struct flow_spring *spring;
};
int flow_springs_make(struct flow_springs *springs, const struct model *model,
                      struct cloth_error *error);
void flow_springs_free(struct flow_springs *springs);

/* One block. Its springs: first the inner ones, sorted by (lower row, higher row), then those cut
 * by its border, neighbour after neighbour. A cut spring is known to both blocks. Pointers lead
 * into arrays of struct flow_tables. */
struct flow_table {
    uint32_t n, first;        /* rows, place of row 0 */
    uint32_t n_inner, n_cut;  /* springs */
    uint32_t n_slots;         /* neighbours */
    const uint32_t *slot;     /* n_slots: their blocks, ascending */
    const uint32_t *cut;      /* n_slots + 1: the springs into slot s are n_inner + cut[s] .. */
    uint32_t n_rim;           /* rows that any neighbour needs, */
    const uint32_t *rim;      /* n_rim: ascending */
    const uint32_t (*end)[2]; /* inner: rows; cut: row here, place in the neighbour's rim */
    uint32_t n_copies;        /* rows that the cut springs end at, neighbour after neighbour */
    const uint32_t *copies;   /* n_slots + 1: those of slot s are copies[s] .. */
    const uint32_t *copy;     /* n_copies: places in the neighbour's rim */
    const uint32_t (*copy_end)[2]; /* cut springs: row here, number of the copy */
    const double *stiffness, *damping, *length;
    const unsigned char *stretch;
    struct solve_block matrix;
    struct solve_held held; /* springs from free rows here to held ends anywhere */
    const double *mass, *drag, *free;
    const phys_vec *load, *position, *velocity;
};

struct flow_tables {
    uint32_t n_blocks;
    struct flow_table *block;
    /* Arrays that the blocks point into: by place, by spring and side, by rim row, by neighbour. */
    double *mass, *drag, *free, *diagonal;
    phys_vec *load, *position, *velocity;
    uint32_t (*end)[2], (*held)[2], *row, *column, *rim, *slot, *cut;
    uint32_t *copies, *copy, (*copy_end)[2];
    double *stiffness, *damping, *length;
    unsigned char *stretch;
};

/* h: s. The tables own what they hold; the arguments may go. Error: CLOTH_E_MEMORY. Local. */
int flow_tables_make(struct flow_tables *tables, const struct flow_particles *particles,
                     const struct flow_springs *springs, const struct mesh_blocks *blocks, double h,
                     struct cloth_error *error);
void flow_tables_free(struct flow_tables *tables);

/* The part of it that finds the copies, when all else is there. Error: CLOTH_E_MEMORY. */
int flow_copies_make(struct flow_tables *tables, struct cloth_error *error);

/* The inner springs of a block; those into neighbour slot s. */
static inline struct phys_springs flow_table_springs(const struct flow_table *t, uint32_t from,
                                                     uint32_t to)
{
    return (struct phys_springs){to - from, t->end + from, t->stiffness + from, t->damping + from,
                                 t->length + from};
}
static inline struct phys_springs flow_table_inner(const struct flow_table *t)
{
    return flow_table_springs(t, 0, t->n_inner);
}
static inline struct phys_springs flow_table_cut(const struct flow_table *t, uint32_t s)
{
    return flow_table_springs(t, t->n_inner + t->cut[s], t->n_inner + t->cut[s + 1]);
}

#endif
