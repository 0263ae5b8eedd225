/* A byte a place of the lattice in the polygon's box says whether it is taken. Its middle column is
 * in the middle of the box, so that a panel that is its own mirror image has almost such a mesh. */
#include "cloth/base/memory.h"
#include "cloth/base/vector.h"
#include "cloth/garment/detail/flat.h"

#include <stdlib.h>

static const double ROW = 0.86602540378443864676; /* a row's height, in edges */
static const double NEAR = 0.55; /* edges: places that near to the boundary make flat triangles */

struct lattice {
    double edge, origin[2];
    int64_t columns, rows;
    unsigned char *taken; /* rows x columns */
};

struct crossing { /* of a row and the boundary */
    int64_t row;
    double x;
};

static double row_y(const struct lattice *of, int64_t row)
{
    return of->origin[1] + (double)row * (ROW * of->edge);
}

/* Odd rows are half an edge further right. */
static double row_x(const struct lattice *of, int64_t row)
{
    return row % 2 ? of->origin[0] + 0.5 * of->edge : of->origin[0];
}

static int make_lattice(struct lattice *lattice, uint32_t n, const double (*loop)[2], double edge,
                        struct cloth_error *error)
{
    double low[2], high[2];
    cloth_box(n, loop, low, high);
    const double half = ceil((high[0] - low[0]) / (2 * edge)) + 1;
    const double rows = ceil((high[1] - low[1]) / (ROW * edge)) + 1;
    if (!((2 * half + 1) * rows < 0x1p28))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "edges of %g m are too short: a panel's box would have %g vertices", edge,
                          (2 * half + 1) * rows);
    const double slack = rows * ROW * edge - (high[1] - low[1]);
    lattice->edge = edge;
    lattice->columns = 2 * (int64_t)half + 1;
    lattice->rows = (int64_t)rows;
    lattice->origin[0] = 0.5 * (low[0] + high[0]) - half * edge;
    lattice->origin[1] = low[1] + 0.5 * (ROW * edge - slack);
    lattice->taken = cloth_alloc((size_t)lattice->columns * (size_t)lattice->rows, 1, error);
    return lattice->taken ? CLOTH_OK : CLOTH_E_MEMORY;
}

static int compare_crossings(const void *a, const void *b)
{
    const struct crossing *one = a, *two = b;
    if (one->row != two->row)
        return (one->row > two->row) - (one->row < two->row);
    return (one->x > two->x) - (one->x < two->x);
}

/* The rows that a segment crosses, its lower end included. */
static int cross_rows(const struct lattice *of, const double a[2], const double b[2],
                      struct cloth_list *list, struct cloth_error *error)
{
    const double *low = a[1] < b[1] ? a : b, *high = a[1] < b[1] ? b : a;
    const double height = ROW * of->edge;
    int64_t row = (int64_t)floor((low[1] - of->origin[1]) / height) - 1;
    for (row = row < 0 ? 0 : row; row < of->rows && row_y(of, row) < high[1]; row++) {
        const double y = row_y(of, row);
        if (y < low[1])
            continue;
        const struct crossing crossing = {row, low[0] + (high[0] - low[0]) *
                                                            ((y - low[1]) / (high[1] - low[1]))};
        const int code = cloth_list_put(list, &crossing, sizeof crossing, error);
        if (code)
            return code;
    }
    return CLOTH_OK;
}

static int take_inside(struct lattice *of, uint32_t n, const double (*loop)[2],
                       struct cloth_error *error)
{
    struct cloth_list list = {0};
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < n && !code; i++)
        code = cross_rows(of, loop[i], loop[(i + 1) % n], &list, error);
    const struct crossing *crossing = list.items;
    cloth_list_sort(&list, sizeof *crossing, compare_crossings);
    for (size_t i = 0; !code && i + 1 < list.n; i += 2) { /* each row has an even number */
        const int64_t row = crossing[i].row;
        const double x = row_x(of, row);
        const int64_t last = (int64_t)floor((crossing[i + 1].x - x) / of->edge);
        for (int64_t c = (int64_t)ceil((crossing[i].x - x) / of->edge); c <= last; c++)
            if (c >= 0 && c < of->columns)
                of->taken[row * of->columns + c] = 1;
    }
    free(list.items);
    return code;
}

static int64_t clamp(double x, int64_t n)
{
    return x < 0 ? 0 : x >= (double)n ? n - 1 : (int64_t)x;
}

static void leave_near(struct lattice *of, const double a[2], const double b[2])
{
    const double near = NEAR * of->edge, height = ROW * of->edge;
    const int64_t first = clamp((fmin(a[1], b[1]) - near - of->origin[1]) / height, of->rows);
    const int64_t last = clamp((fmax(a[1], b[1]) + near - of->origin[1]) / height, of->rows);
    for (int64_t row = first; row <= last; row++) {
        const double x = row_x(of, row);
        const int64_t left = clamp((fmin(a[0], b[0]) - near - x) / of->edge, of->columns);
        const int64_t right = clamp((fmax(a[0], b[0]) + near - x) / of->edge, of->columns);
        for (int64_t c = left; c <= right; c++) {
            const double place[2] = {x + (double)c * of->edge, row_y(of, row)};
            if (cloth_segment_square(place, a, b) < near * near)
                of->taken[row * of->columns + c] = 0;
        }
    }
}

static int list_taken(const struct lattice *of, struct cloth_list *places,
                      struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (int64_t row = 0; row < of->rows; row++)
        for (int64_t k = 0; k < of->columns && !code; k++) {
            const int64_t c = row % 2 ? of->columns - 1 - k : k;
            const double place[2] = {row_x(of, row) + (double)c * of->edge, row_y(of, row)};
            if (of->taken[row * of->columns + c])
                code = cloth_list_put(places, place, sizeof place, error);
        }
    return code;
}

int garment_lattice(uint32_t n, const double (*loop)[2], double edge, struct cloth_list *places,
                    struct cloth_error *error)
{
    struct lattice lattice = {0};
    int code = make_lattice(&lattice, n, loop, edge, error);
    code = code ? code : take_inside(&lattice, n, loop, error);
    for (uint32_t i = 0; i < n && !code; i++)
        leave_near(&lattice, loop[i], loop[(i + 1) % n]);
    code = code ? code : list_taken(&lattice, places, error);
    free(lattice.taken);
    return code;
}
