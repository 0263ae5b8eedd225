/* Which cloths and obstacles do not meet, in scene.json, so that who reads a folder can leave them
 * out as the run did. */
#include "cloth/output/files/obstacles.h"

#include <stdlib.h>

/* A byte each: a short file may count many cloths. */
enum { MAX_PAIRS = 1 << 26 };

void output_apart(FILE *file, const struct contact_apart *apart)
{
    const char *before = "";
    fputs("{\"cloths\": [", file);
    for (uint32_t c = 0; c < apart->n_cloths; c++)
        fprintf(file, "%s%u", c ? ", " : "", apart->end[c] - (c ? apart->end[c - 1] : 0));
    fputs("], \"pairs\": [", file);
    for (uint32_t c = 0; c < apart->n_cloths; c++)
        for (uint32_t i = c; i < apart->n_cloths + apart->n_obstacles; i++)
            if (contact_are_apart(apart, c, i)) {
                fprintf(file, "%s[%u, %u]", before, c, i);
                before = ", ";
            }
    fputs("]}", file);
}

void output_attached(FILE *file, size_t n_obstacles, const struct contact_apart *apart)
{
    const char *before = "";
    fputc('[', file);
    for (uint32_t i = 0; i < n_obstacles; i++) {
        bool any = false;
        for (uint32_t v = 0; v < apart->n_vertices; v++) {
            if (apart->attached[v] != i + 1)
                continue;
            if (!any)
                fprintf(file, "%s[%u", before, i);
            fprintf(file, ", %u", v);
            any = true;
            before = "],\n    ";
        }
    }
    fputs(*before ? "]]" : "]", file);
}

void output_sewn(FILE *file, const struct contact_apart *apart)
{
    const char *before = "";
    fputc('[', file);
    for (uint32_t v = 0; v < apart->n_vertices; v++)
        if (apart->joined[v] != v) {
            fprintf(file, "%s[%u, %u]", before, apart->joined[v], v);
            before = ", ";
        }
    fputc(']', file);
}

/* ---- Reading ---- */

static void apart_take_cloths(struct contact_apart *apart, struct output_json *json)
{
    uint32_t end = 0;
    do {
        uint32_t *grown = realloc(apart->end, (apart->n_cloths + 1) * sizeof *grown);
        if (!grown) {
            output_json_fail(json, "fewer cloths than fit in memory");
            return;
        }
        apart->end = grown;
        const double n = output_json_double(json);
        if (!(n >= 0 && n <= UINT32_MAX - end))
            output_json_fail(json, "a number of vertices");
        end += json->failed ? 0 : (uint32_t)n;
        apart->end[apart->n_cloths++] = end;
    } while (output_json_take(json, ','));
}

static void take_pair(struct contact_apart *apart, struct output_json *json)
{
    const size_t n_sides = (size_t)apart->n_cloths + apart->n_obstacles;
    output_json_expect(json, '[');
    const double a = output_json_double(json);
    output_json_expect(json, ',');
    const double b = output_json_double(json);
    output_json_expect(json, ']');
    if (!(a >= 0 && a < apart->n_cloths && b >= 0 && b < (double)n_sides))
        output_json_fail(json, "a cloth, and a cloth or obstacle");
    if (json->failed)
        return;
    apart->apart[(size_t)a * n_sides + (size_t)b] = 1;
    if (b < apart->n_cloths)
        apart->apart[(size_t)b * n_sides + (size_t)a] = 1;
}

void output_apart_read(struct output_cache *cache, struct output_json *json)
{
    struct contact_apart *apart = &cache->apart;
    output_json_expect(json, '{');
    if (!output_json_key(json, "cloths"))
        output_json_fail(json, "\"cloths\"");
    output_json_expect(json, '[');
    apart_take_cloths(apart, json);
    output_json_expect(json, ']');
    output_json_expect(json, ',');
    if (!output_json_key(json, "pairs"))
        output_json_fail(json, "\"pairs\"");
    output_json_expect(json, '[');
    apart->n_obstacles = cache->n_obstacles;
    if (json->failed)
        return;
    const uint64_t n_pairs =
        (uint64_t)apart->n_cloths * ((uint64_t)apart->n_cloths + apart->n_obstacles);
    apart->apart = n_pairs <= MAX_PAIRS ? calloc(n_pairs, 1) : NULL;
    if (!apart->apart)
        output_json_fail(json, "fewer cloths and obstacles, which fit in memory");
    if (!output_json_take(json, ']')) {
        do
            take_pair(apart, json);
        while (!json->failed && output_json_take(json, ','));
        output_json_expect(json, ']');
    }
    output_json_expect(json, '}');
}

/* An obstacle, then its vertices. Without the mesh, they are read over. */
static void take_attached(struct output_cache *cache, struct output_json *json)
{
    const uint32_t n = cache->mesh.n_vertices;
    const double obstacle = output_json_double(json);
    if (!(obstacle >= 0 && obstacle < cache->n_obstacles))
        output_json_fail(json, "the number of an obstacle");
    while (!json->failed && output_json_take(json, ',')) {
        const double v = output_json_double(json);
        if (!(v >= 0 && (!n || v < n)))
            output_json_fail(json, "a vertex of cloth.obj");
        if (!json->failed && n)
            cache->attached[(size_t)v] = (uint32_t)obstacle + 1;
    }
}

void output_attached_read(struct output_cache *cache, struct output_json *json)
{
    cache->apart.n_vertices = cache->mesh.n_vertices;
    cache->attached = calloc((size_t)cache->mesh.n_vertices + 1, sizeof *cache->attached);
    if (!cache->attached)
        output_json_fail(json, "fewer vertices than fit in memory");
    cache->apart.attached = cache->attached;
    output_json_expect(json, '[');
    if (output_json_take(json, ']'))
        return;
    do {
        output_json_expect(json, '[');
        if (!json->failed)
            take_attached(cache, json);
        output_json_expect(json, ']');
    } while (!json->failed && output_json_take(json, ','));
    output_json_expect(json, ']');
}

/* A vertex and one above it that it is sewn to. Without the mesh, they are read over. */
static void apart_take_sewn(struct contact_apart *apart, uint32_t n, struct output_json *json)
{
    output_json_expect(json, '[');
    const double low = output_json_double(json);
    output_json_expect(json, ',');
    const double v = output_json_double(json);
    output_json_expect(json, ']');
    if (!(low >= 0 && low < v && (!n || v < n)))
        output_json_fail(json, "two vertices of cloth.obj, ascending");
    if (!json->failed && n)
        apart->joined[(size_t)v] = (uint32_t)low;
}

void output_sewn_read(struct output_cache *cache, struct output_json *json)
{
    const uint32_t n = cache->mesh.n_vertices;
    cache->apart.n_vertices = n;
    cache->apart.joined = calloc((size_t)n + 1, sizeof *cache->apart.joined);
    if (!cache->apart.joined)
        output_json_fail(json, "fewer vertices than fit in memory");
    for (uint32_t v = 0; v < n && !json->failed; v++)
        cache->apart.joined[v] = v;
    output_json_expect(json, '[');
    if (output_json_take(json, ']'))
        return;
    do
        apart_take_sewn(&cache->apart, n, json);
    while (!json->failed && output_json_take(json, ','));
    output_json_expect(json, ']');
}
