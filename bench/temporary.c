/* A folder has a name that no other process makes, so several benches may run side by side. */
#include "bench/temporary.h"

#include "bench/serve.h"

#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int temporary_make(const char *in, const char *name, char path[TEMPORARY_PATH])
{
    const char *chosen = getenv("TMPDIR"), *folder = in ? in : chosen ? chosen : "/tmp";
    const int length = snprintf(path, TEMPORARY_PATH, "%s/%s.XXXXXX", folder, name);
    if (length < 0 || length >= TEMPORARY_PATH)
        return serve_fail("the folder %.100s... has too long a name", folder);
    return mkdtemp(path) ? 0 : serve_fail("no folder %s: %s", path, strerror(errno));
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *where)
{
    (void)status, (void)kind, (void)where;
    return remove(path);
}

void temporary_remove(const char *path)
{
    if (nftw(path, remove_one, 8, FTW_DEPTH | FTW_PHYS))
        fprintf(stderr, "duite-bench: %s cannot be removed: %s\n", path, strerror(errno));
}
