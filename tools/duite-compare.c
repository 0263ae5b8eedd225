/* duite-compare: the command line of a comparison (tools/compare/compare.h). */
#include "tools/compare/compare.h"
#include "tools/compare/figure.h"
#include "tools/compare/graph.h"
#include "tools/compare/program.h"

#include <config.h>

#include <argp.h>
#include <duite.h>
#include <duite_policy.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    ROUNDS = 256,
    SEED,
    OUTPUT,
    TIMEOUT,
    METG,
    TASKS,
    COST,
    BYTES,
    STEPS,
    SET,
    VARY,
    FIGURE,
    SAME,
    LIST
};

static const struct argp_option OPTIONS[] = {
    {"scheduler", LIST + SCHEDULER, "LIST", 0,
     "schedulers, with commas between them; all: every one but shuffle, which is for tests; on "
     "graphs also forks:NAME, without replays, and RUNTIME:NAME, another runtime's: starpu:NAME, "
     "libgomp:tasks, libomp:tasks, mpi:isend (default: steal)",
     1},
    {"mapping", LIST + MAPPING, "LIST", 0,
     "mappings, with commas between them; all: every one (default: metis)", 1},
    {"balance", LIST + BALANCE, "LIST", 0,
     "balancers, with commas between them; all: every one but scatter and wander, which are for "
     "tests (default: none)",
     1},
    {"ranks", LIST + RANKS, "LIST", 0, "numbers of ranks, with commas between them (default: 1)",
     1},
    {"threads", LIST + THREADS, "LIST", 0,
     "numbers of threads of each rank, with commas between them (default: 2)", 1},
    {"grain", LIST + GRAIN, "LIST", 0,
     "of scenes: vertices a block; of synthetic graphs: how many times the cost of a task, of "
     "which there are as many times fewer; 0: the default (default: 0)",
     1},
    {"vary", VARY, "NAME=LIST", 0,
     "values of a variable of the environment, with commas between them; may be given several "
     "times",
     1},
    {"figure", FIGURE, "key=KEY|REGEX", 0,
     "what is compared: the number under this key of the report, which a program of duite leaves; "
     "or the number that the first group of this extended regular expression finds in a program's "
     "output, in the last line that has one; the least is the best (default: the time of a step, a "
     "round, or a program's run)",
     2},
    {"same", SAME, "key=KEY|REGEX", 0,
     "what has to be the same in all runs that differ in no grain and no --vary: a text, found as "
     "--figure finds a number (default: the hash of a scene or graph; of a program nothing)",
     2},
    {"metg", METG, NULL, 0,
     "draw the efficiency of all cores over the granularity of tasks, and find the least "
     "granularity with 50 %: on stencil, nearest, fft, spread, tree and random, of steal, "
     "forks:steal and each other runtime that is there, by default; grains change the cost of "
     "tasks, but not their number",
     2},
    {"set", SET, "KEY=VALUE", 0, "change a value of the scenes; may be given several times", 2},
    {"tasks", TASKS, "N", 0, "tasks of a synthetic graph (default: 1000)", 3},
    {"cost", COST, "SECONDS", 0, "what a task of a synthetic graph takes (default: 1e-5)", 3},
    {"bytes", BYTES, "N", 0, "what a task of a synthetic graph writes (default: 4096)", 3},
    {"steps", STEPS, "N", 0, "rounds of a graph in a run (default: 10)", 3},
    {"rounds", ROUNDS, "N", 0, "runs of each product (default: 10; with --metg 3)", 4},
    {"seed", SEED, "N", 0, "of the order of runs (default: 1)", 4},
    {"timeout", TIMEOUT, "SECONDS", 0, "most that a run may take (default: 600)", 4},
    {"output", OUTPUT, "DIR", 0, "the folder of all files (default: comparison)", 4},
    {0}};

/* ---- The command line ---- */

static void add(struct argp_state *state, struct compare_list *list, const char *item)
{
    if (list->n == COMPARE_MOST)
        argp_error(state, "more than %d of a kind, at %s", COMPARE_MOST, item);
    list->item[list->n++] = item;
}

static const char *const *names_of(int dimension)
{
    switch (dimension) {
    case SCHEDULER:
        return duite_scheduler_names();
    case MAPPING:
        return duite_mapping_names();
    case BALANCE:
        return duite_balancer_names();
    }
    return NULL;
}

static void check_item(struct argp_state *state, int dimension, const char *item)
{
    const struct compare *compare = state->input;
    const void *found = state;
    char *end = NULL, wrong[2500];
    const char *name = dimension == SCHEDULER ? compare_name_in_runtime(item) : NULL;
    const bool twin = name && !compare->program && compare_is_twin(item);
    if (twin && compare_twin_wrong(item, wrong, sizeof wrong))
        argp_error(state, "--scheduler %s: %s", item, wrong);
    if (dimension == SCHEDULER && !twin)
        found = duite_scheduler_find(name && !compare->program ? name : item);
    else if (dimension == MAPPING)
        found = duite_mapping_find(item);
    else if (dimension == BALANCE)
        found = duite_balancer_find(item);
    if (!found)
        argp_error(state, "--%s %s: %s", compare->name[dimension], item, duite_message());
    if (dimension == GRAIN || dimension == RANKS || dimension == THREADS) {
        double value = strtod(item, &end);
        if (end == item || *end || value < (dimension != GRAIN) || value > 1e9)
            argp_error(state, "--%s %s: a number is expected", compare->name[dimension], item);
    }
}

