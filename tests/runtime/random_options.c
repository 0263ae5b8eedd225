/* Options by name: numbers, policies, features. */

#include "tests/runtime/random_options.h"

#include "runtime/balance/balance.h"
#include "runtime/sched/sched.h"
#include "tests/support/policies.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RANKS = 16 }; /* as groups of programs */

static const struct option OPTIONS[] = {{"seed", 1, NULL, OPTION_SEED},
                                        {"base", 1, NULL, OPTION_BASE},
                                        {"ranks", 1, NULL, OPTION_RANKS},
                                        {"programs", 1, NULL, OPTION_PROGRAMS},
                                        {"repeat", 1, NULL, OPTION_REPEAT},
                                        {"threads", 1, NULL, OPTION_THREADS},
                                        {"window", 1, NULL, OPTION_WINDOW},
                                        {"memo", 1, NULL, OPTION_MEMO},
                                        {"check", 1, NULL, OPTION_CHECK},
                                        {"scheduler", 1, NULL, N_OPTION_NUMBERS + OPTION_SCHEDULER},
                                        {"mapping", 1, NULL, N_OPTION_NUMBERS + OPTION_MAPPING},
                                        {"balance", 1, NULL, N_OPTION_NUMBERS + OPTION_BALANCE},
                                        {"with", 1, NULL, '+'},
                                        {"without", 1, NULL, '-'},
                                        {"verbose", 0, NULL, 'v'},
                                        {NULL, 0, NULL, 0}};

/* Returns whether there is such a feature. */
static int force_feature(struct options *options, int with, const char *name)
{
    const size_t n = strlen(options->forced);

    for (unsigned f = 0; f < PROG_N_FEATURES; f++)
        if (!strcmp(prog_features[f], name)) {
            *(with ? &options->with : &options->without) |= 1u << f;
            snprintf(options->forced + n, sizeof options->forced - n, " --with%s %s",
                     with ? "" : "out", name);
            return 1;
        }
    return 0;
}

static int are_policies(const struct options *options)
{
    const char *const *text = options->text;

    return (!text[OPTION_SCHEDULER] || duite_scheduler_find(text[OPTION_SCHEDULER])) &&
           (!text[OPTION_MAPPING] || duite_mapping_find(text[OPTION_MAPPING])) &&
           (!text[OPTION_BALANCE] || duite_balancer_find(text[OPTION_BALANCE]));
}

int options_read(struct options *options, int argc, char **argv, int n_ranks)
{
    int fine = 1;

    *options = (struct options){0};
    for (int i = 0; i < N_OPTION_NUMBERS; i++)
        options->number[i] = -1;
    options->number[OPTION_BASE] = options->number[OPTION_RANKS] = 1;
    options->number[OPTION_REPEAT] = 1;
    options->number[OPTION_PROGRAMS] = 500;
    for (int c; (c = getopt_long(argc, argv, "", OPTIONS, NULL)) != -1;)
        if (c < N_OPTION_NUMBERS)
            options->number[c] = atoll(optarg);
        else if (c < N_OPTION_NUMBERS + N_OPTION_TEXTS)
            options->text[c - N_OPTION_NUMBERS] = optarg;
        else if (c == 'v')
            options->verbose = 1;
        else
            fine &= (c == '+' || c == '-') && force_feature(options, c == '+', optarg);
    return fine && optind == argc && are_policies(options) && options->number[OPTION_RANKS] > 0 &&
           options->number[OPTION_RANKS] <= n_ranks &&
           (options->number[OPTION_SEED] >= 0 || n_ranks <= MOST_RANKS);
}

static long long given(const struct options *options, enum option_number number, uint64_t drawn)
{
    return options->number[number] >= 0 ? options->number[number] : (long long)drawn;
}

static const char *given_policy(const struct options *options, enum option_text text,
                                uint64_t *random, const char *const *names,
                                const char *const *adversaries)
{
    const size_t drawn = duite_random(random) % policies_count(names, adversaries);

    return options->text[text] ? options->text[text] : policies_at(names, adversaries, drawn);
}

struct prog_setup options_setup(const struct options *options, uint64_t seed, MPI_Comm comm)
{
    static const double SPINS[] = {0, 1e-6, 100e-6};
    static const size_t WINDOWS[] = {0, 0, 1, 1, 2, 7, 30};
    static const unsigned MEMOS[] = {0, 1, 2, 2, 2};
    static const char *const none[] = {NULL};
    struct prog_setup setup = {.comm = comm, .verbose = options->verbose};
    uint64_t random = ~seed;
    const size_t window = duite_random(&random) % (sizeof WINDOWS / sizeof *WINDOWS);
    const size_t memo = duite_random(&random) % (sizeof MEMOS / sizeof *MEMOS);

    setup.seed = duite_random(&random);
    setup.spin = SPINS[duite_random(&random) % 3];
    setup.threads = (unsigned)given(options, OPTION_THREADS, 1 + duite_random(&random) % 4);
    setup.window = (size_t)given(options, OPTION_WINDOW, WINDOWS[window]);
    setup.memo = (int)given(options, OPTION_MEMO, MEMOS[memo]);
    setup.check = (int)given(options, OPTION_CHECK, duite_random(&random) % 20 == 0);
    setup.scheduler = given_policy(options, OPTION_SCHEDULER, &random, duite_scheduler_names(),
                                   sched_test_names());
    setup.mapping = given_policy(options, OPTION_MAPPING, &random, duite_mapping_names(), none);
    setup.balance = given_policy(options, OPTION_BALANCE, &random, duite_balancer_names(),
                                 balance_test_names());
    return setup;
}
