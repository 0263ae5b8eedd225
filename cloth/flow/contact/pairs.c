/* Finds the sides that are near each other. A meeting is two sides whose boxes over the step came
 * near at some time; its object is the list of their findings. Meetings stay while boxes are near
 * with something to spare, so that the set changes seldom. Every rank has the same meetings, since
 * all get the same boxes.
 *
 * In reading order: boxes of all blocks, meetings, the meetings of a block, their tasks. */
#include "cloth/flow/checkpoint/checkpoint.h"
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/contact/skin.h"
#include "cloth/flow/run/step.h"

#include "cloth/contact/solid.h"

#include <math.h>

/* Thicknesses: boxes still meet if they are this much farther apart than a contact reaches. That is
 * the way of some steps, so the set of meetings changes seldom; more of it costs queries that find
 * nothing. */
static const double SPARE = 20;
enum { LEAST_ROOM = 256 }; /* items of a list, which doubles where it is short */
/* Failing pairs a vertex that any of them is of: with more, cloth passes another one or many layers
 * in the step, and its contacts would be far more than the cloth there. A wrung sheet has 9.4, a
 * sheet pulled through a ring 5.2, two sheets that pass each other 11 to 18. */
enum { MOST_FAILING = 10 };

/* ---- Boxes ---- */

FLOW_KERNEL(root, FLOW_COLLIDE, struct flow_block_args, (R(skin_boxes), W(root)))
{
    (void)call;
    contact_boxes_root(on->skin_boxes, on->root, on->root + 3);
    on->root[FLOW_ROOT_MOVED] = contact_moved_n(on->skin_boxes);
    return 0;
}

/* On every rank; zeros for obstacles that are no bodies. */
FLOW_KERNEL_WITH(roots, FLOW_COLLIDE, struct flow_block_args,
                 (W(roots), IF_MADE(body_boxes), ALL(root)), .replicated = 1)
{
    const struct model *model = flow_of(call)->model;
    const uint32_t n_blocks = flow_of(call)->tables.n_blocks;
    double *obstacle = on->roots + FLOW_ROOT * (size_t)n_blocks;
    for (uint32_t b = 0; b < n_blocks; b++)
        memcpy(on->roots + FLOW_ROOT * (size_t)b, flow_numbers_of(on->root, b),
               FLOW_ROOT * sizeof *on->roots);
    memset(obstacle, 0, FLOW_ROOT * model->n_obstacles * sizeof *obstacle);
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        if (model->obstacles[i].body && on->body_boxes)
            contact_boxes_root(on->body_boxes + flow_body_place(model, i).boxes,
                               obstacle + FLOW_ROOT * i, obstacle + FLOW_ROOT * i + 3);
    return 0;
}

static int get_root_boxes(struct flow_state *state)
{
    struct flow_block_args args;
    int code = flow_bodies_follow(state);
    if (!code)
        code = flow_fork_each(state, &flow_kernel_root, &args);
    args.block = 0;
    if (!code)
        code = flow_fork_one(state, &flow_kernel_roots, &args);
    return code ? code : duite_get(state->rt, state->run.roots, state->contact.root);
}

/* True if two boxes are nearer than reach. */
static bool pairs_is_near(const double *a, const double *b, double reach)
{
    bool near = true;
    for (int c = 0; c < 3; c++)
        near = near && a[c] - b[c + 3] < reach && b[c] - a[c + 3] < reach;
    return near;
}

/* ---- Meetings ---- */

