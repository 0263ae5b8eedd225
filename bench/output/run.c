/* Runs of duite-cloth, as a user starts them, and checkpoints as it writes them. */
#include "bench/output/output.h"

#include "bench/cg/cg.h"
#include "bench/output/folder.h"
#include "bench/output/viewer.h"
#include "bench/program.h"
#include "bench/temporary.h"
#include "cloth/output/checkpoint.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { COMMAND = 3 * OUTPUT_PATH, HASH = 24, LAST_FRAME = 12 };

#define QUICK_SHEET "--set cloths[0].mesh.grid.nx=20 --set cloths[0].mesh.grid.ny=20"

/* ---- duite-cloth ---- */

/* Runs it with a folder of its own for what it writes. */
static int run_cloth(const char *arguments, bool quick)
{
    char programs[OUTPUT_PATH], command[2 * COMMAND];
    program_folder(programs, sizeof programs);
    snprintf(command, sizeof command, "'%s/../duite-cloth' '%s/sheet.yaml' --quiet %s %s >&2",
             programs, BENCH_SCENES, quick ? QUICK_SHEET : "", arguments);
    return system(command);
}

/* Writes the run's frames as USD. */
static int run_view(const char *folder)
{
    char programs[OUTPUT_PATH], command[2 * COMMAND];
    program_folder(programs, sizeof programs);
    snprintf(command, sizeof command, "'%s/../duite-view' '%s/frames' --export '%s/sheet.usda' >&2",
             programs, folder, folder);
    return system(command);
}

static int read_hash(const char *folder, char hash[HASH])
{
    char path[OUTPUT_PATH + 40], line[400];
    snprintf(path, sizeof path, "%s/report.json", folder);
    FILE *file = fopen(path, "r");
    *hash = '\0';
    while (file && fgets(line, sizeof line, file))
        sscanf(line, " \"state_hash\": \"%16[0-9a-f]\"", hash);
    if (file)
        fclose(file);
    return *hash ? 0 : serve_fail("a run has no state_hash");
}

static bool is_file(const char *folder, const char *name)
{
    char path[OUTPUT_PATH + 60];
    struct stat about;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return !stat(path, &about) && about.st_size > 0;
}

/* Whichever were kept, the newest is whole. */
static int check_checkpoint(const char *folder)
{
    char frames[OUTPUT_PATH + 40];
    struct output_checkpoint newest = {0};
    struct cloth_error error = {0};
    snprintf(frames, sizeof frames, "%s/frames", folder);
    const int code = output_checkpoint_newest(&newest, frames, &error, &error);
    output_checkpoint_free(&newest);
    return code ? serve_fail("wrong answer: %s", error.text) : 0;
}

/* The answer: the state of all earlier runs, and the files of this one. */
static int check_run(const char *folder, const char *output)
{
    static char first[HASH]; /* of this process; empty before its first run */
    char hash[HASH];
    const int code = read_hash(folder, hash);
    if (code)
        return code;
    if (*first && strcmp(first, hash))
        return serve_fail("wrong answer: state %s, %s before", hash, first);
    memcpy(first, hash, sizeof first);
    if (!strcmp(output, "hdf5") && !is_file(folder, "frames/hdf5/frame-000001.vtkhdf"))
        return serve_fail("wrong answer: there is no HDF5 file of frame 1");
    if (!strcmp(output, "usd") && !is_file(folder, "sheet.usda"))
        return serve_fail("wrong answer: there is no USD file");
    if (!strcmp(output, "checkpoints"))
        return check_checkpoint(folder);
    return 0;
}

static bool has_viewer(const char *output)
{
    return !strcmp(output, "live") || !strcmp(output, "stopped");
}

static void write_arguments(struct serve_request *request, const char *output, const char *folder,
                            unsigned port, char arguments[COMMAND])
{
    const char *extra = !strcmp(output, "hdf5")          ? "--set output.hdf5={}"
                        : !strcmp(output, "checkpoints") ? "--checkpoint 1"
                                                         : "";
    char scheduler[40], frames[OUTPUT_PATH + 40] = "";
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    if (has_viewer(output))
        snprintf(frames, sizeof frames, "--live %u", port);
    else if (strcmp(output, "none"))
        snprintf(frames, sizeof frames, "--output '%s/frames'", folder);
    snprintf(arguments, COMMAND, "--threads %u --scheduler %s --report '%s/report.json' %s %s",
             (unsigned)serve_number(request, "threads"), scheduler, folder, frames, extra);
}

static int simulate(void *context, struct serve_request *request, double *value)
{
    char output[20], folder[TEMPORARY_PATH], arguments[COMMAND];
    struct output_viewer viewer = {0};
    (void)context;
    serve_word(request, "output", output, sizeof output);
    const bool quick = serve_number(request, "quick") != 0;
    const char *states = getenv(STATE_FOLDER);
    int code = temporary_make(states ? states : ".", "output", folder);
    if (code)
        return code;
    if (has_viewer(output))
        code = output_viewer_start(&viewer, !strcmp(output, "stopped"));
    write_arguments(request, output, folder, viewer.port, arguments);
    sync(); /* what earlier runs left to the disk is not this one's */
    const double begin = serve_seconds();
    if (!code && run_cloth(arguments, quick))
        code = serve_fail("duite-cloth fails: %.150s", arguments);
    if (!code && !strcmp(output, "usd") && run_view(folder))
        code = serve_fail("duite-view exports no frames");
    *value = serve_seconds() - begin;
    if (viewer.process > 0) {
        const int seen = output_viewer_end(&viewer, !quick && !code, LAST_FRAME);
        code = code ? code : seen;
    }
    code = code ? code : check_run(folder, output);
    temporary_remove(folder);
    return code;
}

