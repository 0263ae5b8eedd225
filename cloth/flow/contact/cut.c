/* Ways are changed where solving again does not help. First each pair that fails is pushed apart,
 * by the least that its certificate takes: that loses nothing but the approach, and no momentum
 * between cloths. A pair that still fails after some rounds is cut: each corner goes only as far as
 * divides the pair. The shortest way counts among several pairs, so their order does not matter. A
 * row that was moved gets the velocity of its way. The steps in a row that cut it are counted, but
 * for steps that are given up. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/cut_run.h"
#include "cloth/flow/run/step.h"

#include "cloth/contact/push.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A row counts as halved if it loses more than this part of its way, and that is more than this
 * part of the cloth's thickness: shorter losses do not show. */
static const double HALF = 0.5, COUNTS = 0.1;

struct cut_args {
    union {
        uint32_t block;
        struct flow_step_args step;
    };
    uint32_t attempt, accepted; /* as in struct flow_contact_state */
};

/* ---- Moving a row ---- */

struct moving {
    const struct flow_step_args *step;
    double counts_from; /* m: as halved */
    const phys_vec *from;
    phys_vec *x, *v;
    double *counts;
};

static struct moving moving_of(const duite_call *call, const struct cut_args *args,
                               const phys_vec *from, phys_vec *x, phys_vec *v, double *counts)
{
    const double own = flow_thickness_of(flow_of(call), args->block, args->block).least;
    return (struct moving){&args->step, COUNTS * own, from, x, v, counts};
}

/* Moves a row to where its way ends now. */
static void cut_move_row(const struct moving *m, uint32_t i, double mass, const phys_vec *to)
{
    const phys_vec way = m->x[i] - m->from[i], lost = m->x[i] - *to;
    const double loses = sqrt(phys_dot(&lost, &lost));
    const phys_vec before = m->v[i];
    m->x[i] = *to;
    m->v[i] = (1 / m->step->h) * (m->x[i] - m->from[i]);
    const phys_vec change = mass * (m->v[i] - before);
    m->counts[FLOW_CUT_ROWS]++;
    for (int c = 0; c < 3; c++)
        m->counts[FLOW_CUT_MOMENTUM + c] += change[c];
    m->counts[FLOW_CUT_HALVED] +=
        loses > HALF * sqrt(phys_dot(&way, &way)) && loses > m->counts_from;
}

/* ---- Pushes ---- */

FLOW_KERNEL(push, FLOW_COLLIDE, struct cut_args,
            (R(table), R(kept_x), RW(x), RW(v), W(halo_x), W(halo_v), SUM(cut_counts),
             REST_R(meetings)));

/* Finds the pushes that part a pair where the step ends, m, along the row's normal, as that is
 * where the step begins. They are 0 if none do. */
static void part_pair(const struct flow_near *near, double push[4])
{
    const struct flow_contact *contact = &near->contact;
    const bool turned = contact->kind == CONTACT_TV;
    struct contact_pushed pushed = {
        .n = 4, .first = contact->kind == CONTACT_EE ? 2 : 1, .gap = near->apart};
    double of[4] = {0};
    memcpy(push, near->along, sizeof near->along);
    if (contact->kind == FLOW_CONTACT_SHAPE)
        return;
    for (unsigned k = 0; k < 4; k++) { /* corners of a body have no rows, and are held */
        const unsigned from = (k + turned) % 4;
        pushed.along[from] = near->along[k];
        pushed.held |= (k < contact->at.n ? contact->at.held >> k & 1u : 1u) << from;
    }
    contact_push_apart(&pushed, of);
    for (unsigned k = 0; k < 4; k++)
        push[k] = (turned ? -1 : 1) * of[(k + turned) % 4];
}

/* Adds the push of a corner to that of its row. A row of several pairs goes as far along the normal
 * of each as that asks for. */
static void add_push(const struct flow_near *near, double by, phys_vec *push)
{
    const double sign = by < 0 ? -1 : 1;
    const phys_vec normal = sign * near->contact.row.normal;
    const double lacks = sign * by - phys_dot(push, &normal);
    *push += fmax(lacks, 0) * normal;
}

/* Adds the pushes of a pair to the rows of the block. */
static void cut_add_pair(const struct push_fields *on, const struct flow_near *near, phys_vec *push)
{
    const struct flow_tie_corners *corners = &near->contact.at;
    double by[4];
    part_pair(near, by);
    for (uint32_t k = 0; k < corners->n; k++)
        if (corners->block[k] == on->args->block && by[k] != 0)
            add_push(near, by[k], push + corners->row[k]);
}

static void find_pushes(const struct push_fields *on, phys_vec *push)
{
    for (size_t at = 0; at < on->n_meetings; at++) {
        const struct flow_list *list = on->meetings[at].data;
        const struct flow_near *near = (const struct flow_near *)(list + 1);
        for (uint64_t i = 0; i < list->n; i++)
            if (near[i].fails)
                cut_add_pair(on, near + i, push);
    }
}

