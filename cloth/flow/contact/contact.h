#ifndef CLOTH_FLOW_CONTACT_CONTACT_H
#define CLOTH_FLOW_CONTACT_CONTACT_H

#include "cloth/flow/state/bodies.h"

#include "cloth/contact/row.h"
#include "cloth/contact/skin.h"

/* Certified contact of a step, as its main program drives it. In reading order: certified.c is the
 * step: solve, look, solve again or cut. pairs.c finds which sides are near each other. meet.c is
 * the task of two sides: it certifies pairs that may touch and lists near ones (find.c). touch.c
 * makes the contacts of a block from these lists; they are state. pinch.c says which of them have
 * no room. index.c lists contacts by the blocks of their corners. rows.c brings contacts to the
 * blocks that have their corners, and into the system of the step. cut.c cuts ways. stop.c gives a
 * step up.
 *
 * A side is a block of cloth or an obstacle. Sides have numbers: blocks, then obstacles. */

/* Two features that are near each other, as the first one's block keeps it. Corners of a body have
 * no rows: `at` counts those of the cloth alone, and has the weights of the others behind them. */
struct flow_contact {
    uint32_t side[2];    /* the block that keeps it; the side that it meets */
    uint32_t kind;       /* enum contact_pair, CONTACT_TV or FLOW_CONTACT_SHAPE */
    uint32_t feature[2]; /* of the skin of each side; CONTACT_TV, a vertex of a body and a triangle
                          * of the first side: of the body's, then of the block's */
    uint32_t point[4];   /* corners in the skins, as enum contact_pair orders them; CONTACT_TV:
                          * first those of the triangle */
    uint32_t first;      /* so many of them are of the first side */
    uint32_t chain[2];   /* contacts from a solid to each side, this one the last of them; 0: there
                          * is no such chain (pinch.c) */
    double lack[2];      /* m: the sum of what these lack */
    struct flow_tie_corners at;
    struct contact_row row;
};
/* With a shape the second feature is where on the cloth the contact is. */
enum { FLOW_CONTACT_SHAPE = 8, FLOW_ON_VERTEX = 0, FLOW_ON_TRIANGLE };

/* A finding of two sides: a future contact, or a pair that fails its certificate in this step. */
struct flow_near {
    struct flow_contact contact;
    bool fails, presses; /* of those that fail: it is to be a contact of the next solve */
    double part[4];      /* then: how far each corner may go, */
    double along[4];     /* and where it ends, m, along the normal that it has in the pair; of a
                          * shape: how far it is to be pushed along the row's normal */
    double apart;        /* m: and how far apart pushes end the step (cloth/contact/push.h) */
};

/* A list in an object of bytes that changes its size: the head, then the items. */
struct flow_list {
    uint64_t n;
    uint32_t side[2];  /* of a meeting */
    uint64_t spare[6]; /* the items begin a cache line of their own */
};
static inline size_t flow_list_bytes(size_t n, size_t item)
{
    return sizeof(struct flow_list) + n * item;
}

/* A list of contacts that a block keeps ends with an index of them by the blocks of their corners.
 * The first returns the most bytes of the whole list. The second writes the index and returns the
 * bytes. The third finds the contacts of a block: n places in the list, ascending. Local.
 * (index.c) */
size_t flow_contact_index_room(size_t n, uint32_t n_blocks);
size_t flow_contact_index(struct flow_list *list, uint32_t n_blocks);
const uint32_t *flow_contact_of(const struct flow_list *list, uint32_t block, uint32_t n_blocks,
                                size_t *n);

/* A cloth and another side, as flow->sides has them. */
static inline const struct model_sides *flow_sides_of(const struct flow *flow, uint32_t cloth,
                                                      uint32_t other)
{
    return flow->sides + (size_t)cloth * ((size_t)flow->n_cloths + flow->model->n_obstacles) +
           other;
}
/* m: of all pairs of a cloth of block a and one of another block, or an obstacle. Where least is
 * most, each pair has that. Local. (modes.c) */
struct flow_thickness {
    double least, most;
};
struct flow_thickness flow_thickness_of(const struct flow *flow, uint32_t a, uint32_t b);
/* The cloth of n points of a feature. A point that is welded from several cloths belongs to the
 * first of them. */
static inline uint32_t flow_cloth_of(const struct contact_skin *skin, uint32_t n,
                                     const uint32_t *point)
{
    uint32_t cloth = 0;
    for (uint32_t k = 0; k < n; k++)
        cloth = skin->cloth[point[k]] > cloth ? skin->cloth[point[k]] : cloth;
    return cloth;
}
/* True if a block may leave out features of a block or, with `obstacle`, of an obstacle: some
 * cloths do not meet it, or a pin of a corner follows it. */
static inline bool flow_leaves_out(const struct model *model, bool obstacle)
{
    return model->contact.apart.apart || (obstacle ? model_follows(model) : !model->contact.self);
}
/* True if one of n points is attached to an obstacle, by number. attached: of their skin. */
static inline bool flow_is_attached(const uint32_t *attached, uint32_t n, const uint32_t *point,
                                    uint32_t obstacle)
{
    bool is = false;
    for (uint32_t k = 0; k < n; k++)
        is = is || attached[point[k]] == obstacle + 1;
    return is;
}

/* Drop false contacts from a list that is sorted as in touch.c; return how many are left. Local.
 * (pick.c)
 * A vertex above a triangle is near the triangle's neighbours too, aslant: they would hold it up as
 * it slides. marks: n, zero before and after. */
size_t flow_contact_drop_aslant(struct flow_contact *list, size_t n, unsigned char *marks);
/* A vertex above an edge or a vertex has the same nearest point on each triangle there. Their
 * springs would add up, so only the first is a contact. */
