#ifndef CLOTH_OUTPUT_FILES_INPUTS_H
#define CLOTH_OUTPUT_FILES_INPUTS_H

#include "cloth/output/output.h"

#include <sys/types.h>

/* A file that a run reads, and so does not replace: by what it is, not by its path. */
struct output_input {
    bool is_there;
    dev_t device;
    ino_t number;
};

/* Those of a setup, to be freed; NULL: no memory. */
struct output_input *output_inputs_find(const struct output_setup *setup);

/* Whether what stands where a file goes can be replaced, and is none of them. Errors as of
 * output_open. */
int output_input_check(const char *path, const struct output_setup *setup,
                       const struct output_input *inputs, struct cloth_error *error);

#endif
