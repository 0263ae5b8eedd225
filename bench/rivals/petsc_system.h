#ifndef BENCH_RIVALS_PETSC_SYSTEM_H
#define BENCH_RIVALS_PETSC_SYSTEM_H

#include "bench/cg/state.h"

#include <petscksp.h>

/* Any call of PETSc that fails ends the run; what PETSc says of it is on standard error. */
#define TRY(call)                                                                                  \
    do {                                                                                           \
        if (call)                                                                                  \
            return serve_fail("PETSc failed: %s", #call);                                          \
    } while (0)

enum format { AIJ, AIJ_PLAIN, BAIJ, SBAIJ, FORMATS };
enum order { NATURAL, BLOCKS, CUTHILL, ORDERS };

/* A system as PETSc has it: filtered, rows of a rank in one range. */
struct system {
    Mat a;
    Vec b, x;
    uint32_t *place;     /* of each vertex; n */
    uint32_t first, end; /* places of this rank */
};

/* Makes a state's system in a format and an order. 0, or what serve_fail returns; then what is
 * there of it is to be freed. Collective. */
int system_make(struct system *system, const struct state *state, enum format format,
                enum order order);
void system_free(struct system *system);

#endif
