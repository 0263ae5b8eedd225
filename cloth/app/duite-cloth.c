/* The command line of duite-cloth. Every rank reads it, after MPI has started, and only rank 0
 * prints: a mistake is said once, and all ranks end with the same code. */
#include "cloth/app/simulate.h"
#include "cloth/base/simd.h"

#include <config.h>

#include <argp.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum {
    END = 256,
    GRAIN,
    KEYS,
    LIVE,
    MAPPING,
    BALANCE,
    CHECK,
    CHECK_INTERSECTIONS,
    CHECKPOINT,
    FRAMES,
    OUTPUT,
    QUIET,
    REPORT,
    RESTART,
    SAVE_SYSTEM,
    SCENES,
    SCHEDULER,
    SEED,
    SET,
    THREADS,
    TRACE,
    TRACE_STEPS,
    USAGE
};

/* argp sorts them by group and name. */
static const struct argp_option OPTIONS[] = {
    {"output", OUTPUT, "DIR", 0, "write frames into this folder, which is made", 1},
    {"checkpoint", CHECKPOINT, "SECONDS", 0,
     "write a checkpoint into the folder of --output this often (seconds of the clock), and at the "
     "end",
     1},
    {"restart", RESTART, "DIR", 0,
     "go on from the last checkpoint of the run whose --output was DIR, and write there; --end may "
     "be later",
     1},
    {"live", LIVE, "[ADDRESS:]PORT", 0,
     "publish frames for duite-view --connect, on this host alone, or at an ADDRESS of it (`*': "
     "all)",
     1},
    {"report", REPORT, "FILE", 0,
     "write the figures of the run as flat JSON (default: DUITE_REPORT, else none)", 1},
    {"save-system", SAVE_SYSTEM, "DIR", 0,
     "write the linear system of the last step, in Matrix Market form, into this folder, which is "
     "made",
     1},
    {"trace", TRACE, "FILE", 0,
     "write what each worker does when into FILE, and FILE.1, FILE.2, ... on the other ranks; for "
     "duite-trace and duite-predict (default: DUITE_TRACE, else none)",
     1},
    {"trace-steps", TRACE_STEPS, "A:B", 0,
     "trace only from step A up to, not including, step B; the first step is 0; either may be left "
     "out",
     1},
    {"check-intersections", CHECK_INTERSECTIONS, NULL, 0,
     "look in each frame, exactly, for triangles of cloth that go through each other or through "
     "obstacles",
     1},
    {"check", CHECK, NULL, 0,
     "say what the run would take of memory, time and disk, and what is slow, by its first steps "
     "alone; nothing is written",
     1},
    {"quiet", QUIET, NULL, 0, "neither progress nor summary", 1},
    {"end", END, "SECONDS", 0, "simulated time, instead of the scene's time.end", 2},
    {"frames", FRAMES, "A:B", 0,
     "make frames from A to B only, and end with B; either may be left out. The run begins at time "
     "0 all the same; frame A is the first one in the folder",
     2},
    {"grain", GRAIN, "VERTICES", 0, "vertices a block, instead of the scene's grain", 2},
    {"set", SET, "KEY=VALUE", 0,
     "change a value of the scene, such as time.h=0.002 or cloths[0].mesh.grid.nx=40; may be "
     "given several times",
     2},
    {"threads", THREADS, "N", 0,
     "workers of each rank (default: DUITE_THREADS, else its share of the cores)", 3},
    {"scheduler", SCHEDULER, "NAME", 0,
     "which worker runs which task next: SCHEDULERS; or a policy of your own as ./FILE.so "
     "(default: DUITE_SCHEDULER, else steal)",
     3},
    {"mapping", MAPPING, "NAME", 0,
     "which rank keeps which block: MAPPINGS; or a policy of your own as ./FILE.so (default: "
     "DUITE_MAPPING, else metis)",
     3},
    {"balance", BALANCE, "NAME", 0,
     "which tasks or blocks go to other ranks: BALANCERS; or a policy of your own as ./FILE.so "
     "(default: DUITE_BALANCE, else none)",
     3},
    {"seed", SEED, "N", 0, "of all that is random in the policies (default: DUITE_SEED, else 1)",
     3},
    {"keys", KEYS, "FORMAT", OPTION_ARG_OPTIONAL,
     "list the keys of scene files, with units, ranges and defaults; markdown: in full, as in "
     "docs/scene.md",
     4},
    {"scenes", SCENES, NULL, 0, "list the scenes that came with duite, which are found by name", 4},
    {"help", '?', NULL, 0, "this text", 4},
    {"usage", USAGE, NULL, 0, "a short text", 4},
    {"version", 'V', NULL, 0, "the version", 4},
    {0}};

