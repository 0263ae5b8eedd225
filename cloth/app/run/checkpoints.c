/* Checkpoints: what they have beside the state of the flow, and their turn among the frames that go
 * to the disk.
 *
 * The second part of one is struct saved, a struct phase_done of each phase, then numbers: the
 * start of the phase, 6 a vertex; the drape test's frame, 3 a vertex of its cloth. While `busy` the
 * settler's thread has the parts. */
#include "cloth/app/run/checkpoints.h"

#include "cloth/app/run/outputs.h"
#include "cloth/base/clock.h"
#include "cloth/output/output.h"
#include "cloth/output/settle.h"

#include <stdatomic.h>
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
    struct output_member member; /* of the settler, behind all frames */
    uint32_t given;              /* to it */
    struct output_part part[OUTPUT_CHECKPOINT_PARTS];
    double next;       /* s: when the next one is due; it stays while `asked` or `busy` */
    atomic_bool asked; /* one is due, and was not taken yet */
    atomic_bool busy;  /* one is to be written */
    bool warned;
};

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

static void keeper_drop_parts(struct keeper *keeper)
{
    for (int i = 1; i < OUTPUT_CHECKPOINT_PARTS; i++) {
        free((void *)keeper->part[i].bytes);
        keeper->part[i] = (struct output_part){0};
    }
}

/* Frames before it are on the disk; rows of probes follow here. */
static int keeper_settle(void *context, uint32_t n, struct cloth_error *error)
{
    struct keeper *keeper = context;
    struct cloth_error why = {0};
    (void)n, (void)error;
    if (!keeper->part[1].bytes || !keeper->part[2].bytes)
        cloth_fail(&why, CLOTH_E_MEMORY, "no memory for a checkpoint");
    else if (!output_probes_sync(keeper->of->options->output, &why))
        output_checkpoints_write(keeper->checkpoints, keeper->part, &why);
    if (why.code)
        keeper_warn(keeper, why.text);
    keeper_drop_parts(keeper);
    atomic_store(&keeper->busy, false);
    return CLOTH_OK;
}

int keeper_open(struct keeper **keeper, const struct outputs *of, struct cloth_error *error)
{
    struct keeper *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for checkpoints");
    made->of = of;
    made->next = cloth_seconds() + of->options->checkpoint;
    made->part[0] = (struct output_part){of->settings, strlen(of->settings)};
    made->member = (struct output_member){.settle = keeper_settle, .context = made};
    if (output_checkpoints_open(&made->checkpoints, of->options->output, error)) {
        free(made);
        return error->code;
    }
    output_member_add(&made->member, of->settler, 0);
    *keeper = made;
    return CLOTH_OK;
}

int keeper_due(struct keeper *keeper)
{
    const bool due = !atomic_load(&keeper->asked) && !atomic_load(&keeper->busy) &&
                     cloth_seconds() >= keeper->next;
    if (due)
        atomic_store(&keeper->asked, true);
    return due;
}

void keeper_close(struct keeper **keeper)
{
    struct keeper *gone = *keeper;
    *keeper = NULL;
    if (!gone)
        return;
    keeper_drop_parts(gone);
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
    output_member_wait(&keeper->member, keeper->given);
    keeper_drop_parts(keeper); /* of one that a failing disk left */
    keeper->part[1] = program;
    keeper->part[2] = (struct output_part){state.bytes, state.n};
    keeper->next = cloth_seconds() + of->options->checkpoint;
    atomic_store(&keeper->busy, true);
    atomic_store(&keeper->asked, false);
    output_member_wrote(&keeper->member, ++keeper->given, NULL);
}
