#ifndef CLOTH_MODEL_CLOTH_H
#define CLOTH_MODEL_CLOTH_H

#include "cloth/mesh/mesh.h"
#include "cloth/physics/curve.h"
#include "cloth/physics/motion.h"
#include "cloth/physics/spring.h"
#include "cloth/physics/triangle.h"

#include <stdbool.h>
#include <stdint.h>

/* The parts of a model (model.h): materials, cloths, and the picks, pins, motions, loads, joints
 * and probes of their vertices. SI units. The model owns all that they point to. */

struct model_material {
    char *name;
    double density; /* kg/m^2, > 0; 0: all its cloths have mass_per_vertex */
    enum { MODEL_SPRINGS, MODEL_TRIANGLES } model;
    double stretch,
        weft_excess;    /* membrane moduli, N/m, >= 0: along the warp; the weft's less the warp's */
    double shear, bend; /* likewise; bend: of springs only */
    double poisson;     /* triangles: nu12, nu12 nu21 < 1 */
    struct phys_stiffening stiffening; /* triangles: beyond these two moduli */
    bool uncorrected; /* triangles: with the papers' forces (cloth/physics/triangle.h) */
    enum { MODEL_NO_BENDING, MODEL_HINGES, MODEL_QUADRATIC } bending; /* besides bend springs */
    double rigidity[2];       /* N m, of warp and weft, >= 0 */
    double damping_viscous;   /* kg/s a vertex */
    double damping_mass;      /* 1/s: a force -damping_mass * m * v */
    double damping_stiffness; /* s: along each spring, times its k; of strains and angles too */
    double damping_excess;    /* s: that of bending less damping_stiffness */
    double ea;                /* N, >= 0: force / strain of an edge without triangles */
    double limit_strain;      /* >= 0: edges stretched beyond it are pulled back, */
    double limit_stiffness;   /* by so many N/m, >= 0; 0: they are not */
    struct model_correction {
        double at,
            tolerance;   /* >= 0: edges that would be stretched beyond it have their velocities
                            corrected; > 0: the excess that may be left, of the length at rest */
        uint32_t rounds; /* at most; 0: they are not */
    } correction;
    uint32_t size[2];   /* curves of the model that lengths at rest along warp and weft are
                           multiplied by, from 1; 0: they stay */
    double friction;    /* coefficient, >= 0: of contact that is certified */
    double thickness;   /* m, of contact (contact.h); 0: that of all contact */
    double pressure;    /* Pa, of contact; 0: that of all contact */
    int both_diagonals; /* grids: shear springs along both diagonals of a cell */
};

/* A word of scenes and its meaning: the value of an enum, mostly. */
struct model_word {
    const char *word; /* NULL ends a list */
    int value;
};
static inline const char *model_word_of(const struct model_word *word, int value)
{
    while (word->word && word->value != value)
        word++;
    return word->word;
}

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

/* Holds vertices where they start, or moves them from there; or leaves them free along a slider. A
 * soft pin pulls them there, by a spring and a damper a vertex. */
struct model_pin {
    struct model_pick pick;
    uint32_t
        motion; /* number of the model's motion, from 1; 0: it does not move, or its slider does */
    uint32_t slider;           /* number of the model's slider, from 1; 0: it holds points */
    double stiffness, damping; /* soft: N/m, > 0, and kg/s, >= 0; stiffness 0: it holds */
    double *weight; /* soft: of each listed vertex, what both are multiplied by; NULL: 1 */
    uint32_t curve; /* soft: that both are multiplied by, from 1; 0: they are constant */
};

/* A line or a plane through the start of each of its vertices. */
struct model_slider {
    enum { MODEL_LINE, MODEL_PLANE } kind;
    uint32_t motion;     /* that it takes part in, from 1; 0: none */
    double direction[3]; /* of the line, or normal to the plane; of length 1 */
};

/* Key frames first .. first + n - 1 of the model's, about a point (m). */
struct model_motion {
    uint32_t first, n; /* n > 0, */
    double about[3];
    uint32_t follow; /* unless it follows an obstacle, by number from 1, whose keys these are: it
                        takes along what is there at time 0 */
};

