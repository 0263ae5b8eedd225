/* Runs random programs on groups of the ranks of one job, each group on its own. A
 * program is its seed and the number of ranks; threads, scheduler, mapping and balancer follow from
 * the seed too unless they are given. */

#include "runtime/balance/balance.h"
#include "runtime/sched/sched.h"
#include "tests/runtime/random_program.h"
#include "tests/support/policies.h"

#include <getopt.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct settings {
    uint64_t seed; /* of one program, or the first of many */
    int one, ranks, threads, window, memo, check, verbose;
    unsigned with, without; /* features, a bit each, ... */
    char forced[200];       /* ... and as options */
    unsigned long programs, repeat;
    const char *scheduler, *mapping, *balance;
};

static char running[512]; /* the program that runs, for the handler */
static volatile size_t where;
static unsigned long recognised; /* tasks, of all programs of this process */

/* Says what was running when the job hangs. */
static void last_words(int number)
{
    char line[600] = "# hangs: ", digits[24], *d = digits + sizeof digits - 1;
    size_t at = where;

    (void)number;
    *d = '\0';
    do
        *--d = (char)('0' + at % 10);
    while (at /= 10);
    strcat(strcat(strcat(strcat(line, running), " operation "), d), "\n");
    if (write(STDERR_FILENO, line, strlen(line)) < 0)
        _exit(4);
    _exit(3);
}

static const char *draw_policy(uint64_t *random, const char *const *names,
                               const char *const *adversaries)
{
    const size_t n = policies_count(names, adversaries);
    return policies_at(names, adversaries, duite_random(random) % n);
}

static struct prog_setup draw_setup(const struct settings *settings, uint64_t seed, MPI_Comm comm)
{
    static const double SPINS[] = {0, 1e-6, 100e-6};
    static const size_t WINDOWS[] = {0, 0, 1, 1, 2, 7, 30};
    static const int MEMOS[] = {0, 1, 2, 2, 2};
    struct prog_setup setup = {.comm = comm, .verbose = settings->verbose};
    uint64_t random = ~seed;

    setup.seed = duite_random(&random);
    setup.threads = 1 + (unsigned)(duite_random(&random) % 4);
    setup.spin = SPINS[duite_random(&random) % 3];
    setup.window = WINDOWS[duite_random(&random) % (sizeof WINDOWS / sizeof *WINDOWS)];
    setup.scheduler = draw_policy(&random, duite_scheduler_names(), sched_test_names());
    setup.mapping = draw_policy(&random, duite_mapping_names(), (const char *[]){NULL});
    setup.balance = draw_policy(&random, duite_balancer_names(), balance_test_names());
    setup.memo = MEMOS[duite_random(&random) % (sizeof MEMOS / sizeof *MEMOS)];
    setup.check = duite_random(&random) % 20 == 0;
    if (settings->balance)
        setup.balance = settings->balance;
    if (settings->window >= 0)
        setup.window = (size_t)settings->window;
    if (settings->memo >= 0)
        setup.memo = settings->memo;
    if (settings->check >= 0)
        setup.check = settings->check;
    if (settings->threads > 0)
        setup.threads = (unsigned)settings->threads;
    if (settings->scheduler)
        setup.scheduler = settings->scheduler;
    if (settings->mapping)
        setup.mapping = settings->mapping;
    return setup;
}

/* The rank of the group that found something first; -1 if none did. */
static int finder(const struct prog_setup *setup, const struct prog_report *report)
{
    const unsigned long long none = ~0ull >> 1; /* MPICH 4.0 compares as if they had a sign */
    unsigned long long mine = none, first;
    int rank;

    MPI_Comm_rank(setup->comm, &rank);
    if (report->text[0])
        mine = (unsigned long long)report->op << 16 | (unsigned)rank;
    MPI_Allreduce(&mine, &first, 1, MPI_UNSIGNED_LONG_LONG, MPI_MIN, setup->comm);
    return first == none ? -1 : (int)(first & 0xffff);
}

/* Interprets and runs `repeat` times; returns whether something was found, the same on the whole
 * group. */
static int try_program(const struct prog *prog, const struct prog_setup *setup,
                       unsigned long repeat, struct prog_report *report)
{
    struct prog_answers *answers = prog_interpret(prog);
    int wrong = 0;

    for (unsigned long i = 0; i < repeat && !wrong; i++) {
        alarm(120);
        prog_run(prog, answers, setup, report, &where);
        recognised += report->recognised;
        wrong = finder(setup, report) >= 0;
    }
    prog_answers_free(prog, answers);
    return wrong;
}

/* Tries without n operations of a list; keeps them if the program is then right. */
static void leave_out(struct prog *prog, const struct prog_setup *setup, unsigned long repeat,
                      struct prog_op *ops, size_t n)
{
    enum prog_kind *kept = prog_memory(n, sizeof *kept);
    struct prog_report report;
    int changed = 0;

