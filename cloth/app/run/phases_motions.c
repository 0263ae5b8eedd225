/* Keys of each obstacle in ascending order of time, a phase after the other: where it is at the
 * begin, its keys, and where it is at the end. If it jumps between two phases, the key after the
 * jump is at the next number after their common time, so that the frame there shows the end. */
#include "cloth/app/run/phases.h"
#include "cloth/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

static void phases_motions_add(struct course *to, struct phys_key key, double time)
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
    phases_motions_add(to, key_at(model, shape, 0), begin);
    for (uint32_t i = 0; i < shape->n; i++) {
        const struct phys_key *key = &model->keys[shape->first + i];
        if (key->time > 0 && key->time < seconds)
            phases_motions_add(to, *key, begin + key->time);
    }
    if (!isinf(seconds))
        phases_motions_add(to, key_at(model, shape, seconds), begin + seconds);
}

/* Begins are added up as the runs count the times of their frames. */
static void phases_motions_add_phases(struct course *to, const struct phases *phases,
                                      uint32_t obstacle)
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
static uint32_t phases_motions_take(const struct phases *phases, uint32_t obstacle, uint32_t first,
                                    struct phases_motions *motions)
{
    struct contact_shape *shape = motions->obstacles + obstacle;
    struct course course = {motions->keys + first, 0};
    bool moves = false;
    for (uint32_t p = 0; p <= phases->now; p++) {
        const struct contact_shape *of = phases->models[p].obstacles + obstacle;
        if (of->n)
            memcpy(shape->about, of->about, sizeof of->about);
        moves = moves || of->n;
    }
    if (moves)
        phases_motions_add_phases(&course, phases, obstacle);
    shape->first = first;
    shape->n = course.n;
    return first + course.n;
}

int phases_motions(const struct phases *phases, struct phases_motions *motions,
                   struct cloth_error *error)
{
    const struct model *model = phases_model(phases);
    size_t room = 0;
    for (uint32_t p = 0; p <= phases->now; p++)
        room += phases->models[p].n_keys + 2 * (size_t)model->n_obstacles;
    *motions = (struct phases_motions){0};
    motions->obstacles = cloth_alloc(model->n_obstacles, sizeof *motions->obstacles, error);
    motions->keys = cloth_alloc(room, sizeof *motions->keys, error);
    if (!motions->obstacles || !motions->keys)
        return CLOTH_E_MEMORY;
    uint32_t n = 0;
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        motions->obstacles[i] = model->obstacles[i];
        n = phases_motions_take(phases, i, n, motions);
    }
    return CLOTH_OK;
}

void phases_motions_free(struct phases_motions *motions)
{
    free(motions->obstacles);
    free(motions->keys);
    *motions = (struct phases_motions){0};
}
