/* The system of the last step in plain arrays, made by one task on rank 0, which reads tables,
 * matrices and states of all blocks. An entry between two blocks is in both; that of the lower
 * block counts. A tie (cloth/flow/joints/ties.h) is in all blocks that it has corners in; that of
 * the lowest becomes a pair for each two corners. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/state/bodies.h"

#include "cloth/base/memory.h"
#include "cloth/solve/system.h"

#include <stdlib.h>

/* The fields of a block that the task reads, in this order; the last only in a run with ties. */
enum { TABLE, RIGHT_SIDE, MATRIX, CHANGE, PLACE, SPEED, TIES, FIELDS };
static const enum flow_field_id fields[FIELDS] = {
    [TABLE] = FLOW_FIELD_table,   [RIGHT_SIDE] = FLOW_FIELD_f, [MATRIX] = FLOW_FIELD_a,
    [CHANGE] = FLOW_FIELD_dv,     [PLACE] = FLOW_FIELD_x,      [SPEED] = FLOW_FIELD_v,
    [TIES] = FLOW_FIELD_tie_table};

/* A block as the task sees it. */
struct part {
    struct flow_table t; /* with its matrix */
    const phys_vec *b, *dv, *x, *v;
    const void *value; /* of the matrix */
    struct flow_ties ties;
    const phys_vec *tie_value;
};

/* The parts of all blocks, and the system that they make. */
struct gathering {
    uint32_t n;
    struct part *part;
    struct solve_system *system;
};

static void open_part(const duite_call *call, uint32_t block, const duite_param *object,
                      struct part *part)
{
    const bool tied = flow_of(call)->made[FLOW_FIELD_tie_table];
    part->t = flow_of(call)->tables.block[block];
    flow_table_open(&part->t, object[TABLE].data);
    part->b = object[RIGHT_SIDE].data;
    part->value = flow_matrix_in(call, &part->t, object[MATRIX].data);
    part->dv = object[CHANGE].data;
    part->x = object[PLACE].data;
    part->v = object[SPEED].data;
    part->ties = flow_ties_open(tied ? object[TIES].data : NULL);
    part->tie_value = flow_tie_values(&part->t, part->value);
}

static void take_rows(struct solve_system *system, const struct part *part)
{
    const struct flow_table *t = &part->t;
    for (uint32_t i = 0; i < t->n; i++) {
        const size_t v = t->vertex[i];
        system->mass[v] = t->mass[i];
        system->diagonal[v] = t->matrix.diagonal[i];
        system->free[v] = t->free[i];
        for (size_t c = 0; c < 3; c++) {
            system->b[3 * v + c] = part->b[i][c];
            system->dv[3 * v + c] = part->dv[i][c];
            system->x[3 * v + c] = part->x[i][c];
            system->v[3 * v + c] = part->v[i][c];
        }
    }
}

/* ---- Entries ---- */

/* Adds a pair whose N is scale (w w' + alpha I). */
static void add_spring_pair(struct solve_system *system, uint32_t a, uint32_t b, double scale,
                            const phys_vec *value)
{
    const size_t at = system->n_pairs++;
    system->end[at][0] = a;
    system->end[at][1] = b;
    if (system->value)
        memcpy(system->value[at], value, sizeof *system->value);
    for (int c = 0; c < 3 && system->block; c++)
        for (int d = 0; d < 3; d++)
            system->block[at][3 * c + d] =
                scale * ((*value)[c] * (*value)[d] + (c == d ? (*value)[3] : 0));
}

/* Adds entry i of a block. */
static void add_entry(struct solve_system *system, const struct part *part, size_t i, uint32_t a,
                      uint32_t b)
{
    struct solve_symmetric symmetric = {{0}, {0}};
    struct solve_columns n;
    phys_vec turn;
    if (part->t.format == SOLVE_SPRINGS) {
        add_spring_pair(system, a, b, 1, (const phys_vec *)part->value + i);
        return;
    }
    const size_t at = system->n_pairs++;
    system->end[at][0] = a;
    system->end[at][1] = b;
    solve_entry_of(part->t.format, part->value, i, &symmetric, &turn);
    solve_entry_columns(&symmetric, &turn, &n);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            system->block[at][3 * r + c] = n.c[c][r];
}

static void take_entries(const struct gathering *all, uint32_t block)
{
    const struct part *part = all->part + block;
    const struct flow_table *t = &part->t;
    const struct solve_block *m = &t->matrix;
    for (uint32_t a = 0; a < t->n; a++)
        for (uint32_t i = m->row[a]; i < m->row[a + 1]; i++)
            add_entry(all->system, part, i, t->vertex[a], t->vertex[m->column[i]]);
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        const struct flow_table *other = &all->part[t->neighbour[s]].t;
        for (uint32_t i = t->cut_entry[s]; i < t->cut_entry[s + 1] && t->neighbour[s] > block; i++)
            add_entry(all->system, part, m->row[t->n] + (size_t)i, t->vertex[t->ghost_end[i][0]],
                      other->vertex[other->halo[t->ghost[t->ghost_end[i][1]]]]);
    }
}

/* ---- Ties ----
 *
 * The weights w_k of a tie and its value N give pairs with -w_k w_l N. If the weights do not sum to
 * zero, pairs with the ground, a held vertex behind all others, have the rest. */

/* The pairs that the ties of all blocks make. */
struct tied_pairs {
    size_t n;
    bool springs; /* each is a spring */
    bool ground;  /* some are with the ground */
};

