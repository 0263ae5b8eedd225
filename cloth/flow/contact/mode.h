#ifndef CLOTH_FLOW_CONTACT_MODE_H
#define CLOTH_FLOW_CONTACT_MODE_H

#include "cloth/flow/state/bodies.h"

#include "cloth/contact/repulse.h"

/* A contact mode is a row: its part of a step, and what it needs. Each has a file of its own. A run
 * has the first whose `is` is true. A mode's promises outside of flow are in
 * cloth/model/contact.h. */

struct flow_contact;

/* The force of a contact, and its value in a step of h. against: the part of the value that resists
 * the point's motion, without the part that resists its speed. */
struct flow_pressed {
    phys_vec force, value, against;
};

struct flow_contact_mode {
    bool (*is)(const struct model *model);

    /* Functions of the main program. Collective; they return what the runtime does. NULL: there is
     * nothing to do. */
    int (*start)(struct flow_state *state);  /* of a run, */
    int (*resume)(struct flow_state *state); /* or where it goes on from a checkpoint */
    int (*begin)(struct flow_state *state);  /* of a step, before its forces */
    int (*settle)(struct flow_state *state); /* when x and v have moved: ends the step */
    /* Adds to the status of a step what other solves cost and how many vertices contact moved.
     * Local. */
    void (*status)(const struct flow_state *state, double status[FLOW_STATUS]);
    /* Is told if the step was accepted. Collective. */
    int (*settled)(struct flow_state *state, const double status[FLOW_STATUS], bool accepted);

    /* Thicknesses: nearer features are contacts; NULL: the mode looks for none. */
    double (*reach)(const struct model *model);

    /* Its needs. */
    bool sweeps;  /* pairs are certified on the whole way of a step, bodies by their skins, and ways
                   * are cut; else the places at its begin are looked at */
    bool carries; /* contacts hand load and slip over to the next step: they are state */

    /* In tasks. `row` changes a copy of a contact's row to that of the step. `press` finds the
     * force of tie i, a contact whose point is there; left: part of the step's time. */
    void (*row)(const struct flow *flow, const struct flow_step_args *step,
                const struct flow_contact *contact, struct contact_row *row);
    void (*press)(const struct contact_spring *spring, const struct flow_ties *ties,
                  const struct flow_view *view, double h, double left, uint32_t i,
                  const phys_vec *point, struct flow_pressed *to);
    /* The springs of its contacts in a step of h, s; NULL: they are none, and bound no step. */
    struct contact_spring (*spring)(const struct flow *flow, double h);
};

extern const struct flow_contact_mode flow_contact_certified, flow_contact_repulsion,
    flow_contact_image, flow_contact_project;

const struct flow_contact_mode *flow_contact_mode(const struct model *model);

/* The same for the mode of a run. */
int flow_contact_start(struct flow_state *state);
int flow_contact_resume(struct flow_state *state);
int flow_contact_begin(struct flow_state *state);
int flow_contact_settle(struct flow_state *state);
void flow_contact_status(const struct flow_state *state, double status[FLOW_STATUS]);
int flow_contact_settled(struct flow_state *state, const double status[FLOW_STATUS], bool accepted);

/* A stop inside a step: keeps what the step will change beside x and v; puts all back as its begin
 * had it. Collective. (stop.c) */
int flow_contact_stop_keep(struct flow_state *state);
int flow_contact_stop_restore(struct flow_state *state);

/* Bounds the fastest vibration of contacts that are springs at a vertex of mean mass: its square is
 * at most this times k / m, its damping this times c / m. Two layers that press on each other, each
 * vertex on a triangle, reach 4. */
enum { FLOW_SPRINGS_MOST = 4 };

/* Memory, a part of flow_memory_take. (memory.c) */
void flow_contact_take(struct flow_state *state);
void flow_contact_free(struct flow_state *state);

#endif
