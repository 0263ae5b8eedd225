#ifndef CLOTH_MODEL_MODEL_H
#define CLOTH_MODEL_MODEL_H

#include "cloth/base/error.h"
#include "cloth/contact/shape.h"
#include "cloth/mesh/elastic.h"
#include "cloth/mesh/mesh.h"
#include "cloth/physics/air.h"
#include "cloth/physics/curve.h"
#include "cloth/physics/motion.h"
#include "cloth/physics/spring.h"
#include "cloth/solve/format.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What is to be simulated, as a scene file or a program says it: SI units, right-handed, +y up.
 * Everything is owned by the model and freed by model_free. Rank 0 alone holds one. */

struct model_material {
    char *name;
    double density; /* kg/m^2, > 0; 0: all its cloths have mass_per_vertex */
    enum { MODEL_SPRINGS, MODEL_TRIANGLES } model;
    double stretch, weft_excess; /* membrane moduli, N/m, >= 0: along the warp, and what that along
                                    the weft is more */
    double shear, bend;          /* likewise; bend: of springs only */
    double poisson;              /* triangles: nu12, nu12 nu21 < 1 */
    bool uncorrected;            /* triangles: with the papers' forces (cloth/physics/triangle.h) */
    enum { MODEL_NO_BENDING, MODEL_HINGES, MODEL_QUADRATIC } bending; /* besides bend springs */
    double rigidity[2];       /* N m, of warp and weft, >= 0 */
    double damping_viscous;   /* kg/s a vertex */
    double damping_mass;      /* 1/s: a force -damping_mass * m * v */
    double damping_stiffness; /* s: along each spring, times its k; of strains and angles too */
    double damping_excess;    /* s: what it is of bending less that */
    double ea;                /* N, >= 0: force / strain of an edge without triangles */
    double limit_strain;      /* >= 0: edges stretched beyond it are pulled back, */
    double limit_stiffness;   /* by so many N/m, >= 0; 0: they are not */
    double friction;          /* coefficient, >= 0: of contact that is certified */
    int both_diagonals;       /* grids: shear springs along both diagonals of a cell */
};

/* A word of scenes, and what it means: the value of an enum, mostly. */
struct model_word {
    const char *word; /* NULL ends a list */
    int value;
};

/* A `place` is where the scene says a thing, for messages: "scene.yaml:4:11", or an option; NULL:
 * it does not say. */

/* Chooses vertices of a cloth. */
struct model_pick {
    enum { MODEL_PICK_VERTICES, MODEL_PICK_NEAREST, MODEL_PICK_BOX } kind;
    uint32_t n_vertices;
    uint32_t *vertices; /* of the cloth's mesh */
    double point[3];    /* nearest: its nearest vertex after the transform, the first of equals, */
    double radius;      /* and all that are not farther than this, m; 0: it alone */
    double box[2][3];   /* box: every vertex inside or on it after the transform */
    char *place;
};

/* Holds vertices where they start, or moves them from there; or leaves them free along a slider. */
struct model_pin {
    struct model_pick pick;
    uint32_t
        motion; /* number of the model's motion, from 1; 0: it does not move, or its slider does */
    uint32_t slider; /* number of the model's slider, from 1; 0: it holds points */
};

/* Through each vertex that it has, where it starts: a line, or a plane. */
struct model_slider {
    enum { MODEL_LINE, MODEL_PLANE } kind;
    uint32_t motion;     /* that it takes part in, from 1; 0: none */
    double direction[3]; /* of the line, or normal to the plane; of length 1 */
};

/* Key frames first .. first + n - 1 of the model's, about a point (m). */
struct model_motion {
    uint32_t first, n; /* n > 0 */
    double about[3];
};

/* How a load varies: by keys first .. first + n - 1 of the model's; n 0: as a sine of the
 * frequency (1/s) and phase (turns). */
struct model_curve {
    uint32_t first, n;
    double frequency, phase;
};

/* A force: on each of the picked vertices, newton; or, if there are edges, along these,
 * newton a metre of the length at rest, half of an edge's on each end. */
struct model_load {
    struct model_pick pick; /* a vertex that stands twice gets it twice; edges: its place alone */
    uint32_t n_edges;
    uint32_t (*edges)[2]; /* of the cloth's mesh */
    double force[3];
    uint32_t curve; /* that it is multiplied by, from 1; 0: it is constant */
};

/* More mass, on each of the picked vertices. */
struct model_mass {
    struct model_pick pick; /* a vertex that stands twice gets it twice */
    double mass;            /* kg, > 0 */
};

/* A plane wave over the mesh: sin(2 pi (vector . (p - about) + phase)), p where the mesh has a
 * vertex, times each of the other two. */
struct model_wave {
    double vector[3], phase;          /* waves a metre, waves */
    double translate[3], velocity[3]; /* m, m/s */
};

