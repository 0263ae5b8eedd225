/* Rounds of remeshing and measuring: the error of a girth goes into the factor on its widths, until
 * the mesh itself has the girths. */
#include "cloth/mannequin/mannequin.h"
#include "cloth/base/sets.h"
#include "cloth/base/vector.h"
#include "cloth/mannequin/detail/surface.h"
#include "cloth/mesh/slice.h"

#include <stdlib.h>

enum { SHAPING = 8, FITTING = 12, COLLAPSES = 4 };
static const double CELL = 0.02;   /* m: of the lattice */
static const double CLOSE = 0.002; /* a girth is as asked for, as a part of it */
static const double NEAR = 0.005;  /* it is near enough after all rounds */

struct making {
    struct mannequin asked; /* for a figure of MANNEQUIN_HEIGHT */
    double factor[MANNEQUIN_GIRTHS], girth[MANNEQUIN_GIRTHS];
    struct figure figure;
    struct surface surface; /* has the error */
};

static void remesh(struct surface *surface, double edge)
{
    surface_split(surface, edge);
    for (int i = 0; i < COLLAPSES; i++)
        surface_collapse(surface, edge);
    surface_turn(surface);
    surface_smooth(surface);
}

/* ---- Girths: loops of the half's sections ---- */

/* By set: its length, and the sum of its places weighted by length. */
static void sum_loops(const struct slice *slice, double (*sum)[4])
{
    for (uint32_t s = 0; s < slice->n; s++) {
        const struct slice_segment *segment = slice->segment + s;
        double *to = sum[cloth_sets_root(slice->set, s)];
        for (int c = 0; c < 3; c++)
            to[c] += 0.5 * segment->length * (segment->end[0].place[c] + segment->end[1].place[c]);
        to[3] += segment->length;
    }
}

/* The length of the loop whose middle is nearest to a point; one that is open goes on in the mirror
 * image. */
