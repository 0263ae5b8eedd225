/* The solution of a state, against which errors are: what the solver itself comes to, which plain
 * loops then check. The state's file keeps it unless there are contacts, which the system there
 * does not have. */
#include "bench/cg/cg.h"

#include "bench/tasks/tasks.h"
#include "cloth/flow/solver/solve.h"

#include <stdlib.h>
#include <string.h>

void cg_stop_by(struct cg_session *s, enum model_stop stop, double tolerance, uint32_t most)
{
    struct model *model[] = {&s->plan.model, s->flow ? &s->flow->received : NULL};
    for (int i = 0; i < 2 && model[i]; i++) {
        model[i]->stop = stop;
        model[i]->tolerance = tolerance;
        model[i]->max_iterations = most;
    }
}

int cg_answer(struct cg_session *s, double *dv)
{
    const struct flow *flow = s->flow;
    const uint32_t *vertex = flow->vertex ? flow->vertex : s->state.order;
    int code = 0;
    for (uint32_t b = 0; b < flow->tables.n_blocks && !code; b++) {
        const struct flow_table *t = flow->tables.block + b;
        code = tasks_code(duite_get(s->rt, s->run.block[b].dv, s->run.rows));
        for (uint32_t i = 0; i < t->n && !code; i++)
            memcpy(dv + 3 * (size_t)vertex[t->first + i], s->run.rows + 4 * (size_t)i,
                   3 * sizeof *dv);
    }
    return code;
}

double *cg_new_answer(const struct cg_session *s)
{
    double *dv = calloc((size_t)s->state.system.n + 1, 3 * sizeof *dv);
    if (!dv)
        serve_no_memory();
    return dv;
}

/* True if what the state has as its solution is that of its system. */
static bool is_solved(const struct state *state)
{
    return state_left(state, state->system.dv) < 1e-9;
}

static int solve_to(struct cg_session *s, double tolerance)
{
    enum { MOST = 20000 };
    cg_stop_by(s, MODEL_STOP_RELATIVE, tolerance, MOST);
    const int code = tasks_code(flow_cg(&s->run));
    return code ? code : cg_answer(s, s->solution);
}

/* The solver stops by the norm of its preconditioner, which says little of what is left of the
 * right side. It is asked for more digits only where they are needed: the last ones take a million
 * vertices minutes. */
static int solve_and_check(struct cg_session *s)
{
    int code = 0;
    for (double tolerance = 1e-8; !code && !is_solved(&s->state); tolerance *= 0.1) {
        if (tolerance < 1e-12)
            return serve_fail("the solution of %s is not found", s->state.name);
        code = solve_to(s, tolerance);
        memcpy(s->state.system.dv, s->solution,
               3 * (size_t)s->state.system.n * sizeof *s->solution);
    }
    return code;
}

int cg_find_solution(struct cg_session *s)
{
    const bool touches = model_promise(s->flow->model).apart;
    if (!touches && is_solved(&s->state))
        return 0;
    s->solution = cg_new_answer(s);
    if (!s->solution)
        return 1;
    if (touches)
        return solve_to(s, 1e-10);
    const int code = solve_and_check(s);
    return code || !s->flow->vertex ? code : state_write(&s->state);
}