static void take_list(struct argp_state *state, struct compare *compare, int dimension, char *text)
{
    struct compare_list *list = &compare->list[dimension];
    const char *const *names = names_of(dimension);
    list->n = 0;
    if (names && !strcmp(text, "all")) {
        for (; *names; names++)
            add(state, list, *names);
        return;
    }
    for (char *item = strtok(text, ","); item; item = strtok(NULL, ",")) {
        check_item(state, dimension, item);
        add(state, list, item);
    }
    if (!list->n)
        argp_error(state, "--%s: a list is expected", compare->name[dimension]);
}

/* text: NAME=LIST. */
static void take_variable(struct argp_state *state, struct compare *compare, char *text)
{
    const int last = compare->dimensions;
    char *list = strchr(text, '=');
    if (!list || list == text || !list[1])
        argp_error(state, "--vary %s: NAME=VALUE,VALUE,... is expected", text);
    *list = 0;
    if (text[strspn(text, PROGRAM_NAME)])
        argp_error(state, "--vary %s: a name has letters, digits and _ only", text);
    if (last == COMPARE_ALL_DIMENSIONS)
        argp_error(state, "--vary %s: more than %d variables", text, COMPARE_VARIED);
    for (int d = 0; d < last; d++)
        if (!strcmp(compare->name[d], text))
            argp_error(state, "--vary %s: there is a list of this name already", text);
    compare->name[last] = text;
    compare->dimensions++;
    take_list(state, compare, last, list + 1);
}

/* A list that was not given has its default, which a program does not get. */
static void complete_lists(struct compare *compare)
{
    static const char *const defaults[COMPARE_DIMENSIONS] = {
        [GRAIN] = "0",      [RANKS] = "1",       [THREADS] = "2",
        [BALANCE] = "none", [MAPPING] = "metis", [SCHEDULER] = "steal"};
    for (int d = SUBJECT + 1; d < COMPARE_DIMENSIONS; d++)
        if (!compare->list[d].n)
            compare->list[d] = (struct compare_list){{compare->program ? "" : defaults[d]}, 1};
}

static void check_program(struct argp_state *state, const struct compare *compare)
{
    char wrong[500];
    size_t letters = (compare->figure ? strlen(compare->figure) : 0) +
                     (compare->same ? strlen(compare->same) : 0);
    for (char *const *word = compare->program; word && *word; word++)
        letters += strlen(*word) + 1;
    if (letters > COMPARE_COMMAND)
        argp_error(state,
                   "a program and its arguments have at most %d letters; put them in a script",
                   COMPARE_COMMAND);
    if (compare->program && strpbrk(*compare->program, ",\n"))
        argp_error(state, "%s: a comma or line in a name cannot stand in the files",
                   *compare->program);
    for (char *const *word = compare->program; word && *word; word++)
        if (program_word_wrong(compare, *word, wrong, sizeof wrong))
            argp_error(state, "%s", wrong);
    if (compare->program && *compare->list[GRAIN].item[0] && !program_names(compare, GRAIN))
        argp_error(state, "--grain: a program gets it as {grain} in its arguments only");
}

/* Its curves are of tasks that all runtimes run alike. */
static void check_metg(struct argp_state *state, const struct compare *compare)
{
    if (!compare->metg)
        return;
    if (compare->program)
        argp_error(state, "--metg is for graphs, not for a program after --");
    for (size_t i = 0; i < compare->list[SUBJECT].n; i++)
        if (compare_graph_is_file(compare->list[SUBJECT].item[i]))
            argp_error(state, "--metg: %s: one of " COMPARE_GRAPH_KINDS " is expected",
                       compare->list[SUBJECT].item[i]);
    for (size_t i = 0; i < compare->list[GRAIN].n; i++)
        if (!(strtod(compare->list[GRAIN].item[i], NULL) > 0))
            argp_error(state, "--metg --grain %s: a number above 0 is expected",
                       compare->list[GRAIN].item[i]);
}

static uint64_t number(struct argp_state *state, const char *text, uint64_t least, uint64_t most)
{
    char *end;
    uint64_t value = strtoull(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || value < least || value > most)
        argp_error(state, "%s: a number from %" PRIu64 " to %" PRIu64 " is expected", text, least,
                   most);
    return value;
}

/* The text that an option alone gives; NULL: it is another option. */
static const char **text_of(struct compare *compare, int key)
{
    switch (key) {
    case TASKS:
        return &compare->tasks;
    case COST:
        return &compare->cost;
    case BYTES:
        return &compare->bytes;
    case STEPS:
        return &compare->steps;
    case OUTPUT:
        return &compare->folder;
    }
    return NULL;
}

