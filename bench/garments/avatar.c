/* A figure of another program: its mesh, its clip by its skin, and what closest points need. */
#include "bench/garments/garments.h"

#include "bench/temporary.h"
#include "cloth/contact/body.h"
#include "tests/support/skinned.h"

#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 100 };

static int read_avatar(const char *path, uint32_t n_triangles)
{
    struct cloth_error error = {0};
    struct mesh mesh = {0};
    struct contact_bodies bodies = {0};
    struct contact_frames frames = {.rate = FRAMES - 1};
    double *place = NULL;
    bool turned;
    int code = mesh_read_surface(&mesh, path, &error);
    code = code ? code
                : mesh_read_clip(path, mesh.n_vertices, "bend", frames.rate, &frames.n, &place,
                                 &error);
    frames.place = (const double(*)[3])(void *)place;
    code = code ? code : contact_bodies_add_frames(&bodies, &mesh, &frames, &turned, &error);
    if (code)
        code = serve_fail("%s", error.text);
    else if (frames.n != FRAMES || mesh.n_triangles != n_triangles)
        code = serve_fail("%u frames of %u triangles", frames.n, mesh.n_triangles);
    mesh_free(&mesh);
    free(place);
    free(bodies.memory);
    return code;
}

static int run_avatar(void *context, struct serve_request *request, double *value)
{
    const bool quick = serve_number(request, "quick") != 0;
    const struct skinned of = {
        .around = quick ? 10 : 100, .along = quick ? 15 : 150, .keys = FRAMES};
    char folder[TEMPORARY_PATH], path[TEMPORARY_PATH + 16];
    (void)context;
    int code = temporary_make(NULL, "duite-avatar", folder);
    if (code)
        return code;
    snprintf(path, sizeof path, "%s/avatar.glb", folder);
    code = skinned_write(&of, path) ? serve_fail("%s cannot be written", path) : 0;
    const double begin = serve_seconds();
    code = code ? code : read_avatar(path, skinned_triangles(&of));
    *value = serve_seconds() - begin;
    temporary_remove(folder);
    return code;
}

const struct serve_run garments_avatar_runs[] = {{"avatar", run_avatar}, {0}};

static void plan(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape ours = {"duite_assimp", 0, options->threads};
    measure_value(measure, measure_series(measure, ours, "avatar quick=%d", options->quick), 1, "s",
                  "avatar_seconds");
}

const struct bench_case garments_avatar = {
    "avatar", "a skinned figure in glTF, of 30,200 triangles, read with 100 frames of its clip",
    plan, garments_avatar_runs, 0};