struct command {
    struct simulate_options run; /* sets that name an option own their texts */
    bool talks;                  /* this rank prints */
    bool done;                   /* nothing is to be run: help, version, keys */
};

/* ---- Values ---- */

static error_t parse_whole(struct argp_state *state, const char *option, const char *text,
                           uint64_t min, uint64_t max, uint64_t *value)
{
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    if (*text >= '0' && *text <= '9' && !*end && !errno && *value >= min && *value <= max)
        return 0;
    argp_failure(state, 0, 0, "--%s %s: a whole number from %" PRIu64 " to %" PRIu64 " is expected",
                 option, text, min, max);
    return EINVAL;
}

static error_t parse_name(struct argp_state *state, const char *option, const char *value,
                          const char **name)
{
    *name = value;
    if (*value)
        return 0;
    argp_failure(state, 0, 0, "%s: an empty name", option);
    return EINVAL;
}

/* Refuses an option that names an unknown policy. */
static error_t parse_policy(struct argp_state *state, const char *option, const char *value,
                            const char **name, const void *policy)
{
    *name = value;
    if (policy)
        return 0;
    argp_failure(state, 0, 0, "--%s %s: %s", option, value, duite_message());
    return EINVAL;
}

static error_t add_set(struct simulate_options *run, const char *text, const char *option)
{
    struct scene_set *sets = realloc(run->sets, (run->n_sets + 1) * sizeof *sets);
    if (!sets)
        return ENOMEM;
    sets[run->n_sets++] = (struct scene_set){text, option};
    run->sets = sets;
    return 0;
}

/* An option that stands for a key of the scene: the schema checks it, errors name the option. */
static error_t add_key(struct simulate_options *run, const char *option, const char *key,
                       const char *value)
{
    char *text = NULL, *name = NULL;
    if (asprintf(&text, "%s=%s", key, value) >= 0 &&
        asprintf(&name, "--%s %s", option, value) >= 0 && !add_set(run, text, name))
        return 0;
    free(text);
    free(name);
    return ENOMEM;
}

static error_t parse_steps(duite_options *runtime, struct argp_state *state, const char *text)
{
    runtime->trace_first = 0;
    runtime->trace_end = UINT64_MAX;
    if (options_range(text, &runtime->trace_first, &runtime->trace_end) &&
        runtime->trace_first < runtime->trace_end)
        return 0;
    argp_failure(state, 0, 0,
                 "--trace-steps %s: two steps with a colon between them are expected, the first "
                 "one smaller, such as 10:20, 10: or :20",
                 text);
    return EINVAL;
}

static error_t parse_frames(struct simulate_options *run, struct argp_state *state,
                            const char *text)
{
    run->first_frame = 0;
    run->last_frame = UINT64_MAX;
    if (options_range(text, &run->first_frame, &run->last_frame))
        return 0;
    argp_failure(state, 0, 0,
                 "--frames %s: two numbers of frames with a colon between them are expected, the "
                 "second one not smaller, such as 24:48, 24: or :48",
                 text);
    return EINVAL;
}

static error_t parse_checkpoint(double *seconds, struct argp_state *state, const char *text)
{
    char *end;
    errno = 0;
    *seconds = strtod(text, &end);
    if (end != text && !*end && !errno && *seconds > 0 && *seconds <= 1e9)
        return 0;
    argp_failure(state, 0, 0, "--checkpoint %s: seconds, > 0 and at most 1e9, are expected", text);
    return EINVAL;
}

/* ---- Options ---- */