/* ---- Checkpoints ---- */

static int same_parts(const struct output_checkpoint *a, const struct output_checkpoint *b)
{
    for (int i = 0; i < OUTPUT_CHECKPOINT_PARTS; i++)
        if (a->part[i].n != b->part[i].n ||
            memcmp(a->part[i].bytes, b->part[i].bytes, a->part[i].n))
            return serve_fail("wrong answer: a checkpoint is read back with other bytes");
    return 0;
}

/* Seconds of the fastest checkpoint with those parts. */
static int write_checkpoints(const struct output_checkpoint *source, const char *folder,
                             uint64_t times, double *best)
{
    struct output_checkpoints *checkpoints = NULL;
    struct output_checkpoint back = {0};
    struct cloth_error error = {0};
    int code = output_checkpoints_open(&checkpoints, folder, &error);
    for (uint64_t i = 0; i < times && !code; i++) {
        const double begin = serve_seconds();
        code = output_checkpoints_write(checkpoints, source->part, &error);
        const double seconds = serve_seconds() - begin;
        *best = i && *best < seconds ? *best : seconds;
    }
    code = code ? code : output_checkpoint_newest(&back, folder, &error, &error);
    code = code ? serve_fail("%s", error.text) : same_parts(source, &back);
    output_checkpoint_free(&back);
    output_checkpoints_close(&checkpoints);
    return code;
}

static int write_file(const char *path, const unsigned char *bytes, size_t n)
{
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    size_t done = 0;
    while (file >= 0 && done < n) {
        const ssize_t now = write(file, bytes + done, n - done);
        if (now <= 0)
            break;
        done += (size_t)now;
    }
    const bool synced = file >= 0 && !fsync(file);
    const bool closed = file >= 0 && !close(file);
    return done == n && synced && closed ? 0 : serve_fail("%s cannot be written", path);
}

/* The same of a file of so many bytes. */
static int write_plainly(size_t n, const char *folder, uint64_t times, double *best)
{
    char path[OUTPUT_PATH + 20];
    unsigned char *bytes = malloc(n);
    int code = bytes ? 0 : serve_no_memory();
    for (size_t i = 0; bytes && i < n; i++)
        bytes[i] = (unsigned char)(i * 2654435761u >> 13);
    snprintf(path, sizeof path, "%s/plain", folder);
    for (uint64_t i = 0; i < times && !code; i++) {
        const double begin = serve_seconds();
        code = write_file(path, bytes, n);
        const double seconds = serve_seconds() - begin;
        *best = i && *best < seconds ? *best : seconds;
        if (!code && unlink(path))
            code = serve_fail("%s cannot be removed", path);
    }
    free(bytes);
    return code;
}

static int write_run(void *context, struct serve_request *request, double *value)
{
    char as[20], folder[OUTPUT_PATH], frames[OUTPUT_PATH];
    const uint64_t times = serve_number(request, "times");
    struct output_checkpoint source = {0};
    struct cloth_error error = {0};
    struct stat about = {0};
    (void)context;
    serve_word(request, "as", as, sizeof as);
    output_folder(frames, sizeof frames);
    const char *states = getenv(STATE_FOLDER);
    int code = temporary_make(states ? states : ".", "output", folder);
    if (code)
        return code;
    if (output_checkpoint_newest(&source, frames, &error, &error) || stat(source.path, &about))
        code = serve_fail("no checkpoint of the sheet: %s", error.text);
    else if (!strcmp(as, "plain"))
        code = write_plainly((size_t)about.st_size, folder, times, value);
    else
        code = write_checkpoints(&source, folder, times, value);
    output_checkpoint_free(&source);
    temporary_remove(folder);
    return code;
}

const struct serve_run output_runs[] = {{"simulate", simulate}, {"write", write_run}, {0}};

/* ---- Made once ---- */

int output_prepare(const struct bench_options *options,
                   void (*say)(const char *key, const char *text))
{
    char folder[OUTPUT_PATH], arguments[COMMAND];
    if (cg_make_folder(options))
        return 1;
    output_folder(folder, sizeof folder);
    say("frames", folder);
    if (is_file(folder, "done"))
        return 0;
    fprintf(stderr, "duite-bench: making frames of the sheet\n");
    snprintf(arguments, sizeof arguments,
             "--end %s --threads %u --checkpoint 3600 --output '%s' --report '%s/done'",
             options->quick ? "0.08" : "0.48", options->threads, folder, folder);
    if (!run_cloth(arguments, options->quick))
        return 0;
    fprintf(stderr, "duite-bench: the sheet's frames cannot be made\n");
    return 1;
}
