/* Nothing here leaves half a file under its final name: a file is filled, synced and only then
 * renamed by its caller. */
#include "cloth/output/files/files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

char *output_path(const char *folder, const char *name, const char *suffix)
{
    char *path = NULL;
    return asprintf(&path, "%s/%s%s", folder, name, suffix) < 0 ? NULL : path;
}

int output_fail(struct cloth_error *error, const char *what, const char *path)
{
    const char *reason = strerror(errno);
    return cloth_fail(error, CLOTH_E_IO, "cannot %s %s: %s", what, path, reason);
}

int output_refuse(struct cloth_error *error, const char *what, const char *path)
{
    const int reason = errno;
    const bool disk = reason == ENOSPC || reason == EDQUOT || reason == EIO || reason == EMFILE ||
                      reason == ENFILE || reason == ENOMEM;
    return cloth_fail(error, disk ? CLOTH_E_IO : CLOTH_E_INPUT, "cannot %s %s: %s", what, path,
                      strerror(reason));
}

static int files_make_one(const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) == 0)
        return 0;
    if (errno != EEXIST)
        return -1;
    if (stat(path, &status) != 0)
        return -1;
    if (S_ISDIR(status.st_mode))
        return 0;
    errno = ENOTDIR;
    return -1;
}

int output_make_folder(const char *folder, struct cloth_error *error)
{
    char *path = strdup(folder);
    if (!path)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to make the folder %s", folder);
    int bad = 0;
    for (char *end = path; *end && !bad; end++) {
        if (*end != '/' || end == path)
            continue;
        *end = '\0';
        bad = files_make_one(path);
        *end = '/';
    }
    bad = bad || files_make_one(path);
    int reason = errno;
    free(path);
    if (!bad)
        return 0;
    errno = reason;
    return output_refuse(error, "make the folder", folder);
}

int output_open_file(const char *path, int flags)
{
    enum { TRIES = 100, PAUSE = 10000000 /* ns */ };
    const struct timespec pause = {.tv_nsec = PAUSE};
    int file = open(path, flags | O_CLOEXEC, 0666);
    for (int i = 0; i < TRIES && file < 0 && errno == EMFILE; i++) {
        nanosleep(&pause, NULL);
        file = open(path, flags | O_CLOEXEC, 0666);
    }
    return file;
}

int output_write_at(int file, const void *bytes, size_t n, uint64_t offset)
{
    const char *next = bytes;
    while (n > 0) {
        ssize_t done = pwrite(file, next, n, (off_t)offset);
        if (done < 0 && errno == EINTR)
            continue;
        if (done == 0)
            errno = ENOSPC;
        if (done <= 0)
            return -1;
        next += done;
        n -= (size_t)done;
        offset += (uint64_t)done;
    }
    return 0;
}

int output_check_same(int file, const char *path, struct cloth_error *error)
{
    struct stat here, there;
    if (fstat(file, &here) == 0 && stat(path, &there) == 0 && here.st_dev == there.st_dev &&
        here.st_ino == there.st_ino)
        return 0;
    return cloth_fail(error, CLOTH_E_IO, "%s was removed or replaced while the run wrote to it",
                      path);
}

int output_sync(int file)
{
    if (fdatasync(file) == 0 || errno == EINVAL || errno == EROFS || errno == ENOSYS ||
        errno == ENOTSUP)
        return 0;
    return -1;
}

int output_write_file(const char *path, int (*fill)(FILE *file, const void *what), const void *what,
                      struct cloth_error *error)
{
    const int handle = output_open_file(path, O_WRONLY | O_CREAT | O_TRUNC);
    FILE *file = handle < 0 ? NULL : fdopen(handle, "w");
    if (!file) {
        output_refuse(error, "write", path);
        if (handle >= 0)
            close(handle);
        return error->code;
    }
    int bad = fill(file, what) != 0 || fflush(file) != 0 || ferror(file);
    bad = bad || output_sync(fileno(file)) != 0;
    int reason = errno;
    if (fclose(file) != 0 && !bad) {
        bad = 1;
        reason = errno;
    }
    if (!bad)
        return 0;
    struct stat status;
    if (stat(path, &status) == 0 && S_ISREG(status.st_mode))
        unlink(path);
    errno = reason;
    return output_fail(error, "write", path);
}

int output_replace_file(const char *path, int (*fill)(FILE *file, const void *what),
                        const void *what, struct cloth_error *error)
{
    struct stat status;
    const bool there = stat(path, &status) == 0;
    if (there && !S_ISREG(status.st_mode))
        return output_write_file(path, fill, what, error);
    char *target = there ? realpath(path, NULL) : strdup(path), *part = NULL;
    if (!target || asprintf(&part, "%s.%ld.part", target, (long)getpid()) < 0) {
        free(target);
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to write %s", path);
    }
    int code = output_write_file(part, fill, what, error);
    if (!code && rename(part, target) != 0) {
        code = output_fail(error, "write", path);
        unlink(part);
    }
    free(part);
    free(target);
    return code;
}

void output_sync_folder(const char *folder)
{
    int handle = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0)
        return;
    fsync(handle);
    close(handle);
}
