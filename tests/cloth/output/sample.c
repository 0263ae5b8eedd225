/* Everything here fails the test itself when the file system does not do its part. */
#include "tests/cloth/output/sample.h"

#include "tests/support/unit.h"

#include <ftw.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char QUAD[] = "v 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\nf 1 2 3 4\nl 1 3\n";
/* A floor, and a ball that moves. */
static const struct contact_shape OBSTACLES[] = {
    {.value = {0, -0.1, 0, 0, 1, 0}},
    {.kind = 1, .value = {1, 2, 3, 0.5}, .n = 2, .about = {0, 0, 7}}};
static const struct phys_key KEYS[] = {{0, {0}, {1, 0, 0, 0}},
                                       {0.5, {-1, 0.1, 0}, {0.6, 0, 0.8, 0}}};
static const char *const NAMES[2] = {"sheet", "a\npatch"};

struct sample sample;

void sample_make(void)
{
    memset(&sample, 0, sizeof sample);
    strcpy(sample.folder, "/tmp/duite-output.XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(sample.folder));
    snprintf(sample.frames, sizeof sample.frames, "%s/frames", sample.folder);
    const char *quad = sample_at("quad.obj");
    sample_write(quad, QUAD, strlen(QUAD));
    UNIT_FINE(mesh_grid(&sample.mesh[0], 1, 1, 4, 3, MESH_SAME, &error));
    UNIT_FINE(mesh_read_obj(&sample.mesh[1], quad, &error));
    sample.meshes[0] = &sample.mesh[0];
    sample.meshes[1] = &sample.mesh[1];
    sample.setup = (struct output_setup){.folder = sample.frames,
                                         .n_meshes = 2,
                                         .meshes = sample.meshes,
                                         .names = NAMES,
                                         .fps = 25,
                                         .n_obstacles = 2,
                                         .obstacles = OBSTACLES,
                                         .keys = KEYS};
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

void sample_free(void)
{
    mesh_free(&sample.mesh[0]);
    mesh_free(&sample.mesh[1]);
    nftw(sample.folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
}

void sample_positions(unsigned run, uint64_t frame, double *position)
{
    for (int i = 0; i < 3 * SAMPLE_POINTS; i++)
        position[i] = 1000.0 * run + (double)frame + i / 64.0;
}

const char *sample_at(const char *format, ...)
{
    enum { TURNS = 4, LONG = 200 };
    static char path[TURNS][LONG];
    static unsigned turn;
    char *to = path[turn++ % TURNS];
    va_list arguments;
    const int n = snprintf(to, LONG, "%s/", sample.folder);
    va_start(arguments, format);
    vsnprintf(to + n, (size_t)(LONG - n), format, arguments);
    va_end(arguments);
    return to;
}

const char *sample_path(const char *name)
{
    return sample_at("frames/%s", name);
}

bool sample_has(const char *path)
{
    return access(path, F_OK) == 0;
}

struct stat sample_stat(const char *path)
{
    struct stat status;
    ck_assert_msg(!stat(path, &status), "%s is not there", path);
    return status;
}

size_t sample_read(const char *path, char *bytes, size_t size)
{
    FILE *file = fopen(path, "rb");
    ck_assert_msg(file != NULL, "%s is not there", path);
    size_t n = fread(bytes, 1, size - 1, file);
    bytes[n] = '\0';
    fclose(file);
    return n;
}

static void write_to(const char *path, const char *how, long at, const char *bytes, size_t size)
{
    FILE *file = fopen(path, how);
    ck_assert_msg(file != NULL, "%s cannot be written", path);
    ck_assert_int_eq(fseek(file, at < 0 ? 0 : at, at < 0 ? SEEK_END : SEEK_SET), 0);
    ck_assert_uint_eq(fwrite(bytes, 1, size, file), size);
    ck_assert_int_eq(fclose(file), 0);
}

void sample_write(const char *path, const char *bytes, size_t size)
{
    write_to(path, "wb", 0, bytes, size);
}

void sample_put(const char *path, long at, const char *bytes, size_t size)
{
    write_to(path, "r+b", at, bytes, size);
}

void sample_run(unsigned run, uint64_t n)
{
    struct output_frames *frames = NULL;
    double position[3 * SAMPLE_POINTS];
    struct output_settler **settler = &sample.setup.settler;
    if (sample.settles)
        UNIT_FINE(output_settler_open(settler, &error));
    UNIT_FINE(output_open(&frames, &sample.setup, &error));
    for (uint64_t i = 0; i < n; i++) {
        sample_positions(run, i, position);
        UNIT_FINE(output_frame(frames, i, (double)i / 25, position, &error));
    }
    UNIT_FINE(output_settler_close(settler, &error));
    UNIT_FINE(output_close(&frames, &error));
    ck_assert_ptr_null(frames);
}
