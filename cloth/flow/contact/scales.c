/* The scales of contacts, over all vertices of a model: the thickness that its edges allow, the
 * stiffness of its cloths, the mass of a vertex. Certified contact keeps triangles that share no
 * corner a thickness apart. No edge at rest may be shorter, or a cloth would touch its own
 * neighbours; edges whose ends count as one are exempt. */
#include "cloth/flow/run/source.h"

#include <math.h>

/* The sides of triangles that are too short, and the first of the shortest. */
struct shorts {
    uint32_t n, ends[2];
    double least; /* m */
};

/* first: number of the cloth's first vertex. */
static void scales_find_shorts(const struct model *model, const struct mesh *rest, uint32_t first,
                               struct shorts *shorts)
{
    const uint32_t *joined = model->contact.apart.joined;
    *shorts = (struct shorts){.least = INFINITY};
    for (size_t i = 0; i < 3 * (size_t)rest->n_triangles; i++) {
        const uint32_t t = (uint32_t)(i / 3), triangle[2] = {t, UINT32_MAX};
        uint32_t corner[3];
        mesh_corners(rest, t, corner);
        const uint32_t a = corner[i % 3], b = corner[(i + 1) % 3];
        const double length = mesh_length(rest, triangle, a, b);
        if (!(length < model->contact.thickness) ||
            (joined && joined[first + a] == joined[first + b]))
            continue;
        shorts->n++;
        if (!(length < shorts->least))
            continue;
        shorts->least = length;
        shorts->ends[0] = a;
        shorts->ends[1] = b;
    }
}

int flow_thickness_check(const struct model *model, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        const struct mesh *rest = model_rest(cloth);
        struct shorts shorts;
        scales_find_shorts(model, rest, model_first(model, c), &shorts);
        if (shorts.n)
            code = model_fail(cloth->place, error,
                              "cloth '%.60s': the edge between vertices %u and %u (counted from 0) "
                              "is %g m long at rest, shorter than contact.thickness, %g m, as %u "
                              "of %u sides of triangles are; a smaller one is expected%s",
                              cloth->name ? cloth->name : "", shorts.ends[0], shorts.ends[1],
                              shorts.least, model->contact.thickness, shorts.n,
                              3 * rest->n_triangles, model_contact_cure(model));
    }
    return code;
}

/* Contacts are softer than the cloths by this factor: their multipliers carry the load, so the
 * matrix keeps its condition (docs/physics.md). */
static const double SOFTER = 0.03;

double flow_source_stiffness(const struct flow_source *source)
{
    const struct model *model = source->model;
    double sum = 0, n = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        sum += cloth->mesh.n_vertices * model->materials[cloth->material].stretch;
        n += cloth->mesh.n_vertices;
    }
    return n > 0 ? SOFTER * sum / n : 0;
}

double flow_source_mass(const struct flow_source *source)
{
    double sum = 0, n = 0;
    for (uint32_t v = 0; v < source->particles.n; v++) {
        sum += source->particles.mass[v];
        n += source->particles.mass[v] > 0;
    }
    return n > 0 ? sum / n : 0;
}
