/* Particles carry the data of a vertex on its own: mass, drag, load, whether a pin holds it.
 * Vertices that no face, edge or joint uses stay where they are, at rest, and need no mass. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/physics/particle.h"

#include <math.h>
#include <stdlib.h>

/* kg of a vertex: squares of momenta beyond these would vanish or be infinite. */
static const double MIN_MASS = 1e-30, MAX_MASS = 1e30;

/* Adds a mass to a vertex of all cloths: a name's mass goes to its root. */
static void particles_weigh(struct flow_particles *p, uint32_t vertex, double mass)
{
    p->mass[flow_root(&p->welds, vertex)] += mass;
    if (p->own)
        p->own[vertex] += mass;
}

static int more_masses(struct flow_particles *p, uint32_t first, const struct model_cloth *cloth,
                       struct cloth_error *error)
{
    struct flow_picking picking = {cloth, first, p->used, "a mass", {0}};
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < cloth->n_masses && !code; i++, picking.list.n = 0) {
        code = flow_pick(&cloth->masses[i].pick, &picking, error);
        const uint32_t *vertex = picking.list.items;
        for (size_t k = 0; k < picking.list.n && !code; k++)
            particles_weigh(p, vertex[k], cloth->masses[i].mass);
    }
    free(picking.list.items);
    return code;
}

/* Fails: no triangle of the vertex, if it has any, gives it a mass. */
static int no_mass(const struct model_cloth *cloth, uint32_t vertex, struct cloth_error *error)
{
    for (uint32_t t = 0; t < cloth->mesh.n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(&cloth->mesh, t, corner);
        if (corner[0] == vertex || corner[1] == vertex || corner[2] == vertex)
            return model_fail(cloth->mesh_place, error,
                              "mesh: triangle %u of cloth '%.60s' (vertices %u, %u and %u, all "
                              "counted from 1) has no area at rest, so that vertex %u has no mass; "
                              "an area above 0 is expected, or mass_per_vertex",
                              t + 1, cloth->name, corner[0] + 1, corner[1] + 1, corner[2] + 1,
                              vertex + 1);
    }
    return model_fail(
        cloth->place, error,
        "mass_per_vertex is missing: only edges or joints use vertex %u of cloth '%.60s', which "
        "have no area to take a mass from; a finite number > 0 (kg) is expected (vertices count "
        "from 1)",
        vertex + 1, cloth->name);
}

static int masses(struct flow_particles *p, uint32_t first, const struct model *model,
                  const struct model_cloth *cloth, struct cloth_error *error)
{
    for (uint32_t t = 0; t < cloth->mesh.n_triangles && !(cloth->mass_per_vertex > 0); t++) {
        struct mesh_share share; /* of a linear element its lumped mass */
        uint32_t corner[3];
        mesh_corners(&cloth->mesh, t, corner);
        mesh_share_of(model_rest(cloth), t,
                      model->materials[model_material_of(cloth, 3, corner)].density,
                      model_has_cells(model, cloth), &share);
        for (uint32_t i = 0; i < share.n; i++)
            particles_weigh(p, first + share.vertex[i], share.mass);
    }
    for (uint32_t i = 0; i < cloth->mesh.n_vertices && cloth->mass_per_vertex > 0; i++)
        particles_weigh(p, first + i, cloth->mass_per_vertex);
    return more_masses(p, first, cloth, error);
}

/* Checks that all masses of a cloth are there and in bounds; sets their weights. */
static int weights(struct flow_particles *p, uint32_t first, const struct model *model,
                   const struct model_cloth *cloth, struct cloth_error *error)
{
    const phys_vec gravity = PHYS_VEC(model->gravity);
    for (uint32_t i = 0; i < cloth->mesh.n_vertices; i++) {
        const uint32_t v = first + i;
        const double mass = p->mass[flow_root(&p->welds, v)];
        if (p->used[v] && mass > 0 && !(mass >= MIN_MASS && mass <= MAX_MASS))
            return model_fail(cloth->place, error,
                              "vertex %u of cloth '%.60s' has a mass of %g kg; %g to %g is "
                              "expected (vertices count "
                              "from 1)",
                              i + 1, cloth->name, mass, MIN_MASS, MAX_MASS);
        if (p->used[v] && !(mass > 0))
            return no_mass(cloth, i, error);
        if (p->load)
            p->load[v] = p->mass[v] * gravity;
    }
    return CLOTH_OK;
}

