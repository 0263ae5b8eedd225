/* Corners are rounded to whole numbers, FINE to a side of a pixel. So the side of an edge on which
 * the middle of a pixel lies is exact, and triangles that share the edge agree. A closed body
 * covers each pixel as often from the front as from the back. */
#include "cloth/contact/image.h"

#include <math.h>
#include <string.h>

enum { FINE = 4096, STACK = 64 };
/* Cosine between a triangle and the normal of its corner: beyond it there is an edge. */
static const double ROUND = 0.8;
/* Normals lean at least so much towards the viewer: no surface seen leads away. */
static const double LEAST_FACING = 0.05;

/* A strip that is drawn. */
struct drawing {
    const struct contact_body *body;
    const struct contact_view *view;
    uint32_t first, n; /* rows */
    uint32_t u, v;     /* axes of columns and rows */
    struct contact_pixel *pixel;
    struct contact_pixel_velocity *velocity; /* NULL: the body has no frames */
};

/* A triangle in it, counterclockwise as it is seen. */
struct seen {
    int side;         /* 0: from the front, 1: from the back */
    int64_t at[3][2]; /* column and row, in parts of a pixel */
    int64_t area;     /* twice of it, > 0 */
    double depth[3];
    double normal[3][3], velocity[3][3]; /* of the corners; velocities where the body has them */
};

size_t contact_strip_bytes(const struct contact_body *body, const struct contact_view *view,
                           uint32_t strip)
{
    const size_t pixel =
        sizeof(struct contact_pixel) + (body->n_frames ? sizeof(struct contact_pixel_velocity) : 0);
    return pixel * view->width * contact_view_rows(view, strip);
}

/* ---- A triangle ---- */

static int64_t edge_side(const int64_t a[2], const int64_t b[2], const int64_t x[2])
{
    return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
}

/* True if an edge owns the points on it: exactly one of its two directions does. */
static bool edge_owns(const int64_t a[2], const int64_t b[2])
{
    return b[1] < a[1] || (b[1] == a[1] && b[0] < a[0]);
}

/* Fills corner k with that of a facet. */
static void see_corner(const struct drawing *d, uint32_t f, uint32_t corner, int k,
                       struct seen *seen)
{
    const struct contact_body *body = d->body;
    const phys_vec *flat = contact_facet_normals(body) + f;
    const phys_vec *round = contact_body_normals(body) + corner;
    const double *x = (const double *)(contact_body_vertices(body) + corner);
    const double *normal = (const double *)(phys_dot(flat, round) > ROUND ? round : flat);
    const double scale = FINE / d->view->pitch;
    seen->at[k][0] = (int64_t)((x[d->u] - body->low[d->u]) * scale + 0.5);
    seen->at[k][1] = (int64_t)((x[d->v] - body->low[d->v]) * scale + 0.5);
    seen->depth[k] = x[d->view->axis] - body->low[d->view->axis];
    memcpy(seen->normal[k], normal, sizeof seen->normal[k]);
    if (d->velocity)
        memcpy(seen->velocity[k], contact_body_velocities(body) + corner, sizeof seen->velocity[k]);
}

/* Returns false for one that covers nothing. */
static bool see_facet(const struct drawing *d, uint32_t f, struct seen *seen)
{
    const uint32_t *corner = contact_body_facets(d->body)[f].corner;
    for (int k = 0; k < 3; k++)
        see_corner(d, f, corner[k], k, seen);
    seen->area = edge_side(seen->at[0], seen->at[1], seen->at[2]);
    seen->side = seen->area < 0;
    if (seen->side) {
        see_corner(d, f, corner[2], 1, seen);
        see_corner(d, f, corner[1], 2, seen);
        seen->area = -seen->area;
    }
    return seen->area != 0;
}

/* ---- Its pixels ---- */

static double image_draw_blend(const double weight[3], const double of[3][3], uint32_t c)
{
    return weight[0] * of[0][c] + weight[1] * of[1][c] + weight[2] * of[2][c];
}

static void put_pixel(const struct drawing *d, const struct seen *seen, const double weight[3],
                      size_t at)
{
    const uint32_t axis = d->view->axis, u = d->u, v = d->v;
    const double x = image_draw_blend(weight, seen->normal, u),
                 y = image_draw_blend(weight, seen->normal, v);
    const double out = image_draw_blend(weight, seen->normal, axis), towards = seen->side ? -1 : 1;
    const double z = towards * out < LEAST_FACING ? towards * LEAST_FACING : out;
    const double part = 1 / sqrt(x * x + y * y + z * z);
    float *normal = d->pixel[at].normal[seen->side];
    normal[u] = (float)(part * x);
    normal[v] = (float)(part * y);
    normal[axis] = (float)(part * z);
    for (uint32_t c = 0; d->velocity && c < 3; c++)
        d->velocity[at].of[seen->side][c] = (float)image_draw_blend(weight, seen->velocity, c);
}

