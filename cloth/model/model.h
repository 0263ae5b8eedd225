#ifndef CLOTH_MODEL_MODEL_H
#define CLOTH_MODEL_MODEL_H

#include "cloth/base/error.h"
#include "cloth/contact/shape.h"
#include "cloth/contact/soup.h"
#include "cloth/mesh/lattice.h"
#include "cloth/model/cloth.h"
#include "cloth/model/contact.h"
#include "cloth/physics/air.h"
#include "cloth/physics/curve.h"
#include "cloth/physics/motion.h"
#include "cloth/physics/spring.h"
#include "cloth/solve/local.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A simulation as a scene file or a program gives it: SI units, right-handed, +y up. The model owns
 * everything; model_free frees it. Only rank 0 holds one. cloth.h has the materials of cloths and
 * what acts on them. */

/* Fields of scientific frames beside the positions. */
struct model_hdf5 {
    bool velocity, block, rank; /* of vertices, */
    bool contact_force;         /* as these; */
    bool strain, stress;        /* of triangles */
    bool is_double;             /* numbers on the disk; else float */
    uint32_t every;             /* of all frames each k-th; 0: there are no such frames */
    uint32_t level;             /* of gzip; 0: none */
};
static inline bool model_hdf5_takes(const struct model_hdf5 *hdf5, uint64_t frame)
{
    return hdf5->every && frame % hdf5->every == 0;
}

/* A run ends when no vertex was faster than `speed` for `hold` seconds. */
struct model_rest {
    double speed, hold; /* m/s, s; speed 0: it does not end so */
};

/* A part of a scene that is run in several. */
struct model_phase {
    char *name, *place;
};

/* The integrators: number, name in scenes, and what the rest asks of it (struct model_scheme), in
 * the order of sentences that list them. docs/physics.md has their formulas. Its part of a step is
 * flow_integrator_name, in a file of cloth/flow/integrators. A new one is a row here, and that. */
#define MODEL_ALL_INTEGRATORS(X)                                                                   \
    X(MODEL_IMPLICIT_EULER, implicit_euler, .linear = true)                                        \
    X(MODEL_EXPLICIT_EULER, explicit_euler, .limit = phys_limit_euler)                             \
    X(MODEL_SYMPLECTIC_EULER, symplectic_euler, .limit = phys_limit_symplectic, .staggered = true) \
    X(MODEL_VERLET, verlet, .limit = phys_limit_verlet, .drag_free = true)                         \
    X(MODEL_RK4, rk4, .limit = phys_limit_rk4)                                                     \
    X(MODEL_BDF2, bdf2, .falls_back = true)
#define MODEL_INTEGRATOR_ID(number, name, ...) number,
#define MODEL_INTEGRATOR_ONE(...)              +1
enum model_integrator { MODEL_ALL_INTEGRATORS(MODEL_INTEGRATOR_ID) };
enum { MODEL_INTEGRATORS = 0 MODEL_ALL_INTEGRATORS(MODEL_INTEGRATOR_ONE) };

/* Properties of an integrator. */
struct model_scheme {
    const char *name; /* in scenes */
    /* The longest step, s, that lets no vibration of omega, rad/s, with damping, 1/s, grow
     * (cloth/physics/limit.h). NULL: it is implicit, as no step is too long for it. */
    double (*limit)(double omega, double damping);
    bool drag_free;  /* the drag is solved for: it does not shorten the limit */
    bool staggered;  /* x moves by the new v: v is that of half a step before x */
    bool linear;     /* its step has one system, of the state that it begins with, if it takes one
                      * Newton step: dv of the step before is a guess of its dv */
    bool falls_back; /* a step that gained energy is made again by implicit Euler */
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
/* Its parts: a row of model_conditioners. */
struct model_conditioner {
    enum solve_local local; /* of each block alone */
    bool coarse;
};
extern const struct model_conditioner model_conditioners[];

struct model {
    char *name; /* of the scene */
    uint32_t n_materials, n_cloths, n_obstacles, n_probes;
    struct model_material *materials;
    struct model_cloth *cloths;
    struct contact_shape *obstacles;
    char **obstacle_names;        /* n_obstacles, NULL: it has none; NULL: none has */
    struct contact_bodies bodies; /* of the obstacles that are bodies */
    struct model_probe *probes;
    uint32_t n_joints, n_welds;
    struct model_joint *joints;
    struct model_weld *welds;
    uint32_t n_pulled; /* joints that are of seams */
    uint32_t n_motions, n_keys;
    struct model_motion *motions;
    struct phys_key *keys; /* of each motion in ascending order, of pins and of obstacles; at time 0
                              that of a pin is no motion */
    uint32_t n_sliders;
    struct model_slider *sliders;
    uint32_t n_curves, n_curve_keys;
    struct model_curve *curves;
    struct phys_curve_key *curve_keys; /* of each curve in ascending order */
    bool sizes;                        /* lengths at rest change in time */
    double gravity[3];                 /* m/s^2 */
    struct phys_air air;
    uint32_t wind_curve; /* that the wind is multiplied by, from 1; 0: it is constant */
    struct model_contact contact;
    struct model_hdf5 hdf5;
    char *hdf5_place;
    struct model_drape drape;