    for (size_t i = 0; i < n; i++) {
        enum prog_kind *kind = &ops[i].kind;

        kept[i] = *kind;
        if (*kind == PROG_NEW || *kind == PROG_FREE || *kind == PROG_SKIP)
            continue;
        *kind = PROG_SKIP;
        changed = 1;
    }
    if (changed && !try_program(prog, setup, repeat, &report))
        for (size_t i = 0; i < n; i++)
            ops[i].kind = kept[i];
    free(kept);
}

static void shrink_list(struct prog *prog, const struct prog_setup *setup, unsigned long repeat,
                        struct prog_op *ops, size_t n_ops)
{
    for (size_t n = n_ops; n > 0; n /= 2)
        for (size_t at = 0; at < n_ops; at += n)
            leave_out(prog, setup, repeat, &ops[at], n_ops - at < n ? n_ops - at : n);
}

/* Leaves out of a failing program what can go while it still fails, and prints the rest. */
static void shrink(struct prog *prog, struct prog_setup setup, unsigned long repeat)
{
    int rank;

    MPI_Comm_rank(setup.comm, &rank);
    setup.verbose = 0;
    shrink_list(prog, &setup, repeat, prog->ops, prog->n_ops);
    shrink_list(prog, &setup, repeat, prog->inner, prog->n_inner);
    if (rank == 0)
        printf("# still wrong with these operations only:\n");
    for (size_t i = 0; rank == 0 && i < prog->n_ops; i++)
        if (prog->ops[i].kind != PROG_SKIP)
            prog_print(stdout, prog, i);
}

static void tell(const struct prog *prog, const struct prog_setup *setup,
                 const struct prog_report *report)
{
    const int first = finder(setup, report);
    int rank;

    MPI_Comm_rank(setup->comm, &rank);
    if (rank != first)
        return;
    printf("# WRONG: %s on rank %d: %s\n", running, rank, report->text);
    if (report->op < prog->n_ops)
        prog_print(stdout, prog, report->op);
    fflush(stdout);
}

/* Returns whether the program went wrong, the same on the whole group. */
static int run_seed(const struct settings *settings, uint64_t seed, MPI_Comm comm)
{
    const struct prog_setup setup = draw_setup(settings, seed, comm);
    struct prog_report report;
    struct prog *prog;
    int ranks, wrong;

    MPI_Comm_size(comm, &ranks);
    snprintf(running, sizeof running,
             "--seed %llu --ranks %d --threads %u --scheduler %s --mapping %s --balance %s "
             "--window %zu --memo %d --check %d%s",
             (unsigned long long)seed, ranks, setup.threads, setup.scheduler, setup.mapping,
             setup.balance, setup.window, setup.memo, setup.check, settings->forced);
    prog = prog_make(seed, ranks, settings->with, settings->without);
    wrong = try_program(prog, &setup, settings->repeat, &report);
    if (wrong)
        tell(prog, &setup, &report);
    if (wrong && settings->one)
        shrink(prog, setup, settings->repeat < 20 ? 20 : settings->repeat);
    prog_free(prog);
    alarm(0);
    return wrong;
}

/* Ways to cut four ranks into groups, and how many programs a group of each runs: mostly small
 * groups, since more ranks than cores take long. */
static const struct way {
    int group[4];
    unsigned share;
} WAYS[] = {{{0, 1, 2, 3}, 12},
            {{0, 1, 2, 2}, 8},
            {{0, 0, 1, 1}, 10},
            {{0, 1, 1, 1}, 5},
            {{0, 0, 0, 0}, 5}};
enum { SHARES = 4 * 12 + 3 * 8 + 2 * 10 + 2 * 5 + 5 };

/* Adds to done[0] the programs that a group ran, to done[1] the wrong ones, on its first rank. */
static void run_group(const struct settings *settings, unsigned group, unsigned long n,
                      MPI_Comm comm, unsigned long *done)
{
    unsigned long wrong = 0;
    int member;

    MPI_Comm_rank(comm, &member);
    for (unsigned long i = 0; i < n && wrong < 20; i++) {
        wrong += (unsigned)run_seed(settings, settings->seed + group * 1000000ull + i, comm);
        done[0] += member == 0;
    }
    done[1] += member == 0 ? wrong : 0;
}

/* Four ranks are cut into groups; fewer or more are one group. */
static void run_many(const struct settings *settings, int rank, int size, unsigned long *done)
{
    if (size != 4) {
        run_group(settings, 0, settings->programs, MPI_COMM_WORLD, done);
        return;
    }
    for (unsigned w = 0; w < sizeof WAYS / sizeof *WAYS; w++) {
        const unsigned group = (unsigned)WAYS[w].group[rank];
        MPI_Comm comm;

        MPI_Comm_split(MPI_COMM_WORLD, (int)group, 0, &comm);
        run_group(settings, w * 4 + group, settings->programs * WAYS[w].share / SHARES + 1, comm,
                  done);
        MPI_Comm_free(&comm);
    }
}

