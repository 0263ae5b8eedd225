/* Vertices that come and go, and the flips after them (Lawson, 1977). */
#include "cloth/garment/detail/delaunay.h"

#include <string.h>

void delaunay_suspect(struct delaunay *plane, uint32_t triangle)
{
    uint32_t *edge = cloth_list_add(&plane->suspect, sizeof *edge, 3, NULL);
    if (!edge)
        plane->failed = true;
    for (uint32_t i = 0; edge && i < 3; i++)
        edge[i] = 3 * triangle + i;
}

/* True if the angles opposite an edge sum up to more than half a turn: their sine's sign. Within
 * rounding of the circle an edge stays, so that flips end. */
static bool is_delaunay(const struct delaunay *plane, const struct delaunay_quad *quad)
{
    const double *a = plane->place[quad->corner[0]], *c = plane->place[quad->corner[1]];
    const double *b = plane->place[quad->corner[2]], *d = plane->place[quad->corner[3]];
    double sine_a, cosine_a, sine_b, cosine_b;
    cloth_angle(c, a, d, &sine_a, &cosine_a);
    cloth_angle(d, b, c, &sine_b, &cosine_b);
    const double one_sum = sine_a * cosine_b, two_sum = cosine_a * sine_b;
    return one_sum + two_sum >= -1e-10 * (fabs(one_sum) + fabs(two_sum));
}

void delaunay_legalise(struct delaunay *plane)
{
    size_t left = 100 * ((size_t)plane->n_triangles + plane->suspect.n); /* rounding ends here */
    while (plane->suspect.n > 0 && left-- > 0) {
        const uint32_t edge = ((uint32_t *)plane->suspect.items)[--plane->suspect.n];
        const uint32_t t = edge / 3;
        const int i = (int)(edge % 3);
        const struct delaunay_triangle *one = &plane->triangle[t];
        if (one->vertex[0] == DELAUNAY_NONE || (one->fixed >> i & 1) ||
            one->beside[i] == DELAUNAY_NONE)
            continue;
        const struct delaunay_quad quad = delaunay_quad_at(plane, t, i);
        if (is_delaunay(plane, &quad) || !delaunay_may_flip(plane, &quad))
            continue;
        delaunay_flip(plane, t, i);
        delaunay_suspect(plane, t);
        delaunay_suspect(plane, quad.other);
    }
    plane->suspect.n = 0;
}

/* Twice the area of an edge and a place: below 0 if the place is on the right. Exactly the opposite
 * seen from the other side, or a walk could go to and fro over an edge that points at the place. */
static double side_of(const struct delaunay *plane, uint32_t a, uint32_t b, const double place[2])
{
    return a < b ? cloth_turn(plane->place[a], plane->place[b], place)
                 : -cloth_turn(plane->place[b], plane->place[a], place);
}

/* The triangle that a place is in, or is nearest to be in, from all. */
static uint32_t search(const struct delaunay *plane, const double place[2])
{
    uint32_t best = DELAUNAY_NONE;
    double most = -INFINITY;
    for (uint32_t t = 0; t < plane->n_triangles; t++) {
        const uint32_t *v = plane->triangle[t].vertex;
        if (v[0] == DELAUNAY_NONE)
            continue;
        const double least =
            fmin(side_of(plane, v[0], v[1], place),
                 fmin(side_of(plane, v[1], v[2], place), side_of(plane, v[2], v[0], place)));
        if (least > most) {
            most = least;
            best = t;
        }
        if (least >= 0)
            break;
    }
    return best;
}

/* Walks towards a place over edges that have it on their far side; DELAUNAY_NONE: it is outside. */
static uint32_t find_from(const struct delaunay *plane, const double place[2], uint32_t from)
{
    uint32_t t = from;
    for (uint32_t steps = 0; steps <= plane->n_triangles; steps++) {
        const struct delaunay_triangle *of = &plane->triangle[t];
        uint32_t next = t;
        for (uint32_t k = 0; k < 3 && next == t; k++) {
            const uint32_t i = (k + steps) % 3; /* by turns, or it could go in circles */
            if (side_of(plane, of->vertex[(i + 1) % 3], of->vertex[(i + 2) % 3], place) < 0)
                next = of->beside[i];
        }
        if (next == t || next == DELAUNAY_NONE)
            return next;
        t = next;
    }
    return search(plane, place);
}

/* Where a place is in its triangle: on the edge opposite corner 0 .. 2, 3 inside, 4 on a corner. */
static int part_of(const struct delaunay *plane, const struct delaunay_triangle *of,
                   const double place[2])
{
    int part = 3;
    for (int i = 0; i < 3; i++) {
        const double *a = plane->place[of->vertex[(i + 1) % 3]];
        const double *b = plane->place[of->vertex[(i + 2) % 3]];
        if (cloth_turn(a, b, place) <= DELAUNAY_FLAT * cloth_square_2(a, b))
            part = part == 3 ? i : 4;
    }
    return part;
}

