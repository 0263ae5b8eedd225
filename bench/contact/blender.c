/* Blender on the sheet that falls onto a ball: its quality is raised until no triangles intersect
 * in any frame, which is found once; then that run is timed. bench/rivals/blender_sphere.py is what
 * Blender runs. */
#include "bench/contact/contact.h"

#include "cloth/app/check/intersections.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { FRAMES = 15, QUICK_FRAMES = 2, LEAST_QUALITY = 10, MOST_QUALITY = 40 };

static int run_blender(const struct model *model, unsigned threads, int frames, int quality,
                       const char *path, double *seconds)
{
    char command[8000], line[1000];
    snprintf(command, sizeof command,
             "blender --background -t %u --python-exit-code 3 --python '%s' -- %u %d %d '%s' 2>&1",
             threads, BENCH_BLENDER, model->cloths->mesh.grid_nx, frames, quality, path);
    FILE *said = popen(command, "r");
    *seconds = -1;
    while (said && fgets(line, sizeof line, said))
        sscanf(line, "seconds %lf", seconds);
    return !said || pclose(said) || *seconds < 0 ? serve_fail("Blender does not run the scene") : 0;
}

/* The most intersections in a frame of the file. */
static int look(const struct model *model, int frames, const char *path, double *most)
{
    const size_t n = 3 * (size_t)model->cloths->mesh.n_vertices;
    struct cloth_error error = {0};
    struct intersections *all = NULL;
    struct intersections_found found = {0};
    double *position = calloc(n + 1, sizeof *position);
    FILE *file = fopen(path, "rb");
    const struct intersections_setup of = {.apart = &model->contact.apart, .found = &found};
    int code = position ? intersections_of(&all, model, of, &error) : CLOTH_E_MEMORY;
    for (int i = 0; i < frames && !code; i++) {
        if (!file || fread(position, sizeof *position, n, file) != n)
            code = cloth_fail(&error, CLOTH_E_IO, "Blender's frames cannot be read");
        else
            code =
                intersections_frame(all, (uint64_t)i, (i + 1) / model->fps, position, true, &error);
    }
    if (!code)
        *most = (double)(found.pairs + found.with_shapes);
    intersections_close(&all);
    if (file)
        fclose(file);
    free(position);
    return code ? serve_fail("%s", error.text) : 0;
}

/* Raises the quality while there are intersections; with the most there is the run counts anyway:
 * it is no faster than one without. */
static int tune(const struct model *model, unsigned threads, int frames, const char *path,
                double *seconds)
{
    static int quality = LEAST_QUALITY;
    double most = 1;
    int code = 0;
    while (!code) {
        code = run_blender(model, threads, frames, quality, path, seconds);
        if (!code)
            code = look(model, frames, path, &most);
        if (code || !(most > 0) || 2 * quality > MOST_QUALITY)
            break;
        quality *= 2;
    }
    return code;
}

/* Seconds a frame. */
static int sphere(void *context, struct serve_request *request, double *value)
{
    struct model model = {0};
    char path[] = "/tmp/duite-blender.XXXXXX";
    const bool quick = serve_number(request, "quick") != 0;
    const unsigned threads = (unsigned)serve_number(request, "threads");
    const int frames = quick ? QUICK_FRAMES : FRAMES, file = mkstemp(path);
    (void)context;
    int code =
        file < 0 ? serve_fail("no file %s", path) : contact_scene_read(&model, "sphere", "", quick);
    if (!code)
        code = tune(&model, threads, frames, path, value);
    *value /= frames;
    if (file >= 0) {
        close(file);
        unlink(path);
    }
    model_free(&model);
    return code;
}

const struct serve_run contact_blender_runs[] = {{"blender", sphere}, {0}};
