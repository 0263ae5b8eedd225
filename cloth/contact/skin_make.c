/* A skin has its triangles in the order of the tree, and features in the order of the triangles
 * that they are of. Sizes, like the shape of the tree, depend on the counts alone, so the room for
 * a skin is known without its triangles. */
#include "cloth/base/memory.h"
#include "cloth/contact/skin_table.h"

#include <stdlib.h>
#include <string.h>

static uint64_t skin_make_whole_lines(uint64_t bytes)
{
    return (bytes + CONTACT_ALIGN - 1) / CONTACT_ALIGN * CONTACT_ALIGN;
}

enum { ALONG = 2 }; /* points of loops for each triangle */

/* ---- Sizes ---- */

/* The leaves of n nodes, empty ones included: each node but the first is a child. */
static uint32_t leaves_of(uint32_t n_nodes)
{
    return 3 * n_nodes + 1;
}

/* Parts of a node that are small enough are leaves. */
static uint32_t count_nodes(uint32_t n_triangles)
{
    uint32_t n = 1;
    for (int i = 0; i < 4; i++) {
        const uint32_t part =
            contact_tree_part(n_triangles, i + 1) - contact_tree_part(n_triangles, i);
        n += part > CONTACT_SKIN_LEAF ? count_nodes(part) : 0;
    }
    return n;
}

/* Places of a skin of these counts. */
static void lay_skin(const struct contact_skin *skin, struct contact_skin_head *head)
{
    const uint32_t n_nodes = count_nodes(skin->n_triangles);
    *head = (struct contact_skin_head){.n_points = skin->n_points,
                                       .n_triangles = skin->n_triangles,
                                       .n_edges = skin->n_edges,
                                       .n_vertices = skin->n_vertices,
                                       .n_nodes = n_nodes,
                                       .n_leaves = leaves_of(n_nodes)};
    head->corner = skin_make_whole_lines(sizeof *head);
    head->edge = head->corner + skin_make_whole_lines(head->n_triangles * sizeof *skin->corner);
    head->beside = head->edge + skin_make_whole_lines(head->n_edges * sizeof *skin->edge);
    head->vertex = head->beside + skin_make_whole_lines(head->n_edges * sizeof *skin->beside);
    const uint64_t by_point = skin_make_whole_lines(head->n_points * sizeof *skin->id);
    head->number = head->vertex + skin_make_whole_lines(head->n_vertices * sizeof *skin->vertex);
    head->id = head->number + skin_make_whole_lines(head->n_triangles * sizeof *skin->number);
    head->joined = head->id + by_point;
    head->block = head->joined + by_point;
    head->row = head->block + by_point;
    head->cloth = head->row + by_point;
    head->held = head->cloth + by_point;
    head->child = head->held + skin_make_whole_lines(head->n_points);
    head->leaf = head->child + skin_make_whole_lines(head->n_nodes * sizeof *skin->child);
    head->around = head->leaf + skin_make_whole_lines(head->n_leaves * sizeof *skin->leaf);
    head->triangle_bits = head->around + skin_make_whole_lines(3 * (uint64_t)head->n_triangles *
                                                               sizeof *skin->around);
    head->edge_bits = head->triangle_bits +
                      skin_make_whole_lines(head->n_triangles * sizeof *skin->triangle_bits);
    head->vertex_bits =
        head->edge_bits + skin_make_whole_lines(head->n_edges * sizeof *skin->edge_bits);
    head->loop =
        head->vertex_bits + skin_make_whole_lines(head->n_vertices * sizeof *skin->vertex_bits);
    head->along =
        head->loop + skin_make_whole_lines((4 * (uint64_t)n_nodes + 1) * sizeof *skin->loop);
    head->n_along = ALONG * (uint64_t)head->n_triangles;
    head->bytes = head->along + skin_make_whole_lines(head->n_along * sizeof *skin->along);
}

size_t contact_skin_bytes(const struct contact_skin *skin)
{
    struct contact_skin_head head;
    lay_skin(skin, &head);
    return head.bytes;
}

