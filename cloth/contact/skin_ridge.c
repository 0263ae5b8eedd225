/* Edges press each other where both have a ridge. On a flat or hollow surface vertices and
 * triangles are nearer than the edge, and their contacts are enough. Most edges have no ridge in
 * any direction: u and v, the unit ways down on both sides, have a part of at least r along a
 * common direction only if u.v >= 2 r^2 - 1. */
#include "cloth/contact/direction.h"
#include "cloth/contact/skin_table.h"

#include <math.h>

/* A surface that goes down by more from an edge has a ridge there: sine of 3 degrees. Cloth that
 * slides over less has vertices and triangles that are nearer. */
static const double RIDGE = 0.05;
/* A part of u.v, for rounding. */
static const double ROUNDING = 1e-9;

/* A flat triangle counts at a border of the cloth. */
bool contact_is_ridge(const struct contact_skin *skin, const phys_vec *y, uint32_t edge,
                      const phys_vec *normal)
{
    const phys_vec *from = y + skin->edge[edge][0];
    const phys_vec along = y[skin->edge[edge][1]] - *from;
    const double square = phys_dot(&along, &along);
    const bool border = skin->beside[edge][1] == CONTACT_NO_POINT;
    bool ridge = true;
    for (int k = 0; k < 2 && skin->beside[edge][k] < CONTACT_FAR_POINT; k++) {
        const phys_vec to = y[skin->beside[edge][k]] - *from;
        const phys_vec across = to - phys_dot(&to, &along) / square * along;
        const double up = phys_dot(&across, normal);
        ridge = ridge && up > (border ? -RIDGE : RIDGE) * sqrt(phys_dot(&across, &across));
    }
    return ridge;
}

/* Points beside four edges, from which the ways lead down. */
struct beside {
    struct contact_lanes from, along, at[2];
};

PHYS_INLINE void open_four(const struct contact_skin *skin, const phys_vec *y, uint32_t edge,
                           uint32_t n, struct beside *to)
{
    struct contact_lanes end;
    const phys_vec *point[4][4];
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t e = edge + (k < n ? k : 0), *beside = skin->beside[e];
        point[0][k] = y + skin->edge[e][0];
        point[1][k] = y + skin->edge[e][1];
        point[2][k] = y + beside[0];
        point[3][k] = y + beside[beside[1] < CONTACT_FAR_POINT];
    }
    contact_transpose(point[0][0], point[0][1], point[0][2], point[0][3], &to->from);
    contact_transpose(point[1][0], point[1][1], point[1][2], point[1][3], &end);
    contact_transpose(point[2][0], point[2][1], point[2][2], point[2][3], to->at);
    contact_transpose(point[3][0], point[3][1], point[3][2], point[3][3], to->at + 1);
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        to->along.c[c] = end.c[c] - to->from.c[c];
}

/* Bit k: edge k of four may have a ridge. Edges with one triangle may. */
PHYS_INLINE uint32_t ridges_of_four(const struct beside *of)
{
    const double least = 1 - 2 * RIDGE * RIDGE + ROUNDING;
    struct contact_lanes across[2];
    phys_vec square, dot, both[2], uv;
    uint32_t bits = 0;
    contact_lanes_dot(&of->along, &of->along, &square);
    PHYS_UNROLL
    for (int i = 0; i < 2; i++) {
        struct contact_lanes *to = across + i;
        PHYS_UNROLL
        for (int c = 0; c < 3; c++)
            to->c[c] = of->at[i].c[c] - of->from.c[c];
        contact_lanes_dot(to, &of->along, &dot);
        const phys_vec part = dot / square;
        PHYS_UNROLL
        for (int c = 0; c < 3; c++)
            to->c[c] -= part * of->along.c[c];
        contact_lanes_dot(to, to, both + i);
    }
    contact_lanes_dot(across, across + 1, &uv);
    const contact_mask is = (uv > 0) | (uv * uv < least * least * (both[0] * both[1]));
    for (int k = 0; k < 4; k++)
        bits |= (uint32_t)(is[k] & 1) << k;
    return bits;
}

PHYS_KERNEL_OF(uint32_t, contact_ridges_of,
               (const struct contact_skin *skin, const struct contact_leaf *leaf, const phys_vec *y,
                uint32_t bits),
               (skin, leaf, y, bits))
{
    uint32_t ridges = 0;
    for (uint32_t i = 0; i < leaf->n_edges; i += 4) {
        const uint32_t left = leaf->n_edges - i;
        struct beside four;
        if (!(bits >> i & 15))
            continue;
        open_four(skin, y, leaf->edge + i, left < 4 ? left : 4, &four);
        ridges |= ridges_of_four(&four) << i;
    }
    return ridges & bits;
}
