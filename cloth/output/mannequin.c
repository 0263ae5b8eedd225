/* A figure is written as the bodies of a folder are. */
#include "cloth/output/mannequin.h"
#include "cloth/base/bytes.h"
#include "cloth/base/memory.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/pc2.h"

#include <stdlib.h>

struct writing {
    const struct output_shapes *shapes;
    double (*x)[3];       /* room for a frame, */
    unsigned char *bytes; /* as it is written */
};

static int fill_pc2(FILE *file, const void *what)
{
    const struct writing *writing = what;
    const struct output_shapes *shapes = writing->shapes;
    unsigned char header[OUTPUT_PC2_HEADER];
    output_pc2_header(header, shapes->n_points, shapes->n_frames);
    fwrite(header, sizeof header, 1, file);
    for (uint32_t k = 0; k < shapes->n_frames && !ferror(file); k++) {
        shapes->place(shapes->context, k, writing->x);
        cloth_put_points(writing->bytes, shapes->n_points, writing->x[0], 3);
        fwrite(writing->bytes, 12, shapes->n_points, file);
    }
    return ferror(file);
}

int output_mannequin_pc2(const char *path, const struct output_shapes *shapes,
                         struct cloth_error *error)
{
    const struct writing writing = {shapes, cloth_alloc(shapes->n_points, sizeof *writing.x, error),
                                    cloth_alloc(shapes->n_points, 12, error)};
    const int code = writing.x && writing.bytes
                         ? output_replace_file(path, fill_pc2, &writing, error)
                         : CLOTH_E_MEMORY;
    free(writing.x);
    free(writing.bytes);
    return code;
}
