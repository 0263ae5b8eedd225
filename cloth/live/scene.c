/* A mesh goes out as triangles and edges without triangles, cloth after cloth; a body as the mesh
 * that it was made of. Scenes received are checked like files, by the same functions. */
#include "cloth/live/scene.h"

#include "cloth/base/bytes.h"
#include "cloth/base/memory.h"

#include <stdlib.h>

enum { BODY_COUNTS = 8 };

/* ---- Writing ---- */

static void put_u32(FILE *to, uint32_t value)
{
    unsigned char bytes[4];
    cloth_put_u32(bytes, value);
    fwrite(bytes, sizeof bytes, 1, to);
}

static void put_start(FILE *to, const struct mesh *mesh)
{
    unsigned char bytes[4];
    for (size_t i = 0; i < 3 * (size_t)mesh->n_vertices; i++) {
        cloth_put_float(bytes, (float)mesh->position[i]);
        fwrite(bytes, sizeof bytes, 1, to);
    }
}

/* Counts, then arrays, each of them cloth after cloth. */
static void put_meshes(FILE *to, const struct output_setup *setup)
{
    const struct mesh *const *mesh = setup->meshes, *const *end = mesh + setup->n_meshes;
    uint32_t n_vertices = 0, n_edges = 0, n_triangles = 0, first = 0, corner[3];
    for (; mesh < end; mesh++) {
        n_vertices += (*mesh)->n_vertices;
        n_edges += (*mesh)->n_lone_edges;
        n_triangles += (*mesh)->n_triangles;
    }
    put_u32(to, n_vertices);
    put_u32(to, n_edges);
    put_u32(to, n_triangles);
    put_u32(to, setup->bodies ? setup->bodies->n : 0);
    for (mesh = setup->meshes; mesh < end; mesh++)
        put_start(to, *mesh);
    for (mesh = setup->meshes; mesh < end; first += (*mesh++)->n_vertices)
        for (size_t k = 0; k < 2 * (size_t)(*mesh)->n_lone_edges; k++)
            put_u32(to, first + (*mesh)->lone_edge[k]);
    first = 0;
    for (mesh = setup->meshes; mesh < end; first += (*mesh++)->n_vertices)
        for (uint32_t t = 0; t < (*mesh)->n_triangles; t++) {
            mesh_corners(*mesh, t, corner);
            for (int k = 0; k < 3; k++)
                put_u32(to, first + corner[k]);
        }
}

static int put_body(FILE *to, const struct contact_body *body, struct cloth_error *error)
{
    struct mesh mesh = {0};
    unsigned char bytes[8];
    const int code = contact_body_mesh(body, &mesh, error);
    put_u32(to, mesh.n_vertices);
    put_u32(to, mesh.n_triangles);
    for (size_t i = 0; i < 3 * (size_t)mesh.n_vertices; i++) {
        cloth_put_double(bytes, mesh.position[i]);
        fwrite(bytes, sizeof bytes, 1, to);
    }
    for (size_t i = 0; i < 3 * (size_t)mesh.n_triangles; i++)
        put_u32(to, mesh.triangle[i]);
    mesh_free(&mesh);
    return code;
}

int live_scene_write(const struct output_setup *setup, uint64_t run, uint64_t scene,
                     unsigned char **bytes, size_t *n, struct cloth_error *error)
{
    unsigned char begin[LIVE_HEADER + 16] = {0}; /* the header is written when all is there */
    char *text = NULL;
    int code = CLOTH_OK;
    FILE *to = open_memstream(&text, n);
    *bytes = NULL;
    if (!to)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the scene of --live");
    cloth_put_u64(begin + LIVE_HEADER, run);
    cloth_put_u64(begin + LIVE_HEADER + 8, scene);
    fwrite(begin, sizeof begin, 1, to);
    put_meshes(to, setup);
    for (uint32_t i = 1; setup->bodies && i <= setup->bodies->n && !code; i++)
        code = put_body(to, contact_bodies_at(setup->bodies, i), error);
    output_scene_text(to, setup);
    const bool failed = ferror(to);
    if (fclose(to) != 0 || failed)
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for the scene of --live");
    *bytes = (unsigned char *)text;
    if (!code)
        live_message_seal(*bytes, *n, LIVE_SCENE);
    return code;
}

