/* Files are cut where they are: other files of the folder name them, and readers have them open. */
#include "cloth/output/files/cut.h"

#include "cloth/output/files/files.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Reads n bytes at an offset. Returns false where there are fewer. */
static bool files_cut_read_at(int file, void *bytes, size_t n, uint64_t at)
{
    for (size_t done = 0; done < n;) {
        const ssize_t got = pread(file, (char *)bytes + done, n - done, (off_t)(at + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        done += (size_t)got;
    }
    return true;
}

static int shorten(int file, const char *path, uint64_t size, struct cloth_error *error)
{
    if (ftruncate(file, (off_t)size) == 0 && output_sync(file) == 0)
        return 0;
    return output_fail(error, "cut off what follows the checkpoint in", path);
}

int output_cut_cache(int file, const char *path, uint32_t n_points, uint64_t n_frames,
                     struct cloth_error *error)
{
    unsigned char header[OUTPUT_PC2_HEADER], count[4];
    uint32_t points = 0, frames = 0;
    struct stat status;
    const uint64_t size = OUTPUT_PC2_HEADER + (uint64_t)12 * n_points * n_frames;
    if (!files_cut_read_at(file, header, sizeof header, 0) ||
        !output_pc2_parse(header, &points, &frames) || points != n_points)
        return cloth_fail(error, CLOTH_E_INPUT, "%s is no point cache of %" PRIu32 " vertices: %s",
                          path, n_points, OUTPUT_CHANGED);
    if (fstat(file, &status) != 0)
        return output_fail(error, "read", path);
    if (frames < n_frames || (uint64_t)status.st_size < size)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s has %" PRIu32 " frames, the checkpoint comes after %" PRIu64 ": %s",
                          path, frames, n_frames, OUTPUT_CHANGED);
    output_put_u32(count, (uint32_t)n_frames);
    if (output_write_at(file, count, sizeof count, OUTPUT_PC2_COUNT) != 0 || output_sync(file) != 0)
        return output_fail(error, "count the frames in", path);
    return shorten(file, path, size, error);
}

int output_cut_lines(int file, const char *path, uint64_t n_lines, uint64_t *size,
                     struct cloth_error *error)
{
    char bytes[1 << 14];
    uint64_t lines = 0;
    ssize_t got = 1;
    *size = 0;
    while (lines < n_lines && (got = pread(file, bytes, sizeof bytes, (off_t)*size)) > 0)
        for (ssize_t i = 0; i < got && lines < n_lines; i++, ++*size)
            lines += bytes[i] == '\n';
    if (got < 0)
        return output_fail(error, "read", path);
    if (lines < n_lines)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s has %" PRIu64 " lines, the checkpoint comes after %" PRIu64 ": %s",
                          path, lines, n_lines, OUTPUT_CHANGED);
    return shorten(file, path, *size, error);
}

int output_cut_header(int file, const char *path, const char *header, struct cloth_error *error)
{
    const size_t n = strlen(header);
    char *bytes = malloc(n + 1);
    if (!bytes)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the header of %s", path);
    const bool same =
        files_cut_read_at(file, bytes, n + 1, 0) && !memcmp(bytes, header, n) && bytes[n] == '\n';
    free(bytes);
    return same
               ? 0
               : cloth_fail(error, CLOTH_E_INPUT, "%s has other columns: %s", path, OUTPUT_CHANGED);
}
