/* Certificates of triangles against convex shapes: three numbers for a pair of directions, as
 * solid.h derives them. All is told in the core's own axes at either end of the step, where neither
 * a common velocity nor the room's origin costs digits. */
#include "cloth/contact/solid.h"

#include <math.h>

/* Operations on numbers of one size, with what they may lose together. */
static const double ROUNDING = 64 * 0x1p-53;
enum { APPROACHES = 4 };

/* ---- The solid ---- */

static void put_place(const struct contact_core *core, const struct phys_pose *pose,
                      struct contact_place *place)
{
    const phys_vec origin = {0};
    phys_pose_point(&core->axes, &origin, &place->at);
    if (pose)
        phys_pose_point(pose, &place->at, &place->at);
    for (int c = 0; c < 3; c++) {
        phys_vec along = {0};
        along[c] = 1;
        phys_pose_direction(&core->axes, &along, place->axis + c);
        if (pose)
            phys_pose_direction(pose, place->axis + c, place->axis + c);
    }
}

static double pose_size(const struct phys_pose *pose)
{
    double size = 0;
    for (int c = 0; c < 3; c++)
        size += fabs(pose->about[c]) + fabs(pose->translate[c]);
    return size;
}

void contact_solid_make(const struct contact_shape *shape, const struct contact_pose *pose,
                        struct contact_solid *solid)
{
    struct contact_core core;
    contact_kinds[shape->kind]->core(shape->value, pose->body, &core);
    *solid = (struct contact_solid){.radius = core.radius,
                                    .round = core.round,
                                    .endless = core.endless,
                                    .moves = pose->moves,
                                    .rate = pose->rate,
                                    .size = core.radius + pose_size(&core.axes)};
    for (int c = 0; c < 3; c++) {
        solid->half[c] = core.half[c];
        solid->size += core.half[c];
    }
    if (pose->moves)
        solid->size += pose_size(&pose->from) + pose_size(&pose->to);
    put_place(&core, pose->moves ? &pose->from : NULL, solid->place + CONTACT_BEGIN);
    put_place(&core, pose->moves ? &pose->to : NULL, solid->place + CONTACT_END);
}

/* ---- Three numbers ---- */

/* A triangle in the core's axes: its begin and its end as each end of the step sees them. */
struct solid_triangle {
    phys_vec from[3]; /* x, from the begin */
    phys_vec to[3];   /* y, from the end */
    double rounding;  /* m: what numbers of this triangle may be off */
};

static double most_of(const phys_vec *x)
{
    return fabs((*x)[0]) + fabs((*x)[1]) + fabs((*x)[2]);
}

static void put_triangle(const struct contact_solid *solid, const phys_vec x[3],
                         const phys_vec y[3], struct solid_triangle *triangle)
{
    double most = 0;
    PHYS_UNROLL
    for (int k = 0; k < 3; k++) {
        contact_place_own(solid->place + CONTACT_BEGIN, x + k, triangle->from + k);
        contact_place_own(solid->place + CONTACT_END, y + k, triangle->to + k);
        const double here = most_of(x + k) + most_of(y + k);
        most = here > most || here != here ? here : most;
    }
    triangle->rounding = ROUNDING * (most + solid->size);
}

/* Directions of length 1 at the begin (0) and at the end (1) of the step, as both ends see them,
 * and how far the shape reaches along them: the support functions of solid.h. */
struct solid_divide {
    phys_vec at_begin[2], at_end[2];
    double reach[3];
};

static void put_divide(const struct contact_solid *solid, const phys_vec *early,
                       const phys_vec *late, struct solid_divide *divide)
{
    const struct contact_place *begin = solid->place + CONTACT_BEGIN,
                               *end = solid->place + CONTACT_END;
    contact_place_direction(begin, early, divide->at_begin);
    contact_place_direction(begin, late, divide->at_begin + 1);
    contact_place_direction(end, early, divide->at_end);
    contact_place_direction(end, late, divide->at_end + 1);
    const phys_vec both = divide->at_end[0] + divide->at_begin[1];
    divide->reach[0] = contact_core_support(solid, divide->at_begin) + solid->radius;
    divide->reach[1] = contact_core_support(solid, &both) / 2 + solid->radius;
    divide->reach[2] = contact_core_support(solid, divide->at_end + 1) + solid->radius;
}

/* The three numbers of a corner that goes from one place to another. */
PHYS_INLINE void corner_numbers(const struct solid_divide *divide, const phys_vec *from,
                                const phys_vec *to, double number[3])
{
    number[0] = phys_dot(divide->at_begin, from) - divide->reach[0];
    number[1] = (phys_dot(divide->at_end, to) + phys_dot(divide->at_begin + 1, from)) / 2 -
                divide->reach[1];
    number[2] = phys_dot(divide->at_end + 1, to) - divide->reach[2];
}

