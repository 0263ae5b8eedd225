/* Edges of the boundary are put into a triangulation of its vertices by flips (Sloan, 1993). */
#include "cloth/garment/detail/delaunay.h"

#include <string.h>

/* Fixes the edge opposite corner i of a triangle on both of its sides. */
static void fix(struct delaunay *plane, uint32_t t, int i)
{
    struct delaunay_triangle one = plane->triangle[t];
    const uint32_t u = one.beside[i];
    const int j = u == DELAUNAY_NONE ? 0 : delaunay_quad_at(plane, t, i).other_side;
    one.fixed |= (unsigned char)(1U << i);
    delaunay_put(plane, t, one);
    if (u == DELAUNAY_NONE)
        return;
    struct delaunay_triangle two = plane->triangle[u];
    two.fixed |= (unsigned char)(1U << j);
    delaunay_put(plane, u, two);
}

/* The corner of the triangle around a that is opposite an edge which a line from a to b crosses, or
 * that is opposite the edge a b itself. */
struct way {
    uint32_t triangle; /* DELAUNAY_NONE: a vertex or a fixed edge is in the way */
    int corner;
    bool there; /* the edge a b is there */
};

static struct way first_of(const struct delaunay *plane, uint32_t a, uint32_t b)
{
    const double *from = plane->place[a], *to = plane->place[b];
    uint32_t t = plane->at[a];
    for (uint32_t steps = 0; steps < plane->n_triangles; steps++) {
        const struct delaunay_triangle *of = &plane->triangle[t];
        const int i = delaunay_corner(of, a);
        const uint32_t c = of->vertex[(i + 1) % 3], d = of->vertex[(i + 2) % 3];
        if (c == b)
            return (struct way){t, (i + 2) % 3, true};
        if (d == b)
            return (struct way){t, (i + 1) % 3, true};
        if (cloth_turn(from, plane->place[c], to) > 0 && cloth_turn(from, to, plane->place[d]) > 0)
            return (struct way){t, i, false};
        t = of->beside[(i + 1) % 3];
        if (t == DELAUNAY_NONE)
            break;
    }
    return (struct way){DELAUNAY_NONE, 0, false};
}

/* Two triangles that a line from a to b passes one after the other, over the edge opposite corner i
 * of the first one. */
struct pass {
    uint32_t t;
    int i;
    struct delaunay_quad quad;
    double side;        /* of the second one's corner off that edge: above 0 is left of the line */
    bool convex, fewer; /* whether the edge can turn, and is then out of the way */
};

static bool look_over(const struct delaunay *plane, uint32_t a, uint32_t b, struct pass *pass)
{
    const struct delaunay_triangle *one = &plane->triangle[pass->t];
    const double *from = plane->place[a], *to = plane->place[b];
    if ((one->fixed >> pass->i & 1) || one->beside[pass->i] == DELAUNAY_NONE)
        return false;
    pass->quad = delaunay_quad_at(plane, pass->t, pass->i);
    const uint32_t *corner = pass->quad.corner;
    pass->side = cloth_turn(from, to, plane->place[corner[2]]);
    pass->convex = delaunay_may_flip(plane, &pass->quad);
    pass->fewer = !(cloth_turn(from, to, plane->place[corner[0]]) * pass->side < 0);
    return corner[2] == b || pass->side != 0;
}

/* Turns one edge on the way from a to b: the first that is out of the way then. Where there is none
 * a convex one turns that is still in the way, another one in each round. */
static bool turn_one(struct delaunay *plane, uint32_t a, uint32_t b, struct way way, size_t round)
{
    struct pass pass = {.t = way.triangle, .i = way.corner}, other = {.t = DELAUNAY_NONE};
    size_t n_convex = 0;
    for (uint32_t steps = 0; steps < plane->n_triangles; steps++) {
        if (!look_over(plane, a, b, &pass))
            return false;
        if (pass.convex && pass.fewer) {
            delaunay_flip(plane, pass.t, pass.i);
            return true;
        }
        if (pass.convex && (n_convex == 0 || n_convex == round % (n_convex + 1)))
            other = pass;
        n_convex += pass.convex;
        if (pass.quad.corner[2] == b)
            break;
        pass.t = pass.quad.other;
        pass.i = delaunay_corner(&plane->triangle[pass.t], pass.quad.corner[pass.side > 0 ? 3 : 1]);
    }
    if (other.t == DELAUNAY_NONE)
        return false;
    delaunay_flip(plane, other.t, other.i);
    return true;
}

