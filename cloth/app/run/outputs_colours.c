/* The folder has the shapes and moduli that give the strain of any frame, not the strain: they are
 * written once, and a run need not know what its pictures will show. */
#include "cloth/app/run/outputs_colours.h"

#include "cloth/element/strain.h"

#include <stdio.h>
#include <string.h>

double outputs_colours_bytes(const struct model *model, uint64_t n_vertices)
{
    struct element_strains rest = {.n_materials = model->n_materials};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        rest.n_triangles += model->cloths[c].mesh.n_triangles;
        rest.n_edges += model->cloths[c].mesh.n_bare_edges;
    }
    const uint64_t blocks = n_vertices / model->grain + 1;
    return (double)output_colours_bytes((uint32_t)n_vertices, (uint32_t)blocks, &rest);
}

/* Goes on without the file that was not written. */
static int outputs_colours_go_on(struct output_colours **colours, int code,
                                 struct cloth_error *error)
{
    struct cloth_error ignored = {0};
    if (code != CLOTH_E_IO)
        return code;
    fprintf(stderr,
            "duite-cloth: warning: %s; the run goes on, and pictures of later frames are coloured "
            "by what was written before\n",
            error->text);
    output_colours_close(colours, &ignored);
    *error = (struct cloth_error){0};
    return CLOTH_OK;
}

int outputs_colours_rest(struct output_colours **colours, const struct model *model, uint64_t frame,
                         struct cloth_error *error)
{
    struct element_strains rest;
    if (!*colours)
        return CLOTH_OK;
    int code = element_strains_make(&rest, model, error);
    if (!code)
        code = outputs_colours_go_on(colours, output_colours_rest(*colours, frame, &rest, error),
                                     error);
    element_strains_free(&rest);
    return code;
}

int outputs_colours_places(struct output_colours **colours, uint64_t frame,
                           const struct flow_places *places, struct cloth_error *error)
{
    return *colours
               ? outputs_colours_go_on(colours,
                                       output_colours_places(*colours, frame, places->block,
                                                             places->n_blocks, places->rank, error),
                                       error)
               : CLOTH_OK;
}
