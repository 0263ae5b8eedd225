/* Medians and their intervals. Differences are taken within a round, whose members ran one after
 * the other: what the machine does over minutes hits all of them. */
#include "tools/compare/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Speed-up ---- */

/* A list that a program does not get counts as one. */
static double count_of(const char *value)
{
    return *value ? strtod(value, NULL) : 1;
}

static bool differ_in_cores_alone(const struct compare *compare, const struct compare_config *a,
                                  const struct compare_config *b)
{
    for (int d = 0; d < compare->dimensions; d++)
        if (d != RANKS && d != THREADS && a->value[d] != b->value[d])
            return false;
    return true;
}

static void judge_speedup(const struct compare *compare, struct compare_config *config)
{
    const struct compare_config *least = config, *most = config;
    config->speedup = config->efficiency = NAN;
    for (size_t i = 0; i < compare->n; i++) {
        const struct compare_config *other = &compare->config[i];
        if (!other->n || !differ_in_cores_alone(compare, config, other))
            continue;
        if (other->cores < least->cores ||
            (other->cores <= least->cores && other->median < least->median))
            least = other;
        if (other->cores > most->cores)
            most = other;
    }
    if (!config->n || !(most->cores > least->cores))
        return;
    config->speedup = least->median / config->median;
    config->efficiency = config->speedup * least->cores / config->cores;
}

static void judge_alone(const struct compare *compare, struct compare_config *config)
{
    double seconds[COMPARE_ROUNDS], bodies[COMPARE_ROUNDS], outside[COMPARE_ROUNDS], unused[2];
    config->n = 0;
    config->cores = count_of(config->value[RANKS]) * count_of(config->value[THREADS]);
    for (size_t r = 0; r < compare->rounds; r++) {
        const struct compare_run *run = &config->run[r];
        if (!run->fine)
            continue;
        seconds[config->n] = run->seconds;
        bodies[config->n] = run->bodies;
        outside[config->n++] = run->seconds - run->bodies;
    }
    config->median = compare_median(seconds, config->n, &config->low, &config->high);
    config->bodies = compare_median(bodies, config->n, &unused[0], &unused[1]);
    config->outside = compare_median(outside, config->n, &unused[0], &unused[1]);
}

static void judge_against(const struct compare *compare, struct compare_config *config,
                          const struct compare_config *fastest)
{
    double ratio[COMPARE_ROUNDS];
    size_t n = 0;
    for (size_t r = 0; r < compare->rounds; r++)
        if (config->run[r].fine && fastest->run[r].fine && fastest->run[r].seconds > 0)
            ratio[n++] = config->run[r].seconds / fastest->run[r].seconds;
    config->ratio = compare_median(ratio, n, &config->ratio_low, &config->ratio_high);
    config->fastest = config == fastest;
    config->few = n < COMPARE_ENOUGH;
    config->noise = config->ratio_low <= 1;
}

void compare_judge(struct compare *compare)
{
    for (size_t i = 0; i < compare->n; i++)
        judge_alone(compare, &compare->config[i]);
    for (size_t i = 0; i < compare->n; i++)
        judge_speedup(compare, &compare->config[i]);
    for (size_t i = 0; i < compare->n; i++) {
        const struct compare_config *fastest = NULL;
        for (size_t j = 0; j < compare->n; j++) {
            const struct compare_config *other = &compare->config[j];
            if (other->n && other->value[SUBJECT] == compare->config[i].value[SUBJECT] &&
                (!fastest || other->median < fastest->median))
                fastest = other;
        }
        if (fastest && compare->config[i].n)
            judge_against(compare, &compare->config[i], fastest);
    }
}
