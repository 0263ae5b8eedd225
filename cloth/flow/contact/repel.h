#ifndef CLOTH_FLOW_CONTACT_REPEL_H
#define CLOTH_FLOW_CONTACT_REPEL_H

#include "cloth/contact/repulse.h"
#include "cloth/flow/state/state.h"

/* Contact by springs (cloth/contact/repulse.h). A step finds what is too near where it begins. Its
 * forces know of that, wherever it goes; nothing looks at it afterwards. */

/* What pushes contacts apart in a step of h, s. Without a stiffness of the scene's k is, by the
 * mean mass m of a vertex and the scene's step H, 0.1 m / H^2 in explicit steps and
 * flow_contact_stiffness of H in implicit ones. Local. */
struct contact_spring flow_repulsion_of(const struct flow *flow, double h);

/* The fastest vibration that contacts of a vertex of mean mass can have: its square is so many
 * times k / m, what damps it so many times c / m. Two layers that press on each other all over,
 * each vertex on a triangle, come to 4. */
enum { FLOW_REPULSION_MOST = 4 };

/* Of a run's start; then of each step, before its forces. Collective; they return what the runtime
 * does. */
int flow_repulsion_start(struct flow_state *state);
int flow_repulsion_begin(struct flow_state *state);

#endif
