/* A mesh goes out as triangles and edges without triangles, cloth after cloth; a body as the mesh
 * that it was made of. Scenes received are checked like files, by the same functions. */
#include "cloth/live/scene.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

enum { COUNTS = LIVE_HEADER + 16, ARRAYS = COUNTS + 16, BODY_COUNTS = 8 };

/* ---- Writing ---- */

/* The meshes and bodies of a run's message. */
struct parts {
    uint32_t n_vertices, n_edges, n_triangles, n_bodies;
    size_t body_bytes;
    char *text;
    size_t n_text;
};

static void count_parts(const struct output_setup *setup, struct parts *parts)
{
    for (size_t i = 0; i < setup->n_meshes; i++) {
        parts->n_vertices += setup->meshes[i]->n_vertices;
        parts->n_edges += setup->meshes[i]->n_lone_edges;
        parts->n_triangles += setup->meshes[i]->n_triangles;
    }
    parts->n_bodies = setup->bodies ? setup->bodies->n : 0;
    for (uint32_t i = 1; i <= parts->n_bodies; i++) {
        const struct contact_body *body = contact_bodies_at(setup->bodies, i);
        parts->body_bytes +=
            BODY_COUNTS + 24 * (size_t)body->n_vertices + 12 * (size_t)body->n_triangles;
    }
}

static int write_text(const struct output_setup *setup, struct parts *parts,
                      struct cloth_error *error)
{
    FILE *file = open_memstream(&parts->text, &parts->n_text);
    if (file)
        output_scene_text(file, setup);
    const bool failed = !file || ferror(file);
    return (file && fclose(file) != 0) || failed
               ? cloth_fail(error, CLOTH_E_MEMORY, "no memory for the scene of --live")
               : 0;
}

static unsigned char *put_start(unsigned char *to, const struct output_setup *setup)
{
    for (size_t i = 0; i < setup->n_meshes; i++)
        for (size_t k = 0; k < 3 * (size_t)setup->meshes[i]->n_vertices; k++, to += 4)
            live_put_float(to, (float)setup->meshes[i]->position[k]);
    return to;
}

static unsigned char *put_edges(unsigned char *to, const struct output_setup *setup)
{
    uint32_t first = 0;
    for (size_t i = 0; i < setup->n_meshes; first += setup->meshes[i++]->n_vertices)
        for (size_t k = 0; k < 2 * (size_t)setup->meshes[i]->n_lone_edges; k++, to += 4)
            live_put_u32(to, first + setup->meshes[i]->lone_edge[k]);
    return to;
}

static unsigned char *put_triangles(unsigned char *to, const struct output_setup *setup)
{
    uint32_t first = 0, corner[3];
    for (size_t i = 0; i < setup->n_meshes; first += setup->meshes[i++]->n_vertices)
        for (uint32_t t = 0; t < setup->meshes[i]->n_triangles; t++) {
            mesh_corners(setup->meshes[i], t, corner);
            for (int k = 0; k < 3; k++, to += 4)
                live_put_u32(to, first + corner[k]);
        }
    return to;
}

static int live_scene_put_body(unsigned char **to, const struct contact_body *body,
                               struct cloth_error *error)
{
    struct mesh mesh = {0};
    const int code = contact_body_mesh(body, &mesh, error);
    if (!code) {
        live_put_u32(*to, mesh.n_vertices);
        live_put_u32(*to + 4, mesh.n_triangles);
        *to += BODY_COUNTS;
        for (size_t i = 0; i < 3 * (size_t)mesh.n_vertices; i++, *to += 8)
            live_put_double(*to, mesh.position[i]);
        for (size_t i = 0; i < 3 * (size_t)mesh.n_triangles; i++, *to += 4)
            live_put_u32(*to, mesh.triangle[i]);
    }
    mesh_free(&mesh);
    return code;
}

