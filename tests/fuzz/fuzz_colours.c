/* colours.bin of a folder of frames, as duite-view reads it. The first byte says how many vertices
 * the mesh has. */
#include "cloth/output/colours.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>

enum { FRAMES = 4, MOST = 255 }; /* frames that are read; vertices */

static void read_frame(const struct output_colours_read *colours, uint64_t frame)
{
    int32_t number[MOST];
    struct cloth_error error = {0};
    struct element_strains rest = {0};
    output_colours_blocks(colours, frame, number, &error);
    error = (struct cloth_error){0};
    output_colours_ranks(colours, frame, number, &error);
    error = (struct cloth_error){0};
    if (output_colours_rest_since(colours, frame) != UINT64_MAX)
        output_colours_rest_at(colours, frame, &rest, &error);
    element_strains_free(&rest);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct cloth_error error = {0};
    struct output_colours_read *colours = NULL;
    if (!size || !data[0])
        return 0;
    fuzz_file("colours.bin", data + 1, size - 1);
    if (!output_colours_load(&colours, fuzz_folder(), data[0], &error))
        for (uint64_t frame = 0; frame < FRAMES; frame++)
            read_frame(colours, frame);
    output_colours_unload(colours);
    return 0;
}
