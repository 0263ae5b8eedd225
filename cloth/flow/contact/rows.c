/* Contacts become ties of the blocks that have their corners (cloth/flow/joints/ties.h). Each of
 * these blocks computes a whole contact from its own rows and the rows that others show, as with
 * elements. A block finds its contacts in the lists of blocks that may keep one. First its record
 * gives their number and the blocks that share them. It makes its table when all ranks know the
 * records and have made room.
 *
 * In reading order: finding them, the record of a block, its table, their part of a system. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"

#include <stdlib.h>

/* ---- Finding them ---- */

/* The contacts of lists that have a corner in a block, in the order of the lists. */
struct found_contacts {
    size_t n;
    const struct flow_contact **contact;
    const struct flow_tie_corners **corners;
};

/* Finds them in n_lists lists. Returns false without memory. */
static bool find_contacts(size_t n_lists, const duite_param *lists, uint32_t n_blocks,
                          uint32_t block, struct found_contacts *to)
{
    size_t n = 0, all = 0;
    for (size_t i = 0; i < n_lists; i++, all += n)
        flow_contact_of(lists[i].data, block, n_blocks, &n);
    *to = (struct found_contacts){.contact = malloc((all + 1) * sizeof *to->contact),
                                  .corners = malloc((all + 1) * sizeof *to->corners)};
    if (!to->contact || !to->corners)
        return false;
    for (size_t i = 0; i < n_lists; i++) {
        const struct flow_list *list = lists[i].data;
        const struct flow_contact *contact = (const struct flow_contact *)(list + 1);
        const uint32_t *place = flow_contact_of(list, block, n_blocks, &n);
        for (size_t k = 0; k < n; k++) {
            to->contact[to->n] = contact + place[k];
            to->corners[to->n++] = &contact[place[k]].at;
        }
    }
    return true;
}

static void forget_contacts(struct found_contacts *found)
{
    free(found->contact);
    free(found->corners);
}

static int rows_no_memory(const duite_call *call)
{
    return duite_fail(call, FLOW_NO_MEMORY, "out of memory for the contacts of a block");
}

/* All ties of a block: the joints of the step, then its contacts. */
static struct flow_tie_list ties_of(const struct flow *flow, const struct flow_step_args *step,
                                    const struct found_contacts *found)
{
    return (struct flow_tie_list){.n_joints = flow->n_ties,
                                  .n = (uint32_t)found->n,
                                  .joint = flow->tie,
                                  .tick = (uint64_t)step->begin,
                                  .corners = found->corners};
}

struct row_args {
    union {
        uint32_t block;
        struct flow_step_args step;
    };
    struct flow_tie_room room; /* of its table */
};

/* ---- The record of a block ---- */

FLOW_KERNEL(tie_count, FLOW_COLLIDE, struct row_args, (W(tie_record), KEEPERS(contacts)))
{
    const struct row_args *args = on->args;
    const struct flow *flow = flow_of(call);
    const uint32_t max_links = flow->tables.n_blocks;
    struct flow_tie_record *record = (struct flow_tie_record *)(void *)on->tie_record;
    struct flow_tie_link *link = (struct flow_tie_link *)(record + 1);
    struct found_contacts found;
    uint64_t *scratch = NULL;
    int code = find_contacts(on->n_contacts, on->contacts, max_links, args->block, &found)
                   ? 0
                   : rows_no_memory(call);
    const struct flow_tie_list list = ties_of(flow, &args->step, &found);
    if (!code)
        scratch = malloc((flow_ties_scratch(list.n_joints + found.n) + 1) * sizeof *scratch);
    if (!code && !scratch)
        code = rows_no_memory(call);
    if (!code) /* links fit: there is room for all blocks */
        flow_ties_count(&list, args->block, scratch, max_links, record, link);
    free(scratch);
    forget_contacts(&found);
    return code ? code
                : duite_resize(call, FLOW_INDEX_OF(tie_count, tie_record),
                               sizeof *record + record->n_links * sizeof *link);
}

/* Joins the records of all blocks, on every rank. */
FLOW_KERNEL_WITH(tie_say, FLOW_COLLIDE, struct flow_block_args, (W(tie_said), ALL(tie_record)),
                 .replicated = 1)
{
    const uint32_t n_blocks = flow_of(call)->tables.n_blocks;
    size_t bytes = 0;
    for (uint32_t b = 0; b < n_blocks; b++) {
        memcpy(on->tie_said + bytes, on->tie_record[b].data, on->tie_record[b].count);
        bytes += on->tie_record[b].count;
    }
    return duite_resize(call, FLOW_INDEX_OF(tie_say, tie_said), bytes);
}

