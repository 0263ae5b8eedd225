#ifndef DUITE_WORKERS_SHARE_H
#define DUITE_WORKERS_SHARE_H

#include <stdbool.h>

/* The one rule for a rank's share of the cores and its number of workers. */

struct work_share {
    unsigned cores;   /* of this rank */
    unsigned workers; /* as many as wanted, else one a core, or fewer by the environment */
    bool limited;     /* the rank may run on more cores than its share: others may use these */
    char from[160];   /* for people: the source of the numbers */
};

/* A rank and its surroundings. */
struct work_surroundings {
    unsigned cores;      /* that it may use */
    unsigned ranks;      /* that may use them, itself included */
    unsigned asked;      /* workers wanted; 0: as many as the rule gives */
    const char *cgroups; /* the file with the cgroups of the process */
    const char *mounted; /* the folder with all cgroups */
};
#define WORK_CGROUPS     "/proc/self/cgroup"
#define WORK_CGROUP_ROOT "/sys/fs/cgroup"

/* Cores: the least of the cores that the process may use, its cgroups' quota (rounded down) and
 * SLURM_CPUS_ON_NODE, each divided by the ranks, and of SLURM_CPUS_PER_TASK; one at least. Workers:
 * at most OMP_NUM_THREADS and OMP_THREAD_LIMIT. Variables that are no numbers are ignored. */
void work_share_find(const struct work_surroundings *here, struct work_share *share);

#endif
