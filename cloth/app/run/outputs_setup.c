/* The setup borrows from the models, and owns what it combines from several phases.
 *
 * Keys of each obstacle in ascending order of time, a phase after the other: where it is at the
 * begin, its keys, and where it is at the end. If it jumps between two phases, the key after the
 * jump is at the next number after their common time, so that the frame there shows the end. */
#include "cloth/app/run/outputs_setup.h"

#include "cloth/base/memory.h"
#include "cloth/base/sets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Motions ---- */

static const struct phys_key still = {.rotate = {1, 0, 0, 0}};

/* The key of a shape at a time of the model's phase, as cloth/physics/motion.h has it. */
static struct phys_key key_at(const struct model *model, const struct contact_shape *shape,
                              double time)
{
    if (!shape->n)
        return still;
    const struct phys_key *key = model->keys + shape->first, *end = key + shape->n;
    while (key < end && key->time <= time)
        key++;
    if (key == model->keys + shape->first)
        return *key;
    if (key == end)
        return key[-1];
    const struct phys_key *a = key - 1, *b = key;
    const double part = (time - a->time) / (b->time - a->time);
    struct phys_key at = *a;
    double cosine = 0;
    for (int c = 0; c < 4; c++)
        cosine += a->rotate[c] * b->rotate[c];
    for (int c = 0; c < 4; c++)
        at.rotate[c] += part * ((cosine < 0 ? -b->rotate[c] : b->rotate[c]) - a->rotate[c]);
    double square = 0;
    for (int c = 0; c < 4; c++)
        square += at.rotate[c] * at.rotate[c];
    for (int c = 0; c < 4; c++)
        at.rotate[c] /= sqrt(square);
    for (int c = 0; c < 3; c++)
        at.translate[c] += part * (b->translate[c] - a->translate[c]);
    return at;
}

static bool same_place(const struct phys_key *a, const struct phys_key *b)
{
    return !memcmp(a->translate, b->translate, sizeof a->translate) &&
           !memcmp(a->rotate, b->rotate, sizeof a->rotate);
}

/* Keys of one obstacle, so far. */
struct course {
    struct phys_key *key;
    uint32_t n;
};

static void outputs_add_key(struct course *to, struct phys_key key, double time)
{
    const struct phys_key *last = to->n ? to->key + to->n - 1 : NULL;
    key.time = time;
    if (last && last->time >= time) {
        if (same_place(last, &key))
            return;
        key.time = nextafter(last->time, INFINITY);
    }
    to->key[to->n++] = key;
}

/* A phase that begins at a time, of so many seconds. */
static void add_phase(struct course *to, const struct model *model, uint32_t obstacle, double begin,
                      double seconds)
{
    const struct contact_shape *shape = model->obstacles + obstacle;
    outputs_add_key(to, key_at(model, shape, 0), begin);
    for (uint32_t i = 0; i < shape->n; i++) {
        const struct phys_key *key = &model->keys[shape->first + i];
        if (key->time > 0 && key->time < seconds)
            outputs_add_key(to, *key, begin + key->time);
    }
    if (!isinf(seconds))
        outputs_add_key(to, key_at(model, shape, seconds), begin + seconds);
}

/* Begins are added up as the runs count the times of their frames. */
static void follow_phases(struct course *to, const struct phases *phases, uint32_t obstacle)
{
    double begin = 0;
    for (uint32_t p = 0; p <= phases->now; p++) {
        const double seconds =
            p < phases->now ? phases->done[p].simulated_seconds : (double)INFINITY;
        add_phase(to, phases->models + p, obstacle, begin, seconds);
        begin += seconds;
    }
}

/* The shape and the motion of an obstacle, behind those of the ones before it. */
static uint32_t outputs_add_motion(const struct phases *phases, uint32_t obstacle, uint32_t first,
                                   struct outputs_setup *made)
{
    struct contact_shape *shape = made->obstacles + obstacle;
    struct course course = {made->keys + first, 0};
    bool moves = false;
    for (uint32_t p = 0; p <= phases->now; p++) {
        const struct contact_shape *of = phases->models[p].obstacles + obstacle;
        if (of->n)
            memcpy(shape->about, of->about, sizeof of->about);
        moves = moves || of->n;
    }
    if (moves)
        follow_phases(&course, phases, obstacle);
    shape->first = first;
    shape->n = course.n;
    return first + course.n;
}

