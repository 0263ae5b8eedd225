/* A warned run is made all the same: the estimate is of the start alone. */
#include "cloth/flow/integrators/integrator.h"

#include "cloth/base/memory.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/state/state.h"

#include <math.h>
#include <stdlib.h>

/* The h w, w the fastest vibration, above which solves of implicit steps are expected to fail. The
 * matrix is (h w)^2 times the masses, and rounding leaves 1e-16 times that of dv's error. */
static const double MAX_TURN = 1e4;

static const char *place_of_h(const struct model *model)
{
    return model->h_place ? model->h_place : "h";
}

/* The part that a step of explicit Euler adds to an undamped vibration. turn: h w. */
static double growth_of(double turn)
{
    return turn * turn / (1 + sqrt(1 + turn * turn));
}

/* An explicit step that lets vibrations grow is made all the same. */
static void warn_explicit(struct flow *flow, const struct flow_limit *limit)
{
    const struct model *model = flow->model;
    const char *name = model_scheme(model)->name, *place = place_of_h(model);
    const double max = flow_limit_of(limit, model->integrator), turn = model->h * limit->omega;
    if (!(max > 0))
        flow_warn_say(flow, FLOW_WARN_STEP, place,
                      "no step is short enough for %s without damping: the fastest vibration (up "
                      "to %g rad/s, at vertex %u of cloth '%.60s', counted from 1) can grow by %g "
                      "%% in each of %g s",
                      name, limit->omega, limit->vertex + 1, limit->cloth->name,
                      100 * growth_of(turn), model->h);
    else if (model->h > max)
        flow_warn_say(
            flow, FLOW_WARN_STEP, place,
            "steps of %g s are beyond the limit of %s, %g s: the fastest vibration (up "
            "to %g rad/s, at vertex %u of cloth '%.60s', counted from 1) can grow in each",
            model->h, name, max, limit->omega, limit->vertex + 1, limit->cloth->name);
}

/* Springs of contacts, which may be faster than those of the cloth. */
static void warn_of_contacts(struct flow *flow)
{
    const struct model *model = flow->model;
    const struct contact_spring spring = flow_contact_mode(model)->spring(flow, model->h);
    const double rate = FLOW_SPRINGS_MOST / flow->vertex_mass;
    const struct flow_limit limit = {.omega = sqrt(rate * spring.stiffness),
                                     .along = rate * spring.damping};
    const double max = flow_limit_of(&limit, model->integrator);
    if (flow->vertex_mass > 0 && model->h > max)
        flow_warn_say(flow, FLOW_WARN_STEP, place_of_h(model),
                      "steps of %g s are beyond what contacts of stiffness %g N/m and damping %g "
                      "allow %s, %g s: what they push can bounce ever harder",
                      model->h, spring.stiffness, model->contact.damping, model_scheme(model)->name,
                      max);
}

static void warn_implicit(struct flow *flow, const struct flow_limit *limit)
{
    const struct model *model = flow->model;
    const double turn = model->h * limit->omega;
    if (turn > MAX_TURN)
        flow_warn_say(
            flow, FLOW_WARN_STEP, place_of_h(model),
            "in steps of %g s the cloth is %.1e times stiffer than its mass (vertex %u of "
            "cloth '%.60s', counted from 1): solves can fail, and the run can take up to "
            "1024 times as many steps; give a density or mass %.1e times as large, or "
            "steps of at most %.1e s",
            model->h, turn * turn, limit->vertex + 1, limit->cloth->name,
            turn * turn / (MAX_TURN * MAX_TURN), MAX_TURN / limit->omega);
}

/* The smallest mass of an area, kg/m^2, of a cloth; infinite: it has no triangles. *edge: the mean
 * distance of its vertices, m. */
static int find_density(const struct model *model, const struct model_cloth *cloth, double *density,
                        double *edge, struct cloth_error *error)
{
    const uint32_t n = cloth->mesh.n_vertices;
    double *area = cloth_alloc(n, sizeof *area, error), sum = 0;
    if (!area)
        return CLOTH_E_MEMORY;
    mesh_add_mass(model_rest(cloth), 1, false, area);
    *density = INFINITY;
    for (uint32_t v = 0; v < n; v++) {
        sum += area[v];
        if (area[v] > 0 && cloth->mass_per_vertex > 0)
            *density = fmin(*density, cloth->mass_per_vertex / area[v]);
    }
    for (uint32_t i = 0; i <= cloth->n_regions && !(cloth->mass_per_vertex > 0) && sum > 0; i++)
        *density = fmin(*density, model_material(model, cloth, i)->density);
    *edge = sqrt(sum / n);
    free(area);
    return CLOTH_OK;
}

/* Forces on a cloth that the matrix does not know: the first kind that has something to say. */
static void warn_of_kinds(struct flow *flow, const struct element_sheet *sheet)
{
    char text[400] = "";
    for (int i = 0; i < ELEMENT_KINDS && !*text; i++)
        if (element_kinds[i]->warn && element_kinds[i]->has(sheet->model, sheet->cloth))
            element_kinds[i]->warn(sheet, text, sizeof text);
    if (*text)
        flow_warn_say(flow, FLOW_WARN_AIR, place_of_h(sheet->model), "%s", text);
}

static int warn_of_elements(struct flow *flow, struct cloth_error *error)
{
    struct element_sheet sheet = {.model = flow->model};
    for (uint32_t c = 0; c < flow->model->n_cloths && !flow->warning[FLOW_WARN_AIR][0]; c++) {
        sheet.cloth = flow->model->cloths + c;
        if (!element_parts(sheet.model, sheet.cloth))
            continue;
        if (find_density(sheet.model, sheet.cloth, &sheet.density, &sheet.edge, error))
            return CLOTH_E_MEMORY;
        warn_of_kinds(flow, &sheet);
    }
    return CLOTH_OK;
}

int flow_warn_of_steps(struct flow *flow, struct cloth_error *error)
{
    struct flow_limit limit;
    if (flow_limit_find(&flow->source, &limit, error))
        return CLOTH_E_MEMORY;
    if (model_is_implicit(flow->model))
        warn_implicit(flow, &limit);
    else
        warn_explicit(flow, &limit);
    if (!model_is_implicit(flow->model) && flow_contact_mode(flow->model)->spring)
        warn_of_contacts(flow);
    return warn_of_elements(flow, error);
}