bool delaunay_fix(struct delaunay *plane, uint32_t a, uint32_t b)
{
    struct way way = first_of(plane, a, b);
    for (size_t left = 1000 + 10 * (size_t)plane->n_triangles; !way.there; left--) {
        if (way.triangle == DELAUNAY_NONE || left == 0 || !turn_one(plane, a, b, way, left))
            return false;
        way = first_of(plane, a, b);
    }
    fix(plane, way.triangle, way.corner);
    return true;
}

/* Vertices that no triangle has are taken out. */
static void find_triangles(struct delaunay *plane)
{
    for (uint32_t v = 0; v < plane->n; v++)
        plane->at[v] = DELAUNAY_NONE;
    for (uint32_t t = 0; t < plane->n_triangles; t++)
        for (int i = 0; plane->triangle[t].vertex[0] != DELAUNAY_NONE && i < 3; i++)
            plane->at[plane->triangle[t].vertex[i]] = t;
}

static void pack_vertices(struct delaunay *plane)
{
    uint32_t n = 0;
    for (uint32_t v = 0; v < plane->n; v++) {
        const bool there = plane->at[v] != DELAUNAY_NONE;
        memmove(plane->place[n], plane->place[v], sizeof *plane->place);
        plane->at[v] = there ? n++ : DELAUNAY_NONE; /* its number from now on */
    }
    for (uint32_t t = 0; t < plane->n_triangles; t++)
        for (int i = 0; plane->triangle[t].vertex[0] != DELAUNAY_NONE && i < 3; i++)
            plane->triangle[t].vertex[i] = plane->at[plane->triangle[t].vertex[i]];
    plane->n = n;
}

static void pack_triangles(struct delaunay *plane, uint32_t *number)
{
    uint32_t n = 0;
    for (uint32_t t = 0; t < plane->n_triangles; t++)
        number[t] = plane->triangle[t].vertex[0] == DELAUNAY_NONE ? DELAUNAY_NONE : n++;
    for (uint32_t t = 0; t < plane->n_triangles; t++) {
        if (number[t] == DELAUNAY_NONE)
            continue;
        struct delaunay_triangle of = plane->triangle[t];
        for (int i = 0; i < 3; i++)
            of.beside[i] = of.beside[i] == DELAUNAY_NONE ? DELAUNAY_NONE : number[of.beside[i]];
        plane->triangle[number[t]] = of;
    }
    plane->n_triangles = n;
}

void delaunay_pack(struct delaunay *plane)
{
    plane->suspect.n = 0;
    uint32_t *number =
        cloth_list_add(&plane->suspect, sizeof *number, (size_t)plane->n_triangles + 1, NULL);
    plane->suspect.n = 0;
    plane->last = 0;
    if (!number) {
        plane->failed = true;
        return;
    }
    find_triangles(plane);
    pack_vertices(plane);
    pack_triangles(plane, number);
    find_triangles(plane);
}

/* From a corner of the box inwards, up to fixed edges. */
static void take_outside(struct delaunay *plane, uint32_t from)
{
    plane->suspect.n = 0;
    delaunay_suspect(plane, from);
    delaunay_take_triangle(plane, from);
    while (plane->suspect.n > 0) {
        const uint32_t edge = ((uint32_t *)plane->suspect.items)[--plane->suspect.n];
        const struct delaunay_triangle *of = &plane->triangle[edge / 3];
        const uint32_t next = of->beside[edge % 3];
        if (next == DELAUNAY_NONE)
            continue;
        if (of->fixed >> (edge % 3) & 1) {
            delaunay_put_beside(plane, next, edge / 3, DELAUNAY_NONE);
            continue;
        }
        if (plane->triangle[next].vertex[0] != DELAUNAY_NONE) {
            delaunay_suspect(plane, next);
            delaunay_take_triangle(plane, next);
        }
    }
}

void delaunay_carve(struct delaunay *plane)
{
    take_outside(plane, plane->at[0]);
    delaunay_pack(plane);
    plane->n_fixed -= DELAUNAY_BOX;
}
