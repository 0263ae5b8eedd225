#ifndef TESTS_CLOTH_FLOW_MODELS_H
#define TESTS_CLOTH_FLOW_MODELS_H

#include "cloth/flow/run.h"

/* Models for the tests of cloth/flow, made in C, and their runs with every frame kept. A model
 * points into the setup it was made from, which stays where it is while the model is used. */
struct setup {
    struct model model;
    struct model_material material;
    struct model_cloth cloth;
    struct contact_shape plane;
    struct model_pin pin;
    struct model_load load;
    uint32_t pinned[40], loaded[4];
};

/* A plane that stands still, through a point, with a normal of length 1. */
#define PLANE(...) ((struct contact_shape){.value = {__VA_ARGS__}})

/* A square sheet of n x n vertices and 1 m, level at y = 0, gravity, springs with damping, no pins,
 * loads or planes; implicit, h = 1 ms, 10 steps, a frame a step, relative tolerance 1e-3, blocks of
 * 30. Differences are set afterwards. */
void setup_sheet(struct setup *setup, uint32_t n);

/* Two vertices joined by an edge of 1 m that hangs down from a pin: 0.1 kg, 40 N/m, damped along
 * the spring. */
void setup_weight(struct setup *setup);

/* setup_weight with a mesh of these vertices, edges and triangles in its place. */
void setup_mesh(struct setup *setup, uint32_t n, const double *vertices, uint32_t n_edges,
                const uint32_t *edges, uint32_t n_triangles, const uint32_t *triangles);

/* setup_weight with a chain of edges in its place, from the pin at the origin on: links + 1
 * vertices of `mass` kg, each (x, y, 0) m after the one before it, whose springs have `stiffness`
 * N/m and no damping. */
void setup_chain(struct setup *setup, uint32_t links, double x, double y, double mass,
                 double stiffness);

/* Adds the masses (kg) that the vertices of a sheet of springs have: a quarter of each cell's. */
void setup_masses(const struct setup *s, double *mass);
void setup_pin(struct setup *setup, uint32_t n, const uint32_t *vertices);
void setup_load(struct setup *setup, uint32_t vertex, double x, double y, double z);
void setup_free(struct setup *setup);

/* The outcome of a run. */
struct record {
    int code;
    struct cloth_error error;
    struct flow_report report;
    size_t vertices, frames;
    double *position;       /* frames x vertices x 3 */
    double *time;           /* frames */
    _Atomic uint64_t shown; /* steps that the progress was told of; tasks read it */
    /* Set before the run: */
    uint64_t stop_after;  /* asks for a stop once so many steps were shown; 0: never */
    uint64_t break_frame; /* writing this frame fails; 0: none */
    unsigned threads;     /* 0: 1 */
    const char *balance;  /* NULL: the default */
};

/* Prepares, runs and frees; every rank has the whole record then. Starts MPI if it is not; it ends
 * with the process. Collective. */
void record_run(struct record *record, const struct model *model);
/* The same of a run that must not fail. */
void record_fine(struct record *record, const struct model *model);
/* Which rank this is, of how many. Starts MPI like record_run. */
void record_mpi(int *rank, int *ranks);
/* Component c of a vertex in a frame. */
double record_at(const struct record *record, size_t frame, size_t vertex, size_t c);
/* The largest difference of a component in any frame; both have as many of the same vertices. */
double record_farthest(const struct record *a, const struct record *b);
void record_free(struct record *record);

/* In a unit test: `setup`, which the call makes; with a `record` of its run to come. Both are freed
 * at the end of the scope. */
#define SETUP(CALL)                                                                                \
    UNIT_OWNED(setup_free) struct setup setup;                                                     \
    CALL
#define TRIAL(CALL)                                                                                \
    UNIT_OWNED(record_free) struct record record = {0};                                            \
    SETUP(CALL)

#endif
