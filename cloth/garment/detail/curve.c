/* Lengths are sums by Gauss and Legendre's rule over short parts: for the edges of panels that is
 * as exact as doubles are. */
#include "cloth/garment/detail/curve.h"
#include "cloth/base/vector.h"
#include "cloth/physics/curve.h"

#include <string.h>

static const double TWO_PI = 6.283185307179586;

/* The angle, in turns from 0 to 0.25, whose sine and cosine are given: by Newton's method. */
static double angle_of(double sine, double cosine)
{
    double turns = sine < cosine ? sine / TWO_PI : 0.25 - cosine / TWO_PI;
    for (int i = 0; i < 8; i++) {
        double c, s;
        phys_turn(360 * turns, &c, &s);
        turns += (sine * c - cosine * s) / TWO_PI;
    }
    return turns;
}

/* The arc goes counterclockwise where it is on the right of its chord. */
static void make_arc(struct curve *curve, const struct garment_edge *edge)
{
    const double *a = curve->point[0], *b = curve->point[3];
    const double chord[2] = {b[0] - a[0], b[1] - a[1]};
    const double half = 0.5 * sqrt(cloth_square_2(b, a));
    const double radius = fmax(edge->radius, half);
    const double height =
        sqrt((radius - half) * (radius + half)); /* of the centre over the chord */
    const double side = (edge->right == edge->large ? -height : height) / (2 * half);
    const double angle = angle_of(half / radius, height / radius); /* half of the smaller arc's */
    const double turns = edge->large ? 1 - 2 * angle : 2 * angle;
    curve->centre[0] = 0.5 * (a[0] + b[0]) - side * chord[1];
    curve->centre[1] = 0.5 * (a[1] + b[1]) + side * chord[0];
    curve->turns = edge->right ? turns : -turns;
    curve->length = TWO_PI * turns * radius;
}

static void arc_at(const struct curve *curve, double t, double place[2])
{
    const double x = curve->point[0][0] - curve->centre[0];
    const double y = curve->point[0][1] - curve->centre[1];
    double c, s;
    phys_turn(360 * (curve->turns * t), &c, &s);
    place[0] = curve->centre[0] + (x * c - y * s);
    place[1] = curve->centre[1] + (x * s + y * c);
}

/* Begin, points and end of a polyline. */
static const double *way_at(const struct curve *curve, uint32_t i)
{
    return i == 0 ? curve->point[0] : i > curve->n_points ? curve->point[3] : curve->points[i - 1];
}

static void polyline_at(const struct curve *curve, double part, double place[2])
{
    double left = part * curve->length, length = 0;
    uint32_t i = 0;
    for (; i <= curve->n_points; i++) {
        length = sqrt(cloth_square_2(way_at(curve, i + 1), way_at(curve, i)));
        if (left <= length || i == curve->n_points)
            break;
        left -= length;
    }
    const double t = length > 0 ? fmin(left / length, 1) : 0;
    for (int k = 0; k < 2; k++)
        place[k] = (1 - t) * way_at(curve, i)[k] + t * way_at(curve, i + 1)[k];
}

/* The derivative of a Bezier curve. */
static void velocity(const struct curve *curve, double t, double v[2])
{
    const double r = 1 - t;
    for (int k = 0; k < 2; k++) {
        const double a = curve->point[0][k], b = curve->point[1][k], c = curve->point[2][k],
                     d = curve->point[3][k];
        v[k] = curve->kind == GARMENT_CUBIC
                   ? 3 * (r * r * (b - a) + 2 * r * t * (c - b) + t * t * (d - c))
                   : 2 * (r * (b - a) + t * (d - b));
    }
}

static double speed(const struct curve *curve, double t)
{
    double v[2];
    velocity(curve, t, v);
    return sqrt(v[0] * v[0] + v[1] * v[1]);
}

/* Gauss and Legendre's places from -1 to 1, and their weights. */
static const double AT[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                             0.9061798459386640};
static const double WEIGHT[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                 0.4786286704993665, 0.2369268850561891};

/* The length from t to u, which are near to each other. */
static double length_between(const struct curve *curve, double t, double u)
{
    const double middle = 0.5 * (t + u), half = 0.5 * (u - t);
    double sum = WEIGHT[2] * speed(curve, middle);
    for (int i = 3; i < 5; i++)
        sum +=
            WEIGHT[i] * (speed(curve, middle - half * AT[i]) + speed(curve, middle + half * AT[i]));
    return half * sum;
}

void curve_make(struct curve *curve, const struct garment_panel *panel, uint32_t edge)
{
    const struct garment_edge *of = &panel->edge[edge];
    *curve = (struct curve){
        .kind = of->curve, .n_points = of->n_points, .points = (const double(*)[2])of->point};
    memcpy(curve->point[0], panel->corner[of->end[0]], sizeof curve->point[0]);
    memcpy(curve->point[1], of->control[0], sizeof curve->point[1]);
    memcpy(curve->point[2], of->control[1], sizeof curve->point[2]);
    memcpy(curve->point[3], panel->corner[of->end[1]], sizeof curve->point[3]);
    if (of->curve == GARMENT_CIRCLE) {
        make_arc(curve, of);
        return;
    }
    if (of->curve == GARMENT_STRAIGHT || of->curve == GARMENT_POLYLINE) {
        for (uint32_t i = 0; i <= curve->n_points; i++)
            curve->length += sqrt(cloth_square_2(way_at(curve, i + 1), way_at(curve, i)));
        return;
    }
    for (int k = 0; k < CURVE_PARTS; k++)
        curve->before[k + 1] = curve->before[k] + length_between(curve, (double)k / CURVE_PARTS,
                                                                 (double)(k + 1) / CURVE_PARTS);
    curve->length = curve->before[CURVE_PARTS];
}

