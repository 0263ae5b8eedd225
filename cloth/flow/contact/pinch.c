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

static int compare_pushes(const void *left, const void *right)
{
    const uint64_t a = ((const struct push *)left)->corner,
                   b = ((const struct push *)right)->corner;
    return (a > b) - (a < b);
}

/* Adds those of a contact: its first side goes along the normal, the second one against it. Returns
 * how many; to NULL: they are counted. */
static size_t add_pushes(const struct flow_contact *contact, struct push *to)
{
    size_t n = 0;
    for (int side = 0; side < 2; side++) {
        uint32_t from, end;
        pinch_corners_of(contact, side, &from, &end);
        for (uint32_t k = from; k < end && contact->chain[side]; k++, n++) {
            if (!to)
                continue;
            to[n] = (struct push){.corner = pinch_corner_of(contact, k),
                                  .chain = {contact->chain[side], contact->lack[side]}};
            for (int c = 0; c < 3; c++)
                to[n].way[c] = (side ? -1 : 1) * contact->row.normal[c];
        }
    }
    return n;
}

static size_t list_pushes(const struct flow_contacts_before *before, struct push *to)
{
    size_t n = 0;
    for (size_t i = 0; i <= before->n; i++) {
        const struct flow_list *list = i ? before->other[i - 1].data : before->own;
        const struct flow_contact *contact = (const struct flow_contact *)(list + 1);
        for (uint64_t k = 0; k < list->n; k++)
            n += add_pushes(contact + k, to ? to + n : NULL);
    }
    return n;
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

static size_t first_push(const struct push *pushes, size_t n, uint64_t corner)
{
    size_t low = 0, high = n;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (pushes[middle].corner < corner)
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
                                 const struct push *pushes, size_t n)
{
    struct chain most = {0};
    uint32_t from, end;
    pinch_corners_of(contact, side, &from, &end);
    for (uint32_t k = from; k < end; k++) {
        const uint64_t corner = pinch_corner_of(contact, k);
        for (size_t i = first_push(pushes, n, corner); i < n && pushes[i].corner == corner; i++) {
            const struct chain *chain = &pushes[i].chain;
            const bool more = !most.n || chain->lack > most.lack ||
                              (!(chain->lack < most.lack) && chain->n < most.n);
            if (more && chain->n < LONGEST && pushes_into(pushes + i, contact, side))
                most = *chain;
        }
    }
    return most;
}

/* Finds the chain that ends at a side, and comes from behind the other one. */
static void find_chain(int side, uint32_t n_blocks, const struct push *pushes, size_t n,
                       struct flow_contact *contact)
{
    const bool solid = is_solid(contact, !side, n_blocks);
    const struct chain behind = solid ? (struct chain){0} : chain_behind(contact, !side, pushes, n);
    contact->chain[side] = solid || behind.n ? behind.n + 1 : 0;
    contact->lack[side] = behind.lack + contact_row_lacks(&contact->row);
}

bool flow_contact_find_pinched(const struct flow *flow, const struct flow_contacts_before *before,
                               struct flow_contact *contact, size_t n)
{
    const uint32_t n_blocks = flow->tables.n_blocks;
    size_t first = 0;
    while (first < n && !contact_row_is_tight(&contact[first].row))
        first++;
    if (first == n || !flow->may_pinch)
        return true;
    const size_t n_pushes = list_pushes(before, NULL);
    struct push *pushes = malloc((n_pushes + 1) * sizeof *pushes);
    if (!pushes)
        return false;
    list_pushes(before, pushes);
    qsort(pushes, n_pushes, sizeof *pushes, compare_pushes);
    for (size_t i = first; i < n; i++) {
        struct flow_contact *of = contact + i;
        if (!contact_row_is_tight(&of->row))
            continue;
        for (int side = 0; side < 2; side++)
            find_chain(side, n_blocks, pushes, n_pushes, of);
        of->row.pinched =
            of->chain[0] && of->chain[1] && of->lack[0] + of->lack[1] > contact_row_lacks(&of->row);
    }
    free(pushes);
    return true;
}
