/* A round of a recorded graph as the input of the runtime's passes (plan/passes.h), from the words
 * of a trace. Hosts get the same nodes as in a run (part.c). */
#include "tools/predict/program.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

/* The bytes of a record's objects, and of a flag that is none of them. NULL without memory. */
static size_t *round_bytes(const struct predict_program *p, const struct predict_recorded *recorded,
                           uint32_t flag, size_t *n, uint32_t *place)
{
    struct predict_object *all = p->graph->object;
    size_t *bytes = base_alloc_zero((recorded->n_objects + 2) * sizeof *bytes);
    *n = recorded->n_objects;
    for (uint32_t i = 0; i < *n && bytes; i++) {
        all[recorded->bound[i]].place = i + 1;
        bytes[i] = all[recorded->bound[i]].bytes;
    }
    *place = PLAN_NONE;
    if (flag != PREDICT_NONE && bytes) {
        *place = all[flag].place ? all[flag].place - 1 : (uint32_t)(*n)++;
        bytes[*place] = all[flag].bytes;
    }
    for (uint32_t i = 0; i < recorded->n_objects; i++)
        all[recorded->bound[i]].place = 0;
    return bytes;
}

/* ---- A round for hosts ---- */

/* How a round begins and ends with an object. */
struct round_ends {
    bool touched, leads, trails; /* leads, trails: with contributions */
};

static void ends_note(struct round_ends *ends, bool contributes)
{
    ends->leads |= contributes && !ends->touched;
    ends->trails = contributes;
    ends->touched = true;
}

/* True if contributions of one round and of the next make one sum, or a flag waits for
 * contributions to be continued. Such rounds are forked, as plan_replay_split has it. */
static bool source_is_forked(const struct plan_source *source, struct round_ends *ends)
{
    bool forked = false;
    for (size_t i = 0; i < source->n_forks; i++) {
        const struct plan_source_fork *fork = &source->fork[i];
        const struct plan_access *access = source->access + fork->first;
        for (uint32_t k = 0; k < fork->n; k++)
            ends_note(&ends[access[k].object], access[k].mode == DUITE_CW);
    }
    for (uint32_t i = 0; i < source->n_objects; i++) {
        const bool flagged = source->flag != PLAN_NONE;
        forked |= ends[i].leads && (ends[i].trails || flagged);
        forked |= ends[i].trails && flagged && source->flag != i;
    }
    return forked;
}

void predict_round_free(struct predict_round *round)
{
    if (!round)
        return;
    predict_parts_free(round);
    plan_assignment_free(&round->assignment);
    plan_round_free(&round->lowered);
    base_free(round->source.bytes);
    base_free(round->home);
    base_free(round);
}

/* True if the round that is there is the wanted one. */
static bool round_fits(const struct predict_round *there, const struct predict_round *wanted)
{
    const struct plan_source *a = &there->source, *b = &wanted->source;
    bool fits =
        a->n_objects == b->n_objects && a->flag == b->flag && there->n_hints == wanted->n_hints;
    for (size_t i = 0; i < b->n_objects && fits; i++)
        fits = a->bytes[i] == b->bytes[i] && there->home[i] == wanted->home[i];
    return fits;
}

static bool round_compile(const struct predict_program *p, const struct predict_recorded *recorded,
                          struct predict_round *round)
{
    const struct plan_source *source = &round->source;
    struct round_ends *ends = base_alloc_zero((source->n_objects + 1) * sizeof *ends);
    round->forked = p->graph->plain || (ends && source_is_forked(source, ends));
    base_free(ends);
    if (!ends || round->forked)
        return ends;
    return plan_lower(&round->lowered, source) &&
           plan_assign(&round->assignment, &round->lowered, round->home,
                       (int)p->graph->cluster->hosts) &&
           predict_parts_make(p, recorded, round);
}

bool predict_round_prepare(struct predict_program *p, struct predict_recorded *recorded,
                           uint32_t flag)
{
    struct predict_round *round = base_alloc_zero(sizeof *round);
    bool fine = round;
    if (fine) {
        struct plan_source *source = &round->source;
        *source = recorded->source;
        source->bytes = round_bytes(p, recorded, flag, &source->n_objects, &source->flag);
        round->home = base_alloc((recorded->n_objects + 2) * sizeof *round->home);
        round->flag = flag;
        round->n_hints = p->graph->n_hints;
        fine = source->bytes && round->home;
        for (size_t i = 0; i < source->n_objects && fine; i++)
            round->home[i] =
                p->graph->object[i < recorded->n_objects ? recorded->bound[i] : flag].home;
    }
    if (fine && recorded->round && round_fits(recorded->round, round)) {
        recorded->round->flag = flag;
        predict_round_free(round);
        return true;
    }
    fine = fine && round_compile(p, recorded, round);
    p->graph->failed |= !fine;
    predict_round_free(recorded->round);
    recorded->round = round;
    return fine;
}
