/* Bodies whose surface goes through itself: nothing says there what is inside, and cloth that gets
 * between two of its parts is pinched. They are met all the same, with a warning. */
#include "cloth/scene/build/build.h"
#include "cloth/verify/verify.h"

#include <stdlib.h>

static int warn_of_pairs(struct model *model, const struct mesh *mesh,
                         const struct cloth_list *pairs, const struct scene_tree *tree, int file,
                         struct cloth_error *error)
{
    const struct verify_pair *first = pairs->items;
    if (!pairs->n)
        return CLOTH_OK;
    const uint32_t *a = mesh->triangle + 3 * (size_t)first->triangle[0];
    const uint32_t *b = mesh->triangle + 3 * (size_t)first->triangle[1];
    return scene_build_warn(model, tree, file, error,
                            "the body goes through itself: %zu pairs of its triangles intersect, "
                            "the first are %u %u %u and %u %u %u (vertices count from 1); cloth "
                            "can be pinched there: move its parts apart, or join them",
                            pairs->n, a[0] + 1, a[1] + 1, a[2] + 1, b[0] + 1, b[1] + 1, b[2] + 1);
}

int scene_build_warn_crossed(struct model *model, const struct mesh *mesh, const double *place,
                             const struct scene_tree *tree, int file, struct cloth_error *error)
{
    const double *x = place ? place : mesh->position;
    const struct verify_soup soup = {.n_points = mesh->n_vertices,
                                     .n_triangles = mesh->n_triangles,
                                     .n_first = mesh->n_triangles,
                                     .x = (const double(*)[3])x,
                                     .corner = (const uint32_t(*)[3])mesh->triangle};
    struct cloth_list pairs = {0};
    int code = verify_pairs(&soup, &pairs, error);
    if (!code)
        code = warn_of_pairs(model, mesh, &pairs, tree, file, error);
    free(pairs.items);
    return code;
}
