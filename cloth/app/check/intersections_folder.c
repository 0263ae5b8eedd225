/* A folder does not name its welds. But welded vertices have the same floats in each frame, and no
 * others are likely to: they count as one. */
#include "cloth/app/check/intersections.h"
#include "cloth/base/memory.h"
#include "cloth/contact/soup.h"
#include "cloth/output/output.h"

#include <stdlib.h>

static int intersections_folder_compare_places(const double *x, const double *y)
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
    const int places = intersections_folder_compare_places(x + 3 * (size_t)a, x + 3 * (size_t)b);
    return places ? places : (a > b) - (a < b);
}

static bool is_at(const double *x, uint32_t a, uint32_t b)
{
    return intersections_folder_compare_places(x + 3 * (size_t)a, x + 3 * (size_t)b) == 0;
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
    if (!folder->cache->n_frames)
        return cloth_fail(error, CLOTH_E_INPUT, "the folder has no finished frame");
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

static int intersections_folder_check_frames(const struct folder *folder,
                                             struct intersections *intersections,
                                             struct cloth_error *error)
{
    struct output_cache *cache = folder->cache;
    int code = CLOTH_OK;
    for (uint64_t k = 0; k < cache->n_frames && !code; k++) {
        code = output_cache_frame(cache, k, folder->position, error);
        code = code ? code : output_cache_pose(cache, k, error);
        code = code ? code
                    : intersections_frame(intersections, k, cache->time[k], folder->position, true,
                                          error);
    }
    return code;
}

static int intersections_folder_check(struct folder *folder, const char *program,
                                      struct intersections_found *found, struct cloth_error *error)
{
    const struct output_cache *cache = folder->cache;
    const struct mesh *mesh = &cache->mesh;
    struct contact_soup soup = {0};
    const struct intersections_setup setup = {.program = program,
                                              .soup = &soup,
                                              .obstacles = cache->obstacles,
                                              .keys = cache->keys,
                                              .bodies = &cache->bodies,
                                              .apart = &cache->apart};
    struct intersections *intersections = NULL;
    int code = find_same(folder, error);
    if (!code) {
        code = contact_soup_make(&soup, 1, &mesh, folder->same, (uint32_t)cache->n_obstacles,
                                 cache->obstacles, &cache->bodies, error);
        folder->same = NULL;
    }
    code = code ? code : intersections_open(&intersections, &setup, error);
    contact_soup_free(&soup);
    code = code ? code : intersections_folder_check_frames(folder, intersections, error);
    if (!code)
        *found = intersections_found(intersections);
    intersections_close(&intersections);
    return code;
}

int intersections_of_folder(struct output_cache *cache, const char *program,
                            struct intersections_found *found, struct cloth_error *error)
{
    const size_t n = cache->mesh.n_vertices;
    struct folder folder = {.cache = cache,
                            .position = cloth_alloc(n, 3 * sizeof(double), error),
                            .order = cloth_alloc(n, sizeof *folder.order, error),
                            .same = cloth_alloc(n, sizeof *folder.same, error)};
    const int code = folder.position && folder.order && folder.same
                         ? intersections_folder_check(&folder, program, found, error)
                         : CLOTH_E_MEMORY;
    free(folder.position);
    free(folder.order);
    free(folder.same);
    return code;
}
