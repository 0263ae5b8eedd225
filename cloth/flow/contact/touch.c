/* The contacts of a block: those whose first feature belongs to its skin. They are state: each step
 * hands load and slip over to the pair of features that follows. A list is sorted by its keys, so
 * that it does not depend on the order of finding. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/step.h"

#include "cloth/base/order.h"

#include <float.h>
#include <stdlib.h>

/* Part of the thickness: a place that is farther by less is as near. */
static const double HARDLY = 0.05;
/* Contacts push much the same way if their normals have at least this cosine: 45 degrees. */
static const double SAME_WAY = 0.7;
/* A run begins with contacts that may rise by a tenth of the thickness d: k (d / 10)^2 / 2 in k
 * d^2.
 */
static const double FIRST_ENERGY = 0.005;

struct touch_args {
    uint32_t block, room;
    uint32_t accept; /* not zero: the step is over, near pairs become contacts; else the present
                      * ones stay, pressed, with failing pairs */
    double stiffness, part; /* as contact_row_begin has them */
    double from, to;        /* s: of the step */
    size_t n_others;        /* lists of other blocks' contacts */
};

/* The present contacts, the next ones, the energy of these; each meeting's list and, with another
 * block, its points; contacts of other blocks that may share corners with these. */
FLOW_KERNEL(touch, FLOW_COLLIDE, struct touch_args,
            (R(contacts), W(contacts_next), R(skin_x), SUM(contact_energy), SUM(status),
             REST_R(meetings)));

/* State of the body. */
struct touching {
    const duite_call *call;
    const struct touch_fields *on;
    const struct touch_args *args;
    size_t n_meetings; /* their lists and points */
    bool carries;      /* as the mode does (mode.h) */
    const struct flow_contact *before;
    size_t n_before;
    struct flow_contact *after;
    size_t n;
    unsigned char *used; /* n_before, then n: those before that live on; those after that have a
                          * multiplier of their own */
    double lent;         /* J: to those before */
    double pinched;      /* those before that begin to follow the law of compression */
};

/* ---- Order ---- */

/* Order by the first side, then by the second. */
static int compare_first(const struct flow_contact *a, const struct flow_contact *b)
{
    const int kind = cloth_compare_u32(a->kind, b->kind);
    return kind ? kind : cloth_compare_u32(a->feature[0], b->feature[0]);
}

static int compare_contacts(const void *left, const void *right)
{
    const struct flow_contact *a = left, *b = right;
    const int first = compare_first(a, b);
    const int side = cloth_compare_u32(a->side[1], b->side[1]);
    if (first)
        return first;
    return side ? side : cloth_compare_u32(a->feature[1], b->feature[1]);
}