/* format: of --keys; NULL: none is given. */
static error_t print_keys(struct command *command, struct argp_state *state, const char *format)
{
    command->done = true;
    if (format && strcmp(format, "markdown") != 0) {
        argp_failure(state, 0, 0, "--keys=%s: markdown is expected, or no format", format);
        return EINVAL;
    }
    if (command->talks && format)
        scene_print_page(stdout);
    else if (command->talks)
        scene_print_keys(stdout);
    return 0;
}

/* Options that print and end the program. */
static error_t answer(struct command *command, struct argp_state *state, int key)
{
    command->done = true;
    if (!command->talks)
        return 0;
    if (key == 'V')
        printf("duite-cloth (%s)\n", PACKAGE_STRING);
    else if (key != SCENES)
        argp_state_help(state, stdout,
                        key == USAGE ? ARGP_HELP_USAGE
                                     : ARGP_HELP_LONG | ARGP_HELP_DOC | ARGP_HELP_USAGE);
    else if (!shipped_print(stdout))
        fputs("no scenes are installed; those of the sources are in cloth/scenes\n", stdout);
    return 0;
}

/* Options of the runtime. */
static error_t parse_runtime(struct simulate_options *run, int key, const char *value,
                             struct argp_state *state)
{
    duite_options *runtime = &run->runtime;
    uint64_t threads = 0;
    error_t code;
    switch (key) {
    case THREADS:
        code = parse_whole(state, "threads", value, 1, DUITE_MAX_THREADS, &threads);
        runtime->threads = (unsigned)threads;
        return code;
    case SEED:
        return parse_whole(state, "seed", value, 0, UINT64_MAX, &runtime->seed);
    case SCHEDULER:
        runtime->scheduler = duite_scheduler_find(value);
        return parse_policy(state, "scheduler", value, &run->scheduler_name, runtime->scheduler);
    case MAPPING:
        runtime->mapping = duite_mapping_find(value);
        return parse_policy(state, "mapping", value, &run->mapping_name, runtime->mapping);
    case BALANCE:
        runtime->balance = duite_balancer_find(value);
        return parse_policy(state, "balance", value, &run->balance_name, runtime->balance);
    case TRACE:
        return parse_name(state, "--trace", value, &runtime->trace);
    case TRACE_STEPS:
        return parse_steps(runtime, state, value);
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static error_t cloth_cli_parse(int key, char *value, struct argp_state *state)
{
    struct command *command = state->input;
    struct simulate_options *run = &command->run;
    switch (key) {
    case OUTPUT:
        return parse_name(state, "--output", value, &run->output);
    case REPORT:
        return parse_name(state, "--report", value, &run->report);
    case RESTART:
        return parse_name(state, "--restart", value, &run->restart);
    case LIVE:
        return parse_name(state, "--live", value, &run->live);
    case SAVE_SYSTEM:
        return parse_name(state, "--save-system", value, &run->save_system);
    case CHECKPOINT:
        return parse_checkpoint(&run->checkpoint, state, value);
    case FRAMES:
        return parse_frames(run, state, value);
    case CHECK_INTERSECTIONS:
        run->check_intersections = true;
        return 0;
    case CHECK:
        run->check = true;
        return 0;
    case QUIET:
        run->quiet = true;
        return 0;
    case END:
        return add_key(run, "end", "time.end", value);
    case GRAIN:
        return add_key(run, "grain", "grain", value);
    case SET:
        return add_set(run, value, NULL);
    case KEYS:
        return print_keys(command, state, value);
    case SCENES:
    case USAGE:
    case 'V':
    case '?':
        return answer(command, state, key);
    case ARGP_KEY_ARG:
        if (!run->scene)
            return parse_name(state, "scene file", value, &run->scene);
        argp_failure(state, 0, 0, "%s: a second scene file; one is expected", value);
        return EINVAL;
    default:
        return parse_runtime(run, key, value, state);
    }
}

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = cloth_cli_parse,
    .help_filter = environment_help,
    .args_doc = "SCENE.yaml",
    .doc = "Simulates the cloths of a scene file. Run it under mpirun for several ranks; the "
           "result is the same, to the last bit.\v"
           "Exit codes: 0 done, 1 the run failed or its files could not be written, 2 the input or "
           "the command line is wrong, 3 another rank was lost, or MPI failed, 4 done, but "
           "--check-intersections found intersections, 5 stopped by SIGUSR1 or SIGTERM. "
           "Scene files are described in docs/scene.md and by --keys."};

/* The fault of options that lack another or exclude each other; NULL: there is none. */
static const char *find_fault(const struct command *command)
{
    const struct simulate_options *run = &command->run;
    const duite_options *runtime = &run->runtime;
    if (!runtime->trace && (runtime->trace_first || runtime->trace_end != UINT64_MAX))
        return "--trace-steps without --trace FILE, or DUITE_TRACE";
    if (command->done)
        return NULL;
    if (!run->scene)
        return "a scene file is expected; see duite-cloth --help";
    if (run->check && (run->restart || run->save_system || run->live || run->checkpoint > 0))
        return "--check is of a run from its start, and writes nothing: leave --restart, "
               "--checkpoint, --save-system and --live out";
    if (run->restart && run->save_system)
        return "--save-system with --restart: the system is that of a run from its start";
    if (run->checkpoint > 0 && !run->output && !run->restart)
        return "--checkpoint needs --output DIR: checkpoints are kept in that folder";
    if (run->restart && run->output && strcmp(run->restart, run->output) != 0)
        return "--restart DIR goes on writing into DIR: leave --output out";
    return NULL;
}

/* Returns an exit code. */
static int command_line(struct command *command, int argc, char **argv)
{
    /* --help and the like are options of our own: argp's would end the process of one rank. */
    unsigned flags = ARGP_NO_EXIT | ARGP_NO_HELP | (command->talks ? 0 : ARGP_NO_ERRS);
    error_t error = argp_parse(&ARGP, argc, argv, flags, NULL, command);
    const char *fault = error == ENOMEM ? "out of memory" : error ? NULL : find_fault(command);
    if (fault && command->talks)
        fprintf(stderr, "duite-cloth: %s\n", fault);
    if (command->run.restart) /* a run goes on in its own folder */
        command->run.output = command->run.restart;
    return error == ENOMEM ? SIMULATE_FAILED : error || fault ? SIMULATE_BAD_INPUT : SIMULATE_OK;
}

static void free_sets(struct simulate_options *run)
{
    for (size_t i = 0; i < run->n_sets; i++)
        if (run->sets[i].option) {
            free((char *)(uintptr_t)run->sets[i].text);
            free((char *)(uintptr_t)run->sets[i].option);
        }
    free(run->sets);
}

/* Fails if standard output did not take everything. */
static int finish_output(int code)
{
    if (!fflush(stdout) && !ferror(stdout))
        return code;
    fprintf(stderr, "duite-cloth: cannot write to standard output: %s\n", strerror(errno));
    return code ? code : SIMULATE_FAILED;
}

/* The largest exit code of all ranks, on all ranks. */
static int agree(int code)
{
    MPI_Allreduce(MPI_IN_PLACE, &code, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return code;
}

/* Hosts may differ in processors and environments: the first rank that cannot do what its
 * environment asks says so. */
static int check_host(int rank, const struct simulate_options *run)
{
    struct cloth_error error = {0};
    const int code = cloth_simd_check(&error) || environment_check(run, &error) ? SIMULATE_BAD_INPUT
                                                                                : SIMULATE_OK;
    int first = code ? rank : INT_MAX;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (first == rank)
        fprintf(stderr, "duite-cloth: %s\n", error.text);
    return code;
}

int main(int argc, char **argv)
{
    int provided, rank;
    simulate_block_signals();
    if (MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided) || simulate_catch_signals())
        return SIMULATE_FAILED;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    struct command command = {.talks = rank == 0};
    environment_begin(&command.run);
    int code = agree(command_line(&command, argc, argv));
    if (code == SIMULATE_OK && !command.done)
        code = agree(check_host(rank, &command.run));
    if (code == SIMULATE_OK && !command.done)
        code = simulate(&command.run);
    code = finish_output(code);
    free_sets(&command.run);
    if (code == SIMULATE_LOST)
        return code;
    code = agree(code);
    MPI_Finalize();
    return code;
}
