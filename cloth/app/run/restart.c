/* The second part of a checkpoint is struct saved, a struct saved_phase of each phase, then
 * numbers: the start of the phase, 6 a vertex; the drape test's frame, 3 a vertex of its cloth. */
#include "cloth/app/run/restart.h"

#include "cloth/app/run/keeper.h"
#include "cloth/base/file.h"
#include "cloth/base/memory.h"

#include <config.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

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

/* ---- Settings ---- */

static int put_file(FILE *to, const char *phase, const char *path, struct cloth_error *error)
{
    unsigned char bytes[1 << 14];
    XXH64_state_t *hash = XXH64_createState();
    FILE *file = cloth_file_open(path);
    int code = CLOTH_OK;
    if (!hash)
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for a hash");
    else if (!file)
        code = cloth_fail(error, CLOTH_E_INPUT, "cannot read %s again: %s", path, cloth_file_why());
    if (!code) {
        XXH64_reset(hash, 0);
        for (size_t n; (n = fread(bytes, 1, sizeof bytes, file)) > 0;)
            XXH64_update(hash, bytes, n);
        fprintf(to, "%sfile %s: %016jx\n", phase, path, (uintmax_t)XXH64_digest(hash));
    }
    if (file)
        fclose(file);
    XXH64_freeState(hash);
    return code;
}

/* The first file is the scene, which its settings stand for. */
static int put_phase(FILE *to, const struct phases *phases, uint32_t i, struct cloth_error *error)
{
    const struct model *model = phases->models + i;
    char phase[100] = "";
    int code = CLOTH_OK;
    if (phases->named)
        snprintf(phase, sizeof phase, "phase '%.60s': ", phases->done[i].name);
    for (const char *line = model->settings; line && *line;) {
        const size_t n = strcspn(line, "\n");
        fprintf(to, "%s%.*s\n", phase, (int)n, line);
        line += n + (line[n] == '\n');
    }
    for (uint32_t k = 1; k < model->n_files && !code; k++)
        code = put_file(to, phase, model->files[k], error);
    return code;
}

char *restart_settings(const struct phases *phases, struct cloth_error *error)
{
    char *text = NULL;
    size_t size;
    int code = CLOTH_OK;
    FILE *to = open_memstream(&text, &size);
    if (to)
        fprintf(to, "version: %s\n", PACKAGE_STRING);
    for (uint32_t i = 0; to && i < phases->n && !code; i++)
        code = put_phase(to, phases, i, error);
    const int bad = !to || ferror(to), closed = to ? fclose(to) : 0;
    if (!code && (bad || closed))
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for the settings of the scene");
    if (!code)
        return text;
    free(text);
    return NULL;
}

/* A line without its end, and how long its key is: up to the last ": ". */
static size_t key_length(const char *line, size_t n)
{
    size_t length = n;
    for (size_t i = 0; i + 1 < n; i++)
        if (line[i] == ':' && line[i + 1] == ' ') {
            length = i;
            if (strncmp(line, "phase '", 7) != 0 || i + 2 >= n || line[i - 1] != '\'')
                break;
        }
    return length;
}

static int differs(const char *path, const char *now, const char *was, struct cloth_error *error)
{
    const size_t n = strcspn(now, "\n"), m = strcspn(was, "\n");
    const size_t key = key_length(now, n), key_was = key_length(was, m);
    const char *only = "only time.end, and what changes no state, may be others";
    if (!strncmp(now, "version: ", 9))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s is of another version, %.*s; this is " PACKAGE_STRING
                          ": go on with the one that wrote it",
                          path, (int)(m - key_was - 2), was + key_was + 2);
    if (key == key_was && !strncmp(now, was, key))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s is of another scene: %.*s is %.*s there, here it is %.*s; %s", path,
                          (int)key, now, (int)(m - key_was - 2), was + key_was + 2,
                          (int)(n - key - 2), now + key + 2, only);
    const bool here = !*was || (*now && strcmp(now, was) < 0);
    return cloth_fail(error, CLOTH_E_INPUT, "%s is of another scene: %.*s is %s alone; %s", path,
                      (int)(here ? key : key_was), here ? now : was,
                      here ? "in this one" : "in that one", only);
}

/* Fails with the first line that differs. */
static int compare_settings(const char *path, const char *now, struct output_part part,
                            struct cloth_error *error)
{
    char *was = cloth_alloc(part.n + 1, 1, error);
    if (!was)
        return CLOTH_E_MEMORY;
    memcpy(was, part.bytes, part.n);
    size_t line = 0, i = 0;
    for (; now[i] && now[i] == was[i]; i++)
        line = now[i] == '\n' ? i + 1 : line;
    const int code = now[i] == was[i] ? CLOTH_OK : differs(path, now + line, was + line, error);
    free(was);
    return code;
}

/* ---- Reading ---- */

static int refuse(const struct restart *restart, struct cloth_error *error)
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
        return refuse(restart, error);
    memcpy(saved, part->bytes, sizeof *saved);
    const uint64_t most = part->n / sizeof(double);
    if (saved->n_start > most || saved->n_drape > most || saved->now >= saved->n_phases ||
        part->n != sizeof *saved + saved->n_phases * sizeof(struct saved_phase) +
                       (saved->n_start + saved->n_drape) * sizeof(double) ||
        !memchr(saved->total.contact_pinch, 0, sizeof saved->total.contact_pinch))
        return refuse(restart, error);
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
        code = refuse(restart, error);
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
            code = refuse(restart, error);
    }
    if (code)
        return code;
    phases->now = saved.now;
    phases->total = saved.total;
    if (!saved.now)
        return CLOTH_OK;
    if (saved.n_start != phases_numbers(phases))
        return refuse(restart, error);
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
    char *settings = restart_settings(phases, error);
    code = settings ? compare_settings(from->path, settings, from->part[0], error) : error->code;
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
        return refuse(restart, error);
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
