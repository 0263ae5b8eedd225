/* PC2 point caches: all frames, and one of them. The mesh has 3 vertices, or as many as the header
 * says: it is the header that claims them. */
#include "cloth/mesh/mesh.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>
#include <string.h>

static void read_cache(const char *path, uint32_t n_vertices, uint32_t frame)
{
    struct cloth_error error = {0};
    uint32_t n_frames;
    double *place;
    mesh_read_pc2(path, n_vertices, MESH_ALL_FRAMES, &n_frames, &place, &error);
    free(place);
    error = (struct cloth_error){0};
    mesh_read_pc2(path, n_vertices, frame, &n_frames, &place, &error);
    free(place);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *path = fuzz_file("cloth.pc2", data, size);
    uint32_t n_vertices = 3;
    read_cache(path, n_vertices, MESH_LAST_FRAME);
    if (size >= 20)
        memcpy(&n_vertices, data + 16, sizeof n_vertices);
    read_cache(path, n_vertices, 1);
    return 0;
}
