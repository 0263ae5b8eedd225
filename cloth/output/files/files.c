/* No half file stands under a final name: a file is filled, synced and only then renamed. */
#include "cloth/output/files/files.h"

#include "cloth/base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { MAX_LINKS = 40 }; /* as the kernel follows */

/* ---- Paths ---- */

struct output_path output_path(const char *folder, const char *name, ...)
{
    struct output_path path;
    va_list list;
    const int n = snprintf(path.text, sizeof path.text, "%s/", folder);
    va_start(list, name);
    if (n < (int)sizeof path.text)
        vsnprintf(path.text + n, sizeof path.text - (size_t)n, name, list);
    va_end(list);
    return path;
}

int output_follow(const char *path, struct output_path *end)
{
    char link[PATH_MAX];
    snprintf(end->text, sizeof end->text, "%s", path);
    for (int i = 0; i < MAX_LINKS; i++) {
        const ssize_t n = readlink(end->text, link, sizeof link - 1);
        if (n < 0)
            return 0;
        link[n] = '\0';
        char *slash = strrchr(end->text, '/'), *to = slash && *link != '/' ? slash + 1 : end->text;
        snprintf(to, (size_t)(end->text + sizeof end->text - to), "%s", link);
    }
    errno = ELOOP;
    return -1;
}

static int make_one_folder(const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) == 0)
        return 0;
    if (errno != EEXIST || stat(path, &status) != 0)
        return -1;
    errno = ENOTDIR;
    return S_ISDIR(status.st_mode) ? 0 : -1;
}

int output_make_folder(const char *folder, struct cloth_error *error)
{
    struct output_path path;
    int bad = 0;
    snprintf(path.text, sizeof path.text, "%s", folder);
    for (char *end = path.text; *end && !bad; end++) {
        if (*end != '/' || end == path.text)
            continue;
        *end = '\0';
        bad = make_one_folder(path.text);
        *end = '/';
    }
    bad = bad || make_one_folder(path.text);
    return bad ? output_refuse(error, "make the folder", folder) : 0;
}

void output_sync_folder(const char *folder)
{
    int handle = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0)
        return;
    fsync(handle);
    close(handle);
}

/* ---- Errors ---- */

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

/* ---- Bytes ---- */

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

unsigned char *output_read_file(const char *path, size_t *n)
{
    struct stat status;
    FILE *file = cloth_file_open(path);
    if (!file)
        return NULL;
    unsigned char *bytes =
        fstat(fileno(file), &status) == 0 ? malloc((size_t)status.st_size + 1) : NULL;
    if (bytes) {
        *n = fread(bytes, 1, (size_t)status.st_size, file);
        bytes[*n] = '\0';
    }
    const int reason = errno;
    if (bytes && ferror(file)) {
        free(bytes);
        bytes = NULL;
    }
    fclose(file);
    errno = reason;
    return bytes;
}

bool output_read_at(int file, void *bytes, size_t n, uint64_t offset)
{
    for (size_t done = 0; done < n;) {
        const ssize_t got = pread(file, (char *)bytes + done, n - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        done += (size_t)got;
    }
    return true;
}

bool output_begins(const char *path, const void *bytes, size_t n)
{
    char there[256];
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    bool is = file >= 0;
    for (size_t done = 0, some; done < n && is; done += some) {
        some = n - done < sizeof there ? n - done : sizeof there;
        is = output_read_at(file, there, some, done) &&
             memcmp(there, (const char *)bytes + done, some) == 0;
    }
    if (file >= 0)
        close(file);
    return is;
}

int output_remove_old(const char *path, const void *bytes, size_t n, const char *other,
                      struct cloth_error *error)
{
    struct stat status;
    if (lstat(path, &status) != 0)
        return 0;
    if (output_begins(path, bytes, n))
        return unlink(path) == 0 ? 0 : output_refuse(error, "replace", path);
    return other ? cloth_fail(error, CLOTH_E_INPUT,
                              "%s %s; give another folder, or move the file away", path, other)
                 : 0;
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

int output_sync(int file)
{
    if (fdatasync(file) == 0 || errno == EINVAL || errno == EROFS || errno == ENOSYS ||
        errno == ENOTSUP)
        return 0;
    return -1;
}

/* ---- Whole files ---- */

/* name: the file that is opened; path: its final name, for sentences. */
static int write_whole(const char *name, const char *path, output_fill *fill, const void *what,
                       struct cloth_error *error)
{
    const int handle = output_open_file(name, O_WRONLY | O_CREAT | O_TRUNC);
    FILE *file = handle < 0 ? NULL : fdopen(handle, "w");
    if (!file) {
        const int code = output_refuse(error, "write", path);
        if (handle >= 0)
            close(handle);
        return code;
    }
    errno = 0;
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
    if (stat(name, &status) == 0 && S_ISREG(status.st_mode))
        unlink(name);
    errno = reason;
    return output_fail(error, "write", path);
}

int output_write_file(const char *path, output_fill *fill, const void *what,
                      struct cloth_error *error)
{
    return write_whole(path, path, fill, what, error);
}

int output_replace_file(const char *path, output_fill *fill, const void *what,
                        struct cloth_error *error)
{
    struct stat status;
    struct output_path end;
    char *part = NULL;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode))
        return output_write_file(path, fill, what, error);
    if (output_follow(path, &end) != 0)
        return output_fail(error, "write", path);
    if (asprintf(&part, "%s.%ld.part", end.text, (long)getpid()) < 0)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to write %s", path);
    int code = write_whole(part, path, fill, what, error);
    if (!code && rename(part, end.text) != 0) {
        code = output_fail(error, "write", path);
        unlink(part);
    }
    free(part);
    return code;
}
