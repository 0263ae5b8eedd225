/* The table of kinds, and questions to it about a cloth. */
#include "cloth/element/kind.h"

#define ELEMENT_ADDRESS(name) &element_##name,
const struct element_kind *const element_kinds[ELEMENT_KINDS] = {ELEMENT_ALL(ELEMENT_ADDRESS)};

unsigned element_parts(const struct model *model, const struct model_cloth *cloth)
{
    unsigned parts = 0;
    for (int i = 0; i < ELEMENT_KINDS; i++)
        if (element_kinds[i]->has(model, cloth))
            parts |= 1u << element_kinds[i]->part;
    return parts;
}

const struct element_kind *element_in_matrix(const struct model *model,
                                             const struct model_cloth *cloth)
{
    for (int i = 0; i < ELEMENT_KINDS; i++)
        if (element_kinds[i]->pairs && element_kinds[i]->has(model, cloth))
            return element_kinds[i];
    return NULL;
}

void element_materials(const struct element_kind *kind, const struct model *model, void *to)
{
    for (size_t m = 0; kind->material_bytes && m < model->n_materials; m++)
        kind->material(model->materials + m, (char *)to + kind->material_bytes * m);
}