/* A leaf may have one group of features of each kind that is not full. */
void contact_boxes_lay(const struct contact_skin *skin, struct contact_boxes_head *head)
{
    const uint32_t n_nodes = skin->n_nodes ? skin->n_nodes : count_nodes(skin->n_triangles);
    const uint64_t n_groups = 3 * (uint64_t)leaves_of(n_nodes) + contact_groups(skin->n_triangles) +
                              contact_groups(skin->n_vertices) + contact_groups(skin->n_edges);
    *head = (struct contact_boxes_head){.nodes = skin_make_whole_lines(sizeof *head)};
    head->slopes = head->nodes + n_nodes * sizeof(struct contact_boxes);
    head->groups = head->slopes + n_nodes * sizeof(struct contact_slopes);
    head->points = head->groups + n_groups * sizeof(struct contact_boxes);
    head->ways = head->points + skin->n_points * sizeof(struct contact_point_box);
    head->moved = head->ways + leaves_of(n_nodes) * sizeof(struct contact_point_box);
    head->bytes = skin_make_whole_lines(head->moved + n_nodes + skin->n_points);
}

size_t contact_boxes_bytes(const struct contact_skin *skin)
{
    struct contact_boxes_head head;
    contact_boxes_lay(skin, &head);
    return head.bytes;
}

/* ---- Making ---- */

struct making {
    const struct contact_skin_source *from;
    struct contact_node *node;
    phys_vec *low, *high; /* of triangles */
    uint32_t *order;
    struct third *third; /* of the three edges of each triangle, by edge */
    uint32_t (*corner)[3], (*edge)[2], (*beside)[2], *vertex, *number, (*child)[4];
    struct contact_leaf *leaf;
    uint32_t *around, *triangle_bits, *edge_bits, *vertex_bits;
    uint32_t n_vertices, n_edges, n_nodes, n_leaves, n_groups, n_around; /* so far */
};

/* An edge of a triangle, the lower point first, and the third point. */
struct third {
    uint64_t edge;
    uint32_t point;
};

static struct third third_of(uint32_t a, uint32_t b, uint32_t point)
{
    const uint64_t low = a < b ? a : b, high = a < b ? b : a;
    return (struct third){low << 32 | high, point};
}

static int compare_thirds(const void *left, const void *right)
{
    const struct third *a = left, *b = right;
    const int edge = (a->edge > b->edge) - (a->edge < b->edge);
    return edge ? edge : (a->point > b->point) - (a->point < b->point);
}

static void list_thirds(struct making *making)
{
    const struct contact_skin_source *from = making->from;
    struct third *to = making->third;
    for (uint32_t t = 0; t < from->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t *corner = from->corner[t];
            *to++ = third_of(corner[k], corner[(k + 1) % 3], corner[(k + 2) % 3]);
        }
    qsort(making->third, (size_t)(to - making->third), sizeof *to, compare_thirds);
}

static void bound_triangles(struct making *making)
{
    const struct contact_skin_source *from = making->from;
    for (uint32_t t = 0; t < from->n_triangles; t++) {
        phys_vec low = from->x[from->corner[t][0]], high = low;
        for (int k = 1; k < 3; k++) {
            const phys_vec x = from->x[from->corner[t][k]];
            for (int c = 0; c < 3; c++) {
                low[c] = x[c] < low[c] ? x[c] : low[c];
                high[c] = x[c] > high[c] ? x[c] : high[c];
            }
        }
        making->low[t] = low;
        making->high[t] = high;
    }
}

/* The points beside an edge, of which there may be more than two: the first two. */
static void skin_make_find_beside(const struct making *making, const uint32_t edge[2],
                                  uint32_t beside[2])
{
    const struct third key = third_of(edge[0], edge[1], 0);
    size_t low = 0, high = 3 * (size_t)making->from->n_triangles;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_thirds(making->third + middle, &key) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    beside[0] = beside[1] = CONTACT_NO_POINT;
    for (int k = 0; k < 2 && low < 3 * (size_t)making->from->n_triangles; k++, low++)
        if (making->third[low].edge == key.edge)
            beside[k] = making->third[low].point;
}

/* The bit of a point in the last leaf, which gets it if it is new there. */
static uint32_t bit_of_point(struct making *making, struct contact_leaf *leaf, uint32_t point)
{
    uint32_t k = 0;
    while (k < leaf->n_points && making->around[leaf->point + k] != point)
        k++;
    if (k == leaf->n_points) {
        making->around[making->n_around++] = point;
        leaf->n_points++;
    }
    return UINT32_C(1) << k;
}

