/* Bodies are made whole in memory of their own and appended only then. The number of a body's bytes
 * depends on its vertices and triangles alone. */
#include "cloth/base/memory.h"
#include "cloth/contact/making.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Pseudo-normals ---- */

/* Three times halved, then the series of the arc tangent. */
double contact_angle(const phys_vec *a, const phys_vec *b)
{
    phys_vec product;
    contact_cross(a, b, &product);
    const double across = sqrt(phys_dot(&product, &product));
    if (!(across > 0))
        return phys_dot(a, b) < 0 ? 3.14159265358979323846 : 0;
    const double lengths = sqrt(phys_dot(a, a) * phys_dot(b, b));
    const double along = phys_dot(a, b) + lengths;
    double tangent = across / (along + sqrt(across * across + along * along)); /* of a quarter */
    for (int i = 0; i < 2; i++)
        tangent /= 1 + sqrt(1 + tangent * tangent);
    const double square = tangent * tangent;
    double sum = 0;
    for (int i = 19; i > 0; i -= 2)
        sum = 1.0 / i - square * sum;
    return 16 * tangent * sum;
}

/* Adds the normals of all vertices; those without a triangle keep zero. */
static void add_normals(const struct contact_making *making, phys_vec *normal)
{
    for (uint32_t t = 0; t < making->n; t++) {
        const uint32_t *corner = making->corner[t];
        phys_vec x[3];
        for (int i = 0; i < 3; i++)
            contact_load(making, corner[i], x + i);
        for (int i = 0; i < 3; i++) {
            const phys_vec a = x[(i + 1) % 3] - x[i], b = x[(i + 2) % 3] - x[i];
            normal[corner[i]] += contact_angle(&a, &b) * making->normal[t];
        }
    }
    for (uint32_t v = 0; v < making->mesh->n_vertices; v++) {
        const double square = phys_dot(normal + v, normal + v);
        if (square > 0)
            normal[v] /= sqrt(square);
    }
}

/* ---- The body ---- */

static uint64_t body_make_whole_lines(uint64_t bytes)
{
    return (bytes + CONTACT_ALIGN - 1) / CONTACT_ALIGN * CONTACT_ALIGN;
}

static uint64_t frames_bytes(const struct contact_making *making)
{
    const uint64_t places = (uint64_t)making->frames->n * making->mesh->n_vertices;
    return body_make_whole_lines(places * sizeof *making->frames->place);
}

static void lay_out(const struct contact_making *making, struct contact_body *body)
{
    *body = (struct contact_body){.n_vertices = making->mesh->n_vertices,
                                  .n_triangles = making->n,
                                  .n_nodes = contact_tree_nodes(making->n)};
    body->vertices = body_make_whole_lines(sizeof *body);
    body->vertex_normals =
        body->vertices + body_make_whole_lines(body->n_vertices * sizeof(phys_vec));
    body->facets =
        body->vertex_normals + body_make_whole_lines(body->n_vertices * sizeof(phys_vec));
    body->facet_normals =
        body->facets + body_make_whole_lines(body->n_triangles * sizeof(struct contact_facet));
    body->nodes = body->facet_normals + body_make_whole_lines(body->n_triangles * sizeof(phys_vec));
    body->bytes = body->nodes + body->n_nodes * sizeof(struct contact_node);
    if (!making->frames)
        return;
    body->n_frames = making->frames->n;
    body->first = making->frames->first;
    body->rate = making->frames->rate;
    body->velocities = body->bytes;
    body->frames = body->velocities + body_make_whole_lines(body->n_vertices * sizeof(phys_vec));
    body->bytes = body->frames + frames_bytes(making);
}

static void body_make_put_vertices(const struct contact_making *making, struct contact_body *body)
{
    phys_vec *to = (void *)((char *)body + body->vertices);
    double most = 0;
    for (uint32_t v = 0; v < body->n_vertices; v++)
        contact_load(making, v, to + v);
    for (int c = 0; c < 3; c++) {
        body->low[c] = INFINITY;
        body->high[c] = -INFINITY;
        for (uint32_t t = 0; t < making->n; t++) {
            body->low[c] = fmin(body->low[c], making->low[t][c]);
            body->high[c] = fmax(body->high[c], making->high[t][c]);
        }
        most = fmax(most, fmax(fabs(body->low[c]), fabs(body->high[c])));
    }
    body->near = 1e-10 * most;
    add_normals(making, (void *)((char *)body + body->vertex_normals));
}

static void put_facets(const struct contact_making *making, struct contact_body *body)
{
    struct contact_facet *facet = (void *)((char *)body + body->facets);
    phys_vec *normal = (void *)((char *)body + body->facet_normals);
    for (uint32_t f = 0; f < making->n; f++)
        making->place[making->order[f]] = f;
    for (uint32_t f = 0; f < making->n; f++) {
        const uint32_t t = making->order[f];
        memcpy(facet[f].corner, making->corner[t], sizeof facet[f].corner);
        facet[f].number = t;
        normal[f] = making->normal[t];
        for (int i = 0; i < 3; i++)
            facet[f].neighbour[i] = making->place[making->neighbour[t][i]];
    }
}

/* Appends the body to memory that has room for it. */
static int body_make_put_body(struct contact_making *making, struct contact_body *body)
{
    const int code = contact_tree_build(making->n, making->order, making->low, making->high,
                                        (void *)((char *)body + body->nodes), making->error);
    if (code)
        return code;
    body_make_put_vertices(making, body);
    put_facets(making, body);
    if (making->frames)
        memcpy((char *)body + body->frames, making->frames->place,
               (size_t)body->n_frames * body->n_vertices * sizeof *making->frames->place);
    return CLOTH_OK;
}

