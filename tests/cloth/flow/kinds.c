/* One small run of each kind that has fields of its own, or treats fields in its own way. */
#include "tests/cloth/flow/kinds.h"

enum { SIDE = 6 };

static void run_of(struct session *s, enum model_integrator integrator)
{
    *s = (struct session){0};
    setup_sheet(&s->setup, SIDE);
    setup_pin(&s->setup, 2, (const uint32_t[]){0, SIDE - 1});
    s->setup.model.integrator = integrator;
    s->setup.model.grain = 9;
    s->setup.model.halving = true;
}

static void plain(struct session *s)
{
    run_of(s, MODEL_IMPLICIT_EULER);
}

static void conditioned(struct session *s)
{
    run_of(s, MODEL_IMPLICIT_EULER);
    s->setup.model.preconditioner = MODEL_IC0_COARSE;
}

/* So many patches that groups solve the coarse space. */
static void grouped(struct session *s)
{
    *s = (struct session){0};
    setup_sheet(&s->setup, 17);
    s->setup.model.preconditioner = MODEL_IC0_COARSE;
    s->setup.model.grain = 1;
}

/* Each solve begins with what the step before left. */
static void guessed(struct session *s)
{
    conditioned(s);
    s->setup.model.guess = MODEL_GUESS_PREVIOUS;
}

static void newton(struct session *s)
{
    run_of(s, MODEL_IMPLICIT_EULER);
    s->setup.model.newton_steps = 3;
    s->setup.model.newton_tolerance = 1e-9;
}

static void bdf2(struct session *s)
{
    run_of(s, MODEL_BDF2);
    s->setup.model.newton_steps = 1;
}

static void euler(struct session *s)
{
    run_of(s, MODEL_EXPLICIT_EULER);
}

static void verlet(struct session *s)
{
    run_of(s, MODEL_VERLET);
}

static void runge(struct session *s)
{
    run_of(s, MODEL_RK4);
}

/* A joint across the sheet, and one inside a block, which end some time. */
static void tie(struct session *s)
{
    static uint32_t from[] = {1, SIDE * SIDE - 2}, to[] = {SIDE * SIDE - 2, SIDE * SIDE - 3};
    static struct model_joint joint;
    joint = (struct model_joint){.pairs = {.end = {{.cloth = 0, .n = 2, .vertices = from},
                                                   {.cloth = 0, .n = 2, .vertices = to}}},
                                 .stiffness = 30,
                                 .damping = 0.01,
                                 .length = 0.5,
                                 .end = 100};
    s->setup.model.joints = &joint;
    s->setup.model.n_joints = 1;
}

static void tied(struct session *s)
{
    conditioned(s);
    tie(s);
}

static void tied_plainly(struct session *s)
{
    guessed(s);
    s->setup.model.preconditioner = MODEL_PLAIN;
    tie(s);
}

static void tied_explicitly(struct session *s)
{
    euler(s);
    tie(s);
}

/* A seam of two pairs, across the sheet and inside a block. */
static void sewn(struct session *s)
{
    static struct model_joint joint;
    conditioned(s);
    tie(s);
    joint = *s->setup.model.joints;
    joint.pairs.seam = 1;
    joint.length = joint.end = 0;
    s->setup.model.joints = &joint;
    s->setup.model.n_pulled = 1;
}

/* Over a floor that it comes to. */
static void certified(struct session *s)
{
    conditioned(s);
    s->setup.model.contact = (struct model_contact){
        .mode = MODEL_CONTACT_CERTIFIED, .self = true, .thickness = 0.002, .friction = 0.3};
}

static void repel(struct session *s)
{
    s->setup.model.contact =
        (struct model_contact){.mode = MODEL_CONTACT_REPULSION, .self = true, .thickness = 0.002};
}

static void repelled(struct session *s)
{
    conditioned(s);
    repel(s);
}

static void repelled_explicitly(struct session *s)
{
    verlet(s);
    repel(s);
}

/* Nothing may get longer. */
static void correct(struct session *s)
{
    s->setup.material.correction = (struct model_correction){0, 0.01, 20};
    s->setup.model.correction_rounds = 20;
}

static void corrected(struct session *s)
{
    conditioned(s);
    correct(s);
}

static void corrected_by_bdf2(struct session *s)
{
    bdf2(s);
    correct(s);
}

static void corrected_explicitly(struct session *s)
{
    verlet(s);
    correct(s);
}

void (*const kinds[KINDS])(struct session *) = {plain,
                                                conditioned,
                                                grouped,
                                                guessed,
                                                newton,
                                                bdf2,
                                                euler,
                                                verlet,
                                                runge,
                                                tied,
                                                tied_plainly,
                                                tied_explicitly,
                                                certified,
                                                repelled,
                                                repelled_explicitly,
                                                sewn,
                                                corrected,
                                                corrected_by_bdf2,
                                                corrected_explicitly};
