/* Ties in a solve (cloth/flow/joints/ties.h): the ties that every pass reads, and the corners that
 * blocks show each other: rows of s after each pass, coarse functions once a solve. */
#include "cloth/flow/solver/solver.h"

/* ---- Ties that add something ---- */

/* Where those of each kind start, then arrays with room for all ties. */
struct acting {
    uint32_t *start; /* SOLVE_TIE_KINDS + 1 */
    phys_vec *value;
    double (*weight)[SOLVE_TIE_CORNERS];
    uint32_t (*corner)[SOLVE_TIE_CORNERS];
};
_Static_assert((SOLVE_TIE_KINDS + 1) * sizeof(uint32_t) <= sizeof(phys_vec), "start takes a row");

/* Finds them behind the values of all ties. */
static struct acting find_acting(const struct flow_ties *ties, const phys_vec *value)
{
    const size_t room = ties->room.ties;
    phys_vec *rows = (phys_vec *)value + room; /* readers do not write */
    return (struct acting){(void *)rows, rows + 1, (void *)(rows + 1 + room),
                           (void *)(rows + 1 + 2 * room)};
}

/* The kind of tie i; SOLVE_TIE_KINDS: it adds nothing to rows of the block. */
static uint32_t kind_of_tie(const struct flow_ties *ties, uint32_t i, const phys_vec *value)
{
    uint32_t own = 0, ghosts = 0;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const bool here = ties->corner[i][k] < ties->n_rows;
        own += here && ties->weight[i][k] != 0;
        ghosts += !here;
    }
    if (!own || solve_is_nothing(value + i))
        return SOLVE_TIE_KINDS;
    if (ghosts)
        return own;
    return own == 1 ? SOLVE_TIE_ALONE : SOLVE_TIE_INNER;
}

/* Puts the rows of tie i first. Corners that it has not are the one before. */
static void put_corners(const struct flow_ties *ties, uint32_t i, uint32_t *corner, double *weight)
{
    int n = 0;
    for (int ghosts = 0; ghosts < 2; ghosts++)
        for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
            const uint32_t from = ties->corner[i][k];
            if (ghosts ? from < ties->n_rows : from >= ties->n_rows || ties->weight[i][k] == 0)
                continue;
            corner[n] = from;
            weight[n++] = ties->weight[i][k];
        }
    for (; n < SOLVE_TIE_CORNERS; n++) {
        corner[n] = corner[n - 1];
        weight[n] = 0;
    }
}

void flow_ties_gather(const struct flow_ties *ties, phys_vec *value)
{
    const struct acting to = find_acting(ties, value);
    uint32_t at[SOLVE_TIE_KINDS + 2] = {0}; /* one behind each kind */
    if (!ties->room.ties)
        return;
    for (uint32_t i = 0; i < ties->n; i++)
        at[1 + kind_of_tie(ties, i, value)]++;
    for (int kind = 0; kind < SOLVE_TIE_KINDS; kind++)
        at[kind + 1] += at[kind];
    memset(to.start, 0, sizeof *value);
    memcpy(to.start, at, (SOLVE_TIE_KINDS + 1) * sizeof *at);
    for (uint32_t i = 0; i < ties->n; i++) {
        const uint32_t kind = kind_of_tie(ties, i, value);
        if (kind == SOLVE_TIE_KINDS)
            continue;
        const uint32_t n = at[kind]++;
        to.value[n] = value[i];
        put_corners(ties, i, to.corner[n], to.weight[n]);
    }
    const size_t n = to.start[SOLVE_TIE_KINDS], rest = ties->room.ties - n;
    memset(to.value + n, 0, rest * sizeof *to.value);
    memset(to.weight + n, 0, rest * sizeof *to.weight);
    memset(to.corner + n, 0, rest * sizeof *to.corner);
}

struct solve_ties flow_ties_solved(const struct flow_ties *ties, const phys_vec *value,
                                   const phys_vec *p_other)
{
    static const uint32_t none[SOLVE_TIE_KINDS + 1];
    const struct acting acting = find_acting(ties, value);
    const uint32_t *start = ties->n ? acting.start : none;
    return (struct solve_ties){
        .n = start[SOLVE_TIE_KINDS],
        .start = start,
        .corner = (const uint32_t(*)[SOLVE_TIE_CORNERS])acting.corner,
        .weight = (const double(*)[SOLVE_TIE_CORNERS])acting.weight,
        .value = acting.value,
        .p_other = p_other,
    };
}

/* ---- Corners that are shown ---- */

/* Packs the rows that others see; zeros in spare room. */
static void pack_shown(const struct flow_ties *ties, const phys_vec *y, double *to)
{
    solve_pack(ties->n_shown, ties->shown, y, to);
    memset(to + 3 * (size_t)ties->n_shown, 0,
           3 * (flow_ties_rows(ties) - ties->n_shown) * sizeof *to);
}

/* For the first pass of a solve; the fork puts another vector in place of q. */
FLOW_KERNEL(tie_pack, FLOW_CG, struct flow_block_args, (R(tie_table), R(q), W(tie_q)))
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    pack_shown(&ties, on->q, on->tie_q);
    return 0;
}

/* For the next pass, after the one with these scalars. */
FLOW_KERNEL(tie_pack_pass, FLOW_CG, struct flow_block_args,
            (R(tie_table), R(scalars), R(dv), R(q), W(tie_q_next)))
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    pack_shown(&ties, on->scalars->phase == SOLVE_SHOW ? on->dv : on->q, on->tie_q_next);
    return 0;
}

FLOW_KERNEL(tie_show_basis, FLOW_CG, struct flow_block_args, (R(tie_table), R(basis), W(tie_basis)))
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    memset(on->tie_basis, 0, flow_ties_rows(&ties) * sizeof *on->tie_basis);
    for (uint32_t i = 0; i < ties.n_shown; i++)
        on->tie_basis[i] = on->basis[ties.shown[i]];
    return 0;
}

/* ---- Forks ---- */

static bool is_tied(const struct flow_state *state, uint32_t block)
{
    const uint32_t *first = state->tied.now.first;
    return first && first[block] < first[block + 1];
}

/* With a preconditioner others need s, without one q. */
static enum flow_field_id product_of(const struct flow_state *state)
{
    return flow_is_preconditioned(state->flow) ? FLOW_FIELD_s : FLOW_FIELD_q;
}

static int fork_pack(struct flow_state *state, const struct flow_kernel *kernel, uint32_t block,
                     enum flow_field_id shown)
{
    const struct flow_block_args args = {block};
    if (is_tied(state, block))
        flow_fork_one_as(state, kernel, &args, FLOW_AS({FLOW_FIELD_q, shown}));
    return state->code;
}

int flow_ties_pack_start(struct flow_state *state, uint32_t block, bool guess)
{
    return fork_pack(state, &flow_kernel_tie_pack, block,
                     guess ? FLOW_FIELD_dv : product_of(state));
}

int flow_ties_pack(struct flow_state *state, uint32_t block)
{
    return fork_pack(state, &flow_kernel_tie_pack_pass, block, product_of(state));
}

int flow_ties_show_basis(struct flow_state *state)
{
    struct flow_block_args args = {0};
    for (; args.block < state->flow->tables.n_blocks; args.block++)
        if (is_tied(state, args.block))
            flow_fork_one(state, &flow_kernel_tie_show_basis, &args);
    return state->code;
}