/* How the picked vertices start, if not where the mesh has them: x -> about + rotate(scale * (x -
 * about)) + translate; then v, or what it was before, + spin x (x - about). The wave is added to
 * both. */
struct model_start {
    struct model_pick pick;
    struct mesh_transform transform;
    double about[3], spin[3], velocity[3]; /* m, rad/s, m/s */
    bool has_velocity;
    struct model_wave wave;
};

enum { MODEL_MAX_REGIONS = 64 };

struct model_cloth {
    char *name;
    struct mesh mesh;  /* transformed: rest lengths and masses are those of this shape, */
    struct mesh *rest; /* unless this is another, which shares all but the positions; or NULL */
    uint32_t material;
    uint32_t n_regions; /* where there are others: at most MODEL_MAX_REGIONS */
    uint32_t
        *region;    /* materials, which have model, diagonals and, if any, bending of the cloth's */
    uint64_t *mask; /* by vertex, which regions have it: mesh_region; NULL: there are none */
    double mass_per_vertex; /* kg, replaces density * area where > 0 */
    double velocity[3];     /* at the start, m/s */
    double *start;          /* n_vertices x 6: where they start (m) and how fast (m/s), the shape of
                               the mesh notwithstanding; NULL: at the mesh, with `velocity` */
    uint32_t n_pins, n_loads, n_masses, n_starts;
    struct model_pin *pins;
    struct model_load *loads;
    struct model_mass *masses;
    struct model_start *starts;                /* one after the other, from that start */
    char *place, *mesh_place, *velocity_place; /* of the cloth, and of parts of it */
};

/* Vertices of a cloth's mesh. */
struct model_end {
    uint32_t cloth, n;
    uint32_t *vertices;
};

/* Pairs of vertices, of two cloths or of one: vertex i of one end and vertex i of the other, of
 * which there are as many. */
struct model_pairs {
    struct model_end end[2];
    char *place;
};

/* A spring of the scene for each pair. It has no mass. It acts in the steps that begin at `begin`
 * or later, and before `end`. */
enum { MODEL_START_LENGTH = -1 };
struct model_joint {
    struct model_pairs pairs;
    double stiffness, damping; /* N/m, > 0; kg/s, along the joint */
    double length;             /* at rest, m; MODEL_START_LENGTH: the distance at the start */
    double begin, end;         /* s, >= 0; end 0: never */
};

/* Whether it comes or goes while the run is on. */
static inline bool model_is_timed(const struct model_joint *joint)
{
    return joint->begin > 0 || joint->end > 0;
}

/* Makes the two vertices of each pair one. */
struct model_weld {
    struct model_pairs pairs;
    double tolerance; /* m: they start at most so far from each other */
};

/* What is reported of vertices after each step. */
struct model_probe {
    char *name;
    uint32_t cloth;
    struct model_pick pick;
    bool position, velocity, reaction; /* of each vertex */
    bool total;                        /* the sum of their reactions */
};

/* A run ends when no vertex was faster than `speed` for `hold` seconds. */
struct model_rest {
    double speed, hold; /* m/s, s; speed 0: it does not end so */
};

/* Explicit ones come first. docs/physics.md has their formulas. */
enum model_integrator {
    MODEL_EXPLICIT_EULER,   /* x by the velocity before the step */
    MODEL_SYMPLECTIC_EULER, /* x by the velocity after it */
    MODEL_VERLET,           /* velocity Verlet, drag solved for in the first half step */
    MODEL_MIDPOINT,         /* the explicit midpoint method */
    MODEL_RK4,              /* the classical Runge-Kutta method */
    MODEL_IMPLICIT_EULER,
    MODEL_BDF2 /* begins with implicit Euler, also after contact or a change of h */
};
enum { MODEL_INTEGRATORS = MODEL_BDF2 + 1 };
enum model_contact_mode {
    MODEL_CONTACT_PROJECT,  /* vertices in an obstacle are put onto it after the step */
    MODEL_CONTACT_CERTIFIED /* the solve knows of contacts; a step ends where all are certified */
};
struct model_contact {
    enum model_contact_mode mode;
    bool self;        /* a cloth touches itself, too */
    double thickness; /* m, > 0: of cloth that touches something, half of it on each side */
    double friction;  /* coefficient, >= 0, of materials and obstacles that have none of their own;
                         sides a and b rub on each other by sqrt(a b) */
};
enum model_stop {
    MODEL_STOP_RELATIVE,
    MODEL_STOP_ABSOLUTE,
    MODEL_STOP_COUNT,
    MODEL_STOP_MASS_NORM,
    MODEL_STOP_NORMALISED
};
enum model_guess {
    MODEL_GUESS_AUTO, /* as PREVIOUS in steps shorter than MODEL_GUESS_BELOW, else as ZERO */
    MODEL_GUESS_ZERO,
    MODEL_GUESS_PREVIOUS /* from the best multiple of the last step's dv; of one linear step only */
};
#define MODEL_GUESS_BELOW 0.01 /* s */
enum model_preconditioner {
    MODEL_PLAIN,     /* none */
    MODEL_JACOBI,    /* inverses of the 3 x 3 blocks on the diagonal */
    MODEL_IC0,       /* incomplete Cholesky of each block */
    MODEL_COARSE,    /* Jacobi and a coarse space, affine on each patch of a block */
    MODEL_IC0_COARSE /* IC(0) and that coarse space */
};

