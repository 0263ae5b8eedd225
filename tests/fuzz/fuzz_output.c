/* A folder of frames as duite-view reads it: cloth.obj, cloth.pc2, frames.csv, scene.json,
 * contact.pc2, and a body with its shapes. */
#include "cloth/output/files/scene.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>

enum { FRAMES = 4 }; /* that are read */

static void read_frames(struct output_cache *cache)
{
    const uint32_t n = cache->mesh.n_vertices;
    double *position = malloc(3 * sizeof *position * n);
    for (uint64_t k = 0; position && k < FRAMES; k++) {
        struct cloth_error error = {0};
        if (!output_cache_frame(cache, k, position, &error))
            output_cache_pose(cache, k, &error);
        error = (struct cloth_error){0};
        uint64_t n_frames;
        output_forces_read(fuzz_folder(), n, k, position, &n_frames, &error);
    }
    free(position);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"scene.json",  "cloth.obj",  "cloth.pc2", "frames.csv",
                                        "contact.pc2", "body-0.obj", "body-0.pc2"};
    struct cloth_error error = {0};
    struct output_cache cache;
    fuzz_files(sizeof names / sizeof *names, names, data, size);
    if (!output_cache_open(&cache, fuzz_folder(), &error)) {
        read_frames(&cache);
        output_cache_close(&cache);
    }
    output_bodies_before(fuzz_folder());
    return 0;
}