/* A triangle becomes three around its new vertex. */
static void split_triangle(struct delaunay *plane, uint32_t t, uint32_t vertex)
{
    const struct delaunay_triangle old = plane->triangle[t];
    const uint32_t part[3] = {t, delaunay_new_triangle(plane), delaunay_new_triangle(plane)};
    for (int i = 0; i < 3; i++) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        delaunay_put(plane, part[i],
                     (struct delaunay_triangle){{vertex, old.vertex[i1], old.vertex[i2]},
                                                {old.beside[i], part[i1], part[i2]},
                                                (unsigned char)(old.fixed >> i & 1)});
        if (i > 0)
            delaunay_put_beside(plane, old.beside[i], t, part[i]);
    }
    for (int i = 0; i < 3; i++)
        delaunay_suspect(plane, part[i]);
}

/* The two triangles at an edge become four. */
static void split_edge(struct delaunay *plane, uint32_t t, int i, uint32_t vertex)
{
    const struct delaunay_quad quad = delaunay_quad_at(plane, t, i);
    const uint32_t u = quad.other, t2 = delaunay_new_triangle(plane),
                   u2 = delaunay_new_triangle(plane);
    const uint32_t part[4] = {t, u, u2, t2}; /* part k has side k */
    for (int n = 4; n > 0; n--) {
        const int k = n % 4, next = (k + 1) % 4, before = (k + 3) % 4;
        delaunay_put(plane, part[k],
                     (struct delaunay_triangle){{vertex, quad.corner[k], quad.corner[next]},
                                                {quad.beside[k], part[next], part[before]},
                                                (unsigned char)quad.fixed[k]});
    }
    delaunay_put_beside(plane, quad.beside[3], t, t2);
    delaunay_put_beside(plane, quad.beside[2], u, u2);
    const uint32_t suspect[4] = {t, t2, u, u2};
    for (int k = 0; k < 4; k++)
        delaunay_suspect(plane, suspect[k]);
}

uint32_t delaunay_insert(struct delaunay *plane, const double place[2], uint32_t near)
{
    if (plane->n == plane->room || plane->n_triangles + 2 > plane->triangle_room)
        return DELAUNAY_NONE;
    const uint32_t t = find_from(plane, place, near);
    if (t == DELAUNAY_NONE)
        return DELAUNAY_NONE;
    const struct delaunay_triangle *of = &plane->triangle[t];
    const int part = part_of(plane, of, place);
    if (part == 4 || (part < 3 && ((of->fixed >> part & 1) || of->beside[part] == DELAUNAY_NONE)))
        return DELAUNAY_NONE;
    const uint32_t vertex = plane->n++;
    memcpy(plane->place[vertex], place, sizeof plane->place[vertex]);
    plane->at[vertex] = DELAUNAY_NONE;
    if (part == 3)
        split_triangle(plane, t, vertex);
    else
        split_edge(plane, t, part, vertex);
    delaunay_legalise(plane);
    plane->last = plane->at[vertex];
    return vertex;
}

/* The neighbours at an edge that two triangles leave become each other's. */
static void close_gap(struct delaunay *plane, uint32_t gone, uint32_t one, uint32_t two,
                      unsigned fixed)
{
    delaunay_put_beside(plane, one, gone, two);
    delaunay_put_beside(plane, two, gone, one);
    const uint32_t side[2] = {one, two};
    for (int k = 0; k < 2; k++) {
        if (side[k] == DELAUNAY_NONE)
            continue;
        struct delaunay_triangle value = plane->triangle[side[k]];
        for (int i = 0; i < 3; i++)
            if (fixed && value.beside[i] == side[1 - k])
                value.fixed |= (unsigned char)(1U << i);
        delaunay_put(plane, side[k], value);
    }
}

/* Takes out a triangle at the edge between a vertex that goes and the one that it becomes. */
static void take_at_edge(struct delaunay *plane, uint32_t t, uint32_t vertex, uint32_t to)
{
    const struct delaunay_triangle of = plane->triangle[t];
    const int i = delaunay_corner(&of, vertex), toward = delaunay_corner(&of, to);
    close_gap(plane, t, of.beside[i], of.beside[toward],
              (of.fixed >> i & 1) | (of.fixed >> toward & 1));
    delaunay_take_triangle(plane, t);
}

bool delaunay_merge(struct delaunay *plane, uint32_t vertex, uint32_t to)
{
    enum { MOST = 32 };
    uint32_t around[MOST];
    bool stays[MOST]; /* the other triangles are at the edge */
    const uint32_t n = delaunay_around(plane, vertex, MOST, around);
    for (uint32_t k = 0; k < n; k++) { /* does each that stays keep its side? */
        const struct delaunay_triangle *of = &plane->triangle[around[k]];
        const uint32_t b = delaunay_after(of, vertex, 1), c = delaunay_after(of, vertex, 2);
        stays[k] = b != to && c != to;
        if (stays[k] && delaunay_sharpness(plane->place[to], plane->place[b], plane->place[c]) >= 2)
            return false;
    }
    for (uint32_t k = 0; k < n; k++)
        if (stays[k]) {
            struct delaunay_triangle of = plane->triangle[around[k]];
            of.vertex[delaunay_corner(&of, vertex)] = to;
            delaunay_put(plane, around[k], of);
        }
    for (uint32_t k = 0; k < n; k++)
        if (!stays[k])
            take_at_edge(plane, around[k], vertex, to);
    delaunay_log_vertex(plane, vertex);
    plane->at[vertex] = DELAUNAY_NONE;
    for (uint32_t k = 0; k < n; k++)
        if (stays[k])
            delaunay_suspect(plane, around[k]);
    return n > 0;
}