/* What each of the numbers has to be: certificate.h has the rule. gap: that at the begin. */
static void numbers_due(double gap, double thickness, double rounding, double due[3])
{
    const double least = CONTACT_MARGIN / 2 + rounding, keep = fmin(gap / 2, 0.1 * thickness);
    due[0] = due[1] = least;
    due[2] = fmin(fmax(CONTACT_MARGIN + rounding, keep), fmax(least, gap));
}

static bool is_divided(const struct solid_divide *divide, const struct solid_triangle *triangle,
                       const double due[3])
{
    double least[3] = {INFINITY, INFINITY, INFINITY};
    for (int k = 0; k < 3; k++) {
        double number[3];
        corner_numbers(divide, triangle->from + k, triangle->to + k, number);
        for (int i = 0; i < 3; i++) /* what is not a number stays */
            least[i] = number[i] < least[i] || number[i] != number[i] ? number[i] : least[i];
    }
    return least[0] >= due[0] && least[1] >= due[1] && least[2] >= due[2];
}

/* ---- The certificate ---- */

/* Along it the triangle is farther from the shape than along any other; returns how far, m. */
static double nearest_way(const struct contact_solid *solid, enum contact_end end,
                          const phys_vec own[3], phys_vec *way)
{
    struct contact_solid_point point;
    contact_core_nearest(solid, own, &point);
    contact_place_out(solid->place + end, &point.normal, way);
    return point.gap;
}

bool contact_solid_certify(const struct contact_solid *solid, const phys_vec x[3],
                           const phys_vec y[3], double thickness)
{
    struct solid_triangle triangle;
    struct solid_divide divide;
    phys_vec begin, end;
    double due[3];
    put_triangle(solid, x, y, &triangle);
    numbers_due(nearest_way(solid, CONTACT_BEGIN, triangle.from, &begin), thickness,
                triangle.rounding, due);
    put_divide(solid, &begin, &begin, &divide);
    if (!solid->endless && is_divided(&divide, &triangle, due))
        return true;
    nearest_way(solid, CONTACT_END, triangle.to, &end);
    put_divide(solid, &end, &end, &divide);
    if (!solid->endless && is_divided(&divide, &triangle, due))
        return true;
    put_divide(solid, &begin, &end, &divide);
    return is_divided(&divide, &triangle, due);
}

/* ---- The cut ---- */

/* The part of its way that a corner may go, at most t; below 0: none will do. number: at the begin
 * and at the end of that way. */
static double corner_part(const double stays[3], const double goes[3], const double due[3],
                          double rounding, double t, bool held)
{
    double part = t;
    for (int i = 1; i < 3; i++) {
        if (stays[i] + part * (goes[i] - stays[i]) >= due[i])
            continue;
        if (held || !(stays[i] >= due[i]))
            return -1;
        const double spare = stays[i] - due[i] - 2 * rounding;
        part = spare > 0 ? fmin(part, spare / (stays[i] - goes[i])) : 0;
    }
    return part;
}

/* Cuts by two directions. stays: the end of a triangle that does not go. */
enum cut { CUT_FAILS, CUT_HOLDS, CUT_HOLDS_BELOW }; /* the last: and so does all that goes less */
static enum cut cut_by(const struct solid_divide *divide, const struct solid_triangle *triangle,
                       const phys_vec stays[3], const double due[3], unsigned held,
                       const double t[3], double part[3])
{
    bool below = true;
    for (int k = 0; k < 3; k++) {
        double still[3], goes[3];
        corner_numbers(divide, triangle->from + k, stays + k, still);
        corner_numbers(divide, triangle->from + k, triangle->to + k, goes);
        part[k] = corner_part(still, goes, due, triangle->rounding, t[k], held >> k & 1);
        if (!(part[k] >= 0 && still[0] >= due[0]))
            return CUT_FAILS;
        below = below && still[1] >= due[1] && still[2] >= due[2];
    }
    return below ? CUT_HOLDS_BELOW : CUT_HOLDS;
}

static void put_cut(const phys_vec x[3], const phys_vec y[3], const double t[3], phys_vec end[3])
{
    for (int k = 0; k < 3; k++)
        end[k] = x[k] + t[k] * (y[k] - x[k]);
}

/* Directions that may divide: the nearest at the begin; at the end, of the triangle as t has it; at
 * the end, of one that stays. */
