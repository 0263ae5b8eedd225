#ifndef CLOTH_FLOW_STATE_TABLES_H
#define CLOTH_FLOW_STATE_TABLES_H

#include "cloth/base/error.h"
#include "cloth/element/cloths.h"
#include "cloth/physics/spring.h"
#include "cloth/solve/correction.h"
#include "cloth/solve/patches.h"

/* Data that do not change during a run. Every rank knows the shapes and neighbours of all blocks.
 * The rest of a block is its table, a shared object beside the block's others, which tasks read
 * where they run. Numbers are of all cloths together: vertices cloth after cloth in the input's
 * order, places block after block (cloth/mesh/blocks.h). */

/* A position or speed of this size (m, m/s, along an axis) is an error: a run does not start with
 * it, and a run that reaches it diverged. */
#define FLOW_BOUND 1e6

/* The counts of a block's skin (contact/skin.h). */
struct flow_skin_size {
    uint32_t n_points, n_triangles, n_edges, n_vertices;
    uint32_t n_kin;    /* of all points (flow_kin of run/source.h) */
    uint32_t cloth[2]; /* its points are of these cloths and some between them */
};

/* An edge whose velocities are corrected, cut by the border of a block: one end is a row of the
 * halo here, the other of that of a neighbour. */
struct flow_cut_edge {
    struct solve_edge edge;
    uint32_t row, neighbour; /* row here; which of the neighbours */
    double share;            /* of its correction that either block makes at once */
};

/* A spring or element whose shape at rest changes: how, and its numbers by the mesh: the stiffness,
 * damping and length of a spring; the vector, then the numbers of an element. */
struct flow_sized {
    struct element_size size;
    double base[4 + PHYS_NUMBERS];
};

/* clang-format off */
/* The arrays of a table, in the order of its memory: X(type, name, rows), PAIR(name, rows) of two
 * numbers a row. t: its shape. */
#define FLOW_TABLE_ARRAYS(X, PAIR)                                                                 \
    X(phys_vec, load, t->n)              /* N, gravity included */                                 \
    X(phys_vec, position, t->n)          /* m, m/s, at the start */                                \
    X(phys_vec, velocity, t->n)                                                                    \
    X(double, mass, t->n)                /* kg */                                                  \
    X(double, drag, t->n)                /* kg/s, viscous + mass damping */                        \
    X(double, free, t->n)                /* 1, or 0 where held */                                  \
    X(double, stiffness, sides)                                                                    \
    X(double, damping, sides)                                                                      \
    X(double, length, sides)                                                                       \
    PAIR(end, sides)                     /* inner: rows; cut: row here, place in the neighbour's halo */ \
    PAIR(ghost_end, t->n_cut_entries)    /* row here, number of the ghost */                       \
    PAIR(held_at, t->n_held)             /* struct solve_held: row, entry */                       \
    X(uint32_t, vertex, t->n)            /* of the input */                                        \
    X(uint32_t, row, t->n + 1)           /* struct solve_block */                                  \
    X(uint32_t, column, t->n_entries)                                                              \
    X(uint32_t, halo, t->n_halo)         /* rows, ascending */                                     \
    X(uint32_t, cut, t->n_neighbours + 1) /* springs into neighbour s are n_inner + cut[s] .. */   \
    X(uint32_t, cut_entry, t->n_neighbours + 1) /* cut entries into it are cut_entry[s] .. */      \
    X(uint32_t, at, t->format == SOLVE_SPRINGS ? 0 : sides) /* of each spring, its entry */        \
    X(uint32_t, held_entries, 1)         /* how many of held_at there are */                       \
    PAIR(moved, t->n_moved)              /* row, ascending; number of its motion, from 1 */        \
    PAIR(sliding, t->n_sliding)          /* row, ascending; number of its slider, from 1 */        \
    PAIR(loose, t->n_loose)              /* row, ascending; number of its piece, from 1 */         \
    PAIR(varying, t->n_varying)          /* row, ascending; number of its curve, from 1 */         \
    X(phys_vec, varying_force, t->n_varying) /* N, times the curve */                              \
    PAIR(soft, t->n_soft)                /* row, ascending; number of its motion, from 1; 0: none */ \
    X(uint32_t, soft_curve, t->n_soft)   /* number, from 1; 0: constant */                         \
    X(double, soft_stiffness, t->n_soft) /* N/m, times the curve */                                \
    X(double, soft_damping, t->n_soft)   /* kg/s, times the curve */                               \
    X(uint32_t, watched, t->n_watched)   /* rows, ascending */                                     \
    X(unsigned char, stretch, sides)     /* counts for the largest stretch */                      \
    PAIR(pulled, t->n_pulled)            /* spring, ascending; number of its seam, from 1 */       \
    X(struct flow_sized, sized, t->n_sized) /* springs; elements kind after kind */                \
    X(struct solve_edge, corrected, t->n_corrected) /* their ends are rows here */                 \
    X(struct flow_cut_edge, corrected_cut, t->n_corrected_cut) /* neighbour after neighbour */
/* clang-format on */

/* One block. Its springs: first the inner ones, sorted by (lower row, higher row), then those cut
 * by its border, neighbour after neighbour. Both blocks know a cut spring. The entries of its
 * matrix (cloth/solve/format.h) have the same order: the springs themselves or, in half storage,
 * the pairs of rows that anything joins, each once. Rows that elements join have a spring without
 * stiffness, a link. */