void curve_at(const struct curve *curve, double t, double place[2])
{
    const double r = 1 - t;
    if (t <= 0 || t >= 1) { /* the corners exactly */
        memcpy(place, curve->point[t <= 0 ? 0 : 3], sizeof curve->point[0]);
        return;
    }
    if (curve->kind == GARMENT_CIRCLE) {
        arc_at(curve, t, place);
        return;
    }
    if (curve->kind == GARMENT_POLYLINE) {
        polyline_at(curve, t, place);
        return;
    }
    for (int k = 0; k < 2; k++) {
        const double a = curve->point[0][k], b = curve->point[1][k], c = curve->point[2][k],
                     d = curve->point[3][k];
        place[k] = curve->kind == GARMENT_STRAIGHT ? r * a + t * d
                   : curve->kind == GARMENT_CUBIC
                       ? r * r * r * a + 3 * r * r * t * b + 3 * r * t * t * c + t * t * t * d
                       : r * r * a + 2 * r * t * b + t * t * d;
    }
}

/* By Newton's method, and by halves where it would leave what it has found. */
static double parameter_at(const struct curve *curve, double length)
{
    int part = 0;
    while (part < CURVE_PARTS - 1 && curve->before[part + 1] <= length)
        part++;
    const double begin = (double)part / CURVE_PARTS;
    double low = begin, high = (double)(part + 1) / CURVE_PARTS, t = 0.5 * (low + high);
    for (int i = 0; i < 40; i++) {
        const double off = curve->before[part] + length_between(curve, begin, t) - length;
        low = off <= 0 ? t : low;
        high = off <= 0 ? high : t;
        const double next = t - off / speed(curve, t);
        if (fabs(off) <= 1e-15 * curve->length)
            break;
        t = next > low && next < high ? next : 0.5 * (low + high);
    }
    return t;
}

void curve_at_length(const struct curve *curve, double part, double place[2])
{
    const bool bezier = curve->kind == GARMENT_QUADRATIC || curve->kind == GARMENT_CUBIC;
    const bool inside = part > 0 && part < 1;
    curve_at(curve, bezier && inside ? parameter_at(curve, part * curve->length) : part, place);
}

double curve_turning(const struct curve *curve)
{
    double place[CURVE_PARTS + 1][2], sum = 0;
    if (curve->kind == GARMENT_STRAIGHT)
        return 0;
    for (int k = 0; k <= CURVE_PARTS; k++)
        curve_at(curve, (double)k / CURVE_PARTS, place[k]);
    for (int k = 1; k < CURVE_PARTS; k++) {
        double sine, cosine;
        const double squares = cloth_angle(place[k - 1], place[k], place[k + 1], &sine, &cosine);
        if (squares > 0)
            sum += fabs(sine) / sqrt(squares);
    }
    return sum;
}

/* Half the integral of x dy - y dx along the curve, m^2: those of a counterclockwise loop are its
 * area. Gauss and Legendre's rule is exact for a Bezier curve; an arc has its circle's segment
 * beside the chord. */
static double curve_area(const struct curve *curve)
{
    const double *begin = curve->point[0];
    double sum = 0;
    if (curve->kind == GARMENT_QUADRATIC || curve->kind == GARMENT_CUBIC) {
        for (int i = 0; i < 5; i++) {
            double x[2], v[2];
            curve_at(curve, 0.5 + 0.5 * AT[i], x);
            velocity(curve, 0.5 + 0.5 * AT[i], v);
            sum += 0.5 * WEIGHT[i] * (x[0] * v[1] - x[1] * v[0]);
        }
        return 0.5 * sum;
    }
    for (uint32_t i = 0; i <= curve->n_points; i++) {
        const double *a = way_at(curve, i), *b = way_at(curve, i + 1);
        sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    if (curve->kind == GARMENT_CIRCLE) {
        const double x = begin[0] - curve->centre[0], y = begin[1] - curve->centre[1];
        double c, s;
        phys_turn(360 * curve->turns, &c, &s);
        sum += 0.5 * (x * x + y * y) * (TWO_PI * curve->turns - s);
    }
    return sum;
}

double garment_panel_area(const struct garment_panel *panel)
{
    double sum = 0;
    for (uint32_t e = 0; e < panel->n_edges; e++) {
        struct curve curve;
        curve_make(&curve, panel, e);
        sum += curve_area(&curve);
    }
    return sum;
}

double garment_edge_length(const struct garment_panel *panel, uint32_t edge)
{
    struct curve curve;
    curve_make(&curve, panel, edge);
    return curve.length;
}
