/* Borders of parts, from the leaves up. Sides of a part's triangles that go between the same points
 * in opposite senses cancel; the remaining ones are the border. A node's border is made of those of
 * its children. */
#include "cloth/base/memory.h"
#include "cloth/contact/skin_table.h"

#include <stdlib.h>
#include <string.h>

enum { FEW = 40 }; /* sides that are sorted one by one */
#define NONE UINT32_MAX

/* A side: its ends, the lower one above, and its direction: 1 from the higher one. */
static uint64_t skin_loops_side_of(uint32_t a, uint32_t b)
{
    return a < b ? (uint64_t)a << 32 | (uint64_t)b << 1 : (uint64_t)b << 32 | (uint64_t)a << 1 | 1;
}

static uint32_t begin_of(uint64_t side)
{
    return side & 1 ? (uint32_t)side >> 1 : (uint32_t)(side >> 32);
}

static uint32_t end_of(uint64_t side)
{
    return side & 1 ? (uint32_t)(side >> 32) : (uint32_t)side >> 1;
}

struct making {
    const struct contact_skin *skin;
    struct contact_loop *loop;
    uint32_t *along;
    uint64_t room, n_along;
    uint64_t *side; /* a stack */
    size_t n;
    uint32_t *next; /* a point: the one behind it on the border, or NONE */
};

static int by_side(const void *a, const void *b)
{
    const uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return (left > right) - (left < right);
}

static void skin_loops_sort_sides(uint64_t *side, size_t n)
{
    if (n > FEW) {
        qsort(side, n, sizeof *side, by_side);
        return;
    }
    for (size_t i = 1; i < n; i++) {
        const uint64_t one = side[i];
        size_t k = i;
        for (; k > 0 && side[k - 1] > one; k--)
            side[k] = side[k - 1];
        side[k] = one;
    }
}

/* Takes away those on the stack, from `from` on, that have an opposite. */
static void reduce(struct making *making, size_t from)
{
    uint64_t *side = making->side;
    size_t kept = from;
    skin_loops_sort_sides(side + from, making->n - from);
    for (size_t i = from; i < making->n;) {
        const uint64_t ends = side[i] >> 1;
        long net = 0;
        for (; i < making->n && side[i] >> 1 == ends; i++)
            net += side[i] & 1 ? -1 : 1;
        for (; net; net += net > 0 ? -1 : 1)
            side[kept++] = ends << 1 | (net < 0);
    }
    making->n = kept;
}

/* Appends the line that n sides make. Returns true if it is one simple line. */
static bool skin_loops_walk(struct making *making, const uint64_t *side, size_t n)
{
    uint32_t *along = making->along + making->n_along, at = n ? begin_of(side[0]) : 0;
    bool simple = n >= 3 && making->n_along + n <= making->room;
    for (size_t i = 0; i < n && simple; i++) {
        simple = making->next[begin_of(side[i])] == NONE;
        making->next[begin_of(side[i])] = end_of(side[i]);
    }
    for (size_t i = 0; i < n && simple; i++, at = making->next[at]) {
        simple = making->next[at] != NONE && (i == 0 || at != along[0]);
        along[i] = at;
    }
    simple = simple && at == along[0];
    for (size_t i = 0; i < n; i++)
        making->next[begin_of(side[i])] = NONE;
    return simple;
}

static void skin_loops_put_loop(struct making *making, size_t from, struct contact_loop *loop)
{
    const size_t n = making->n - from;
    if (!skin_loops_walk(making, making->side + from, n))
        return;
    *loop = (struct contact_loop){(uint32_t)making->n_along, (uint32_t)n};
    making->n_along += n;
}

static void push_leaf(struct making *making, const struct contact_leaf *leaf)
{
    for (uint32_t t = leaf->triangle; t < leaf->triangle + leaf->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            making->side[making->n++] = skin_loops_side_of(making->skin->corner[t][k],
                                                           making->skin->corner[t][(k + 1) % 3]);
}

/* Leaves the border of a node on the stack. */
static void push_node(struct making *making, uint32_t node, struct contact_loop *loop)
{
    const size_t from = making->n;
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t child = making->skin->child[node][k];
        if (child & CONTACT_IS_LEAF)
            push_leaf(making, making->skin->leaf + (child & ~CONTACT_IS_LEAF));
        else
            push_node(making, child, making->loop + contact_loop_at(making->skin, node, k));
    }
    reduce(making, from);
    skin_loops_put_loop(making, from, loop);
}

int contact_loops_make(const struct contact_skin *skin, uint64_t room, struct contact_loop *loop,
                       uint32_t *along, struct cloth_error *error)
{
    struct making making = {.skin = skin, .loop = loop, .along = along, .room = room};
    making.side = cloth_alloc(3 * (size_t)skin->n_triangles, sizeof *making.side, error);
    making.next = cloth_alloc(skin->n_points, sizeof *making.next, error);
    const int code = making.side && making.next ? CLOTH_OK : CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < skin->n_points && !code; i++)
        making.next[i] = NONE;
    if (!code)
        push_node(&making, 0, loop + contact_loop_at(skin, NONE, 0));
    free(making.side);
    free(making.next);
    return code;
}
