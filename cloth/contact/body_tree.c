/* A node halves its triangles at the median and halves both halves again: four parts, each a leaf
 * once it is small. The shape of the tree depends on the number of triangles alone. */
#include "cloth/base/memory.h"
#include "cloth/contact/body.h"

#include <math.h>
#include <stdlib.h>

struct item {
    double key;
    uint32_t triangle;
};

struct tree {
    uint32_t *order;
    const phys_vec *low, *high;
    struct item *item;
    struct contact_node *nodes;
    uint32_t n_nodes;
};

/* Parts of n things: i to i + 1 of four. */
uint32_t contact_tree_part(uint32_t n, int i)
{
    const uint32_t half = n / 2;
    const uint32_t begin[5] = {0, half / 2, half, half + (n - half) / 2, n};
    return begin[i];
}

uint32_t contact_tree_nodes(uint32_t n_triangles)
{
    uint32_t n = 1;
    for (int i = 0; i < 4; i++) {
        const uint32_t part =
            contact_tree_part(n_triangles, i + 1) - contact_tree_part(n_triangles, i);
        n += part > CONTACT_LEAF ? contact_tree_nodes(part) : 0;
    }
    return n;
}

static int body_tree_by_key(const void *left, const void *right)
{
    const struct item *a = left, *b = right;
    if (a->key < b->key || a->key > b->key)
        return a->key < b->key ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

/* Puts triangles in the order of their middles along the axis in which those are farthest apart. */
static void sort_range(struct tree *tree, uint32_t from, uint32_t to)
{
    double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
    int axis = 0;
    for (uint32_t i = from; i < to; i++) {
        const phys_vec twice = tree->low[tree->order[i]] + tree->high[tree->order[i]];
        for (int c = 0; c < 3; c++) {
            least[c] = fmin(least[c], twice[c]);
            most[c] = fmax(most[c], twice[c]);
        }
    }
    for (int c = 1; c < 3; c++)
        axis = most[c] - least[c] > most[axis] - least[axis] ? c : axis;
    for (uint32_t i = from; i < to; i++) {
        const uint32_t triangle = tree->order[i];
        tree->item[i].key = tree->low[triangle][axis] + tree->high[triangle][axis];
        tree->item[i].triangle = triangle;
    }
    qsort(tree->item + from, to - from, sizeof *tree->item, body_tree_by_key);
    for (uint32_t i = from; i < to; i++)
        tree->order[i] = tree->item[i].triangle;
}

static float round_down(double x)
{
    const float near = (float)x;
    return (double)near > x ? nextafterf(near, -INFINITY) : near;
}

static void put_box(const struct tree *tree, struct contact_node *node, int part, uint32_t from,
                    uint32_t to)
{
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = from; i < to; i++) {
            low = fmin(low, tree->low[tree->order[i]][c]);
            high = fmax(high, tree->high[tree->order[i]][c]);
        }
        node->low[c][part] = round_down(low);
        node->high[c][part] = -round_down(-high);
    }
}

/* Fits the box of a part of a node to its facets, or to the boxes of its child, which are already
 * fit. */
static void refit_part(const struct contact_facet *facet, const phys_vec *x,
                       struct contact_node *nodes, struct contact_node *node, int part)
{
    const uint32_t child = node->child[part];
    const bool leaf = child & CONTACT_IS_LEAF;
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; leaf && i < contact_leaf_n(child); i++)
            for (int k = 0; k < 3; k++) {
                const double at = x[facet[contact_leaf_first(child) + i].corner[k]][c];
                low = fmin(low, at);
                high = fmax(high, at);
            }
        /* GCC 12 for arm64 fails over it as a loop. */
        PHYS_UNROLL
        for (int i = 0; !leaf && i < 4; i++) {
            low = fmin(low, (double)nodes[child].low[c][i]);
            high = fmax(high, (double)nodes[child].high[c][i]);
        }
        node->low[c][part] = round_down(low);
        node->high[c][part] = -round_down(-high);
    }
}

/* A node has a lower number than those below it. */
void contact_tree_refit(uint32_t n_nodes, const struct contact_facet *facet, const phys_vec *x,
                        struct contact_node *nodes)
{
    for (uint32_t n = n_nodes; n > 0; n--)
        for (int part = 0; part < 4; part++)
            if (nodes[n - 1].low[0][part] <= nodes[n - 1].high[0][part])
                refit_part(facet, x, nodes, nodes + n - 1, part);
}

/* Returns the number of the node that has these. */
static uint32_t build_node(struct tree *tree, uint32_t from, uint32_t to)
{
    const uint32_t n = to - from, number = tree->n_nodes++;
    struct contact_node *node = tree->nodes + number;
    sort_range(tree, from, to);
    sort_range(tree, from, from + contact_tree_part(n, 2));
    sort_range(tree, from + contact_tree_part(n, 2), to);
    for (int i = 0; i < 4; i++) {
        const uint32_t begin = from + contact_tree_part(n, i),
                       end = from + contact_tree_part(n, i + 1);
        put_box(tree, node, i, begin, end);
        node->child[i] = end - begin > CONTACT_LEAF
                             ? build_node(tree, begin, end)
                             : CONTACT_IS_LEAF | (end > begin ? end - begin - 1 : 0) << 29 | begin;
    }
    return number;
}

int contact_tree_build(uint32_t n, uint32_t *order, const phys_vec *low, const phys_vec *high,
                       struct contact_node *nodes, struct cloth_error *error)
{
    struct tree tree = {.order = order, .low = low, .high = high, .nodes = nodes};
    tree.item = cloth_alloc(n, sizeof *tree.item, error);
    if (!tree.item)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < n; i++)
        order[i] = i;
    build_node(&tree, 0, n);
    free(tree.item);
    return CLOTH_OK;
}