static void take_subject(struct argp_state *state, struct compare *compare, char *text)
{
    char wrong[500];
    if (compare->program)
        argp_error(state, "%s: a scene or graph beside a program after --", text);
    if (compare_graph_wrong(text, wrong, sizeof wrong))
        argp_error(state, "%s", wrong);
    add(state, &compare->list[SUBJECT], text);
}

static void take_figure(struct argp_state *state, struct compare *compare, char *text, bool figure)
{
    char wrong[500];
    if (figure_wrong(compare, text, wrong, sizeof wrong))
        argp_error(state, "--%s %s: %s", figure ? "figure" : "same", text, wrong);
    *(figure ? &compare->figure : &compare->same) = text;
}

static void complete(struct argp_state *state, struct compare *compare)
{
    enum { ROUNDS_OF_METG = 3, ROUNDS_ELSE = 10 };
    if (compare->metg && !compare->program)
        compare_metg_lists(compare);
    check_metg(state, compare);
    if (!compare->rounds)
        compare->rounds = compare->metg ? ROUNDS_OF_METG : ROUNDS_ELSE;
    complete_lists(compare);
    check_program(state, compare);
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    struct compare *compare = state->input;
    if (key >= LIST && key < LIST + COMPARE_DIMENSIONS) {
        take_list(state, compare, key - LIST, text);
        return 0;
    }
    if (compare->program && key >= TASKS && key <= SET)
        argp_error(state,
                   "%s: --set, --tasks, --cost, --bytes and --steps are for scenes and "
                   "graphs, not for a program after --",
                   text);
    if (text_of(compare, key)) {
        *text_of(compare, key) = text;
        return 0;
    }
    switch (key) {
    case VARY:
        take_variable(state, compare, text);
        return 0;
    case FIGURE:
    case SAME:
        take_figure(state, compare, text, key == FIGURE);
        return 0;
    case SET:
        if (!strchr(text, '='))
            argp_error(state, "--set %s: KEY=VALUE is expected", text);
        add(state, &compare->sets, text);
        return 0;
    case METG:
        compare->metg = true;
        return 0;
    case ROUNDS:
        compare->rounds = number(state, text, 1, COMPARE_ROUNDS);
        return 0;
    case SEED:
        compare->seed = number(state, text, 0, UINT64_MAX);
        return 0;
    case TIMEOUT:
        compare->timeout = (unsigned)number(state, text, 1, 1000000);
        return 0;
    case ARGP_KEY_ARG:
        take_subject(state, compare, text);
        return 0;
    case ARGP_KEY_NO_ARGS:
        if (compare->program)
            return 0;
        if (!compare->metg)
            argp_error(state,
                       "what is to be run? A scene, a graph file, one of " COMPARE_GRAPH_KINDS
                       ", or -- and a program");
        return 0;
    case ARGP_KEY_END:
        complete(state, compare);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* ---- The program ---- */

/* The words behind -- are the program's, its options too. */
static void take_program(struct compare *compare, int *argc, char **argv)
{
    for (int i = 1; i < *argc && !compare->program; i++)
        if (!strcmp(argv[i], "--") && i + 1 < *argc) {
            compare->program = argv + i + 1;
            compare->list[SUBJECT] = (struct compare_list){{argv[i + 1]}, 1};
            *argc = i;
        }
    if (compare->program)
        argv[*argc] = NULL;
}

const char *argp_program_version = "duite-compare (" PACKAGE_STRING ")";

int main(int argc, char **argv)
{
    static struct compare compare = {
        .dimensions = COMPARE_DIMENSIONS,
        .name = {"subject", "grain", "ranks", "threads", "balance", "mapping", "scheduler"},
        .folder = "comparison",
        .tasks = "1000",
        .cost = "1e-5",
        .bytes = "4096",
        .steps = "10",
        .seed = 1,
        .timeout = 600};
    const struct argp argp = {
        OPTIONS,
        parse,
        "SCENE.yaml|GRAPH...\n-- PROGRAM [ARGUMENT...]",
        "Compares schedulers, mappings, balancers, grains, ranks, threads and variables of the "
        "environment: every product of the lists, in rounds of random order.\vA program after -- "
        "gets the lists as DUITE_SCHEDULER, DUITE_MAPPING, DUITE_BALANCE, DUITE_THREADS, "
        "OMP_NUM_THREADS and STARPU_NCPU, runs under mpirun on more than one rank, and has a "
        "value wherever its arguments have the {name} of a list.\n\nA comparison that was "
        "interrupted goes on where it stopped when the same command is given again; longer lists "
        "and more --rounds are added to it. Results are in the folder: compare.html has all, "
        "summary.csv every run. The status is 1 if a run failed, a result was wrong, or something "
        "could not be written.",
        NULL,
        NULL,
        NULL};
    argp_err_exit_status = 2;
    take_program(&compare, &argc, argv);
    if (argp_parse(&argp, argc, argv, 0, NULL, &compare))
        return 2;
    setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 0);
    setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 0);
    if (!geteuid()) { /* Open MPI asks for it */
        setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
        setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
    }
    return compare_run(&compare);
}
