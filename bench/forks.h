#ifndef BENCH_FORKS_H
#define BENCH_FORKS_H

#include <stddef.h>
#include <stdint.h>

/* The results of tasks that fork and wait, in sizes of the public comparison of runtimes
 * (github.com/tzcnt/runtime-benchmarks) or less: here as calls, whose results check the tasks'. */

/* Skynet: a call for several numbers makes ten for a tenth of them each and adds what they return;
 * one for a single number returns it. n: a power of ten. */
enum { FORKS_TEN = 10 };
uint64_t forks_skynet(uint64_t first, uint64_t n);
uint64_t forks_skynet_calls(uint64_t n);

/* Queens on n x n squares: a call makes one for each square of the next row where no queen takes
 * another, and adds what they return; on a full board it returns 1. */
enum { FORKS_QUEENS = 16 };
struct forks_board {
    uint8_t n, row; /* rows with a queen come before it */
    uint8_t column[FORKS_QUEENS];
};
/* The boards with a queen more, at most n; their number. */
unsigned forks_next(const struct forks_board *board, struct forks_board *next);
uint64_t forks_queens(const struct forks_board *board);
uint64_t forks_queens_calls(const struct forks_board *board);

/* c += a b, squares of n numbers a side: a call makes four for quarters of c, waits for them, and
 * makes four more; squares of FORKS_TILE are multiplied. n: FORKS_TILE times a power of two. */
enum { FORKS_TILE = 32, FORKS_QUARTERS = 8 };
struct forks_square {
    size_t a, b, c; /* of their first numbers, among the three matrices */
    size_t n, side; /* numbers of the square and of a matrix a side */
};
/* The k-th call that it makes. */
struct forks_square forks_quarter(struct forks_square square, unsigned k);
void forks_tile(int32_t *matrices, struct forks_square square);
void forks_multiply(int32_t *matrices, struct forks_square square);
uint64_t forks_multiply_calls(size_t n);
/* Three matrices, c zero, to be freed; NULL without memory. And whether c is not a b; makes it zero
 * again. */
int32_t *forks_matrices(size_t n, struct forks_square *square);
int forks_matrices_wrong(int32_t *matrices, size_t n);

#endif