/* Draws a pixel. If depths are equal, the first triangle of the tree stays. */
static void try_pixel(const struct drawing *d, const struct seen *seen, const int64_t inside[3],
                      size_t at)
{
    double weight[3];
    for (int k = 0; k < 3; k++)
        weight[k] = (double)inside[k] / (double)seen->area;
    const float depth = (float)(weight[0] * seen->depth[0] + weight[1] * seen->depth[1] +
                                weight[2] * seen->depth[2]);
    float *there = d->pixel[at].depth + seen->side;
    if (seen->side ? !(depth < *there) : !(depth > *there))
        return;
    *there = depth;
    put_pixel(d, seen, weight, at);
}

/* Pixels whose middles lie from the least to the largest of three numbers; bounded by 0 .. n - 1 */
static void image_draw_find_range(const struct seen *seen, int way, int64_t n, int64_t range[2])
{
    const int64_t a = seen->at[0][way], b = seen->at[1][way], c = seen->at[2][way];
    const int64_t ab = a < b ? a : b, low = ab < c ? ab : c;
    const int64_t ba = a < b ? b : a, high = ba < c ? c : ba;
    range[0] = (low + FINE / 2 - 1) / FINE;
    range[1] = (high + FINE / 2) / FINE - 1;
    range[1] = range[1] < n - 1 ? range[1] : n - 1;
}

static void draw_facet(const struct drawing *d, uint32_t f)
{
    struct seen seen;
    int64_t column[2], row[2], start[3], across[3], own[3];
    if (!see_facet(d, f, &seen))
        return;
    image_draw_find_range(&seen, 0, d->view->width, column);
    image_draw_find_range(&seen, 1, d->first + d->n, row);
    row[0] = row[0] > d->first ? row[0] : d->first;
    const int64_t first[2] = {column[0] * FINE + FINE / 2, row[0] * FINE + FINE / 2};
    for (int k = 0; k < 3; k++) { /* of the edge that corner k is not on */
        const int64_t *a = seen.at[(k + 1) % 3], *b = seen.at[(k + 2) % 3];
        start[k] = edge_side(a, b, first);
        across[k] = -(b[1] - a[1]) * FINE;
        own[k] = edge_owns(a, b) ? 0 : 1;
    }
    for (int64_t j = row[0]; j <= row[1]; j++) {
        int64_t inside[3] = {start[0], start[1], start[2]};
        for (int64_t i = column[0]; i <= column[1]; i++) {
            if (inside[0] >= own[0] && inside[1] >= own[1] && inside[2] >= own[2])
                try_pixel(d, &seen, inside, (size_t)(j - d->first) * d->view->width + (size_t)i);
            for (int k = 0; k < 3; k++)
                inside[k] += across[k];
        }
        for (int k = 0; k < 3; k++)
            start[k] += (seen.at[(k + 2) % 3][0] - seen.at[(k + 1) % 3][0]) * FINE;
    }
}

/* ---- The strip ---- */

static void clear_strip(const struct drawing *d)
{
    const size_t n = (size_t)d->n * d->view->width;
    for (size_t i = 0; i < n; i++)
        d->pixel[i] = (struct contact_pixel){.depth = {-INFINITY, INFINITY}};
    for (size_t i = 0; d->velocity && i < n; i++)
        d->velocity[i] = (struct contact_pixel_velocity){0};
}

/* True if a part of a node may have pixels in the strip. */
static bool image_draw_is_near(const struct drawing *d, const struct contact_node *node, int part)
{
    const double low = d->body->low[d->v], pitch = d->view->pitch;
    return (double)node->high[d->v][part] >= low + ((double)d->first - 1) * pitch &&
           (double)node->low[d->v][part] <= low + ((double)d->first + d->n + 1) * pitch;
}

/* Draws in the order of the tree, which does not depend on the strip. */
static void draw_facets(const struct drawing *d)
{
    uint32_t stack[STACK], n = 0;
    stack[n++] = 0;
    while (n) {
        const uint32_t child = stack[--n];
        if (child & CONTACT_IS_LEAF) {
            for (uint32_t i = 0; i < contact_leaf_n(child); i++)
                draw_facet(d, contact_leaf_first(child) + i);
            continue;
        }
        const struct contact_node *node = contact_body_nodes(d->body) + child;
        for (int part = 3; part >= 0; part--)
            if (node->low[0][part] <= node->high[0][part] && image_draw_is_near(d, node, part))
                stack[n++] = node->child[part];
    }
}

void contact_strip_draw(const struct contact_body *body, const struct contact_view *view,
                        uint32_t strip, void *memory)
{
    struct drawing d = {.body = body,
                        .view = view,
                        .first = strip * view->rows,
                        .n = contact_view_rows(view, strip),
                        .u = (view->axis + 1) % 3,
                        .v = (view->axis + 2) % 3,
                        .pixel = memory};
    if (body->n_frames)
        d.velocity = (void *)(d.pixel + (size_t)d.n * view->width);
    clear_strip(&d);
    draw_facets(&d);
}
