/* Postponed parameters of a task that runs on another rank, with all that it forks. There the scope
 * begins with the values that came. Each parameter goes back to a version, or to a leaf, without
 * waiters; the answer is read from it when the subtree is over. At home nothing is ever forked in
 * the scope. It gets the results as by duite_set, and ends like any other. */
#include "runtime/task/scope.h"

#include "runtime/data/law.h"

#include <string.h>

/* ---- On the other rank ---- */

static bool lend_contribution(struct task_scope *inner, struct task_access *access,
                              const struct data_object *object)
{
    struct data_sum *sum =
        data_sum_new(inner->graph->n_ranks, object->law, object->type, object->count);
    struct data_piece *leaf = sum ? data_sum_leaf(sum, 0) : NULL;
    if (!leaf) {
        if (sum)
            data_sum_free(sum);
        return false;
    }
    access->leaf = leaf;
    task_lend(inner, access, object, NULL, NULL);
    return true;
}

bool task_lend_value(struct task_scope *inner, struct task_access *access,
                     const struct data_object *object, const void *values, size_t bytes)
{
    const duite_mode mode = task_immediate((duite_mode)access->waiter.mode);
    if (mode == DUITE_CW)
        return lend_contribution(inner, access, object);
    struct data_version *in = mode == DUITE_W ? NULL : task_value_version(object, values, bytes);
    struct data_version *out = mode == DUITE_R ? NULL : data_object_version(object);
    if ((!in && mode != DUITE_W) || (!out && mode != DUITE_R)) {
        if (in)
            data_version_release(in);
        if (out)
            data_version_free(out);
        return false;
    }
    access->left = out;
    task_lend(inner, access, object, in, out);
    return true;
}

struct task_left_value task_lent_left(const struct task_access *access)
{
    const bool contributes = access->waiter.mode == DUITE_CWP;
    struct task_left_value left = {0};
    if (contributes && access->leaf) {
        const struct data_piece *leaf = access->leaf;
        left.failure = leaf->failure;
        left.values = leaf->value;
        left.bytes = data_sum_bytes(leaf->sum);
    } else if (!contributes && access->left) {
        struct data_packet *packet = data_version_packet(access->left);
        left.failure = data_version_failure(access->left);
        left.values = packet ? data_payload(packet) : NULL;
        left.bytes = packet ? packet->bytes : 0;
    }
    return left;
}

void task_lent_drop(struct task_access *access)
{
    if (access->waiter.mode == DUITE_CWP && access->leaf)
        data_sum_free(access->leaf->sum);
    else if (access->waiter.mode != DUITE_CWP && access->left)
        data_version_release(access->left);
    access->left = NULL;
}

/* ---- At home ---- */

static void leaf_comes_home(struct data_piece *leaf, const struct task_left_value *left)
{
    leaf->failure = left->failure;
    if (!left->values)
        return;
    leaf->packet = data_packet_new(left->bytes, false);
    if (!leaf->packet) {
        leaf->failure = &task_scope_no_memory;
        return;
    }
    leaf->value = data_payload(leaf->packet);
    memcpy(leaf->value, left->values, left->bytes);
}

void task_lent_comes_home(struct task_scope *inner, struct worker *worker, size_t lent,
                          const struct task_left_value *left)
{
    struct task_nest *nest = task_nest_of(inner);
    struct data_object *object = &nest->local[lent];
    if (nest->exit[lent].sum) {
        leaf_comes_home(nest->exit[lent].leaf, left);
        return;
    }
    struct data_version *version = task_value_version(object, left->values, left->bytes);
    if (!version) {
        task_scope_fail(inner, &task_scope_no_memory);
        return;
    }
    data_version_poison(version, left->failure);
    task_note_version(object, object->holder);
    task_forget(inner->graph, worker, object);
    object->current = version;
}
