/* Nothing here changes a file. */
#include "cloth/output/files/inputs.h"

#include "cloth/output/files/files.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>

struct output_input *output_inputs_find(const struct output_setup *setup)
{
    struct output_input *inputs = calloc(setup->n_inputs + 1, sizeof *inputs);
    for (size_t i = 0; inputs && i < setup->n_inputs; i++) {
        struct stat status;
        if (stat(setup->inputs[i], &status) == 0)
            inputs[i] = (struct output_input){true, status.st_dev, status.st_ino};
    }
    return inputs;
}

int output_input_check(const char *path, const struct output_setup *setup,
                       const struct output_input *inputs, struct cloth_error *error)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return 0;
    if (S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        return output_refuse(error, "replace", path);
    }
    for (size_t i = 0; i < setup->n_inputs; i++)
        if (inputs[i].is_there && inputs[i].device == status.st_dev &&
            inputs[i].number == status.st_ino)
            return cloth_fail(error, CLOTH_E_INPUT,
                              "%.300s would be replaced, but this run reads it, as %.300s; give "
                              "another folder, or move the file away",
                              path, setup->inputs[i]);
    return 0;
}
