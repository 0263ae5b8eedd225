/* Only the count of frames ever changes in a header. It is rewritten last, when the floats that it
 * counts are on the disk: bytes beyond the counted frames mean nothing. */
#include "cloth/output/files/pc2.h"

#include "cloth/base/bytes.h"
#include "cloth/base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const unsigned char output_pc2_magic[OUTPUT_PC2_MAGIC] = "POINTCACHE2\0\1\0\0";

static uint64_t pc2_size(uint32_t n_points, uint64_t n_frames)
{
    return OUTPUT_PC2_HEADER + (uint64_t)12 * n_points * n_frames;
}

void output_pc2_header(unsigned char header[OUTPUT_PC2_HEADER], uint32_t n_points,
                       uint32_t n_frames)
{
    memcpy(header, output_pc2_magic, OUTPUT_PC2_MAGIC);
    cloth_put_u32(header + 16, n_points);
    cloth_put_float(header + 20, 0.0f); /* start frame */
    cloth_put_float(header + 24, 1.0f); /* frames a sample, as Blender's exporter has it */
    cloth_put_u32(header + OUTPUT_PC2_COUNT, n_frames);
}

static bool pc2_parse(const unsigned char header[OUTPUT_PC2_HEADER], uint32_t *n_points,
                      uint32_t *n_frames)
{
    *n_points = cloth_get_u32(header + 16);
    *n_frames = cloth_get_u32(header + OUTPUT_PC2_COUNT);
    return memcmp(header, output_pc2_magic, OUTPUT_PC2_MAGIC) == 0 && *n_points <= INT32_MAX &&
           *n_frames <= INT32_MAX;
}

int output_pc2_fill(FILE *file, const void *what)
{
    unsigned char header[OUTPUT_PC2_HEADER];
    output_pc2_header(header, *(const uint32_t *)what, 0);
    return fwrite(header, sizeof header, 1, file) != 1;
}

/* ---- Writing ---- */

int output_pc2_make(struct output_pc2 *cache, const char *folder, const char *name,
                    uint32_t n_points, struct cloth_error *error)
{
    *cache = (struct output_pc2){.of = output_file(folder, name),
                                 .n_points = n_points,
                                 .bytes = cloth_alloc(n_points, 12, error)};
    return cache->bytes ? 0 : CLOTH_E_MEMORY;
}

static int pc2_put_count(const struct output_pc2 *cache, uint64_t n)
{
    unsigned char count[4];
    cloth_put_u32(count, (uint32_t)n);
    return output_write_at(cache->of.file, count, sizeof count, OUTPUT_PC2_COUNT);
}

static int pc2_go_on(const struct output_pc2 *cache, uint64_t n_frames, struct cloth_error *error)
{
    unsigned char header[OUTPUT_PC2_HEADER];
    uint32_t points = 0, frames = 0;
    struct stat status;
    const char *path = cache->of.path.text;
    const uint64_t size = pc2_size(cache->n_points, n_frames);
    if (!output_read_at(cache->of.file, header, sizeof header, 0) ||
        !pc2_parse(header, &points, &frames) || points != cache->n_points)
        return cloth_fail(error, CLOTH_E_INPUT, "%s is no point cache of %" PRIu32 " vertices: %s",
                          path, cache->n_points, OUTPUT_CHANGED);
    if (fstat(cache->of.file, &status) != 0)
        return output_fail(error, "read", path);
    if (frames < n_frames || (uint64_t)status.st_size < size)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s has %" PRIu32 " frames, the checkpoint comes after %" PRIu64 ": %s",
                          path, frames, n_frames, OUTPUT_CHANGED);
    if (pc2_put_count(cache, n_frames) != 0 || output_sync(cache->of.file) != 0)
        return output_fail(error, "count the frames in", path);
    return output_file_cut(&cache->of, size, error);
}

int output_pc2_open(struct output_pc2 *cache, const uint64_t *n_frames, struct cloth_error *error)
{
    int code = output_file_open(&cache->of, O_RDWR, n_frames ? "go on with" : "write", error);
    return code || !n_frames ? code : pc2_go_on(cache, *n_frames, error);
}

int output_pc2_write(struct output_pc2 *cache, uint64_t frame, const double *x, size_t stride,
                     size_t *finite, struct cloth_error *error)
{
    *finite = cloth_put_points(cache->bytes, cache->n_points, x, stride);
    if (*finite < cache->n_points)
        return 0;
    cache->of.size = pc2_size(cache->n_points, frame);
    return output_file_append(&cache->of, cache->bytes, (size_t)12 * cache->n_points,
                              "write a frame to", error);
}

int output_pc2_count(const struct output_pc2 *cache, uint64_t n, struct cloth_error *error)
{
    if (output_sync(cache->of.file) != 0)
        return output_fail(error, "write a frame to", cache->of.path.text);
    return pc2_put_count(cache, n) == 0 && output_sync(cache->of.file) == 0
               ? 0
               : output_fail(error, "count a frame in", cache->of.path.text);
}

void output_pc2_cut(const struct output_pc2 *cache, uint64_t n, bool counted)
{
    if (counted)
        pc2_put_count(cache, n);
    output_file_cut(&cache->of, pc2_size(cache->n_points, n), NULL);
}

int output_pc2_close(struct output_pc2 *cache, struct cloth_error *error)
{
    free(cache->bytes);
    cache->bytes = NULL;
    return output_file_close(&cache->of, error);
}

/* ---- Reading ---- */

bool output_pc2_read_header(FILE *file, uint32_t *n_points, uint32_t *n_frames)
{
    unsigned char header[OUTPUT_PC2_HEADER];
    return fread(header, sizeof header, 1, file) == 1 && pc2_parse(header, n_points, n_frames);
}

/* Floats come in lumps, so that a frame of any size needs little memory besides the caller's. */
const char *output_pc2_read(FILE *file, uint32_t n_points, uint64_t frame, double *x)
{
    enum { LUMP = 1024 };
    unsigned char lump[4 * LUMP];
    const size_t n = (size_t)3 * n_points;
    if (fseeko(file, (off_t)pc2_size(n_points, frame), SEEK_SET) != 0)
        return strerror(errno);
    for (size_t done = 0; done < n;) {
        const size_t some = n - done < LUMP ? n - done : LUMP;
        if (fread(lump, 4, some, file) != some)
            return ferror(file) ? strerror(errno) : "the file ends early";
        for (size_t i = 0; i < some; i++, done++)
            x[done] = (double)cloth_get_float(lump + 4 * i);
    }
    return NULL;
}
