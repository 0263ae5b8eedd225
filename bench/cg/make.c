/* Making a state: its motion, unless a state before it had the same one; the system of one step as
 * the cloth hands it over, of its whole length; the answers by plain loops. */
#include "bench/cg/cg.h"

#include "cloth/mesh/blocks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

/* The motions that ran. States may come in any order, so the end of each is kept: a few MB each. */
static struct end {
    const char *motion; /* NULL: this place is free */
    struct solve_system at;
} ended[STATES_MOTIONS];

static int take(void *context, const struct solve_system *system, struct cloth_error *error)
{
    struct solve_system *copy = context;
    solve_system_free(copy);
    const int code =
        solve_system_make(copy, system->n, system->n_pairs, SOLVE_PAIRS_OF_SPRINGS, error);
    const size_t n = system->n;
    if (code)
        return code;
    copy->h = system->h;
    memcpy(copy->mass, system->mass, n * sizeof(double));
    memcpy(copy->diagonal, system->diagonal, n * sizeof(double));
    memcpy(copy->free, system->free, n * sizeof(double));
    memcpy(copy->b, system->b, 3 * n * sizeof(double));
    memcpy(copy->x, system->x, 3 * n * sizeof(double));
    memcpy(copy->v, system->v, 3 * n * sizeof(double));
    memcpy(copy->end, system->end, system->n_pairs * sizeof *copy->end);
    memcpy(copy->value, system->value, system->n_pairs * sizeof *copy->value);
    return CLOTH_OK;
}

/* Where a motion ends. Its contacts are of no interest. */
static int take_end(void *context, const struct solve_system *system, struct cloth_error *error)
{
    struct solve_system *copy = context;
    const size_t bytes = 3 * (size_t)system->n * sizeof(double);
    solve_system_free(copy);
    const int code = solve_system_make(copy, system->n, 1, SOLVE_PAIRS_OF_SPRINGS, error);
    if (code)
        return code;
    memcpy(copy->x, system->x, bytes);
    memcpy(copy->v, system->v, bytes);
    return CLOTH_OK;
}

/* A place of its own, or a free one. */
static struct end *find_end(const char *motion)
{
    struct end *end = ended;
    while (end->motion && strcmp(end->motion, motion) != 0)
        end++;
    return end;
}

static int run_motion(struct states_plan *plan, struct serve_request *request, struct end *end)
{
    const struct flow_output output = {.context = &end->at, .system = take_end};
    const double steps = plan->motion.end / plan->motion.h;
    fprintf(stderr, "duite-bench: running the motion %s: %.0f steps\n", plan->moved, steps);
    int code = states_wave(&plan->motion);
    if (!code)
        code = cg_run(&plan->motion, request, &output, NULL, NULL);
    if (!code)
        end->motion = plan->moved;
    return code;
}

/* The model of the step starts where its motion ends. */
static int move(struct states_plan *plan, struct serve_request *request)
{
    if (!plan->moves)
        return states_wave(&plan->model);
    struct end *end = find_end(plan->moved);
    const int code = end->motion ? 0 : run_motion(plan, request, end);
    return code ? code : states_start(&plan->model, end->at.x, end->at.v);
}

int cg_make_system(struct states_plan *plan, struct serve_request *request,
                   struct solve_system *system)
{
    struct model *model = &plan->model;
    const struct flow_output output = {.context = system, .system = take};
    model->halving = false;
    model->contact.mode = MODEL_CONTACT_PROJECT;
    model->energy_growth = model->stretch_growth = model->stretch_limit = 0;
    const int code = cg_run(model, request, &output, NULL, NULL);
    if (!code && !(fabs(system->h - model->h) <= 1e-9 * model->h))
        return serve_fail("its system is of a step of %g ms, not of one whole step of %g ms",
                          1e3 * system->h, 1e3 * model->h);
    return code;
}

static void each_pair(const void *context, void (*visit)(void *to, uint32_t a, uint32_t b),
                      void *to)
{
    const struct solve_system *s = context;
    for (size_t i = 0; i < s->n_pairs; i++)
        visit(to, s->end[i][0], s->end[i][1]);
}

int cg_order(struct state *state, uint32_t grain)
{
    const struct solve_system *s = &state->system;
    const struct mesh_pairs pairs = {s, each_pair};
    struct mesh_blocks blocks = {0};
    struct cloth_error error = {0};
    unsigned char *used = calloc((size_t)s->n + 1, 1);
    state->order = calloc((size_t)s->n + 1, sizeof *state->order);
    for (uint32_t v = 0; used && v < s->n; v++)
        used[v] = s->mass[v] > 0;
    for (size_t i = 0; used && i < 2 * s->n_pairs; i++)
        used[s->end[i / 2][i % 2]] = 1;
    int code = used && state->order ? 0 : serve_no_memory();
    if (!code && mesh_blocks_cut(&blocks, s->n, used, &pairs, grain, &error))
        code = serve_fail("%s", error.text);
    uint32_t next = 0;
    for (; !code && next < blocks.n_places; next++)
        state->order[next] = blocks.vertex[next];
    for (uint32_t v = 0; !code && v < s->n; v++)
        if (!used[v])
            state->order[next++] = v;
    mesh_blocks_free(&blocks);
    free(used);
    return code;
}

uint64_t cg_hash(const struct solve_system *s)
{
    const size_t n = s->n * sizeof(double);
    const struct {
        const void *at;
        size_t bytes;
    } part[] = {{&s->n, sizeof s->n},
                {&s->h, sizeof s->h},
                {s->mass, n},
                {s->diagonal, n},
                {s->free, n},
                {s->b, 3 * n},
                {s->end, s->n_pairs * sizeof *s->end},
                {s->value, s->value ? s->n_pairs * sizeof *s->value : 0},
                {s->block, s->block ? s->n_pairs * sizeof *s->block : 0}};
    uint64_t hash = 0;
    for (size_t i = 0; i < sizeof part / sizeof *part; i++)
        hash = XXH64(part[i].at, part[i].bytes, hash);
    return hash;
}

/* x and v of the system become those that it was made at. */
static int complete(struct state *state, const struct states_plan *plan)
{
    struct solve_system *s = &state->system;
    const double *start = plan->model.cloths->start;
    for (size_t v = 0; v < s->n; v++) {
        memcpy(s->x + 3 * v, start + 6 * v, 3 * sizeof *start);
        memcpy(s->v + 3 * v, start + 6 * v + 3, 3 * sizeof *start);
    }
    state->hash = cg_hash(s);
    state->count = plan->count;
    state->after = calloc((size_t)s->n + 1, 3 * sizeof *state->after);
    int code = state->after ? cg_order(state, plan->model.grain) : serve_no_memory();
    if (!code && !plan->solved_here)
        code = state_iterate(s, state->count, state->after);
    if (!code && !plan->solved_here)
        code = state_solve(s, s->dv);
    return code;
}

int cg_make_state(void *context, struct serve_request *request, double *value)
{
    struct state state = {0};
    struct states_plan plan = {0};
    (void)context;
    serve_word(request, "state", state.name, sizeof state.name);
    int code = states_plan_make(&plan, state.name, serve_number(request, "quick") != 0);
    if (!code)
        code = move(&plan, request);
    if (!code)
        code = cg_make_system(&plan, request, &state.system);
    if (!code)
        code = complete(&state, &plan);
    if (!code)
        code = state_write(&state);
    *value = state.system.n;
    state_free(&state);
    states_plan_free(&plan);
    return code;
}

const struct serve_run cg_make_runs[] = {{"make", cg_make_state}, {0}};
