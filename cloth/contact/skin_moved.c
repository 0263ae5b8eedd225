/* A look at a step that was looked at before need not see again what has not moved: the same points
 * give the same bits. Marks say what moved, point by point, and for each part of the tree, so that
 * a query leaves out parts that rest. If an edge is a ridge depends on the triangles beside it,
 * too: so a point is also marked if another corner of one of its triangles moved. */
#include "cloth/contact/skin_table.h"

static unsigned char *moved_parts_of(const struct contact_skin *skin, const void *boxes)
{
    struct contact_boxes_head head;
    contact_boxes_lay(skin, &head);
    return (unsigned char *)(void *)boxes + head.moved; /* the caller knows if it may write */
}

unsigned char *contact_moved_points(const struct contact_skin *skin, const void *boxes)
{
    return moved_parts_of(skin, boxes) + skin->n_nodes;
}

uint32_t contact_moved_n(const void *boxes)
{
    const struct contact_boxes_head *head = boxes;
    return head->n_moved;
}

/* Corners of a triangle with a point that moved are marked, too. */
static void mark_corners(const struct contact_skin *skin, unsigned char *moved)
{
    enum { ITSELF = 1, BESIDE = 2 };
    for (uint32_t i = 0; i < skin->n_triangles; i++) {
        const uint32_t *at = skin->corner[i];
        if (!((moved[at[0]] | moved[at[1]] | moved[at[2]]) & ITSELF))
            continue;
        for (int k = 0; k < 3; k++)
            moved[at[k]] |= BESIDE;
    }
}

static bool leaf_moved(const struct contact_skin *skin, const unsigned char *moved,
                       const struct contact_leaf *leaf)
{
    const uint32_t *point = skin->around + leaf->point;
    unsigned char is = 0;
    for (uint32_t i = 0; i < leaf->n_points; i++)
        is |= moved[point[i]];
    return is;
}

/* Children have higher numbers than their node. */
void contact_moved_mark(const struct contact_skin *skin, void *boxes)
{
    struct contact_boxes_head *head = boxes;
    unsigned char *part = moved_parts_of(skin, boxes), *moved = part + skin->n_nodes;
    head->n_moved = 0;
    for (uint32_t i = 0; i < skin->n_points; i++)
        head->n_moved += moved[i];
    mark_corners(skin, moved);
    for (uint32_t i = skin->n_nodes; i-- > 0;) {
        part[i] = 0;
        for (int k = 0; k < 4; k++) {
            const uint32_t child = skin->child[i][k];
            const bool is = child & CONTACT_IS_LEAF
                                ? leaf_moved(skin, moved, skin->leaf + (child & ~CONTACT_IS_LEAF))
                                : part[child] != 0;
            part[i] |= (unsigned char)(is << k);
        }
    }
}
