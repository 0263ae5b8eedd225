/* Each function reads on after a failure of the reader, which then takes nothing: only numbers that
 * it gave without a failure are used. Memory belongs to the cache, also after a failure. */
#include "cloth/output/files/files.h"
#include "cloth/output/files/json.h"
#include "cloth/output/files/scene.h"

#include <stdlib.h>

/* A byte each: a short file may count many cloths. */
enum { MAX_PAIRS = 1 << 26 };

/* Room for an item behind n of them. NULL: the reader has failed, and the items stay. */
static void *scene_grow(struct output_json *json, void *items, size_t n, size_t size,
                        const char *name)
{
    char what[60];
    void *grown = realloc(items, (n + 1) * size);
    snprintf(what, sizeof what, "fewer %s than fit in memory", name);
    if (!grown)
        output_json_fail(json, what);
    return grown;
}

/* A key with numbers, and the character before it. */
static void take_named(struct output_json *json, char before, const char *name, size_t n,
                       double *value)
{
    output_json_expect(json, before);
    output_json_expect_key(json, name);
    output_json_numbers(json, n, value);
}

/* ---- Obstacles ---- */

/* That the numbers are what their role says. */
static void check_role(struct output_json *json, const struct contact_parameter *parameter,
                       const double *value)
{
    double square = 0, least = 1;
    for (size_t i = 0; i < contact_role_size(parameter->role); i++) {
        square += value[i] * value[i];
        least = value[i] < least ? value[i] : least;
    }
    const bool is_length = parameter->role == CONTACT_LENGTH || parameter->role == CONTACT_LENGTHS;
    char what[60];
    snprintf(what, sizeof what, "a %s %s", parameter->name,
             is_length ? "above zero" : "that is not zero");
    if (parameter->role != CONTACT_POINT && !(square > 0 && (!is_length || least > 0)))
        output_json_fail(json, what);
}

/* The name of the next body's file. */
static void scene_take_body(struct output_cache *cache, struct output_json *json,
                            struct contact_shape *shape)
{
    char name[40];
    const uint32_t k = cache->n_bodies;
    snprintf(name, sizeof name, OUTPUT_BODY_OBJ, k);
    shape->body = ++cache->n_bodies;
    output_json_expect(json, '{');
    output_json_expect_key(json, "obj");
    if (!output_json_word(json, name))
        output_json_fail(json, "the file of the next body: \"body-K.obj\", K from 0");
    bool *posed = scene_grow(json, cache->posed, k, sizeof *posed, "bodies");
    if (!posed)
        return;
    cache->posed = posed;
    posed[k] = output_json_take(json, ',');
    snprintf(name, sizeof name, OUTPUT_BODY_PC2, k);
    if (posed[k] && (!output_json_key(json, "pc2") || !output_json_word(json, name)))
        output_json_fail(json, "\"pc2\": the file of the body's shapes");
}

static void take_shape(struct output_cache *cache, struct output_json *json,
                       struct contact_shape *shape)
{
    *shape = (struct contact_shape){0};
    output_json_expect(json, '{');
    while (shape->kind < contact_n_kinds &&
           !output_json_key(json, contact_kinds[shape->kind]->name))
        shape->kind++;
    if (shape->kind == contact_n_kinds) {
        shape->kind = 0;
        output_json_fail(json, "a kind of obstacle");
        return;
    }
    const struct contact_kind *kind = contact_kinds[shape->kind];
    double *value = shape->value;
    for (const struct contact_parameter *p = kind->parameter; p->name; p++) {
        const char before = p == kind->parameter ? '{' : ',';
        take_named(json, before, p->name, contact_role_size(p->role), value);
        check_role(json, p, value);
        value += contact_role_size(p->role);
    }
    if (kind == &contact_body_kind)
        scene_take_body(cache, json, shape);
    output_json_expect(json, '}');
}

static void take_key(struct output_json *json, struct phys_key *key)
{
    const struct contact_parameter rotation = {"rotate", CONTACT_ROTATION};
    take_named(json, '{', "time", 1, &key->time);
    take_named(json, ',', "translate", 3, key->translate);
    take_named(json, ',', "rotate", 4, key->rotate);
    check_role(json, &rotation, key->rotate);
    output_json_expect(json, '}');
}

