/* Names and sizes of an obstacle's parameters are those of the table of kinds: a new kind needs
 * nothing here. */
#include "cloth/output/files/scene.h"

#include "cloth/output/files/json.h"

/* ---- Obstacles ---- */

static void scene_put_named(FILE *file, const char *name, size_t n, const double *value)
{
    fprintf(file, "\"%s\": ", name);
    output_json_put_numbers(file, n, value);
}

static void put_shape(FILE *file, const struct contact_shape *shape, const bool *posed)
{
    const struct contact_kind *kind = contact_kinds[shape->kind];
    const double *value = shape->value;
    fprintf(file, "{\"%s\": {", kind->name);
    for (const struct contact_parameter *p = kind->parameter; p->name; p++) {
        const size_t n = contact_role_size(p->role);
        fputs(p == kind->parameter ? "" : ", ", file);
        scene_put_named(file, p->name, n, value);
        value += n;
    }
    if (shape->body)
        fprintf(file, "\"obj\": \"" OUTPUT_BODY_OBJ "\"", shape->body - 1);
    if (shape->body && posed && posed[shape->body - 1])
        fprintf(file, ", \"pc2\": \"" OUTPUT_BODY_PC2 "\"", shape->body - 1);
    fputc('}', file);
}

static void put_motion(FILE *file, const struct contact_shape *shape, const struct phys_key *keys)
{
    fputs(", ", file);
    scene_put_named(file, "about", 3, shape->about);
    fputs(", \"keys\": [", file);
    for (uint32_t i = 0; i < shape->n; i++) {
        const struct phys_key *key = keys + shape->first + i;
        fputs(i ? ",\n      {" : "\n      {", file);
        scene_put_named(file, "time", 1, &key->time);
        fputs(", ", file);
        scene_put_named(file, "translate", 3, key->translate);
        fputs(", ", file);
        scene_put_named(file, "rotate", 4, key->rotate);
        fputc('}', file);
    }
    fputc(']', file);
}

static void put_obstacles(FILE *file, const struct output_setup *setup)
{
    fputc('[', file);
    for (size_t i = 0; i < setup->n_obstacles; i++) {
        const struct contact_shape *shape = setup->obstacles + i;
        fputs(i ? ",\n    " : "\n    ", file);
        put_shape(file, shape, setup->posed);
        if (shape->n)
            put_motion(file, shape, setup->keys);
        fputc('}', file);
    }
    fputs(setup->n_obstacles ? "\n  ]" : "]", file);
}

/* ---- Pairs that do not meet, so that who reads a folder can leave them out as the run did ---- */

static void put_apart(FILE *file, const struct contact_apart *apart)
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

static void put_attached(FILE *file, size_t n_obstacles, const struct contact_apart *apart)
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

static void put_sewn(FILE *file, const struct contact_apart *apart)
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

/* ---- All of it ---- */

void output_scene_text(FILE *file, const struct output_setup *setup)
{
    const struct contact_apart *apart = setup->apart;
    fputs("{\n  \"fps\": ", file);
    output_json_number(file, setup->fps);
    fputs(",\n  \"obstacles\": ", file);
    put_obstacles(file, setup);
    if (apart && (apart->apart || apart->n_cloths > 1)) {
        fputs(",\n  \"apart\": ", file);
        put_apart(file, apart);
    }
    if (apart && apart->attached) {
        fputs(",\n  \"attached\": ", file);
        put_attached(file, setup->n_obstacles, apart);
    }
    if (apart && apart->joined) {
        fputs(",\n  \"sewn\": ", file);
        put_sewn(file, apart);
    }
    fputs("\n}\n", file);
}

int output_fill_scene(FILE *file, const void *what)
{
    output_scene_text(file, what);
    return ferror(file);
}
