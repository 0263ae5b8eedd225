/* The card's vertices are those of the last move; the faces never change. */
#include "cloth/view/draw/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Triangles that are few enough. Lengths of edges that may vanish, and how far a vertex may leave
 * the surface that way, in radii of the mesh: the sky's light on a vertex is looked for an
 * eightieth of a radius off it (draw_lights_aim), and would be none where a coarse triangle is
 * farther out. */
enum { COARSE = 3000, MAX_ROUNDS = 3 };
static const float SHORT = 0.04f, FLAT = 0.002f;

/* Limits of joining, m. */
struct joins {
    const float *vertex;
    uint32_t *join;
    float longest, flat;
};

/* Where an edge is so short, and either end so near to the plane of the other one, that it may
 * vanish. */
static bool may_join(const struct joins *joins, uint32_t a, uint32_t b)
{
    const float *p = joins->vertex + 6 * (size_t)a, *q = joins->vertex + 6 * (size_t)b;
    float square = 0, off_p = 0, off_q = 0;
    for (int k = 0; k < 3; k++) {
        const float way = p[k] - q[k];
        square += way * way;
        off_p += way * p[3 + k];
        off_q += way * q[3 + k];
    }
    return square < joins->longest * joins->longest && fabsf(off_p) <= joins->flat &&
           fabsf(off_q) <= joins->flat;
}

/* All three to the first one, where none is joined yet. */
static void join_triangle(const struct joins *joins, const uint32_t of[3])
{
    for (int i = 0; i < 3; i++)
        if (joins->join[of[i]] != UINT32_MAX || !may_join(joins, of[i], of[(i + 1) % 3]))
            return;
    joins->join[of[0]] = joins->join[of[1]] = joins->join[of[2]] = of[0];
}

/* A corner that is not joined yet to where a neighbour is. */
static void join_corner(const struct joins *joins, const uint32_t of[3], int corner)
{
    for (int k = 1; k < 3 && joins->join[of[corner]] == UINT32_MAX; k++) {
        const uint32_t to = joins->join[of[(corner + k) % 3]];
        if (to != UINT32_MAX && may_join(joins, of[corner], of[(corner + k) % 3]) &&
            may_join(&(struct joins){joins->vertex, NULL, INFINITY, joins->flat}, of[corner], to))
            joins->join[of[corner]] = to;
    }
}

uint32_t draw_coarsen(uint32_t n_vertices, const float *vertex, float longest, float flat,
                      uint32_t *join, uint32_t n, uint32_t (*triangle)[3])
{
    const struct joins joins = {vertex, join, longest, flat};
    uint32_t left = 0;
    for (uint32_t v = 0; v < n_vertices; v++)
        join[v] = UINT32_MAX;
    for (uint32_t t = 0; t < n; t++)
        join_triangle(&joins, triangle[t]);
    for (uint32_t t = 0; t < n; t++)
        for (int corner = 0; corner < 3; corner++)
            join_corner(&joins, triangle[t], corner);
    for (uint32_t t = 0; t < n; t++) {
        uint32_t to[3];
        for (int i = 0; i < 3; i++)
            to[i] = join[triangle[t][i]] == UINT32_MAX ? triangle[t][i] : join[triangle[t][i]];
        if (to[0] != to[1] && to[1] != to[2] && to[2] != to[0])
            memcpy(triangle[left++], to, sizeof to);
    }
    return left;
}

static size_t behind_lines(const struct draw_mesh *mesh)
{
    return (size_t)12 * mesh->n_triangles + (size_t)8 * mesh->n_lines;
}

static void upload_indices(const struct draw_mesh *mesh, const uint32_t *line)
{
    const size_t triangles = (size_t)12 * mesh->n_triangles, lines = (size_t)8 * mesh->n_lines;
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(2 * triangles + lines), NULL,
                 GL_STATIC_DRAW);
    glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, (GLsizeiptr)triangles, mesh->triangle);
    glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, (GLintptr)triangles, (GLsizeiptr)lines, line);
}

