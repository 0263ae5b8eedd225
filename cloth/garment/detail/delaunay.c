/* The triangulation as a structure: who is beside whom. A triangle is written by `put` alone, so
 * that every change can be undone. */
#include "cloth/garment/detail/delaunay.h"

#include <stdlib.h>
#include <string.h>

int delaunay_make(struct delaunay *plane, const double low[2], const double high[2], uint32_t room,
                  struct cloth_error *error)
{
    const double wide = fmax(high[0] - low[0], high[1] - low[1]);
    *plane =
        (struct delaunay){.n_fixed = DELAUNAY_BOX, .n = DELAUNAY_BOX, .room = room + DELAUNAY_BOX};
    plane->triangle_room = 2 * plane->room;
    plane->place = cloth_alloc(plane->room, sizeof *plane->place, error);
    plane->at = cloth_alloc(plane->room, sizeof *plane->at, error);
    plane->triangle = cloth_alloc(plane->triangle_room, sizeof *plane->triangle, error);
    if (!plane->place || !plane->at || !plane->triangle)
        return CLOTH_E_MEMORY;
    for (int k = 0; k < DELAUNAY_BOX; k++) {
        const bool right = k == 1 || k == 2, up = k >= 2;
        plane->place[k][0] = right ? high[0] + wide : low[0] - wide;
        plane->place[k][1] = up ? high[1] + wide : low[1] - wide;
    }
    plane->n_triangles = 2;
    plane->triangle[0] =
        (struct delaunay_triangle){{0, 1, 2}, {DELAUNAY_NONE, 1, DELAUNAY_NONE}, 0};
    plane->triangle[1] =
        (struct delaunay_triangle){{0, 2, 3}, {DELAUNAY_NONE, DELAUNAY_NONE, 0}, 0};
    plane->at[3] = 1;
    return CLOTH_OK;
}

void delaunay_free(struct delaunay *plane)
{
    free(plane->place);
    free(plane->at);
    free(plane->triangle);
    free(plane->suspect.items);
    free(plane->changes.items);
    *plane = (struct delaunay){0};
}

static void log_change(struct delaunay *plane, struct delaunay_change change)
{
    if (cloth_list_put(&plane->changes, &change, sizeof change, NULL))
        plane->failed = true;
}

static void log_triangle(struct delaunay *plane, uint32_t triangle)
{
    if (!plane->logs)
        return;
    log_change(plane, (struct delaunay_change){.triangle = triangle,
                                               .vertex = DELAUNAY_NONE,
                                               .before = plane->triangle[triangle]});
}

void delaunay_log_vertex(struct delaunay *plane, uint32_t vertex)
{
    if (!plane->logs)
        return;
    const double *place = plane->place[vertex];
    log_change(plane, (struct delaunay_change){.triangle = DELAUNAY_NONE,
                                               .vertex = vertex,
                                               .place = {place[0], place[1]},
                                               .at = plane->at[vertex]});
}

void delaunay_log(struct delaunay *plane)
{
    plane->logs = true;
    plane->changes.n = 0;
}

/* Vertices and triangles that were added stay, taken out: they have no `at` and no corner. Those of
 * the end go. */
static void undo(struct delaunay *plane)
{
    const struct delaunay_change *change = plane->changes.items;
    for (size_t i = plane->changes.n; i-- > 0;) {
        if (change[i].triangle != DELAUNAY_NONE) {
            plane->triangle[change[i].triangle] = change[i].before;
            continue;
        }
        memcpy(plane->place[change[i].vertex], change[i].place, sizeof change[i].place);
        plane->at[change[i].vertex] = change[i].at;
    }
    while (plane->n > plane->n_fixed && plane->at[plane->n - 1] == DELAUNAY_NONE)
        plane->n--;
    while (plane->n_triangles > 0 &&
           plane->triangle[plane->n_triangles - 1].vertex[0] == DELAUNAY_NONE)
        plane->n_triangles--;
    plane->last = 0;
}

bool delaunay_decide(struct delaunay *plane, bool stay)
{
    if (!stay)
        undo(plane);
    plane->logs = false;
    return stay;
}

void delaunay_put(struct delaunay *plane, uint32_t triangle, struct delaunay_triangle value)
{
    log_triangle(plane, triangle);
    plane->triangle[triangle] = value;
    for (int i = 0; i < 3; i++)
        if (plane->at[value.vertex[i]] != triangle) {
            delaunay_log_vertex(plane, value.vertex[i]);
            plane->at[value.vertex[i]] = triangle;
        }
}