static double nearest_loop(const struct slice *slice, const double (*sums)[4],
                           const double point[3], bool half)
{
    double best = INFINITY, length = 0;
    for (uint32_t s = 0; s < slice->n; s++) {
        const double *sum = sums[s];
        if (!(sum[3] > 0))
            continue;
        const double middle[3] = {half ? 0 : sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
        const double far = cloth_distance(middle, point) + (half ? sum[0] / sum[3] : 0);
        if (far < best) {
            best = far;
            length = half ? 2 * sum[3] : sum[3];
        }
    }
    return length;
}

/* The length of the section of a measure, of both halves; 0: there is none. */
static double find_girth(const struct surface *surface, uint32_t measured)
{
    double point[3], normal[3], (*sum)[4] = NULL, girth = 0;
    const struct slice_mesh mesh = {surface->m, (const double(*)[3])surface->x,
                                    (const uint32_t(*)[3])surface->triangle};
    struct slice slice;
    figure_section(surface->figure, measured, point, normal);
    if (!slice_make(&slice, &mesh, normal, cloth_dot(point, normal), surface->error))
        sum = cloth_alloc(slice.n, sizeof *sum, surface->error);
    if (sum) {
        sum_loops(&slice, sum);
        girth = nearest_loop(&slice, (const double(*)[4])sum, point, measured < MANNEQUIN_THIGH);
    }
    free(sum);
    slice_free(&slice);
    return girth;
}

/* Measures, and corrects the factors. Returns the measure that is furthest from its wanted value;
 * MANNEQUIN_GIRTHS: all are close. */
static uint32_t fit(struct making *making)
{
    double most = CLOSE;
    uint32_t worst = MANNEQUIN_GIRTHS;
    for (uint32_t i = 0; i < MANNEQUIN_GIRTHS; i++) {
        making->girth[i] = find_girth(&making->surface, i);
        const double ratio = making->asked.girth[i] / fmax(making->girth[i], 1e-3);
        if (fabs(ratio - 1) > most) {
            most = fabs(ratio - 1);
            worst = i;
        }
        making->factor[i] *= fmin(1.1, fmax(0.9, ratio));
    }
    if (worst < MANNEQUIN_GIRTHS)
        figure_make(&making->figure, making->factor);
    return worst;
}

/* Returns the worst measure, as `fit` does. */
static uint32_t make_half(struct making *making)
{
    const struct cloth_error *error = making->surface.error;
    uint32_t worst = MANNEQUIN_GIRTHS;
    figure_make(&making->figure, making->factor);
    surface_march(&making->surface, CELL);
    for (int i = 0; i < SHAPING && !error->code; i++) {
        remesh(&making->surface, making->asked.edge);
        if (!error->code && i >= SHAPING / 2)
            worst = fit(making);
    }
    for (int i = 0; i < FITTING && !error->code; i++) {
        surface_project(&making->surface);
        worst = fit(making);
        if (worst == MANNEQUIN_GIRTHS)
            break;
    }
    return worst;
}

/* ---- Both halves ---- */

/* Heights in the half, and the factors on lengths: heights, others. */
struct fitting {
    double low, high, scale[2];
};

static struct fitting fit_height(const struct surface *half, double height)
{
    double low = INFINITY, high = -INFINITY;
    for (uint32_t v = 0; v < half->n; v++) {
        low = fmin(low, half->x[v][1]);
        high = fmax(high, half->x[v][1]);
    }
    return (struct fitting){low, high, {height / (high - low), height / MANNEQUIN_HEIGHT}};
}

/* Vertices of the other half follow in the order of the first; those of the middle are shared.
 * image: of each vertex; x and corner: filled. Returns how many vertices there are. */
static uint32_t mirror(const struct surface *half, const struct fitting *fitting, double height,
                       uint32_t *image, double *x, uint32_t *corner)
{
    uint32_t n = half->n;
    for (uint32_t v = 0; v < half->n; v++) {
        const double y = (half->x[v][1] - fitting->low) / (fitting->high - fitting->low);
        image[v] = half->middle[v] ? v : n++;
        for (int side = 0; side < 2; side++) {
            double *to = x + 3 * (size_t)(side ? image[v] : v);
            to[0] = half->middle[v] ? 0 : fitting->scale[1] * (side ? -1 : 1) * half->x[v][0];
            to[1] = height * y; /* exactly height at the top */
            to[2] = fitting->scale[1] * half->x[v][2];
        }
    }
    for (uint32_t t = 0; t < half->m; t++)
        for (uint32_t k = 0; k < 3; k++) {
            corner[3 * t + k] = half->triangle[t][k];
            corner[3 * (half->m + t) + k] = image[half->triangle[t][2 - k]];
        }
    return n;
}

/* The whole mesh, and its rig unless NULL. */
static void make_whole(const struct making *making, struct mesh *mesh, struct mannequin_rig *rig)
{
    const struct surface *half = &making->surface;
    struct cloth_error *error = half->error;
    const struct fitting fitting = fit_height(half, making->asked.height);
    uint32_t *image = cloth_alloc(half->n, sizeof *image, error);
    double *x = cloth_alloc(6 * (size_t)half->n, sizeof *x, error);
    uint32_t *corner = cloth_alloc(6 * (size_t)half->m, sizeof *corner, error);
    if (!error->code) {
        const uint32_t n = mirror(half, &fitting, making->asked.height, image, x, corner);
        mesh_inline(mesh, n, x, 0, NULL, 2 * half->m, corner, error);
    }
    if (!error->code && rig)
        rig_make(rig, mesh, half, making->asked.edge, fitting.low, fitting.scale);
    free(image);
    free(x);
    free(corner);
}

static void check_girths(const struct making *making, uint32_t worst, double scale)
{
    const double is = making->girth[worst], asked = making->asked.girth[worst];
    if (fabs(is / asked - 1) > NEAR)
        cloth_fail(making->surface.error, CLOTH_E_INPUT,
                   "a %s of %g m does not go with the other girths: this figure gets one of %.3g "
                   "m; change it, or those beside it",
                   mannequin_measures[worst].name, asked * scale, is * scale);
}

int mannequin_make(struct mesh *mesh, struct mannequin_rig *rig, const struct mannequin *mannequin,
                   double girth[MANNEQUIN_GIRTHS], struct cloth_error *error)
{
    struct cloth_error own = {0};
    struct making making = {.asked = *mannequin,
                            .surface = {.figure = &making.figure, .error = &own}};
    *mesh = (struct mesh){0};
    if (rig)
        *rig = (struct mannequin_rig){0};
    if (mannequin_complete(&making.asked, error))
        return error->code;
    const double scale = making.asked.height / MANNEQUIN_HEIGHT;
    making.asked.edge /= scale;
    for (uint32_t i = 0; i < MANNEQUIN_GIRTHS; i++) {
        making.asked.girth[i] /= scale;
        making.factor[i] = making.asked.girth[i] / mannequin_measures[i].girth;
    }
    const uint32_t worst = make_half(&making);
    if (!own.code && worst < MANNEQUIN_GIRTHS)
        check_girths(&making, worst, scale);
    if (!own.code)
        make_whole(&making, mesh, rig);
    for (uint32_t i = 0; i < MANNEQUIN_GIRTHS && girth; i++)
        girth[i] = making.girth[i] * scale;
    surface_free(&making.surface);
    if (!own.code)
        return CLOTH_OK;
    mesh_free(mesh);
    if (rig)
        mannequin_rig_free(rig);
    return cloth_fail(error, own.code, "%s", own.text);
}