/* ---- Reading: each function takes what it reads off `from` ---- */

static uint32_t *take_numbers(const unsigned char **from, size_t n, struct cloth_error *error)
{
    uint32_t *number = cloth_alloc(n, sizeof *number, error);
    for (size_t i = 0; number && i < n; i++)
        number[i] = cloth_get_u32(*from + 4 * i);
    *from += 4 * n;
    return number;
}

/* size: bytes of a number, float or double. */
static double *take_points(const unsigned char **from, size_t n, size_t size,
                           struct cloth_error *error)
{
    double *x = cloth_alloc(3 * n, sizeof *x, error);
    for (size_t i = 0; x && i < 3 * n; i++)
        x[i] = size == sizeof(float) ? (double)cloth_get_float(*from + size * i)
                                     : cloth_get_double(*from + size * i);
    *from += 3 * size * n;
    return x;
}

/* size: of the numbers of places. */
static int take_mesh(const unsigned char **from, uint32_t n_vertices, size_t size, uint32_t n_edges,
                     uint32_t n_triangles, struct mesh *mesh, struct cloth_error *error)
{
    double *place = take_points(from, n_vertices, size, error);
    uint32_t *edge = take_numbers(from, 2 * (size_t)n_edges, error);
    uint32_t *triangle = take_numbers(from, 3 * (size_t)n_triangles, error);
    const int code = place && edge && triangle ? mesh_inline(mesh, n_vertices, place, n_edges, edge,
                                                             n_triangles, triangle, error)
                                               : CLOTH_E_MEMORY;
    free(place);
    free(edge);
    free(triangle);
    return code;
}

static int take_body(const unsigned char **from, struct contact_bodies *bodies,
                     struct cloth_error *error)
{
    const uint32_t n = cloth_get_u32(*from), n_triangles = cloth_get_u32(*from + 4);
    struct mesh mesh = {0};
    bool turned;
    *from += BODY_COUNTS;
    int code = take_mesh(from, n, sizeof(double), 0, n_triangles, &mesh, error);
    if (!code)
        code = contact_bodies_add(bodies, &mesh, &turned, error);
    mesh_free(&mesh);
    return code;
}

static int take_text(const unsigned char *from, size_t n, struct output_cache *cache,
                     struct cloth_error *error)
{
    char *text = strndup((const char *)from, n);
    const int code = text ? output_cache_scene(cache, text, "the scene of the live view", error)
                          : cloth_fail(error, CLOTH_E_MEMORY, "no memory for a scene's text");
    free(text);
    return code;
}

static int live_scene_take_parts(const struct live_message *scene, struct output_cache *cache,
                                 struct cloth_error *error)
{
    const unsigned char *from = scene->rest;
    int code = take_mesh(&from, scene->n_vertices, sizeof(float), scene->n_edges,
                         scene->n_triangles, &cache->mesh, error);
    for (uint32_t i = 0; i < scene->n_bodies && !code; i++)
        code = take_body(&from, &cache->bodies, error);
    if (!code)
        code = take_text(from, scene->n_rest - (size_t)(from - scene->rest), cache, error);
    if (!code && cache->n_bodies != scene->n_bodies)
        code = cloth_fail(error, CLOTH_E_INPUT, "%u bodies came, but the scene has %u",
                          scene->n_bodies, cache->n_bodies);
    return code;
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
    return code ? cloth_fail(error, code, "a scene of the live view cannot be used: %s", inner.text)
                : 0;
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
    double *x = take_points(&from, n, sizeof(float), error);
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
        cache->held[i] = (double)cloth_get_float(frame->rest + 4 * i);
    cache->time[0] = frame->time;
    return place_bodies(frame->rest + 12 * (size_t)frame->n_vertices, cache, frame->n_body_vertices,
                        error);
}
