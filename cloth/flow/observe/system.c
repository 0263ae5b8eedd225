/* The system of the last step, brought together on rank 0: each block reports its part of it, in
 * numbers, and one task on rank 0 makes plain arrays of all parts. An entry between two blocks is
 * reported by both; the report of the lower block counts. Ties (cloth/flow/state/ties.h) are
 * entries, too. */
#include "cloth/flow/bodies.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/step/step.h"

#include "cloth/solve/system.h"

/* A part: rows, entries and room for ties, rows of the halo. A row has its vertex, mass, diagonal
 * and free, then vectors. An entry has its row here, the block of its other end and the row there,
 * then its values: those of a spring, or N by rows. A block less than 0: there is no entry any
 * more. In another block the row is its place in the halo there. For a tie it is the row's number
 * plus the number of rows in that halo. */
enum { VERTEX, MASS, DIAGONAL, FREE, B, DV = B + 3, X = DV + 3, V = X + 3, ROW = V + 3 };
enum { HERE, BLOCK, THERE, VALUE, SPRING = VALUE + 4, PAIR = VALUE + SOLVE_NINE };

static size_t entry_doubles(const struct flow_table *t)
{
    return t->format == SOLVE_SPRINGS ? SPRING : PAIR;
}

static size_t entries_at(const struct flow_table *t)
{
    return (size_t)ROW * t->n;
}

static size_t halo_at(const struct flow_table *t, size_t room)
{
    return entries_at(t) + entry_doubles(t) * (t->n_entries + t->n_cut_entries + room);
}

size_t flow_system_doubles(const struct flow_table *t, size_t room)
{
    return halo_at(t, room) + t->n_halo;
}

/* How many ties a part of so many numbers has room for. */
static size_t room_of(const struct flow_table *t, size_t numbers)
{
    const size_t least = flow_system_doubles(t, 0);
    return numbers > least ? (numbers - least) / entry_doubles(t) : 0;
}

static double *put_vector(double *to, const phys_vec *from)
{
    for (int c = 0; c < 3; c++)
        *to++ = (*from)[c];
    return to;
}

FLOW_KERNEL(system_part, FLOW_NO_PART, struct flow_block_args,
            (R(table), R(f), R(a), R(dv), R(x), R(v), W(saved), IF_MADE(tie_table)))

static void put_rows(const struct flow_table *t, const struct system_part_fields *on, double *to)
{
    for (uint32_t i = 0; i < t->n; i++) {
        const double row[B] = {t->vertex[i], t->mass[i], t->matrix.diagonal[i], t->free[i]};
        for (int k = 0; k < B; k++)
            *to++ = row[k];
        const phys_vec *const vectors[] = {on->f, on->dv, on->x, on->v};
        for (size_t k = 0; k < 4; k++)
            to = put_vector(to, vectors[k] + i);
    }
}

/* Value i of entries in a format, as the part of the block has them. */
static double *put_value(const struct flow_table *t, enum solve_format format, const void *entry,
                         size_t i, double *to)
{
    struct solve_symmetric symmetric = {{0}, {0}};
    struct solve_columns n;
    phys_vec turn;
    if (t->format == SOLVE_SPRINGS) {
        memcpy(to, (const phys_vec *)entry + i, sizeof(phys_vec));
        return to + 4;
    }
    solve_entry_of(format, entry, i, &symmetric, &turn);
    solve_entry_columns(&symmetric, &turn, &n);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            *to++ = n.c[c][r];
    return to;
}

static double *put_place(const uint32_t place[3], double *to)
{
    for (int k = 0; k < 3; k++)
        *to++ = place[k];
    return to;
}

static double *put_entry(const struct flow_table *t, const struct solve_values *values, size_t i,
                         const uint32_t place[3], double *to)
{
    return put_value(t, t->format, values->entry, i, put_place(place, to));
}

static double *put_ties(const duite_call *call, const struct flow_table *t, uint32_t block,
                        const struct flow_ties *ties, const phys_vec *value, double *to)
{
    const struct flow_table *tables = flow_of(call)->tables.block;
    for (uint32_t i = 0, k = 0; i < ties->n; i++) {
        uint32_t place[] = {ties->end[i][0], block, ties->end[i][1]};
        while (i >= ties->n_inner && i - ties->n_inner >= ties->start[k + 1])
            k++;
        if (i >= ties->n_inner) {
            place[1] = ties->other[k];
            place[2] = tables[place[1]].n_halo + ties->far[i - ties->n_inner];
        }
        to = put_value(t, SOLVE_SPRINGS, value, i, put_place(place, to));
    }
    return to;
}

static double *put_entries(const struct flow_table *t, uint32_t block,
                           const struct solve_values *values, double *to)
{
    const struct solve_block *m = &t->matrix;
    for (uint32_t a = 0; a < t->n; a++)
        for (uint32_t i = m->row[a]; i < m->row[a + 1]; i++)
            to = put_entry(t, values, i, (const uint32_t[]){a, block, m->column[i]}, to);
    for (uint32_t s = 0; s < t->n_neighbours; s++)
        for (uint32_t i = t->cut_entry[s]; i < t->cut_entry[s + 1]; i++) {
            const uint32_t place[] = {t->ghost_end[i][0], t->neighbour[s],
                                      t->ghost[t->ghost_end[i][1]]};
            to = put_entry(t, values, m->row[t->n] + (size_t)i, place, to);
        }
    return to;
}

