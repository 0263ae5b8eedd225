/* Some near features are no contacts: neighbours of the feature below. Lists have the order of
 * touch.c, so the contacts of a feature are side by side. */
#include "cloth/flow/contact/contact.h"

/* Surfaces face much the same way if their normals have at least this cosine: 60 degrees. */
static const double SAME_WAY = 0.5;
/* Part of the thickness: points of a surface that are as near to each other are one, but for
 * rounding. */
static const double SAME_POINT = 1e-6;

/* True if two contacts are of the same feature of the block. */
static bool are_of_one(const struct flow_contact *a, const struct flow_contact *b)
{
    return a->kind == b->kind && a->feature[0] == b->feature[0];
}

/* True if the nearest point is inside the triangle that a vertex meets. */
static bool pick_is_inside(const struct flow_contact *contact)
{
    bool inside = true;
    for (uint32_t k = contact->first; k < contact->at.n; k++)
        inside = inside && contact->at.weight[k] != 0;
    return inside;
}

/* True if the vertex of a contact is above a triangle of the same surface. A triangle that is
 * farther is of another surface. */
static bool pick_is_met(const struct flow_contact *list, size_t n, size_t i)
{
    const struct flow_contact *contact = list + i;
    size_t from = i;
    bool met = false;
    while (from > 0 && are_of_one(list + from - 1, contact))
        from--;
    for (size_t to = from; to < n && are_of_one(list + to, contact); to++)
        met = met || (pick_is_inside(list + to) && list[to].row.gap <= contact->row.gap &&
                      phys_dot(&list[to].row.normal, &contact->row.normal) > SAME_WAY);
    return met;
}

size_t flow_contact_drop_aslant(struct flow_contact *list, size_t n, unsigned char *marks)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++)
        marks[i] =
            list[i].kind == CONTACT_VT && !pick_is_inside(list + i) && pick_is_met(list, n, i);
    for (size_t i = 0; i < n; i++)
        if (!marks[i])
            list[kept++] = list[i];
    memset(marks, 0, n);
    return kept;
}

/* True if two contacts of a vertex are with the same point of a surface. */
static bool are_same(const struct flow_contact *a, const struct flow_contact *b)
{
    const phys_vec between = a->row.gap * a->row.normal - b->row.gap * b->row.normal;
    const double most = SAME_POINT * a->row.thickness;
    return phys_dot(&between, &between) <= most * most;
}

size_t flow_contact_drop_repeated(struct flow_contact *list, size_t n)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        bool repeated = false;
        for (size_t k = kept; k > 0 && are_of_one(list + k - 1, list + i); k--)
            repeated = repeated || are_same(list + k - 1, list + i);
        if (!repeated || list[i].kind != CONTACT_VT)
            list[kept++] = list[i];
    }
    return kept;
}