/* Takes it apart for flow_ties_adopt. */
static void hear_records(struct flow_state *state)
{
    struct flow_tie_records *said = &state->tied.said;
    const unsigned char *from = state->contact.said;
    uint32_t n = 0;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++) {
        said->first[b] = n;
        memcpy(said->of + b, from, sizeof said->of[b]);
        from += sizeof said->of[b];
        memcpy(said->link + n, from, said->of[b].n_links * sizeof *said->link);
        from += said->of[b].n_links * sizeof *said->link;
        n += said->of[b].n_links;
    }
    said->first[state->flow->tables.n_blocks] = n;
}

static int say_records(struct flow_state *state, struct row_args *args)
{
    const struct flow_block_args all = {0};
    int code = flow_fork_each(state, &flow_kernel_tie_count, args);
    if (!code)
        code = flow_fork_one(state, &flow_kernel_tie_say, &all);
    if (!code)
        code = duite_get(state->rt, state->run.tie_said, state->contact.said);
    if (!code)
        hear_records(state);
    return code;
}

/* ---- Its table ---- */

/* Writes every byte, also of unused rows. */
static void write_rows(const struct flow *flow, const struct flow_step_args *step,
                       const struct found_contacts *found, const struct flow_ties *ties,
                       struct contact_row *row, uint32_t *obstacle)
{
    const size_t room = ties->room.ties ? ties->room.ties : 1;
    const struct flow_contact_mode *mode = flow_contact_mode(flow->model);
    memset(row, 0, room * sizeof *row);
    memset(obstacle, 0, room * sizeof *obstacle);
    for (uint32_t i = 0; i < ties->n; i++) {
        if (ties->of[i] < flow->n_ties)
            continue;
        const struct flow_contact *contact = found->contact[ties->of[i] - flow->n_ties];
        if (contact->side[1] >= flow->tables.n_blocks)
            obstacle[i] = 1 + contact->side[1] - flow->tables.n_blocks;
        row[i] = contact->row;
        if (mode->row)
            mode->row(flow, step, contact, row + i);
    }
}

FLOW_KERNEL(tie_contacts, FLOW_COLLIDE, struct row_args,
            (R(table), R(tie_links), W(tie_table), W(contact_rows), W(contact_obstacles),
             KEEPERS(contacts)))
{
    const struct row_args *args = on->args;
    const struct flow *flow = flow_of(call);
    const struct flow_table table = flow_table_in(call, on->table);
    const uint32_t(*links)[2] = (const uint32_t(*)[2])on->tie_links;
    struct found_contacts found;
    int code =
        find_contacts(on->n_contacts, on->contacts, flow->tables.n_blocks, args->block, &found)
            ? 0
            : rows_no_memory(call);
    const struct flow_tie_list list = ties_of(flow, &args->step, &found);
    const struct flow_ties_of of = {.block = args->block,
                                    .n_rows = table.n,
                                    .n_halo = table.n_halo,
                                    .n_others = links[0][0],
                                    .halo = table.halo,
                                    .others = links + 1,
                                    .list = &list,
                                    .room = args->room};
    if (!code && !flow_ties_make(&of, on->tie_table))
        code = duite_fail(call, FLOW_NO_MEMORY, "block %u has no room for its ties", of.block);
    if (!code) {
        const struct flow_ties ties = flow_ties_open(on->tie_table);
        write_rows(flow, &args->step, &found, &ties, on->contact_rows, on->contact_obstacles);
    }
    forget_contacts(&found);
    return code;
}

int flow_contact_tie(struct flow_state *state)
{
    struct row_args args;
    memset(&args, 0, sizeof args);
    args.step = flow_attempt_args(state);
    int code = say_records(state, &args);
    if (!code)
        code = flow_ties_adopt(state);
    if (!code)
        code = flow_ties_group(state);
    for (args.block = 0; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        args.room = state->tied.now.room[args.block];
        code = flow_fork_one(state, &flow_kernel_tie_contacts, &args);
    }
    return code;
}

/* ---- Their part of a system ---- */

/* The point of a contact (cloth/contact/row.h) after corners have moved for `ahead` seconds at
 * their velocities. */
