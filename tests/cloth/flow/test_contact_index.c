/* The index behind a list of contacts names, for each block, the contacts with a corner in it, as a
 * look through the whole list does. And of contacts of a vertex with one point the list has one. */
#include "cloth/flow/contact/contact.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>

enum { BLOCKS = 7, MOST = 60 };

static struct flow_list *draw_list(unsigned n)
{
    struct flow_list *list = aligned_alloc(64, (flow_contact_index_room(n, BLOCKS) / 64 + 1) * 64);
    struct flow_contact *contact = (struct flow_contact *)(list + 1);
    ck_assert_ptr_nonnull(list);
    *list = (struct flow_list){.n = n};
    memset(contact, 0, n * sizeof *contact);
    for (unsigned i = 0; i < n; i++) {
        contact[i].at.n = 1 + (uint32_t)rand() % SOLVE_TIE_CORNERS;
        for (int k = 0; k < SOLVE_TIE_CORNERS; k++) /* behind the corners: nothing to look at */
            contact[i].at.block[k] = (uint32_t)rand() % (BLOCKS - 1);
    }
    return list;
}

static bool is_in(const struct flow_tie_corners *at, uint32_t block)
{
    bool in = false;
    for (uint32_t k = 0; k < at->n; k++)
        in = in || at->block[k] == block;
    return in;
}

UNIT_LOOP(each_block_finds_its_contacts, 0, 5)
{
    srand((unsigned)_i);
    const unsigned n = (unsigned)_i * MOST / 4;
    struct flow_list *list = draw_list(n);
    const struct flow_contact *contact = (const struct flow_contact *)(list + 1);
    const size_t bytes = flow_contact_index(list, BLOCKS);
    ck_assert_uint_le(bytes, flow_contact_index_room(n, BLOCKS));
    for (uint32_t b = 0; b < BLOCKS; b++) {
        size_t found, at = 0;
        const uint32_t *place = flow_contact_of(list, b, BLOCKS, &found);
        for (uint32_t i = 0; i < n; i++) {
            if (!is_in(&contact[i].at, b))
                continue;
            ck_assert_uint_lt(at, found);
            ck_assert((const char *)(place + at + 1) <= (const char *)list + bytes);
            ck_assert_uint_eq(place[at], i);
            at++;
        }
        ck_assert_uint_eq(at, found);
    }
    free(list);
}

/* A run begins with lists that end with their head. */
UNIT_TEST(nothing_is_behind_an_empty_list)
{
    const struct flow_list none = {0};
    size_t found = 1;
    ck_assert_ptr_null(flow_contact_of(&none, 0, BLOCKS, &found));
    ck_assert_uint_eq(found, 0);
}

/* A vertex of the block, 2 mm off in a direction along y. */
static struct flow_contact drawn(uint32_t kind, uint32_t vertex, double along)
{
    return (struct flow_contact){
        .kind = kind,
        .feature = {vertex},
        .row = {.normal = {0, along, 0, 0}, .gap = 0.002, .thickness = 0.002}};
}

/* Triangles with a common edge or corner have the nearest point of a vertex in common: it is one
 * contact. Where the vertex lies between two layers there are two. */
UNIT_TEST(a_point_is_met_once)
{
    struct flow_contact list[] = {
        drawn(CONTACT_VT, 5, 1), drawn(CONTACT_VT, 5, 1), drawn(CONTACT_VT, 5, -1),
        drawn(CONTACT_VT, 5, 1), drawn(CONTACT_VT, 6, 1), drawn(CONTACT_EE, 6, 1),
        drawn(CONTACT_EE, 6, 1),
    };
    static const double along[] = {1, -1, 1, 1, 1};
    static const uint32_t vertex[] = {5, 5, 6, 6, 6};
    ck_assert_uint_eq(flow_contact_drop_repeated(list, sizeof list / sizeof *list), 5);
    for (int i = 0; i < 5; i++) {
        ck_assert_uint_eq(list[i].feature[0], vertex[i]);
        ck_assert(list[i].row.normal[1] * along[i] > 0);
    }
}