size_t flow_contact_drop_repeated(struct flow_contact *list, size_t n);

/* The contacts that a step had: a block's own, and n lists of others. */
struct flow_contacts_before {
    const struct flow_list *own;
    size_t n;
    const duite_param *other;
};
/* Finds the chains of n contacts, and which of them are pinched, by contacts of the step before:
 * all that may have corners where these have some. Returns false without memory. Local. (pinch.c)
 */
bool flow_contact_find_pinched(const struct flow *flow, const struct flow_contacts_before *before,
                               struct flow_contact *contact, size_t n);

/* Functions of the main program. Collective; they return what the runtime does. */

/* Arguments of the task of two sides. */
struct flow_meet_args {
    union {
        uint32_t block; /* the first side */
        uint32_t side[2];
    };
    uint32_t number; /* among all meetings */
    uint32_t room;   /* for so many items in its list */
    bool again;      /* the list is that of a look before: only what moved is looked at */
    double from, to; /* s: of the step */
};

/* Room for so many meetings on every rank. The second frees those that there are. (memory.c) */
int flow_contact_room(struct flow_state *state, uint32_t n);
void flow_contact_part(struct flow_state *state);
/* Room for the further objects of a fork (struct flow_with): lists of all meetings with points.
 * Local. */
static inline duite_object *flow_contact_rest(const struct flow_state *state)
{
    return state->contact.refs + FLOW_MAX_PARAMETERS;
}

/* Counts of one look at the step. passes, queries: of this look alone. */
struct flow_seen {
    uint64_t fails, passes, contacts;
    uint64_t queries; /* sides that were looked at */
    bool hopeless;    /* more pairs fail than a solve can hold: lists are not complete */
};
/* Looks at the way from kept_x to x: all pairs are certified, the near ones are listed. (pairs.c)
 * again: the last look was at this step, and kept_x is the same. shorter: a shorter step can be
 * made where it is hopeless. */
int flow_contact_look(struct flow_state *state, bool again, bool shorter, struct flow_seen *seen);
/* Makes the meetings of a checkpoint. (pairs.c) */
struct flow_saved_side;
int flow_contact_meet_again(struct flow_state *state, uint32_t n,
                            const struct flow_saved_side *side);
/* The lists of meetings whose features may have corners in a block, put into `to`; returns how
 * many. Marks the blocks that may keep contacts with corners in it, of all. Local. (pairs.c) */
uint32_t flow_contact_lists(const struct flow_state *state, uint32_t block, duite_object *to);
void flow_contact_keepers(const struct flow_state *state, uint32_t block, unsigned char *keeps);
/* The index of one of a block's lists of contacts, the field `contacts` or one of the two behind
 * it. Local. */
static inline struct flow_kept_list *flow_kept_list(const struct flow_state *state, uint32_t block,
                                                    enum flow_field_id contacts)
{
    return state->contact.kept[block].list + (contacts - FLOW_FIELD_contacts);
}
/* Gives one of them room for n contacts: they are lost if it is made again. A failure is returned
 * by the next fork. (memory.c) */
void flow_contact_keep(struct flow_state *state, uint32_t block, enum flow_field_id contacts,
                       uint32_t n);
/* Swaps two of them in all blocks. Local. (memory.c) */
void flow_contact_swap(struct flow_state *state, enum flow_field_id a, enum flow_field_id b);
/* Back to the contacts where the step began. Local. (memory.c) */
void flow_contact_return(struct flow_state *state);
/* Sets the lists of all blocks that have no contacts yet. */
int flow_contact_none(struct flow_state *state);
/* Fork the tasks that make the contacts of all blocks: `again` those of the solve, pressed, and the
 * failing pairs; `accept`, at the end of a step, the near pairs. (touch.c) */
int flow_contact_again(struct flow_state *state);
int flow_contact_accept(struct flow_state *state);
/* Forks the tasks that make ties of the contacts, for the next solve. (rows.c) */
int flow_contact_tie(struct flow_state *state);
/* Pushes the corners of pairs that fail, or cuts their ways. (cut.c) */
struct flow_cut {
    uint64_t rows, halved; /* that were moved; by more than half of a way that counts */
    uint64_t run;          /* most steps in a row that one of them was cut in, with this one */
    bool stops;            /* a rank is asked to stop */
    double momentum;       /* kg m/s: that the cloth lost or gained */
};
int flow_contact_cut(struct flow_state *state, bool push, struct flow_cut *cut);
int flow_contact_cut_none(struct flow_state *state); /* no row was cut yet */

/* Sets the normal and gap of row's origin at the end of a step between two times (s), for a contact
 * with a convex shape. Local. (ahead.c) */
void flow_contact_end(const struct flow *flow, double from, double to,
                      const struct flow_contact *contact, struct contact_row *row);

/* A contact with an obstacle, where the obstacle is in a step between two times (s): row begins as
 * that of the contact. Others stay as they are. Local.
 * (ahead.c) */
void flow_contact_ahead(const struct flow *flow, double from, double to,
                        const struct flow_contact *contact, struct contact_row *row);

/* The difference of the velocities of both sides' points at a contact, tie i, as corners have them.
 * Local. (rows.c) */
void flow_contact_speed(const struct flow_ties *ties, const struct flow_view *view, uint32_t i,
                        phys_vec *speed);

/* N/m: the k of cloth/contact/row.h in a step of h. */
double flow_contact_stiffness(const struct flow *flow, double h);

/* Thicknesses: nearer features are contacts, as the mode says. Local. (modes.c) */
double flow_contact_reach(const struct model *model);

#endif