static void take_motion(struct output_cache *cache, struct output_json *json,
                        struct contact_shape *shape)
{
    take_named(json, ',', "about", 3, shape->about);
    output_json_expect(json, ',');
    output_json_expect_key(json, "keys");
    shape->first = cache->n_keys;
    for (; output_json_item(json, shape->n); shape->n++) {
        struct phys_key *keys = scene_grow(json, cache->keys, cache->n_keys, sizeof *keys, "keys");
        if (!keys)
            return;
        cache->keys = keys;
        take_key(json, keys + cache->n_keys);
        if (shape->n && !(keys[cache->n_keys].time > keys[cache->n_keys - 1].time))
            output_json_fail(json, "times in ascending order");
        cache->n_keys++;
    }
    if (!shape->n)
        output_json_fail(json, "a key");
}

static void take_obstacles(struct output_cache *cache, struct output_json *json)
{
    while (output_json_item(json, cache->n_obstacles)) {
        struct contact_shape *shapes =
            scene_grow(json, cache->obstacles, cache->n_obstacles, sizeof *shapes, "obstacles");
        if (!shapes)
            return;
        cache->obstacles = shapes;
        struct contact_shape *shape = shapes + cache->n_obstacles++;
        take_shape(cache, json, shape);
        if (!output_json_take(json, '}')) {
            take_motion(cache, json, shape);
            output_json_expect(json, '}');
        }
    }
}

/* ---- Pairs that do not meet ---- */

static void take_cloths(struct contact_apart *apart, struct output_json *json)
{
    uint32_t last = 0;
    for (; output_json_item(json, apart->n_cloths); apart->n_cloths++) {
        uint32_t *end = scene_grow(json, apart->end, apart->n_cloths, sizeof *end, "cloths");
        if (!end)
            return;
        apart->end = end;
        const double n = output_json_double(json);
        if (!(n >= 0 && n <= UINT32_MAX - last))
            output_json_fail(json, "a number of vertices");
        last += json->failed ? 0 : (uint32_t)n;
        end[apart->n_cloths] = last;
    }
    if (!apart->n_cloths)
        output_json_fail(json, "a number of vertices");
}

static void take_pair(struct contact_apart *apart, struct output_json *json)
{
    const size_t n_sides = (size_t)apart->n_cloths + apart->n_obstacles;
    double side[2];
    output_json_numbers(json, 2, side);
    if (!(side[0] >= 0 && side[0] < apart->n_cloths && side[1] >= 0 && side[1] < (double)n_sides))
        output_json_fail(json, "a cloth, and a cloth or obstacle");
    if (json->failed)
        return;
    const size_t a = (size_t)side[0], b = (size_t)side[1];
    apart->apart[a * n_sides + b] = 1;
    if (b < apart->n_cloths)
        apart->apart[b * n_sides + a] = 1;
}

static void take_apart(struct output_cache *cache, struct output_json *json)
{
    struct contact_apart *apart = &cache->apart;
    output_json_expect(json, '{');
    output_json_expect_key(json, "cloths");
    take_cloths(apart, json);
    output_json_expect(json, ',');
    output_json_expect_key(json, "pairs");
    apart->n_obstacles = cache->n_obstacles;
    if (json->failed)
        return;
    const uint64_t n_pairs =
        (uint64_t)apart->n_cloths * ((uint64_t)apart->n_cloths + apart->n_obstacles);
    apart->apart = n_pairs <= MAX_PAIRS ? calloc(n_pairs, 1) : NULL;
    if (!apart->apart)
        output_json_fail(json, "fewer cloths and obstacles, which fit in memory");
    for (size_t i = 0; output_json_item(json, i); i++)
        take_pair(apart, json);
    output_json_expect(json, '}');
}