    double h;                  /* s; time is an integer count of h/1024 */
    char *h_place, *fps_place; /* where fps is the default: that of end */
    double end;                /* s; N = round(end / h) steps */
    double fps;   /* frames a second; frame k follows the step that ends nearest to k / fps */
    bool halving; /* a step that fails is made again with half the length, to h/1024; */
    double stretch_growth; /* so is one in which the largest length / rest length of stretch springs
                              grows by more, */
    double stretch_limit;  /* or that ends with a larger one; 0: no limit */
    double energy_growth;  /* part of the larger of flow_source_release and the largest energy of
                              motion and strain so far; 0: energy is not guarded. A step that ends
                              above an earlier energy by more is made again: of BDF2 by implicit
                              Euler, others shorter */
    struct model_rest rest;
    double sewn; /* m: it ends when the partners of pulled seams are at most so far from each other;
                    0: it does not end so */
    enum model_integrator integrator;
    uint32_t newton_steps;   /* at most, of a step of an implicit one; 0: as 1, one linear step */
    double newton_tolerance; /* |dv| of the last <= tolerance |change of v in the step|, by mass */

    uint32_t
        correction_rounds; /* the most that any material has; 0: velocities are not corrected */

    bool energy_steps; /* the report has energies after each step */

    enum model_stop stop; /* relative: |r| <= tolerance |b|; absolute: |r| <= tolerance (kg m/s);
                             count: no test; mass_norm: the error of dv <= tolerance |dv|;
                             normalised: (h / l) sqrt(r.D^-1 r / m) <= tolerance. There m is the
                             mass of all free vertices, l the mean rest length of edges */
    double tolerance;
    uint32_t max_iterations; /* count: exactly so many */
    enum model_guess guess;  /* of dv */
    enum model_preconditioner preconditioner;
    uint32_t patches;  /* of a block, for the coarse space, at most 4; 0: as model_patches finds */
    bool exact_coarse; /* one factor of it, however many patches there are: not in scenes */
    enum solve_format format; /* of the matrix; springs alone can be SOLVE_SPRINGS */
    int full_slope; /* enum phys_slope, of the matrix; only springs know PHYS_ABSOLUTE, which is
                       PHYS_DEFINITE to all else */

    uint32_t grain; /* vertices a block; 0, until the scene is built: as model_usual_grain finds */

    uint32_t n_phases; /* of the scene; 0: it is one run. The model is that of one of them */
    struct model_phase *phases;

