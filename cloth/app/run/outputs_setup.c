/* The setup borrows from the models, and owns what it combines from several phases. */
#include "cloth/app/run/outputs_setup.h"

#include "cloth/base/memory.h"

#include <stdlib.h>

/* Marks the bodies that change their shape in any phase; to be freed. NULL: no memory. */
static bool *find_posed(const struct phases *phases, struct cloth_error *error)
{
    const uint32_t n = phases->models->bodies.n;
    bool *posed = cloth_alloc(n, sizeof *posed, error);
    for (uint32_t p = 0; posed && p < phases->n; p++)
        for (uint32_t i = 0; i < n; i++)
            posed[i] |= contact_bodies_at(&phases->models[p].bodies, i + 1)->n_frames > 0;
    return posed;
}

static int outputs_setup_find_cloths(struct outputs_setup *made, const struct model *model,
                                     struct cloth_error *error)
{
    made->meshes = cloth_alloc(model->n_cloths, sizeof *made->meshes, error);
    made->names = cloth_alloc(model->n_cloths, sizeof *made->names, error);
    if (!made->meshes || !made->names)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < model->n_cloths; i++) {
        made->meshes[i] = &model->cloths[i].mesh;
        made->names[i] = model->cloths[i].name;
    }
    return CLOTH_OK;
}

/* Adds motions and seams of earlier phases. */
static int outputs_setup_add_phases(struct outputs_setup *made, const struct phases *phases,
                                    struct cloth_error *error)
{
    const int code = phases_motions(phases, &made->motions, error);
    made->setup.obstacles = made->motions.obstacles;
    made->setup.keys = made->motions.keys;
    if (code)
        return code;
    made->all.joined = NULL;
    const int joins = phases_joined(phases, made->all.n_vertices, &made->joined, error);
    made->all.joined = made->joined;
    return joins;
}

int outputs_setup_make(struct outputs_setup *made, const struct simulate_options *options,
                       const struct phases *phases, const struct contact_apart *apart,
                       struct cloth_error *error)
{
    const struct model *model = phases_model(phases);
    *made = (struct outputs_setup){.all = *apart};
    int code = outputs_setup_find_cloths(made, model, error);
    made->posed = code ? NULL : find_posed(phases, error);
    code = error->code;
    made->setup = (struct output_setup){.folder = options->output,
                                        .n_meshes = model->n_cloths,
                                        .meshes = made->meshes,
                                        .names = made->names,
                                        .fps = model->fps,
                                        .n_obstacles = model->n_obstacles,
                                        .obstacles = model->obstacles,
                                        .keys = model->keys,
                                        .bodies = &model->bodies,
                                        .posed = made->posed,
                                        .apart = &made->all,
                                        .n_inputs = model->n_files,
                                        .inputs = (const char *const *)model->files};
    return code || !phases->now ? code : outputs_setup_add_phases(made, phases, error);
}

void outputs_setup_free(struct outputs_setup *made)
{
    phases_motions_free(&made->motions);
    free(made->joined);
    free(made->meshes);
    free(made->names);
    free(made->posed);
}
