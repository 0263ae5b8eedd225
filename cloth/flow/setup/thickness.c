/* Contact that is certified keeps triangles a thickness apart that share no corner: so no edge at
 * rest may be shorter, or a cloth would touch its own neighbours. */
#include "cloth/flow/setup/source.h"

#include <math.h>

/* Of two corners of a triangle, at rest. */
static double length_of(const struct mesh *rest, const uint32_t ends[2])
{
    const double *a = rest->position + 3 * (size_t)ends[0];
    const double *b = rest->position + 3 * (size_t)ends[1];
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* The shortest edge of all triangles, m, the first of equals; infinite: there is none. */
static double find_shortest(const struct mesh *rest, uint32_t shortest[2])
{
    double least = INFINITY;
    for (size_t i = 0; i < 3 * (size_t)rest->n_triangles; i++) {
        uint32_t corner[3];
        mesh_corners(rest, (uint32_t)(i / 3), corner);
        const uint32_t ends[2] = {corner[i % 3], corner[(i + 1) % 3]};
        const double length = length_of(rest, ends);
        if (!(length < least))
            continue;
        least = length;
        shortest[0] = ends[0];
        shortest[1] = ends[1];
    }
    return least;
}

int flow_thickness_check(const struct model *model, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        uint32_t ends[2] = {0};
        const double length = find_shortest(model_rest(cloth), ends);
        if (length < model->contact.thickness)
            code = model_fail(
                cloth->place, error,
                "cloth '%.60s': the edge between vertices %u and %u is %g m long at "
                "rest, shorter than contact.thickness, %g m; a smaller one is expected%s",
                cloth->name ? cloth->name : "", ends[0], ends[1], length, model->contact.thickness,
                model_contact_cure(model));
    }
    return code;
}
