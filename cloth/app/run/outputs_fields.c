/* Files beside positions: colours and scientific frames; and the room that all frames take.
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

/* ---- Room on the disk ---- */

/* An estimate: halved steps add rows of probes, blocks that move to other ranks add to the colours,
 * and a run that comes to rest ends early. */

/* Its size on the disk for a run of this model alone, bytes, about. */
static double colours_bytes(const struct model *model, uint64_t n_vertices)
{
    struct element_strains rest = {.n_materials = model->n_materials};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        rest.n_triangles += model->cloths[c].mesh.n_triangles;
        rest.n_edges += model->cloths[c].mesh.n_bare_edges;
    }
    const uint64_t blocks = n_vertices / model->grain + 1;
    return (double)output_colours_bytes((uint32_t)n_vertices, (uint32_t)blocks, &rest);
}

/* Size of a model's scientific frames on the disk, bytes a frame of all; 0: it has none. */
static double hdf5_bytes(const struct model *model)
{
    const struct output_hdf5_setup setup = setup_of(model);
    return model->hdf5.every ? output_hdf5_bytes(&setup) / model->hdf5.every : 0;
}

/* The most that a run of several phases takes. */
struct extent {
    double frames, steps, seconds;
    double colours; /* bytes: colours, which each phase writes */
    bool may_rest;  /* and so take less */
};

static struct extent extent_of(uint32_t n, const struct model *phases, const struct flow *flow)
{
    struct extent all = {.frames = 1};
    for (uint32_t i = 0; i < n; i++) {
        all.steps += phases[i].end / phases[i].h;
        all.seconds += phases[i].end;
        all.colours += colours_bytes(phases + i, flow_vertices(flow));
        all.may_rest = all.may_rest || phases[i].rest.speed > 0;
    }
    all.frames += floor(phases->fps * all.seconds);
    return all;
}

/* Size of frames, their colours and rows of probes on the disk, bytes. */
static double output_bytes(const struct extent *all, const struct model *model,
                           const struct flow *flow)
{
    enum { NUMBER = 26, INDEX = 24 }; /* characters of a number with 17 digits; of a frame's line */
    const char *header = flow_header(flow);
    double columns = header ? 1 : 0;
    for (; header && *header; header++)
        columns += *header == ',';
    const double vectors = model_shows_contact(model) ? 2 : 1;
    return all->frames * (vectors * 3 * sizeof(float) * (double)flow_vertices(flow) + INDEX +
                          hdf5_bytes(model)) +
           all->steps * columns * NUMBER + all->colours;
}

int outputs_check_room(uint32_t n, const struct model *phases, const struct flow *flow,
                       const char *folder, struct cloth_error *error)
{
    const double MUCH = 10e9, OFTEN = 10;
    const struct model *model = phases; /* all have its frames a second, and its columns */
    const struct extent all = extent_of(n, phases, flow);
    const char *place = model->fps_place ? model->fps_place : "fps";
    const double bytes = output_bytes(&all, model, flow), room = output_room(folder);
    const double frames = all.frames, steps = all.steps;
    char what[200];
    snprintf(what, sizeof what, "time.fps = %g gives %.0f frames of %llu vertices up to %g s",
             model->fps, frames, (unsigned long long)flow_vertices(flow), all.seconds);
    if (bytes > room && !all.may_rest)
        return cloth_fail(
            error, CLOTH_E_INPUT,
            "%.300s: %s: frames and probes take %.3g GB, but %.200s has room for %.3g "
            "GB; give fewer frames, an earlier time.end, or another folder",
            place, what, 1e-9 * bytes, folder, 1e-9 * room);
    if (bytes > fmin(MUCH, room))
        fprintf(
            stderr,
            "duite-cloth: warning: %.300s: %s: frames and probes take up to %.3g GB in %.200s\n",
            place, what, 1e-9 * bytes, folder);
    if (frames > OFTEN * steps)
        fprintf(stderr,
                "duite-cloth: warning: %.300s: %s, but there are %.0f steps: each is shown %.0f "
                "times; time.fps = %g shows each once\n",
                place, what, steps, frames / steps, 1 / model->h);
    return CLOTH_OK;
}
