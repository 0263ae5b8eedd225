/* A show has one frame at a time. What is read of it waits in plain arrays, so that files are read
 * before there is an OpenGL context; the scene gets it when it is drawn. */
#include "cloth/view/show.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FITTED_FRAMES = 100 };

struct view_show {
    struct output_cache *cache;
    const struct view_wish *wish;
    struct view_obstacles obstacles;
    struct view_sight sight;
    bool wire, plain;         /* plain: without shadows */
    struct view_scene *scene; /* NULL until the first drawing */
    bool moved;               /* the scene has another frame than was read last */
    unsigned char *used;      /* a vertex: whether a face or an edge uses it */
    double *position, *force; /* of the frame read last; force: NULL unless asked for */
    float *heat;              /* a vertex, 0 .. 1; NULL: the cloth has its own colour */
    double largest, most;     /* N: of the frame; that has the hottest colour */
};

/* Vertices that nothing uses are not to be seen, and neither camera nor light is to look for them:
 * they go where the first used one is. */
static int read_position(struct view_show *show, uint64_t frame, struct cloth_error *error)
{
    const size_t n = show->cache->mesh.n_vertices;
    size_t first = 0;
    int code = output_cache_frame(show->cache, frame, show->position, error);
    while (first < n && !show->used[first])
        first++;
    for (size_t v = 0; !code && first < n && v < n; v++)
        if (!show->used[v])
            memcpy(show->position + 3 * v, show->position + 3 * first, 3 * sizeof(double));
    return code;
}

static double length_of(const double *v)
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static int read_heat(struct view_show *show, uint64_t frame, struct cloth_error *error)
{
    const uint32_t n = show->cache->mesh.n_vertices;
    const int code = output_forces_read(show->wish->folder, n, frame, show->force, error);
    if (code)
        return code;
    show->largest = 0;
    for (size_t v = 0; v < n; v++)
        show->largest = fmax(show->largest, length_of(show->force + 3 * v));
    if (!(show->most > 0))
        show->most = show->largest;
    for (size_t v = 0; v < n; v++)
        show->heat[v] =
            show->most > 0 ? (float)fmin(length_of(show->force + 3 * v) / show->most, 1) : 0;
    return 0;
}

void view_show_say(const struct view_show *show)
{
    if (show->heat)
        printf("the largest force of contact on a vertex is %g N, the hottest colour %g N\n",
               show->largest, show->most);
}

/* Where they are in a frame. */
static int place_obstacles(struct view_show *show, uint64_t frame, struct cloth_error *error)
{
    const int code = output_cache_pose(show->cache, frame, error);
    if (!code)
        view_obstacles_at(&show->obstacles, show->cache->time[frame]);
    return code;
}

static uint64_t fitted_frames(const struct output_cache *cache)
{
    return cache->n_frames < FITTED_FRAMES ? cache->n_frames : FITTED_FRAMES;
}

static uint64_t fitted_frame(const struct output_cache *cache, uint64_t i)
{
    const uint64_t n = fitted_frames(cache);
    return n > 1 ? i * (cache->n_frames - 1) / (n - 1) : 0;
}

/* The obstacles, after the cloth. */
static void fit_obstacles(struct view_show *show)
{
    const struct view_obstacles *obstacles = &show->obstacles;
    view_fit_planes(&show->sight.fit, obstacles->n_planes, (const double(*)[6])obstacles->plane);
    view_fit_near(&show->sight.fit, obstacles->n_vertices, (const double(*)[6])obstacles->vertex);
}

static int fit_camera(struct view_show *show, struct cloth_error *error)
{
    const struct view_wish *wish = show->wish;
    const struct output_cache *cache = show->cache;
    view_fit_start(&show->sight.fit, wish->azimuth, wish->elevation,
                   (double)wish->width / wish->height, wish->zoom);
    for (uint64_t i = 0; i < fitted_frames(cache); i++) {
        const int code = read_position(show, fitted_frame(cache, i), error);
        if (code)
            return code;
        view_fit_add(&show->sight.fit, cache->mesh.n_vertices, show->position);
    }
    for (uint64_t i = 0; i < fitted_frames(cache); i++) {
        const int code = place_obstacles(show, fitted_frame(cache, i), error);
        if (code)
            return code;
        fit_obstacles(show);
    }
    view_fit_orbit(&show->sight.fit, &show->sight.fitted);
    view_show_recentre(show);
    return 0;
}

