/* Checkpoints: what they have beside the state of the flow, and the thread that writes them.
 *
 * The second part of one is struct saved, a struct phase_done of each phase, then numbers: the
 * start of the phase, 6 a vertex; the drape test's frame, 3 a vertex of its cloth. The thread
 * sleeps until there is something to write. `busy`, under the lock, says that the thread has the
 * parts. */
#include "cloth/app/run/checkpoints.h"

#include "cloth/app/run/outputs.h"
#include "cloth/base/clock.h"
#include "cloth/output/output.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct saved {
    uint32_t now, n_phases;
    uint64_t n_start, n_drape; /* numbers */
    struct flow_report total;
    struct intersections_found found;
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
    return (const double *)((const struct phase_done *)phases_in(restart) + saved->n_phases);
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
        part->n != sizeof *saved + saved->n_phases * sizeof(struct phase_done) +
                       (saved->n_start + saved->n_drape) * sizeof(double) ||
        !memchr(saved->total.contact_pinch, 0, sizeof saved->total.contact_pinch))
        return restart_refuse(restart, error);
    return CLOTH_OK;
}

static int check_end(const struct restart *restart, const struct phases *phases, uint32_t i,
                     double end, struct cloth_error *error)
{
    const double now = phases->models[i].end;
    if (!(now < end) && !(now > end))
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s: phase '%.60s' is over, and ended at %g s: time.end of it cannot be %g s",
                      restart->checkpoint.path, phases_label(phases, i), end, now);
}

