/* The runs of a comparison: each member of the product once a round, in an order drawn at random
 * from the seed and the round alone, so that one that is taken up again goes on in the same order.
 */
#include "tools/compare/compare.h"

#include <duite_policy.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- The product ---- */

/* Other runtimes have graphs alone, and no ranks, mappings and balancers. */
static bool makes_sense(const struct compare *compare, const struct compare_config *config)
{
    if (compare->program || !compare_name_in_runtime(config->value[SCHEDULER]))
        return true;
    const char *end = strrchr(config->value[SUBJECT], '.');
    if (end && !strcmp(end, ".yaml"))
        return false;
    return !compare_is_twin(config->value[SCHEDULER]) ||
           (!strcmp(config->value[RANKS], "1") &&
            config->value[MAPPING] == compare->list[MAPPING].item[0] &&
            config->value[BALANCE] == compare->list[BALANCE].item[0]);
}

static int multiply(struct compare *compare)
{
    size_t all = 1;
    for (int d = 0; d < compare->dimensions; d++)
        all *= compare->list[d].n;
    if (all > COMPARE_CONFIGS) {
        fprintf(stderr, "duite-compare: %zu configurations; at most %d\n", all, COMPARE_CONFIGS);
        return 1;
    }
    compare->config = calloc(all, sizeof *compare->config);
    for (size_t i = 0; i < all && compare->config; i++) {
        struct compare_config *config = &compare->config[compare->n];
        size_t rest = i;
        for (int d = compare->dimensions - 1; d >= 0; d--) {
            config->value[d] = compare->list[d].item[rest % compare->list[d].n];
            rest /= compare->list[d].n;
        }
        if (!makes_sense(compare, config))
            continue;
        config->run = calloc(compare->rounds, sizeof *config->run);
        if (!config->run)
            break;
        compare->n++;
    }
    if (!compare->n)
        fprintf(stderr, "duite-compare: nothing to run\n");
    return !compare->n;
}

/* ---- The runs ---- */

/* All results of one subject and grain are the same, whatever scheduled them; a variable of the
 * environment may change what a program computes. */
static bool should_agree(const struct compare *compare, const struct compare_config *a,
                         const struct compare_config *b)
{
    for (int d = COMPARE_DIMENSIONS; d < compare->dimensions && compare->program; d++)
        if (a->value[d] != b->value[d])
            return false;
    return a->value[SUBJECT] == b->value[SUBJECT] && a->value[GRAIN] == b->value[GRAIN];
}

static void say_wrong(struct compare *compare, const struct compare_config *config, size_t round,
                      const struct compare_config *other, size_t other_round)
{
    char *text = NULL;
    size_t size;
    FILE *memory = open_memstream(&text, &size);
    compare->wrong = true;
    if (!memory)
        return;
    fprintf(memory, "WRONG: round %zu of ", round + 1);
    compare_print_member(compare, config, memory);
    fprintf(memory, " has the %s %s, not %s as round %zu of ", compare->same ? "result" : "hash",
            config->run[round].result, other->run[other_round].result, other_round + 1);
    compare_print_member(compare, other, memory);
    fclose(memory);
    compare_journal_warn(compare, text);
    free(text);
}

static void check_result(struct compare *compare, const struct compare_config *config, size_t round)
{
    const struct compare_run *run = &config->run[round];
    for (size_t i = 0; i < compare->n && run->fine; i++) {
        const struct compare_config *other = &compare->config[i];
        for (size_t r = 0; r < compare->rounds && should_agree(compare, config, other); r++)
            if (other->run[r].fine && strcmp(other->run[r].result, run->result) != 0) {
                say_wrong(compare, config, round, other, r);
                return;
            }
    }
}

/* A member that was stopped once is not run again: the others would wait as long in each round. */
static bool was_stopped(const struct compare_config *config, size_t rounds)
{
    for (size_t r = 0; r < rounds; r++)
        if (config->run[r].stopped)
            return true;
    return false;
}