static void rows_find_point(const struct flow_ties *ties, const struct flow_view *view,
                            double ahead, uint32_t i, phys_vec *point)
{
    *point = (phys_vec){0};
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const uint32_t corner = ties->corner[i][k];
        phys_vec x = *flow_tie_x(ties, view, corner);
        if (ahead > 0)
            x += ahead * *flow_tie_v(ties, view, corner);
        *point += ties->weight[i][k] * x;
    }
}

/* Adds a force on the point, times `scale`, to the rows that are here. */
static void spread_force(const struct flow_ties *ties, uint32_t i, double scale,
                         const phys_vec *force, phys_vec *y)
{
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
        if (ties->corner[i][k] < ties->n_rows)
            y[ties->corner[i][k]] += scale * ties->weight[i][k] * *force;
}

void flow_contact_speed(const struct flow_ties *ties, const struct flow_view *view, uint32_t i,
                        phys_vec *speed)
{
    *speed = (phys_vec){0};
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
        *speed += ties->weight[i][k] * *flow_tie_v(ties, view, ties->corner[i][k]);
}

/* The law of a run's contacts in a step of h. */
struct law {
    const struct flow_contact_mode *mode;
    struct contact_spring spring;
    double h;
};

static struct law law_of(const struct flow *flow, double h)
{
    const struct flow_contact_mode *mode = flow_contact_mode(flow->model);
    struct law law = {.mode = mode, .h = h};
    if (mode->spring)
        law.spring = mode->spring(flow, h);
    return law;
}

/* ahead: s, for which corners move on at their velocities. left: part of the step's time. */
static void press_contact(const struct law *law, const struct flow_ties *ties,
                          const struct flow_view *view, double ahead, double left, uint32_t i,
                          struct flow_pressed *to)
{
    phys_vec point;
    rows_find_point(ties, view, ahead, i, &point);
    law->mode->press(&law->spring, ties, view, law->h, left, i, &point, to);
}

void flow_contact_force(const struct flow *flow, const struct flow_view *view,
                        const struct flow_step_args *step, phys_vec *f)
{
    const double left = step->h > 0 ? (step->time - step->now) / step->h : 0;
    const struct law law = law_of(flow, step->h);
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    for (uint32_t i = 0; i < ties.n; i++) {
        struct flow_pressed pressed;
        if (ties.of[i] < flow->n_ties)
            continue;
        press_contact(&law, &ties, view, 0, left, i, &pressed);
        spread_force(&ties, i, 1, &pressed.force, f);
    }
}

void flow_contact_solved(const struct flow *flow, const struct flow_view *view,
                         const uint32_t *obstacle, const phys_vec *value, phys_vec *f,
                         phys_vec *by_obstacle)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    for (uint32_t i = 0; i < ties.n; i++) {
        phys_vec point, force;
        if (ties.of[i] < flow->n_ties)
            continue;
        rows_find_point(&ties, view, 0, i, &point);
        contact_row_force(view->contact_rows + i, &point, value + i, &force);
        spread_force(&ties, i, 1, &force, f);
        for (int k = 0; k < SOLVE_TIE_CORNERS && obstacle[i]; k++)
            if (ties.corner[i][k] < ties.n_rows)
                by_obstacle[obstacle[i] - 1] += ties.weight[i][k] * force;
    }
}

/* For a right side that has the forces already: adds their loss while the step moves. */
static void resist_motion(const struct flow_ties *ties, const struct flow_view *view, double h,
                          uint32_t i, const phys_vec *value, phys_vec *b)
{
    const phys_vec three = {1, 1, 1, 0};
    phys_vec speed, lost;
    flow_contact_speed(ties, view, i, &speed);
    solve_spring_times(value, &speed, &lost);
    lost *= three;
    spread_force(ties, i, -h * h, &lost, b);
}

void flow_contact_system(const struct flow *flow, const struct flow_view *view, double h,
                         double push, phys_vec *b, phys_vec *value)
{
    const struct law law = law_of(flow, h);
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    for (uint32_t i = 0; i < ties.n; i++) {
        struct flow_pressed pressed;
        if (ties.of[i] < flow->n_ties)
            continue;
        press_contact(&law, &ties, view, b ? push : 0, 0, i, &pressed);
        if (b && push > 0)
            spread_force(&ties, i, h, &pressed.force, b);
        else if (b)
            resist_motion(&ties, view, h, i, &pressed.against, b);
        value[i] = pressed.value * (phys_vec){h, h, h, h * h}; /* h^2 N: of w w' each w takes h */
    }
}
