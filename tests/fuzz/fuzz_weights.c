/* Weights of meshes of 1, 4 and 7 vertices: those that are read are from 0 to 1. */
#include "cloth/mesh/mesh.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>

enum { MOST = 7 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *path = fuzz_file("weights.txt", data, size);
    for (uint32_t n = 1; n <= MOST; n += 3) {
        struct cloth_error error = {0};
        double *weight = calloc(n, sizeof *weight);
        if (!weight)
            abort();
        const int code = mesh_read_weights(path, n, weight, &error);
        for (uint32_t v = 0; v < n && !code; v++)
            if (!(weight[v] >= 0 && weight[v] <= 1))
                abort();
        free(weight);
    }
    return 0;
}
