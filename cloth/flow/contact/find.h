#ifndef CLOTH_FLOW_CONTACT_FIND_H
#define CLOTH_FLOW_CONTACT_FIND_H

#include "cloth/flow/contact/contact.h"

/* The list that the task of two sides fills, and its counts. In a task; local. (find.c) */
struct flow_findings {
    const duite_call *call;
    size_t parameter; /* the list */
    struct flow_list *list;
    struct flow_near *near;            /* its items: */
    size_t n, before;                  /* found now; of a look before, none unless it looks again */
    const struct flow_meet_args *args; /* room: for so many */
    double *counts;
    uint32_t n_points[2];   /* of both sides; the second one of a shape, or of the same block: 0 */
    unsigned char *failing; /* by point of the first side, then of the second one: a pair fails
                             * there; NULL: no pair fails */
    bool no_memory;         /* for it */
};

/* list: parameter i, under rw. counts: of all meetings. */
void flow_findings_open(const duite_call *call, size_t i, struct flow_list *list,
                        const struct flow_meet_args *args, double *counts,
                        struct flow_findings *to);

/* Counts an item, and appends it if there is room. It may be one of the look before that is at the
 * same place or behind. */
void flow_findings_add(struct flow_findings *findings, const struct flow_near *near);

/* passes: pairs that were certified. Returns what the body does. */
int flow_findings_close(const struct flow_findings *findings, size_t passes);

#endif