/* Makes room for so many bytes, at least twice what there was: so each body is moved only a few
 * times. */
static int body_make_room(struct contact_bodies *bodies, uint64_t bytes,
                          const struct contact_making *making)
{
    const uint64_t room = bytes > 2 * bodies->room ? bytes : 2 * bodies->room;
    if (bytes <= bodies->room)
        return CLOTH_OK;
    char *memory = aligned_alloc(CONTACT_ALIGN, room);
    if (!memory)
        return cloth_fail(making->error, CLOTH_E_MEMORY, "no memory for a body of %u triangles",
                          making->n);
    if (bodies->bytes)
        memcpy(memory, bodies->memory, bodies->bytes);
    free(bodies->memory);
    bodies->memory = memory;
    bodies->room = room;
    return CLOTH_OK;
}

static int body_make_append(struct contact_bodies *bodies, struct contact_making *making)
{
    struct contact_body laid;
    lay_out(making, &laid);
    int code = body_make_room(bodies, bodies->bytes + laid.bytes, making);
    if (code)
        return code;
    char *body = (char *)bodies->memory + bodies->bytes;
    memset(body, 0, laid.bytes);
    memcpy(body, &laid, sizeof laid);
    code = body_make_put_body(making, (void *)body);
    if (code)
        return code;
    bodies->bytes += laid.bytes;
    bodies->n++;
    return CLOTH_OK;
}

static int body_make_take_room(struct contact_making *making)
{
    const uint32_t n = making->n;
    making->corner = cloth_alloc(n, sizeof *making->corner, making->error);
    making->neighbour = cloth_alloc(n, sizeof *making->neighbour, making->error);
    making->side = cloth_alloc(n, 3 * sizeof *making->side, making->error);
    making->order = cloth_alloc(n, sizeof *making->order, making->error);
    making->place = cloth_alloc(n, sizeof *making->place, making->error);
    making->normal =
        aligned_alloc(CONTACT_ALIGN, body_make_whole_lines(3 * n * sizeof *making->normal));
    if (!making->normal)
        return cloth_fail(making->error, CLOTH_E_MEMORY, "no memory for a body of %u triangles", n);
    making->low = making->normal + n;
    making->high = making->low + n;
    memset(making->normal, 0, 3 * n * sizeof *making->normal);
    return making->error->code;
}

static void free_room(struct contact_making *making)
{
    free(making->corner);
    free(making->neighbour);
    free(making->side);
    free(making->order);
    free(making->place);
    free(making->normal);
}

/* Checks that all vertices of all frames are within the bound of a mesh. */
static int body_make_check_frames(const struct contact_making *making)
{
    const uint32_t n = making->mesh->n_vertices;
    for (uint32_t k = 0; k < making->frames->n; k++)
        for (uint32_t v = 0; v < n; v++)
            for (int c = 0; c < 3; c++)
                if (!(fabs(making->frames->place[(size_t)k * n + v][c]) < CONTACT_BODY_BOUND))
                    return cloth_fail(making->error, CLOTH_E_INPUT,
                                      "vertex %u of frame %u is %g m from the origin along an "
                                      "axis; less than %g m is expected (vertices and frames "
                                      "count from 1)",
                                      v + 1, k + 1, making->frames->place[(size_t)k * n + v][c],
                                      CONTACT_BODY_BOUND);
    return CLOTH_OK;
}

int contact_bodies_add(struct contact_bodies *bodies, const struct mesh *mesh, bool *turned,
                       struct cloth_error *error)
{
    return contact_bodies_add_frames(bodies, mesh, NULL, turned, error);
}

int contact_bodies_add_frames(struct contact_bodies *bodies, const struct mesh *mesh,
                              const struct contact_frames *frames, bool *turned,
                              struct cloth_error *error)
{
    struct cloth_error own = {0};
    struct contact_making making = {
        .mesh = mesh, .frames = frames, .n = mesh->n_triangles, .error = &own};
    int code = contact_body_check_vertices(&making);
    if (!code && frames)
        code = body_make_check_frames(&making);
    code = code ? code : body_make_take_room(&making);
    code = code ? code : contact_body_check(&making, turned);
    code = code ? code : body_make_append(bodies, &making);
    free_room(&making);
    if (!code && frames)
        contact_bodies_move(bodies, 0, 0);
    return code ? cloth_fail(error, code, "%s", own.text) : CLOTH_OK;
}

int contact_body_mesh(const struct contact_body *body, struct mesh *mesh, struct cloth_error *error)
{
    const phys_vec *vertex = contact_body_vertices(body);
    const struct contact_facet *facet = contact_body_facets(body);
    double(*position)[3] = cloth_alloc(body->n_vertices, sizeof *position, error);
    uint32_t(*triangle)[3] = cloth_alloc(body->n_triangles, sizeof *triangle, error);
    int code = CLOTH_E_MEMORY;
    *mesh = (struct mesh){0};
    if (position && triangle) {
        for (uint32_t v = 0; v < body->n_vertices; v++)
            memcpy(position[v], vertex + v, sizeof *position);
        for (uint32_t f = 0; f < body->n_triangles; f++)
            memcpy(triangle[facet[f].number], facet[f].corner, sizeof *triangle);
        code = mesh_inline(mesh, body->n_vertices, *position, 0, NULL, body->n_triangles, *triangle,
                           error);
    }
    free(position);
    free(triangle);
    return code;
}