/* The variation of a load: by keys first .. first + n - 1 of the model's; n 0: as a sine of the
 * frequency (1/s) and phase (turns). */
struct model_curve {
    uint32_t first, n;
    double frequency, phase;
};

/* A force on each picked vertex, N; or along the edges, if there are any, N a metre of rest length,
 * half of an edge's on each end. */
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

/* Moves the picked vertices from the mesh: x -> about + rotate(scale * (x - about)) + translate.
 * Then v, or the velocity before, gets + spin x (x - about). The wave is added to both. */
struct model_start {
    struct model_pick pick;
    struct mesh_transform transform;
    double about[3], spin[3], velocity[3]; /* m, rad/s, m/s */
    bool has_velocity;
    struct model_wave wave;
};

/* A fold: at rest the hinges between vertices that follow each other have this angle. */
struct model_fold {
    uint32_t n;
    uint32_t *vertices; /* of the cloth's mesh */
    bool sewn;          /* along a seam, which folds only if it is welded */
    bool open;          /* and the seam is open */
    double angle; /* degrees, above -180 and below 180; above 0: a ridge on the side from which the
                     triangles are counterclockwise */
    char *place;
};

/* An elastic along a path of vertices, each joined with the next by a spring: the parts of the path
 * have their parts of the length. It has no mass. */
struct model_band {
    struct model_pick pick; /* of vertices, in their order */
    double length;          /* m, > 0: of all of it, at rest */
    double ea, damping;     /* N, > 0: force / strain; s: times the stiffness */
    uint32_t size;          /* curve that the length is multiplied by, from 1; 0: it stays */
};

enum { MODEL_MAX_REGIONS = 64 };

enum model_seams_state {
    MODEL_SEAMS_OPEN,   /* nothing joins them */
    MODEL_SEAMS_PULLED, /* a joint of rest length 0 for each pair, whose two meet as one vertex does
                         */
    MODEL_SEAMS_WELDED, /* a weld for each pair */
    MODEL_SEAMS_STATES
};

/* How a seam is sewn. */
struct model_sewing {
    enum model_seams_state state;
    double stiffness, damping; /* pulled: N/m, > 0, and kg/s, >= 0, of each joint */
    double tolerance;          /* welded: m: partners start at most so far from each other */
    double bending;            /* welded: N m: of the hinges across it; < 0: as the materials */
};

/* A seam of a sewn cloth: pairs of vertices of its mesh that belong together, along an edge of one
 * panel and one of the same or another panel. */
struct model_seam {
    struct {
        char *panel; /* its name */
        uint32_t edge;
    } side[2];
    uint32_t n_pairs;
    uint32_t (*pair)[2]; /* of both sides, in the order of the first */
    bool reversed;       /* the second side runs from its end to its begin */
    bool unsure;         /* it may have to be the other way round */
    double distance[2];  /* m: of partners in the mean, if both sides run alike, and reversed */
    struct model_sewing sewing;
};

/* An edge of a panel: the vertices of the cloth's mesh along it, both ends included. */
struct model_border {
    char *panel; /* its name */
    uint32_t edge, n;
    uint32_t *vertices; /* n */
};

/* Seams that are sewn otherwise, by number or by their two panels; only the keys that the scene
 * gives of its sewing count. */
struct model_some_seams {
    uint32_t n;
    uint32_t *number; /* n */
    struct model_sewing sewing;
};

/* The seams of a cloth and how they are sewn: joints or welds of the model, whose pairs name their
 * seam. */
struct model_seams {
    struct model_sewing sewing; /* of all that are not named in `some` */
    uint32_t n, n_reversed, n_some;
    struct model_seam *seam;
    uint32_t *reversed; /* seams that are sewn the other way round than they came */
    struct model_some_seams *some;
};

