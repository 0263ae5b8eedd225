/* The seams beside an OBJ mesh, here one of two squares. */
#include "cloth/scene/build/build.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double vertices[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                      0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    struct cloth_error error = {0};
    struct model model = {0};
    struct model_cloth *cloth = cloth_alloc(1, sizeof *cloth, &error);
    if (!cloth)
        return 0;
    model.cloths = cloth;
    model.n_cloths = 1;
    if (!mesh_inline(&cloth->mesh, 8, vertices, 0, NULL, 4, triangles, &error))
        scene_read_seams(cloth, fuzz_file("mesh.seams.json", data, size), &error);
    model_free(&model);
    return 0;
}