/* The features that a triangle stands for are the next ones. bit: of its corners. */
static void add_features(struct making *making, uint32_t triangle, const uint32_t bit[3],
                         struct contact_leaf *leaf)
{
    const uint32_t *corner = making->from->corner[triangle];
    const unsigned stands = making->from->stands[triangle];
    const unsigned shared = making->from->shared ? making->from->shared[triangle] : 0;
    for (int k = 0; k < 3; k++) {
        if (stands >> k & 1) {
            making->vertex_bits[making->n_vertices] = bit[k];
            making->vertex[making->n_vertices++] = corner[k];
            leaf->n_vertices++;
        }
        if (stands >> (3 + k) & 1) {
            uint32_t *edge = making->edge[making->n_edges];
            edge[0] = corner[k];
            edge[1] = corner[(k + 1) % 3];
            making->edge_bits[making->n_edges] = bit[k] | bit[(k + 1) % 3];
            uint32_t *beside = making->beside[making->n_edges++];
            skin_make_find_beside(making, edge, beside);
            if (beside[1] == CONTACT_NO_POINT && shared >> k & 1)
                beside[1] = CONTACT_FAR_POINT;
            leaf->n_edges++;
        }
    }
}

/* Triangles first .. first + n - 1 in the order of the tree. Returns the number of the leaf. */
static uint32_t add_leaf(struct making *making, uint32_t first, uint32_t n)
{
    struct contact_leaf *leaf = making->leaf + making->n_leaves;
    *leaf = (struct contact_leaf){.triangle = first,
                                  .n_triangles = n,
                                  .vertex = making->n_vertices,
                                  .edge = making->n_edges,
                                  .point = making->n_around,
                                  .group = making->n_groups};
    for (uint32_t t = first; t < first + n; t++) {
        uint32_t bit[3];
        memcpy(making->corner[t], making->from->corner[making->order[t]], sizeof making->corner[t]);
        making->number[t] = making->order[t];
        for (int k = 0; k < 3; k++)
            bit[k] = bit_of_point(making, leaf, making->corner[t][k]);
        making->triangle_bits[t] = bit[0] | bit[1] | bit[2];
        add_features(making, making->order[t], bit, leaf);
    }
    making->n_groups = contact_edge_group(leaf) + contact_groups(leaf->n_edges);
    return making->n_leaves++;
}

/* Those of a node of the tree that has n triangles from `from` on, in the order of their triangles.
 * Returns its number here. */
static uint32_t skin_make_add_node(struct making *making, uint32_t of, uint32_t from, uint32_t n)
{
    const uint32_t number = making->n_nodes++;
    for (int k = 0; k < 4; k++) {
        const uint32_t begin = from + contact_tree_part(n, k);
        const uint32_t size = from + contact_tree_part(n, k + 1) - begin;
        making->child[number][k] =
            size > CONTACT_SKIN_LEAF
                ? skin_make_add_node(making, making->node[of].child[k], begin, size)
                : CONTACT_IS_LEAF | add_leaf(making, begin, size);
    }
    return number;
}

static void count_features(const struct contact_skin_source *from, struct contact_skin *skin)
{
    *skin = (struct contact_skin){.n_points = from->n_points, .n_triangles = from->n_triangles};
    for (uint32_t t = 0; t < from->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            skin->n_vertices += from->stands[t] >> k & 1;
            skin->n_edges += from->stands[t] >> (3 + k) & 1;
        }
}

static int make_scratch(struct making *making, struct cloth_error *error)
{
    const uint32_t n = making->from->n_triangles, n_nodes = contact_tree_nodes(n);
    const size_t bytes = n_nodes * sizeof *making->node + 2 * (size_t)n * sizeof *making->low;
    making->order = cloth_alloc(n, sizeof *making->order, error);
    making->third = cloth_alloc(3 * (size_t)n, sizeof *making->third, error);
    making->node = aligned_alloc(CONTACT_ALIGN, skin_make_whole_lines(bytes));
    if (!making->node || !making->order || !making->third)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a skin of %u triangles", n);
    making->low = (void *)(making->node + n_nodes);
    making->high = making->low + n;
    return CLOTH_OK;
}

static void put_points(const struct contact_skin_source *from, const struct contact_skin_head *head,
                       char *table)
{
    const size_t n = from->n_points;
    if (!n)
        return;
    memcpy(table + head->id, from->id, n * sizeof *from->id);
    memcpy(table + head->joined, from->joined ? from->joined : from->id, n * sizeof *from->id);
    memcpy(table + head->held, from->held, n);
    if (!from->block)
        return;
    memcpy(table + head->block, from->block, n * sizeof *from->block);
    memcpy(table + head->row, from->row, n * sizeof *from->row);
    memcpy(table + head->cloth, from->cloth, n * sizeof *from->cloth);
}