struct model_cloth {
    char *name;
    struct mesh mesh;  /* transformed: rest lengths and masses are those of this shape, */
    struct mesh *rest; /* unless this is another, which shares all but the positions; or NULL */
    uint32_t material;
    uint32_t layer;       /* where a start is untangled: of two cloths the higher one is outside */
    uint32_t n_regions;   /* where there are others: at most MODEL_MAX_REGIONS */
    uint32_t *region;     /* materials, of panels first, which have model, diagonals and, if any,
                             bending of the cloth's */
    uint64_t *mask;       /* by vertex, which regions have it: mesh_region; NULL: there are none */
    uint32_t n_grains;    /* where the warp is turned: at most MODEL_MAX_REGIONS; */
    double (*grain)[2];   /* cosine and sine of the angle from u towards v; */
    uint64_t *grain_mask; /* by vertex, which of these have it: mesh_region; NULL: none */
    double weld;          /* m: vertices that lie so near are one, by a weld; 0: none are */
    struct mesh_low low;  /* triangles that are lower at rest than contacts reach */
    uint32_t n_unjoined;  /* vertices at another's place that are not joined with it */
    double mass_per_vertex; /* kg, replaces density * area where > 0 */
    double pressure;        /* Pa, behind its triangles less that in front */
    double velocity[3];     /* at the start, m/s */
    double *start;          /* n_vertices x 6: where they start (m) and how fast (m/s), the shape of
                               the mesh notwithstanding; NULL: at the mesh, with `velocity` */
    uint32_t n_pins, n_loads, n_masses, n_starts;
    struct model_pin *pins;
    struct model_load *loads;
    struct model_mass *masses;
    struct model_start *starts; /* one after the other, from that start */
    struct model_seams seams;
    uint32_t n_borders;
    struct model_border *borders; /* of a mesh of panels whose edges are known */
    uint32_t n_folds;
    struct model_fold *folds;
    uint32_t n_bands; /* joints of the model */
    struct model_band *bands;
    char *place, *mesh_place, *velocity_place; /* of the cloth, and of parts of it */
};

/* Vertices of a cloth's mesh, or points on edges of it. */
struct model_end {
    uint32_t cloth, n;
    uint32_t *vertices;   /* n; NULL: there are edges, */
    uint32_t (*edges)[2]; /* n, with ends a and b: the point is (1 - at) a + at b */
    double *at;           /* n, 0 to 1 */
};

/* Pairs of vertices, of two cloths or of one: vertex i of one end and vertex i of the other. Both
 * ends have as many. The other end of a joint may have points on edges. */
struct model_pairs {
    struct model_end end[2];
    char *place;
    uint32_t seam; /* of the cloth that both ends are of, from 1; 0: they are no seam's */
};

/* A spring of the scene for each pair. It has no mass. It acts in the steps that begin at `begin`
 * or later, and before `end`. */
enum { MODEL_START_LENGTH = -1 };
struct model_joint {
    struct model_pairs pairs;
    double stiffness, damping; /* N/m, > 0; kg/s, along the joint */
    double length;             /* at rest, m; MODEL_START_LENGTH: the distance at the start */
    uint32_t size;             /* curve that it is multiplied by, from 1; 0: it stays. The stiffness
                                  goes with one over it */
    double begin, end;         /* s, >= 0; end 0: never */
};

/* True if it begins or ends during the run. */
static inline bool model_is_timed(const struct model_joint *joint)
{
    return joint->begin > 0 || joint->end > 0;
}

/* True if it is a tie: timed, or ending on edges. */
static inline bool model_is_tied(const struct model_joint *joint)
{
    return model_is_timed(joint) || joint->pairs.end[1].edges;
}

/* Makes the two vertices of each pair one. */
struct model_weld {
    struct model_pairs pairs;
    double tolerance; /* m: they start at most so far from each other */
};

/* Reports on vertices after each step. */
struct model_probe {
    char *name;
    uint32_t cloth;
    struct model_pick pick;
    bool position, velocity, reaction; /* of each vertex; */
    bool contact;                      /* the force of contact on each; */
    bool total, contact_total;         /* sums of their reactions, of these forces */
    bool by_obstacle;  /* it picks no vertices: the force that an obstacle puts on all cloth */
    uint32_t obstacle; /* then: which */
};

/* The drape test of a cloth: the shadow of its border, along an axis, against the flat border. */
struct model_drape {
    uint32_t cloth;
    double axis[3]; /* of length 1 */
    double radius;  /* of the disc that carries the cloth, m; 0: there is no such test */
};

#endif