enum { WAYS = 3, PAIRS = 5 };
static const int PAIR[PAIRS][2] = {{0, 0}, {1, 1}, {0, 1}, {2, 2}, {0, 2}};

/* The first pair of directions, that of the begin, is taken if it holds below, for every later look
 * finds it again; else that pair which cuts least. */
bool contact_solid_cut(const struct contact_solid *solid, const phys_vec x[3], const phys_vec y[3],
                       double thickness, unsigned held, double t[3])
{
    const int first = solid->endless ? 2 : 0;
    struct solid_triangle triangle, still;
    phys_vec way[WAYS], at[3];
    double most = -1, best[3] = {t[0], t[1], t[2]}, due[3];
    put_cut(x, y, t, at);
    if (contact_solid_certify(solid, x, at, thickness))
        return true;
    put_triangle(solid, x, at, &triangle);
    nearest_way(solid, CONTACT_END, triangle.to, way + 1);
    put_triangle(solid, x, x, &still);
    nearest_way(solid, CONTACT_END, still.to, way + 2);
    put_triangle(solid, x, y, &triangle);
    numbers_due(nearest_way(solid, CONTACT_BEGIN, triangle.from, way), thickness, triangle.rounding,
                due);
    for (int i = first; i < PAIRS; i++) {
        struct solid_divide divide;
        double part[3];
        put_divide(solid, way + PAIR[i][0], way + PAIR[i][1], &divide);
        const enum cut cut = cut_by(&divide, &triangle, still.to, due, held, t, part);
        const double sum = part[0] + part[1] + part[2];
        put_cut(x, y, part, at);
        if (cut == CUT_FAILS || sum <= most || !contact_solid_certify(solid, x, at, thickness))
            continue;
        most = sum;
        for (int k = 0; k < 3; k++)
            best[k] = part[k];
        if (i == first && cut == CUT_HOLDS_BELOW)
            break;
    }
    for (int k = 0; k < 3; k++)
        t[k] = best[k];
    return most >= 0;
}

/* ---- Apart ---- */

/* The direction from a shape to the point of a box that is nearest to it, or nearly. */
static void box_way(const struct contact_solid *solid, enum contact_end end, const double low[3],
                    const double high[3], phys_vec *way)
{
    const struct contact_place *place = solid->place + end;
    phys_vec at = place->at, own[3];
    for (int i = 0; i < APPROACHES; i++) {
        for (int c = 0; c < 3; c++)
            at[c] = at[c] < low[c] ? low[c] : at[c] > high[c] ? high[c] : at[c];
        contact_place_own(place, &at, own);
        own[1] = own[2] = own[0];
        if (i + 1 == APPROACHES)
            break;
        contact_core_clamp(solid, own, &at);
        contact_place_out(place, &at, &at);
        at += place->at;
    }
    nearest_way(solid, end, own, way);
}

/* Whether two directions divide a box that stays from the shape, by so much. */
static bool box_divided(const struct contact_solid *solid, const phys_vec *middle,
                        const phys_vec *half, const phys_vec *early, const phys_vec *late,
                        double reach)
{
    const phys_vec x[3] = {*middle, *middle, *middle};
    struct solid_triangle triangle;
    struct solid_divide divide;
    double number[3], wide[3] = {0};
    put_triangle(solid, x, x, &triangle);
    put_divide(solid, early, late, &divide);
    corner_numbers(&divide, triangle.from, triangle.to, number);
    for (int c = 0; c < 3; c++) {
        wide[0] += fabs((*early)[c]) * (*half)[c];
        wide[1] += fabs((*early)[c] + (*late)[c]) / 2 * (*half)[c];
        wide[2] += fabs((*late)[c]) * (*half)[c];
    }
    const double due = reach + CONTACT_MARGIN + triangle.rounding;
    return number[0] - wide[0] > due && number[1] - wide[1] > due && number[2] - wide[2] > due;
}

bool contact_solid_apart(const struct contact_solid *solid, const double low[3],
                         const double high[3], double reach)
{
    phys_vec middle = {0}, half = {0}, begin, end;
    for (int c = 0; c < 3; c++) {
        middle[c] = (low[c] + high[c]) / 2;
        half[c] = (high[c] - low[c]) / 2;
    }
    box_way(solid, CONTACT_BEGIN, low, high, &begin);
    if (!solid->endless && box_divided(solid, &middle, &half, &begin, &begin, reach))
        return true;
    if (!solid->moves && !solid->endless)
        return false;
    box_way(solid, CONTACT_END, low, high, &end);
    if (!solid->endless && box_divided(solid, &middle, &half, &end, &end, reach))
        return true;
    return box_divided(solid, &middle, &half, &begin, &end, reach);
}
