/* Messages and reports know phases by their names. */
#include "cloth/scene/build/build.h"

#include <string.h>

int scene_build_phases(const struct model *model, struct cloth_error *error)
{
    for (uint32_t i = 0; i < model->n_phases; i++)
        for (uint32_t k = 0; k < i; k++)
            if (!strcmp(model->phases[i].name, model->phases[k].name))
                return model_fail(model->phases[i].place, error,
                                  "phases[%u].name is '%.60s', as that of phases[%u]; each phase "
                                  "has a name of its own",
                                  i, model->phases[i].name, k);
    return CLOTH_OK;
}
