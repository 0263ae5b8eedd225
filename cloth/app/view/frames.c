/* A context of OpenGL is open while something is drawn off screen; a window has its own. */
#include "config.h"

#include "cloth/app/view/frames.h"

#include "cloth/base/memory.h"
#include "cloth/contact/soup.h"
#include "cloth/view/export.h"
#include "cloth/view/film.h"
#include "cloth/view/window.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The number of a frame that is asked for. */
static int find_frame(const struct output_cache *cache, const char *folder, uint64_t wanted,
                      uint64_t *frame, struct cloth_error *error)
{
    const uint64_t n = cache->n_frames;
    if (n == 0)
        return cloth_fail(error, CLOTH_E_INPUT, "%s has no finished frame", folder);
    if (wanted != VIEW_LAST_FRAME && wanted >= n)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s has %" PRIu64 " frames, 0 to %" PRIu64 ": no frame %" PRIu64, folder,
                          n, n - 1, wanted);
    *frame = wanted == VIEW_LAST_FRAME ? n - 1 : wanted;
    return CLOTH_OK;
}

int view_frames_open(struct view_show **show, struct output_cache *cache,
                     const struct view_wish *wish, struct cloth_error *error)
{
    uint64_t any;
    const int code = find_frame(cache, wish->folder, VIEW_LAST_FRAME, &any, error);
    return code ? code : view_show_open(show, cache, wish, error);
}

int view_frames_draw(struct view_show *show, const char *png, struct cloth_error *error)
{
    struct view_picture picture = {show->wish->width, show->wish->height, NULL};
    struct view_context *context = NULL;
    int code = view_context_open(&context, error);
    code = code ? code : view_show_picture(show, &picture, error);
    code = code ? code : view_picture_write(&picture, png, error);
    view_picture_free(&picture);
    view_show_undraw(show);
    view_context_close(context);
    return code;
}

int view_frames_picture(struct view_show *show, uint64_t frame, const char *png,
                        struct cloth_error *error)
{
    int code = find_frame(show->cache, show->wish->folder, frame, &frame, error);
    code = code ? code : view_show_frame(show, frame, error);
    code = code ? code : view_frames_draw(show, png, error);
    if (!code)
        view_colours_say(&show->colours);
    return code;
}

int view_frames_window(struct view_show *show, uint64_t frame, struct cloth_error *error)
{
#ifdef HAVE_WINDOW
    const int code = find_frame(show->cache, show->wish->folder, frame, &frame, error);
    return code ? code : view_window(show, frame, error);
#else
    (void)show, (void)frame;
    return cloth_fail(error, CLOTH_E_LIBRARY, "this build opens no windows");
#endif
}

/* ---- Films ---- */

static int film_frame(struct view_show *show, struct view_film *film, uint64_t frame,
                      struct cloth_error *error)
{
    struct view_picture picture = {show->wish->width, show->wish->height, NULL};
    int code = view_show_frame(show, frame, error);
    code = code ? code : view_show_picture(show, &picture, error);
    code = code ? code : view_film_add(film, &picture, error);
    view_picture_free(&picture);
    return code;
}

static int film_frames(struct view_show *show, struct view_film *film,
                       const struct view_frames *frames, struct cloth_error *error)
{
    const bool seen = isatty(STDERR_FILENO);
    const uint64_t n = frames->last - frames->first + 1;
    int code = 0;
    for (uint64_t i = 0; i < n && !code; i++) {
        if (seen)
            fprintf(stderr, "\r%s: %" PRIu64 " of %" PRIu64 " frames ", frames->path, i, n);
        code = film_frame(show, film, frames->first + i, error);
    }
    if (seen)
        fprintf(stderr, "\r\033[K");
    return code;
}

int view_frames_film(struct view_show *show, const struct view_frames *wanted,
                     struct cloth_error *error)
{
    const struct view_wish *wish = show->wish;
    struct view_frames frames = *wanted;
    struct view_context *context = NULL;
    struct view_film *film = NULL;
    int code = find_frame(show->cache, wish->folder, wanted->last, &frames.last, error);
    code = code ? code : find_frame(show->cache, wish->folder, wanted->first, &frames.first, error);
    code = code ? code : view_context_open(&context, error);
    code = code ? code
                : view_film_open(&film, frames.path, wish->width, wish->height, frames.fps, error);
    code = code ? code : film_frames(show, film, &frames, error);
    const int closed = view_film_close(&film, !code, error);
    view_show_undraw(show);
    view_context_close(context);
    return code ? code : closed;
}

/* ---- Files for other programs ---- */

static bool ends_with(const char *path, const char *ending)
{
    const size_t length = strlen(path), n = strlen(ending);
    return length > n && strcmp(path + length - n, ending) == 0;
}

bool view_frames_exports_many(const char *path)
{
    return ends_with(path, ".usda") || ends_with(path, ".usd") || ends_with(path, ".abc");
}

bool view_frames_can_export(const char *path)
{
    return view_frames_exports_many(path) || ends_with(path, ".glb") || ends_with(path, ".obj");
}

static int export_obj(struct output_cache *cache, uint64_t frame, const char *path,
                      struct cloth_error *error)
{
    struct mesh mesh = cache->mesh;
    mesh.position = cloth_alloc(mesh.n_vertices, 3 * sizeof *mesh.position, error);
    int code =
        mesh.position ? output_cache_frame(cache, frame, mesh.position, error) : CLOTH_E_MEMORY;
    code = code ? code : output_mesh_obj(path, &mesh, "cloth", error);
    free(mesh.position);
    return code;
}

