/* Names and sizes of parameters are those of the table of kinds: a new kind needs nothing here. */
#include "cloth/output/files/obstacles.h"

#include <stdlib.h>

static void files_obstacles_put_numbers(FILE *file, const char *name, size_t n, const double *value)
{
    fprintf(file, "\"%s\": ", name);
    for (size_t i = 0; i < n; i++) {
        fputs(n == 1 ? "" : i ? ", " : "[", file);
        output_json_number(file, value[i]);
    }
    fputs(n == 1 ? "" : "]", file);
}

void output_body_name(char name[OUTPUT_BODY_NAME], uint32_t number, const char *suffix)
{
    snprintf(name, OUTPUT_BODY_NAME, "body-%u.obj%s", number - 1, suffix);
}

void output_pose_name(char name[OUTPUT_BODY_NAME], uint32_t number)
{
    snprintf(name, OUTPUT_BODY_NAME, "body-%u.pc2", number - 1);
}

static void put_shape(FILE *file, const struct contact_shape *shape, const bool *posed)
{
    const struct contact_kind *kind = contact_kinds[shape->kind];
    const double *value = shape->value;
    fprintf(file, "{\"%s\": {", kind->name);
    for (const struct contact_parameter *p = kind->parameter; p->name; p++) {
        const size_t n = contact_role_size(p->role);
        fputs(p == kind->parameter ? "" : ", ", file);
        files_obstacles_put_numbers(file, p->name, n, value);
        value += n;
    }
    if (shape->body) {
        char name[OUTPUT_BODY_NAME];
        output_body_name(name, shape->body, "");
        fprintf(file, "\"obj\": \"%s\"", name);
    }
    if (shape->body && posed && posed[shape->body - 1]) {
        char name[OUTPUT_BODY_NAME];
        output_pose_name(name, shape->body);
        fprintf(file, ", \"pc2\": \"%s\"", name);
    }
    fputc('}', file);
}

static void put_motion(FILE *file, const struct contact_shape *shape, const struct phys_key *keys)
{
    fputs(", ", file);
    files_obstacles_put_numbers(file, "about", 3, shape->about);
    fputs(", \"keys\": [", file);
    for (uint32_t i = 0; i < shape->n; i++) {
        const struct phys_key *key = keys + shape->first + i;
        fputs(i ? ",\n      {" : "\n      {", file);
        files_obstacles_put_numbers(file, "time", 1, &key->time);
        fputs(", ", file);
        files_obstacles_put_numbers(file, "translate", 3, key->translate);
        fputs(", ", file);
        files_obstacles_put_numbers(file, "rotate", 4, key->rotate);
        fputc('}', file);
    }
    fputc(']', file);
}

void output_obstacles(FILE *file, size_t n, const struct contact_shape *obstacles,
                      const struct phys_key *keys, const bool *posed)
{
    fputc('[', file);
    for (size_t i = 0; i < n; i++) {
        fputs(i ? ",\n    " : "\n    ", file);
        put_shape(file, obstacles + i, posed);
        if (obstacles[i].n)
            put_motion(file, obstacles + i, keys);
        fputc('}', file);
    }
    fputs(n ? "\n  ]" : "]", file);
}

/* ---- Reading ---- */

static void files_obstacles_take_numbers(struct output_json *json, const char *name, size_t n,
                                         double *value)
{
    if (!output_json_key(json, name)) {
        char what[40];
        snprintf(what, sizeof what, "\"%s\"", name);
        output_json_fail(json, what);
    }
    if (n > 1)
        output_json_expect(json, '[');
    for (size_t i = 0; i < n; i++) {
        if (i)
            output_json_expect(json, ',');
        value[i] = output_json_double(json);
    }
    if (n > 1)
        output_json_expect(json, ']');
}

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
static void files_obstacles_take_body(struct output_cache *cache, struct output_json *json,
                                      struct contact_shape *shape)
{
    char name[OUTPUT_BODY_NAME];
    shape->body = ++cache->n_bodies;
    output_body_name(name, shape->body, "");
    if (!output_json_key(json, "obj"))
        output_json_fail(json, "\"obj\"");
    else if (!output_json_word(json, name))
        output_json_fail(json, "the file of the next body: \"body-K.obj\", K from 0");
    bool *posed = realloc(cache->posed, cache->n_bodies);
    if (!posed) {
        output_json_fail(json, "fewer bodies than fit in memory");
        return;
    }
    cache->posed = posed;
    posed[cache->n_bodies - 1] = output_json_take(json, ',');
    output_pose_name(name, shape->body);
    if (posed[cache->n_bodies - 1] &&
        (!output_json_key(json, "pc2") || !output_json_word(json, name)))
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
    output_json_expect(json, '{');
    for (const struct contact_parameter *p = kind->parameter; p->name; p++) {
        if (p != kind->parameter)
            output_json_expect(json, ',');
        files_obstacles_take_numbers(json, p->name, contact_role_size(p->role), value);
        check_role(json, p, value);
        value += contact_role_size(p->role);
    }
    if (kind == &contact_body_kind)
        files_obstacles_take_body(cache, json, shape);
    output_json_expect(json, '}');
}

static void take_key(struct output_json *json, struct phys_key *key)
{
    const struct contact_parameter rotation = {"rotate", CONTACT_ROTATION};
    output_json_expect(json, '{');
    files_obstacles_take_numbers(json, "time", 1, &key->time);
    output_json_expect(json, ',');
    files_obstacles_take_numbers(json, "translate", 3, key->translate);
    output_json_expect(json, ',');
    files_obstacles_take_numbers(json, "rotate", 4, key->rotate);
    check_role(json, &rotation, key->rotate);
    output_json_expect(json, '}');
}

static void take_motion(struct output_cache *cache, struct output_json *json,
                        struct contact_shape *shape)
{
    files_obstacles_take_numbers(json, "about", 3, shape->about);
    output_json_expect(json, ',');
    if (!output_json_key(json, "keys"))
        output_json_fail(json, "\"keys\"");
    output_json_expect(json, '[');
    shape->first = cache->n_keys;
    do {
        struct phys_key *grown = realloc(cache->keys, (cache->n_keys + 1) * sizeof *grown);
        if (!grown) {
            output_json_fail(json, "fewer keys than fit in memory");
            return;
        }
        cache->keys = grown;
        take_key(json, grown + cache->n_keys);
        if (shape->n && !(grown[cache->n_keys].time > grown[cache->n_keys - 1].time))
            output_json_fail(json, "times in ascending order");
        cache->n_keys++;
        shape->n++;
    } while (output_json_take(json, ','));
    output_json_expect(json, ']');
}

void output_obstacles_read(struct output_cache *cache, struct output_json *json)
{
    output_json_expect(json, '[');
    if (output_json_take(json, ']'))
        return;
    do {
        struct contact_shape *grown =
            realloc(cache->obstacles, (cache->n_obstacles + 1) * sizeof *grown);
        if (!grown) {
            output_json_fail(json, "fewer obstacles than fit in memory");
            return;
        }
        cache->obstacles = grown;
        struct contact_shape *shape = grown + cache->n_obstacles++;
        take_shape(cache, json, shape);
        if (output_json_take(json, ','))
            take_motion(cache, json, shape);
        output_json_expect(json, '}');
    } while (output_json_take(json, ','));
    output_json_expect(json, ']');
}
