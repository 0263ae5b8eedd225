/* The system of the last step, gathered on rank 0. Each block reports its part in numbers; one task
 * on rank 0 makes plain arrays of all parts. An entry between two blocks is reported by both; the
 * report of the lower block counts. Ties (cloth/flow/joints/ties.h) are reported by all blocks that
 * they have corners in, and become a pair for each two corners. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/state/bodies.h"

#include "cloth/solve/system.h"

/* A part: rows, entries, room for ties, rows of the halo. A row has its vertex, mass, diagonal and
 * free, then vectors. An entry has its row here, the block of its other end and the row there, then
 * its values: those of a spring, or N by rows. A block less than 0: there is no entry any more. In
 * another block the row is its place in the halo there. A tie has of each corner block, row and
 * weight, or zeros, then the value of a spring. */
enum { VERTEX, MASS, DIAGONAL, FREE, B, DV = B + 3, X = DV + 3, V = X + 3, ROW = V + 3 };
enum { HERE, BLOCK, THERE, VALUE, SPRING = VALUE + 4, PAIR = VALUE + SOLVE_NINE };
enum { CORNER_BLOCK, CORNER_ROW, CORNER_WEIGHT, CORNER };
enum { TIE_VALUE = SOLVE_TIE_CORNERS * CORNER, TIE = TIE_VALUE + 4 };

static size_t entry_doubles(const struct flow_table *t)
{
    return t->format == SOLVE_SPRINGS ? SPRING : PAIR;
}

static size_t entries_at(const struct flow_table *t)
{
    return (size_t)ROW * t->n;
}

static size_t ties_at(const struct flow_table *t)
{
    return entries_at(t) + entry_doubles(t) * ((size_t)t->n_entries + t->n_cut_entries);
}

static size_t halo_at(const struct flow_table *t, size_t room)
{
    return ties_at(t) + TIE * room;
}

size_t flow_system_doubles(const struct flow_table *t, size_t room)
{
    return halo_at(t, room) + t->n_halo;
}

/* How many ties a part of so many numbers has room for. */
static size_t room_of(const struct flow_table *t, size_t numbers)
{
    const size_t least = flow_system_doubles(t, 0);
    return numbers > least ? (numbers - least) / TIE : 0;
}

static double *observe_system_put_vector(double *to, const phys_vec *from)
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
            to = observe_system_put_vector(to, vectors[k] + i);
    }
}

/* Value i of the entries. */
static double *observe_system_put_value(const struct flow_table *t, const void *entry, size_t i,
                                        double *to)
{
    struct solve_symmetric symmetric = {{0}, {0}};
    struct solve_columns n;
    phys_vec turn;
    if (t->format == SOLVE_SPRINGS) {
        memcpy(to, (const phys_vec *)entry + i, sizeof(phys_vec));
        return to + 4;
    }
    solve_entry_of(t->format, entry, i, &symmetric, &turn);
    solve_entry_columns(&symmetric, &turn, &n);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            *to++ = n.c[c][r];
    return to;
}

static double *observe_system_put_place(const uint32_t place[3], double *to)
{
    for (int k = 0; k < 3; k++)
        *to++ = place[k];
    return to;
}

static double *put_entry(const struct flow_table *t, const struct solve_values *values, size_t i,
                         const uint32_t place[3], double *to)
{
    return observe_system_put_value(t, values->entry, i, observe_system_put_place(place, to));
}

static void put_corner(uint32_t block, const struct flow_ties *ties, uint32_t corner, double weight,
                       double to[CORNER])
{
    const uint32_t ghost = corner - ties->n_rows;
    const bool own = corner < ties->n_rows;
    to[CORNER_BLOCK] = own ? block : ties->other[ties->ghost_other[ghost]];
    to[CORNER_ROW] = own ? corner : ties->ghost_row[ghost];
    to[CORNER_WEIGHT] = weight;
}