/* The first contact of a list that is not before this one. */
static size_t lower_bound(const struct flow_contact *list, size_t n,
                          const struct flow_contact *contact)
{
    size_t low = 0, high = n;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_contacts(list + middle, contact) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* ---- Where its corners are ---- */

/* The points of a side at the end of the step. */
static const phys_vec *ends_in(const duite_param *points)
{
    const size_t n = points->count / 8; /* begin and end of each, four numbers */
    return (const phys_vec *)points->data + n;
}
static const phys_vec *own_ends(const struct touching *t)
{
    return ends_in(t->call->param + FLOW_INDEX_OF(touch, skin_x));
}

/* True if a meeting is of two blocks: the other one's points follow its list. */
static bool is_between_blocks(const duite_call *call, const struct flow_list *list)
{
    return list->side[0] != list->side[1] && list->side[1] < flow_of(call)->tables.n_blocks;
}

/* The points of the block that a contact meets, or of its own. */
static const phys_vec *ends_of(const struct touching *t, uint32_t side)
{
    const struct touch_fields *on = t->on;
    if (side == t->args->block)
        return own_ends(t);
    for (size_t at = 0; at < t->n_meetings; at++) {
        const struct flow_list *list = on->meetings[at].data;
        const bool points = is_between_blocks(t->call, list);
        if (points && (list->side[0] == side || list->side[1] == side))
            return ends_in(on->meetings + at + 1);
        at += points;
    }
    return NULL;
}

/* Finds the point of a contact (cloth/contact/row.h) at the step's end. Returns false if the two
 * blocks have parted: they have no meeting any more. */
static bool touch_find_point(const struct touching *t, const struct flow_contact *contact,
                             phys_vec *point)
{
    const phys_vec *y[2] = {own_ends(t), NULL};
    *point = (phys_vec){0};
    if (contact->first < contact->at.n && !(y[1] = ends_of(t, contact->side[1])))
        return false;
    for (uint32_t k = 0; k < contact->at.n; k++)
        *point += contact->at.weight[k] * y[k >= contact->first][contact->point[k]];
    return true;
}

/* The row of a contact as the solve of the step had it. */
static void find_solved_row(const struct touching *t, const struct flow_contact *contact,
                            struct contact_row *row)
{
    *row = contact->row;
    contact_row_begin(row, t->args->stiffness, t->args->part);
    flow_contact_ahead(flow_of(t->call), t->args->from, t->args->to, contact, row);
}

/* ---- To be solved once more ---- */

static void press_again(const struct touching *t, struct flow_contact *contact)
{
    struct contact_row row;
    phys_vec point;
    find_solved_row(t, contact, &row);
    if (!touch_find_point(t, contact, &point))
        return;
    contact_row_press(&row, &point);
    contact->row.load = row.load;
    contact->row.pushed = row.pushed;
}

/* The contact of before that is this one; n_before: there is none. */
static size_t find_before(const struct touching *t, const struct flow_contact *contact)
{
    const size_t at = lower_bound(t->before, t->n_before, contact);
    return at < t->n_before && !compare_contacts(t->before + at, contact) ? at : t->n_before;
}

/* Contacts that fail although they are there are marked. */
static void add_failing(struct touching *t, const struct flow_near *near)
{
    const size_t at = find_before(t, &near->contact);
    if (!near->fails)
        return;
    if (at < t->n_before)
        t->used[at] = 1;
    else if (near->presses)
        t->after[t->n++] = near->contact;
}

static void end_again(struct touching *t)
{
    for (size_t i = 0; i < t->n_before; i++) {
        struct flow_contact *contact = t->after + t->n++;
        *contact = t->before[i];
        if (t->used[i])
            contact_row_stiffen(&contact->row);
        press_again(t, contact);
    }
    qsort(t->after, t->n, sizeof *t->after, compare_contacts);
}

/* ---- The end of a step ---- */

static void take_near(struct touching *t, const struct flow_near *near)
{
    if (!near->fails)
        t->after[t->n++] = near->contact;
}

/* Carries load and slip to the successor. */
static void touch_hand_over(struct touching *t, size_t from, size_t to)
{
    const struct flow_contact *before = t->before + from;
    struct contact_row row, *after = &t->after[to].row;
    phys_vec point;
    if (!touch_find_point(t, before, &point))
        return;
    find_solved_row(t, before, &row);
    contact_row_end(&row, &point, after);
    t->lent += contact_row_lent(&row, &point, before->row.energy, after->energy);
    t->pinched += after->held >= CONTACT_ROW_FOLLOWS && !(row.held >= CONTACT_ROW_FOLLOWS);
    t->used[from] = t->used[t->n_before + to] = 1;
}

/* Ends a contact without a successor. */
static void end_contact(struct touching *t, const struct flow_contact *before)
{
    struct contact_row row;
    phys_vec point;
    if (!touch_find_point(t, before, &point))
        return;
    find_solved_row(t, before, &row);
    t->lent += contact_row_lent(&row, &point, before->row.energy, 0);
}

/* The place in a triangle that is nearest to a shape jumps along it if both are almost parallel. A
 * contact stays at its place if that is hardly farther: else resting cloth would rock from step to
 * step. */
static void stay_at_place(const struct touching *t, const struct flow_contact *before,
                          struct flow_contact *after)
{
    const double hardly = HARDLY * after->row.thickness;
    struct contact_row there = after->row;
    if (before->kind != FLOW_CONTACT_SHAPE || before->feature[1] != FLOW_ON_TRIANGLE)
        return;
    there.hard = before->row.hard;
    touch_find_point(t, before, &there.origin);
    flow_contact_end(flow_of(t->call), t->args->from, t->args->to, before, &there);
    if (!(there.gap < after->row.gap + hardly))
        return;
    after->row = there;
    memcpy(after->at.weight, before->at.weight, sizeof after->at.weight);
}

/* The pair that a contact slid on to: of the same first feature, on much the same side, and new.
 * Returns n if there is none. */
static size_t find_successor(const struct touching *t, const struct flow_contact *before)
{
    struct flow_contact least = *before;
    least.side[1] = least.feature[1] = 0;
    for (size_t i = lower_bound(t->after, t->n, &least); i < t->n; i++) {
        const struct flow_contact *after = t->after + i;
        if (compare_first(after, before))
            break;
        if (before->kind == CONTACT_TV && after->side[1] != before->side[1])
            continue; /* the vertex is another body's */
        if (before->kind == FLOW_CONTACT_SHAPE && after->feature[1] != before->feature[1])
            continue; /* a vertex and a triangle of that number */
        if (!t->used[t->n_before + i] &&
            phys_dot(&after->row.normal, &before->row.normal) > SAME_WAY)
            return i;
    }
    return t->n;
}

/* At a run's start, contacts about to rest are in the first solve, though without load. */
static void begin_all(struct touching *t)
{
    const double k = flow_contact_stiffness(flow_of(t->call), flow_of(t->call)->model->h);
    for (size_t i = 0; i < t->n; i++) {
        struct contact_row *row = &t->after[i].row;
        row->load = DBL_MIN;
        row->energy = FIRST_ENERGY * k * row->thickness * row->thickness;
    }
}

/* Returns false without memory. */
static bool end_accept(struct touching *t)
{
    qsort(t->after, t->n, sizeof *t->after, compare_contacts);
    t->n = flow_contact_drop_aslant(t->after, t->n, t->used + t->n_before);
    if (!t->carries)
        t->n = flow_contact_drop_repeated(t->after, t->n);
    for (size_t i = 0; i < t->n; i++) {
        const size_t at = find_before(t, t->after + i);
        if (at < t->n_before) {
            stay_at_place(t, t->before + at, t->after + i);
            touch_hand_over(t, at, i);
        }
    }
    for (size_t i = 0; i < t->n_before; i++) {
        if (t->used[i])
            continue;
        const size_t next = find_successor(t, t->before + i);
        if (next < t->n)
            touch_hand_over(t, i, next);
        else
            end_contact(t, t->before + i);
    }
    if (!(t->args->to > t->args->from))
        begin_all(t);
    const struct flow_contacts_before lists = {t->on->contacts, t->args->n_others,
                                               t->on->meetings + t->n_meetings};
    return flow_contact_find_pinched(flow_of(t->call), &lists, t->after, t->n);
}

static void sum_held_energy(const struct touching *t, double held[FLOW_HELD])
{
    for (size_t i = 0; i < t->n; i++)
        held[FLOW_HELD_ALL] += contact_row_holds(&t->after[i].row);
    held[FLOW_HELD_LENT] += t->lent;
}

/* ---- Both ---- */

/* Takes the pairs that the block's meetings listed for it. */
static void take_meetings(struct touching *t)
{
    const struct touch_fields *on = t->on;
    for (size_t at = 0; at < t->n_meetings; at++) {
        const struct flow_list *list = on->meetings[at].data;
        const struct flow_near *near = (const struct flow_near *)(list + 1);
        for (uint64_t i = 0; i < list->n; i++) {
            if (near[i].contact.side[0] != t->args->block)
                continue;
            if (t->args->accept)
                take_near(t, near + i);
            else
                add_failing(t, near + i);
        }
        at += is_between_blocks(t->call, list);
    }
}

static int touch_body(const duite_call *call, const struct touch_fields *on)
{
    const struct touch_args *args = on->args;
    const struct flow_list *before = on->contacts;
    struct flow_list *after = on->contacts_next;
    const bool carries = flow_contact_mode(flow_of(call)->model)->carries;
    struct touching t = {.call = call,
                         .on = on,
                         .args = args,
                         .n_meetings = on->n_meetings - args->n_others,
                         .before = (const struct flow_contact *)(before + 1),
                         .carries = carries,
                         .n_before = carries ? before->n : 0,
                         .after = (struct flow_contact *)(after + 1)};
    t.used = calloc(t.n_before + args->room + 1, 1);
    if (!t.used)
        return duite_fail(call, FLOW_NO_MEMORY, "out of memory for contacts");
    take_meetings(&t);
    if (args->accept && !end_accept(&t)) {
        free(t.used);
        return duite_fail(call, FLOW_NO_MEMORY, "out of memory for contacts");
    }
    if (!args->accept)
        end_again(&t);
    if (args->accept)
        sum_held_energy(&t, on->contact_energy);
    on->status[FLOW_PINCHES] += t.pinched;
    free(t.used);
    *after = (struct flow_list){.n = t.n};
    return duite_resize(call, FLOW_INDEX_OF(touch, contacts_next),
                        flow_contact_index(after, flow_of(call)->tables.n_blocks));
}

/* ---- Forks ---- */

/* Puts the meetings of a block and the points of their other blocks into `to`. Returns how many. */
static size_t list_meetings(const struct flow_state *state, uint32_t block, duite_object *to)
{
    duite_object *end = to;
    const struct flow_meetings *meetings = &state->contact.meetings;
    for (uint32_t i = 0; i < meetings->n; i++) {
        const uint32_t *side = meetings->all[i].side;
        if (side[0] != block && side[1] != block)
            continue;
        *end++ = meetings->all[i].near;
        if (side[0] != side[1] && side[1] < state->flow->tables.n_blocks)
            *end++ = state->block[side[side[0] == block]].skin_x;
    }
    return (size_t)(end - to);
}

/* The same of the contacts of other blocks, for those that may be pinched. */
static size_t list_others(const struct flow_state *state, uint32_t block, duite_object *to)
{
    unsigned char *keeps = state->contact.mark;
    size_t n = 0;
    flow_contact_keepers(state, block, keeps);
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++)
        if (keeps[b] && b != block)
            to[n++] = state->block[b].contacts;
    return n;
}

