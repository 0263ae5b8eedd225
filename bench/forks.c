/* This file does not know its callers. */
#include "bench/forks.h"

#include <stdlib.h>
#include <string.h>

uint64_t forks_skynet(uint64_t first, uint64_t n)
{
    uint64_t sum = 0;
    if (n == 1)
        return first;
    for (uint64_t i = 0; i < FORKS_TEN; i++)
        sum += forks_skynet(first + i * (n / FORKS_TEN), n / FORKS_TEN);
    return sum;
}

uint64_t forks_skynet_calls(uint64_t n)
{
    return n == 1 ? 1 : n + forks_skynet_calls(n / FORKS_TEN);
}

/* ---- Queens ---- */

static int fits(const struct forks_board *board, unsigned column)
{
    for (unsigned row = 0; row < board->row; row++) {
        const unsigned other = board->column[row], distance = board->row - row;
        if (other == column || other + distance == column || column + distance == other)
            return 0;
    }
    return 1;
}

unsigned forks_next(const struct forks_board *board, struct forks_board *next)
{
    unsigned n = 0;
    for (unsigned column = 0; column < board->n; column++)
        if (fits(board, column)) {
            next[n] = *board;
            next[n].column[board->row] = (uint8_t)column;
            next[n++].row++;
        }
    return n;
}

uint64_t forks_queens(const struct forks_board *board)
{
    struct forks_board next[FORKS_QUEENS];
    uint64_t sum = 0;
    if (board->row == board->n)
        return 1;
    const unsigned n = forks_next(board, next);
    for (unsigned i = 0; i < n; i++)
        sum += forks_queens(&next[i]);
    return sum;
}

uint64_t forks_queens_calls(const struct forks_board *board)
{
    struct forks_board next[FORKS_QUEENS];
    uint64_t sum = 1;
    const unsigned n = board->row == board->n ? 0 : forks_next(board, next);
    for (unsigned i = 0; i < n; i++)
        sum += forks_queens_calls(&next[i]);
    return sum;
}

/* ---- Matrices ---- */

struct forks_square forks_quarter(struct forks_square square, unsigned k)
{
    const size_t half = square.n / 2, down = half * square.side;
    const size_t row = k / 2 % 2, column = k % 2, middle = k / 4;
    return (struct forks_square){square.a + row * down + middle * half,
                                 square.b + middle * down + column * half,
                                 square.c + row * down + column * half, half, square.side};
}

void forks_tile(int32_t *matrices, struct forks_square square)
{
    for (size_t i = 0; i < square.n; i++)
        for (size_t k = 0; k < square.n; k++) {
            const int32_t left = matrices[square.a + i * square.side + k];
            const int32_t *row = matrices + square.b + k * square.side;
            int32_t *out = matrices + square.c + i * square.side;
            for (size_t j = 0; j < square.n; j++)
                out[j] += left * row[j];
        }
}

void forks_multiply(int32_t *matrices, struct forks_square square)
{
    if (square.n <= FORKS_TILE)
        forks_tile(matrices, square);
    else
        for (unsigned k = 0; k < FORKS_QUARTERS; k++)
            forks_multiply(matrices, forks_quarter(square, k));
}

uint64_t forks_multiply_calls(size_t n)
{
    return n <= FORKS_TILE ? 1 : 1 + FORKS_QUARTERS * forks_multiply_calls(n / 2);
}

/* Rows of a are alike inside, columns of b are: c is n times the product of a row's and a column's
 * number. */
int32_t *forks_matrices(size_t n, struct forks_square *square)
{
    int32_t *matrices = calloc(3 * n * n, sizeof *matrices);
    for (size_t i = 0; i < n * n && matrices; i++) {
        matrices[i] = (int32_t)(i / n + 1);
        matrices[n * n + i] = (int32_t)(i % n + 1);
    }
    *square = (struct forks_square){0, n * n, 2 * n * n, n, n};
    return matrices;
}

int forks_matrices_wrong(int32_t *matrices, size_t n)
{
    int32_t *c = matrices + 2 * n * n;
    int wrong = 0;
    for (size_t i = 0; i < n * n; i++)
        wrong |= c[i] != (int32_t)(n * (i / n + 1) * (i % n + 1));
    memset(c, 0, n * n * sizeof *c);
    return wrong;
}
