/* The scales of contacts, over all vertices of a model: the stiffness of its cloths, the mass of a
 * vertex. */
#include "cloth/flow/run/source.h"

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
