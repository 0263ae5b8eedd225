/* A host that is half as fast: a group of processes that have half of a core's time, in turns of a
 * millisecond (control groups of either version, for root). This process is in it while it runs as
 * that host. */
#include "bench/predict/predict.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Microseconds; the kernel takes no shorter ones. */
#define QUOTA  "1000"
#define PERIOD "2000"

static const struct quota_version {
    const char *all, *own; /* groups */
    struct {
        const char *file, *text;
    } limit[2];
} VERSIONS[] = {{"/sys/fs/cgroup/cpu",
                 "/sys/fs/cgroup/cpu/duite-bench",
                 {{"cpu.cfs_period_us", PERIOD}, {"cpu.cfs_quota_us", QUOTA}}},
                {"/sys/fs/cgroup",
                 "/sys/fs/cgroup/duite-bench",
                 {{"cpu.max", QUOTA " " PERIOD}, {NULL, NULL}}}};

static int quota_write(const char *group, const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", group, name);
    FILE *file = fopen(path, "w");
    const bool fine = file && fputs(text, file) >= 0;
    if ((file && fclose(file)) || !fine)
        return serve_fail("%s: %s", path, strerror(errno));
    return 0;
}

static const struct quota_version *quota_version(void)
{
    return &VERSIONS[access("/sys/fs/cgroup/cgroup.controllers", F_OK) == 0];
}

static int quota_group(const struct quota_version *version)
{
    if (mkdir(version->own, 0755) && errno != EEXIST)
        return serve_fail("%s: %s", version->own, strerror(errno));
    int code = 0;
    for (int i = 0; i < 2 && version->limit[i].file && !code; i++)
        code = quota_write(version->own, version->limit[i].file, version->limit[i].text);
    return code;
}

bool predict_quota_is_there(void)
{
    return !quota_group(quota_version());
}

int predict_quota(bool begins)
{
    const struct quota_version *version = quota_version();
    char own[32];
    snprintf(own, sizeof own, "%d", (int)getpid());
    return quota_write(begins ? version->own : version->all, "cgroup.procs", own);
}

void predict_quota_end(void)
{
    rmdir(quota_version()->own);
}
