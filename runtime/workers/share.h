#ifndef DUITE_WORKERS_SHARE_H
#define DUITE_WORKERS_SHARE_H

#include <stdbool.h>

/* How many cores are a rank's, and how many workers it has on them: the one rule. */

struct work_share {
    unsigned cores;   /* of this rank */
    unsigned workers; /* as many as were asked for, else one a core, or fewer by the environment */
    bool limited;     /* the rank may use more cores than are its own: others may be on these */
    char from[160];   /* for people: what said so */
};

/* What there is to know of a rank and its surroundings. */
struct work_surroundings {
    unsigned cores;      /* that it may use, */
    unsigned ranks;      /* and so many ranks may, itself among them */
    unsigned asked;      /* workers that were asked for; 0: none were */
    const char *cgroups; /* the file with the cgroups of the process; */
    const char *mounted; /* the folder where all are */
};
#define WORK_CGROUPS     "/proc/self/cgroup"
#define WORK_CGROUP_ROOT "/sys/fs/cgroup"

/* The least of: cores that the process may use, a quota of its cgroups (rounded down), and
 * SLURM_CPUS_ON_NODE, each of which the ranks share; and SLURM_CPUS_PER_TASK. One at least. Workers
 * are no more than OMP_NUM_THREADS and OMP_THREAD_LIMIT say. Variables that are no numbers say
 * nothing. */
void work_share_find(const struct work_surroundings *here, struct work_share *share);

#endif
