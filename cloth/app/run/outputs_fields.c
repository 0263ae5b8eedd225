/* Files beside positions: colours and scientific frames.
 *
 * The folder has the shapes and moduli that give the strain of any frame, not the strain: they are
 * written once, and a run need not know what its pictures will show. In scientific frames strain
 * and stress follow from positions, too: the settler finds them, and no rank but this one
 * needs to. */
#include "cloth/app/run/outputs_fields.h"

#include "cloth/base/memory.h"
#include "cloth/output/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void outputs_warn(const char *text)
{
    fprintf(stderr, "duite-cloth: warning: %s\n", text);
}

/* ---- Colours ---- */

/* Goes on without the file that was not written. */
static int outputs_colours_go_on(struct output_colours **colours, int code,
                                 struct cloth_error *error)
{
    struct cloth_error ignored = {0};
    if (code != CLOTH_E_IO)
        return code;
    fprintf(stderr,
            "duite-cloth: warning: %s; the run goes on, and pictures of later frames are coloured "
            "by what was written before\n",
            error->text);
    output_colours_close(colours, &ignored);
    *error = (struct cloth_error){0};
    return CLOTH_OK;
}

int outputs_colours_rest(struct output_colours **colours, const struct model *model, uint64_t frame,
                         struct cloth_error *error)
{
    struct element_strains rest;
    if (!*colours)
        return CLOTH_OK;
    int code = element_strains_make(&rest, model, error);
    if (!code)
        code = outputs_colours_go_on(colours, output_colours_rest(*colours, frame, &rest, error),
                                     error);
    element_strains_free(&rest);
    return code;
}

int outputs_colours_places(struct output_colours **colours, uint64_t frame,
                           const struct flow_places *places, struct cloth_error *error)
{
    return *colours
               ? outputs_colours_go_on(colours,
                                       output_colours_places(*colours, frame, places->block,
                                                             places->n_blocks, places->rank, error),
                                       error)
               : CLOTH_OK;
}

/* ---- Scientific frames ---- */

enum { POSITION = 1, BESIDE = 2, FORCE = 4 };

/* Stress without strain needs room for the strains, too: the setup always wants them together. */
static void derive(void *context, struct output_state *state)
{
    const struct outputs_hdf5 *of = context;
    element_strains_find(&of->strains, state->position, state->field[OUTPUT_STRAIN],
                         (double(*)[3])state->field[OUTPUT_STRESS]);
}

static struct output_hdf5_setup setup_of(const struct model *model)
{
    const struct model_hdf5 *hdf5 = &model->hdf5;
    struct output_hdf5_setup setup = {.is_double = hdf5->is_double,
                                      .every = hdf5->every,
                                      .level = hdf5->level,
                                      .derive = derive,
                                      .warn = outputs_warn};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        setup.n_points += model->cloths[c].mesh.n_vertices;
        setup.n_triangles += model->cloths[c].mesh.n_triangles;
        setup.n_edges += model->cloths[c].mesh.n_bare_edges;
    }
    setup.wants[OUTPUT_VELOCITY] = hdf5->velocity;
    setup.wants[OUTPUT_BLOCK] = hdf5->block;
    setup.wants[OUTPUT_RANK] = hdf5->rank;
    setup.wants[OUTPUT_FORCE] = hdf5->contact_force;
    setup.wants[OUTPUT_STRAIN] = hdf5->strain || hdf5->stress;
    setup.wants[OUTPUT_STRESS] = hdf5->stress;
    return setup;
}

/* The corners of triangles without their material; to be freed. */
static uint32_t (*corners_of(const struct element_strains *strains, struct cloth_error *error))[3]
{
    uint32_t(*corner)[3] = cloth_alloc(strains->n_triangles, sizeof *corner, error);
    for (uint32_t t = 0; corner && t < strains->n_triangles; t++)
        memcpy(corner[t], strains->corner[t], sizeof *corner);
    return corner;
}

int outputs_hdf5_open(struct outputs_hdf5 *to, const struct model *model, const char *folder,
                      const uint64_t *n_frames, struct output_settler *settler,
                      struct cloth_error *error)
{
    if (!model->hdf5.every)
        return output_hdf5_forget(folder, n_frames, error);
    const char *lacks = output_hdf5_lacks(model->hdf5.level);
    if (lacks)
        return model_fail(model->hdf5_place, error, "output.hdf5: %s", lacks);
    if (element_strains_make(&to->strains, model, error))
        return error->code;
    struct output_hdf5_setup setup = setup_of(model);
    uint32_t(*triangle)[3] = corners_of(&to->strains, error);
    if (!triangle)
        return error->code;
    setup.folder = folder;
    setup.n_frames = n_frames;
    setup.settler = settler;
    setup.triangle = (const uint32_t(*)[3])triangle;
    setup.edge = (const uint32_t(*)[2])to->strains.edge;
    setup.context = to;
    to->parts = POSITION | (model->hdf5.contact_force ? FORCE : 0) |
                (model->hdf5.velocity || model->hdf5.block || model->hdf5.rank ? BESIDE : 0);
    const int code = output_hdf5_open(&to->frames, &setup, error);
    free(triangle);
    return code;
}

int outputs_hdf5_go_on(struct outputs_hdf5 *to, const struct model *model,
                       struct cloth_error *error)
{
    if (!to->frames)
        return CLOTH_OK;
    output_hdf5_wait(to->frames);
    element_strains_free(&to->strains);
    return element_strains_make(&to->strains, model, error);
}

void outputs_hdf5_close(struct outputs_hdf5 *of)
{
    output_hdf5_close(&of->frames, &of->unwritten);
    element_strains_free(&of->strains);
}

static void outputs_hdf5_take(struct outputs_hdf5 *of, unsigned part)
{
    of->have |= part;
    if (of->have != of->parts)
        return;
    output_hdf5_end(of->frames);
    of->state = NULL;
}

void outputs_hdf5_position(struct outputs_hdf5 *of, uint64_t frame, double time,
                           const double *position)
{
    if (!of->frames || !output_hdf5_takes(of->frames, frame))
        return;
    of->state = output_hdf5_begin(of->frames, frame, time);
    of->have = 0;
    memcpy(of->state->position, position, 3 * of->strains.n_vertices * sizeof *position);
    outputs_hdf5_take(of, POSITION);
}

void outputs_hdf5_beside(struct outputs_hdf5 *of, const struct flow_beside *beside)
{
    const size_t n = of->strains.n_vertices;
    if (!of->state)
        return;
    double *velocity = of->state->field[OUTPUT_VELOCITY];
    int32_t *block = of->state->number[OUTPUT_BLOCK], *rank = of->state->number[OUTPUT_RANK];
    if (velocity)
        memcpy(velocity, beside->velocity, 3 * n * sizeof *velocity);
    if (block)
        memcpy(block, beside->block, n * sizeof *block);
    if (rank)
        memcpy(rank, beside->rank, n * sizeof *rank);
    outputs_hdf5_take(of, BESIDE);
}

void outputs_hdf5_force(struct outputs_hdf5 *of, const double *force)
{
    if (!of->state || !of->state->field[OUTPUT_FORCE])
        return;
    memcpy(of->state->field[OUTPUT_FORCE], force, 3 * of->strains.n_vertices * sizeof *force);
    outputs_hdf5_take(of, FORCE);
}

double outputs_hdf5_bytes(const struct model *model)
{
    const struct output_hdf5_setup setup = setup_of(model);
    return model->hdf5.every ? output_hdf5_bytes(&setup) / model->hdf5.every : 0;
}