struct model {
    char *name; /* of the scene */
    uint32_t n_materials, n_cloths, n_obstacles, n_probes;
    struct model_material *materials;
    struct model_cloth *cloths;
    struct contact_shape *obstacles;
    struct contact_bodies bodies; /* of the obstacles that are bodies */
    struct model_probe *probes;
    uint32_t n_joints, n_welds;
    struct model_joint *joints;
    struct model_weld *welds;
    uint32_t n_motions, n_keys;
    struct model_motion *motions;
    struct phys_key *keys; /* of each motion in ascending order, of pins and of obstacles; at time 0
                              that of a pin is no motion */
    uint32_t n_sliders;
    struct model_slider *sliders;
    uint32_t n_curves, n_curve_keys;
    struct model_curve *curves;
    struct phys_curve_key *curve_keys; /* of each curve in ascending order */
    double gravity[3];                 /* m/s^2 */
    struct phys_air air;
    uint32_t wind_curve; /* that the wind is multiplied by, from 1; 0: it is constant */
    struct model_contact contact;

    double h;                  /* s; time is an integer count of h/1024 */
    char *h_place, *fps_place; /* where fps is the default: that of end */
    double end;                /* s; N = round(end / h) steps */
    double fps;   /* frames a second; frame k follows the step that ends nearest to k / fps */
    bool halving; /* a step that fails is made again with half the length, to h/1024; */
    double stretch_growth; /* so is one in which the largest length / rest length of stretch springs
                              grows by more, */
    double stretch_limit;  /* or that ends with a larger one; 0: no limit */
    double energy_growth;  /* part of flow_source_release or the largest energy of motion and strain
                              so far: where that is guarded, a step that ends so much above an
                              earlier energy is made again, by BDF2 by implicit Euler, else shorter;
                              0: by any */
    struct model_rest rest;
    enum model_integrator integrator;
    uint32_t newton_steps;   /* at most, of a step of an implicit one; 0: as 1, one linear step */
    double newton_tolerance; /* |dv| of the last <= tolerance |change of v in the step|, by mass */

    bool energy_steps; /* the report has energies after each step */

    enum model_stop stop; /* relative: |r| <= tolerance |b|; absolute: |r| <= tolerance (kg m/s);
                             count: no test; mass_norm: the error of dv <= tolerance |dv|;
                             normalised: (h / l) sqrt(r.D^-1 r / m) <= tolerance, of all free
                             vertices, m their mass, l the mean length of edges at rest */
    double tolerance;
    uint32_t max_iterations; /* count: exactly so many */
    enum model_guess guess;  /* of dv */
    enum model_preconditioner preconditioner;
    uint32_t patches; /* of a block, for the coarse space, at most 4; 0: as model_patches finds */
    enum solve_format format; /* of the matrix; springs alone can be SOLVE_SPRINGS */
    int own_filter;           /* solves are filtered by the program's flow_filter, too */
    int full_slope; /* enum phys_slope, of the matrix; only springs know PHYS_ABSOLUTE, which is
                       PHYS_DEFINITE to all else */

    uint32_t grain; /* vertices a block */

    uint32_t n_files;
    char **files; /* that were read, by the paths they were opened by; the first is the scene */
    uint32_t n_warnings;
    char **warnings; /* what is unusual about the scene but no error, each with its place */
};

/* Whether its steps solve a linear system. */
static inline int model_is_implicit(const struct model *model)
{
    return model->integrator >= MODEL_IMPLICIT_EULER;
}

/* Whether its steps end where all contacts are certified. */
static inline bool model_certifies(const struct model *model)
{
    return model_is_implicit(model) && model->contact.mode == MODEL_CONTACT_CERTIFIED;
}

/* Whether its solves are filtered by more than points: by sliders or the program. */
static inline int model_is_filtered(const struct model *model)
{
    return model_is_implicit(model) && (model->n_sliders || model->own_filter);
}

/* Whether an obstacle moves: two key frames of it differ. */
bool model_obstacles_move(const struct model *model);
/* Whether a pin or an obstacle moves after a time, s. */
bool model_moves_after(const struct model *model, double time);

/* Whether pins have a part in the velocities that a step begins with. */
static inline int model_is_driven(const struct model *model)
{
    return model->n_motions || model->n_sliders;
}

