#ifndef DUITE_TOOLS_COMPARE_COMPARE_H
#define DUITE_TOOLS_COMPARE_COMPARE_H

#include "tools/compare/load.h"

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* A comparison: the product of some lists, each member run once a round, the members of a round in
 * an order drawn at random. Each run is a line of a journal (summary.csv), so that a comparison
 * goes on where it was interrupted. Strings are the command line's. */

/* The most letters of a program with its arguments and --figure, which the journal keeps. */
enum { COMPARE_COMMAND = 10000 };
enum { COMPARE_MOST = 24, COMPARE_CONFIGS = 2000, COMPARE_ROUNDS = 1000, COMPARE_VARIED = 8 };
/* Rounds from which on order statistics have an interval of 95 %. */
enum { COMPARE_ENOUGH = 6 };

struct compare_list {
    const char *item[COMPARE_MOST];
    size_t n;
};

/* One run. Times are seconds of a step, of a round of a graph, or of a program; or what --figure
 * finds. Numbers that a program does not tell are NAN. */
struct compare_run {
    double seconds, bodies; /* bodies: in bodies of tasks, a worker; the rest is outside of them */
    double stolen, messages, bytes;
    char result[64];          /* the same in all runs that should agree; empty: it is not known */
    char *why;                /* it failed: how it ended, and its last error */
    bool done, fine, stopped; /* stopped: by the limit, --timeout */
    bool reported;            /* by a program of duite, which can be traced */
};

/* Dimensions of the product, in the order in which the last one changes first. Behind them are the
 * variables of the environment that --vary names. */
enum { SUBJECT, GRAIN, RANKS, THREADS, BALANCE, MAPPING, SCHEDULER, COMPARE_DIMENSIONS };
enum { COMPARE_ALL_DIMENSIONS = COMPARE_DIMENSIONS + COMPARE_VARIED };

struct compare_config {
    const char *value[COMPARE_ALL_DIMENSIONS];
    struct compare_run *run; /* rounds of them */
    /* From those that are fine: */
    size_t n;
    double median, low, high; /* low .. high: 95 % for the median if runs are enough, else all */
    double bodies, outside;   /* medians */
    double ratio, ratio_low, ratio_high; /* to the fastest of its subject, within rounds */
    double cores;                        /* ranks times threads, as far as they were given */
    double speedup, efficiency; /* against the member with the fewest cores of those that differ in
                                   cores alone; NAN: there is no such pair */
    bool fastest, few, noise; /* few: too few rounds to tell; noise: the difference to it is none */
    bool known;               /* the journal had a run of it when it was opened */
};

struct compare {
    int dimensions; /* that there are */
    const char *name[COMPARE_ALL_DIMENSIONS];
    struct compare_list list[COMPARE_ALL_DIMENSIONS];
    struct compare_list sets;  /* of scenes */
    char *const *program;      /* and its arguments, or NULL. Lists that were not given have one
                                  empty value, which it does not get */
    const char *figure, *same; /* what finds them (tools/compare/figure.h), or NULL */
    const char *folder, *tasks, *cost, *bytes, *steps;
    const char *trace; /* a file for the traces of runs, or NULL */
    uint64_t seed;
    size_t rounds;
    unsigned timeout; /* s: a run that takes longer is stopped */
    bool metg;        /* grains change the cost of tasks alone, and the curves are drawn */
    struct compare_config *config;
    size_t n;
    FILE *journal, *about; /* about.txt */
    char *where;           /* the host and the build, a line each */
    struct load load;      /* from the first run on, then from that of a round on */
    char warnings[2000];   /* a line each */
    bool wrong;            /* two runs that should agree have not the same result */
    size_t failed;         /* runs that did */
};

/* Opens the journal and takes over what is there, or begins it. about.txt beside it has what is
 * compared, the host, the build and warnings. Lists may have grown meanwhile. 1, said on stderr, if
 * it is another comparison's or cannot be written. */
int compare_journal_open(struct compare *compare);
/* Appends a run and sees to it that it is on the disk. 1, said on stderr: nothing more can be kept.
 */
int compare_journal_add(struct compare *compare, const struct compare_config *config, size_t round);
/* Adds a warning: to about.txt, so that a comparison that is taken up again keeps it, to
 * compare->warnings, and on stderr. NULL is none. */
