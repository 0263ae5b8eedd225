#ifndef CLOTH_MODEL_CONTACT_H
#define CLOTH_MODEL_CONTACT_H

#include "cloth/contact/apart.h"
#include "cloth/model/cloth.h"

/* How what touches is kept apart: a part of a model (model.h). The way of each mode through a step
 * is a row of cloth/flow/contact/mode.h. All else asks for what a mode promises, not for its name.
 */

enum model_contact_mode {
    MODEL_CONTACT_PROJECT,   /* vertices in an obstacle are put onto it after the step */
    MODEL_CONTACT_REPULSION, /* springs push apart near features when a step begins */
    MODEL_CONTACT_CERTIFIED, /* the solve knows of contacts; a step ends where all are certified */
    MODEL_CONTACT_MODES,
    MODEL_CONTACT_BEST = MODEL_CONTACT_CERTIFIED /* the default of scenes that can have it */
};

/* All of it is false where there is nothing to touch. */
struct model_promise {
    bool near;    /* near features are found, of cloths and obstacles: cloths meet cloths, too */
    bool springs; /* which springs push apart, contact.stiffness and damping theirs */
    bool apart;   /* nothing touches where the run starts, nor on the way of a step to its end */
    bool force;   /* the force of contact on each vertex is known */
};
struct model_contact_is {
    bool solves;         /* only implicit steps can: contact is in their system */
    const char *no_maps; /* why bodies cannot be met by maps; NULL: they can */
    struct model_promise promise;
};
extern const struct model_contact_is model_contact_is[MODEL_CONTACT_MODES];
/* Their names, as the schema of scenes takes them. */
extern const struct model_word model_contact_modes[];

/* The coefficient of two sides, in place of theirs. of: numbers of materials; those of obstacles
 * follow. */
struct model_rub {
    uint32_t of[2];
    double friction;
};
struct model_contact {
    enum model_contact_mode mode;
    bool assumed;     /* it is the default of the scene */
    bool idle;        /* there is nothing to touch: steps need not look */
    bool self;        /* a cloth touches itself, too */
    bool untangle;    /* a start that is not free is made so */
    bool force;       /* frames have the force of contact on each vertex */
    double thickness; /* m, > 0, of materials and obstacles that have none of their own */
    double pressure;  /* Pa, >= 0, likewise: halves the thickness; 0: nothing is compressed */
    double friction;  /* coefficient, >= 0, of materials and obstacles that have none of their own;
                         sides a and b rub on each other by sqrt(a b), */
    uint32_t n_pairs; /* unless one of these is of them: the last counts */
    struct model_rub *pairs;
    struct contact_apart apart; /* sides that do not meet */
    double stiffness;           /* springs: N/m, > 0; 0: as the mode finds */
    double damping; /* springs: >= 0; part of the critical damping of a vertex of mean mass */
};

struct model;

/* The promises of a model's steps. */
struct model_promise model_promise(const struct model *model);
/* True if frames have the force of contact. True if a probe reports it; on the rank that has the
 * probes. */
bool model_shows_contact(const struct model *model);
bool model_feels_contact(const struct model *model);
/* True if an obstacle is a body that is met by maps (cloth/contact/image.h). */
bool model_has_maps(const struct model *model);

/* True if a cloth meets another side of contact.apart: an obstacle, another cloth, or itself. On
 * the rank that has the cloths. */
bool model_meets(const struct model *model, uint32_t cloth, uint32_t other);

/* The contact of two sides, by what each of them has. Each brings half of its thickness, so both
 * are (a + b) / 2 apart. Their pressure leaves half of that, as each half is compressed by its own
 * law (cloth/contact/row.h); an obstacle is as hard as the cloth on it. On the rank that has the
 * cloths. */
struct model_sides {
    double friction;  /* by which they rub on each other */
    double thickness; /* m, > 0 */
    double pressure;  /* Pa, >= 0; 0: they are not compressed */
};
struct model_sides model_sides(const struct model *model, uint32_t cloth, uint32_t other);

const char *model_contact_name(const struct model *model);
/* The end of a sentence that refuses something: how to do without this mode; empty if the scene
 * chose it. The remedy for a start that is not free. */
const char *model_contact_cure(const struct model *model);
const char *model_start_cure(const struct model *model);

#endif
