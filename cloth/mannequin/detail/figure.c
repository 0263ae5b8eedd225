/* Sums and products in a fixed order; the nearest part melts with those near it, one after the
 * other. */
#include "cloth/mannequin/detail/figure.h"
#include "cloth/base/vector.h"

static const double FAR = 0.09;   /* m: further from the box of a part it does not count */
static const double SOLE = 0.012; /* m: how round the edges of soles are */
static const double PAIR = 0.03;  /* m: how near a part melts with its mirror image */
static const double STEP = 1e-4;  /* m: of differences */
static const double THIN = 0.42;  /* edges are this part of a section's least half width */
static const double SHORT = 0.55; /* but not below this part of the longest */

/* ---- One part ---- */

/* The values at t, from the first station to the last one. */
static void values_at(const struct figure_part *part, double t, double value[FIGURE_VALUES])
{
    uint32_t k = 0;
    while (k + 2 < part->n && t > part->station[k + 1].t)
        k++;
    const struct figure_station *a = &part->station[k], *b = a + 1;
    const double width = b->t - a->t, u = (t - a->t) / width, r = 1 - u;
    for (int i = 0; i < FIGURE_VALUES; i++)
        value[i] = r * r * ((1 + 2 * u) * a->value[i] + u * width * a->slope[i]) +
                   u * u * ((3 - 2 * u) * b->value[i] - r * width * b->slope[i]);
}

static double limit(double t, double low, double high)
{
    return t < low ? low : t > high ? high : t;
}

/* The distance by the first order of the implicit function: 1 on the surface. *least: half the
 * section's least width. */
static double part_distance(const struct figure_part *part, const double x[3], double *least)
{
    const double from[3] = {x[0] - part->origin[0], x[1] - part->origin[1], x[2] - part->origin[2]};
    const double along = cloth_dot(from, part->axis);
    const double t = limit(along, part->station[0].t, part->station[part->n - 1].t);
    double v[FIGURE_VALUES];
    values_at(part, t, v);
    const double a = cloth_dot(from, part->side) - v[0], b = cloth_dot(from, part->front) - v[1];
    const double width[3] = {v[2], b > 0 ? v[3] : v[4], along < t ? part->cap[0] : part->cap[1]};
    const double p[3] = {a / width[0], b / width[1], (along - t) / width[2]};
    const double flat = p[0] * p[0] + p[1] * p[1];
    const double full =
        flat > 0 ? 1 - part->square * (4 * p[0] * p[0] * p[1] * p[1]) / (flat * flat) : 1;
    const double q = sqrt(flat * full * full + p[2] * p[2]);
    const double g[3] = {p[0] / width[0], p[1] / width[1], p[2] / width[2]};
    const double slope = sqrt(cloth_dot(g, g));
    *least = fmin(v[2], 0.5 * (v[3] + v[4]));
    return slope > 1e-9 ? q * (q - 1) / slope : -*least;
}

/* How far x is from the part's box. */
static double box_distance(const struct figure_part *part, const double x[3])
{
    double square = 0;
    for (int c = 0; c < 3; c++) {
        const double out = fmax(0, fmax(part->low[c] - x[c], x[c] - part->high[c]));
        square += out * out;
    }
    return sqrt(square);
}

/* ---- Their union ---- */

/* The smooth minimum of Quilez: twice differentiable, and the minimum where they differ by more
 * than k. */
static double melt(double a, double b, double k)
{
    const double h = fmax(0, k - fabs(a - b)) / k;
    return fmin(a, b) - h * h * h * k / 6;
}

/* The distance from a part, and from its mirror image if it has one; FAR or more: it is too far to
 * count. */
static double pair_distance(const struct figure_part *part, const double x[3], double *least)
{
    const double here[3] = {fabs(x[0]), x[1], x[2]}, there[3] = {-here[0], x[1], x[2]};
    double other, d = box_distance(part, here);
    if (d < FAR)
        d = part_distance(part, here, least);
    if (!part->paired || here[0] > FAR)
        return d;
    const double e = box_distance(part, there);
    return e < FAR ? melt(d, part_distance(part, there, &other), PAIR) : d;
}

struct figure_near figure_near(const struct figure *figure, const double x[3])
{
    struct figure_near near = {.least = 1};
    double sum = 1, nearest = 1;
    for (uint32_t i = 0; i < figure->n; i++) {
        double thin = 1;
        const double d = pair_distance(&figure->part[i], x, &thin);
        if (d < nearest) {
            nearest = d;
            near.least = thin;
            near.part = i;
        }
        sum = melt(sum, d, figure->part[i].blend);
    }
    near.distance = -melt(-sum, x[1], SOLE);
    return near;
}

double figure_gradient(const struct figure *figure, const double x[3], double gradient[3])
{
    const double d = figure_near(figure, x).distance;
    for (int c = 0; c < 3; c++) {
        double y[3] = {x[0], x[1], x[2]};
        y[c] += STEP;
        gradient[c] = (figure_near(figure, y).distance - d) / STEP;
    }
    return d;
}

double figure_edge(const struct figure *figure, const double x[3], double edge)
{
    return limit(THIN * figure_near(figure, x).least, SHORT * edge, edge);
}
