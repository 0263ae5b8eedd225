#ifndef BENCH_TILES_H
#define BENCH_TILES_H

#include <stddef.h>

/* A dense matrix of doubles by square tiles, and its factorisation: Cholesky's A = L transpose(L),
 * of which only the lower triangle is kept, or A = L U without pivoting, where L has ones on its
 * diagonal. A is made from factors of small whole numbers with a diagonal of twos, so that nothing
 * is ever rounded, and the factors must come out exactly. A tile is stored column after column:
 * tile[column * size + row]. One object code for us and every rival (bench/module.mk). */

enum tiles_kind { TILES_CHOLESKY, TILES_LU };

struct tiles {
    enum tiles_kind kind;
    size_t n;    /* tiles a side; the matrix has n x size rows, fewer than 2^20 */
    size_t size; /* rows of a tile, a multiple of TILES_ROWS */
};
enum { TILES_ROWS = 4 };

/* A task's operation: z changes, x and y are read. Names are LAPACK's. */
enum tiles_routine {
    TILES_POTRF,  /* z = L of z */
    TILES_TRSM_L, /* z = z transpose(x)^-1, x lower */
    TILES_SYRK,   /* z -= x transpose(x), all of it: as dear as TILES_GEMM_T */
    TILES_GEMM_T, /* z -= x transpose(y) */
    TILES_GETRF,  /* z = L and U of z */
    TILES_TRSM_U, /* z = z x^-1, of x the upper triangle */
    TILES_TRSM_1, /* z = x^-1 z, of x the lower triangle with ones */
    TILES_GEMM,   /* z -= x y */
    TILES_ROUTINES
};
typedef void tiles_body(const double *x, const double *y, double *z, size_t size);
/* Called through these pointers by everybody. How many tiles each reads: x and y, x, or none. */
extern tiles_body *const volatile tiles_routine[TILES_ROUTINES];
extern const unsigned tiles_reads[TILES_ROUTINES];

/* A task of the factorisation; tiles by their place, row * n + column. */
struct tiles_task {
    enum tiles_routine routine;
    size_t x, y, z;
};
/* Visits all tasks in the order of the sequential program, which looks at no tile to its right
 * (right-looking). How many there are. */
void tiles_visit(struct tiles tiles, void (*visit)(const struct tiles_task *task, void *context),
                 void *context);
double tiles_tasks(struct tiles tiles);

/* A run factorises the same matrix so many times, each time from the start; the least time counts,
 * of all but the first. */
enum { TILES_TIMES = 4 };
double tiles_least(double least, int time, double seconds);

/* True if a tile is kept at all: of Cholesky's those on the diagonal and below. */
int tiles_kept(struct tiles tiles, size_t place);
/* All tiles of A, one after the other in the order of their places: so many bytes. NULL without
 * memory; the caller frees it. */
size_t tiles_bytes(struct tiles tiles);
double *tiles_make(struct tiles tiles);
/* Factorises such tiles by a loop. */
void tiles_factor(struct tiles tiles, double *a);
/* True if a factorised tile is another than the factors say; if any of all is. */
int tiles_wrong(struct tiles tiles, size_t place, const double *tile);
int tiles_all_wrong(struct tiles tiles, const double *a);

#endif