/* True if any cloth of block a meets the other side. */
static bool sides_meet(const struct flow_state *state, uint32_t a, uint32_t b)
{
    const struct flow *flow = state->flow;
    const uint32_t n_blocks = flow->tables.n_blocks, obstacle = flow->n_cloths + (b - n_blocks);
    const struct flow_skin_size *own = &flow->tables.block[a].skin;
    const struct flow_skin_size *other = b < n_blocks ? &flow->tables.block[b].skin : NULL;
    const uint32_t from = other ? other->cloth[0] : obstacle,
                   to = other ? other->cloth[1] : obstacle;
    bool meet = false;
    for (uint32_t c = own->cloth[0]; c <= own->cloth[1]; c++)
        for (uint32_t i = from; i <= to; i++)
            meet = meet || flow_sides_of(flow, c, i)->friction >= 0;
    return meet;
}

/* True if a block meets an obstacle by its own triangles and vertices: bodies may have skins
 * instead. */
static bool is_shape(const struct flow_state *state, uint32_t side)
{
    const struct model *model = state->flow->model;
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    return side >= n_blocks &&
           !(flow_contact_mode(model)->sweeps && model->obstacles[side - n_blocks].body);
}

/* Block a and any side: at some time of the step. reach, spare: thicknesses. */
static bool sides_are_near(const struct flow_state *state, uint32_t a, uint32_t b, double reach,
                           double spare)
{
    const double most = flow_thickness_of(state->flow, a, b).most;
    const double far = reach * most + spare * most;
    const double *root = state->contact.root, *own = root + FLOW_ROOT * (size_t)a;
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    const bool near =
        is_shape(state, b)
            ? !contact_solid_apart(state->contact.solid + (b - n_blocks), own, own + 3, far)
            : pairs_is_near(own, root + FLOW_ROOT * (size_t)b, far);
    return near && sides_meet(state, a, b);
}

static uint32_t pairs_count_sides(const struct flow_state *state)
{
    return state->flow->tables.n_blocks + state->flow->model->n_obstacles;
}

/* True if every two near sides have a meeting. */
static bool all_meet(const struct flow_state *state)
{
    const struct flow_meetings *meetings = &state->contact.meetings;
    const uint32_t n_blocks = state->flow->tables.n_blocks, n_sides = pairs_count_sides(state);
    const double reach = flow_contact_reach(state->flow->model);
    uint32_t at = 0;
    for (uint32_t a = 0; a < n_blocks; a++)
        for (uint32_t b = a; b < n_sides; b++) {
            const bool met = at < meetings->n && meetings->all[at].side[0] == a &&
                             meetings->all[at].side[1] == b;
            if (!met && sides_are_near(state, a, b, reach, 0))
                return false;
            at += met;
        }
    return true;
}

static uint32_t count_near(const struct flow_state *state, double reach)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks, n_sides = pairs_count_sides(state);
    uint32_t n = 0;
    for (uint32_t a = 0; a < n_blocks; a++)
        for (uint32_t b = a; b < n_sides; b++)
            n += sides_are_near(state, a, b, reach, SPARE);
    return n;
}

/* The counts of a group of meetings are one object, since each of its tasks opens the whole of it:
 * in one object of all, memory would grow with the square of their number. */
static void make_counts(struct flow_state *state)
{
    struct flow_meetings *meetings = &state->contact.meetings;
    for (uint32_t g = 0; g < flow_meeting_groups(meetings); g++)
        flow_noted(state, duite_new(state->rt, DUITE_F64, FLOW_COUNTS * FLOW_MEETING_GROUP,
                                    meetings->counts + g));
}

/* The object of a list lives with the first side where the sum of both is even, else with the
 * second: so neighbours share the work. */
static void pairs_make_list(struct flow_state *state, struct flow_meeting *meeting)
{
    const uint32_t *side = meeting->side;
    const bool second = (side[0] + side[1]) % 2 && side[1] < state->flow->tables.n_blocks;
    const uint32_t owner = side[second];
    duite_new_sized(state->rt, DUITE_BYTE, 0,
                    flow_list_bytes(meeting->room, sizeof(struct flow_near)), &meeting->near);
    duite_colocate(state->rt, meeting->near, state->block[owner].x);
}

