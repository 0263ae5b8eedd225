/* Sums in the part of one rank. Its list of subtrees of the present sum begins with what its own
 * leaves make, and grows by what it receives; each has a place. A PARTIAL combines as soon as there
 * are halves, a SUM folds what is left: both go by data/subtrees.h. */
#include "runtime/plan/part.h"

static struct plan_round_node *part_add(struct plan_parting *p, enum plan_kind kind, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    struct plan_round_node *made = plan_round_add(p->part, kind, node->fork);
    made->law = node->law;
    return made;
}

/* Combines this rank's contributions to a piece. */
static void part_combine_leaves(struct plan_parting *p, struct plan_round_node *made,
                                const struct plan_piece *piece)
{
    const struct plan_round_node *node = &p->round->node[piece->node];
    const struct plan_node_use *leaf = &p->round->use[node->first_use + 1];
    const uint64_t end = data_subtree_end(&piece->tree, node->n_uses - 1);
    p->row.n = 0;
    for (uint64_t first = piece->tree.first; first < end; first++) {
        const uint32_t param = made->n_uses;
        plan_round_use(p->part, made, plan_part_leaf(p, leaf[first].place), true, true);
        data_subtrees_push(&p->row, (struct data_subtree){.first = first, .where = param},
                           plan_merge, p->part);
    }
    data_subtrees_fold(&p->row, plan_merge, p->part);
}

/* Combines the contributions of this rank to pieces of more than one leaf. */
static void part_partial(struct plan_parting *p, size_t n)
{
    struct plan_round_node *made = NULL;
    for (size_t i = p->m->first_piece[n]; i < p->m->first_piece[n + 1]; i++) {
        const struct plan_piece *piece = &p->m->piece[i];
        if (piece->rank != p->m->rank || !piece->tree.level)
            continue;
        if (!made)
            made = part_add(p, PLAN_PARTIAL, n);
        part_combine_leaves(p, made, piece);
    }
}

/* A relayed sum begins with this rank's own pieces, any other sum with all pieces. */
static void part_begin_sum(struct plan_parting *p, size_t n)
{
    p->state.n = 0;
    for (size_t i = p->m->first_piece[n]; i < p->m->first_piece[n + 1]; i++) {
        const struct plan_piece *piece = &p->m->piece[i];
        const bool own = piece->rank == p->m->rank;
        if (!own && (p->m->rounds[n] || !plan_runs(p->a, n, p->m->rank)))
            continue;
        struct data_subtree *entry = &p->state.at[p->state.n++];
        *entry = piece->tree;
        entry->where = own ? plan_part_piece(p, piece) : p->arrival[i];
    }
}

/* A PARTIAL that joins the lists of a sum; made once two subtrees combine. */
struct part_joining {
    struct plan_parting *p;
    size_t n; /* the sum */
    struct plan_round_node *made;
};

static uint32_t part_param(struct part_joining *j, uint32_t place)
{
    uint32_t *param = &j->p->param[place];
    if (*param == PLAN_NONE) {
        *param = j->made->n_uses;
        plan_round_use(j->p->part, j->made, place, true, true);
    }
    return *param;
}

static void part_combine_places(void *context, uint32_t left, uint32_t right)
{
    struct part_joining *j = context;
    if (!j->made)
        j->made = part_add(j->p, PLAN_PARTIAL, j->n);
    const uint32_t into = part_param(j, left);
    plan_merge(j->p->part, into, part_param(j, right));
}

/* Joins the subtrees received in this round, in items from `first` on, with those present. */
static void part_join(struct plan_parting *p, size_t n, size_t first)
{
    struct part_joining joining = {.p = p, .n = n};
    const struct data_subtrees state = p->state;
    p->came.n = 0;
    for (size_t i = first; i < p->next_item; i++) {
        if (plan_part_sends(p, p->m->item[i].message))
            continue;
        struct data_subtree *came = &p->came.at[p->came.n++];
        *came = p->m->item[i].tree;
        came->where = p->place[i];
    }
    data_subtrees_join(&p->joined, &state, &p->came, part_combine_places, &joining);
    p->state = p->joined;
    p->joined = state;
    for (size_t i = 0; joining.made && i < joining.made->n_uses; i++)
        p->param[p->part->use[joining.made->first_use + i].place] = PLAN_NONE;
}

void plan_part_sum(struct plan_parting *p, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    struct plan_round_node *made = part_add(p, PLAN_SUM, n);
    made->owner = node->owner;
    plan_round_use(p->part, made, p->round->use[node->first_use].place, true, true);
    p->row.n = 0;
    for (size_t i = 0; i < p->state.n; i++) {
        struct data_subtree subtree = p->state.at[i];
        subtree.where = made->n_uses;
        plan_round_use(p->part, made, p->state.at[i].where, true, true);
        data_subtrees_push(&p->row, subtree, plan_merge, p->part);
    }
    data_subtrees_fold(&p->row, plan_merge, p->part);
}

void plan_part_before_sum(struct plan_parting *p, size_t n)
{
    const uint32_t rounds = p->m->rounds[n];
    const size_t fork = p->round->node[n].fork;
    part_partial(p, n);
    part_begin_sum(p, n);
    for (uint32_t round = 0; round <= rounds; round++) {
        const size_t first = p->next_item;
        plan_part_moment(p, plan_moment_sum(n, round), fork);
        if (round < rounds)
            part_join(p, n, first);
    }
}
