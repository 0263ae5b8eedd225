/* Runs random programs on groups of the ranks of one job, each group on its own. A program is its
 * seed, the number of ranks and the features that are forced; how it runs follows from the seed,
 * too, except for given options. */

#include "tests/runtime/random_options.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

enum { MOST_SECONDS = 120, MOST_WRONG = 20, SHRINK_REPEATS = 20 };

static char running[512]; /* the command that repeats the program that runs, for the handler */
static volatile size_t where;
static unsigned long recognised; /* tasks, of all programs of this process */

/* Seconds of this process on cores, which a rank that hangs spends looking for messages; a machine
 * that others use is slow without anything hanging. 0: no limit. */
static void limit_running(time_t seconds)
{
    setitimer(ITIMER_PROF, &(struct itimerval){.it_value.tv_sec = seconds}, NULL);
}

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
        limit_running(MOST_SECONDS);
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
        if (*kind == PROG_NEW || *kind == PROG_FREE || *kind == PROG_RELEASE ||
            *kind == PROG_KERNEL || *kind == PROG_SKIP || *kind == PROG_SPLIT || *kind == PROG_JOIN)
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
static int run_seed(const struct options *options, uint64_t seed, MPI_Comm comm)
{
    const struct prog_setup setup = options_setup(options, seed, comm);
    const unsigned long repeat = (unsigned long)options->number[OPTION_REPEAT];
    struct prog_report report;
    struct prog *prog;
    int ranks, wrong;

    MPI_Comm_size(comm, &ranks);
    snprintf(running, sizeof running,
             "mpirun -n %d tests/runtime/random_programs --seed %llu --ranks %d --threads %u "
             "--scheduler %s --mapping %s --balance %s "
             "--window %zu --memo %d --check %d%s",
             ranks, (unsigned long long)seed, ranks, setup.threads, setup.scheduler, setup.mapping,
             setup.balance, setup.window, setup.memo, setup.check, options->forced);
    prog = prog_make(seed, ranks, options->with, options->without);
    wrong = try_program(prog, &setup, repeat, &report);
    if (wrong)
        tell(prog, &setup, &report);
    if (wrong && options->number[OPTION_SEED] >= 0)
        shrink(prog, setup, repeat < SHRINK_REPEATS ? SHRINK_REPEATS : repeat);
    prog_free(prog);
    limit_running(0);
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
static void run_group(const struct options *options, unsigned group, unsigned long n, MPI_Comm comm,
                      unsigned long *done)
{
    const uint64_t base = (uint64_t)options->number[OPTION_BASE];
    unsigned long wrong = 0;
    int member;

    MPI_Comm_rank(comm, &member);
    for (unsigned long i = 0; i < n && wrong < MOST_WRONG; i++) {
        wrong += (unsigned)run_seed(options, base + group * 1000000ull + i, comm);
        done[0] += member == 0;
    }
    done[1] += member == 0 ? wrong : 0;
}

/* Four ranks are cut into groups; fewer or more are one group. */
static void run_many(const struct options *options, int rank, int size, unsigned long *done)
{
    const unsigned long programs = (unsigned long)options->number[OPTION_PROGRAMS];

    if (size != 4) {
        run_group(options, 0, programs, MPI_COMM_WORLD, done);
        return;
    }
    for (unsigned w = 0; w < sizeof WAYS / sizeof *WAYS; w++) {
        const unsigned group = (unsigned)WAYS[w].group[rank];
        MPI_Comm comm;

        MPI_Comm_split(MPI_COMM_WORLD, (int)group, 0, &comm);
        run_group(options, w * 4 + group, programs * WAYS[w].share / SHARES + 1, comm, done);
        MPI_Comm_free(&comm);
    }
}

static int run_one(const struct options *options, int rank)
{
    MPI_Comm comm;
    int wrong;

    MPI_Comm_split(MPI_COMM_WORLD, rank < options->number[OPTION_RANKS] ? 0 : MPI_UNDEFINED, 0,
                   &comm);
    if (comm == MPI_COMM_NULL)
        return 0;
    wrong = run_seed(options, (uint64_t)options->number[OPTION_SEED], comm);
    MPI_Comm_free(&comm);
    return rank == 0 && wrong;
}

int main(int argc, char **argv)
{
    struct options options;
    unsigned long mine[3] = {0, 0, 0}, sum[3];
    int rank, size, given;

    signal(SIGPROF, last_words);
    /* A rank that waits for its group inside MPI would spin on a core that another rank needs. */
    setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (!options_read(&options, argc, argv, size)) {
        fprintf(
            stderr,
            "%s: --base SEED --programs N, on 1 to 16 ranks; or --seed SEED --ranks R [--threads "
            "T] [--scheduler S] [--mapping M] [--balance B] [--window W] [--memo M] [--check C] "
            "[--repeat N] [--verbose], on R ranks or more. Both: --with or --without FEATURE\n",
            argv[0]);
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
    if (options.number[OPTION_SEED] >= 0) {
        mine[0] = rank == 0;
        mine[1] = (unsigned)run_one(&options, rank);
    } else {
        run_many(&options, rank, size, mine);
    }
    mine[2] = recognised;
    MPI_Allreduce(mine, sum, 3, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0)
        printf("%sok 1 - %lu random programs, %lu wrong\n1..1\n# %lu tasks recognised\n",
               sum[1] ? "not " : "", sum[0], sum[1], sum[2]);
    MPI_Finalize();
    return sum[1] != 0;
}