static int system_part_body(const duite_call *call, const struct system_part_fields *on)
{
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const void *value = flow_matrix_in(call, t, on->a);
    const struct solve_values values = solve_values_of(t->format, t->n, value);
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    const size_t numbers = duite_count(call, FLOW_INDEX_OF(system_part, saved));
    double *part = on->saved, *to = part + entries_at(t);
    put_rows(t, on, part);
    to = put_entries(t, on->args->block, &values, to);
    to = put_ties(call, t, on->args->block, &ties, flow_tie_values(t, value), to);
    for (; to < part + halo_at(t, room_of(t, numbers)); to += entry_doubles(t)) {
        memset(to, 0, entry_doubles(t) * sizeof *to);
        to[BLOCK] = -1;
    }
    for (uint32_t i = 0; i < t->n_halo; i++)
        *to++ = t->halo[i];
    return 0;
}
/* ---- On rank 0 ---- */

struct save_args {
    uint32_t block; /* none */
    double h;       /* s: length of the step */
};

FLOW_KERNEL_WITH(system_save, FLOW_NO_PART, struct save_args, (RW(token), ALL(saved)),
                 .side_effects = 1)

static uint32_t vertex_of(const double *part, double row)
{
    return (uint32_t)part[(size_t)ROW * (size_t)row + VERTEX];
}

static void take_rows(struct solve_system *system, const struct flow_table *t, const double *row)
{
    for (uint32_t i = 0; i < t->n; i++, row += ROW) {
        const size_t v = (size_t)row[VERTEX];
        system->mass[v] = row[MASS];
        system->diagonal[v] = row[DIAGONAL];
        system->free[v] = row[FREE];
        for (size_t c = 0; c < 3; c++) {
            system->b[3 * v + c] = row[B + c];
            system->dv[3 * v + c] = row[DV + c];
            system->x[3 * v + c] = row[X + c];
            system->v[3 * v + c] = row[V + c];
        }
    }
}

/* The row of another block at a place: in its halo, or behind that of a tie. */
static double row_there(const struct flow_table *t, const duite_param *part, double place)
{
    const double *numbers = part->data;
    return place < t->n_halo ? numbers[halo_at(t, room_of(t, part->count)) + (size_t)place]
                             : place - t->n_halo;
}

/* Of block b, by the parts of all blocks. */
static void take_entries(struct solve_system *system, const duite_call *call,
                         const duite_param *parts, uint32_t b)
{
    const struct flow_table *tables = flow_of(call)->tables.block, *t = tables + b;
    const double *own = flow_numbers_of(parts, b), *entry = own + entries_at(t);
    const double *end = own + halo_at(t, room_of(t, parts[b].count));
    for (; entry < end; entry += entry_doubles(t)) {
        if (entry[BLOCK] < b)
            continue;
        const uint32_t other = (uint32_t)entry[BLOCK];
        const double *there = flow_numbers_of(parts, other);
        const double row =
            other == b ? entry[THERE] : row_there(tables + other, parts + other, entry[THERE]);
        const size_t at = system->n_pairs++;
        system->end[at][0] = vertex_of(own, entry[HERE]);
        system->end[at][1] = vertex_of(there, row);
        if (system->block)
            memcpy(system->block[at], entry + VALUE, sizeof *system->block);
        else
            memcpy(system->value[at], entry + VALUE, sizeof *system->value);
    }
}

static int gather(const duite_call *call, const struct system_save_fields *on,
                  struct solve_system *system, struct cloth_error *error)
{
    const struct flow *flow = flow_of(call);
    const enum solve_pairs pairs =
        flow->model->format == SOLVE_SPRINGS ? SOLVE_PAIRS_OF_SPRINGS : SOLVE_PAIRS_OF_BLOCKS;
    size_t entries = 0;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++)
        entries += (size_t)flow->tables.block[b].n_entries + flow->tables.block[b].n_cut_entries +
                   room_of(flow->tables.block + b, on->saved[b].count);
    const int code = solve_system_make(system, flow->n_vertices, entries, pairs, error);
    if (code)
        return code;
    system->h = on->args->h;
    system->n_pairs = 0;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++) {
        take_rows(system, flow->tables.block + b, flow_numbers_of(on->saved, b));
        take_entries(system, call, on->saved, b);
    }
    return solve_system_sort(system, error);
}

static int system_save_body(const duite_call *call, const struct system_save_fields *on)
{
    struct flow *flow = flow_of(call);
    struct solve_system system = {0};
    int code = gather(call, on, &system, &flow->trouble);
    if (!code)
        code = flow->output->system(flow->output->context, &system, &flow->trouble);
    solve_system_free(&system);
    if (!code)
        return 0;
    return duite_fail(call, code == CLOTH_E_MEMORY ? FLOW_NO_MEMORY : FLOW_NOT_WRITTEN, "%s",
                      flow->trouble.text);
}
/* ---- The main program ---- */

int flow_system(struct flow_state *state)
{
    struct flow_block_args each;
    const struct save_args save = {.h = flow_attempt_args(state).h};
    const int code = flow_fork_each(state, &flow_kernel_system_part, &each);
    return code ? code : flow_fork_at(state, 0, &flow_kernel_system_save, &save, NULL);
}
