/* The folder is made once a process, where files are in memory if the machine has such a place. */
#include "tests/fuzz/fuzz.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[128], path[256];

static void end(const char *what)
{
    fprintf(stderr, "%s: %s\n", what, strerror(errno));
    _exit(99);
}

static void remove_folder(void)
{
    char command[sizeof folder + 16];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (system(command))
        fprintf(stderr, "%s stays\n", folder);
}

const char *fuzz_folder(void)
{
    const char *tmp = getenv("TMPDIR");
    if (*folder)
        return folder;
    if (!tmp || strlen(tmp) > sizeof folder - 32)
        tmp = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    snprintf(folder, sizeof folder, "%s/duite-fuzz.XXXXXX", tmp);
    if (!mkdtemp(folder))
        end(folder);
    atexit(remove_folder);
    return folder;
}

const char *fuzz_file(const char *name, const void *data, size_t size)
{
    snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
    char *slash = strchr(name, '/') ? strrchr(path, '/') : NULL;
    if (slash) {
        *slash = '\0';
        if (mkdir(path, 0777) && errno != EEXIST)
            end(path);
        *slash = '/';
    }
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(data, 1, size, file) != size)
        end(path);
    if (fclose(file))
        end(path);
    return path;
}

void fuzz_files(size_t n, const char *const names[], const uint8_t *data, size_t size)
{
    const size_t mark = strlen(FUZZ_NEXT);
    for (size_t i = 0; i < n; i++) {
        const uint8_t *next = data ? memmem(data, size, FUZZ_NEXT, mark) : NULL;
        const size_t part = next ? (size_t)(next - data) : size;
        const char *to = fuzz_file(names[i], data ? data : (const uint8_t *)"", data ? part : 0);
        if (!data && unlink(to))
            end(to);
        data = next ? next + mark : NULL;
        size = next ? size - part - mark : 0;
    }
}
