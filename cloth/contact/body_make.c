/* Bodies are made whole in memory of their own and appended only then. The number of a body's bytes
 * follows of its vertices and triangles alone. */
#include "cloth/base/memory.h"
#include "cloth/contact/body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Below these parts of what it could be a triangle has no area, or a body no room. */
static const double FLAT = 1e-9, EMPTY = 1e-9;
enum { MAX_TRIANGLES = 1 << 28 };

/* An edge of a triangle: from corner `edge` to the next one. */
struct side {
    uint64_t ends; /* the lower vertex above the higher one: equal for both sides of an edge */
    uint32_t triangle, edge;
    bool rises; /* from the lower vertex to the higher one */
};

/* A body that is being made. By number of the triangle: corners, normals, boxes, neighbours. */
struct making {
    const struct mesh *mesh;
    uint32_t n;
    uint32_t (*corner)[3], (*neighbour)[3];
    phys_vec *normal, *low, *high;
    struct side *side;       /* 3 n */
    uint32_t *order, *place; /* of the tree; where in it a triangle is */
    struct cloth_error *error;
};

static void load(const struct making *making, uint32_t vertex, phys_vec *x)
{
    const double *from = making->mesh->position + 3 * (size_t)vertex;
    *x = (phys_vec){from[0], from[1], from[2], 0};
}

static void cross(const phys_vec *a, const phys_vec *b, phys_vec *product)
{
    const phys_vec u = *a, v = *b;
    *product = (phys_vec){u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0], 0};
}

/* ---- What a mesh has to be ---- */

static int check_vertices(const struct making *making)
{
    const struct mesh *mesh = making->mesh;
    if (!making->n)
        return cloth_fail(making->error, CLOTH_E_INPUT,
                          "the mesh has no triangles; a closed surface is expected");
    if (making->n >= MAX_TRIANGLES)
        return cloth_fail(making->error, CLOTH_E_INPUT,
                          "the mesh has %u triangles; fewer than %d are expected", making->n,
                          MAX_TRIANGLES);
    for (size_t i = 0; i < 3 * (size_t)mesh->n_vertices; i++)
        if (!(fabs(mesh->position[i]) < CONTACT_BODY_BOUND))
            return cloth_fail(making->error, CLOTH_E_INPUT,
                              "vertex %zu is %g m from the origin along an axis; less than %g m is "
                              "expected (vertices count from 1)",
                              i / 3 + 1, fabs(mesh->position[i]), CONTACT_BODY_BOUND);
    return CLOTH_OK;
}

/* Normals, and boxes. */
static int measure_triangle(struct making *making, uint32_t t)
{
    phys_vec x[3], longest = {0};
    uint32_t *corner = making->corner[t];
    mesh_corners(making->mesh, t, corner);
    for (int i = 0; i < 3; i++)
        load(making, corner[i], x + i);
    for (int c = 0; c < 3; c++) {
        making->low[t][c] = fmin(x[0][c], fmin(x[1][c], x[2][c]));
        making->high[t][c] = fmax(x[0][c], fmax(x[1][c], x[2][c]));
    }
    for (int i = 0; i < 3; i++) {
        const phys_vec edge = x[(i + 1) % 3] - x[i];
        longest[0] = fmax(longest[0], phys_dot(&edge, &edge));
    }
    const phys_vec ab = x[1] - x[0], ac = x[2] - x[0];
    cross(&ab, &ac, making->normal + t);
    const double twice = sqrt(phys_dot(making->normal + t, making->normal + t));
    if (!(twice > FLAT * longest[0]))
        return cloth_fail(making->error, CLOTH_E_INPUT,
                          "triangle %u, of vertices %u, %u and %u, has no area; remove it, or move "
                          "a vertex (triangles and vertices count from 1)",
                          t + 1, corner[0] + 1, corner[1] + 1, corner[2] + 1);
    making->normal[t] /= twice;
    return CLOTH_OK;
}

