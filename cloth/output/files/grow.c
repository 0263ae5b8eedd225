/* The first `size` bytes of a file are whole parts; bytes beyond them mean nothing. Files are cut
 * where they are: other files of the folder name them, and readers have them open. */
#include "cloth/output/files/files.h"

#include <fcntl.h>
#include <inttypes.h>
#include <sys/stat.h>
#include <unistd.h>

struct output_file output_file(const char *folder, const char *name)
{
    return (struct output_file){.path = output_path(folder, "%s", name), .file = -1};
}

int output_file_open(struct output_file *file, int flags, const char *verb,
                     struct cloth_error *error)
{
    file->file = open(file->path.text, flags | O_CLOEXEC, 0666);
    return file->file < 0 ? output_refuse(error, verb, file->path.text) : 0;
}

int output_file_check(const struct output_file *file, struct cloth_error *error)
{
    struct stat here, there;
    if (fstat(file->file, &here) == 0 && stat(file->path.text, &there) == 0 &&
        here.st_dev == there.st_dev && here.st_ino == there.st_ino)
        return 0;
    return cloth_fail(error, CLOTH_E_IO, "%s was removed or replaced while the run wrote to it",
                      file->path.text);
}

int output_file_cut(const struct output_file *file, uint64_t size, struct cloth_error *error)
{
    return ftruncate(file->file, (off_t)size) == 0 && output_sync(file->file) == 0
               ? 0
               : output_fail(error, "cut off what follows the checkpoint in", file->path.text);
}

int output_file_keep_lines(struct output_file *file, uint64_t n_lines, struct cloth_error *error)
{
    char bytes[1 << 14];
    uint64_t lines = 0, size = 0;
    ssize_t got = 1;
    while (lines < n_lines && (got = pread(file->file, bytes, sizeof bytes, (off_t)size)) > 0)
        for (ssize_t i = 0; i < got && lines < n_lines; i++, size++)
            lines += bytes[i] == '\n';
    if (got < 0)
        return output_fail(error, "read", file->path.text);
    if (lines < n_lines)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s has %" PRIu64 " lines, the checkpoint comes after %" PRIu64 ": %s",
                          file->path.text, lines, n_lines, OUTPUT_CHANGED);
    file->size = size;
    return output_file_cut(file, size, error);
}

int output_file_append(struct output_file *file, const void *bytes, size_t n, const char *verb,
                       struct cloth_error *error)
{
    int code = output_file_check(file, error);
    if (code)
        return code;
    if (output_write_at(file->file, bytes, n, file->size) == 0) {
        file->size += n;
        return 0;
    }
    code = output_fail(error, verb, file->path.text);
    if (ftruncate(file->file, (off_t)file->size) != 0)
        return code; /* the first error is the one that matters */
    return code;
}

int output_file_close(struct output_file *file, struct cloth_error *error)
{
    const int handle = file->file;
    file->file = -1;
    return handle >= 0 && close(handle) != 0 ? output_fail(error, "close", file->path.text) : 0;
}