/* A start that a run would take for divergence. */
static int check_start(const struct model_cloth *cloth, struct cloth_error *error)
{
    for (uint32_t i = 0; i < cloth->mesh.n_vertices; i++) {
        const phys_vec x = PHYS_VEC(cloth->mesh.position + 3 * (size_t)i);
        if (phys_diverged(1, FLOW_BOUND, &x) == 0)
            return model_fail(cloth->mesh_place, error,
                              "vertex %u of cloth '%.60s' starts at (%g, %g, %g) m, after the "
                              "transform; less than %g m from the origin along each axis is "
                              "expected (vertices count from 1)",
                              i + 1, cloth->name, x[0], x[1], x[2], FLOW_BOUND);
    }
    const phys_vec v = PHYS_VEC(cloth->velocity);
    if (phys_diverged(1, FLOW_BOUND, &v) == 0)
        return model_fail(cloth->velocity_place, error,
                          "cloth '%.60s' starts with the velocity (%g, %g, %g) m/s; less than %g "
                          "m/s along each axis is expected",
                          cloth->name, v[0], v[1], v[2], FLOW_BOUND);
    return CLOTH_OK;
}

static int cloth_particles(struct flow_particles *p, uint32_t first, const struct model *model,
                           const struct model_cloth *cloth, struct cloth_error *error)
{
    for (uint32_t i = 0; i < cloth->mesh.n_vertices; i++) {
        p->free[first + i] = 1;
        if (!p->used[first + i])
            flow_unusual_note(&p->unused, cloth, i, cloth->mesh_place);
    }
    int code = check_start(cloth, error);
    if (!code)
        code = flow_starts_make(p, first, cloth, error);
    return code ? code : masses(p, first, model, cloth, error);
}

/* Sets weights, loads and pins, when the masses of all cloths are there: a welded vertex has
 * several. */
static int cloth_forces(struct flow_particles *p, uint32_t first, const struct model *model,
                        const struct model_cloth *cloth, struct cloth_error *error)
{
    int code = weights(p, first, model, cloth, error);
    if (!code)
        code = flow_loads_make(p, first, cloth, error);
    if (!code)
        code = flow_pins_make(p, first, model, cloth, error);
    return code;
}

/* Does it for all cloths, one after the other. */
static int each_cloth(struct flow_particles *p, const struct model *model,
                      int (*make)(struct flow_particles *p, uint32_t first,
                                  const struct model *model, const struct model_cloth *cloth,
                                  struct cloth_error *error),
                      struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++)
        code = make(p, model_first(model, c), model, model->cloths + c, error);
    return code;
}

static int particles_allocate(struct flow_particles *p, uint32_t n, bool loaded, bool starts,
                              const struct model *model, struct cloth_error *error)
{
    struct cloth_pool *memory = &p->memory;
    p->n = n;
    p->used = cloth_take(memory, n, 1, error);
    p->free = cloth_take(memory, n, 1, error);
    p->mass = cloth_take(memory, n, sizeof *p->mass, error);
    p->motion = model->n_motions ? cloth_take(memory, n, sizeof *p->motion, error) : NULL;
    p->slider = model->n_sliders ? cloth_take(memory, n, sizeof *p->slider, error) : NULL;
    p->own = model->n_welds ? cloth_take(memory, n, sizeof *p->own, error) : NULL;
    p->drag = model->n_welds ? cloth_take(memory, n, sizeof *p->drag, error) : NULL;
    p->start = starts ? cloth_take(memory, n, sizeof *p->start, error) : NULL;
    p->load = loaded ? cloth_take(memory, n, sizeof *p->load, error) : NULL;
    return memory->lacks ? CLOTH_E_MEMORY : CLOTH_OK;
}

static int find_used(struct flow_particles *p, const struct model *model, struct cloth_error *error)
{
    for (uint32_t c = 0; c < model->n_cloths; c++)
        mesh_used(&model->cloths[c].mesh, p->used + model_first(model, c));
    return flow_joints_use(p, model, error);
}

