/* Places and velocities at the start, if the scene says more than the shape of the mesh and one
 * velocity. Rest shapes and masses do not change with them. */
#include "cloth/flow/run/source.h"

#include "cloth/physics/curve.h"
#include "cloth/physics/particle.h"

#include <stdlib.h>
#include <string.h>

static bool is_bounded(const double start[6])
{
    const phys_vec x = PHYS_VEC(start), v = {start[3], start[4], start[5], 0};
    return phys_diverged(1, FLOW_BOUND, &x) != 0 && phys_diverged(1, FLOW_BOUND, &v) != 0;
}

static int refuse_start(const struct model_cloth *cloth, uint32_t vertex, double (*start)[6],
                        const char *place, struct cloth_error *error)
{
    const double *x = start[vertex], *v = x + 3;
    return model_fail(
        place, error,
        "vertex %u of cloth '%.60s' starts at (%g, %g, %g) m with the velocity (%g, "
        "%g, %g) m/s; less than %g along each axis is expected (vertices count from 1)",
        vertex + 1, cloth->name, x[0], x[1], x[2], v[0], v[1], v[2], FLOW_BOUND);
}

static double wave_at(const struct model_start *how, const double mesh[3])
{
    double cycles = how->wave.phase;
    for (int c = 0; c < 3; c++)
        cycles += how->wave.vector[c] * (mesh[c] - how->about[c]);
    return phys_sine(cycles);
}

/* mesh: where the mesh has the vertex. */
static void move_start(double start[6], const double mesh[3], const struct model_start *how)
{
    double *x = start, *v = x + 3, arm[3];
    const double sine = wave_at(how, mesh);
    struct mesh one = {.n_vertices = 1, .position = arm};
    for (int c = 0; c < 3; c++)
        arm[c] = x[c] - how->about[c];
    mesh_apply(&one, &how->transform);
    for (int c = 0; c < 3; c++) {
        const int a = (c + 1) % 3, b = (c + 2) % 3;
        const double before = how->has_velocity ? how->velocity[c] : v[c];
        v[c] =
            before + (how->spin[a] * arm[b] - how->spin[b] * arm[a]) + how->wave.velocity[c] * sine;
        x[c] = how->about[c] + arm[c] + how->wave.translate[c] * sine;
    }
}

static void at_mesh(const struct model_cloth *cloth, double (*start)[6])
{
    const uint32_t n = cloth->mesh.n_vertices;
    if (cloth->start)
        memcpy(start, cloth->start, n * sizeof *start);
    for (size_t i = 0; i < n && !cloth->start; i++) {
        memcpy(start[i], cloth->mesh.position + 3 * i, 3 * sizeof(double));
        memcpy(start[i] + 3, cloth->velocity, 3 * sizeof(double));
    }
}

int flow_starts_make(struct flow_particles *particles, uint32_t first,
                     const struct model_cloth *cloth, struct cloth_error *error)
{
    if (!particles->start)
        return CLOTH_OK;
    double(*start)[6] = particles->start + first;
    struct flow_picking picking = {cloth, first, particles->used, "a start", {0}};
    int code = CLOTH_OK;
    at_mesh(cloth, start);
    for (uint32_t i = 0; i < cloth->mesh.n_vertices && !code; i++)
        code = is_bounded(start[i]) ? CLOTH_OK : refuse_start(cloth, i, start, cloth->place, error);
    for (uint32_t i = 0; i < cloth->n_starts && !code; i++, picking.list.n = 0) {
        const struct model_pick *pick = &cloth->starts[i].pick;
        uint32_t lost = UINT32_MAX;
        code = flow_pick(pick, &picking, error);
        const uint32_t *vertex = picking.list.items;
        for (size_t k = 0; k < picking.list.n && !code; k++) {
            const uint32_t v = vertex[k] - first;
            move_start(start[v], cloth->mesh.position + 3 * (size_t)v, cloth->starts + i);
            lost = is_bounded(start[v]) ? lost : v;
        }
        if (lost != UINT32_MAX)
            code = refuse_start(cloth, lost, start, pick->place, error);
    }
    free(picking.list.items);
    return code;
}

void flow_starts_take(const struct flow_particles *particles, const struct model *model,
                      double (*start)[6])
{
    if (particles->start)
        memcpy(start, particles->start, particles->n * sizeof *start);
    for (uint32_t c = 0; c < model->n_cloths && !particles->start; c++)
        at_mesh(model->cloths + c, start + model_first(model, c));
}
