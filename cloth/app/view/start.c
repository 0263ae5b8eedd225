/* The frame is written as a run writes it, into a folder of its own, so that all that reads folders
 * shows it alike. The folder goes when its files are open. */
#include "cloth/app/view/start.h"

#include "cloth/app/run/options.h"
#include "cloth/app/run/outputs_setup.h"
#include "cloth/app/view/marks.h"
#include "cloth/base/memory.h"

#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct start {
    struct model model;
    struct flow *flow;
    struct view_marks marks;
    double *position; /* of all cloths, then of the marks */
    char folder[300];
};

bool view_start_is_scene(const char *argument, char **path)
{
    struct stat status;
    *path = NULL;
    if (stat(argument, &status) != 0)
        return (*path = shipped_scene(argument));
    return S_ISREG(status.st_mode);
}

static int start_read(struct start *start, const char *path, struct cloth_error *error)
{
    const struct model *model = &start->model;
    const char *warning;
    int code = scene_read(&start->model, path, 0, NULL, error);
    code = code ? code : flow_prepare(&start->flow, model, 1, error);
    for (uint32_t i = 0; !code && i < model->n_warnings; i++)
        fprintf(stderr, "duite-view: warning: %s\n", model->warnings[i]);
    for (size_t i = 0; !code && (warning = flow_warning(start->flow, i)); i++)
        fprintf(stderr, "duite-view: warning: %s\n", warning);
    return code;
}

/* Finds where all is, and the marks. */
static int start_place(struct start *start, struct cloth_error *error)
{
    const uint32_t n = (uint32_t)flow_vertices(start->flow);
    double(*at)[6] = cloth_alloc(n, sizeof *at, error);
    unsigned char *held = cloth_alloc(n, sizeof *held, error);
    int code = at && held ? CLOTH_OK : CLOTH_E_MEMORY;
    if (!code) {
        flow_starts(start->flow, at, held);
        code = view_marks_make(&start->marks, &start->model, (const double(*)[6])at, held, error);
    }
    const uint32_t all = n + view_marks_vertices(&start->marks);
    start->position = code ? NULL : cloth_alloc(all, 3 * sizeof *start->position, error);
    if (start->position) {
        flow_start(start->flow, start->position);
        view_marks_place(&start->marks, start->position + 3 * (size_t)n);
    }
    free(at);
    free(held);
    return error->code;
}

/* Marks of which there are none are no cloths. */
static int start_write(const struct start *start, const struct outputs_setup *made,
                       struct cloth_error *error)
{
    struct output_setup setup = made->setup;
    const size_t most = setup.n_meshes + VIEW_MARKS;
    const struct mesh **mesh = cloth_alloc(most, sizeof *mesh, error);
    const char **name = cloth_alloc(most, sizeof *name, error);
    uint32_t *end = cloth_alloc(most, sizeof *end, error);
    struct contact_apart apart = {.end = end}; /* the rest of it is of contact */
    struct output_frames *frames = NULL;
    int code = mesh && name && end ? CLOTH_OK : CLOTH_E_MEMORY;
    for (size_t i = 0; i < most && !code; i++) {
        const bool mark = i >= setup.n_meshes;
        const struct mesh *of = mark ? start->marks.mesh + (i - setup.n_meshes) : setup.meshes[i];
        const uint32_t k = apart.n_cloths;
        if (mark && !of->n_vertices)
            continue;
        mesh[k] = of;
        name[k] = mark ? view_marks_names[i - setup.n_meshes] : setup.names[i];
        end[k] = (k ? end[k - 1] : 0) + of->n_vertices;
        apart.n_cloths++;
    }
    setup.folder = start->folder;
    setup.n_meshes = apart.n_cloths;
    setup.meshes = mesh;
    setup.names = name;
    setup.apart = &apart;
    code = code ? code : output_open(&frames, &setup, error);
    code = code ? code : output_frame(frames, 0, 0, start->position, error);
    const int closed = output_close(&frames, error);
    free(mesh);
    free(name);
    free(end);
    return code ? code : closed;
}

static int start_remove(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status, (void)kind, (void)place;
    return remove(path);
}

static int start_show(struct start *start, struct output_cache *cache, struct cloth_error *error)
{
    enum { FILES = 8 }; /* that may be open at a time */
    const char *temporary = getenv("TMPDIR");
    const struct simulate_options options = {.output = start->folder};
    const struct phases phases = {.n = 1, .models = &start->model};
    struct outputs_setup made;
    snprintf(start->folder, sizeof start->folder, "%.250s/duite-view-XXXXXX",
             temporary ? temporary : "/tmp");
    if (!mkdtemp(start->folder))
        return cloth_fail(error, CLOTH_E_IO, "cannot make a folder %s: %s", start->folder,
                          strerror(errno));
    int code = outputs_setup_make(&made, &options, &phases, &start->model.contact.apart, error);
    code = code ? code : start_write(start, &made, error);
    outputs_setup_free(&made);
    code = code ? code : output_cache_open(cache, start->folder, error);
    nftw(start->folder, start_remove, FILES, FTW_DEPTH | FTW_PHYS);
    return code;
}

int view_start_open(struct output_cache *cache, const char *path, struct cloth_error *error)
{
    struct start start = {.position = NULL};
    int code = start_read(&start, path, error);
    code = code ? code : start_place(&start, error);
    code = code ? code : start_show(&start, cache, error);
    view_marks_free(&start.marks);
    free(start.position);
    flow_free(start.flow);
    model_free(&start.model);
    return code;
}