static int by_ends(const void *left, const void *right)
{
    const struct side *a = left, *b = right;
    if (a->ends != b->ends)
        return a->ends < b->ends ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static void sort_sides(struct making *making)
{
    for (uint32_t t = 0; t < making->n; t++)
        for (uint32_t i = 0; i < 3; i++) {
            const uint32_t a = making->corner[t][i], b = making->corner[t][(i + 1) % 3];
            making->side[3 * (size_t)t + i] =
                (struct side){a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a, t, i, a < b};
        }
    qsort(making->side, 3 * (size_t)making->n, sizeof *making->side, by_ends);
}

/* How many sides have the edge of this one, which is the first of them. */
static size_t count_sides(const struct making *making, size_t first)
{
    size_t n = 1;
    while (first + n < 3 * (size_t)making->n &&
           making->side[first + n].ends == making->side[first].ends)
        n++;
    return n;
}

static int fail_open(const struct making *making, size_t first, size_t n)
{
    const uint64_t ends = making->side[first].ends;
    size_t others = 0;
    for (size_t i = first, count; i < 3 * (size_t)making->n; i += count)
        others += (count = count_sides(making, i)) != 2;
    return cloth_fail(making->error, CLOTH_E_INPUT,
                      "the mesh is not closed: the edge between vertices %u and %u has %zu "
                      "triangle%s where 2 are expected, as %zu edge%s in all (vertices count from "
                      "1); fill the holes, or join the parts",
                      (uint32_t)(ends >> 32) + 1, (uint32_t)ends + 1, n, n == 1 ? "" : "s", others,
                      others == 1 ? " has" : "s have");
}

static int fail_turned(const struct making *making, const struct side *side)
{
    return cloth_fail(making->error, CLOTH_E_INPUT,
                      "triangles %u and %u, at the edge between vertices %u and %u, are wound "
                      "against each other (triangles and vertices count from 1); turn one round",
                      side[0].triangle + 1, side[1].triangle + 1, (uint32_t)(side->ends >> 32) + 1,
                      (uint32_t)side->ends + 1);
}

static int join_sides(struct making *making)
{
    sort_sides(making);
    for (size_t i = 0; i < 3 * (size_t)making->n; i += 2) {
        const struct side *side = making->side + i;
        const size_t n = count_sides(making, i);
        if (n != 2)
            return fail_open(making, i, n);
        if (side[0].rises == side[1].rises)
            return fail_turned(making, side);
        making->neighbour[side[0].triangle][side[0].edge] = side[1].triangle;
        making->neighbour[side[1].triangle][side[1].edge] = side[0].triangle;
    }
    return CLOTH_OK;
}

/* ---- Inside and outside ---- */

/* Six times the volume, m^3, and what it could be: its magnitude were all parts of one sign. */
static void find_volume(const struct making *making, double *volume, double *most)
{
    phys_vec origin;
    load(making, making->corner[0][0], &origin);
    *volume = *most = 0;
    for (uint32_t t = 0; t < making->n; t++) {
        phys_vec x[3], area;
        for (int i = 0; i < 3; i++) {
            load(making, making->corner[t][i], x + i);
            x[i] -= origin;
        }
        cross(x + 1, x + 2, &area);
        const double part = phys_dot(x, &area);
        *volume += part;
        *most += fabs(part);
    }
}

static void turn_round(struct making *making)
{
    for (uint32_t t = 0; t < making->n; t++) {
        uint32_t *corner = making->corner[t], *neighbour = making->neighbour[t];
        const uint32_t second = corner[1], first = neighbour[0];
        corner[1] = corner[2];
        corner[2] = second;
        neighbour[0] = neighbour[2];
        neighbour[2] = first;
        making->normal[t] = -making->normal[t];
    }
}

static int orient(struct making *making, bool *turned)
{
    double volume, most;
    find_volume(making, &volume, &most);
    if (!(fabs(volume) > EMPTY * most))
        return cloth_fail(making->error, CLOTH_E_INPUT,
                          "the mesh holds no room: its volume is zero; a body is expected");
    *turned = volume < 0;
    if (*turned)
        turn_round(making);
    return CLOTH_OK;
}

/* ---- Pseudo-normals ---- */

/* The angle between two vectors of any length, rad, of + - * / and sqrt alone, so that its bits are
 * the same everywhere: three times halved, then the series of the arc tangent. */
static double angle_between(const phys_vec *a, const phys_vec *b)
{
    phys_vec product;
    cross(a, b, &product);
    const double across = sqrt(phys_dot(&product, &product));
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

/* Of all vertices; those that no triangle has keep zero. */
static void add_normals(const struct making *making, phys_vec *normal)
{
    for (uint32_t t = 0; t < making->n; t++) {
        const uint32_t *corner = making->corner[t];
        phys_vec x[3];
        for (int i = 0; i < 3; i++)
            load(making, corner[i], x + i);
        for (int i = 0; i < 3; i++) {
            const phys_vec a = x[(i + 1) % 3] - x[i], b = x[(i + 2) % 3] - x[i];
            normal[corner[i]] += angle_between(&a, &b) * making->normal[t];
        }
    }
    for (uint32_t v = 0; v < making->mesh->n_vertices; v++) {
        const double square = phys_dot(normal + v, normal + v);
        if (square > 0)
            normal[v] /= sqrt(square);
    }
}

/* ---- The body ---- */

static uint64_t whole_lines(uint64_t bytes)
{
    return (bytes + CONTACT_ALIGN - 1) / CONTACT_ALIGN * CONTACT_ALIGN;
}

static void lay_out(const struct making *making, struct contact_body *body)
{
    *body = (struct contact_body){.n_vertices = making->mesh->n_vertices,
                                  .n_triangles = making->n,
                                  .n_nodes = contact_tree_nodes(making->n)};
    body->vertices = whole_lines(sizeof *body);
    body->vertex_normals = body->vertices + whole_lines(body->n_vertices * sizeof(phys_vec));
    body->facets = body->vertex_normals + whole_lines(body->n_vertices * sizeof(phys_vec));
    body->facet_normals =
        body->facets + whole_lines(body->n_triangles * sizeof(struct contact_facet));
    body->nodes = body->facet_normals + whole_lines(body->n_triangles * sizeof(phys_vec));
    body->bytes = body->nodes + body->n_nodes * sizeof(struct contact_node);
}

static void put_vertices(const struct making *making, struct contact_body *body)
{
    phys_vec *to = (void *)((char *)body + body->vertices);
    double most = 0;
    for (uint32_t v = 0; v < body->n_vertices; v++)
        load(making, v, to + v);
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

static void put_facets(const struct making *making, struct contact_body *body)
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
static int put_body(struct making *making, struct contact_body *body)
{
    const int code = contact_tree_build(making->n, making->order, making->low, making->high,
                                        (void *)((char *)body + body->nodes), making->error);
    if (code)
        return code;
    put_vertices(making, body);
    put_facets(making, body);
    return CLOTH_OK;
}

static int append(struct contact_bodies *bodies, struct making *making)
{
    struct contact_body laid;
    lay_out(making, &laid);
    char *memory = aligned_alloc(CONTACT_ALIGN, bodies->bytes + laid.bytes);
    if (!memory)
        return cloth_fail(making->error, CLOTH_E_MEMORY, "no memory for a body of %u triangles",
                          making->n);
    if (bodies->bytes)
        memcpy(memory, bodies->memory, bodies->bytes);
    char *body = memory + bodies->bytes;
    memset(body, 0, laid.bytes);
    memcpy(body, &laid, sizeof laid);
    const int code = put_body(making, (void *)body);
    if (code) {
        free(memory);
        return code;
    }
    free(bodies->memory);
    *bodies = (struct contact_bodies){memory, bodies->bytes + laid.bytes, bodies->n + 1};
    return CLOTH_OK;
}

static int take_room(struct making *making)
{
    const uint32_t n = making->n;
    making->corner = cloth_alloc(n, sizeof *making->corner, making->error);
    making->neighbour = cloth_alloc(n, sizeof *making->neighbour, making->error);
    making->side = cloth_alloc(n, 3 * sizeof *making->side, making->error);
    making->order = cloth_alloc(n, sizeof *making->order, making->error);
    making->place = cloth_alloc(n, sizeof *making->place, making->error);
    making->normal = aligned_alloc(CONTACT_ALIGN, whole_lines(3 * n * sizeof *making->normal));
    if (!making->normal)
        return cloth_fail(making->error, CLOTH_E_MEMORY, "no memory for a body of %u triangles", n);
    making->low = making->normal + n;
    making->high = making->low + n;
    memset(making->normal, 0, 3 * n * sizeof *making->normal);
    return making->error->code;
}

static void free_room(struct making *making)
{
    free(making->corner);
    free(making->neighbour);
    free(making->side);
    free(making->order);
    free(making->place);
    free(making->normal);
}

int contact_bodies_add(struct contact_bodies *bodies, const struct mesh *mesh, bool *turned,
                       struct cloth_error *error)
{
    struct cloth_error own = {0};
    struct making making = {.mesh = mesh, .n = mesh->n_triangles, .error = &own};
    int code = check_vertices(&making);
    code = code ? code : take_room(&making);
    for (uint32_t t = 0; t < making.n && !code; t++)
        code = measure_triangle(&making, t);
    code = code ? code : join_sides(&making);
    code = code ? code : orient(&making, turned);
    code = code ? code : append(bodies, &making);
    free_room(&making);
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