void compare_journal_warn(struct compare *compare, const char *warning);
void compare_journal_close(struct compare *compare);

/* The path of a program that lies beside this one, or in a folder there. */
enum { COMPARE_PROGRAM = PATH_MAX + 100 };
const char *compare_find_program(const char *name, char path[COMPARE_PROGRAM]);

/* A scheduler RUNTIME:NAME is another runtime's, whose twin of duite-graph runs (bench/rivals), or
 * duite's own without replays ("forks:NAME"). The name behind the colon; NULL: it has none. */
const char *compare_name_in_runtime(const char *scheduler);
/* Returns true if it is another runtime's. */
bool compare_is_twin(const char *scheduler);
/* NULL if the twin is there and has the scheduler, else the reason, written to text. */
const char *compare_twin_wrong(const char *scheduler, char *text, size_t size);

/* The unit of figures, and how many of them a second is. */
static inline const char *compare_unit(const struct compare *compare)
{
    return compare->figure ? "figure" : "ms";
}
static inline double compare_scale(const struct compare *compare)
{
    return compare->figure ? 1 : 1e3;
}

/* --metg: fills lists that were not given, and says which runtimes are left out. */
void compare_metg_lists(struct compare *compare);
/* Writes the efficiency of each run's tasks over their granularity (metg.csv), draws it on the
 * page, and tells there and on the terminal how short tasks may be. 1, said on stderr, if the file
 * cannot be written. */
int compare_metg(const struct compare *compare, FILE *page);

/* A file of the folder for writing, and its end. NULL and 1, said on stderr, if it cannot be
 * written. */
FILE *compare_open(const struct compare *compare, const char *name);
int compare_close(const struct compare *compare, const char *name, FILE *file);

/* Starts a run and reads its figures; run->done is set in any case. The log of one that failed
 * becomes failed.log, unless compare->trace is set. */
void compare_start(const struct compare *compare, const struct compare_config *config,
                   struct compare_run *run);

/* Runs a comparison whose lists are there, and writes its folder. 1 if a run failed, results
 * disagree, or something could not be written: said on stderr. */
int compare_run(struct compare *compare);

/* Fills in medians, intervals and verdicts. */
void compare_judge(struct compare *compare);
/* The median of n values and the interval of its 95 %, of order statistics: the k-th from both ends
 * with the largest k for which fewer than k of n tosses come out heads with a probability of at
 * most 2.5 %; of fewer than 6 values all of them. Sorts the values. */
double compare_median(double *values, size_t n, double *low, double *high);

static inline bool compare_varies(const struct compare *compare, int dimension)
{
    return dimension != SUBJECT && compare->list[dimension].n > 1;
}

/* The values of what varies: with names, or (a label) short and without the dimensions of
 * `without`, a set of bits. */
void compare_print_member(const struct compare *compare, const struct compare_config *config,
                          FILE *out);
void compare_print_label(const struct compare *compare, const struct compare_config *config,
                         unsigned without, FILE *out);

/* How many runs of it failed; *first, if any, is the first one. */
size_t compare_failures(const struct compare *compare, const struct compare_config *config,
                        const struct compare_run **first);

/* Fills row with the members of a subject from the fastest on, those without figures last; returns
 * their number. */
size_t compare_sort(const struct compare *compare, const char *subject, size_t *row);

/* The table of n members, of Markdown or of HTML. */
void compare_print_table(const struct compare *compare, const size_t *row, size_t n, bool html,
                         FILE *out);

/* Plots of a subject's members, sorted, as elements of a page. */
void compare_print_plots(const struct compare *compare, const size_t *row, size_t n, FILE *out);

/* Runs the best and the worst of a subject's members, sorted, once more with a trace in the folder,
 * if any run of this process reported. */
void compare_trace(const struct compare *compare, size_t subject, const size_t *row, size_t n);
/* Charts of their traces, as far as these are there, as elements of a page. */
void compare_print_traces(const struct compare *compare, size_t subject, const size_t *row,
                          size_t n, FILE *out);

/* Tables on the terminal, and compare.html. 1, said on stderr, if it cannot be written. */
int compare_page(const struct compare *compare);

#endif
