/* A contact is pinched where solids press on both of its sides and leave less than the thickness of
 * the cloth between them. A solid is an obstacle, or a feature that pins hold. It presses on a
 * contact by a chain of contacts through the cloth: each is tight, and pushes a corner of the next
 * one's side on its way. The sum of the room that they lack tells how much the solids leave. Cloth
 * that is pulled tight around an obstacle is not pinched, nor cloth that an obstacle pushes along:
 * nothing solid is behind it.
 *
 * Each contact keeps the chains to its sides that lack most, found from those of the step before: a
 * chain grows by a contact a step. One without a solid any more counts up and ends. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/run/source.h"

#include <stdlib.h>

/* Contacts push much the same way if their normals have at least this cosine: 45 degrees. */
static const double ALONG = 0.7;
enum { LONGEST = 256 }; /* contacts of a chain: more layers than any pile has */

bool flow_source_may_pinch(const struct flow_source *source)
{
    const struct model *model = source->model;
    bool solids = model->n_obstacles > 1 || model->bodies.n > 0;
    for (uint32_t v = 0; v < source->particles.n && !solids; v++)
        solids = source->particles.used[v] && !source->particles.free[v];
    return model_promise(model).apart && solids;
}

/* A chain: its contacts, 0: there is none; m: what they lack. */
struct chain {
    uint32_t n;
    double lack;
};

/* It ends with a push of a corner. */
struct push {
    uint64_t corner; /* its block and row */
    double way[3];   /* of length 1 */
    struct chain chain;
};

static uint64_t pinch_corner_of(const struct flow_contact *contact, uint32_t k)
{
    return (uint64_t)contact->at.block[k] << 32 | contact->at.row[k];
}

/* Corners from .. to - 1 are those of a side. */
static void pinch_corners_of(const struct flow_contact *contact, int side, uint32_t *from,
                             uint32_t *to)
{
    const uint32_t first = contact->first < contact->at.n ? contact->first : contact->at.n;
    *from = side ? first : 0;
    *to = side ? contact->at.n : first;
}

/* ---- Pushes of the step before ---- */

/* Corners of the contacts that may be pinched, as bits at their hashes: other corners may share a
 * bit, which costs time only. */
enum { CORNER_BITS = 16 };
struct corner_set {
    uint64_t word[(1u << CORNER_BITS) / 64];
};

/* The bit of a corner: Fibonacci hashing (Knuth, TAOCP 3, 6.4). */
static uint32_t corner_bit(uint64_t corner)
{
    return (uint32_t)(corner * 0x9E3779B97F4A7C15u >> (64 - CORNER_BITS));
}

static bool has_corner(const struct corner_set *set, uint64_t corner)
{
    const uint32_t bit = corner_bit(corner);
    return set->word[bit / 64] >> bit % 64 & 1;
}

/* Adds the corners of tight contacts. Returns false if there is none. */
static bool add_corners(const struct flow_contact *contact, size_t n, struct corner_set *set)
{
    bool any = false;
    for (size_t i = 0; i < n; i++) {
        if (!contact_row_is_tight(&contact[i].row))
            continue;
        any = true;
        for (uint32_t k = 0; k < contact[i].at.n; k++) {
            const uint32_t bit = corner_bit(pinch_corner_of(contact + i, k));
            set->word[bit / 64] |= (uint64_t)1 << bit % 64;
        }
    }
    return any;
}

struct pushes {
    struct push *all; /* by corner */
    size_t n, room;
    struct corner_set of; /* pushes of other corners are left out */
};

static int compare_pushes(const void *left, const void *right)
{
    const uint64_t a = ((const struct push *)left)->corner,
                   b = ((const struct push *)right)->corner;
    return (a > b) - (a < b);
}

static bool add_push(struct pushes *pushes, const struct push *push)
{
    if (pushes->n == pushes->room) {
        const size_t room = 2 * pushes->room + 64;
        struct push *all = realloc(pushes->all, room * sizeof *all);
        if (!all)
            return false;
        pushes->all = all;
        pushes->room = room;
    }
    pushes->all[pushes->n++] = *push;
    return true;
}

/* Adds those of a contact: its first side goes along the normal, the second one against it. Returns
 * false without memory. */
