/* A rank's share of the cores. Batch systems and containers that do not bind a process may still
 * grant it fewer cores than it can use. Each says so in its own way; the least counts. */
#include "runtime/workers/share.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Quotas of cgroups ---- */

/* Reads up to two numbers from the file's beginning. Returns how many it read. */
static int quota_read(const char *folder, const char *name, double number[2])
{
    char path[PATH_MAX + 40];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    const int n = file ? fscanf(file, "%lf %lf", &number[0], &number[1]) : 0;
    if (file)
        fclose(file);
    return n;
}

/* Cores' worth of time that this cgroup may take, of version 2 or 1; infinite: any. */
static double quota_here(const char *folder)
{
    double quota[2], period[2];
    if (quota_read(folder, "cpu.max", quota) == 2 && quota[1] > 0)
        return quota[0] / quota[1];
    if (quota_read(folder, "cpu.cfs_quota_us", quota) == 1 && quota[0] > 0 &&
        quota_read(folder, "cpu.cfs_period_us", period) == 1 && period[0] > 0)
        return quota[0] / period[0];
    return INFINITY;
}

/* The least quota of a cgroup and all above it. In a container the path may be the host's, which is
 * not there: then the topmost folder is the container's. */
static double quota_up(const char *root, const char *hierarchy, const char *group)
{
    char folder[PATH_MAX];
    double least = INFINITY;
    const int top =
        snprintf(folder, sizeof folder, "%s%s%s", root, *hierarchy ? "/" : "", hierarchy);
    snprintf(folder, sizeof folder, "%s%s%s%s", root, *hierarchy ? "/" : "", hierarchy, group);
    for (char *end = folder; end; *end = 0) {
        least = fmin(least, quota_here(folder));
        end = strrchr(folder, '/');
        if (!end || end < folder + top)
            break;
    }
    return least;
}

static bool quota_names_cpu(const char *controllers)
{
    for (const char *c = controllers; c; c = strchr(c, ',') ? strchr(c, ',') + 1 : NULL)
        if (!strncmp(c, "cpu", 3) && (!c[3] || c[3] == ','))
            return true;
    return false;
}

/* Lines are NUMBER:CONTROLLERS:PATH; version 2 has no controllers there. */
static double quota_find(const char *cgroups, const char *root)
{
    char line[PATH_MAX];
    double least = INFINITY;
    FILE *file = fopen(cgroups, "r");
    while (file && fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        char *controllers = strchr(line, ':'),
             *group = controllers ? strchr(++controllers, ':') : NULL;
        if (!group)
            continue;
        *group++ = 0;
        if (!*controllers)
            least = fmin(least, fmin(quota_up(root, "", group), quota_up(root, "unified", group)));
        else if (quota_names_cpu(controllers))
            least =
                fmin(least, fmin(quota_up(root, controllers, group), quota_up(root, "cpu", group)));
    }
    if (file)
        fclose(file);
    return least;
}

/* ---- The rule ---- */

/* The variable's first whole number >= 1, else UINT_MAX. OMP_NUM_THREADS may be a list for nested
 * parallel regions, the outermost first. */
static unsigned variable_number(const char *variable)
{
    const char *text = getenv(variable);
    char *end;
    if (!text || *text < '0' || *text > '9')
        return UINT_MAX;
    const unsigned long value = strtoul(text, &end, 10);
    return value && value < UINT_MAX && (!*end || *end == ',') ? (unsigned)value : UINT_MAX;
}

static void variable_take(const char *name, unsigned *least, char *from, size_t size)
{
    const unsigned value = variable_number(name);
    if (value >= *least)
        return;
    *least = value;
    snprintf(from, size, "%s=%u", name, value);
}

static unsigned share_divided(unsigned cores, unsigned ranks)
{
    return cores > ranks ? cores / ranks : 1;
}

void work_share_find(const struct work_surroundings *here, struct work_share *share)
{
    char shared[60], own[60] = "", omp[60] = "", ranks[40] = "";
    unsigned cores = here->cores;
    const double quota = quota_find(here->cgroups, here->mounted);
    snprintf(shared, sizeof shared, "affinity, %u core%s", cores, cores == 1 ? "" : "s");
    if (quota < cores) {
        cores = quota > 1 ? (unsigned)quota : 1;
        snprintf(shared, sizeof shared, "cgroup quota %.3g", quota);
    }
    variable_take("SLURM_CPUS_ON_NODE", &cores, shared, sizeof shared);
    share->cores = share_divided(cores, here->ranks);
    variable_take("SLURM_CPUS_PER_TASK", &share->cores, own, sizeof own);
    share->limited = share->cores < share_divided(here->cores, here->ranks);
    share->workers = here->asked ? here->asked : share->cores;
    if (!here->asked) {
        variable_take("OMP_NUM_THREADS", &share->workers, omp, sizeof omp);
        variable_take("OMP_THREAD_LIMIT", &share->workers, omp, sizeof omp);
    }
    if (here->ranks > 1)
        snprintf(ranks, sizeof ranks, " for %u ranks", here->ranks);
    snprintf(share->from, sizeof share->from, "%s%s%s%s", *own ? own : shared, *own ? "" : ranks,
             *omp ? "; workers by " : "", omp);
}
