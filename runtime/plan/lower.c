/* Lowering: from the forks of a round to its nodes. Only this pass adds nodes to a program's forks:
 * it decides when contributions end, and the tree in which they combine. Invariant: the nodes so
 * far are all those that must run before the next fork, in an order in which a program could run
 * them one after the other. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"
#include "runtime/data/order.h"

/* The open contributions of an object. */
struct lower_object {
    uint32_t first, last, n_open; /* their buffers */
    const duite_law *law;         /* of these */
};

struct lowering {
    struct plan_round *round;
    size_t n_sums; /* accesses that contribute */
    struct lower_object *object;
    uint32_t *next; /* by buffer, less n_objects: the next of the same sum */
};

/* ---- A round under construction ---- */

uint32_t plan_round_buffer(struct plan_round *round, uint32_t object, const duite_law *law)
{
    round->place[round->n_places] = (struct plan_round_place){.object = object, .law = law};
    return (uint32_t)round->n_places++;
}

bool plan_round_room(struct plan_round *round, size_t nodes, size_t uses, size_t places,
                     size_t merges)
{
    const struct base_array arrays[] = {BASE_ARRAY(round->node, nodes + 1),
                                        BASE_ARRAY(round->use, uses + 1),
                                        BASE_ARRAY(round->place, places + 1),
                                        BASE_ARRAY(round->merge, merges + 1),
                                        {0}};
    round->memory = base_arrays(arrays);
    if (!round->memory)
        return false;
    round->n_objects = round->source->n_objects;
    for (uint32_t i = 0; i < round->n_objects; i++)
        plan_round_buffer(round, i, NULL);
    return true;
}

void plan_round_free(struct plan_round *round)
{
    base_free(round->memory);
    base_free(round->edge);
    *round = (struct plan_round){0};
}

void plan_merge(void *to, uint32_t left, uint32_t right)
{
    struct plan_round *round = to;
    round->merge[round->n_merges++] = (struct plan_merge){left, right};
    round->node[round->n_nodes - 1].n_merges++;
}

/* ---- Contributions ---- */

/* A buffer for a contribution, which becomes the last open one. */
static uint32_t lower_contribution(struct lowering *l, const struct plan_access *access)
{
    struct lower_object *object = &l->object[access->object];
    uint32_t leaf = plan_round_buffer(l->round, access->object, access->law);
    object->law = access->law;
    if (object->n_open++)
        l->next[object->last - l->round->n_objects] = leaf;
    else
        object->first = leaf;
    object->last = leaf;
    return leaf;
}

/* Ends the open contributions to the object, if any. */
static void lower_sum(struct lowering *l, uint32_t name, size_t fork)
{
    struct plan_round *round = l->round;
    struct lower_object *object = &l->object[name];
    if (!object->n_open)
        return;
    struct plan_round_node *node = plan_round_add(round, PLAN_SUM, fork);
    struct data_subtree row[64]; /* a counter's bits, and one more for a moment: leaves are fewer */
    struct data_subtrees list = {.at = row};
    node->owner = name;
    node->law = object->law;
    plan_round_use(round, node, name, true, true);
    uint32_t leaf = object->first;
    for (uint32_t i = 0; i < object->n_open; i++) {
        plan_round_use(round, node, leaf, true, false);
        data_subtrees_push(&list, (struct data_subtree){.first = i, .where = i + 1}, plan_merge,
                           round);
        leaf = l->next[leaf - round->n_objects];
    }
    data_subtrees_fold(&list, plan_merge, round);
    object->n_open = 0;
}

/* ---- Forks ---- */

/* Adds the sums that must come before the fork. */
static void lower_ends(struct lowering *l, size_t i)
{
    const struct plan_source_fork *fork = &l->round->source->fork[i];
    const struct plan_access *access = l->round->source->access + fork->first;
    for (uint32_t k = 0; k < fork->n; k++)
        if (!data_order_joins(access[k].mode, access[k].law, l->object[access[k].object].law))
            lower_sum(l, access[k].object, i);
}

static void lower_fork(struct lowering *l, size_t i)
{
    struct plan_round *round = l->round;
    const struct plan_source_fork *fork = &round->source->fork[i];
    const struct plan_access *access = round->source->access + fork->first;
    if (l->n_sums)
        lower_ends(l, i);
    struct plan_round_node *node = plan_round_add(round, fork->sets ? PLAN_SET : PLAN_TASK, i);
    node->owner = fork->owner;
    for (uint32_t k = 0; k < fork->n; k++) {
        duite_mode mode = access[k].mode;
        if (mode == DUITE_CW)
            plan_round_use(round, node, lower_contribution(l, &access[k]), false, true);
        else
            plan_round_use(round, node, access[k].object, data_order_reads(mode),
                           data_order_writes(mode));
    }
}

static void lower_all(struct lowering *l)
{
    struct plan_round *round = l->round;
    size_t n = round->source->n_forks, end = n ? n - 1 : 0;
    for (size_t i = 0; i < n; i++)
        lower_fork(l, i);
    for (uint32_t i = 0; i < round->n_objects; i++)
        lower_sum(l, i, end);
    if (round->source->flag == PLAN_NONE)
        return;
    struct plan_round_node *node = plan_round_add(round, PLAN_FLAG, end);
    node->owner = round->source->flag;
    plan_round_use(round, node, round->source->flag, true, false);
}

/* ---- The pass ---- */

static void lower_count(struct lowering *l)
{
    const struct plan_source *source = l->round->source;
    for (size_t i = 0; i < source->n_accesses; i++)
        l->n_sums += source->access[i].mode == DUITE_CW;
}

/* A sum uses its object and at least one contribution. */
static bool lower_room(struct lowering *l)
{
    const struct plan_source *source = l->round->source;
    const size_t more = l->n_sums + 1, objects = source->n_objects;
    l->object = base_alloc_zero((objects + 1) * sizeof *l->object);
    l->next = base_alloc_zero((l->n_sums + 1) * sizeof *l->next);
    return l->object && l->next &&
           plan_round_room(l->round, source->n_forks + more, source->n_accesses + 2 * more,
                           objects + l->n_sums, l->n_sums);
}

bool plan_lower(struct plan_round *round, const struct plan_source *source)
{
    struct lowering l = {.round = round};
    round->source = source;
    lower_count(&l);
    const bool fine = lower_room(&l);
    if (fine)
        lower_all(&l);
    base_free(l.object);
    base_free(l.next);
    return fine;
}
