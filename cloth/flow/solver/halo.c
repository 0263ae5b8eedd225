/* A pass of a solve reads q of its block's neighbours: their rims as they are where the neighbour
 * lives on the same rank; else a far rim, one for each block and rank that reads it, with the rows
 * that any block there needs: so a message holds nothing else. A task of its own packs it, since
 * the neighbours' passes still read its other half. Which it is depends on the homes that the
 * blocks have when a run begins and changes no result. All ranks know the rows of all far rims. */
#include "cloth/flow/bodies.h"
#include "cloth/flow/solver/solve.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

void flow_halo_take(struct flow_state *state)
{
    const struct flow_head *head = &state->head;
    struct cloth_error *trouble = &state->flow->trouble;
    struct flow_far *far = &state->far;
    const size_t slots = head->n_slots, copies = head->n_copies, rim = head->most_rim;
    for (int i = 0; i < 2; i++)
        far->read[i] = cloth_alloc(slots, sizeof *far->read[i], trouble);
    far->rim = cloth_alloc(slots, sizeof *far->rim, trouble);
    far->first = cloth_alloc((size_t)head->n_blocks + 1, sizeof *far->first, trouble);
    far->home = cloth_alloc(head->n_blocks, sizeof *far->home, trouble);
    far->number = cloth_alloc(rim, sizeof *far->number, trouble);
    state->flow->at = cloth_alloc(copies, sizeof *state->flow->at, trouble);
    state->flow->far_row = cloth_alloc(copies, sizeof *state->flow->far_row, trouble);
    state->flow->far_rim = cloth_alloc(slots, sizeof *state->flow->far_rim, trouble);
}

void flow_halo_free(struct flow_state *state)
{
    struct flow_far *far = &state->far;
    for (int i = 0; i < 2; i++)
        free(far->read[i]);
    free(far->rim);
    free(far->first);
    free(far->home);
    free(far->number);
    free(state->flow->at);
    free(state->flow->far_row);
    free(state->flow->far_rim);
    *far = (struct flow_far){0};
    state->flow->at = state->flow->far_row = NULL;
    state->flow->far_rim = NULL;
}

/* Neighbour slot s of block b, for who reads: the slot's place among all, its rows. */
struct reader {
    size_t slot;
    const uint32_t *row;
    uint32_t *at;
    size_t n;
};

static struct reader reader_of(struct flow_state *state, uint32_t b, uint32_t neighbour)
{
    const struct flow_tables *tables = &state->flow->tables;
    const struct flow_table *t = tables->block + b;
    uint32_t s = 0;
    while (t->slot[s] != neighbour)
        s++;
    const uint32_t *row = t->copy + t->copies[s];
    return (struct reader){.slot = (size_t)(t->slot - tables->slot) + s,
                           .row = row,
                           .at = state->flow->at + (row - tables->copy),
                           .n = t->copies[s + 1] - t->copies[s]};
}

/* Numbers the rows of block b that blocks of this home read, and lists their places in its rim in
 * `row`, which has room for them. Returns how many there are. */
static uint32_t number_rows(struct flow_state *state, uint32_t b, int home, uint32_t *row)
{
    const struct flow_table *t = state->flow->tables.block + b;
    struct flow_far *far = &state->far;
    memset(far->number, 0, t->n_rim * sizeof *far->number);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        if (far->home[t->slot[s]] != home)
            continue;
        const struct reader reader = reader_of(state, t->slot[s], b);
        for (size_t i = 0; i < reader.n; i++)
            far->number[reader.row[i]] = 1;
    }
    uint32_t n = 0;
    for (uint32_t i = 0; i < t->n_rim; i++) {
        if (!far->number[i])
            continue;
        row[n] = i;
        far->number[i] = n++;
    }
    return n;
}

/* The rim of block b that blocks of this home read. */
static void make_rim(struct flow_state *state, uint32_t b, int home)
{
    const struct flow_table *t = state->flow->tables.block + b;
    struct flow_far *far = &state->far;
    struct flow_far_rim *rim = state->flow->far_rim + far->n;
    duite_object *object = far->rim[far->n++].object;
    rim->row = state->flow->far_row + far->n_rows;
    rim->n = number_rows(state, b, home, state->flow->far_row + far->n_rows);
    far->n_rows += rim->n;
    for (int i = 0; i < 2; i++) {
        duite_new(state->rt, DUITE_F64, 3 * (size_t)rim->n, object + i);
        duite_colocate(state->rt, object[i], state->block[b].x);
    }
    for (uint32_t s = 0; s < t->n_slots; s++) {
        if (far->home[t->slot[s]] != home)
            continue;
        const struct reader reader = reader_of(state, t->slot[s], b);
        for (size_t i = 0; i < reader.n; i++)
            reader.at[i] = far->number[reader.row[i]];
        far->read[0][reader.slot] = object[0];
        far->read[1][reader.slot] = object[1];
    }
}

static void read_rims(struct flow_state *state, uint32_t b, uint32_t neighbour)
{
    const struct reader reader = reader_of(state, neighbour, b);
    memcpy(reader.at, reader.row, reader.n * sizeof *reader.at);
    for (int i = 0; i < 2; i++)
        state->far.read[i][reader.slot] = state->block[b].rim_q[i];
}

/* Whether slot s of a block is the first one with its home. */
static bool is_first(const struct flow_far *far, const struct flow_table *t, uint32_t s)
{
    for (uint32_t i = 0; i < s; i++)
        if (far->home[t->slot[i]] == far->home[t->slot[s]])
            return false;
    return true;
}

void flow_halo_make(struct flow_state *state)
{
    const struct flow_tables *tables = &state->flow->tables;
    struct flow_far *far = &state->far;
    for (uint32_t b = 0; b < tables->n_blocks; b++)
        far->home[b] = duite_home(state->rt, state->block[b].x);
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        const struct flow_table *t = tables->block + b;
        far->first[b] = far->n;
        for (uint32_t s = 0; s < t->n_slots; s++) {
            const int home = far->home[t->slot[s]];
            if (home == far->home[b])
                read_rims(state, b, t->slot[s]);
            else if (is_first(far, t, s))
                make_rim(state, b, home);
        }
    }
    far->first[tables->n_blocks] = far->n;
}

int flow_halo_pack(struct flow_state *state, uint32_t b, int to)
{
    const struct flow_far *far = &state->far;
    int code = DUITE_OK;
    for (uint32_t i = far->first[b]; i < far->first[b + 1] && !code; i++)
        code = DUITE_FORK(state->rt, &flow_pack, &i, state->block[b].rim_q[to],
                          far->rim[i].object[to]);
    return code;
}

static int pack_rows(const duite_call *call)
{
    const uint32_t *i = call->args;
    const struct flow_far_rim *rim = flow_of(call)->far_rim + *i;
    const double *from = duite_in(call, 0, double);
    double *to = duite_out(call, 1, double);
    for (uint32_t k = 0; k < rim->n; k++, to += 3)
        memcpy(to, from + 3 * (size_t)rim->row[k], 3 * sizeof *to);
    return 0;
}

static int pack(const duite_call *call)
{
    return flow_timed(call, pack_rows, FLOW_CG);
}
const duite_kernel flow_pack = {
    .name = "cg_pack", .body = pack, .access = {DUITE_R, DUITE_W}, .args_size = sizeof(uint32_t)};
