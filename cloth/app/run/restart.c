/* The second part of a checkpoint is struct saved, a struct saved_phase of each phase, then
 * numbers: the start of the phase, 6 a vertex; the drape test's frame, 3 a vertex of its cloth. */
#include "cloth/app/run/restart.h"

#include "cloth/app/run/keeper.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct saved {
    uint32_t now, n_phases;
    uint64_t n_start, n_drape; /* numbers */
    struct flow_report total;
    struct untangle_result untangled;
    struct intersections_found found;
};
struct saved_phase {
    uint64_t steps;
    double cg_iterations_mean, simulated_seconds, wall_seconds, end;
    char ended[16]; /* empty: it is not over */
};

/* ---- Reading ---- */

static int restart_refuse(const struct restart *restart, struct cloth_error *error)
{
    return cloth_fail(error, CLOTH_E_INPUT, "%s does not fit this scene", restart->checkpoint.path);
}

static const void *phases_in(const struct restart *restart)
{
    return (const struct saved *)restart->checkpoint.part[1].bytes + 1;
}

static const double *numbers_in(const struct restart *restart, const struct saved *saved)
{
    return (const double *)((const struct saved_phase *)phases_in(restart) + saved->n_phases);
}

/* Its sizes agree, and its text ends. */
static int open_saved(const struct restart *restart, struct saved *saved, struct cloth_error *error)
{
    const struct output_part *part = restart->checkpoint.part + 1;
    if (part->n < sizeof *saved)
        return restart_refuse(restart, error);
    memcpy(saved, part->bytes, sizeof *saved);
    const uint64_t most = part->n / sizeof(double);
    if (saved->n_start > most || saved->n_drape > most || saved->now >= saved->n_phases ||
        part->n != sizeof *saved + saved->n_phases * sizeof(struct saved_phase) +
                       (saved->n_start + saved->n_drape) * sizeof(double) ||
        !memchr(saved->total.contact_pinch, 0, sizeof saved->total.contact_pinch))
        return restart_refuse(restart, error);
    return CLOTH_OK;
}

/* NULL: it is none of them. */
static const char *word_of(const char ended[16])
{
    static const char *const words[] = {"stopped", "sewn", "end", "rest"};
    const char *found = NULL;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strncmp(words[i], ended, 16))
            found = words[i];
    return found;
}

static int check_end(const struct restart *restart, const struct phases *phases, uint32_t i,
                     double end, struct cloth_error *error)
{
    const double now = phases->models[i].end;
    if (!(now < end) && !(now > end))
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s: phase '%.60s' is over, and ended at %g s: time.end of it cannot be %g s",
                      restart->checkpoint.path, phases->done[i].name, end, now);
}

static int take_phases(const struct restart *restart, struct phases *phases,
                       struct cloth_error *error)
{
    struct saved saved;
    int code = open_saved(restart, &saved, error);
    if (!code && saved.n_phases != phases->n)
        code = restart_refuse(restart, error);
    const struct saved_phase *of = phases_in(restart);
    for (uint32_t i = 0; i < saved.now && !code; i++) {
        struct phase_done *done = phases->done + i;
        code = check_end(restart, phases, i, of[i].end, error);
        done->steps = of[i].steps;
        done->cg_iterations_mean = of[i].cg_iterations_mean;
        done->simulated_seconds = of[i].simulated_seconds;
        done->wall_seconds = of[i].wall_seconds;
        done->ended = word_of(of[i].ended);
        if (!code && !done->ended)
            code = restart_refuse(restart, error);
    }
    if (code)
        return code;
    phases->now = saved.now;
    phases->total = saved.total;
    if (!saved.now)
        return CLOTH_OK;
    if (saved.n_start != phases_numbers(phases))
        return restart_refuse(restart, error);
    return phases_start(phases, numbers_in(restart, &saved), error);
}

int restart_read(struct restart *restart, const char *folder, struct phases *phases,
                 struct cloth_error *error)
{
    struct cloth_error note = {0};
    struct output_checkpoint *from = &restart->checkpoint;
    int code = output_checkpoint_newest(from, folder, &note, error);
    if (code)
        return code;
    if (note.code)
        fprintf(stderr, "duite-cloth: warning: %s; the one before it is used: %s\n", note.text,
                from->path);
    char *settings = phases_settings(phases, error);
    code = settings
               ? phases_compare(from->path, settings, from->part[0].bytes, from->part[0].n, error)
               : error->code;
    free(settings);
    return code ? code : take_phases(restart, phases, error);
}

int restart_resume(struct restart *restart, struct flow *flow, struct cloth_error *error)
{
    const struct output_part *part = restart->checkpoint.part + 2;
    const struct flow_checkpoint from = {(unsigned char *)part->bytes, part->n};
    struct cloth_error why = {0};
    if (flow_resume(flow, from, &restart->at, &why))
        return cloth_fail(error, why.code, "%s: %s", restart->checkpoint.path, why.text);
    return CLOTH_OK;
}

int restart_outputs(const struct restart *restart, struct outputs *to, struct cloth_error *error)
{
    struct saved saved;
    const int code = open_saved(restart, &saved, error);
    if (code)
        return code;
    to->found = saved.found;
    if (saved.n_drape != (to->drape ? drape_numbers(to->drape) : 0))
        return restart_refuse(restart, error);
    if (to->drape)
        drape_set(to->drape, numbers_in(restart, &saved) + saved.n_start);
    return CLOTH_OK;
}

void restart_free(struct restart *restart)
{
    output_checkpoint_free(&restart->checkpoint);
}

/* ---- Writing ---- */

static void put_phases(const struct phases *phases, struct saved_phase *to)
{
    for (uint32_t i = 0; i < phases->n; i++) {
        const struct phase_done *done = phases->done + i;
        to[i] = (struct saved_phase){.steps = done->steps,
                                     .cg_iterations_mean = done->cg_iterations_mean,
                                     .simulated_seconds = done->simulated_seconds,
                                     .wall_seconds = done->wall_seconds,
                                     .end = phases->models[i].end};
        if (done->ended)
            snprintf(to[i].ended, sizeof to[i].ended, "%s", done->ended);
    }
}

static struct output_part pack(const struct outputs *of)
{
    const struct phases *phases = of->phases;
    const struct saved saved = {.now = phases->now,
                                .n_phases = phases->n,
                                .n_start = phases->now ? phases_numbers(phases) : 0,
                                .n_drape = of->drape ? drape_numbers(of->drape) : 0,
                                .total = phases->total,
                                .untangled = *of->untangled,
                                .found = outputs_found(of)};
    const size_t n_phases = phases->n * sizeof(struct saved_phase);
    const size_t n = sizeof saved + n_phases + (saved.n_start + saved.n_drape) * sizeof(double);
    unsigned char *bytes = calloc(n, 1);
    if (!bytes)
        return (struct output_part){0};
    memcpy(bytes, &saved, sizeof saved);
    put_phases(phases, (void *)(bytes + sizeof saved));
    double *numbers = (void *)(bytes + sizeof saved + n_phases);
    if (saved.n_start)
        memcpy(numbers, phases->start, saved.n_start * sizeof *numbers);
    if (of->drape)
        drape_get(of->drape, numbers + saved.n_start);
    return (struct output_part){bytes, n};
}

void restart_save(void *context, struct flow_checkpoint state)
{
    struct outputs *of = context;
    keeper_take(of->keeper, pack(of), (struct output_part){state.bytes, state.n});
}
