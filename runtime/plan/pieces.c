/* Pieces of sums. The pieces of a sum cover its leaves in order, each once. Those of a rank are the
 * subtrees that it can combine alone, by data/subtrees.h. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"

/* Returns whether the rank alone runs the sum. */
static bool pieces_stay(const struct plan_assignment *a, size_t n, int rank)
{
    return plan_runs(a, n, rank) && base_ranks_count(plan_runs_set(a, n), a->words) == 1;
}

/* A rank's pieces move once its last leaf is there. `latest` is by rank. */
static void pieces_set_phases(const struct plan_messages *m, size_t n, size_t first,
                              uint32_t *latest)
{
    const struct plan_assignment *a = m->assignment;
    const struct plan_round_node *node = &a->round->node[n];
    const struct plan_node_use *use = &a->round->use[node->first_use];
    for (size_t i = 1; i < node->n_uses; i++)
        latest[a->at[plan_message_leaf(m, &use[i])]] = 0;
    for (size_t i = 1; i < node->n_uses; i++) {
        const uint32_t leaf = plan_message_leaf(m, &use[i]);
        if (m->phase[leaf] > latest[a->at[leaf]])
            latest[a->at[leaf]] = m->phase[leaf];
    }
    for (size_t i = first; i < m->n_pieces; i++)
        m->piece[i].phase = latest[m->piece[i].rank];
}

static void piece_append(struct plan_messages *m, size_t n, int rank, struct data_subtree tree)
{
    m->piece[m->n_pieces++] = (struct plan_piece){.node = (uint32_t)n, .tree = tree, .rank = rank};
}

/* A rank has the leaves first .. end - 1. If it has all, they become one piece, or stay as they are
 * if it alone runs the sum. */
static void pieces_of_row(struct plan_messages *m, size_t n, int rank, uint32_t first, uint32_t end)
{
    const uint32_t all = m->assignment->round->node[n].n_uses - 1;
    struct data_subtree row[DATA_SUBTREES_IN_ROW];
    struct data_subtrees list = {.at = row};
    if (end - first < all) {
        data_subtrees_row(&list, first, end - first);
        for (size_t i = 0; i < list.n; i++)
            piece_append(m, n, rank, row[i]);
    } else if (!pieces_stay(m->assignment, n, rank)) {
        piece_append(m, n, rank, data_subtree_whole(all));
    } else {
        for (uint32_t i = first; i < end; i++)
            piece_append(m, n, rank, (struct data_subtree){.first = i});
    }
}

static void pieces_of_sum(struct plan_messages *m, size_t n, uint32_t *latest)
{
    const struct plan_assignment *a = m->assignment;
    const struct plan_round_node *node = &a->round->node[n];
    const struct plan_node_use *use = &a->round->use[node->first_use + 1];
    const size_t first = m->n_pieces;
    for (uint32_t i = 0, end; i + 1 < node->n_uses; i = end) {
        const int rank = a->at[plan_message_leaf(m, &use[i])];
        for (end = i + 1; end + 1 < node->n_uses; end++)
            if (a->at[plan_message_leaf(m, &use[end])] != rank)
                break;
        pieces_of_row(m, n, rank, i, end);
    }
    pieces_set_phases(m, n, first, latest);
}

bool plan_pieces_find(struct plan_messages *m)
{
    const struct plan_assignment *a = m->assignment;
    uint32_t *latest = base_alloc((size_t)a->n_ranks * sizeof *latest);
    for (size_t n = 0; n < a->round->n_nodes && latest; n++) {
        m->first_piece[n] = m->n_pieces;
        if (a->round->node[n].kind == PLAN_SUM && !plan_is_dead(a, n))
            pieces_of_sum(m, n, latest);
        m->first_piece[n + 1] = m->n_pieces;
    }
    base_free(latest);
    return latest != NULL;
}
