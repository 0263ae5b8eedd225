/* A body of frames changes its place in its own memory: vertices, normals and boxes are those of
 * the end of a step, velocities those of the step. They depend on the two times alone, not on
 * earlier moves. */
#include "cloth/contact/making.h"
#include "cloth/contact/shape.h"

#include <math.h>

/* A time between two frames. */
struct moment {
    const double (*a)[3], (*b)[3]; /* places of vertices, m */
    double part;                   /* of the way from a to b */
};

static void find_moment(const struct contact_body *body, double time, struct moment *at)
{
    const double(*frame)[3] = (void *)((const char *)body + body->frames);
    const double last = body->n_frames - 1, count = (time - body->first) * body->rate;
    const double in = count > 0 ? (count < last ? count : last) : 0;
    const uint32_t k = (uint32_t)in, next = k < body->n_frames - 1 ? k + 1 : k;
    at->a = frame + (size_t)k * body->n_vertices;
    at->b = frame + (size_t)next * body->n_vertices;
    at->part = in - k;
}

PHYS_INLINE void moment_place(const struct moment *at, uint32_t v, phys_vec *x)
{
    const double *a = at->a[v], *b = at->b[v];
    const phys_vec was = {a[0], a[1], a[2], 0}, is = {b[0], b[1], b[2], 0};
    *x = was + at->part * (is - was);
}

void contact_body_places(const struct contact_body *body, double time, phys_vec *x)
{
    struct moment at;
    find_moment(body, time, &at);
    for (uint32_t v = 0; v < body->n_vertices; v++)
        moment_place(&at, v, x + v);
}

void contact_body_vertex_place(const struct contact_body *body, double time, uint32_t vertex,
                               phys_vec *x)
{
    struct moment at;
    find_moment(body, time, &at);
    moment_place(&at, vertex, x);
}

bool contact_body_moves_after(const struct contact_body *body, double time)
{
    const bool moves = body && body->n_frames > 1;
    return moves && time < body->first + (body->n_frames - 1) / body->rate;
}

/* A triangle without area has neither a direction nor angles: it faces up, and does not count for
 * its corners. */
static void move_normals(const struct contact_body *body, const phys_vec *x, phys_vec *of_facet,
                         phys_vec *of_vertex)
{
    const struct contact_facet *facet = contact_body_facets(body);
    for (uint32_t v = 0; v < body->n_vertices; v++)
        of_vertex[v] = (phys_vec){0};
    for (uint32_t f = 0; f < body->n_triangles; f++) {
        const uint32_t *corner = facet[f].corner;
        const phys_vec u = x[corner[1]] - x[corner[0]], w = x[corner[2]] - x[corner[0]];
        contact_cross(&u, &w, of_facet + f);
        const double square = phys_dot(of_facet + f, of_facet + f);
        of_facet[f] = square > 0 ? of_facet[f] / sqrt(square) : (phys_vec){0, 1, 0, 0};
        for (int i = 0; i < 3 && square > 0; i++) {
            const phys_vec a = x[corner[(i + 1) % 3]] - x[corner[i]];
            const phys_vec b = x[corner[(i + 2) % 3]] - x[corner[i]];
            of_vertex[corner[i]] += contact_angle(&a, &b) * of_facet[f];
        }
    }
    for (uint32_t v = 0; v < body->n_vertices; v++) {
        const double square = phys_dot(of_vertex + v, of_vertex + v);
        if (square > 0)
            of_vertex[v] /= sqrt(square);
    }
}

static void move_box(struct contact_body *body, const phys_vec *x)
{
    const struct contact_facet *facet = contact_body_facets(body);
    double most = 0;
    for (int c = 0; c < 3; c++) {
        body->low[c] = INFINITY;
        body->high[c] = -INFINITY;
        for (uint32_t f = 0; f < body->n_triangles; f++)
            for (int i = 0; i < 3; i++) {
                body->low[c] = fmin(body->low[c], x[facet[f].corner[i]][c]);
                body->high[c] = fmax(body->high[c], x[facet[f].corner[i]][c]);
            }
        most = fmax(most, fmax(fabs(body->low[c]), fabs(body->high[c])));
    }
    body->near = 1e-10 * most;
}

/* All that follows of where the vertices are. */
static void follow_vertices(struct contact_body *body)
{
    char *memory = (char *)body;
    const phys_vec *x = contact_body_vertices(body);
    move_box(body, x);
    move_normals(body, x, (void *)(memory + body->facet_normals),
                 (void *)(memory + body->vertex_normals));
    contact_tree_refit(body->n_nodes, contact_body_facets(body), x, (void *)(memory + body->nodes));
}

static void move_body(struct contact_body *body, double from, double to)
{
    char *memory = (char *)body;
    phys_vec *x = (void *)(memory + body->vertices);
    phys_vec *velocity = (void *)(memory + body->velocities);
    const double rate = to > from ? 1 / (to - from) : 0;
    struct moment was, is;
    find_moment(body, from, &was);
    find_moment(body, to, &is);
    for (uint32_t v = 0; v < body->n_vertices; v++) {
        phys_vec before;
        moment_place(&was, v, &before);
        moment_place(&is, v, x + v);
        velocity[v] = rate * (x[v] - before);
    }
    follow_vertices(body);
}

void contact_body_place(const struct contact_bodies *bodies, uint32_t number, const double (*x)[3])
{
    char *at = bodies->memory;
    for (uint32_t i = 1; i < number; i++)
        at += ((struct contact_body *)(void *)at)->bytes;
    struct contact_body *body = (void *)at;
    phys_vec *vertex = (void *)(at + body->vertices);
    for (uint32_t v = 0; v < body->n_vertices; v++)
        vertex[v] = (phys_vec){x[v][0], x[v][1], x[v][2], 0};
    follow_vertices(body);
}

void contact_bodies_move(const struct contact_bodies *bodies, double from, double to)
{
    char *at = bodies->memory;
    for (uint32_t i = 0; i < bodies->n; i++) {
        struct contact_body *body = (void *)at;
        if (body->n_frames)
            move_body(body, from, to);
        at += body->bytes;
    }
}
