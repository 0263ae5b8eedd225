/* The facets around a vertex, from one to the next across their edges. */
#include "cloth/contact/body_skin.h"

/* A surface that rises by less does not hide a vertex or an edge: sine of an angle, 0.06 degrees.
 * More than what rounding does to a plane of triangles, in double. */
static const double RISE_OF_PLANE = 1e-3;
/* Facets that meet at less are of one flat surface: square of the sine of 0.1 degree. It is small,
 * as a triangle of the cloth may lie over many edges, and what they hold up is the sum. */
static const double BEND_OF_PLANE = 4e-6;

void contact_body_fans(const struct contact_body *body, uint32_t *fan)
{
    const struct contact_facet *facet = contact_body_facets(body);
    for (uint32_t v = 0; v < body->n_vertices; v++)
        fan[v] = UINT32_MAX;
    for (uint32_t f = body->n_triangles; f-- > 0;)
        for (int k = 0; k < 3; k++)
            fan[facet[f].corner[k]] = f;
}

static bool is_below(const phys_vec *x, const phys_vec *point, const phys_vec *n)
{
    const phys_vec way = *x - *point;
    const double rise = phys_dot(n, &way);
    return !(rise > 0) || rise * rise <= RISE_OF_PLANE * RISE_OF_PLANE * phys_dot(&way, &way);
}

/* On which corner of a facet a vertex is. */
static int corner_of(const struct contact_facet *facet, uint32_t vertex)
{
    return facet->corner[0] == vertex ? 0 : (facet->corner[1] == vertex ? 1 : 2);
}

/* On a vertex the surface goes down along all of its edges; on an edge, given by its other end, to
 * both of its sides. */
bool contact_body_opens(const struct contact_body *body, const uint32_t *fan, const phys_vec *y,
                        uint32_t n_vertices, const uint32_t *vertex, const phys_vec *point,
                        const phys_vec *n)
{
    const struct contact_facet *facet = contact_body_facets(body);
    const uint32_t first = fan[vertex[0]];
    uint32_t f = first;
    bool opens = true;
    if (n_vertices > 2)
        return true;
    do {
        const int k = corner_of(facet + f, vertex[0]);
        const uint32_t next = facet[f].corner[(k + 1) % 3], last = facet[f].corner[(k + 2) % 3];
        if (n_vertices == 1)
            opens = opens && is_below(y + next, point, n);
        else if (next == vertex[1] || last == vertex[1])
            opens = opens && is_below(y + (next == vertex[1] ? last : next), point, n);
        f = facet[f].neighbour[k];
    } while (opens && f != first);
    return opens;
}

static void body_fan_find_normal(const struct contact_facet *facet, const phys_vec *y, phys_vec *n)
{
    const phys_vec a = y[facet->corner[1]] - y[facet->corner[0]];
    const phys_vec b = y[facet->corner[2]] - y[facet->corner[0]];
    *n = (phys_vec){a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
                    0};
}

/* True if two facets meet at an angle. */
static bool fan_is_bent(const phys_vec *m, const phys_vec *n)
{
    const double dot = phys_dot(m, n);
    return !(dot > 0 && dot * dot > (1 - BEND_OF_PLANE) * phys_dot(m, m) * phys_dot(n, n));
}

bool contact_body_bends(const struct contact_body *body, const uint32_t *fan, const phys_vec *y,
                        uint32_t n_vertices, const uint32_t *vertex)
{
    const struct contact_facet *facet = contact_body_facets(body);
    const uint32_t first = fan[vertex[0]];
    phys_vec before = {0};
    uint32_t f = first;
    bool bends = false, any = false;
    do {
        const int k = corner_of(facet + f, vertex[0]);
        const uint32_t next = facet[f].corner[(k + 1) % 3], last = facet[f].corner[(k + 2) % 3];
        if (n_vertices == 1 || next == vertex[1] || last == vertex[1]) {
            phys_vec normal;
            body_fan_find_normal(facet + f, y, &normal);
            bends = bends || (any && fan_is_bent(&before, &normal));
            before = any ? before : normal;
            any = true;
        }
        f = facet[f].neighbour[k];
    } while (!bends && f != first);
    return bends;
}