static int make_meetings(struct flow_state *state)
{
    struct flow_meetings *meetings = &state->contact.meetings;
    const uint32_t n_blocks = state->flow->tables.n_blocks, n_sides = pairs_count_sides(state);
    const double reach = flow_contact_reach(state->flow->model);
    flow_contact_part(state);
    const int code = flow_contact_room(state, count_near(state, reach));
    if (code)
        return code;
    for (uint32_t a = 0; a < n_blocks; a++)
        for (uint32_t b = a; b < n_sides; b++) {
            if (!sides_are_near(state, a, b, reach, SPARE))
                continue;
            struct flow_meeting *meeting = meetings->all + meetings->n++;
            *meeting = (struct flow_meeting){.side = {a, b}, .room = LEAST_ROOM};
            pairs_make_list(state, meeting);
        }
    make_counts(state);
    return DUITE_OK;
}

int flow_contact_meet_again(struct flow_state *state, uint32_t n,
                            const struct flow_saved_side *side)
{
    struct flow_meetings *meetings = &state->contact.meetings;
    const int code = flow_contact_room(state, n);
    if (code)
        return code;
    for (uint32_t i = 0; i < n; i++) {
        struct flow_meeting *meeting = meetings->all + meetings->n++;
        *meeting =
            (struct flow_meeting){.side = {side[i].side[0], side[i].side[1]}, .room = side[i].room};
        pairs_make_list(state, meeting);
    }
    make_counts(state);
    return DUITE_OK;
}

/* ---- The meetings of a block ---- */

/* True if a block may have a corner of a side's contacts: it is the side or its neighbour. */
static bool pairs_has_corners(const struct flow_state *state, uint32_t block, uint32_t side)
{
    if (side >= state->flow->tables.n_blocks)
        return false;
    const struct flow_table *t = state->flow->tables.block + side;
    bool has = side == block;
    for (uint32_t s = 0; s < t->n_neighbours; s++)
        has = has || t->neighbour[s] == block;
    return has;
}

static bool concerns_block(const struct flow_state *state, const struct flow_meeting *meeting,
                           uint32_t block)
{
    return pairs_has_corners(state, block, meeting->side[0]) ||
           pairs_has_corners(state, block, meeting->side[1]);
}

uint32_t flow_contact_lists(const struct flow_state *state, uint32_t block, duite_object *to)
{
    const struct flow_meetings *meetings = &state->contact.meetings;
    uint32_t n = 0;
    for (uint32_t i = 0; i < meetings->n; i++)
        if (concerns_block(state, meetings->all + i, block))
            to[n++] = meetings->all[i].near;
    return n;
}

void flow_contact_keepers(const struct flow_state *state, uint32_t block, unsigned char *keeps)
{
    const struct flow_meetings *meetings = &state->contact.meetings;
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    memset(keeps, 0, n_blocks);
    for (uint32_t i = 0; i < meetings->n; i++)
        for (int k = 0; k < 2 && concerns_block(state, meetings->all + i, block); k++)
            if (meetings->all[i].side[k] < n_blocks)
                keeps[meetings->all[i].side[k]] = 1;
}

/* ---- Their tasks ---- */

static int fork_meeting(struct flow_state *state, uint32_t number)
{
    const struct flow_meeting *meeting = state->contact.meetings.all + number;
    const uint32_t *side = meeting->side, n_blocks = state->flow->tables.n_blocks;
    const struct flow_step_args step = flow_attempt_args(state);
    const struct flow_meet_args args = {.side = {side[0], side[1]},
                                        .number = number,
                                        .room = meeting->room,
                                        .again = meeting->looks == FLOW_LOOKS_AGAIN,
                                        .from = step.time - step.h,
                                        .to = step.time};
    const struct flow_objects *other = state->block + (side[1] < n_blocks ? side[1] : 0);
    const struct flow_with with = {.near = meeting->near,
                                   .meeting_counts =
                                       state->contact.meetings.counts[number / FLOW_MEETING_GROUP],
                                   .other_skin = other->skin,
                                   .other_x = other->skin_x,
                                   .other_boxes = other->skin_boxes};
    const struct flow_kernel *kernel = &flow_kernel_meet;
    if (side[0] == side[1])
        kernel = &flow_kernel_meet_self;
    else if (is_shape(state, side[1]))
        kernel = &flow_kernel_meet_shape;
    else if (side[1] >= n_blocks)
        kernel = &flow_kernel_meet_figure;
    return flow_fork_with(state, kernel, &args, &with);
}