static void observe_system_put_ties(uint32_t block, const struct flow_ties *ties,
                                    const phys_vec *value, double *to)
{
    memset(to, 0, TIE * (size_t)ties->room.ties * sizeof *to);
    for (uint32_t i = 0; i < ties->n; i++, to += TIE) {
        for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
            if (ties->weight[i][k] != 0)
                put_corner(block, ties, ties->corner[i][k], ties->weight[i][k], to + CORNER * k);
        memcpy(to + TIE_VALUE, value + i, sizeof *value);
    }
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
    double *part = on->saved, *to = part + entries_at(t);
    put_rows(t, on, part);
    to = put_entries(t, on->args->block, &values, to);
    for (; to < part + ties_at(t); to += entry_doubles(t)) {
        memset(to, 0, entry_doubles(t) * sizeof *to);
        to[BLOCK] = -1;
    }
    observe_system_put_ties(on->args->block, &ties, flow_tie_values(t, value), to);
    to = part + halo_at(t, ties.room.ties);
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

static uint32_t observe_system_vertex_of(const double *part, double row)
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

/* The row of another block at a place in its halo. */
static double row_there(const struct flow_table *t, const duite_param *part, double place)
{
    const double *numbers = part->data;
    return numbers[halo_at(t, room_of(t, part->count)) + (size_t)place];
}

/* N = scale (w w' + alpha I), by rows. */
static void nine_of(double scale, const double value[4], double nine[SOLVE_NINE])
{
    for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
            nine[3 * c + d] = scale * (value[c] * value[d] + (c == d ? value[3] : 0));
}

/* Takes the entries of block b; parts: of all blocks. */
static void take_entries(struct solve_system *system, const duite_call *call,
                         const duite_param *parts, uint32_t b)
{
    const struct flow_table *tables = flow_of(call)->tables.block, *t = tables + b;
    const double *own = flow_numbers_of(parts, b), *entry = own + entries_at(t);
    const double *end = own + ties_at(t);
    for (; entry < end; entry += entry_doubles(t)) {
        if (entry[BLOCK] < b)
            continue;
        const uint32_t other = (uint32_t)entry[BLOCK];
        const double *there = flow_numbers_of(parts, other);
        const double row =
            other == b ? entry[THERE] : row_there(tables + other, parts + other, entry[THERE]);
        const size_t at = system->n_pairs++;
        system->end[at][0] = observe_system_vertex_of(own, entry[HERE]);
        system->end[at][1] = observe_system_vertex_of(there, row);
        if (!system->block)
            memcpy(system->value[at], entry + VALUE, sizeof *system->value);
        else if (t->format == SOLVE_SPRINGS)
            nine_of(1, entry + VALUE, system->block[at]);
        else
            memcpy(system->block[at], entry + VALUE, sizeof *system->block);
    }
}

/* ---- Ties on rank 0 ----
 *
 * The weights w_k of a tie and its value N give pairs with -w_k w_l N. If the weights do not sum to
 * zero, pairs with the ground, a held vertex behind all others, have the rest. */

/* The pairs that the ties of all parts make. */
struct tied_pairs {
    size_t n;
    bool springs; /* each is a spring */
    bool ground;  /* some are with the ground */
};

/* True if there is a tie, and b is its lowest block. */
static bool counts(const double *tie, uint32_t b)
{
    bool lowest = false;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const double *corner = tie + CORNER * k;
        if (corner[CORNER_WEIGHT] != 0 && corner[CORNER_BLOCK] < b)
            return false;
        lowest = lowest || corner[CORNER_WEIGHT] != 0;
    }
    return lowest;
}

/* The sum of the weights; rounding errors count as zero. */
static double sum_of_weights(const double *tie)
{
    double sum = 0;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
        sum += tie[CORNER * k + CORNER_WEIGHT];
    return fabs(sum) > 1e-12 ? sum : 0;
}