static void find_ids(const struct contact_skin_source *from, uint32_t ids[2])
{
    const uint32_t *joined = from->joined ? from->joined : from->id;
    ids[0] = UINT32_MAX;
    ids[1] = 0;
    for (uint32_t i = 0; i < from->n_points; i++) {
        const uint32_t low = from->id[i] < joined[i] ? from->id[i] : joined[i];
        const uint32_t high = from->id[i] > joined[i] ? from->id[i] : joined[i];
        ids[0] = low < ids[0] ? low : ids[0];
        ids[1] = high > ids[1] ? high : ids[1];
    }
}

static int put_skin(struct making *making, const struct contact_skin_head *head, char *table,
                    struct cloth_error *error)
{
    const struct contact_skin_source *from = making->from;
    memset(table, 0, head->bytes);
    memcpy(table, head, sizeof *head);
    find_ids(from, ((struct contact_skin_head *)(void *)table)->ids);
    put_points(from, head, table);
    making->corner = (void *)(table + head->corner);
    making->edge = (void *)(table + head->edge);
    making->beside = (void *)(table + head->beside);
    making->vertex = (void *)(table + head->vertex);
    making->number = (void *)(table + head->number);
    making->child = (void *)(table + head->child);
    making->leaf = (void *)(table + head->leaf);
    making->around = (void *)(table + head->around);
    making->triangle_bits = (void *)(table + head->triangle_bits);
    making->edge_bits = (void *)(table + head->edge_bits);
    making->vertex_bits = (void *)(table + head->vertex_bits);
    skin_make_add_node(making, 0, 0, from->n_triangles);
    const struct contact_skin skin = contact_skin_open(table);
    return contact_loops_make(&skin, head->n_along, (void *)(table + head->loop),
                              (void *)(table + head->along), error);
}

int contact_skin_make(const struct contact_skin_source *from, void *table,
                      struct cloth_error *error)
{
    struct making making = {.from = from};
    struct contact_skin_head head;
    struct contact_skin skin;
    count_features(from, &skin);
    lay_skin(&skin, &head);
    int code = make_scratch(&making, error);
    if (!code) {
        bound_triangles(&making);
        list_thirds(&making);
        code = contact_tree_build(from->n_triangles, making.order, making.low, making.high,
                                  making.node, error);
    }
    if (!code)
        code = put_skin(&making, &head, table, error);
    free(making.order);
    free(making.node);
    free(making.third);
    return code;
}

struct contact_skin contact_skin_open(const void *table)
{
    const struct contact_skin_head *head = table;
    const char *at = table;
    return (struct contact_skin){.n_points = head->n_points,
                                 .n_triangles = head->n_triangles,
                                 .n_edges = head->n_edges,
                                 .n_vertices = head->n_vertices,
                                 .corner = (const uint32_t(*)[3])(const void *)(at + head->corner),
                                 .edge = (const uint32_t(*)[2])(const void *)(at + head->edge),
                                 .beside = (const uint32_t(*)[2])(const void *)(at + head->beside),
                                 .vertex = (const void *)(at + head->vertex),
                                 .number = (const void *)(at + head->number),
                                 .id = (const void *)(at + head->id),
                                 .joined = (const void *)(at + head->joined),
                                 .ids = {head->ids[0], head->ids[1]},
                                 .block = (const void *)(at + head->block),
                                 .row = (const void *)(at + head->row),
                                 .cloth = (const void *)(at + head->cloth),
                                 .held = (const void *)(at + head->held),
                                 .n_nodes = head->n_nodes,
                                 .n_leaves = head->n_leaves,
                                 .child = (const uint32_t(*)[4])(const void *)(at + head->child),
                                 .leaf = (const void *)(at + head->leaf),
                                 .around = (const void *)(at + head->around),
                                 .triangle_bits = (const void *)(at + head->triangle_bits),
                                 .edge_bits = (const void *)(at + head->edge_bits),
                                 .vertex_bits = (const void *)(at + head->vertex_bits),
                                 .loop = (const void *)(at + head->loop),
                                 .along = (const void *)(at + head->along)};
}
