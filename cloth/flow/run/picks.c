/* The vertices that a part of the scene means: listed ones, the one nearest to a point and all
 * within a radius of that point, or all in a box. The last two mean used ones only. */
#include "cloth/flow/run/source.h"

int flow_no_vertex(const struct model_cloth *cloth, const char *what, uint32_t vertex,
                   const char *place, struct cloth_error *error)
{
    return model_fail(place, error,
                      "%s of cloth '%.60s' names vertex %u; its mesh has the vertices 0 to %u",
                      what, cloth->name, vertex, cloth->mesh.n_vertices - 1);
}

static int pick_one(struct flow_picking *picking, uint32_t vertex, struct cloth_error *error)
{
    vertex += picking->first;
    return cloth_list_put(&picking->list, &vertex, sizeof vertex, error);
}

static int pick_vertices(const struct model_pick *pick, struct flow_picking *picking,
                         struct cloth_error *error)
{
    const struct model_cloth *cloth = picking->cloth;
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < pick->n_vertices && !code; i++)
        code = pick->vertices[i] < cloth->mesh.n_vertices
                   ? pick_one(picking, pick->vertices[i], error)
                   : flow_no_vertex(cloth, picking->what, pick->vertices[i], pick->place, error);
    return code;
}

static double square_distance(const double *a, const double *b)
{
    const phys_vec d = {a[0] - b[0], a[1] - b[1], a[2] - b[2], 0};
    return phys_dot(&d, &d);
}

/* A vertex at a distance of the radius is within it, however that was rounded. */
static const double ROUNDED = 1 + 1e-9;

/* The used vertex nearest to the point, the first of equals, and all within the radius. */
static int pick_nearest(const struct model_pick *pick, struct flow_picking *picking,
                        struct cloth_error *error)
{
    const struct mesh *mesh = &picking->cloth->mesh;
    const unsigned char *used = picking->used + picking->first;
    uint32_t best = UINT32_MAX;
    int code = CLOTH_OK;
    double least = 0;
    for (uint32_t v = 0; v < mesh->n_vertices; v++) {
        const double distance = square_distance(mesh->position + 3 * (size_t)v, pick->point);
        if (used[v] && (best == UINT32_MAX || distance < least)) {
            best = v;
            least = distance;
        }
    }
    if (best == UINT32_MAX)
        return model_fail(pick->place, error, "cloth '%.60s' has %s but neither a face nor an edge",
                          picking->cloth->name, picking->what);
    const double radius = pick->radius * ROUNDED;
    for (uint32_t v = 0; v < mesh->n_vertices && !code; v++) {
        const double distance = square_distance(mesh->position + 3 * (size_t)v, pick->point);
        if (v == best || (radius > 0 && used[v] && distance <= radius * radius))
            code = pick_one(picking, v, error);
    }
    return code;
}

static int pick_box(const struct model_pick *pick, struct flow_picking *picking,
                    struct cloth_error *error)
{
    const struct mesh *mesh = &picking->cloth->mesh;
    const size_t before = picking->list.n;
    int code = CLOTH_OK;
    for (uint32_t v = 0; v < mesh->n_vertices && !code; v++) {
        bool in = picking->used[picking->first + v];
        for (size_t c = 0; c < 3; c++) { /* any two opposite corners */
            const double x = mesh->position[3 * (size_t)v + c], from = pick->box[0][c],
                         to = pick->box[1][c];
            in = in && ((x >= from && x <= to) || (x <= from && x >= to));
        }
        if (in)
            code = pick_one(picking, v, error);
    }
    if (code || picking->list.n > before)
        return code;
    return model_fail(
        pick->place, error,
        "the box of %s of cloth '%.60s' holds no vertex that a face, edge or joint uses",
        picking->what, picking->cloth->name);
}

int flow_pick(const struct model_pick *pick, struct flow_picking *picking,
              struct cloth_error *error)
{
    switch (pick->kind) {
    case MODEL_PICK_VERTICES:
        return pick_vertices(pick, picking, error);
    case MODEL_PICK_NEAREST:
        return pick_nearest(pick, picking, error);
    case MODEL_PICK_BOX:
        break;
    }
    return pick_box(pick, picking, error);
}
