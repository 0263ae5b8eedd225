/* Drag and wind on faces (cloth/physics/air.h). They are not in the matrix, so steps have a limit.
 * The list of faces has corners only. */
#include "cloth/physics/air.h"
#include "cloth/element/kind.h"

#include <math.h>
#include <stdio.h>

static bool air_has(const struct model *model, const struct model_cloth *cloth)
{
    (void)cloth;
    return model_has_air(model);
}

/* The longest step, s, in which the drag of the air does not more than reverse the velocity of a
 * cloth. The slope of the drag over the mass, rho C |u| / density, times h must be below 2. speed:
 * |u| of the cloth's start against the strongest wind, m/s. */
static double air_limit(const struct model *model, double density, double speed)
{
    const struct phys_air *air = &model->air;
    return 2 * density / (air->density * fmax(air->normal, air->tangent) * speed);
}

/* The air's push is that of the begin of a step, whatever the integrator. */
static void air_warn(const struct element_sheet *sheet, char *text, size_t size)
{
    const struct model *model = sheet->model;
    const double gusts = 1 + 3 * model->air.turbulence.intensity; /* three times the mean size */
    const double strongest = gusts * model_curve_max(model, model->wind_curve);
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += pow(strongest * model->air.wind[i] - sheet->cloth->velocity[i], 2);
    const double speed = sqrt(square), max = air_limit(model, sheet->density, speed);
    *text = 0;
    if (model->h > max)
        snprintf(text, size,
                 "steps of %g s are beyond the limit of the air, which is not in the matrix, %g s: "
                 "its push on cloth '%.60s' can grow in each. It blows %g m in a step, vertices "
                 "are %g m apart; give shorter steps or less wind",
                 model->h, max, sheet->cloth->name, speed * model->h, sheet->edge);
}

const struct element_kind element_air = {
    .name = "faces in the air",
    .part = ELEMENT_FACES,
    .corners = 4,
    .has = air_has,
    .warn = air_warn,
    .force = phys_air_force,
};