static int push_body(const duite_call *call, const struct push_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct moving moving =
        moving_of(call, on->args, on->kept_x, on->x, on->v, on->cut_counts);
    phys_vec *push = aligned_alloc(sizeof *push, (table.n + 1) * sizeof *push);
    if (!push)
        return duite_fail(call, FLOW_NO_MEMORY, "out of memory for the pushes of a block");
    on->cut_counts[FLOW_CUT_STOP] += flow_stop_is_asked(flow_of(call));
    memset(push, 0, (table.n + 1) * sizeof *push);
    find_pushes(on, push);
    for (uint32_t i = 0; i < table.n; i++) {
        const phys_vec to = on->x[i] + push[i];
        if (phys_dot(push + i, push + i) > 0)
            cut_move_row(&moving, i, table.mass[i], &to);
    }
    flow_write_halo(&table, on->x, on->halo_x);
    flow_write_halo(&table, on->v, on->halo_v);
    free(push);
    return 0;
}

/* ---- Cuts ---- */

FLOW_KERNEL(cut, FLOW_COLLIDE, struct cut_args,
            (R(table), R(kept_x), RW(x), RW(v), RW(cut_runs), W(halo_x), W(halo_v), SUM(cut_counts),
             MAX(cut_longest), REST_R(meetings)));

/* Finds the part of its way that each row may go, by all failing pairs. */
static void contact_cut_find_parts(const struct cut_fields *on, double *part)
{
    const uint32_t block = on->args->block;
    for (size_t at = 0; at < on->n_meetings; at++) {
        const struct flow_list *list = on->meetings[at].data;
        const struct flow_near *near = (const struct flow_near *)(list + 1);
        for (uint64_t i = 0; i < list->n; i++)
            for (uint32_t k = 0; near[i].fails && k < near[i].contact.at.n; k++) {
                const struct flow_tie_corners *corners = &near[i].contact.at;
                if (corners->block[k] == block && !(near[i].part[k] >= part[corners->row[k]]))
                    part[corners->row[k]] = near[i].part[k];
            }
    }
}

static int cut_body(const duite_call *call, const struct cut_fields *on)
{
    const struct cut_args *args = on->args;
    const struct flow_table table = flow_table_in(call, on->table);
    struct flow_cut_run *runs = (struct flow_cut_run *)(void *)on->cut_runs;
    const struct moving moving = moving_of(call, args, on->kept_x, on->x, on->v, on->cut_counts);
    double *part = malloc((table.n + 1) * sizeof *part);
    if (!part)
        return duite_fail(call, FLOW_NO_MEMORY, "out of memory for the ways of a block");
    on->cut_counts[FLOW_CUT_STOP] += flow_stop_is_asked(flow_of(call));
    for (uint32_t i = 0; i < table.n; i++)
        part[i] = 1;
    contact_cut_find_parts(on, part);
    for (uint32_t i = 0; i < table.n; i++) {
        if (part[i] >= 1)
            continue;
        /* by the same sum as certificates use */
        const phys_vec to = on->kept_x[i] + fmax(part[i], 0) * (on->x[i] - on->kept_x[i]);
        cut_move_row(&moving, i, table.mass[i], &to);
        *on->cut_longest =
            fmax(*on->cut_longest, flow_cut_again(runs + i, args->attempt, args->accepted));
    }
    flow_write_halo(&table, on->x, on->halo_x);
    flow_write_halo(&table, on->v, on->halo_v);
    free(part);
    return 0;
}

/* ---- Forks ---- */

static int fork_cut(struct flow_state *state, const struct flow_kernel *kernel,
                    const struct cut_args *args)
{
    duite_object *rest = flow_contact_rest(state);
    const struct flow_with with = {.n = flow_contact_lists(state, args->block, rest), .rest = rest};
    return flow_fork_with(state, kernel, args, &with);
}

int flow_contact_cut(struct flow_state *state, bool push, struct flow_cut *cut)
{
    struct cut_args args = {.step = flow_attempt_args(state),
                            .attempt = state->contact.attempt,
                            .accepted = state->contact.accepted};
    double counts[FLOW_CUT_COUNTS] = {0}, longest = 0;
    int code = duite_set(state->rt, state->run.cut_counts, NULL);
    if (!code)
        code = duite_set(state->rt, state->run.cut_longest, NULL);
    for (args.block = 0; args.block < state->flow->tables.n_blocks && !code; args.block++)
        code = fork_cut(state, push ? &flow_kernel_push : &flow_kernel_cut, &args);
    if (!code)
        code = duite_get(state->rt, state->run.cut_counts, counts);
    const double *p = counts + FLOW_CUT_MOMENTUM;
    if (!code)
        code = duite_get(state->rt, state->run.cut_longest, &longest);
    *cut = (struct flow_cut){.rows = (uint64_t)counts[FLOW_CUT_ROWS],
                             .halved = (uint64_t)counts[FLOW_CUT_HALVED],
                             .run = (uint64_t)longest,
                             .stops = counts[FLOW_CUT_STOP] > 0,
                             .momentum = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])};
    return code;
}

int flow_contact_cut_none(struct flow_state *state)
{
    int code = DUITE_OK;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks && !code; b++)
        code = duite_set(state->rt, state->block[b].cut_runs, NULL);
    return code;
}