/* Adds the coarse triangles behind the others and the lines. A mesh that there is no memory for
 * casts all its triangles. */
static void make_coarse(struct draw_mesh *mesh)
{
    const size_t bytes = (size_t)12 * mesh->n_triangles;
    uint32_t *join = malloc(((size_t)mesh->n_vertices + 1) * sizeof *join);
    uint32_t(*triangle)[3] = malloc(bytes + 1);
    mesh->n_coarse = mesh->n_triangles;
    if (triangle)
        memcpy(triangle, mesh->triangle, bytes);
    for (int round = 0; round < MAX_ROUNDS && mesh->n_coarse > COARSE && join && triangle; round++)
        mesh->n_coarse =
            draw_coarsen(mesh->n_vertices, mesh->vertex, (float)(round + 1) * SHORT * mesh->radius,
                         FLAT * mesh->radius, join, mesh->n_coarse, triangle);
    glBindVertexArray(mesh->array);
    glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, (GLintptr)behind_lines(mesh),
                    (GLsizeiptr)((size_t)12 * mesh->n_coarse),
                    triangle ? (const void *)triangle : mesh->triangle);
    free(join);
    free(triangle);
}

int draw_mesh_make(struct draw_mesh *mesh, uint32_t n_vertices, uint32_t n_triangles,
                   const uint32_t *triangle, uint32_t n_lines, const uint32_t *line,
                   struct cloth_error *error)
{
    *mesh = (struct draw_mesh){.n_vertices = n_vertices,
                               .n_triangles = n_triangles,
                               .n_lines = n_lines,
                               .triangle = triangle};
    mesh->vertex = calloc((size_t)n_vertices + 1, 6 * sizeof *mesh->vertex);
    if (!mesh->vertex)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to draw %u vertices", n_vertices);
    glGenVertexArrays(1, &mesh->array);
    glGenBuffers(1, &mesh->vertices);
    glGenBuffers(1, &mesh->indices);
    glBindVertexArray(mesh->array);
    glBindBuffer(GL_ARRAY_BUFFER, mesh->vertices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->indices);
    upload_indices(mesh, line);
    for (GLuint i = 0; i < 2; i++) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 6 * sizeof(float),
                              (const void *)(i * 3 * sizeof(float)));
    }
    return draw_sky_make(&mesh->sky, n_vertices ? n_vertices : 1, error);
}

/* Area-weighted; up where no triangle says. */
static void find_normals(uint32_t n_vertices, float *vertex, uint32_t n_triangles,
                         const uint32_t *triangle)
{
    for (size_t v = 0; v < n_vertices; v++)
        memset(vertex + 6 * v + 3, 0, 3 * sizeof *vertex);
    for (size_t t = 0; t < n_triangles; t++) {
        float *p[3], e[2][3];
        for (size_t i = 0; i < 3; i++)
            p[i] = vertex + 6 * (size_t)triangle[3 * t + i];
        for (int k = 0; k < 3; k++) {
            e[0][k] = p[1][k] - p[0][k];
            e[1][k] = p[2][k] - p[0][k];
        }
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            float n = e[0][a] * e[1][b] - e[0][b] * e[1][a]; /* twice the area */
            for (int i = 0; i < 3; i++)
                p[i][3 + k] += n;
        }
    }
    for (size_t v = 0; v < n_vertices; v++) {
        float *n = vertex + 6 * v + 3;
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++)
            n[k] = length > 0 ? n[k] / length : (float)(k == 1);
    }
}

static void find_sphere(struct draw_mesh *mesh)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t v = 0; v < mesh->n_vertices; v++)
        for (size_t k = 0; k < 3; k++) {
            low[k] = fminf(low[k], mesh->vertex[6 * v + k]);
            high[k] = fmaxf(high[k], mesh->vertex[6 * v + k]);
        }
    float square = 0;
    for (int k = 0; k < 3; k++) {
        mesh->center[k] = 0.5f * (low[k] + high[k]);
        square += (high[k] - low[k]) * (high[k] - low[k]);
    }
    mesh->radius = fmaxf(0.5f * sqrtf(square), 1e-6f);
}

