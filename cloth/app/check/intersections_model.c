/* The model's cloths, welds and obstacles, as the check wants them. */
#include "cloth/app/check/intersections.h"
#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/model/model.h"

#include <stdlib.h>

int intersections_same(const struct model *model, uint32_t **same, struct cloth_error *error)
{
    const uint32_t n = model_first(model, model->n_cloths);
    *same = cloth_alloc(n, sizeof **same, error);
    if (!*same)
        return CLOTH_E_MEMORY;
    cloth_sets_start(*same, n);
    for (uint32_t w = 0; w < model->n_welds; w++) {
        const struct model_end *end = model->welds[w].pairs.end;
        for (uint32_t i = 0; i < end[0].n; i++) {
            const uint32_t a = model_first(model, end[0].cloth) + end[0].vertices[i];
            const uint32_t b = model_first(model, end[1].cloth) + end[1].vertices[i];
            cloth_sets_join(*same, a, b);
        }
    }
    for (uint32_t v = 0; v < n; v++)
        (*same)[v] = cloth_sets_root(*same, v);
    return CLOTH_OK;
}

int intersections_of(struct intersections **intersections, const struct model *model,
                     const struct contact_apart *apart, const char *program, bool self_off,
                     struct cloth_error *error)
{
    uint32_t *same = NULL;
    const struct mesh **meshes = cloth_alloc(model->n_cloths, sizeof *meshes, error);
    const char **names = cloth_alloc(model->n_cloths, sizeof *names, error);
    int code = meshes && names ? intersections_same(model, &same, error) : CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < model->n_cloths && !code; i++) {
        meshes[i] = &model->cloths[i].mesh;
        names[i] = model->cloths[i].name;
    }
    const struct intersections_setup setup = {.program = program,
                                              .n_meshes = model->n_cloths,
                                              .meshes = meshes,
                                              .names = names,
                                              .same = same,
                                              .n_obstacles = model->n_obstacles,
                                              .obstacles = model->obstacles,
                                              .keys = model->keys,
                                              .bodies = &model->bodies,
                                              .apart = apart,
                                              .self_off = self_off};
    code = code ? code : intersections_open(intersections, &setup, error);
    free(meshes);
    free(names);
    free(same);
    return code;
}