/* Chooses the meetings of a round. again: those with a side that moved are looked at again. */
static void choose_meetings(struct flow_state *state, bool again)
{
    struct flow_meetings *meetings = &state->contact.meetings;
    for (uint32_t i = 0; i < meetings->n; i++) {
        struct flow_meeting *meeting = meetings->all + i;
        bool moved = false;
        for (int k = 0; k < 2; k++)
            moved = moved ||
                    state->contact.root[FLOW_ROOT * (size_t)meeting->side[k] + FLOW_ROOT_MOVED] > 0;
        meeting->looks = !again ? FLOW_LOOKS : moved ? FLOW_LOOKS_AGAIN : FLOW_LOOKS_NOT;
    }
}

/* Forks the meetings of a round and gets their counts. */
static int fork_meetings(struct flow_state *state, struct flow_seen *seen)
{
    struct flow_meetings *meetings = &state->contact.meetings;
    const uint32_t n_groups = flow_meeting_groups(meetings);
    int code = DUITE_OK;
    for (uint32_t g = 0; g < n_groups && !code; g++)
        code = duite_set(state->rt, meetings->counts[g], NULL);
    for (uint32_t i = 0; i < meetings->n && !code; i++)
        if (meetings->all[i].looks != FLOW_LOOKS_NOT)
            code = fork_meeting(state, i);
    for (uint32_t g = 0; g < n_groups && !code; g++)
        code = duite_get(state->rt, meetings->counts[g],
                         meetings->counted + (size_t)g * FLOW_COUNTS * FLOW_MEETING_GROUP);
    for (uint32_t i = 0; i < meetings->n && !code; i++) {
        const double *counted = meetings->counted + FLOW_COUNTS * (size_t)i;
        if (meetings->all[i].looks == FLOW_LOOKS_NOT)
            continue;
        memcpy(meetings->count + FLOW_COUNTS * (size_t)i, counted, FLOW_COUNTS * sizeof *counted);
        seen->passes += (uint64_t)counted[FLOW_COUNT_PASSES];
        seen->queries++;
    }
    return code;
}

/* Makes full lists again with room for all their items: the meetings of the next round. Returns
 * true if any was full. */
static bool make_longer(struct flow_state *state)
{
    struct flow_meetings *meetings = &state->contact.meetings;
    bool any = false;
    for (uint32_t i = 0; i < meetings->n; i++) {
        struct flow_meeting *meeting = meetings->all + i;
        const uint32_t found = (uint32_t)meetings->count[FLOW_COUNTS * (size_t)i + FLOW_COUNT_ALL];
        meeting->looks = FLOW_LOOKS_NOT;
        if (found <= meeting->room)
            continue;
        meeting->looks = FLOW_LOOKS;
        while (meeting->room < found)
            meeting->room *= 2;
        duite_free(state->rt, meeting->near);
        pairs_make_list(state, meeting);
        any = true;
    }
    return any;
}

/* Adds a meeting's contacts of a side to those of its block. */
static void pairs_add_found(struct flow_state *state, uint32_t side, double n, double fails)
{
    if (!(n > 0))
        return;
    state->contact.found[side] += (uint32_t)n;
    state->contact.failing[side] += (uint32_t)(fails < n ? fails : n);
}

