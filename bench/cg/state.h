#ifndef BENCH_CG_STATE_H
#define BENCH_CG_STATE_H

#include "bench/serve.h"
#include "cloth/solve/system.h"

/* A state: a system to be solved, kept in a file from run to run, with what tells right answers
 * from wrong ones. Its hash is that of the system: equal wherever it is made. For us, the twin and
 * the rivals; vectors are n x 3 in the numbering of the input. */
struct state {
    char name[40];
    struct solve_system system; /* x, v: at which it was made; dv: the solution */
    double *after;              /* dv after `count` iterations of conjugate gradients from zero */
    uint32_t count;
    uint32_t *order; /* n: the vertices in the order of the cloth's blocks, for locality */
    uint64_t hash;
};

/* The folder of the states is named by this variable of the environment. */
#define STATE_FOLDER "DUITE_BENCH_STATES"

/* The N of a name with _hN: the step in ms; 0: the name tells none. */
double state_step(const char *name);
/* NAME.state in the folder; 0, or what serve_fail returns. A file with the system of another step
 * than its name tells is refused. */
int state_read(struct state *state, const char *name);
int state_write(const struct state *state);
void state_free(struct state *state);
/* The state that the request names (state=), unless it is there already. */
int state_ready(struct state *state, struct serve_request *request);

/* |a - b| / |b| in the mass norm over what is not held. */
double state_distance(const struct state *state, const double *a, const double *b);
/* |b - A dv| / |b|, by plain loops; NAN after serve_fail. */
double state_left(const struct state *state, const double *dv);
/* 0 if dv is what so many iterations come to, which must be state->count; else what serve_fail
 * returns. */
int state_check(const struct state *state, uint32_t count, const double *dv);

/* Conjugate gradients by plain loops: so many iterations from zero; and, with 3x3 blocks as a
 * preconditioner, until the true residual is 1e-12 of the right side or gets no smaller. 0, or what
 * serve_fail returns. */
int state_iterate(const struct solve_system *system, uint32_t count, double *dv);
int state_solve(const struct solve_system *system, double *dv);

/* Bytes that an iteration has to move at least: dv, r and p read and written, q written and read,
 * three doubles a vertex each; diagonal and filter; four doubles and a column a spring. */
#define STATE_BYTES_FORMULA "8 x 24 + 2 x 8 a vertex and 4 x 8 + 4 a spring"
double state_bytes(const struct state *state);

#endif
