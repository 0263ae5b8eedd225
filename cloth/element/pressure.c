/* Pressure on triangles (cloth/physics/air.h). It is not in the matrix, so steps have a limit.
 */
#include "cloth/element/cloths.h"
#include "cloth/physics/air.h"

#include <math.h>
#include <stdio.h>

static bool pressure_has(const struct model *model, const struct model_cloth *cloth)
{
    (void)model;
    return cloth->pressure != 0;
}

static void pressure_pack(const struct element_cloths *cloths, const struct element *element,
                          const struct phys_elements *list, uint32_t e)
{
    list->number[PHYS_PRESSURE][e] = cloths->model->cloths[element->cloth].pressure;
}

/* The slope of the push on a vertex is some p times an edge, its mass the density times the edge
 * squared. Errors do not grow where h^2 times the slope stays below twice the mass. */
static void pressure_warn(const struct element_sheet *sheet, char *text, size_t size)
{
    const double p = fabs(sheet->cloth->pressure), h = sheet->model->h;
    const double max = sqrt(2 * sheet->density * sheet->edge / p);
    *text = 0;
    if (h > max)
        snprintf(text, size,
                 "steps of %g s are beyond the limit of the pressure, which is not in the matrix, "
                 "%g s: what %g Pa do to cloth '%.60s' can grow in each; give shorter steps",
                 h, max, p, sheet->cloth->name);
}

const struct element_kind element_pressure = {
    .name = "triangles under pressure",
    .part = ELEMENT_TRIANGLES,
    .corners = 3,
    .numbers = 1,
    .has = pressure_has,
    .pack = pressure_pack,
    .warn = pressure_warn,
    .force = phys_pressure_force,
};