int flow_particles_make(struct flow_particles *particles, const struct model *model,
                        struct cloth_error *error)
{
    *particles = (struct flow_particles){0};
    size_t n = 0;
    bool loaded = false, starts = model->n_welds; /* which may move vertices a little */
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        n += model->cloths[c].mesh.n_vertices;
        loaded = loaded || model->cloths[c].n_loads;
        starts = starts || model->cloths[c].start || model->cloths[c].n_starts;
    }
    if (n >= UINT32_MAX)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%zu vertices are too many; at most 4294967294 are possible", n);
    int code = particles_allocate(particles, (uint32_t)n, loaded, starts, model, error);
    code = code ? code : find_used(particles, model, error);
    code = code ? code : flow_welds_make(particles, model, error);
    code = code ? code : each_cloth(particles, model, cloth_particles, error);
    code = code ? code : flow_welds_settle(particles, model, error);
    code = code ? code : each_cloth(particles, model, cloth_forces, error);
    code = code ? code : flow_follow_make(particles, model, error);
    if (!code && particles->unused.n == particles->n)
        code = model_fail(model->n_cloths ? model->cloths[0].mesh_place : NULL, error,
                          "nothing to simulate: no face, edge or joint uses a vertex");
    if (code)
        flow_particles_free(particles);
    return code;
}

/* Takes out of a velocity what a slider forbids. */
static void constrain_velocity(const struct model_slider *slider, phys_vec *v)
{
    phys_vec filter = PHYS_VEC(slider->direction);
    filter[3] = slider->kind == MODEL_PLANE;
    solve_filter(&filter, v);
}

void flow_particle_of(const struct flow_particles *particles, const struct model *model,
                      const struct model_cloth *cloth, uint32_t first, uint32_t vertex,
                      struct flow_particle *particle)
{
    const uint32_t own = vertex - first;
    const struct model_material *material = model->materials + model_material_of(cloth, 1, &own);
    const bool moves = particles->free[vertex];
    particle->mass = particles->mass[vertex];
    particle->drag = particles->drag
                         ? particles->drag[vertex]
                         : material->damping_viscous + material->damping_mass * particle->mass;
    particle->free = moves ? 1 : 0;
    flow_start_place(particles, cloth, first, own, &particle->position);
    const double *velocity = particles->start ? particles->start[vertex] + 3 : cloth->velocity;
    particle->velocity = moves ? PHYS_VEC(velocity) : (phys_vec){0};
    if (particles->slider && particles->slider[vertex])
        constrain_velocity(model->sliders + particles->slider[vertex] - 1, &particle->velocity);
    particle->load = PHYS_VEC(model->gravity) * particle->mass;
    if (particles->load)
        particle->load = particles->load[vertex];
}

/* The release of the vertices of one cloth, the first of which is `first`. */
static double release(const struct flow_particles *p, const struct model *model,
                      const struct model_cloth *cloth, uint32_t first)
{
    struct flow_particle at;
    phys_vec centre = {0};
    double mass = 0, sum = 0;
    for (uint32_t v = first; v < first + cloth->mesh.n_vertices; v++) {
        if (!p->used[v])
            continue;
        flow_particle_of(p, model, cloth, first, v, &at);
        centre += at.mass * at.position;
        mass += at.mass;
    }
    if (!(mass > 0)) /* all are other names of welded vertices, which have it */
        return 0;
    for (uint32_t v = first; v < first + cloth->mesh.n_vertices; v++) {
        if (!p->used[v] || !p->free[v])
            continue;
        flow_particle_of(p, model, cloth, first, v, &at);
        const phys_vec away = at.position - centre / mass;
        sum += 2 * sqrt(phys_dot(&at.load, &at.load) * phys_dot(&away, &away));
    }
    return sum;
}

/* Rounding moves what is at rest by less, m/s, and nothing slower is seen. */
static const double ROUNDS = 1e-6;

double flow_source_release(const struct flow_source *source)
{
    const struct model *model = source->model;
    double sum = 0, mass = 0;
    for (uint32_t v = 0; v < source->particles.n; v++)
        mass += source->particles.mass[v];
    for (uint32_t c = 0; c < model->n_cloths; c++)
        sum += release(&source->particles, model, model->cloths + c, model_first(model, c));
    return fmax(sum, 0.5 * mass * ROUNDS * ROUNDS);
}

void flow_particles_free(struct flow_particles *particles)
{
    cloth_pool_free(&particles->memory);
    free(particles->attached);
    free(particles->varying.items);
    free(particles->soft.items);
    free(particles->joints.items);
    *particles = (struct flow_particles){0};
}