static void upload_vertices(struct draw_mesh *mesh)
{
    find_sphere(mesh);
    glBindBuffer(GL_ARRAY_BUFFER, mesh->vertices);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)((size_t)mesh->n_vertices * 6 * sizeof *mesh->vertex),
                 mesh->vertex, GL_DYNAMIC_DRAW);
    if (mesh->n_triangles)
        make_coarse(mesh);
}

void draw_mesh_move(struct draw_mesh *mesh, const double *position)
{
    for (size_t v = 0; v < mesh->n_vertices; v++)
        for (size_t k = 0; k < 3; k++)
            mesh->vertex[6 * v + k] = (float)position[3 * v + k];
    find_normals(mesh->n_vertices, mesh->vertex, mesh->n_triangles, mesh->triangle);
    upload_vertices(mesh);
}

void draw_mesh_place(struct draw_mesh *mesh, const double (*vertex)[6])
{
    for (size_t v = 0; v < mesh->n_vertices; v++)
        for (size_t k = 0; k < 6; k++)
            mesh->vertex[6 * v + k] = (float)vertex[v][k];
    upload_vertices(mesh);
}

void draw_mesh_values(struct draw_mesh *mesh, const float *value)
{
    glBindVertexArray(mesh->array);
    if (!mesh->values)
        glGenBuffers(1, &mesh->values);
    glBindBuffer(GL_ARRAY_BUFFER, mesh->values);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(mesh->n_vertices * sizeof *value), value,
                 GL_DYNAMIC_DRAW);
    glEnableVertexAttribArray(DRAW_VALUE);
    glVertexAttribPointer(DRAW_VALUE, 1, GL_FLOAT, GL_FALSE, 0, NULL);
}

float draw_mesh_edge(const struct draw_mesh *mesh)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)3 * mesh->n_triangles; i++) {
        const float *a = mesh->vertex + 6 * (size_t)mesh->triangle[i];
        const float *b = mesh->vertex + 6 * (size_t)mesh->triangle[i % 3 == 2 ? i - 2 : i + 1];
        double square = 0;
        for (int k = 0; k < 3; k++)
            square += (double)((a[k] - b[k]) * (a[k] - b[k]));
        sum += sqrt(square);
    }
    return mesh->n_triangles ? (float)(sum / (3.0 * mesh->n_triangles)) : 0;
}

void draw_mesh_draw_part(const struct draw_mesh *mesh, const struct draw_part *part)
{
    const size_t lines = (size_t)12 * mesh->n_triangles + (size_t)8 * part->line;
    glBindVertexArray(mesh->array);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * part->n_triangles), GL_UNSIGNED_INT,
                   (const void *)((size_t)12 * part->triangle));
    if (part->n_lines)
        glDrawElements(GL_LINES, (GLsizei)(2 * part->n_lines), GL_UNSIGNED_INT,
                       (const void *)lines);
}

void draw_mesh_draw(const struct draw_mesh *mesh)
{
    draw_mesh_draw_part(mesh, &(struct draw_part){0, mesh->n_triangles, 0, mesh->n_lines});
}

void draw_mesh_draw_coarse(const struct draw_mesh *mesh)
{
    glBindVertexArray(mesh->array);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * mesh->n_coarse), GL_UNSIGNED_INT,
                   (const void *)behind_lines(mesh));
}

void draw_mesh_free(struct draw_mesh *mesh)
{
    glDeleteVertexArrays(1, &mesh->array);
    glDeleteBuffers(1, &mesh->vertices);
    glDeleteBuffers(1, &mesh->indices);
    glDeleteBuffers(1, &mesh->values);
    draw_sky_free(&mesh->sky);
    free(mesh->vertex);
    mesh->vertex = NULL;
}