    uint32_t n_files;
    char **files; /* that were read, by the paths they were opened by; the first is the scene */
    uint32_t n_warnings;
    char **warnings; /* unusual things in the scene that are no errors, each with its place */
    char *settings;  /* a line `key: value` of each that the state depends on, sorted */
};

extern const struct model_scheme model_schemes[MODEL_INTEGRATORS];
static inline const struct model_scheme *model_scheme(const struct model *model)
{
    return model_schemes + model->integrator;
}
static inline bool model_is_implicit(const struct model *model)
{
    return !model_scheme(model)->limit;
}

/* True if each step solves one system, of the state that it begins with. */
static inline bool model_is_linear(const struct model *model)
{
    return model_scheme(model)->linear && model->newton_steps <= 1;
}

/* The area of a cloth at rest, m^2; while it has its mesh. */
static inline double model_area(const struct model_cloth *cloth)
{
    return mesh_surface(cloth->rest ? cloth->rest : &cloth->mesh);
}
/* The area of the disc of a drape test, m^2. */
static inline double model_disc(const struct model_drape *drape)
{
    return 3.14159265358979323846 * drape->radius * drape->radius;
}

/* True if the run finds features of cloth that are near each other or near an obstacle. */
static inline bool model_seeks(const struct model *model)
{
    return model_promise(model).near;
}

/* True if its solves are filtered by more than points: by sliders. */
static inline int model_is_filtered(const struct model *model)
{
    return model_is_implicit(model) && model->n_sliders;
}

static inline bool model_follows(const struct model *model)
{
    bool follows = false;
    for (uint32_t i = 0; i < model->n_motions; i++)
        follows = follows || model->motions[i].follow;
    return follows;
}

/* True if an obstacle moves: two of its key frames differ. */
bool model_obstacles_move(const struct model *model);
/* True if a pin or an obstacle moves after a time, s. */
bool model_moves_after(const struct model *model, double time);

/* True if pins change the velocities that a step begins with. */
static inline int model_is_driven(const struct model *model)
{
    return model->n_motions || model->n_sliders;
}

/* True if its steps are judged by the energy that they gain: implicit ones, if nothing does work on
 * the cloth. */
bool model_is_guarded(const struct model *model);

/* True if the state before a step is copied: the step may be made again, or velocities are
 * corrected. */
static inline bool model_keeps(const struct model *model)
{
    return model->halving || model->correction_rounds || model_promise(model).apart ||
           (model_scheme(model)->falls_back && model_is_guarded(model));
}

/* True if x and v stay as an explicit integrator ended a step: no contact, pin or correction
 * changes them, and no force comes or goes with contact. */
static inline bool model_leaves_ends(const struct model *model)
{
    return !model->n_obstacles && !model_is_driven(model) && !model_seeks(model) &&
           !model->correction_rounds;
}

/* True if its solves stop by norms of the masses. */
static inline int model_stops_by_norms(const struct model *model)
{
    return model->stop == MODEL_STOP_MASS_NORM || model->stop == MODEL_STOP_NORMALISED;
}

/* The number of patches of a block for the coarse space; 1 without one. The default is four, or two
 * if one factor can then take all patches: one task solves with it after those of the blocks. */
enum { MODEL_ONE_FACTOR = 256 }; /* more patches are solved by groups (cloth/solve/levels.h) */
uint32_t model_patches(const struct model *model, uint32_t n_blocks);

/* The grain of so many vertices in all, where a scene gives none. It makes as many blocks as one
 * factor takes with four patches each. It is at least 1000, since springs between blocks are
 * computed on both sides, and at most 4000, which leaves blocks for many cores. */
uint32_t model_usual_grain(uint32_t n_vertices);

/* Their names in scenes. */
extern const struct model_word model_integrators[];
extern const struct model_word model_preconditioners[];

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

/* The stiffness damping of bending, s, >= 0. */
static inline double model_damping_bending(const struct model_material *material)
{
    return material->damping_stiffness + material->damping_excess;
}

static inline int model_has_air(const struct model *model)
{
    return model->air.density > 0;
}

/* True if a cloth is made of triangles. True if its mass and air are those of its grid's cells:
 * springs know no triangles. */
static inline bool model_has_triangles(const struct model *model, const struct model_cloth *cloth)
{
    return model->materials[cloth->material].model == MODEL_TRIANGLES;
}
static inline bool model_has_cells(const struct model *model, const struct model_cloth *cloth)
{
    return cloth->mesh.grid_nx && !model_has_triangles(model, cloth);
}

/* The material, by number, that n > 0 vertices of the cloth's mesh share: that of the last region
 * that has them all, else the cloth's. */
static inline uint32_t model_material_of(const struct model_cloth *cloth, size_t n,
                                         const uint32_t *vertex)
{
    const int region = mesh_region(cloth->mask, n, vertex);
    return region < 0 ? cloth->material : cloth->region[region];
}

/* Cosine and sine of the angle that turns the warp at n > 0 vertices of the cloth's mesh; NULL: it
 * is not turned. */
static inline const double *model_grain(const struct model_cloth *cloth, size_t n,
                                        const uint32_t *vertex)
{
    const int grain = mesh_region(cloth->grain_mask, n, vertex);
    return grain < 0 ? NULL : cloth->grain[grain];
}

/* One after the other, all materials of a cloth: i = 0 is its own, then those of its regions. */
static inline const struct model_material *
model_material(const struct model *model, const struct model_cloth *cloth, uint32_t i)
{
    return model->materials + (i ? cloth->region[i - 1] : cloth->material);
}

/* The moduli that a material, by number, gives its cloths, for small strains. Triangles have their
 * own in any mesh; springs have them from the cells of grids. NaN: unknown, as no cloth has the
 * material, its mesh is no grid, or cloths whose cells make different ones. Before the meshes are
 * freed. */
struct mesh_elastic model_elastic(const struct model *model, uint32_t material);

/* True if the cloth or a region of it is of the material, by number. */
bool model_has_material(const struct model_cloth *cloth, uint32_t material);

/* Finds whether cloths that have the material, by number, have triangles, and edges without
 * triangles. */
void model_parts(const struct model *model, uint32_t material, bool *triangles, bool *edges);

/* True if a point is in or on the box between two corners, lower and upper. */
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
/* The air as it blows at a time, s. */
struct phys_air model_air_at(const struct model *model, double time);

/* The first vertex of a cloth, of those of all cloths. */
static inline uint32_t model_first(const struct model *model, uint32_t cloth)
{
    uint32_t first = 0;
    for (uint32_t c = 0; c < cloth; c++)
        first += model->cloths[c].mesh.n_vertices;
    return first;
}

/* The soup of a model's cloths and bodies, with its welds; to be freed in any case. Errors: as of
 * contact_soup_make. While there are meshes. */
int model_soup(const struct model *model, struct contact_soup *soup, struct cloth_error *error);

/* Makes a cloth start as `start` says (model_cloth.start, which the cloth then owns), whatever it
 * had before. */
void model_start_at(struct model_cloth *cloth, double *start);

/* "seam 3 of cloth 'shirt' (edge 1 of panel 'front', edge 0 of panel 'back')". seam: from 0. On the
 * rank that has the cloths. */
enum { MODEL_SEAM_NAME = 280 };
void model_name_seam(const struct model_cloth *cloth, uint32_t seam, char text[MODEL_SEAM_NAME]);

/* Frees what the model owns and clears it. */
void model_free(struct model *model);

/* cloth_fail with CLOTH_E_INPUT and the place before the sentence, if there is one. */
int model_fail(const char *place, struct cloth_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