/* Sums the counts of all meetings, and how many contacts each block is to keep. */
static void pairs_sum_up(struct flow_state *state, struct flow_seen *seen)
{
    const struct flow_meetings *meetings = &state->contact.meetings;
    const size_t bytes = state->flow->tables.n_blocks * sizeof(uint32_t);
    memset(state->contact.found, 0, bytes);
    memset(state->contact.failing, 0, bytes);
    for (uint32_t i = 0; i < meetings->n; i++) {
        const double *count = meetings->count + FLOW_COUNTS * (size_t)i;
        const double fails = count[FLOW_COUNT_FAILS];
        seen->fails += (uint64_t)fails;
        seen->contacts += (uint64_t)count[FLOW_COUNT_ALL];
        pairs_add_found(state, meetings->all[i].side[0], count[FLOW_COUNT_FIRST], fails);
        pairs_add_found(state, meetings->all[i].side[1], count[FLOW_COUNT_SECOND], fails);
    }
}

/* The vertices of a block, or of a body; of other obstacles 0. */
static uint32_t pairs_count_vertices(const struct flow_state *state, uint32_t side)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    const struct model *model = state->flow->model;
    if (side < n_blocks)
        return state->flow->tables.block[side].skin.n_vertices;
    const struct contact_body *body =
        contact_bodies_at(&model->bodies, model->obstacles[side - n_blocks].body);
    return body ? body->n_vertices : 0;
}

/* True if more pairs fail than their vertices can hold; those of a body count, too, since one that
 * is finer than the cloth on it has many pairs a vertex of the cloth. A vertex that fails in
 * several meetings counts in each, so all vertices of the sides bound how many there are. */
static bool pairs_is_hopeless(const struct flow_state *state)
{
    const struct flow_meetings *meetings = &state->contact.meetings;
    const uint32_t n_sides = pairs_count_sides(state);
    unsigned char *fails = state->contact.mark;
    double n_fails = 0, n_failing = 0, n_vertices = 0;
    memset(fails, 0, n_sides);
    for (uint32_t i = 0; i < meetings->n; i++) {
        const double *count = meetings->count + FLOW_COUNTS * (size_t)i;
        n_fails += count[FLOW_COUNT_FAILS];
        n_failing += count[FLOW_COUNT_FAILING];
        for (int k = 0; k < 2 && count[FLOW_COUNT_FAILS] > 0; k++)
            fails[meetings->all[i].side[k]] = 1;
    }
    for (uint32_t side = 0; side < n_sides; side++)
        n_vertices += fails[side] ? pairs_count_vertices(state, side) : 0;
    return n_fails > MOST_FAILING * fmin(n_failing, n_vertices);
}

/* Places the shapes over the step. */
static void place_shapes(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const struct flow_step_args step = flow_attempt_args(state);
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        struct contact_pose pose;
        if (!is_shape(state, state->flow->tables.n_blocks + i))
            continue;
        contact_pose_over(model->obstacles + i, model->keys, &model->bodies, step.time - step.h,
                          step.time, &pose);
        contact_solid_make(model->obstacles + i, &pose, state->contact.solid + i);
    }
}

int flow_contact_look(struct flow_state *state, bool again, bool shorter, struct flow_seen *seen)
{
    bool met = state->contact.meetings.all != NULL;
    int code = flow_contact_mode(state->flow->model)->sweeps ? flow_skins_refit(state, again)
                                                             : flow_skins_place(state);
    *seen = (struct flow_seen){0};
    if (!code)
        code = get_root_boxes(state);
    place_shapes(state);
    met = met && !code && all_meet(state);
    if (!code && !met)
        code = make_meetings(state);
    choose_meetings(state, again && met);
    do {
        code = code ? code : fork_meetings(state, seen);
        seen->hopeless = !code && shorter && pairs_is_hopeless(state);
    } while (!code && !seen->hopeless && make_longer(state));
    pairs_sum_up(state, seen);
    return code;
}
