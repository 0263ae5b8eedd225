/* Springs keep the order of their mesh, cloth after cloth. */
#include "cloth/flow/tables/tables.h"

#include "cloth/mesh/lattice.h"

#include <stdlib.h>

static int append(struct flow_springs *springs, const struct mesh_lattice *lattice, uint32_t first,
                  double damping, struct cloth_error *error)
{
    const size_t n = springs->n + lattice->n;
    struct flow_spring *grown = realloc(springs->spring, (n + 1) * sizeof *grown);
    if (!grown)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for %zu springs", n);
    springs->spring = grown;
    for (uint32_t i = 0; i < lattice->n; i++) {
        const struct mesh_spring *s = lattice->spring + i;
        grown[springs->n++] = (struct flow_spring){.a = first + s->a,
                                                   .b = first + s->b,
                                                   .stiffness = s->stiffness,
                                                   .damping = damping * s->stiffness,
                                                   .length = s->length,
                                                   .stretch = s->kind == MESH_STRETCH};
    }
    return CLOTH_OK;
}

int flow_springs_make(struct flow_springs *springs, const struct model *model,
                      struct cloth_error *error)
{
    *springs = (struct flow_springs){0};
    uint32_t first = 0;
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        const struct model_material *m = model->materials + cloth->material;
        const struct mesh_moduli moduli = {m->stretch, m->shear, m->bend, m->both_diagonals};
        struct mesh_lattice lattice = {0};
        struct cloth_error inner = {0};
        code = mesh_lattice_build(&lattice, &cloth->mesh, &moduli, &inner);
        if (code == CLOTH_E_INPUT)
            model_fail(cloth->mesh_place, error, "cloth '%.60s': %s", cloth->name, inner.text);
        else if (code)
            cloth_fail(error, code, "%s", inner.text);
        else
            code = append(springs, &lattice, first, m->damping_stiffness, error);
        mesh_lattice_free(&lattice);
        first += cloth->mesh.n_vertices;
    }
    if (code)
        flow_springs_free(springs);
    return code;
}

void flow_springs_free(struct flow_springs *springs)
{
    free(springs->spring);
    *springs = (struct flow_springs){0};
}
