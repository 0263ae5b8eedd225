/* Prints a hash of how METIS cuts a fixed graph into 96 parts: a sheet of 120 x 120 vertices, each
 * joined to its neighbours along rows, columns and one diagonal. The graph is made here, and METIS
 * is called as cloth/mesh calls it, so no code of the cloth has a part in the answer:
 * golden.sh tells by it another METIS from a change of our own cutting. */
#include <inttypes.h>
#include <metis.h>
#include <stdio.h>

enum { SIDE = 120, VERTICES = SIDE * SIDE, PARTS = 96, UNEVEN = 1 };

static idx_t start[VERTICES + 1], neighbour[6 * VERTICES], part[VERTICES];

static void sheet_make(void)
{
    static const int steps[][2] = {{0, -1}, {-1, 0}, {1, -1}, {-1, 1}, {1, 0}, {0, 1}};
    idx_t n = 0;
    for (int v = 0; v < VERTICES; v++) {
        for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
            const int x = v % SIDE + steps[k][0], y = v / SIDE + steps[k][1];
            if (x >= 0 && x < SIDE && y >= 0 && y < SIDE)
                neighbour[n++] = y * SIDE + x;
        }
        start[v + 1] = n;
    }
}

static uint64_t parts_hash(void) /* FNV-1a */
{
    uint64_t hash = 14695981039346656037U;
    for (int v = 0; v < VERTICES; v++)
        hash = (hash ^ (uint64_t)part[v]) * 1099511628211U;
    return hash;
}

int main(void)
{
    idx_t n = VERTICES, constraints = 1, parts = PARTS, cut, options[METIS_NOPTIONS];
    sheet_make();
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    options[METIS_OPTION_UFACTOR] = UNEVEN;
    if (METIS_PartGraphRecursive(&n, &constraints, start, neighbour, NULL, NULL, NULL, &parts, NULL,
                                 NULL, options, &cut, part) != METIS_OK)
        return 1;
    printf("%016" PRIx64 "\n", parts_hash());
    return 0;
}
