#ifndef CLOTH_FLOW_CONTACT_REPEL_H
#define CLOTH_FLOW_CONTACT_REPEL_H

#include "cloth/contact/repulse.h"
#include "cloth/flow/state/state.h"

/* Contact by springs (cloth/contact/repulse.h). A step finds the pairs that are too near at its
 * begin. Its forces push these pairs, wherever it goes; its end is not checked. */

/* The springs that push contacts apart in a step of h, s. The scene gives k. Its default is 0.1 m /
 * H^2 in explicit steps, m the mean mass of a vertex and H the scene's step; in implicit ones
 * flow_contact_stiffness of H. Local. */
struct contact_spring flow_repulsion_of(const struct flow *flow, double h);

/* Bounds the fastest vibration of contacts at a vertex of mean mass: its square is at most this
 * times k / m, its damping this times c / m. Two layers that press on each other, each vertex on a
 * triangle, reach 4. */
enum { FLOW_REPULSION_MOST = 4 };

/* Called at a run's start; then in each step, before its forces. Collective; they return what the
 * runtime does. */
int flow_repulsion_start(struct flow_state *state);
int flow_repulsion_begin(struct flow_state *state);

#endif