static int add_motions(struct outputs_setup *made, const struct phases *phases,
                       struct cloth_error *error)
{
    const struct model *model = phases_model(phases);
    size_t room = 0;
    for (uint32_t p = 0; p <= phases->now; p++)
        room += phases->models[p].n_keys + 2 * (size_t)model->n_obstacles;
    made->setup.obstacles = made->obstacles =
        cloth_alloc(model->n_obstacles, sizeof *made->obstacles, error);
    made->setup.keys = made->keys = cloth_alloc(room, sizeof *made->keys, error);
    uint32_t n = 0;
    for (uint32_t i = 0; i < model->n_obstacles && !error->code; i++) {
        made->obstacles[i] = model->obstacles[i];
        n = outputs_add_motion(phases, i, n, made);
    }
    return error->code;
}

/* ---- Seams ---- */

/* Joins the vertices that seams pulled in any phase so far; none did: nothing is joined. */
static int outputs_add_seams(struct outputs_setup *made, const struct phases *phases,
                             struct cloth_error *error)
{
    const uint32_t n = made->all.n_vertices;
    made->all.joined = NULL;
    for (uint32_t i = 0; i <= phases->now; i++) {
        const uint32_t *of = phases->models[i].contact.apart.joined;
        if (of && !made->joined) {
            made->all.joined = made->joined = cloth_alloc(n, sizeof *made->joined, error);
            if (!made->joined)
                return CLOTH_E_MEMORY;
            cloth_sets_start(made->joined, n);
        }
        for (uint32_t v = 0; v < n && of; v++)
            cloth_sets_join(made->joined, v, of[v]);
    }
    for (uint32_t v = 0; v < n && made->joined; v++)
        made->joined[v] = cloth_sets_root(made->joined, v);
    return CLOTH_OK;
}

/* ---- In all ---- */

/* Marks the bodies that change their shape in any phase; to be freed. NULL: no memory. */
static bool *find_posed(const struct phases *phases, struct cloth_error *error)
{
    const uint32_t n = phases->models->bodies.n;
    bool *posed = cloth_alloc(n, sizeof *posed, error);
    for (uint32_t p = 0; posed && p < phases->n; p++)
        for (uint32_t i = 0; i < n; i++)
            posed[i] |= contact_bodies_at(&phases->models[p].bodies, i + 1)->n_frames > 0;
    return posed;
}

static int find_cloths(struct outputs_setup *made, const struct model *model,
                       struct cloth_error *error)
{
    made->meshes = cloth_alloc(model->n_cloths, sizeof *made->meshes, error);
    made->names = cloth_alloc(model->n_cloths, sizeof *made->names, error);
    if (!made->meshes || !made->names)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < model->n_cloths; i++) {
        made->meshes[i] = &model->cloths[i].mesh;
        made->names[i] = model->cloths[i].name;
    }
    return CLOTH_OK;
}

int outputs_setup_make(struct outputs_setup *made, const struct simulate_options *options,
                       const struct phases *phases, const struct contact_apart *apart,
                       struct cloth_error *error)
{
    const struct model *model = phases_model(phases);
    *made = (struct outputs_setup){.all = *apart};
    int code = find_cloths(made, model, error);
    made->posed = code ? NULL : find_posed(phases, error);
    code = error->code;
    made->setup = (struct output_setup){.folder = options->output,
                                        .n_meshes = model->n_cloths,
                                        .meshes = made->meshes,
                                        .names = made->names,
                                        .fps = model->fps,
                                        .n_obstacles = model->n_obstacles,
                                        .obstacles = model->obstacles,
                                        .keys = model->keys,
                                        .bodies = &model->bodies,
                                        .posed = made->posed,
                                        .apart = &made->all,
                                        .n_inputs = model->n_files,
                                        .inputs = (const char *const *)model->files};
    if (code || !phases->now)
        return code;
    code = add_motions(made, phases, error);
    return code ? code : outputs_add_seams(made, phases, error);
}

void outputs_setup_free(struct outputs_setup *made)
{
    free(made->obstacles);
    free(made->keys);
    free(made->joined);
    free(made->meshes);
    free(made->names);
    free(made->posed);
}