static void count_tie(const double *tie, struct tied_pairs *pairs)
{
    const bool ground = sum_of_weights(tie) != 0;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const double weight = tie[CORNER * k + CORNER_WEIGHT];
        pairs->n += weight != 0 && ground;
        for (int l = 0; l < k && weight != 0; l++) {
            const double other = tie[CORNER * l + CORNER_WEIGHT];
            pairs->n += other != 0;
            pairs->springs = pairs->springs && (other == 0 || weight * other == -1);
        }
    }
    pairs->springs = pairs->springs && !ground;
    pairs->ground = pairs->ground || ground;
}

static void observe_system_add_pair(struct solve_system *system, uint32_t a, uint32_t b,
                                    double scale, const double *tie)
{
    const size_t at = system->n_pairs++;
    system->end[at][0] = a;
    system->end[at][1] = b;
    if (system->block)
        nine_of(scale, tie + TIE_VALUE, system->block[at]);
    else
        memcpy(system->value[at], tie + TIE_VALUE, sizeof *system->value);
}

static void add_tie(struct solve_system *system, uint32_t ground, const duite_param *parts,
                    const double *tie)
{
    const double sum = sum_of_weights(tie);
    uint32_t vertex[SOLVE_TIE_CORNERS] = {0};
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const double *corner = tie + CORNER * k, weight = corner[CORNER_WEIGHT];
        if (weight == 0)
            continue;
        vertex[k] = observe_system_vertex_of(flow_numbers_of(parts, (size_t)corner[CORNER_BLOCK]),
                                             corner[CORNER_ROW]);
        if (sum != 0)
            observe_system_add_pair(system, vertex[k], ground, weight * sum, tie);
        for (int l = 0; l < k; l++)
            if (tie[CORNER * l + CORNER_WEIGHT] != 0)
                observe_system_add_pair(system, vertex[l], vertex[k],
                                        -weight * tie[CORNER * l + CORNER_WEIGHT], tie);
    }
}

/* Counts the ties of all parts or, where there is a system, adds them. */
static void each_tie(const struct flow *flow, const duite_param *parts, struct tied_pairs *pairs,
                     struct solve_system *system)
{
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++) {
        const struct flow_table *t = flow->tables.block + b;
        const double *tie = flow_numbers_of(parts, b) + ties_at(t);
        const double *end = tie + TIE * room_of(t, parts[b].count);
        for (; tie < end; tie += TIE)
            if (counts(tie, b) && system)
                add_tie(system, flow->n_vertices, parts, tie);
            else if (counts(tie, b))
                count_tie(tie, pairs);
    }
}

static int gather_system(const duite_call *call, const struct system_save_fields *on,
                         struct solve_system *system, struct cloth_error *error)
{
    const struct flow *flow = flow_of(call);
    struct tied_pairs tied = {.springs = flow->model->format == SOLVE_SPRINGS};
    each_tie(flow, on->saved, &tied, NULL);
    size_t entries = tied.n;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++)
        entries += (size_t)flow->tables.block[b].n_entries + flow->tables.block[b].n_cut_entries;
    const enum solve_pairs pairs = tied.springs ? SOLVE_PAIRS_OF_SPRINGS : SOLVE_PAIRS_OF_BLOCKS;
    const int code =
        solve_system_make(system, flow->n_vertices + tied.ground, entries, pairs, error);
    if (code)
        return code;
    system->h = on->args->h;
    system->n_pairs = 0;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++) {
        take_rows(system, flow->tables.block + b, flow_numbers_of(on->saved, b));
        take_entries(system, call, on->saved, b);
    }
    each_tie(flow, on->saved, NULL, system);
    return solve_system_sort(system, error);
}

static int system_save_body(const duite_call *call, const struct system_save_fields *on)
{
    struct flow *flow = flow_of(call);
    struct solve_system system = {0};
    int code = gather_system(call, on, &system, &flow->trouble);
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