static int take_room(struct view_show *show, struct cloth_error *error)
{
    const size_t n = show->cache->mesh.n_vertices;
    const bool heated = show->wish->contact;
    show->used = malloc(n);
    show->position = malloc(3 * n * sizeof *show->position);
    show->force = heated ? malloc(3 * n * sizeof *show->force) : NULL;
    show->heat = heated ? malloc(n * sizeof *show->heat) : NULL;
    return show->used && show->position && (!heated || (show->force && show->heat))
               ? 0
               : cloth_fail(error, CLOTH_E_MEMORY, "no memory for %zu vertices", n);
}

int view_show_open(struct view_show **show, struct output_cache *cache,
                   const struct view_wish *wish, struct cloth_error *error)
{
    struct view_show *made = *show = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to show %s", wish->folder);
    made->cache = cache;
    made->wish = wish;
    made->most = wish->most_force;
    made->wire = wish->wire;
    int code = view_obstacles_make(&made->obstacles, cache->n_obstacles, cache->obstacles,
                                   cache->keys, &cache->bodies, error);
    code = code ? code : take_room(made, error);
    if (!code)
        mesh_used(&cache->mesh, made->used);
    return code ? code : fit_camera(made, error);
}

int view_show_frame(struct view_show *show, uint64_t frame, struct cloth_error *error)
{
    int code = read_position(show, frame, error);
    if (!code && show->heat)
        code = read_heat(show, frame, error);
    show->moved = true;
    return code ? code : place_obstacles(show, frame, error);
}

static int make_scene(struct view_show *show, struct cloth_error *error)
{
    const struct output_cache *cache = show->cache;
    const struct view_shape shape = {.n_vertices = cache->mesh.n_vertices,
                                     .n_triangles = cache->mesh.n_triangles,
                                     .n_lines = cache->mesh.n_lone_edges,
                                     .triangle = cache->mesh.triangle,
                                     .line = cache->mesh.lone_edge,
                                     .obstacles = &show->obstacles,
                                     .n_cloths = cache->apart.n_cloths,
                                     .cloth_end = cache->apart.end};
    return view_scene_new(&show->scene, &shape, error);
}

/* Hands the scene what was read last. */
static int move_scene(struct view_show *show, struct cloth_error *error)
{
    int code = show->scene ? 0 : make_scene(show, error);
    if (!code)
        view_scene_wire(show->scene, show->wire);
    if (!code)
        view_scene_shadows(show->scene, !show->plain);
    if (code || !show->moved)
        return code;
    code = view_scene_move(show->scene, show->position, error);
    if (!code && show->heat)
        view_scene_heat(show->scene, show->heat);
    show->moved = code;
    return code;
}

int view_show_picture(struct view_show *show, struct view_picture *picture,
                      struct cloth_error *error)
{
    struct view_camera camera;
    view_orbit_camera(&show->sight.orbit, (double)picture->width / picture->height, &camera);
    const int code = move_scene(show, error);
    return code ? code : view_picture_draw(picture, show->scene, &camera, error);
}

struct view_orbit *view_show_orbit(struct view_show *show)
{
    return &show->sight.orbit;
}

void view_show_recentre(struct view_show *show)
{
    show->sight.orbit = show->sight.fitted;
}

void view_show_follow(struct view_show *show)
{
    struct view_sight *sight = &show->sight;
    const bool moved = memcmp(&sight->orbit, &sight->fitted, sizeof sight->fitted) != 0;
    view_fit_add(&sight->fit, show->cache->mesh.n_vertices, show->position);
    fit_obstacles(show);
    view_fit_orbit(&sight->fit, &sight->fitted);
    if (!moved)
        sight->orbit = sight->fitted;
}

struct view_sight *view_show_sight(struct view_show *show)
{
    return &show->sight;
}

void view_show_wire(struct view_show *show, bool wire)
{
    show->wire = wire;
}

void view_show_shadows(struct view_show *show, bool shadows)
{
    show->plain = !shadows;
}

int view_show_window(struct view_show *show, int width, int height, struct cloth_error *error)
{
    struct view_camera camera;
    view_orbit_camera(&show->sight.orbit, (double)width / height, &camera);
    const int code = move_scene(show, error);
    return code ? code : view_window_draw(width, height, show->scene, &camera, error);
}

void view_show_undraw(struct view_show *show)
{
    view_scene_free(show->scene);
    show->scene = NULL;
    show->moved = true;
}

void view_show_close(struct view_show *show)
{
    if (!show)
        return;
    view_obstacles_free(&show->obstacles);
    free(show->used);
    free(show->position);
    free(show->force);
    free(show->heat);
    free(show);
}
