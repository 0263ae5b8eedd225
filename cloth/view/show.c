/* The frame waits in plain arrays, so that files can be read before there
 * is an OpenGL context; drawing hands it to the scene. */
#include "cloth/view/show.h"

#include "cloth/contact/surface.h"

#include <stdlib.h>
#include <string.h>

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

/* Puts them where they are in a frame. */
static int place_obstacles(struct view_show *show, uint64_t frame, struct cloth_error *error)
{
    const int code = output_cache_pose(show->cache, frame, error);
    if (!code)
        view_obstacles_at(&show->obstacles, show->cache->time[frame]);
    return code;
}

/* The obstacles, after the cloth. */
static void fit_obstacles(struct view_show *show)
{
    const struct view_obstacles *obstacles = &show->obstacles;
    view_fit_planes(&show->sight.fit, obstacles->n_planes, (const double(*)[6])obstacles->plane);
    const double(*vertex)[6] = (const double(*)[6])obstacles->vertex;
    for (size_t i = 0; i < obstacles->n; i++) {
        const struct contact_shape *shape = obstacles->shape + i;
        uint32_t n, triangles;
        contact_surface_count(shape, contact_bodies_at(obstacles->bodies, shape->body), &n,
                              &triangles);
        view_fit_near(&show->sight.fit, n, vertex, shape->body > 0);
        vertex += n;
    }
}

static int fit_camera(struct view_show *show, struct cloth_error *error)
{
    const struct view_wish *wish = show->wish;
    const struct output_cache *cache = show->cache;
    view_fit_start(&show->sight.fit, wish->azimuth, wish->elevation,
                   (double)wish->width / wish->height, wish->zoom);
    for (uint64_t i = 0; i < view_looks(cache->n_frames); i++) {
        const int code = read_position(show, view_look(cache->n_frames, i), error);
        if (code)
            return code;
        view_fit_add(&show->sight.fit, cache->mesh.n_vertices, show->position);
    }
    for (uint64_t i = 0; i < view_looks(cache->n_frames); i++) {
        const int code = place_obstacles(show, view_look(cache->n_frames, i), error);
        if (code)
            return code;
        fit_obstacles(show);
    }
    view_fit_orbit(&show->sight.fit, &show->sight.fitted);
    show->sight.orbit = show->sight.fitted;
    return 0;
}

static int show_take_room(struct view_show *show, struct cloth_error *error)
{
    const size_t n = show->cache->mesh.n_vertices;
    show->used = malloc(n);
    show->position = malloc(3 * n * sizeof *show->position);
    return show->used && show->position
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
    made->wire = wish->wire;
    int code = view_obstacles_make(&made->obstacles, cache->n_obstacles, cache->obstacles,
                                   cache->keys, &cache->bodies, error);
    code = code ? code : show_take_room(made, error);
    if (!code)
        mesh_used(&cache->mesh, made->used);
    code = code ? code : fit_camera(made, error);
    return code ? code
                : view_colours_open(&made->colours, cache, wish->folder, &wish->colouring, error);
}

int view_show_frame(struct view_show *show, uint64_t frame, struct cloth_error *error)
{
    int code = read_position(show, frame, error);
    code = code ? code : view_colours_frame(&show->colours, frame, show->position, error);
    show->frame = frame;
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

/* Hands the scene the frame read last. */
static int move_scene(struct view_show *show, struct cloth_error *error)
{
    int code = show->scene ? 0 : make_scene(show, error);
    if (!code)
        view_scene_style(show->scene, show->wire, show->plain);
    if (code || !show->moved)
        return code;
    code = view_scene_move(show->scene, show->position, error);
    if (!code)
        view_colours_paint(&show->colours, show->scene);
    show->moved = code;
    return code;
}

int view_show_picture(struct view_show *show, struct view_picture *picture,
                      struct cloth_error *error)
{
    struct view_camera camera;
    view_orbit_camera(&show->sight.orbit, (double)picture->width / picture->height, &camera);
    int code = move_scene(show, error);
    code = code ? code : view_picture_draw(picture, show->scene, &camera, error);
    return code ? code : view_legend_lay(&show->colours.legend, picture, error);
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

/* Skips quantities that the folder lacks; the cloth's own colours are always there. */
int view_show_next_colour(struct view_show *show, struct cloth_error *error)
{
    enum view_colour by = show->colours.legend.by;
    int code = CLOTH_E_INPUT;
    while (code == CLOTH_E_INPUT) {
        struct cloth_error left_out = {0};
        by = (by + 1) % VIEW_COLOURS;
        code = view_colours_pick(&show->colours, by, &left_out);
        if (!code)
            code = view_colours_frame(&show->colours, show->frame, show->position, &left_out);
        if (code && code != CLOTH_E_INPUT)
            *error = left_out;
    }
    show->moved = true;
    return code;
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
    view_colours_close(&show->colours);
    free(show);
}
