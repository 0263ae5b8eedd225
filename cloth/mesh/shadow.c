/* A shadow is cut by evenly spaced lines. The intervals of all triangles along a line are joined,
 * so overlapping triangles count once. */
#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/vector.h"
#include "cloth/mesh/mesh.h"

#include <stdlib.h>

enum { LINES = 2048 };
#define NO_TRIANGLE UINT32_MAX

struct interval {
    double from, to;
};

struct shadow {
    const struct mesh_shape *shape;
    double (*at)[2];       /* of each vertex: along the lines, across them */
    double low, apart;     /* the lowest vertex; the distance of two lines */
    uint32_t first[LINES]; /* a triangle whose lowest corner this line is the first above; */
    uint32_t *next;        /* by triangle, another one; NO_TRIANGLE: there is none */
    uint32_t *active;      /* triangles that a line may cut */
    struct interval *cut;
};

/* Two directions of length 1 across an axis of any length, at right angles. */
static void shadow_find_frame(const double axis[3], double along[3], double across[3])
{
    int least = fabs(axis[1]) < fabs(axis[0]) ? 1 : 0;
    least = fabs(axis[2]) < fabs(axis[least]) ? 2 : least;
    const int i = (least + 1) % 3, j = (least + 2) % 3;
    const double size = sqrt(axis[i] * axis[i] + axis[j] * axis[j]);
    const double whole = sqrt(size * size + axis[least] * axis[least]);
    along[least] = 0;
    along[i] = -axis[j] / size;
    along[j] = axis[i] / size;
    cloth_cross(axis, along, across);
    for (int c = 0; c < 3; c++)
        across[c] /= whole;
}

static void project_vertices(struct shadow *shadow, const double axis[3])
{
    double along[3], across[3], low = INFINITY, high = -INFINITY;
    shadow_find_frame(axis, along, across);
    for (uint32_t v = 0; v < shadow->shape->n_vertices; v++) {
        const double *x = shadow->shape->position + 3 * (size_t)v;
        shadow->at[v][0] = cloth_dot(along, x);
        shadow->at[v][1] = cloth_dot(across, x);
        low = fmin(low, shadow->at[v][1]);
        high = fmax(high, shadow->at[v][1]);
    }
    shadow->low = low;
    shadow->apart = (high - low) / LINES;
}

static double line_at(const struct shadow *shadow, uint32_t j)
{
    return shadow->low + (j + 0.5) * shadow->apart;
}

static void shadow_list_triangles(struct shadow *shadow)
{
    for (uint32_t j = 0; j < LINES; j++)
        shadow->first[j] = NO_TRIANGLE;
    for (uint32_t t = 0; t < shadow->shape->n_triangles; t++) {
        double low = INFINITY;
        for (int c = 0; c < 3; c++)
            low = fmin(low, shadow->at[shadow->shape->corner[t][c]][1]);
        const double before = (low - shadow->low) / shadow->apart - 1; /* rounded */
        uint32_t j = before > 0 ? (uint32_t)before : 0;
        while (j < LINES && !(low < line_at(shadow, j)))
            j++;
        shadow->next[t] = j < LINES ? shadow->first[j] : NO_TRIANGLE;
        if (j < LINES)
            shadow->first[j] = t;
    }
}

/* The interval of a line in a triangle; from > to: none. */
static struct interval shadow_cut_triangle(const struct shadow *shadow, uint32_t t, double line)
{
    struct interval cut = {INFINITY, -INFINITY};
    for (int c = 0; c < 3; c++) {
        const double *a = shadow->at[shadow->shape->corner[t][c]];
        const double *b = shadow->at[shadow->shape->corner[t][(c + 1) % 3]];
        if ((a[1] < line) == (b[1] < line))
            continue;
        const double along = a[0] + (b[0] - a[0]) * ((line - a[1]) / (b[1] - a[1]));
        cut.from = fmin(cut.from, along);
        cut.to = fmax(cut.to, along);
    }
    return cut;
}

static double length_of_union(struct interval *cut, uint32_t n)
{
    double length = 0, end = -INFINITY;
    qsort(cut, n, sizeof *cut, cloth_by_double); /* by `from` */
    for (uint32_t i = 0; i < n; i++) {
        if (cut[i].to > end)
            length += cut[i].to - fmax(cut[i].from, end);
        end = fmax(end, cut[i].to);
    }
    return length;
}

/* A triangle is listed at the first line above its lowest corner. So the first line that does not
 * cut it is above it, as are all that follow. */
static double sweep_lines(struct shadow *shadow)
{
    double length = 0;
    uint32_t n_active = 0;
    for (uint32_t j = 0; j < LINES; j++) {
        for (uint32_t t = shadow->first[j]; t != NO_TRIANGLE; t = shadow->next[t])
            shadow->active[n_active++] = t;
        uint32_t n = 0;
        for (uint32_t i = 0; i < n_active; i++) {
            shadow->cut[n] = shadow_cut_triangle(shadow, shadow->active[i], line_at(shadow, j));
            if (shadow->cut[n].from <= shadow->cut[n].to)
                shadow->active[n++] = shadow->active[i];
        }
        n_active = n;
        length += length_of_union(shadow->cut, n);
    }
    return length * shadow->apart;
}

int mesh_shadow(const struct mesh_shape *shape, const double axis[3], double *area,
                struct cloth_error *error)
{
    const size_t n = shape->n_triangles;
    struct shadow shadow = {.shape = shape};
    struct cloth_pool memory = {0};
    shadow.at = cloth_take(&memory, shape->n_vertices, sizeof *shadow.at, error);
    shadow.next = cloth_take(&memory, n, sizeof *shadow.next, error);
    shadow.active = cloth_take(&memory, n, sizeof *shadow.active, error);
    shadow.cut = cloth_take(&memory, n, sizeof *shadow.cut, error);
    const int code = memory.lacks ? CLOTH_E_MEMORY : CLOTH_OK;
    *area = 0;
    if (!code)
        project_vertices(&shadow, axis);
    if (!code && shadow.apart > 0) {
        shadow_list_triangles(&shadow);
        *area = sweep_lines(&shadow);
    }
    cloth_pool_free(&memory);
    return code;
}

double mesh_surface(const struct mesh *mesh)
{
    double area = 0;
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        area += mesh_triangle_area(mesh, t);
    return area;
}
