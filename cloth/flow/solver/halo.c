/* A pass reads q of neighbours on the same rank from their halos. For each other rank a block has
 * one packed halo, with the rows that blocks there need. So messages hold only these rows. A
 * separate task packs the halo, since the neighbours' passes still read its other half. The choice
 * between the two halos depends on the blocks' homes at the run's begin and changes no result. All
 * ranks know the rows of all packed halos. */
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"

#include <string.h>

void flow_halo_take(struct flow_state *state)
{
    const struct flow_head *head = &state->head;
    struct flow *flow = state->flow;
    struct flow_packed *packed = &state->packed;
    const size_t neighbours = head->n_neighbours;
    for (int i = 0; i < 2; i++)
        packed->read[i] = flow_take(flow, neighbours, sizeof *packed->read[i]);
    packed->halo = flow_take(flow, neighbours, sizeof *packed->halo);
    packed->first = flow_take(flow, (size_t)head->n_blocks + 1, sizeof *packed->first);
    packed->home = flow_take(flow, head->n_blocks, sizeof *packed->home);
    packed->number = flow_take(flow, head->max_halo, sizeof *packed->number);
    flow->at = flow_take(flow, head->n_ghosts, sizeof *flow->at);
    flow->packed_row = flow_take(flow, head->n_ghosts, sizeof *flow->packed_row);
    flow->packed_halo = flow_take(flow, neighbours, sizeof *flow->packed_halo);
}

/* Neighbour s of block b, for a reader: the neighbour's place among all, its rows. */
struct reader {
    size_t neighbour;
    const uint32_t *row;
    uint32_t *at;
    size_t n;
};

static struct reader reader_of(struct flow_state *state, uint32_t b, uint32_t neighbour)
{
    const struct flow_tables *tables = &state->flow->tables;
    const struct flow_table *t = tables->block + b;
    uint32_t s = 0;
    while (t->neighbour[s] != neighbour)
        s++;
    const uint32_t *row = t->ghost + t->ghost_start[s];
    return (struct reader){.neighbour = (size_t)(t->neighbour - tables->neighbour) + s,
                           .row = row,
                           .at = state->flow->at + (row - tables->ghost),
                           .n = t->ghost_start[s + 1] - t->ghost_start[s]};
}

/* Numbers the rows of block b that blocks of this home read, and lists their places in its halo in
 * `row`, which has room for them. Returns their number. */
static uint32_t number_rows(struct flow_state *state, uint32_t b, int home, uint32_t *row)
{
    const struct flow_table *t = state->flow->tables.block + b;
    struct flow_packed *packed = &state->packed;
    memset(packed->number, 0, t->n_halo * sizeof *packed->number);
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        if (packed->home[t->neighbour[s]] != home)
            continue;
        const struct reader reader = reader_of(state, t->neighbour[s], b);
        for (size_t i = 0; i < reader.n; i++)
            packed->number[reader.row[i]] = 1;
    }
    uint32_t n = 0;
    for (uint32_t i = 0; i < t->n_halo; i++) {
        if (!packed->number[i])
            continue;
        row[n] = i;
        packed->number[i] = n++;
    }
    return n;
}

/* The halo of block b that blocks of this home read. */
static void make_halo(struct flow_state *state, uint32_t b, int home)
{
    const struct flow_table *t = state->flow->tables.block + b;
    struct flow_packed *packed = &state->packed;
    struct flow_packed_halo *halo = state->flow->packed_halo + packed->n;
    duite_object *object = packed->halo[packed->n++].object;
    halo->row = state->flow->packed_row + packed->n_rows;
    halo->n = number_rows(state, b, home, state->flow->packed_row + packed->n_rows);
    packed->n_rows += halo->n;
    for (int i = 0; i < 2; i++) {
        duite_new(state->rt, DUITE_F64, 3 * (size_t)halo->n, object + i);
        duite_colocate(state->rt, object[i], state->block[b].x);
    }
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        if (packed->home[t->neighbour[s]] != home)
            continue;
        const struct reader reader = reader_of(state, t->neighbour[s], b);
        for (size_t i = 0; i < reader.n; i++)
            reader.at[i] = packed->number[reader.row[i]];
        packed->read[0][reader.neighbour] = object[0];
        packed->read[1][reader.neighbour] = object[1];
    }
}

static void read_halos(struct flow_state *state, uint32_t b, uint32_t neighbour)
{
    const struct reader reader = reader_of(state, neighbour, b);
    memcpy(reader.at, reader.row, reader.n * sizeof *reader.at);
    for (int i = 0; i < 2; i++)
        state->packed.read[i][reader.neighbour] = state->block[b].halo_q[i];
}

/* True if neighbour s of a block is the first one with its home. */
static bool halo_is_first(const struct flow_packed *packed, const struct flow_table *t, uint32_t s)
{
    for (uint32_t i = 0; i < s; i++)
        if (packed->home[t->neighbour[i]] == packed->home[t->neighbour[s]])
            return false;
    return true;
}

void flow_halo_make(struct flow_state *state)
{
    const struct flow_tables *tables = &state->flow->tables;
    struct flow_packed *packed = &state->packed;
    for (uint32_t b = 0; b < tables->n_blocks; b++)
        packed->home[b] = duite_home(state->rt, state->block[b].x);
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        const struct flow_table *t = tables->block + b;
        packed->first[b] = packed->n;
        for (uint32_t s = 0; s < t->n_neighbours; s++) {
            const int home = packed->home[t->neighbour[s]];
            if (home == packed->home[b])
                read_halos(state, b, t->neighbour[s]);
            else if (halo_is_first(packed, t, s))
                make_halo(state, b, home);
        }
    }
    packed->first[tables->n_blocks] = packed->n;
}

struct pack_args {
    uint32_t block, halo; /* halo: among all that are packed */
};

FLOW_KERNEL(cg_pack, FLOW_CG, struct pack_args, (GIVEN_R(whole_halo), GIVEN_W(packed_halo)))
{
    const struct flow_packed_halo *halo = flow_of(call)->packed_halo + on->args->halo;
    double *to = on->packed_halo;
    for (uint32_t k = 0; k < halo->n; k++, to += 3)
        memcpy(to, on->whole_halo + 3 * (size_t)halo->row[k], 3 * sizeof *to);
    return 0;
}

int flow_halo_pack(struct flow_state *state, uint32_t b, int to)
{
    const struct flow_packed *packed = &state->packed;
    for (uint32_t i = packed->first[b]; i < packed->first[b + 1]; i++) {
        const struct pack_args args = {.block = b, .halo = i};
        const struct flow_with with = {.whole_halo = state->block[b].halo_q[to],
                                       .packed_halo = packed->halo[i].object[to]};
        flow_fork_with(state, &flow_kernel_cg_pack, &args, &with);
    }
    return state->code;
}
