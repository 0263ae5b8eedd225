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
    CHECK_INTERSECTIONS,
    CHECKPOINT,
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
    {"report", REPORT, "FILE", 0, "write the figures of the run as flat JSON", 1},
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
    {"quiet", QUIET, NULL, 0, "neither progress nor summary", 1},
    {"end", END, "SECONDS", 0, "simulated time, instead of the scene's time.end", 2},
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
    struct simulate_options run;
    char **texts; /* of the sets made here, two for each set */
    size_t n_texts;
    bool talks; /* this rank prints */
    bool done;  /* nothing is to be run: help, version, keys */
};

static int cloth_cli_whole_number(struct argp_state *state, const char *option, const char *text,
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

/* Refuses an option that names an unknown policy. */
static int chosen(struct argp_state *state, const char *option, const char *name,
                  const void *policy)
{
    if (policy)
        return 0;
    argp_failure(state, 0, 0, "--%s %s: %s", option, name, duite_message());
    return EINVAL;
}

static int choose_scheduler(struct argp_state *state, struct simulate_options *run,
                            const char *name)
{
    run->scheduler_name = name;
    run->scheduler = duite_scheduler_find(name);
    return chosen(state, "scheduler", name, run->scheduler);
}

static int choose_mapping(struct argp_state *state, struct simulate_options *run, const char *name)
{
    run->mapping_name = name;
    run->mapping = duite_mapping_find(name);
    return chosen(state, "mapping", name, run->mapping);
}

static int choose_balance(struct argp_state *state, struct simulate_options *run, const char *name)
{
    run->balance_name = name;
    run->balance = duite_balancer_find(name);
    return chosen(state, "balance", name, run->balance);
}

static int add_set(struct command *command, const char *text, const char *option)
{
    struct simulate_options *run = &command->run;
    struct scene_set *sets = realloc(run->sets, (run->n_sets + 1) * sizeof *sets);
    if (!sets)
        return ENOMEM;
    sets[run->n_sets++] = (struct scene_set){text, option};
    run->sets = sets;
    return 0;
}

/* An option that stands for a key of the scene: the schema checks it, errors name the option. */
static int cloth_cli_add_key(struct command *command, const char *option, const char *key,
                             const char *value)
{
    char **texts = realloc(command->texts, (command->n_texts + 2) * sizeof *texts);
    if (!texts)
        return ENOMEM;
    command->texts = texts;
    char **text = texts + command->n_texts, **name = text + 1;
    if (asprintf(text, "%s=%s", key, value) < 0)
        return ENOMEM;
    command->n_texts++;
    if (asprintf(name, "--%s %s", option, value) < 0)
        return ENOMEM;
    command->n_texts++;
    return add_set(command, *text, *name);
}

static void print_version(FILE *file)
{
    fprintf(file, "duite-cloth (%s)\n", PACKAGE_STRING);
}

static void print_scenes(FILE *file)
{
    if (!shipped_print(file))
        fputs("no scenes are installed; those of the sources are in cloth/scenes\n", file);
}

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
static int answer(struct command *command, struct argp_state *state, int key)
{
    command->done = true;
    if (!command->talks)
        return 0;
    if (key == 'V')
        print_version(stdout);
    else if (key == SCENES)
        print_scenes(stdout);
    else
        argp_state_help(state, stdout,
                        key == USAGE ? ARGP_HELP_USAGE
                                     : ARGP_HELP_LONG | ARGP_HELP_DOC | ARGP_HELP_USAGE);
    return 0;
}

static error_t cloth_cli_parse_number(struct command *command, struct argp_state *state, int key,
                                      const char *value)
{
    uint64_t number = 0;
    bool threads = key == THREADS;
    int code = cloth_cli_whole_number(state, threads ? "threads" : "seed", value, threads ? 1 : 0,
                                      threads ? DUITE_MAX_THREADS : UINT64_MAX, &number);
    if (code)
        return code;
    if (threads)
        command->run.threads = (unsigned)number;
    else
        command->run.seed = number;
    return 0;
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

/* A number up to the character, or the default if there is none. */
static const char *parse_step(const char *text, uint64_t otherwise, uint64_t *step)
{
    char *end = (char *)text;
    errno = 0;
    *step = *text >= '0' && *text <= '9' ? strtoull(text, &end, 10) : otherwise;
    return errno ? NULL : end;
}

static error_t parse_steps(struct command *command, struct argp_state *state, const char *text)
{
    struct simulate_options *run = &command->run;
    const char *colon = parse_step(text, 0, &run->trace_first);
    const char *end =
        colon && *colon == ':' ? parse_step(colon + 1, UINT64_MAX, &run->trace_end) : NULL;
    if (end && !*end && run->trace_first < run->trace_end)
        return 0;
    argp_failure(state, 0, 0,
                 "--trace-steps %s: two steps with a colon between them are expected, the first "
                 "one smaller, such as 10:20, 10: or :20",
                 text);
    return EINVAL;
}

static error_t parse_checkpoint(struct command *command, struct argp_state *state, const char *text)
{
    char *end;
    errno = 0;
    const double seconds = strtod(text, &end);
    command->run.checkpoint = seconds;
    if (end != text && !*end && !errno && seconds > 0 && seconds <= 1e9)
        return 0;
    argp_failure(state, 0, 0, "--checkpoint %s: seconds, > 0 and at most 1e9, are expected", text);
    return EINVAL;
}

static error_t cloth_cli_parse_scene(struct command *command, struct argp_state *state,
                                     const char *path)
{
    if (command->run.scene) {
        argp_failure(state, 0, 0, "%s: a second scene file; one is expected", path);
        return EINVAL;
    }
    return parse_name(state, "scene file", path, &command->run.scene);
}

static error_t cloth_cli_parse(int key, char *value, struct argp_state *state)
{
    struct command *command = state->input;
    switch (key) {
    case OUTPUT:
        return parse_name(state, "--output", value, &command->run.output);
    case REPORT:
        return parse_name(state, "--report", value, &command->run.report);
    case RESTART:
        return parse_name(state, "--restart", value, &command->run.restart);
    case CHECKPOINT:
        return parse_checkpoint(command, state, value);
    case LIVE:
        return parse_name(state, "--live", value, &command->run.live);
    case SAVE_SYSTEM:
        return parse_name(state, "--save-system", value, &command->run.save_system);
    case TRACE:
        return parse_name(state, "--trace", value, &command->run.trace);
    case TRACE_STEPS:
        return parse_steps(command, state, value);
    case CHECK_INTERSECTIONS:
        command->run.check_intersections = true;
        return 0;
    case QUIET:
        command->run.quiet = true;
        return 0;
    case END:
        return cloth_cli_add_key(command, "end", "time.end", value);
    case GRAIN:
        return cloth_cli_add_key(command, "grain", "grain", value);
    case KEYS:
        return print_keys(command, state, value);
    case SET:
        return add_set(command, value, NULL);
    case SCHEDULER:
        return choose_scheduler(state, &command->run, value);
    case MAPPING:
        return choose_mapping(state, &command->run, value);
    case BALANCE:
        return choose_balance(state, &command->run, value);
    case THREADS:
    case SEED:
        return cloth_cli_parse_number(command, state, key, value);
    case SCENES:
    case USAGE:
    case 'V':
    case '?':
        return answer(command, state, key);
    case ARGP_KEY_ARG:
        return cloth_cli_parse_scene(command, state, value);
    default:
        return ARGP_ERR_UNKNOWN;
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

/* A run goes on in its own folder. */
static int check_restart(struct command *command)
{
    struct simulate_options *run = &command->run;
    const char *wrong = NULL;
    if (run->restart && run->output && strcmp(run->restart, run->output) != 0)
        wrong = "--restart DIR goes on writing into DIR: leave --output out";
    if (run->restart && !run->output)
        run->output = run->restart;
    if (run->checkpoint > 0 && !run->output)
        wrong = "--checkpoint needs --output DIR: checkpoints are kept in that folder";
    if (run->restart && run->save_system)
        wrong = "--save-system with --restart: the system is that of a run from its start";
    if (wrong && command->talks)
        fprintf(stderr, "duite-cloth: %s\n", wrong);
    return wrong ? SIMULATE_BAD_INPUT : SIMULATE_OK;
}

/* Returns an exit code. */
static int command_line(struct command *command, int argc, char **argv)
{
    /* --help and the like are options of our own: argp's would end the process of one rank. */
    unsigned flags = ARGP_NO_EXIT | ARGP_NO_HELP | (command->talks ? 0 : ARGP_NO_ERRS);
    error_t error = argp_parse(&ARGP, argc, argv, flags, NULL, command);
    if (error == ENOMEM && command->talks)
        fprintf(stderr, "duite-cloth: out of memory\n");
    if (error)
        return error == ENOMEM ? SIMULATE_FAILED : SIMULATE_BAD_INPUT;
    if (!command->run.trace && (command->run.trace_first || command->run.trace_end != UINT64_MAX)) {
        if (command->talks)
            fprintf(stderr, "duite-cloth: --trace-steps without --trace FILE, or DUITE_TRACE\n");
        return SIMULATE_BAD_INPUT;
    }
    if (command->done || command->run.scene)
        return command->done ? SIMULATE_OK : check_restart(command);
    if (command->talks)
        fprintf(stderr, "duite-cloth: a scene file is expected; see duite-cloth --help\n");
    return SIMULATE_BAD_INPUT;
}

static void free_command(struct command *command)
{
    for (size_t i = 0; i < command->n_texts; i++)
        free(command->texts[i]);
    free(command->texts);
    free(command->run.sets);
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
    free_command(&command);
    if (code == SIMULATE_LOST)
        return code;
    code = agree(code);
    MPI_Finalize();
    return code;
}
