/* A pass of a solve reads q of its block's neighbours: their rims as they are where the neighbour
 * lives on the same rank; else a view of them, one a block and rank that reads it, with the rows
 * that any block there needs, so that a message holds nothing else. Which it is depends on the
 * homes that the blocks have when a run begins and changes no result. */
#include "cloth/flow/tasks/tasks.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

void flow_far_take(struct flow_state *state)
{
    const struct flow_tables *tables = &state->flow->tables;
    struct cloth_error *trouble = &state->flow->trouble;
    struct flow_far *far = &state->far;
    size_t slots = 0, copies = 0, rim = 0;
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        slots += tables->block[b].n_slots;
        copies += tables->block[b].n_copies;
        rim = larger(rim, tables->block[b].n_rim);
    }
    for (int i = 0; i < 2; i++)
        far->read[i] = cloth_alloc(slots, sizeof *far->read[i], trouble);
    far->view = cloth_alloc(2 * slots, sizeof *far->view, trouble);
    far->home = cloth_alloc(tables->n_blocks, sizeof *far->home, trouble);
    far->number = cloth_alloc(rim, sizeof *far->number, trouble);
    far->element = cloth_alloc(3 * rim, sizeof *far->element, trouble);
    state->flow->at = cloth_alloc(copies, sizeof *state->flow->at, trouble);
}

void flow_far_free(struct flow_state *state)
{
    struct flow_far *far = &state->far;
    for (int i = 0; i < 2; i++)
        free(far->read[i]);
    free(far->view);
    free(far->home);
    free(far->number);
    free(far->element);
    free(state->flow->at);
    *far = (struct flow_far){0};
    state->flow->at = NULL;
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

/* Numbers the rows of block b that blocks of this home read, and lists their numbers in the rim.
 * Returns how many of these there are. */
static size_t number_rows(struct flow_state *state, uint32_t b, int home)
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
        for (size_t c = 0; c < 3; c++)
            far->element[3 * (size_t)n + c] = 3 * (size_t)i + c;
        far->number[i] = n++;
    }
    return 3 * (size_t)n;
}

/* The views of block b that blocks of this home read. */
static int make_views(struct flow_state *state, uint32_t b, int home)
{
    const struct flow_table *t = state->flow->tables.block + b;
    struct flow_far *far = &state->far;
    const size_t n = number_rows(state, b, home);
    duite_object view[2];
    for (int i = 0; i < 2; i++) {
        const int code = duite_view(state->rt, state->block[b].rim_q[i], n, far->element, view + i);
        if (code)
            return code;
        far->view[far->n_views++] = view[i];
    }
    for (uint32_t s = 0; s < t->n_slots; s++) {
        if (far->home[t->slot[s]] != home)
            continue;
        const struct reader reader = reader_of(state, t->slot[s], b);
        for (size_t i = 0; i < reader.n; i++)
            reader.at[i] = far->number[reader.row[i]];
        far->read[0][reader.slot] = view[0];
        far->read[1][reader.slot] = view[1];
    }
    return DUITE_OK;
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

int flow_far_make(struct flow_state *state)
{
    const struct flow_tables *tables = &state->flow->tables;
    struct flow_far *far = &state->far;
    int code = DUITE_OK;
    for (uint32_t b = 0; b < tables->n_blocks; b++)
        far->home[b] = duite_home(state->rt, state->block[b].x);
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        const struct flow_table *t = tables->block + b;
        for (uint32_t s = 0; s < t->n_slots && !code; s++) {
            const int home = far->home[t->slot[s]];
            if (home == far->home[b])
                read_rims(state, b, t->slot[s]);
            else if (is_first(far, t, s))
                code = make_views(state, b, home);
        }
    }
    return code;
}
