/* One small run of each kind that has fields of its own, or treats fields in its own way. */
#include "tests/cloth/flow/kinds.h"

#include <string.h>

/* Joints across the sheet and inside a block, which end some time; or a seam of them. */
enum tied { APART, JOINED, SEWN };

/* Defaults: a sheet of 6 x 6 vertices in blocks of about nine. */
static const struct kind {
    enum model_integrator integrator;
    enum model_preconditioner preconditioner;
    enum model_guess guess;
    uint32_t newton_steps;
    enum model_contact_mode contact;
    enum tied tied;
    bool corrected; /* no edge may get longer */
    bool grouped;   /* so many patches that groups solve the coarse space */
} kinds[] = {
    {.integrator = MODEL_IMPLICIT_EULER},
    {MODEL_IMPLICIT_EULER, .preconditioner = MODEL_IC0_COARSE},
    {MODEL_IMPLICIT_EULER, MODEL_IC0_COARSE, .grouped = true},
    {MODEL_IMPLICIT_EULER, MODEL_IC0_COARSE, .guess = MODEL_GUESS_PREVIOUS},
    {MODEL_IMPLICIT_EULER, .newton_steps = 3},
    {MODEL_BDF2, .newton_steps = 1},
    {.integrator = MODEL_EXPLICIT_EULER},
    {.integrator = MODEL_VERLET},
    {.integrator = MODEL_RK4},
    {MODEL_IMPLICIT_EULER, MODEL_IC0_COARSE, .tied = JOINED},
    {MODEL_IMPLICIT_EULER, MODEL_PLAIN, MODEL_GUESS_PREVIOUS, .tied = JOINED},
    {MODEL_EXPLICIT_EULER, .tied = JOINED},
    {MODEL_IMPLICIT_EULER, MODEL_IC0_COARSE, .contact = MODEL_CONTACT_CERTIFIED},
    {MODEL_IMPLICIT_EULER, MODEL_IC0_COARSE, .contact = MODEL_CONTACT_REPULSION},
    {MODEL_VERLET, .contact = MODEL_CONTACT_REPULSION},
    {MODEL_IMPLICIT_EULER, MODEL_IC0_COARSE, .tied = SEWN},
    {MODEL_IMPLICIT_EULER, MODEL_IC0_COARSE, .corrected = true},
    {MODEL_BDF2, .newton_steps = 1, .corrected = true},
    {MODEL_VERLET, .corrected = true},
};
_Static_assert(sizeof kinds / sizeof *kinds == KINDS, "the kinds of the header");

static void tie(struct model *model, uint32_t side, enum tied tied)
{
    static uint32_t from[2], to[2];
    static struct model_joint joint;
    const uint32_t last = side * side - 1;
    memcpy(from, (uint32_t[2]){1, last - 1}, sizeof from);
    memcpy(to, (uint32_t[2]){last - 1, last - 2}, sizeof to);
    joint = (struct model_joint){.pairs = {.seam = tied == SEWN,
                                           .end = {{.cloth = 0, .n = 2, .vertices = from},
                                                   {.cloth = 0, .n = 2, .vertices = to}}},
                                 .stiffness = 30,
                                 .damping = 0.01,
                                 .length = tied == SEWN ? 0 : 0.5,
                                 .end = tied == SEWN ? 0 : 100};
    model->joints = &joint;
    model->n_joints = 1;
    model->n_pulled = tied == SEWN;
}

void kind_setup(int number, struct session *s)
{
    const struct kind *kind = kinds + number;
    const uint32_t side = kind->grouped ? 17 : 6;
    *s = (struct session){0};
    setup_sheet(&s->setup, side);
    setup_pin(&s->setup, 2, (const uint32_t[]){0, side - 1});
    struct model *model = &s->setup.model;
    model->integrator = kind->integrator;
    model->preconditioner = kind->preconditioner;
    model->guess = kind->guess;
    model->newton_steps = kind->newton_steps;
    model->newton_tolerance = 1e-9;
    model->grain = kind->grouped ? 1 : 9;
    model->halving = true;
    if (kind->contact)
        model->contact = (struct model_contact){
            .mode = kind->contact, .self = true, .thickness = 0.002, .friction = 0.3};
    if (kind->tied)
        tie(model, side, kind->tied);
    if (kind->corrected) {
        s->setup.material.correction = (struct model_correction){0, 0.01, 20};
        model->correction_rounds = 20;
    }
}