struct flow_table {
    /* Its shape, known to every rank: all before `neighbour` is broadcast as it stands. */
    uint32_t n, first;                               /* rows, place of row 0 */
    uint32_t n_inner, n_cut;                         /* springs */
    uint32_t n_corrected, n_corrected_cut;           /* edges whose velocities are corrected */
    uint32_t n_stiff;                                /* of them, those that are more than links */
    uint32_t n_elements[ELEMENT_KINDS], n_materials; /* of a kind; of the model */
    uint32_t n_entries, n_cut_entries; /* of the matrix: what is counted here may be one entry */
    uint32_t span; /* rows that an entry within the block joins are no farther apart */
    enum solve_format format;
    uint32_t n_halo;          /* rows that any neighbour needs */
    uint32_t n_held;          /* springs from free rows here to held ends: entries at most */
    uint32_t n_watched;       /* rows that probes are at */
    uint32_t n_moved;         /* rows that pins move */
    uint32_t n_sliding;       /* rows that pins leave free along a slider */
    uint32_t n_loose;         /* rows of pieces that no pin holds */
    uint32_t n_varying;       /* loads that vary */
    uint32_t n_sized;         /* springs and elements, if shapes at rest change; else 0 */
    uint32_t n_soft;          /* soft pins of rows */
    uint32_t n_pulled;        /* springs that are joints of seams */
    uint32_t lowest, highest; /* of its vertices */
    uint32_t n_neighbours;    /* blocks that it is joined to */
    uint32_t n_ghosts;        /* rows that the cut springs end at, neighbour after neighbour */
    struct flow_skin_size skin;
    uint32_t joined; /* which of its patches are (cloth/solve/patches.h) */
    uint32_t halo_start[SOLVE_MAX_PATCHES + 1]; /* places in the halo where patches begin */
    /* Not owned: */
    const uint32_t *neighbour;   /* n_neighbours: blocks, ascending */
    const uint32_t *ghost_start; /* n_neighbours + 1: those of neighbour s are ghost_start[s] .. */
    const uint32_t *joins;       /* n_neighbours: which patches here and there */
    const uint32_t *ghost; /* n_ghosts: places in the neighbour's halo, ascending in a neighbour */
    /* The table itself, in memory that is not owned; NULL but where one is open. */
#define FLOW_TABLE_MEMBER(type, name, rows) const type *name;
#define FLOW_TABLE_MEMBERS(name, rows)      const uint32_t(*name)[2];
    FLOW_TABLE_ARRAYS(FLOW_TABLE_MEMBER, FLOW_TABLE_MEMBERS)
    struct phys_elements list[ELEMENT_KINDS];
    struct solve_block matrix; /* its diagonal: of each step, NULL here */
    struct solve_held held;
};

struct flow_tables {
    uint32_t n_blocks;
    struct flow_table *block;          /* shapes, unless somebody opens the tables; not owned */
    const uint32_t *neighbour, *ghost; /* of all blocks, block after block; not owned */
};

/* The arrays of a table as they lie in its memory, one piece, while it is made. */
struct flow_layout {
#define FLOW_LAYOUT_MEMBER(type, name, rows) type *name;
#define FLOW_LAYOUT_MEMBERS(name, rows)      uint32_t(*name)[2];
    FLOW_TABLE_ARRAYS(FLOW_LAYOUT_MEMBER, FLOW_LAYOUT_MEMBERS)
    struct phys_elements list[ELEMENT_KINDS];
};

/* Bytes of a table's memory, which its shape decides; and where its arrays are. memory: aligned to
 * 64 bytes. */
size_t flow_table_bytes(const struct flow_table *table);
struct flow_layout flow_table_layout(const struct flow_table *table, void *memory);

/* Points the arrays of a table that has its shape into its memory. */
void flow_table_open(struct flow_table *table, const void *memory);

/* The index of a row of the halo of neighbour s among the block's ghosts. */
uint32_t flow_table_ghost(const struct flow_table *table, uint32_t s, uint32_t row);

/* The inner springs of a block; those into neighbour s. */
static inline struct phys_springs flow_table_springs(const struct flow_table *t, uint32_t from,
                                                     uint32_t to)
{
    return (struct phys_springs){to - from,         t->end + from,    t->stiffness + from,
                                 t->damping + from, t->length + from, 0};
}
static inline struct phys_springs flow_table_inner(const struct flow_table *t)
{
    return flow_table_springs(t, 0, t->n_inner);
}
static inline struct phys_springs flow_table_cut(const struct flow_table *t, uint32_t s)
{
    return flow_table_springs(t, t->n_inner + t->cut[s], t->n_inner + t->cut[s + 1]);
}

/* The cut entries, and the doubles of the values of all. */
static inline struct solve_cut flow_table_cut_entries(const struct flow_table *t)
{
    return (struct solve_cut){t->cut_entry[t->n_neighbours], t->ghost_end, t->n_halo, t->halo,
                              NULL};
}
static inline size_t flow_table_doubles(const struct flow_table *t)
{
    return solve_format_doubles(t->format, (size_t)t->n_entries + t->n_cut_entries);
}
static inline size_t flow_value_rows(const struct flow_table *t)
{
    return (flow_table_doubles(t) + 3) / 4;
}
/* The place of a number behind a block's factor, which has room for double entries: 1 if it was
 * made with a shift, or gave way to SSOR; else 0. */
static inline size_t flow_factor_shifted(const struct flow_table *t, enum solve_local local)
{
    return solve_local_doubles(t->n, t->n_entries, local);
}

#endif