static int put_parts(unsigned char *bytes, const struct output_setup *setup,
                     const struct parts *parts, struct cloth_error *error)
{
    const uint32_t count[4] = {parts->n_vertices, parts->n_edges, parts->n_triangles,
                               parts->n_bodies};
    for (int i = 0; i < 4; i++)
        live_put_u32(bytes + COUNTS + 4 * i, count[i]);
    unsigned char *to = put_start(bytes + ARRAYS, setup);
    to = put_triangles(put_edges(to, setup), setup);
    int code = 0;
    for (uint32_t i = 1; i <= parts->n_bodies && !code; i++)
        code = live_scene_put_body(&to, contact_bodies_at(setup->bodies, i), error);
    if (!code)
        memcpy(to, parts->text, parts->n_text);
    return code;
}

int live_scene_write(const struct output_setup *setup, uint64_t run, uint64_t scene,
                     unsigned char **bytes, size_t *n, struct cloth_error *error)
{
    struct parts parts = {0};
    count_parts(setup, &parts);
    int code = write_text(setup, &parts, error);
    *n = ARRAYS + 12 * (size_t)parts.n_vertices + 8 * (size_t)parts.n_edges +
         12 * (size_t)parts.n_triangles + parts.body_bytes + parts.n_text;
    *bytes = code ? NULL : cloth_alloc(*n, 1, error);
    code = code || *bytes ? code : CLOTH_E_MEMORY;
    if (!code)
        code = put_parts(*bytes, setup, &parts, error);
    if (!code) {
        live_put_u64(*bytes + LIVE_HEADER, run);
        live_put_u64(*bytes + LIVE_HEADER + 8, scene);
        live_message_seal(*bytes, *n, LIVE_SCENE);
    }
    free(parts.text);
    return code;
}

/* ---- Reading ---- */

static uint32_t *live_scene_take_numbers(const unsigned char **from, size_t n,
                                         struct cloth_error *error)
{
    uint32_t *number = cloth_alloc(n, sizeof *number, error);
    for (size_t i = 0; number && i < n; i++)
        number[i] = live_get_u32(*from + 4 * i);
    *from += 4 * n;
    return number;
}

static double *take_floats(const unsigned char **from, uint32_t n, struct cloth_error *error)
{
    double *x = cloth_alloc(3 * (size_t)n, sizeof *x, error);
    for (size_t i = 0; x && i < 3 * (size_t)n; i++)
        x[i] = (double)live_get_float(*from + 4 * i);
    *from += 12 * (size_t)n;
    return x;
}

static double *take_doubles(const unsigned char **from, uint32_t n, struct cloth_error *error)
{
    double *x = cloth_alloc(3 * (size_t)n, sizeof *x, error);
    for (size_t i = 0; x && i < 3 * (size_t)n; i++)
        x[i] = live_get_double(*from + 8 * i);
    *from += 24 * (size_t)n;
    return x;
}

static int live_scene_take_mesh(const struct live_message *scene, const unsigned char **from,
                                struct mesh *mesh, struct cloth_error *error)
{
    double *place = take_floats(from, scene->n_vertices, error);
    uint32_t *edge = live_scene_take_numbers(from, 2 * (size_t)scene->n_edges, error);
    uint32_t *triangle = live_scene_take_numbers(from, 3 * (size_t)scene->n_triangles, error);
    int code = edge && triangle && place ? 0 : CLOTH_E_MEMORY;
    if (!code)
        code = mesh_inline(mesh, scene->n_vertices, place, scene->n_edges, edge, scene->n_triangles,
                           triangle, error);
    free(edge);
    free(triangle);
    free(place);
    return code;
}

static int live_scene_take_body(const unsigned char **from, struct contact_bodies *bodies,
                                struct cloth_error *error)
{
    const uint32_t n = live_get_u32(*from), n_triangles = live_get_u32(*from + 4);
    struct mesh mesh = {0};
    bool turned;
    *from += BODY_COUNTS;
    double *place = take_doubles(from, n, error);
    uint32_t *triangle = live_scene_take_numbers(from, 3 * (size_t)n_triangles, error);
    int code = place && triangle ? 0 : CLOTH_E_MEMORY;
    if (!code)
        code = mesh_inline(&mesh, n, place, 0, NULL, n_triangles, triangle, error);
    if (!code)
        code = contact_bodies_add(bodies, &mesh, &turned, error);
    mesh_free(&mesh);
    free(place);
    free(triangle);
    return code;
}

