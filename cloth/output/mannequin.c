/* A figure is written as the bodies of a folder are. */
#include "cloth/output/mannequin.h"
#include "cloth/output/files/files.h"

int output_mannequin_obj(const char *path, const struct mesh *mesh, struct cloth_error *error)
{
    const struct output_setup alone = {.n_meshes = 1,
                                       .meshes = (const struct mesh *const[]){mesh},
                                       .names = (const char *const[]){"body"}};
    return output_replace_file(path, output_fill_obj, &alone, error);
}
