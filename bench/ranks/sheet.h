#ifndef BENCH_RANKS_SHEET_H
#define BENCH_RANKS_SHEET_H

#include "cloth/flow/state/state.h"

/* The system of one step of a sheet that hangs, waved and moving, cut into blocks, and conjugate
 * gradients on it by plain loops: what the twin does between its messages, and, over all blocks
 * with the runtime's tree of sums, the answer to the last bit. A bench looks into the cloth's own
 * folders, as a test does. */
struct sheet {
    struct model model; /* its stop is a count of iterations */
    struct model_material material;
    struct model_cloth cloth;
    struct model_pin pin[3];
    struct flow *flow;         /* of the run that is on */
    uint32_t side;             /* vertices */
    struct flow_source source; /* blocks, and what the tables point into; */
    struct flow_tables tables; /* of all blocks, on every rank, with their memory */
    void **memory;
    size_t *halo_start, *value_start; /* a block */
    /* Block after block: rows by place, values by side of springs, r and then p of each ghost,
     * three numbers a halo row. */
    phys_vec *b, *dv, *r, *p, *q, *value, *ghost_r, *ghost_p;
    double *halo[2];
    phys_vec *answer; /* dv after so many iterations; 0: of none */
    uint32_t answered;
    double square; /* r.r then */
};

/* A sheet of side x side vertices, with a grain, made unless it is there already. 0, or what
 * serve_fail returns. */
int sheet_ready(struct sheet *sheet, uint32_t side, uint32_t grain);
/* A flow of it alone, as a run of the cloth begins: the model with two iterations and one step. */
void sheet_model(struct sheet *sheet, uint32_t side, uint32_t grain);
void sheet_free(struct sheet *sheet);
/* The rank of this process, as mpirun says it: MPI may not have begun. */
int sheet_own_rank(void);
/* Makes sheet->flow for a run, which frees it: rank 0 cuts the model, the others join. 0, or what
 * serve_fail returns. */
int sheet_flow(struct sheet *sheet);
/* Waves the start of a block in its table, and sets it moving; the same as a task: rw table. */
void sheet_wave(const struct flow_table *table, void *memory);
extern const duite_kernel sheet_wave_kernel;

const struct flow_tables *sheet_tables(const struct sheet *sheet);
/* The first row of a block, and the first number of its halo. */
size_t sheet_row(const struct sheet *sheet, uint32_t block);
size_t sheet_halo(const struct sheet *sheet, uint32_t block);

/* A task of the cloth's solve on a block: before the first pass; in a pass that reads halo[from] of
 * the neighbours and writes halo[1 - from]. */
void sheet_start(struct sheet *sheet, uint32_t block);
/* The i-th of n blocks of a pass: passes go to and fro. */
static inline uint32_t sheet_order(uint32_t n, uint32_t i, int from)
{
    return from ? n - 1 - i : i;
}
void sheet_pass(struct sheet *sheet, uint32_t block, const struct solve_scalars *scalars, int from,
                double dots[SOLVE_DOTS]);

/* Solves by so many iterations, unless the answer is there. 0, or what serve_fail returns. */
int sheet_solve(struct sheet *sheet, uint32_t count);

#endif