static int fork_touch(struct flow_state *state, struct touch_args *args)
{
    const uint32_t block = args->block;
    const uint32_t n = args->accept ? state->contact.found[block]
                                    : flow_kept_list(state, block, FLOW_FIELD_contacts)->n +
                                          state->contact.failing[block];
    flow_contact_keep(state, block, FLOW_FIELD_contacts_next, n);
    args->room = flow_kept_list(state, block, FLOW_FIELD_contacts_next)->room;
    duite_object *rest = flow_contact_rest(state);
    const size_t n_meetings = list_meetings(state, block, rest);
    args->n_others =
        args->accept && state->flow->may_pinch ? list_others(state, block, rest + n_meetings) : 0;
    const struct flow_with with = {.n = n_meetings + args->n_others, .rest = rest};
    return flow_fork_with(state, &flow_kernel_touch, args, &with);
}

/* The contacts where the step began are kept. */
static int fork_blocks(struct flow_state *state, bool accept)
{
    struct flow_contact_state *contact = &state->contact;
    const struct flow_step_args step = flow_attempt_args(state);
    struct touch_args args = {.accept = accept,
                              .stiffness = flow_contact_stiffness(state->flow, step.h),
                              .part = step.h / state->flow->model->h,
                              .from = step.time - step.h,
                              .to = step.time};
    int code = duite_set(state->rt, state->run.contact_energy, NULL);
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++)
        code = fork_touch(state, &args);
    if (!contact->kept_begin)
        flow_contact_swap(state, FLOW_FIELD_contacts, FLOW_FIELD_kept_contacts);
    contact->kept_begin = true;
    flow_contact_swap(state, FLOW_FIELD_contacts, FLOW_FIELD_contacts_next);
    return code;
}

int flow_contact_again(struct flow_state *state)
{
    return fork_blocks(state, false);
}

int flow_contact_accept(struct flow_state *state)
{
    return fork_blocks(state, true);
}