void delaunay_put_beside(struct delaunay *plane, uint32_t triangle, uint32_t before, uint32_t now)
{
    if (triangle == DELAUNAY_NONE)
        return;
    log_triangle(plane, triangle);
    struct delaunay_triangle *of = &plane->triangle[triangle];
    for (int i = 0; i < 3; i++)
        if (of->beside[i] == before) {
            of->beside[i] = now;
            return;
        }
}

void delaunay_take_triangle(struct delaunay *plane, uint32_t triangle)
{
    log_triangle(plane, triangle);
    plane->triangle[triangle].vertex[0] = DELAUNAY_NONE;
}

uint32_t delaunay_new_triangle(struct delaunay *plane)
{
    const uint32_t triangle = plane->n_triangles++;
    plane->triangle[triangle] = (struct delaunay_triangle){{DELAUNAY_NONE, 0, 0}, {0, 0, 0}, 0};
    return triangle;
}

/* The two triangles at an edge that is not of the hull turn it:
 *
 *          c              c
 *        / | \          /   \
 *       a  |  b   ->   a --- b
 *        \ | /          \   /
 *          d              d
 */
bool delaunay_may_flip(const struct delaunay *plane, const struct delaunay_quad *quad)
{
    const double *a = plane->place[quad->corner[0]], *b = plane->place[quad->corner[2]];
    return delaunay_sharpness(a, plane->place[quad->corner[1]], b) < 2 &&
           delaunay_sharpness(a, b, plane->place[quad->corner[3]]) < 2;
}

void delaunay_flip(struct delaunay *plane, uint32_t t, int i)
{
    const struct delaunay_quad quad = delaunay_quad_at(plane, t, i);
    const uint32_t u = quad.other, *v = quad.corner, *beside = quad.beside;
    const unsigned *fixed = quad.fixed;
    delaunay_put(plane, t,
                 (struct delaunay_triangle){{v[0], v[1], v[2]},
                                            {beside[1], u, beside[0]},
                                            (unsigned char)(fixed[1] | fixed[0] << 2)});
    delaunay_put(plane, u,
                 (struct delaunay_triangle){{v[0], v[2], v[3]},
                                            {beside[2], beside[3], t},
                                            (unsigned char)(fixed[2] | fixed[3] << 1)});
    delaunay_put_beside(plane, beside[1], u, t);
    delaunay_put_beside(plane, beside[3], t, u);
}

uint32_t delaunay_around(const struct delaunay *plane, uint32_t vertex, uint32_t most,
                         uint32_t *around)
{
    uint32_t start = plane->at[vertex], n = 0;
    if (start == DELAUNAY_NONE)
        return 0;
    for (uint32_t t = start, steps = 0; steps < most; steps++) { /* clockwise to an end */
        const struct delaunay_triangle *of = &plane->triangle[t];
        t = of->beside[(delaunay_corner(of, vertex) + 2) % 3];
        if (t == DELAUNAY_NONE || t == plane->at[vertex])
            break;
        start = t;
    }
    for (uint32_t t = start; t != DELAUNAY_NONE;) {
        if (n == most)
            return 0;
        around[n++] = t;
        const struct delaunay_triangle *of = &plane->triangle[t];
        t = of->beside[(delaunay_corner(of, vertex) + 1) % 3];
        if (t == start)
            break;
    }
    return n;
}

double delaunay_sharpness(const double a[2], const double b[2], const double c[2])
{
    const double one = cloth_square_2(a, b), two = cloth_square_2(b, c),
                 three = cloth_square_2(c, a);
    if (!(cloth_turn(a, b, c) > DELAUNAY_FLAT * fmax(one, fmax(two, three))))
        return 2;
    if (one <= two && one <= three)
        return (two + three - one) / (2 * sqrt(two * three));
    if (two <= three)
        return (one + three - two) / (2 * sqrt(one * three));
    return (one + two - three) / (2 * sqrt(one * two));
}

double delaunay_sharpness_of(const struct delaunay *plane, uint32_t triangle)
{
    const uint32_t *v = plane->triangle[triangle].vertex;
    return delaunay_sharpness(plane->place[v[0]], plane->place[v[1]], plane->place[v[2]]);
}
