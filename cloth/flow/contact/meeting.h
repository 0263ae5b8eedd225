#ifndef CLOTH_FLOW_CONTACT_MEETING_H
#define CLOTH_FLOW_CONTACT_MEETING_H

#include "cloth/flow/contact/find.h"
#include "cloth/flow/contact/skin.h"

/* The task of two skins that meet. (meet.c, meet_pair.c) */

/* The state of a query's visits. */
struct meeting {
    const struct flow *flow;
    const struct model *model;
    const struct flow_meet_args *args;
    const struct contact_body *body; /* that it is with; NULL: a block */
    const uint32_t *fan;             /* of the body (contact_body_opens) */
    const uint32_t *attached;        /* by point of the first skin */
    const double *area[2];           /* by point of each skin; of a body NULL */
    struct flow_skin_kin kin[2];
    bool leaves_out;                 /* see flow_leaves_out */
    struct flow_thickness thickness; /* of its pairs */
    double reach;                    /* m: of the thickest, as the mode has it (mode.h) */
    const unsigned char *moved[2];   /* by point of each skin; NULL: it rests */
    struct contact_skin skin[2];
    struct contact_side side[2]; /* of a block that meets itself: both */
    struct flow_findings findings;
    size_t passes; /* pairs that are certified */
};

/* Looks at n candidates; to: the meeting. For queries. */
void flow_meeting_visit(void *to, uint32_t n, const struct contact_candidate *candidate);

/* m: how near to each other kin of two blocks are contacts, at most; 0: they have none. Features of
 * one flat part of cloth are kin where they are near. */
double flow_meeting_kin_reach(const struct meeting *m);

/* True if a point of a listed contact moved since the last look. */
bool flow_meeting_moved(const struct meeting *m, const struct flow_contact *contact);

#endif
