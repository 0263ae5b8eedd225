#ifndef TESTS_CLOTH_SOLVE_SYSTEM_H
#define TESTS_CLOTH_SOLVE_SYSTEM_H

#include "cloth/physics/element.h"
#include "cloth/solve/block.h"

#include <stdbool.h>

/* A small system of springs, whole as a dense matrix and cut into strips of rows as blocks see it,
 * in any format. */
enum { SYSTEM_ROWS = 64, SYSTEM_SPRINGS = 256, SYSTEM_BLOCKS = 8 };

struct system_block {
    struct solve_block matrix;
    struct solve_cut cut; /* end: own row, number of the ghost */
    uint32_t first;       /* row 0 in the whole */
    double diagonal[SYSTEM_ROWS], free[SYSTEM_ROWS];
    uint32_t row[SYSTEM_ROWS + 1], column[SYSTEM_SPRINGS], end[SYSTEM_SPRINGS][2];
    uint32_t halo[SYSTEM_ROWS];
    uint32_t n_ghosts, ghost[SYSTEM_SPRINGS];         /* rows in the whole, ascending */
    phys_vec value[3 * SYSTEM_SPRINGS + SYSTEM_ROWS]; /* of the entries, as the format has them */
    phys_vec position[SYSTEM_ROWS];
};

struct system {
    enum solve_format format; /* stays what it was */
    uint32_t n, n_springs, n_blocks;
    uint32_t end[SYSTEM_SPRINGS][2]; /* the lower row first, in order */
    phys_vec value[SYSTEM_SPRINGS], position[SYSTEM_ROWS];
    phys_vec turn[SYSTEM_SPRINGS]; /* in half storage added to the spring's N as [turn]x */
    double diagonal[SYSTEM_ROWS], free[SYSTEM_ROWS];
    bool filtered;                /* stays what it was */
    phys_vec filter[SYSTEM_ROWS]; /* if so */
    struct system_block block[SYSTEM_BLOCKS];
    double dense[3 * SYSTEM_ROWS][3 * SYSTEM_ROWS]; /* S A S + I - S */
};

/* Vertices in a line, each joined to the next; a sheet of nx x ny with one diagonal a cell.
 * Positions are drawn about the regular ones, stiffness is that of a step. */
void system_chain(struct system *system, uint32_t n, double stiffness);
void system_sheet(struct system *system, uint32_t nx, uint32_t ny, double stiffness);

/* Where three springs close a triangle, gives them turns of about a size that come to nothing in
 * every row, as elements have them; none where springs are the format. */
void system_turn(struct system *system, double size);

/* Cuts it into strips of about the same size and makes the dense matrix, when free and diagonal are
 * as they shall be. */
void system_cut(struct system *system, uint32_t n_blocks);

/* Holds rows in planes, on lines and at points; oblique: not only along axes. */
void system_filter(struct system *system, bool oblique);

/* Adds N to an entry whose first row is that of N, or, transposed, whose second is. */
static inline void system_assemble(struct phys_pair *sum, bool transposed, const double n[3][3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sum->cyclic[0][i] += n[i][i];
        sum->cyclic[1][i] += transposed ? n[j][i] : n[i][j];
        sum->cyclic[2][i] += transposed ? n[k][i] : n[i][k];
    }
}

/* Between -1 and 1. */
double system_draw(void);
void system_draw_rows(const struct system *system, phys_vec *y); /* zero where rows are
                                                                 held */
/* y = A x; x = A^-1 y by Gauss' elimination. */
void system_multiply(const struct system *system, const phys_vec *x, phys_vec *y);
void system_solve(const struct system *system, const phys_vec *y, phys_vec *x);
double system_dot(const struct system *system, const phys_vec *x, const phys_vec *y);

#endif