int view_frames_export(struct output_cache *cache, const char *folder,
                       const struct view_frames *frames, uint64_t frame, struct cloth_error *error)
{
    uint64_t first, last;
    if (!view_frames_exports_many(frames->path)) {
        const int code = find_frame(cache, folder, frame, &frame, error);
        if (code)
            return code;
        return ends_with(frames->path, ".obj")
                   ? export_obj(cache, frame, frames->path, error)
                   : view_export_gltf(cache, frame, frames->path, error);
    }
    int code = find_frame(cache, folder, frames->last, &last, error);
    code = code ? code : find_frame(cache, folder, frames->first, &first, error);
    if (code)
        return code;
    return ends_with(frames->path, ".abc")
               ? view_export_abc(cache, first, last, frames->path, error)
               : view_export_usd(cache, first, last, frames->path, error);
}

/* ---- The check ---- */

/* A folder does not name its welds. But welded vertices have the same floats in each frame, and no
 * others are likely to: they count as one. */

static int compare_places(const double *x, const double *y)
{
    for (int c = 0; c < 3; c++)
        if (x[c] < y[c] || x[c] > y[c])
            return x[c] < y[c] ? -1 : 1;
    return 0;
}

static int by_place(const void *left, const void *right, void *position)
{
    const uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    const double *x = position;
    const int places = compare_places(x + 3 * (size_t)a, x + 3 * (size_t)b);
    return places ? places : (a > b) - (a < b);
}

static bool is_at(const double *x, uint32_t a, uint32_t b)
{
    return compare_places(x + 3 * (size_t)a, x + 3 * (size_t)b) == 0;
}

/* Finds the lowest vertex at the place of each vertex. */
static void join_places(uint32_t n, double *position, uint32_t *order, uint32_t *same)
{
    for (uint32_t v = 0; v < n; v++)
        order[v] = v;
    qsort_r(order, n, sizeof *order, by_place, position);
    for (uint32_t i = 0; i < n; i++)
        same[order[i]] =
            i && is_at(position, order[i], order[i - 1]) ? same[order[i - 1]] : order[i];
}

struct folder {
    struct output_cache *cache;
    double *position; /* of a frame */
    uint32_t *order, *same;
};

static int find_same(const struct folder *folder, struct cloth_error *error)
{
    const uint32_t n = folder->cache->mesh.n_vertices;
    int code = CLOTH_OK;
    for (uint64_t k = 0; k < folder->cache->n_frames && !code; k++) {
        code = output_cache_frame(folder->cache, k, folder->position, error);
        if (!code && k == 0)
            join_places(n, folder->position, folder->order, folder->same);
        for (uint32_t v = 0; v < n && !code; v++)
            if (!is_at(folder->position, v, folder->same[v]))
                folder->same[v] = v;
    }
    return code;
}

static int check_each(const struct folder *folder, const struct view_frames *frames,
                      struct intersections *intersections, struct cloth_error *error)
{
    struct output_cache *cache = folder->cache;
    int code = CLOTH_OK;
    for (uint64_t k = frames->first; k <= frames->last && !code; k++) {
        code = output_cache_frame(cache, k, folder->position, error);
        code = code ? code : output_cache_pose(cache, k, error);
        code = code ? code
                    : intersections_frame(intersections, k, cache->time[k], folder->position, true,
                                          error);
    }
    return code;
}

static int check_frames_folder(struct folder *folder, const struct view_frames *frames,
                               struct intersections_found *found, struct cloth_error *error)
{
    const struct output_cache *cache = folder->cache;
    const struct mesh *mesh = &cache->mesh;
    struct contact_soup soup = {0};
    const struct intersections_setup setup = {.program = "duite-view",
                                              .obstacles = cache->obstacles,
                                              .keys = cache->keys,
                                              .bodies = &cache->bodies,
                                              .apart = &cache->apart,
                                              .found = found};
    struct intersections *intersections = NULL;
    int code = find_same(folder, error);
    if (!code) {
        code = contact_soup_make(&soup, 1, &mesh, folder->same, (uint32_t)cache->n_obstacles,
                                 cache->obstacles, &cache->bodies, error);
        folder->same = NULL;
    }
    code = code ? code : intersections_open(&intersections, &setup, &soup, error);
    contact_soup_free(&soup);
    code = code ? code : check_each(folder, frames, intersections, error);
    intersections_close(&intersections);
    return code;
}

int view_frames_check(struct output_cache *cache, const char *path,
                      const struct view_frames *wanted, struct intersections_found *found,
                      struct cloth_error *error)
{
    struct view_frames frames = *wanted;
    if (find_frame(cache, path, wanted->last, &frames.last, error) ||
        find_frame(cache, path, wanted->first, &frames.first, error))
        return error->code;
    const size_t n = cache->mesh.n_vertices;
    struct folder folder = {.cache = cache,
                            .position = cloth_alloc(n, 3 * sizeof(double), error),
                            .order = cloth_alloc(n, sizeof *folder.order, error),
                            .same = cloth_alloc(n, sizeof *folder.same, error)};
    const int code = folder.position && folder.order && folder.same
                         ? check_frames_folder(&folder, &frames, found, error)
                         : CLOTH_E_MEMORY;
    found->frames -= found->frames ? frames.first : 0; /* those before were not looked at */
    free(folder.position);
    free(folder.order);
    free(folder.same);
    return code;
}