static int take_text(const unsigned char *from, size_t n, struct output_cache *cache,
                     struct cloth_error *error)
{
    char *text = cloth_alloc(n + 1, 1, error);
    if (!text)
        return CLOTH_E_MEMORY;
    memcpy(text, from, n);
    const int code = output_cache_scene(cache, text, "the scene of the live view", error);
    free(text);
    return code;
}

static int live_scene_take_parts(const struct live_message *scene, struct output_cache *cache,
                                 struct cloth_error *error)
{
    const unsigned char *from = scene->rest;
    int code = live_scene_take_mesh(scene, &from, &cache->mesh, error);
    for (uint32_t i = 0; i < scene->n_bodies && !code; i++)
        code = live_scene_take_body(&from, &cache->bodies, error);
    if (!code)
        code = take_text(from, scene->n_rest - (size_t)(from - scene->rest), cache, error);
    if (!code && cache->n_bodies != scene->n_bodies)
        code = cloth_fail(error, CLOTH_E_INPUT, "%u bodies came, but the scene has %u",
                          scene->n_bodies, cache->n_bodies);
    return code;
}

/* Says first where an error comes from. */
static int name_error(int code, const struct cloth_error *inner, struct cloth_error *error)
{
    return code
               ? cloth_fail(error, code, "a scene of the live view cannot be used: %s", inner->text)
               : 0;
}

int live_scene_open(const struct live_message *scene, struct output_cache *cache,
                    struct cloth_error *error)
{
    struct cloth_error inner = {0};
    *cache = (struct output_cache){0};
    int code = live_scene_take_parts(scene, cache, &inner);
    if (!code) {
        cache->held = cloth_alloc(3 * (size_t)scene->n_vertices, sizeof *cache->held, &inner);
        cache->time = cloth_alloc(1, sizeof *cache->time, &inner);
        cache->n_frames = 1;
        code = inner.code;
    }
    if (code)
        output_cache_close(cache);
    return name_error(code, &inner, error);
}

/* Counts vertices of the bodies that change their shape. */
static uint64_t count_posed(const struct output_cache *cache)
{
    uint64_t n = 0;
    for (uint32_t i = 0; i < cache->n_bodies; i++)
        n += cache->posed[i] ? contact_bodies_at(&cache->bodies, i + 1)->n_vertices : 0;
    return n;
}

static int place_bodies(const unsigned char *from, struct output_cache *cache, uint32_t n,
                        struct cloth_error *error)
{
    double *x = take_floats(&from, n, error);
    const double(*at)[3] = (const double(*)[3])x;
    if (!x)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < cache->n_bodies; i++)
        if (cache->posed[i]) {
            contact_body_place(&cache->bodies, i + 1, at);
            at += contact_bodies_at(&cache->bodies, i + 1)->n_vertices;
        }
    free(x);
    return 0;
}

int live_frame_show(const struct live_message *frame, struct output_cache *cache,
                    struct cloth_error *error)
{
    const uint64_t n_posed = count_posed(cache);
    if (frame->n_vertices != cache->mesh.n_vertices || frame->n_body_vertices != n_posed)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a frame of the live view has %u and %u vertices, its scene %u and %ju",
                          frame->n_vertices, frame->n_body_vertices, cache->mesh.n_vertices,
                          (uintmax_t)n_posed);
    for (size_t i = 0; i < 3 * (size_t)frame->n_vertices; i++)
        cache->held[i] = (double)live_get_float(frame->rest + 4 * i);
    cache->time[0] = frame->time;
    return place_bodies(frame->rest + 12 * (size_t)frame->n_vertices, cache, frame->n_body_vertices,
                        error);
}
