/* Springs keep the order of their mesh, cloth after cloth. */
#include "cloth/flow/tables/source.h"

#include "cloth/base/memory.h"

#include <stdlib.h>

int flow_springs_make(struct flow_springs *springs, const struct model *model,
                      struct cloth_error *error)
{
    *springs = (struct flow_springs){.model = model};
    springs->lattice = cloth_alloc(model->n_cloths, sizeof *springs->lattice, error);
    int code = springs->lattice ? CLOTH_OK : CLOTH_E_MEMORY;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        const struct model_material *m = model->materials + cloth->material;
        const struct mesh_moduli moduli = {m->stretch, m->shear, m->bend, m->both_diagonals};
        struct cloth_error inner = {0};
        code = mesh_lattice_build(springs->lattice + c, &cloth->mesh, &moduli, &inner);
        if (code == CLOTH_E_INPUT)
            model_fail(cloth->mesh_place, error, "cloth '%.60s': %s", cloth->name, inner.text);
        else if (code)
            cloth_fail(error, code, "%s", inner.text);
    }
    if (code)
        flow_springs_free(springs);
    return code;
}

struct visitor {
    void (*visit)(void *to, const struct flow_spring *spring);
    void *to;
    uint32_t first;
    double damping;
};

static void pass_on(void *context, const struct mesh_spring *s)
{
    const struct visitor *visitor = context;
    const struct flow_spring spring = {.a = visitor->first + s->a,
                                       .b = visitor->first + s->b,
                                       .stiffness = s->stiffness,
                                       .damping = visitor->damping * s->stiffness,
                                       .length = s->length,
                                       .stretch = s->kind == MESH_STRETCH};
    visitor->visit(visitor->to, &spring);
}

void flow_springs_each(const struct flow_springs *springs,
                       void (*visit)(void *to, const struct flow_spring *spring), void *to)
{
    const struct model *model = springs->model;
    struct visitor visitor = {.visit = visit, .to = to};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        visitor.damping = model->materials[cloth->material].damping_stiffness;
        mesh_lattice_each(springs->lattice + c, pass_on, &visitor);
        visitor.first += cloth->mesh.n_vertices;
    }
}

void flow_springs_free(struct flow_springs *springs)
{
    for (uint32_t c = 0; springs->lattice && c < springs->model->n_cloths; c++)
        mesh_lattice_free(springs->lattice + c);
    free(springs->lattice);
    *springs = (struct flow_springs){0};
}
