/* Each mark has vertices of its own, so the cloth's stay as they are. */
#include "cloth/app/view/marks.h"

#include "cloth/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const view_marks_names[VIEW_MARKS] = {"pins", "seams"};

static const double STUD = 0.006; /* half its width, of the largest extent of all cloths */
enum { CORNERS = 6, FACES = 8 };  /* of a stud, an octahedron */

static double extent_of(uint32_t n, const double (*at)[6])
{
    double largest = 0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t v = 0; v < n; v++) {
            low = fmin(low, at[v][k]);
            high = fmax(high, at[v][k]);
        }
        largest = fmax(largest, high - low);
    }
    return largest;
}

/* Leaves out cloths that are pinned all over. Returns how many are left. */
static uint32_t choose_pins(const struct model *model, const unsigned char *held,
                            unsigned char *marked)
{
    uint32_t v = 0, all = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const uint32_t first = v, end = v + model->cloths[c].mesh.n_vertices;
        uint32_t n = 0;
        for (; v < end; v++)
            n += marked[v] = held[v] != 0;
        if (n == end - first)
            memset(marked + first, 0, n);
        else
            all += n;
    }
    return all;
}

static void put_stud(double (*x)[3], uint32_t (*triangle)[3], uint32_t first, const double at[6],
                     double half)
{
    for (int i = 0; i < CORNERS; i++)
        for (int k = 0; k < 3; k++)
            x[i][k] = at[k] + (i / 2 == k ? i % 2 ? half : -half : 0);
    for (uint32_t i = 0; i < FACES; i++) { /* the corners of an octant, outwards */
        const uint32_t a = first + i % 2, b = first + 2 + i / 2 % 2, c = first + 4 + i / 4;
        const bool turned = (i % 2 + i / 2 % 2 + i / 4) % 2 == 0;
        memcpy(triangle[i], (uint32_t[3]){a, turned ? c : b, turned ? b : c}, sizeof *triangle);
    }
}

static int make_pins(struct mesh *mesh, const struct model *model, const double (*at)[6],
                     const unsigned char *held, struct cloth_error *error)
{
    const uint32_t n = model_first(model, model->n_cloths);
    unsigned char *marked = cloth_alloc(n, sizeof *marked, error);
    const uint32_t n_pins = marked ? choose_pins(model, held, marked) : 0;
    double(*x)[3] = cloth_alloc(CORNERS * (size_t)n_pins, sizeof *x, error);
    uint32_t(*triangle)[3] = cloth_alloc(FACES * (size_t)n_pins, sizeof *triangle, error);
    const double half = STUD * extent_of(n, at);
    uint32_t i = 0;
    for (uint32_t v = 0; v < n && !error->code; v++)
        if (marked[v]) {
            put_stud(x + CORNERS * (size_t)i, triangle + FACES * (size_t)i, CORNERS * i, at[v],
                     half);
            i++;
        }
    if (!error->code && n_pins)
        mesh_inline(mesh, CORNERS * n_pins, x[0], 0, NULL, FACES * n_pins, triangle[0], error);
    free(marked);
    free(x);
    free(triangle);
    return error->code;
}

/* Vertices 2 k and 2 k + 1 are the partners of pair k. A dart begins with a pair of one vertex. */
static uint32_t put_seam(const struct model_seam *seam, uint32_t first, const double (*at)[6],
                         double (*x)[3], uint32_t (*edge)[2])
{
    uint32_t n = 0;
    for (uint32_t k = 0; k < 2 * seam->n_pairs; k++) {
        memcpy(x[k], at[seam->pair[k / 2][k % 2]], sizeof *x);
        if (k % 2 && memcmp(x[k], x[k - 1], sizeof *x) != 0)
            memcpy(edge[n++], (uint32_t[2]){first + k - 1, first + k}, sizeof *edge);
        if (k >= 2 && memcmp(x[k], x[k - 2], sizeof *x) != 0)
            memcpy(edge[n++], (uint32_t[2]){first + k - 2, first + k}, sizeof *edge);
    }
    return n;
}

static int make_seams(struct mesh *mesh, const struct model *model, const double (*at)[6],
                      struct cloth_error *error)
{
    size_t pairs = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        for (uint32_t s = 0; s < model->cloths[c].seams.n; s++)
            pairs += model->cloths[c].seams.seam[s].n_pairs;
    double(*x)[3] = cloth_alloc(2 * pairs, sizeof *x, error);
    uint32_t(*edge)[2] = cloth_alloc(3 * pairs, sizeof *edge, error);
    uint32_t n = 0, n_edges = 0;
    for (uint32_t c = 0; c < model->n_cloths && !error->code; c++)
        for (uint32_t s = 0; s < model->cloths[c].seams.n; s++) {
            const struct model_seam *seam = model->cloths[c].seams.seam + s;
            n_edges += put_seam(seam, n, at + model_first(model, c), x + n, edge + n_edges);
            n += 2 * seam->n_pairs;
        }
    if (!error->code && n)
        mesh_inline(mesh, n, x[0], n_edges, edge[0], 0, NULL, error);
    free(x);
    free(edge);
    return error->code;
}

int view_marks_make(struct view_marks *marks, const struct model *model, const double (*at)[6],
                    const unsigned char *held, struct cloth_error *error)
{
    const int code = make_pins(marks->mesh + VIEW_MARK_PINS, model, at, held, error);
    return code ? code : make_seams(marks->mesh + VIEW_MARK_SEAMS, model, at, error);
}

uint32_t view_marks_vertices(const struct view_marks *marks)
{
    return marks->mesh[VIEW_MARK_PINS].n_vertices + marks->mesh[VIEW_MARK_SEAMS].n_vertices;
}

void view_marks_place(const struct view_marks *marks, double *position)
{
    for (int i = 0; i < VIEW_MARKS; i++) {
        const size_t n = 3 * (size_t)marks->mesh[i].n_vertices;
        if (n) /* no marks, no memory */
            memcpy(position, marks->mesh[i].position, n * sizeof *position);
        position += n;
    }
}

void view_marks_free(struct view_marks *marks)
{
    for (int i = 0; i < VIEW_MARKS; i++)
        mesh_free(marks->mesh + i);
}
