/* Checkpoints: as they are, then with the length and the hash that their bytes should have, so that
 * what a hash keeps away is read, too. */
#include "cloth/output/checkpoint.h"
#include "tests/fuzz/fit.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>

static void read_checkpoint(const uint8_t *data, size_t size)
{
    struct cloth_error error = {0};
    struct output_checkpoint checkpoint;
    if (output_checkpoint_read(&checkpoint, fuzz_file("1.checkpoint", data, size), &error))
        return;
    volatile unsigned char sum = 0;
    for (int i = 0; i < OUTPUT_CHECKPOINT_PARTS; i++)
        for (size_t k = 0; k < checkpoint.part[i].n; k++)
            sum = (unsigned char)(sum + ((const unsigned char *)checkpoint.part[i].bytes)[k]);
    output_checkpoint_free(&checkpoint);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_checkpoint(data, size);
    uint8_t *fitting = malloc(size ? size : 1);
    if (!fitting)
        return 0;
    memcpy(fitting, data, size);
    fit_checkpoint(fitting, size);
    read_checkpoint(fitting, size);
    free(fitting);
    return 0;
}