/* Whether its steps are judged by the energy that they gain: implicit ones, where nothing does work
 * on the cloth. */
bool model_is_guarded(const struct model *model);

/* Whether a step may be made again, from a copy of the state before it. */
static inline bool model_keeps(const struct model *model)
{
    return model->halving || model_certifies(model) ||
           (model->integrator == MODEL_BDF2 && model_is_guarded(model));
}

/* Whether its solves stop by norms of the masses. */
static inline int model_stops_by_norms(const struct model *model)
{
    return model->stop == MODEL_STOP_MASS_NORM || model->stop == MODEL_STOP_NORMALISED;
}

/* Whether its solves have a coarse space, and how many patches a block has in it. Without a number
 * of the model's own these are as many as keep the coarse system small against the blocks' work:
 * one task solves it after theirs. */
bool model_is_coarse(const struct model *model);
uint32_t model_patches(const struct model *model, uint32_t n_blocks);

/* Their names in scenes. */
extern const struct model_word model_integrators[];
const char *model_integrator_name(enum model_integrator integrator);

/* The shape at rest of a cloth; the modulus along the weft. */
static inline const struct mesh *model_rest(const struct model_cloth *cloth)
{
    return cloth->rest ? cloth->rest : &cloth->mesh;
}
static inline double model_weft(const struct model_material *material)
{
    return material->stretch + material->weft_excess;
}

/* The moduli of springs, without regions. */
static inline struct mesh_moduli model_moduli(const struct model_material *m)
{
    return (struct mesh_moduli){m->stretch,     m->shear, m->bend, m->both_diagonals,
                                m->weft_excess, NULL,     m->ea};
}

/* The stiffness damping of what resists bending, s, >= 0. */
static inline double model_damping_bending(const struct model_material *material)
{
    return material->damping_stiffness + material->damping_excess;
}

static inline int model_has_air(const struct model *model)
{
    return model->air.density > 0;
}

/* Whether a cloth is made of triangles; whether its mass and air are those of its grid's cells, not
 * of triangles: of springs, which know no triangles. */
static inline bool model_has_triangles(const struct model *model, const struct model_cloth *cloth)
{
    return model->materials[cloth->material].model == MODEL_TRIANGLES;
}
static inline bool model_has_cells(const struct model *model, const struct model_cloth *cloth)
{
    return cloth->mesh.grid_nx && !model_has_triangles(model, cloth);
}

/* The material, by number, of what n > 0 vertices of the cloth's mesh have in common: that of the
 * last region that has them all, else the cloth's. */
static inline uint32_t model_material_of(const struct model_cloth *cloth, size_t n,
                                         const uint32_t *vertex)
{
    const int region = mesh_region(cloth->mask, n, vertex);
    return region < 0 ? cloth->material : cloth->region[region];
}

/* One after the other, all materials of a cloth: i = 0 is its own, then those of its regions. */
static inline const struct model_material *
model_material(const struct model *model, const struct model_cloth *cloth, uint32_t i)
{
    return model->materials + (i ? cloth->region[i - 1] : cloth->material);
}

/* The moduli that a material, by number, gives to the cloths that have it, for small strains.
 * Triangles have their own in any mesh; springs have them from the cells of grids. NaN: none is
 * known, since no cloth has the material, or a mesh that is no grid, or cloths whose cells make
 * different ones. Before the meshes are freed. */
struct mesh_elastic model_elastic(const struct model *model, uint32_t material);

/* Whether cloths that have the material, by number, have triangles, or edges without triangles. */
void model_parts(const struct model *model, uint32_t material, bool *triangles, bool *edges);

/* Whether a point is in the box between two corners, lower and upper, or on it. */
static inline bool model_in_box(const double *x, const double box[2][3])
{
    bool in = true;
    for (int i = 0; i < 3; i++)
        in = in && x[i] >= box[0][i] && x[i] <= box[1][i];
    return in;
}

/* The factor of a curve, by number, at a time, s; of 0: 1. Its largest size at any time; and the
 * time, s, from which on it is constant: INFINITY for a sine. */
double model_curve_at(const struct model *model, uint32_t curve, double time);
double model_curve_max(const struct model *model, uint32_t curve);
double model_curve_end(const struct model *model, uint32_t curve);

/* The first vertex of a cloth, of those of all cloths. */
static inline uint32_t model_first(const struct model *model, uint32_t cloth)
{
    uint32_t first = 0;
    for (uint32_t c = 0; c < cloth; c++)
        first += model->cloths[c].mesh.n_vertices;
    return first;
}

/* Frees what the model owns and clears it. */
void model_free(struct model *model);

/* cloth_fail with CLOTH_E_INPUT and the place before the sentence, if there is one. */
int model_fail(const char *place, struct cloth_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
