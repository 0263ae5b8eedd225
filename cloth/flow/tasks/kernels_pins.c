/* Pins that move. Before a step their vertices get the velocity that brings them, in the step, to
 * where they are due: forces and the solve then see it as that of any other vertex, and a row that
 * is held keeps it (b - A z of Ascher & Boxerman 2003, with the change z made beforehand). After
 * the step they are put exactly there, so that nothing adds up. */
#include "cloth/flow/tasks/bodies.h"

#include "cloth/physics/motion.h"

#define ARGS sizeof(struct flow_args)

/* Where a moved vertex is at a time; the pose of the last motion asked for is kept. */
struct due {
    const struct model *model;
    double time;
    uint32_t motion; /* from 1; 0: none yet */
    struct phys_pose pose;
};

static void find(struct due *due, uint32_t motion, const phys_vec *start, phys_vec *x)
{
    const struct model_motion *m = due->model->motions + motion - 1;
    if (due->motion != motion)
        phys_pose_at(m->n, due->model->keys + m->first, m->about, due->time, &due->pose);
    due->motion = motion;
    phys_pose_point(&due->pose, start, x);
}

static int drive(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const double h = flow_args_of(call)->h;
    const phys_vec *x = duite_in(call, 1, phys_vec);
    phys_vec *v = duite_out(call, 2, phys_vec);
    struct due due = {.model = flow_of(call)->model, .time = flow_args_of(call)->time};
    for (uint32_t i = 0; i < t->n_moved; i++) {
        const uint32_t row = t->moved[i][0];
        phys_vec to;
        find(&due, t->moved[i][1], t->position + row, &to);
        v[row] = (to - x[row]) / h;
    }
    flow_write_rim(t, v, duite_out(call, 3, phys_vec));
    return 0;
}
FLOW_TIMED(drive, FLOW_VELOCITY)
const duite_kernel flow_drive = {.name = "drive",
                                 .body = drive_timed,
                                 .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_W},
                                 .args_size = ARGS};

static int place(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *x = duite_out(call, 1, phys_vec);
    struct due due = {.model = flow_of(call)->model, .time = flow_args_of(call)->time};
    for (uint32_t i = 0; i < t->n_moved; i++)
        find(&due, t->moved[i][1], t->position + t->moved[i][0], x + t->moved[i][0]);
    flow_write_rim(t, x, duite_out(call, 2, phys_vec));
    return 0;
}
FLOW_TIMED(place, FLOW_POSITION)
const duite_kernel flow_place = {.name = "place",
                                 .body = place_timed,
                                 .access = {DUITE_R, DUITE_RW, DUITE_W},
                                 .args_size = ARGS};

void flow_due_acceleration(const struct model *model, uint32_t motion, double time,
                           const phys_vec *start, phys_vec *a)
{
    const double h = model->h;
    phys_vec x[3];
    for (int i = 0; i < 3; i++) {
        struct due due = {.model = model, .time = time - i * h};
        find(&due, motion, start, x + i);
    }
    *a = (x[0] - 2 * x[1] + x[2]) / (h * h);
}

/* ---- The main program ---- */

static int fork_moved(struct flow_state *state, const duite_kernel *kernel, const long *objects)
{
    struct flow_args args = flow_attempt_args(state);
    int code = DUITE_OK;
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        if (!state->flow->tables.block[args.block].n_moved)
            continue;
        duite_object own[DUITE_MAX_ACCESS];
        size_t n = 0;
        for (; objects[n] >= 0; n++)
            own[n] =
                *(const duite_object *)(const void *)((const char *)(state->block + args.block) +
                                                      objects[n]);
        code = flow_fork(state, kernel, &args, n, own, FLOW_NO_RIM, FLOW_NO_RIM);
    }
    return code;
}

int flow_pins_drive(struct flow_state *state)
{
    return fork_moved(state, &flow_drive, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(rim_v)));
}

int flow_pins_place(struct flow_state *state)
{
    return fork_moved(state, &flow_place, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(rim_x)));
}
