/* An index is whole at any moment: its end is written over by the next entry and a new end in one
 * write, after the frame has its name. When that fails the old end is put back, in its old place.
 * So a run that is killed leaves an index of the frames that are there. */
#include "cloth/output/hdf5/hdf5.h"

#include "cloth/output/files/files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool output_index_is_ours(const char *path, const char *begin)
{
    char bytes[256];
    const size_t n = strlen(begin);
    FILE *file = fopen(path, "rbe");
    const bool is =
        file && n <= sizeof bytes && fread(bytes, 1, n, file) == n && memcmp(bytes, begin, n) == 0;
    if (file)
        fclose(file);
    return is;
}

int output_index_open(struct output_index *index, char *path, const char *begin, const char *end,
                      struct cloth_error *error)
{
    *index = (struct output_index){.path = path, .file = -1, .body = strlen(begin), .end = end};
    if (!path)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the path of an index of frames");
    index->file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (index->file < 0)
        return output_refuse(error, "write", path);
    return output_write_at(index->file, begin, index->body, 0) == 0 &&
                   output_write_at(index->file, end, strlen(end), index->body) == 0
               ? CLOTH_OK
               : output_fail(error, "write", path);
}

/* Once the file is longer, nothing that it needs for its old text can fail. */
static void put_back(const struct output_index *index)
{
    const uint64_t size = index->body + strlen(index->end);
    output_write_at(index->file, index->end, strlen(index->end), index->body);
    if (ftruncate(index->file, (off_t)size) == 0)
        fdatasync(index->file);
}

int output_index_add(struct output_index *index, const char *entry, size_t n,
                     struct cloth_error *error)
{
    const char *comma = index->n && index->end[0] == ']' ? ",\n" : "";
    char *text = NULL;
    const int size = asprintf(&text, "%s%.*s%s", comma, (int)n, entry, index->end);
    if (size < 0)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a line of %s", index->path);
    int code = output_check_same(index->file, index->path, error);
    if (!code && (output_write_at(index->file, text, (size_t)size, index->body) != 0 ||
                  output_sync(index->file) != 0)) {
        code = output_fail(error, "write", index->path);
        put_back(index);
    }
    if (!code) {
        index->body += strlen(comma) + n;
        index->n++;
    }
    free(text);
    return code;
}

int output_index_close(struct output_index *index, struct cloth_error *error)
{
    int code = CLOTH_OK;
    if (index->file >= 0 && close(index->file) != 0)
        code = output_fail(error, "close", index->path);
    free(index->path);
    *index = (struct output_index){.file = -1};
    return code;
}