static int take_phases(const struct restart *restart, struct phases *phases,
                       struct cloth_error *error)
{
    struct saved saved;
    int code = open_saved(restart, &saved, error);
    if (!code && saved.n_phases != phases->n)
        code = restart_refuse(restart, error);
    const struct phase_done *of = phases_in(restart);
    for (uint32_t i = 0; !code && i < saved.now; i++) {
        code = check_end(restart, phases, i, of[i].end, error);
        if (!code && (!*of[i].ended || !memchr(of[i].ended, 0, sizeof of[i].ended)))
            code = restart_refuse(restart, error);
        phases->done[i] = of[i];
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
    if (saved.n_drape != to->drape.n)
        return restart_refuse(restart, error);
    if (to->drape.n)
        memcpy(to->drape.position, numbers_in(restart, &saved) + saved.n_start,
               saved.n_drape * sizeof(double));
    return CLOTH_OK;
}

/* ---- The keeper ---- */

struct keeper {
    const struct outputs *of; /* its files and settings outlive the keeper */
    struct output_checkpoints *checkpoints;
    double next; /* s: when the next one is due */
    struct output_part part[OUTPUT_CHECKPOINT_PARTS];
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool asked;  /* one is due, and was not taken yet */
    bool busy;   /* one is to be written */
    bool ending; /* the thread is to end */
    bool warned;
};

/* ---- Its thread ---- */

static void keeper_warn(struct keeper *keeper, const char *why)
{
    const char *last = output_checkpoints_last(keeper->checkpoints);
    if (!keeper->warned)
        fprintf(stderr,
                "duite-cloth: warning: %s; the run goes on, and the last checkpoint is %s (this is "
                "said once)\n",
                why, last ? last : "that of before the run, if there is one");
    keeper->warned = true;
}

/* Frames and rows of probes before it are on the disk first. */
static void write_one(struct keeper *keeper)
{
    struct cloth_error error = {0};
    if (!keeper->part[1].bytes || !keeper->part[2].bytes)
        cloth_fail(&error, CLOTH_E_MEMORY, "no memory for a checkpoint");
    else if (!output_settler_wait(keeper->of->settler, &error) &&
             !output_probes_sync(keeper->of->options->output, &error))
        output_checkpoints_write(keeper->checkpoints, keeper->part, &error);
    if (error.code)
        keeper_warn(keeper, error.text);
    for (int i = 1; i < OUTPUT_CHECKPOINT_PARTS; i++) {
        free((void *)keeper->part[i].bytes);
        keeper->part[i] = (struct output_part){0};
    }
}

static void *keeper_run(void *context)
{
    struct keeper *keeper = context;
    pthread_mutex_lock(&keeper->lock);
    while (keeper->busy || !keeper->ending) {
        if (!keeper->busy) {
            pthread_cond_wait(&keeper->changed, &keeper->lock);
            continue;
        }
        pthread_mutex_unlock(&keeper->lock);
        write_one(keeper);
        pthread_mutex_lock(&keeper->lock);
        keeper->busy = false;
        pthread_cond_broadcast(&keeper->changed);
    }
    pthread_mutex_unlock(&keeper->lock);
    return NULL;
}

/* ---- For the run ---- */

static int keeper_start(struct keeper *keeper, struct cloth_error *error)
{
    pthread_mutex_init(&keeper->lock, NULL);
    pthread_cond_init(&keeper->changed, NULL);
    const int failed = pthread_create(&keeper->thread, NULL, keeper_run, keeper);
    if (!failed)
        return CLOTH_OK;
    pthread_mutex_destroy(&keeper->lock);
    pthread_cond_destroy(&keeper->changed);
    return cloth_fail(error, CLOTH_E_LIBRARY, "no thread to write checkpoints: %s",
                      strerror(failed));
}

int keeper_open(struct keeper **keeper, const struct outputs *of, struct cloth_error *error)
{
    struct keeper *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for checkpoints");
    made->of = of;
    made->next = cloth_seconds() + of->options->checkpoint;
    made->part[0] = (struct output_part){of->settings, strlen(of->settings)};
    int code = output_checkpoints_open(&made->checkpoints, of->options->output, error);
    code = code ? code : keeper_start(made, error);
    if (!code) {
        *keeper = made;
        return CLOTH_OK;
    }
    output_checkpoints_close(&made->checkpoints);
    free(made);
    return code;
}

int keeper_due(struct keeper *keeper)
{
    pthread_mutex_lock(&keeper->lock);
    const bool due = !keeper->asked && !keeper->busy && cloth_seconds() >= keeper->next;
    keeper->asked = keeper->asked || due;
    pthread_mutex_unlock(&keeper->lock);
    return due;
}

void keeper_close(struct keeper **keeper)
{
    struct keeper *gone = *keeper;
    *keeper = NULL;
    if (!gone)
        return;
    pthread_mutex_lock(&gone->lock);
    gone->ending = true;
    pthread_cond_broadcast(&gone->changed);
    pthread_mutex_unlock(&gone->lock);
    pthread_join(gone->thread, NULL);
    pthread_mutex_destroy(&gone->lock);
    pthread_cond_destroy(&gone->changed);
    output_checkpoints_close(&gone->checkpoints);
    free(gone);
}

/* ---- Writing ---- */

static struct output_part pack(const struct outputs *of)
{
    const struct phases *phases = of->phases;
    const struct saved saved = {.now = phases->now,
                                .n_phases = phases->n,
                                .n_start = phases->now ? phases_numbers(phases) : 0,
                                .n_drape = of->drape.n,
                                .total = phases->total,
                                .found = of->found};
    const size_t n_phases = phases->n * sizeof(struct phase_done);
    const size_t n = sizeof saved + n_phases + (saved.n_start + saved.n_drape) * sizeof(double);
    unsigned char *bytes = calloc(n, 1);
    if (!bytes)
        return (struct output_part){0};
    memcpy(bytes, &saved, sizeof saved);
    memcpy(bytes + sizeof saved, phases->done, n_phases);
    double *numbers = (void *)(bytes + sizeof saved + n_phases);
    if (saved.n_start)
        memcpy(numbers, phases->start, saved.n_start * sizeof *numbers);
    if (of->drape.n)
        memcpy(numbers + saved.n_start, of->drape.position, saved.n_drape * sizeof *numbers);
    return (struct output_part){bytes, n};
}

void restart_save(void *context, struct flow_checkpoint state)
{
    const struct outputs *of = context;
    struct keeper *keeper = of->keeper;
    const struct output_part program = pack(of);
    pthread_mutex_lock(&keeper->lock);
    while (keeper->busy)
        pthread_cond_wait(&keeper->changed, &keeper->lock);
    keeper->part[1] = program;
    keeper->part[2] = (struct output_part){state.bytes, state.n};
    keeper->busy = true;
    keeper->asked = false;
    keeper->next = cloth_seconds() + of->options->checkpoint;
    pthread_cond_broadcast(&keeper->changed);
    pthread_mutex_unlock(&keeper->lock);
}