static int run_one(struct compare *compare, struct compare_config *config, size_t round)
{
    struct compare_run *run = &config->run[round];
    if (run->done)
        return 0;
    if (was_stopped(config, round))
        *run = (struct compare_run){.done = true, .why = strdup("not tried again")};
    else
        compare_start(compare, config, run);
    printf("round %zu:", round + 1);
    for (int d = 0; d < compare->dimensions; d++)
        if (compare->list[d].n > 1)
            printf(" %s", config->value[d]);
    if (run->fine)
        printf(": %.4g %s\n", compare_scale(compare) * run->seconds, compare_unit(compare));
    else
        printf(": failed; %s\n", run->why ? run->why : "out of memory");
    fflush(stdout);
    compare->failed += !run->fine;
    check_result(compare, config, round);
    return compare_journal_add(compare, config, round);
}

/* The order of a round depends on the seed and its number only, so that a run that is taken up
 * again goes on in the same one. */
static int run_round(struct compare *compare, size_t *order, size_t round)
{
    uint64_t random = compare->seed * 1000003 + round;
    int failed = 0;
    for (size_t i = 0; i < compare->n; i++)
        order[i] = i;
    for (size_t i = compare->n; i > 1; i--) {
        size_t other = duite_random(&random) % i, kept = order[other];
        order[other] = order[i - 1];
        order[i - 1] = kept;
    }
    for (size_t i = 0; i < compare->n && !failed; i++)
        failed = run_one(compare, &compare->config[order[i]], round);
    return failed;
}

/* Others on the machine are looked for once a round, if it took long enough to tell. *most: of all
 * rounds; the first one in which there are too many draws a warning at once. */
static void look_for_others(struct compare *compare, size_t round, double *most)
{
    char text[200], warning[250];
    const double others = load_others(&compare->load), cores = compare->load.cores;
    if (!isfinite(others))
        return;
    load_begin(&compare->load);
    const bool warned = load_warn_others(*most, cores, text, sizeof text);
    *most = fmax(*most, others);
    if (warned || !load_warn_others(others, cores, text, sizeof text))
        return;
    snprintf(warning, sizeof warning, "in round %zu %s", round + 1, text);
    compare_journal_warn(compare, warning);
}

/* Returns true if something is left to run. */
static bool is_left(const struct compare *compare)
{
    for (size_t i = 0; i < compare->n; i++)
        for (size_t round = 0; round < compare->rounds; round++)
            if (!compare->config[i].run[round].done)
                return true;
    return false;
}

static int run_all(struct compare *compare)
{
    char text[200];
    double others = 0;
    size_t *order = calloc(compare->n, sizeof *order);
    int failed = !order;
    load_begin(&compare->load);
    if (is_left(compare))
        compare_journal_warn(compare, load_warn_average(compare->load.average, compare->load.cores,
                                                        text, sizeof text));
    printf("%zu configurations, %zu rounds, order from seed %" PRIu64 "\n", compare->n,
           compare->rounds, compare->seed);
    for (size_t round = 0; round < compare->rounds && !failed; round++) {
        failed = run_round(compare, order, round);
        look_for_others(compare, round, &others);
    }
    free(order);
    return failed;
}

static void runs_free(struct compare *compare)
{
    for (size_t i = 0; i < compare->n; i++) {
        for (size_t r = 0; r < compare->rounds; r++)
            free(compare->config[i].run[r].why);
        free(compare->config[i].run);
    }
    free(compare->config);
}

int compare_run(struct compare *compare)
{
    if (mkdir(compare->folder, 0777) && errno != EEXIST) {
        fprintf(stderr, "duite-compare: %s: %s\n", compare->folder, strerror(errno));
        return 1;
    }
    int failed = multiply(compare) || compare_journal_open(compare);
    if (!failed) {
        failed = run_all(compare);
        compare_judge(compare);
        failed = compare_page(compare) || failed;
    }
    compare_journal_close(compare);
    if (compare->failed)
        fprintf(stderr, "duite-compare: %zu %s failed: %s/compare.html says which, and why\n",
                compare->failed, compare->failed > 1 ? "runs" : "run", compare->folder);
    runs_free(compare);
    return failed || compare->wrong || compare->failed;
}