/* An obstacle, then its vertices. Without the mesh, they are read over. */
static void take_attached_to(struct output_cache *cache, struct output_json *json)
{
    const uint32_t n = cache->mesh.n_vertices;
    double obstacle = 0;
    for (size_t i = 0; output_json_item(json, i); i++) {
        const double number = output_json_double(json);
        if (!i)
            obstacle = number;
        if (!(obstacle >= 0 && obstacle < cache->n_obstacles))
            output_json_fail(json, "the number of an obstacle");
        if (i && !(number >= 0 && (!n || number < n)))
            output_json_fail(json, "a vertex of cloth.obj");
        if (i && !json->failed && n)
            cache->attached[(size_t)number] = (uint32_t)obstacle + 1;
    }
}

static void take_attached(struct output_cache *cache, struct output_json *json)
{
    cache->apart.n_vertices = cache->mesh.n_vertices;
    cache->attached = calloc((size_t)cache->mesh.n_vertices + 1, sizeof *cache->attached);
    if (!cache->attached)
        output_json_fail(json, "fewer vertices than fit in memory");
    cache->apart.attached = cache->attached;
    for (size_t i = 0; output_json_item(json, i); i++)
        take_attached_to(cache, json);
}

/* Vertices and those above them that they are sewn to. Without the mesh, they are read over. */
static void take_sewn(struct output_cache *cache, struct output_json *json)
{
    const uint32_t n = cache->mesh.n_vertices;
    uint32_t *joined = cache->apart.joined = calloc((size_t)n + 1, sizeof *joined);
    cache->apart.n_vertices = n;
    if (!joined)
        output_json_fail(json, "fewer vertices than fit in memory");
    for (uint32_t v = 0; v < n && joined; v++)
        joined[v] = v;
    for (size_t i = 0; output_json_item(json, i); i++) {
        double pair[2];
        output_json_numbers(json, 2, pair);
        if (!(pair[0] >= 0 && pair[0] < pair[1] && (!n || pair[1] < n)))
            output_json_fail(json, "two vertices of cloth.obj, ascending");
        if (!json->failed && n)
            joined[(size_t)pair[1]] = (uint32_t)pair[0];
    }
}

/* ---- All of it ---- */

static void take_scene(struct output_cache *cache, struct output_json *json)
{
    take_named(json, '{', "fps", 1, &cache->fps);
    output_json_expect(json, ',');
    if (!output_json_key(json, "obstacles"))
        output_json_fail(json, output_json_key(json, "planes")
                                   ? "\"obstacles\" in place of \"planes\", which an earlier "
                                     "duite-cloth wrote: run the scene again"
                                   : "\"obstacles\"");
    take_obstacles(cache, json);
    while (!json->failed && output_json_take(json, ',')) {
        if (!cache->apart.apart && output_json_key(json, "apart"))
            take_apart(cache, json);
        else if (!cache->attached && output_json_key(json, "attached"))
            take_attached(cache, json);
        else if (!cache->apart.joined && output_json_key(json, "sewn"))
            take_sewn(cache, json);
        else
            output_json_fail(json, "\"apart\", \"attached\" or \"sewn\", or the end");
    }
    output_json_expect(json, '}');
    output_json_expect(json, '\0');
}

int output_cache_scene(struct output_cache *cache, const char *text, const char *name,
                       struct cloth_error *error)
{
    const struct contact_apart *apart = &cache->apart;
    struct output_json json = {.path = name, .text = text, .next = text, .error = error};
    take_scene(cache, &json);
    if (json.failed)
        return CLOTH_E_INPUT;
    if (!apart->n_cloths || !cache->mesh.n_vertices ||
        apart->end[apart->n_cloths - 1] == cache->mesh.n_vertices)
        return 0;
    return cloth_fail(error, CLOTH_E_INPUT, "%s has cloths of %u vertices, cloth.obj beside it %u",
                      name, apart->end[apart->n_cloths - 1], cache->mesh.n_vertices);
}

uint32_t output_bodies_before(const char *folder)
{
    struct output_cache cache = {0};
    size_t size;
    unsigned char *text = output_read_file(output_path(folder, "scene.json").text, &size);
    const bool read = text && !output_cache_scene(&cache, (const char *)text, "", NULL);
    const uint32_t n = read ? cache.n_bodies : 0;
    output_cache_close(&cache);
    free(text);
    return n;
}
