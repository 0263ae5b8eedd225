/* Ties in a solve (cloth/flow/joints/ties.h): the ties that every pass reads, and the corners that
 * blocks show each other: rows of s after each pass, coarse functions once a solve. */
#include "cloth/flow/solver/solver.h"

/* ---- Ties that add something ---- */

/* Their number, then arrays with room for all ties. */
struct acting {
    uint64_t *n;
    phys_vec *value;
    double (*weight)[SOLVE_TIE_CORNERS];
    uint32_t (*corner)[SOLVE_TIE_CORNERS];
};

/* Finds them behind the values of all ties. */
static struct acting find_acting(const struct flow_ties *ties, const phys_vec *value)
{
    const size_t room = ties->room.ties;
    phys_vec *rows = (phys_vec *)value + room; /* readers do not write */
    return (struct acting){(void *)rows, rows + 1, (void *)(rows + 1 + room),
                           (void *)(rows + 1 + 2 * room)};
}

void flow_ties_gather(const struct flow_ties *ties, phys_vec *value)
{
    const struct acting to = find_acting(ties, value);
    size_t n = 0;
    for (uint32_t i = 0; i < ties->n; i++) {
        if (solve_is_nothing(value + i))
            continue;
        to.value[n] = value[i];
        memcpy(to.weight[n], ties->weight[i], sizeof to.weight[n]);
        memcpy(to.corner[n], ties->corner[i], sizeof to.corner[n]);
        n++;
    }
    if (!ties->room.ties)
        return;
    const size_t rest = ties->room.ties - n;
    memset(to.value + n, 0, rest * sizeof *to.value);
    memset(to.weight + n, 0, rest * sizeof *to.weight);
    memset(to.corner + n, 0, rest * sizeof *to.corner);
    memset(to.n, 0, sizeof *value);
    *to.n = n;
}

struct solve_ties flow_ties_solved(const struct flow_ties *ties, const phys_vec *value,
                                   const phys_vec *p_other)
{
    const struct acting acting = find_acting(ties, value);
    return (struct solve_ties){
        .n = ties->n ? *acting.n : 0,
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
static int tie_pack_body(const duite_call *call, const struct tie_pack_fields *on)
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    pack_shown(&ties, on->q, on->tie_q);
    return 0;
}

/* For the next pass, after the one with these scalars. */
FLOW_KERNEL(tie_pack_pass, FLOW_CG, struct flow_block_args,
            (R(tie_table), R(scalars), R(dv), R(q), W(tie_q_next)))
static int tie_pack_pass_body(const duite_call *call, const struct tie_pack_pass_fields *on)
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    pack_shown(&ties, on->scalars->phase == SOLVE_SHOW ? on->dv : on->q, on->tie_q_next);
    return 0;
}

FLOW_KERNEL(tie_show_basis, FLOW_CG, struct flow_block_args, (R(tie_table), R(basis), W(tie_basis)))
static int tie_show_basis_body(const duite_call *call, const struct tie_show_basis_fields *on)
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
