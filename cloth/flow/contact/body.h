#ifndef CLOTH_FLOW_CONTACT_BODY_H
#define CLOTH_FLOW_CONTACT_BODY_H

#include "cloth/flow/contact/contact.h"

#include "cloth/contact/body_skin.h"

/* Bodies as blocks of cloth meet them, in runs that certify the ways of steps (mode.h). Each
 * obstacle that is a body has a skin (cloth/contact/body_skin.h), in fields of the run that all
 * ranks have: `body_skins` the tables, `body_fans` a facet of each vertex, `body_points` where each
 * vertex is at the begin and at the end of a step, `body_boxes` the boxes of its way. In each the
 * bodies come in the order of the obstacles. */

/* Where an obstacle begins in these fields: bytes, vertices, points, bytes; for model->n_obstacles,
 * the end of the last one. Local. */
struct flow_body_place {
    size_t skin, vertex, point, boxes;
};
struct flow_body_place flow_body_place(const struct model *model, uint32_t obstacle);

/* True if a run has such bodies; if any of them moves or changes its
 * shape. Local. */
bool flow_bodies_are_met(const struct model *model);
bool flow_bodies_move(const struct model *model);

/* An obstacle in these fields, as a query takes it. Local. */
void flow_body_open(const struct model *model, uint32_t obstacle, const unsigned char *skins,
                    const phys_vec *points, const unsigned char *boxes, struct contact_skin *skin,
                    struct contact_side *side);

/* The same as flow_contact_ahead, of a contact with a body. Local. */
void flow_body_ahead(const struct flow *flow, double from, double to,
                     const struct flow_contact *contact, struct contact_row *row);

/* Functions of the main program. Collective; they return what the runtime does. */

/* Forks the making of skins. Called before anything else about bodies. */
int flow_bodies_make(struct flow_state *state);
/* Forks the making of points and boxes of the step under way, unless they are made. */
int flow_bodies_follow(struct flow_state *state);

#endif