/* The block of a corner, and the row there. */
static uint32_t block_of(const struct part *part, uint32_t own, uint32_t corner, uint32_t *row)
{
    const struct flow_ties *ties = &part->ties;
    const uint32_t ghost = corner - ties->n_rows;
    const bool here = corner < ties->n_rows;
    *row = here ? corner : ties->ghost_row[ghost];
    return here ? own : ties->other[ties->ghost_other[ghost]];
}

/* True if a block is the lowest one of its tie i. */
static bool is_lowest(const struct part *part, uint32_t block, uint32_t i)
{
    bool lowest = true;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        uint32_t row;
        lowest = lowest && (part->ties.weight[i][k] == 0 ||
                            block_of(part, block, part->ties.corner[i][k], &row) >= block);
    }
    return lowest;
}

/* The sum of the weights; rounding errors count as zero. */
static double sum_of_weights(const double weight[SOLVE_TIE_CORNERS])
{
    double sum = 0;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
        sum += weight[k];
    return fabs(sum) > 1e-12 ? sum : 0;
}

static void count_tie(const double weight[SOLVE_TIE_CORNERS], struct tied_pairs *pairs)
{
    const bool ground = sum_of_weights(weight) != 0;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        pairs->n += weight[k] != 0 && ground;
        for (int l = 0; l < k && weight[k] != 0; l++) {
            pairs->n += weight[l] != 0;
            pairs->springs = pairs->springs && (weight[l] == 0 || weight[k] * weight[l] == -1);
        }
    }
    pairs->springs = pairs->springs && !ground;
    pairs->ground = pairs->ground || ground;
}

static void add_tie(const struct gathering *all, uint32_t ground, uint32_t block, uint32_t i)
{
    const struct part *part = all->part + block;
    const double *weight = part->ties.weight[i], sum = sum_of_weights(weight);
    const phys_vec *value = part->tie_value + i;
    uint32_t vertex[SOLVE_TIE_CORNERS] = {0}, row;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        if (weight[k] == 0)
            continue;
        const uint32_t there = block_of(part, block, part->ties.corner[i][k], &row);
        vertex[k] = all->part[there].t.vertex[row];
        if (sum != 0)
            add_spring_pair(all->system, vertex[k], ground, weight[k] * sum, value);
        for (int l = 0; l < k; l++)
            if (weight[l] != 0)
                add_spring_pair(all->system, vertex[l], vertex[k], -weight[k] * weight[l], value);
    }
}

/* Counts the ties of all blocks or, where pairs is NULL, adds them. */
static void each_tie(const struct gathering *all, uint32_t ground, struct tied_pairs *pairs)
{
    for (uint32_t b = 0; b < all->n; b++)
        for (uint32_t i = 0; i < all->part[b].ties.n; i++) {
            if (!is_lowest(all->part + b, b, i))
                continue;
            if (pairs)
                count_tie(all->part[b].ties.weight[i], pairs);
            else
                add_tie(all, ground, b, i);
        }
}

/* ---- The task ---- */

static int gather_system(const struct flow *flow, const struct gathering *all,
                         struct cloth_error *error)
{
    struct tied_pairs tied = {.springs = flow->model->format == SOLVE_SPRINGS};
    each_tie(all, flow->n_vertices, &tied);
    size_t entries = tied.n;
    for (uint32_t b = 0; b < all->n; b++)
        entries += (size_t)all->part[b].t.n_entries + all->part[b].t.n_cut_entries;
    const enum solve_pairs pairs = tied.springs ? SOLVE_PAIRS_OF_SPRINGS : SOLVE_PAIRS_OF_BLOCKS;
    const int code =
        solve_system_make(all->system, flow->n_vertices + tied.ground, entries, pairs, error);
    if (code)
        return code;
    all->system->n_pairs = 0;
    for (uint32_t b = 0; b < all->n; b++) {
        take_rows(all->system, all->part + b);
        take_entries(all, b);
    }
    each_tie(all, flow->n_vertices, NULL);
    return solve_system_sort(all->system, error);
}

struct save_args {
    uint32_t block; /* none */
    double h;       /* s: length of the step */
};

FLOW_KERNEL_WITH(system_save, FLOW_NO_PART, struct save_args, (RW(token), REST_R(system_objects)),
                 .side_effects = 1)
{
    struct flow *flow = flow_of(call);
    struct solve_system system = {0};
    struct gathering all = {.n = flow->tables.n_blocks, .system = &system};
    const size_t each = on->n_system_objects / all.n;
    all.part = cloth_alloc(all.n, sizeof *all.part, &flow->trouble);
    int code = all.part ? CLOTH_OK : CLOTH_E_MEMORY;
    for (uint32_t b = 0; b < all.n && !code; b++)
        open_part(call, b, on->system_objects + each * b, all.part + b);
    if (!code)
        code = gather_system(flow, &all, &flow->trouble);
    system.h = on->args->h;
    if (!code)
        code = flow->output->system(flow->output->context, &system, &flow->trouble);
    solve_system_free(&system);
    free(all.part);
    if (!code)
        return 0;
    return duite_fail(call, code == CLOTH_E_MEMORY ? FLOW_NO_MEMORY : FLOW_NOT_WRITTEN, "%s",
                      flow->trouble.text);
}

int flow_system(struct flow_state *state)
{
    const struct save_args save = {.h = flow_attempt_args(state).h};
    struct flow_with with = {.rest = state->refs + FLOW_MAX_PARAMETERS};
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++)
        for (int k = 0; k < FIELDS; k++)
            if (state->flow->made[fields[k]])
                with.rest[with.n++] = flow_field_object(state, fields[k], b);
    return flow_fork_with_at(state, 0, &flow_kernel_system_save, &save, &with);
}