/* --with or --without FEATURE; returns whether there is none of that name. */
static int force(struct settings *settings, const char *option, const char *name)
{
    const size_t n = strlen(settings->forced);

    for (unsigned f = 0; f < PROG_N_FEATURES; f++)
        if (!strcmp(prog_features[f], name)) {
            *(option[4] ? &settings->without : &settings->with) |= 1u << f;
            snprintf(settings->forced + n, sizeof settings->forced - n, " --%s %s", option, name);
            return 0;
        }
    return 1;
}

static int read_number(struct settings *settings, int option, const char *text)
{
    if (option == 's' || option == 'b')
        settings->seed = strtoull(text, NULL, 10);
    else if (option == 'r')
        settings->ranks = atoi(text);
    else if (option == 't')
        settings->threads = atoi(text);
    else if (option == 'w')
        settings->window = atoi(text);
    else if (option == 'n')
        settings->repeat = strtoul(text, NULL, 10);
    else if (option == 'p')
        settings->programs = strtoul(text, NULL, 10);
    else if (option == 'o')
        settings->memo = atoi(text);
    else if (option == 'c')
        settings->check = atoi(text);
    else
        return 1;
    settings->one |= option == 's';
    return 0;
}

static int read_options(int argc, char **argv, struct settings *settings)
{
    static const struct option OPTIONS[] = {
        {"seed", 1, NULL, 's'},    {"base", 1, NULL, 'b'},    {"ranks", 1, NULL, 'r'},
        {"threads", 1, NULL, 't'}, {"repeat", 1, NULL, 'n'},  {"programs", 1, NULL, 'p'},
        {"mapping", 1, NULL, 'm'}, {"verbose", 0, NULL, 'v'}, {"scheduler", 1, NULL, 'q'},
        {"balance", 1, NULL, 'a'}, {"window", 1, NULL, 'w'},  {"with", 1, NULL, '+'},
        {"without", 1, NULL, '-'}, {"memo", 1, NULL, 'o'},    {"check", 1, NULL, 'c'},
        {NULL, 0, NULL, 0}};

    for (int c; (c = getopt_long(argc, argv, "", OPTIONS, NULL)) != -1;) {
        if (c == 'm')
            settings->mapping = optarg;
        else if (c == 'a')
            settings->balance = optarg;
        else if (c == 'q')
            settings->scheduler = optarg;
        else if (c == 'v')
            settings->verbose = 1;
        else if (c == '+' || c == '-' ? force(settings, c == '+' ? "with" : "without", optarg)
                                      : read_number(settings, c, optarg))
            return 1;
    }
    return optind < argc || (settings->scheduler && !duite_scheduler_find(settings->scheduler)) ||
           (settings->balance && !duite_balancer_find(settings->balance)) ||
           (settings->mapping && !duite_mapping_find(settings->mapping));
}

static int run_one(const struct settings *settings, int rank)
{
    MPI_Comm comm;
    int wrong;

    MPI_Comm_split(MPI_COMM_WORLD, rank < settings->ranks ? 0 : MPI_UNDEFINED, 0, &comm);
    if (comm == MPI_COMM_NULL)
        return 0;
    wrong = run_seed(settings, settings->seed, comm);
    MPI_Comm_free(&comm);
    return rank == 0 && wrong;
}

int main(int argc, char **argv)
{
    struct settings settings = {
        .seed = 1, .ranks = 1, .window = -1, .memo = -1, .check = -1, .programs = 500, .repeat = 1};
    unsigned long mine[3] = {0, 0, 0}, sum[3];
    int rank, size, given;

    signal(SIGALRM, last_words);
    /* A rank that waits for its group inside MPI would spin on a core that another rank needs. */
    setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (read_options(argc, argv, &settings) || settings.ranks > size || settings.ranks < 1 ||
        (!settings.one && size > 16)) {
        fprintf(
            stderr,
            "%s: --base SEED --programs N, on 1 to 16 ranks; or --seed SEED --ranks R [--threads "
            "T] [--scheduler S] [--mapping M] [--balance B] [--window W] [--memo M] [--check C] "
            "[--repeat N] [--verbose], on R ranks or more. Both: --with or --without FEATURE\n",
            argv[0]);
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
    if (settings.one) {
        mine[0] = rank == 0;
        mine[1] = (unsigned)run_one(&settings, rank);
    } else {
        run_many(&settings, rank, size, mine);
    }
    mine[2] = recognised;
    MPI_Allreduce(mine, sum, 3, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0)
        printf("%sok 1 - %lu random programs, %lu wrong\n1..1\n# %lu tasks recognised\n",
               sum[1] ? "not " : "", sum[0], sum[1], sum[2]);
    MPI_Finalize();
    return sum[1] != 0;
}
