#ifndef BENCH_VASSILEV_LOOPS_H
#define BENCH_VASSILEV_LOOPS_H

#include "cloth/contact/image.h"
#include "cloth/model/model.h"
#include "cloth/physics/vec.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* Vassilev's explicit iteration in six loops (Vassilev, Spanlang & Chrysanthou 2001, and his later
 * work on garments), as plain C: springs; external forces, with viscous -c v; joints of seams, and
 * cloth against cloth; velocities and collisions; velocities of springs that are too long;
 * positions. It is the rival of bench/experiments vassilev. SI units; vectors of n are by vertex of
 * the scene's meshes, cloth after cloth. */

struct loops_spring {
    uint32_t end[2];
    double stiffness, damping, length; /* N/m, kg/s, m */
};

/* A vertex, and a place on an edge: (1 - share) end[0] + share end[1]; of a joint point to point
 * both ends are one vertex. */
struct loops_joint {
    uint32_t vertex, end[2];
    double share, stiffness, damping, length;
};

/* Vertices from .. to - 1 of `order`, and the box around them, m. A patch that is not cut has no
 * children; children come after their parent. */
enum { LOOPS_PARTS = 4, LOOPS_LEAF = 16 };
struct loops_patch {
    uint32_t from, to, child[LOOPS_PARTS]; /* 0: none */
    double low[3], high[3];
};

/* Two vertices that repel each other by a force, N, on the first. */
struct loops_push {
    uint32_t vertex[2];
    double force[3];
};
struct loops_pushes {
    size_t n, room;
    struct loops_push *push;
    uint64_t all; /* of all steps */
};

struct loops {
    uint32_t n, n_springs, n_joints;
    phys_vec *x, *v, *f, *load; /* m, m/s, N, N */
    double *mass, *drag, *free; /* kg, kg/s; 1 or 0 where a pin holds */
    struct loops_spring *spring;
    struct loops_joint *joint;
    double h;     /* s */
    double limit; /* length / length at rest, beyond which springs are too long; 0: none is */
    bool maps;    /* there is a body */
    struct contact_image image;
    void *pixels;

    /* Springs by vertex, ascending: at[first[i]] ..; twice its number, + 1 where i is its end 1. */
    uint32_t *first, *at;
    phys_vec *pull; /* n_springs: on end 0, N; of several threads */
    /* Springs by colour: no two of a colour share a vertex. */
    uint32_t n_colours, *colour_first, *by_colour;

    bool self;                   /* pieces repel each other */
    double thickness, stiffness; /* m; N/m */
    uint32_t n_pieces, n_patches;
    uint32_t *order, *seam;    /* n: vertices by patch; joined vertices have the same seam */
    struct loops_patch *patch; /* the pieces' own ones come first */
};

/* The parts of a scene's model: its springs, joints, particles, the body that is met by image,
 * drawn, pieces and patches. Mesh, gravity and h are the model's. 0, or 1 after a sentence on
 * stderr: no memory; or the model has what these loops do not know. The loops belong to the caller,
 * also after a failure. */
int loops_take(struct loops *loops, const struct model *model);
void loops_free(struct loops *loops);

/* Makes the patches: the pieces, which no spring joins, cut in four again and again. order has the
 * pieces one after the other, piece k from piece[k] to piece[k + 1]. 0, or 1: no memory. */
int loops_cut(struct loops *loops, const uint32_t *piece);

/* ---- Steps ---- */

enum { LOOPS = 6, LOOPS_MOST_THREADS = 64 };

/* Threads that go through the loops together, each over a range of its own. */
struct loops_team {
    struct loops *loops;
    unsigned threads;
    uint64_t steps;
    double seconds[LOOPS];   /* of all steps */
    uint64_t pushes, inside; /* pairs that repelled each other; vertices that were in the body */

    atomic_uint arrived, round; /* at the barrier */
    atomic_ulong all_inside;
    atomic_bool failed; /* no memory for pushes */
    struct loops_pushes found[LOOPS_MOST_THREADS];
    /* Tasks: pairs of patches that are to be met, on a stack. */
    pthread_mutex_t lock;
    uint32_t (*pair)[2];
    size_t n_pairs, room;
    atomic_ulong open; /* pairs on the stack or at work */
};

/* Makes the steps. 0, or 1 after a sentence on stderr. */
int loops_run(struct loops_team *team);

/* Waits for all threads. */
void loops_wait(struct loops_team *team);

/* Finds the forces between pieces as part `thread` of the team, and adds those on its range of
 * vertices to f. */
void loops_repel(struct loops_team *team, unsigned thread, uint32_t from, uint32_t to);

#endif