static bool add_pushes(const struct flow_contact *contact, struct pushes *pushes)
{
    bool added = true;
    for (int side = 0; side < 2; side++) {
        struct push push = {.chain = {contact->chain[side], contact->lack[side]}};
        uint32_t from, end;
        pinch_corners_of(contact, side, &from, &end);
        for (int c = 0; c < 3; c++)
            push.way[c] = (side ? -1 : 1) * contact->row.normal[c];
        for (uint32_t k = from; k < end && push.chain.n; k++) {
            push.corner = pinch_corner_of(contact, k);
            if (has_corner(&pushes->of, push.corner))
                added = added && add_push(pushes, &push);
        }
    }
    return added;
}

/* Lists them by their corners. Returns false without memory. */
static bool list_pushes(const struct flow_contacts_before *before, struct pushes *pushes)
{
    bool added = true;
    for (size_t i = 0; i <= before->n; i++) {
        const struct flow_list *list = i ? before->other[i - 1].data : before->own;
        const struct flow_contact *contact = (const struct flow_contact *)(list + 1);
        for (uint64_t k = 0; k < list->n && added; k++)
            added = add_pushes(contact + k, pushes);
    }
    if (pushes->n)
        qsort(pushes->all, pushes->n, sizeof *pushes->all, compare_pushes);
    return added;
}

/* ---- Chains ---- */

/* True if a side gives way nowhere. */
static bool is_solid(const struct flow_contact *contact, int side, uint32_t n_blocks)
{
    uint32_t from, end;
    pinch_corners_of(contact, side, &from, &end);
    bool solid = true;
    for (uint32_t k = from; k < end; k++)
        solid = solid && (contact->at.held >> k & 1 || contact->at.weight[k] == 0);
    return solid || (side && contact->side[1] >= n_blocks);
}

static size_t first_push(const struct pushes *pushes, uint64_t corner)
{
    size_t low = 0, high = pushes->n;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (pushes->all[middle].corner < corner)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* True if a push of a side's corner goes into the contact. */
static bool pushes_into(const struct push *push, const struct flow_contact *contact, int side)
{
    double along = 0;
    for (int c = 0; c < 3; c++)
        along += push->way[c] * contact->row.normal[c];
    return (side ? along : -along) > ALONG;
}

/* The chain that pushes a side into the contact. */
static struct chain chain_behind(const struct flow_contact *contact, int side,
                                 const struct pushes *pushes)
{
    struct chain most = {0};
    uint32_t from, end;
    pinch_corners_of(contact, side, &from, &end);
    for (uint32_t k = from; k < end; k++) {
        const uint64_t corner = pinch_corner_of(contact, k);
        for (size_t i = first_push(pushes, corner); i < pushes->n; i++) {
            const struct push *push = pushes->all + i;
            const struct chain *chain = &push->chain;
            if (push->corner != corner)
                break;
            const bool more = !most.n || chain->lack > most.lack ||
                              (!(chain->lack < most.lack) && chain->n < most.n);
            if (more && chain->n < LONGEST && pushes_into(push, contact, side))
                most = *chain;
        }
    }
    return most;
}

/* Finds the chain that ends at a side, and comes from behind the other one. */
static void find_chain(int side, uint32_t n_blocks, const struct pushes *pushes,
                       struct flow_contact *contact)
{
    const bool solid = is_solid(contact, !side, n_blocks);
    const struct chain behind = solid ? (struct chain){0} : chain_behind(contact, !side, pushes);
    contact->chain[side] = solid || behind.n ? behind.n + 1 : 0;
    contact->lack[side] = behind.lack + contact_row_lacks(&contact->row);
}

bool flow_contact_find_pinched(const struct flow *flow, const struct flow_contacts_before *before,
                               struct flow_contact *contact, size_t n)
{
    const uint32_t n_blocks = flow->tables.n_blocks;
    struct pushes pushes = {0};
    if (!flow->may_pinch || !add_corners(contact, n, &pushes.of))
        return true;
    const bool listed = list_pushes(before, &pushes);
    for (size_t i = 0; i < n && listed; i++) {
        struct flow_contact *of = contact + i;
        if (!contact_row_is_tight(&of->row))
            continue;
        for (int side = 0; side < 2; side++)
            find_chain(side, n_blocks, &pushes, of);
        of->row.pinched =
            of->chain[0] && of->chain[1] && of->lack[0] + of->lack[1] > contact_row_lacks(&of->row);
    }
    free(pushes.all);
    return listed;
}
