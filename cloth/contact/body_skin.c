/* Each edge of a body is that of two facets, and a feature of the first of them; a vertex is one of
 * the first facet that has it. Vertices that no triangle has are points, but no features. */
#include "cloth/contact/body_skin.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The most that there may be: all vertices have triangles. */
static void measure_skin(const struct contact_body *body, struct contact_skin *skin)
{
    *skin = (struct contact_skin){.n_points = body->n_vertices,
                                  .n_triangles = body->n_triangles,
                                  .n_edges = body->n_triangles / 2 * 3,
                                  .n_vertices = body->n_vertices};
}

size_t contact_body_skin_bytes(const struct contact_body *body)
{
    struct contact_skin skin;
    measure_skin(body, &skin);
    return contact_skin_bytes(&skin);
}

size_t contact_body_boxes_bytes(const struct contact_body *body)
{
    struct contact_skin skin;
    measure_skin(body, &skin);
    return contact_boxes_bytes(&skin);
}

struct body_source {
    uint32_t (*corner)[3], *id;
    unsigned char *stands, *seen; /* by triangle; by vertex */
};

static int make_source(const struct contact_body *body, struct body_source *source,
                       struct cloth_error *error)
{
    source->corner = cloth_alloc(body->n_triangles, sizeof *source->corner, error);
    source->stands = cloth_alloc(body->n_triangles, sizeof *source->stands, error);
    source->id = cloth_alloc(body->n_vertices, sizeof *source->id, error);
    source->seen = cloth_alloc(body->n_vertices, sizeof *source->seen, error);
    return source->corner && source->stands && source->id && source->seen ? CLOTH_OK
                                                                          : CLOTH_E_MEMORY;
}

static void free_source(struct body_source *source)
{
    free(source->corner);
    free(source->stands);
    free(source->id);
    free(source->seen);
}

static void put_source(const struct contact_body *body, uint32_t first_id,
                       struct body_source *source)
{
    const struct contact_facet *facet = contact_body_facets(body);
    memset(source->seen, 0, body->n_vertices);
    for (uint32_t v = 0; v < body->n_vertices; v++)
        source->id[v] = first_id + v;
    for (uint32_t f = 0; f < body->n_triangles; f++) {
        unsigned stands = 0;
        for (int k = 0; k < 3; k++) {
            const uint32_t corner = facet[f].corner[k];
            stands |= (unsigned)!source->seen[corner] << k;
            stands |= (unsigned)(f < facet[f].neighbour[k]) << (3 + k);
            source->seen[corner] = 1;
            source->corner[f][k] = corner;
        }
        source->stands[f] = (unsigned char)stands;
    }
}

int contact_body_skin_make(const struct contact_body *body, uint32_t first_id, void *table,
                           struct cloth_error *error)
{
    struct body_source source = {0};
    int code = make_source(body, &source, error);
    if (!code) {
        put_source(body, first_id, &source);
        memset(source.seen, 1, body->n_vertices); /* none can be cut */
        const struct contact_skin_source from = {
            .n_points = body->n_vertices,
            .n_triangles = body->n_triangles,
            .corner = (const uint32_t(*)[3])(const void *)source.corner,
            .stands = source.stands,
            .id = source.id,
            .held = source.seen,
            .x = contact_body_vertices(body)};
        memset(table, 0, contact_body_skin_bytes(body));
        code = contact_skin_make(&from, table, error);
    }
    free_source(&source);
    return code;
}

static void body_skin_place_points(const struct phys_pose *pose, size_t n, const phys_vec *from,
                                   phys_vec *to)
{
    for (size_t i = 0; i < n; i++)
        phys_pose_point(pose, from + i, to + i);
}

void contact_body_ends(const struct contact_body *body, const struct contact_pose *pose,
                       phys_vec *x, phys_vec *y, phys_vec *way)
{
    const phys_vec *vertex = contact_body_vertices(body);
    phys_vec middle = {0}, was, is;
    *way = (phys_vec){0};
    if (body->n_frames) {
        contact_body_places(body, pose->begin, x);
        contact_body_places(body, pose->end, y);
        for (uint32_t v = 0; v < body->n_vertices; v++)
            *way += (y[v] - x[v]) / body->n_vertices;
        return;
    }
    if (!pose->moves) {
        memcpy(x, vertex, body->n_vertices * sizeof *x);
        memcpy(y, vertex, body->n_vertices * sizeof *y);
        return;
    }
    body_skin_place_points(&pose->from, body->n_vertices, vertex, x);
    body_skin_place_points(&pose->to, body->n_vertices, vertex, y);
    for (int c = 0; c < 3; c++)
        middle[c] = (body->low[c] + body->high[c]) / 2;
    phys_pose_point(&pose->from, &middle, &was);
    phys_pose_point(&pose->to, &middle, &is);
    *way = is - was;
}

void contact_body_vertex_ends(const struct contact_body *body, const struct contact_pose *pose,
                              uint32_t vertex, phys_vec *x, phys_vec *y)
{
    const phys_vec *from = contact_body_vertices(body) + vertex;
    if (body->n_frames) {
        contact_body_vertex_place(body, pose->begin, vertex, x);
        contact_body_vertex_place(body, pose->end, vertex, y);
    } else if (pose->moves) {
        phys_pose_point(&pose->from, from, x);
        phys_pose_point(&pose->to, from, y);
    } else {
        *x = *y = *from;
    }
}
