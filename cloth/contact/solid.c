/* Certificates of triangles against convex shapes: three numbers for a pair of directions, as
 * solid.h derives them. All is told in the core's own axes at either end of the step, where neither
 * a common velocity nor the room's origin costs digits. */
#include "cloth/contact/solid_core.h"

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
    for (int i = 0; i < 3; i++) {
        phys_vec along = {0};
        along[i] = 1;
        phys_pose_direction(&core->axes, &along, &along);
        if (pose)
            phys_pose_direction(pose, &along, &along);
        for (int c = 0; c < 3; c++)
            place->axis[i][c] = along[c];
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
    struct contact_lanes from, to;
    double rounding; /* m: what numbers of this triangle may be off; not finite where it is not */
};

PHYS_INLINE double lanes_size(const struct contact_lanes *own)
{
    phys_vec sum = {0};
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const contact_mask sign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
        sum += (phys_vec)((contact_mask)own->c[c] & sign);
    }
    return phys_lanes(&sum);
}

PHYS_INLINE void triangle_of(const struct contact_solid *solid, const phys_vec x[3],
                             const phys_vec y[3], struct solid_triangle *triangle)
{
    contact_core_lanes(solid->place + CONTACT_BEGIN, x, &triangle->from);
    contact_core_lanes(solid->place + CONTACT_END, y, &triangle->to);
    triangle->rounding =
        ROUNDING * (lanes_size(&triangle->from) + lanes_size(&triangle->to) + solid->size);
}

/* Directions n0 of the begin (early) and n1 of the end (late), in the core's axes at the begin [0]
 * and at the end [1], and how far the shape reaches along them: the support functions of solid.h.
 */
struct solid_divide {
    double early[2][3], late[2][3];
    double reach[3];
};

/* A direction of one end in the core's axes, as the other end sees it. */
PHYS_INLINE void other_end(const struct contact_solid *solid, enum contact_end end,
                           const double way[3], double there[3])
{
    double out[3] = {way[0], way[1], way[2]};
    if (solid->moves)
        contact_way_out(solid->place + end, way, out);
    for (int c = 0; c < 3; c++)
        there[c] = solid->moves ? contact_inner(solid->place[!end].axis[c], out) : out[c];
}

/* Of a direction in the core's axes at the begin and one at the end. */
PHYS_INLINE void divide_by(const struct contact_solid *solid, const double early[3],
                           const double late[3], struct solid_divide *divide)
{
    double both[3];
    other_end(solid, CONTACT_BEGIN, early, divide->early[1]);
    other_end(solid, CONTACT_END, late, divide->late[0]);
    for (int c = 0; c < 3; c++) {
        divide->early[0][c] = early[c];
        divide->late[1][c] = late[c];
        both[c] = divide->early[1][c] + divide->late[0][c];
    }
    divide->reach[0] = contact_core_support(solid, early) + solid->radius;
    divide->reach[1] = contact_core_support(solid, both) / 2 + solid->radius;
    divide->reach[2] = contact_core_support(solid, late) + solid->radius;
}

/* The three numbers of each corner, by lanes. */
PHYS_INLINE void corner_numbers(const struct solid_divide *divide, const struct contact_lanes *from,
                                const struct contact_lanes *to, phys_vec number[3])
{
    phys_vec before, after;
    contact_heights(from, divide->early[0], number);
    contact_heights(from, divide->late[0], &before);
    contact_heights(to, divide->early[1], &after);
    contact_heights(to, divide->late[1], number + 2);
    number[0] -= divide->reach[0];
    number[1] = (before + after) / 2 - divide->reach[1];
    number[2] -= divide->reach[2];
}

/* What each of the numbers has to be: certificate.h has the rule. gap: that at the begin. */
PHYS_INLINE void numbers_due(double gap, double thickness, double rounding, double due[3])
{
    const double least = CONTACT_MARGIN / 2 + rounding, margin = CONTACT_MARGIN + rounding;
    const double keep = gap / 2 < 0.1 * thickness ? gap / 2 : 0.1 * thickness;
    const double enough = keep > margin ? keep : margin, opens = gap > least ? gap : least;
    due[0] = due[1] = least;
    due[2] = enough < opens ? enough : opens;
}

/* What is not finite makes what is due so. */
PHYS_INLINE bool is_divided(const struct solid_divide *divide,
                            const struct solid_triangle *triangle, const double due[3])
{
    phys_vec number[3];
    corner_numbers(divide, &triangle->from, &triangle->to, number);
    return contact_least(number) >= due[0] && contact_least(number + 1) >= due[1] &&
           contact_least(number + 2) >= due[2];
}

/* ---- The certificate ---- */

/* Along it, in the core's axes, a triangle is farther from the shape than along any other; returns
 * how far, m. */
static double nearest_way(const struct contact_solid *solid, const struct contact_lanes *own,
                          double way[3])
{
    struct contact_solid_point point;
    contact_core_nearest(solid, own, &point);
    for (int c = 0; c < 3; c++)
        way[c] = point.normal[c];
    return point.gap;
}

/* Pairs of directions that may divide, of the nearest ones at both ends, in the core's axes: either
 * of them, fixed in the room; the one, then the other; their mean, fixed in the room; either of
 * them, and their mean, as the shape carries it along. A plane has the third alone; for a shape
 * that stands still the last three are no others. */
enum { DIVIDES = 7, DIVIDES_STILL = 4, DIVIDES_BOTH = 2 };

static void put_mean(const double a[3], const double b[3], double mean[3])
{
    double length = 0;
    for (int c = 0; c < 3; c++) {
        mean[c] = a[c] + b[c];
        length += mean[c] * mean[c];
    }
    length = sqrt(length);
    for (int c = 0; c < 3; c++) /* of two that are opposite it is neither */
        mean[c] = length > CONTACT_MARGIN ? mean[c] / length : a[c];
}

static void divide_pair(const struct contact_solid *solid, int i, const double begin[3],
                        const double end[3], struct solid_divide *divide)
{
    const double *early = i == 4 ? end : begin, *late = i == 5 ? begin : end;
    double there[3], mean[3];
    if (i == 0) {
        other_end(solid, CONTACT_BEGIN, begin, there);
        late = there;
    } else if (i == 1) {
        other_end(solid, CONTACT_END, end, there);
        early = there;
    } else if (i == 3) {
        other_end(solid, CONTACT_END, end, there);
        put_mean(begin, there, mean);
        other_end(solid, CONTACT_BEGIN, mean, there);
        early = mean;
        late = there;
    } else if (i == 6) {
        put_mean(begin, end, mean);
        early = late = mean;
    }
    divide_by(solid, early, late, divide);
}

PHYS_INLINE int first_divide(const struct contact_solid *solid)
{
    return solid->endless ? DIVIDES_BOTH : 0;
}

PHYS_INLINE int last_divide(const struct contact_solid *solid)
{
    return solid->endless ? DIVIDES_BOTH : (solid->moves ? DIVIDES : DIVIDES_STILL) - 1;
}

/* By the best directions of both ends. */
static bool certify_near(const struct contact_solid *solid, const struct solid_triangle *triangle,
                         double thickness)
{
    struct solid_divide divide;
    double begin[3], end[3], due[3];
    const double gap = nearest_way(solid, &triangle->from, begin);
    numbers_due(gap, thickness, triangle->rounding, due);
    divide_pair(solid, 0, begin, begin, &divide);
    if (!solid->endless && is_divided(&divide, triangle, due))
        return true;
    nearest_way(solid, &triangle->to, end);
    for (int i = first_divide(solid) + !solid->endless; i <= last_divide(solid); i++) {
        divide_pair(solid, i, begin, end, &divide);
        if (is_divided(&divide, triangle, due))
            return true;
    }
    return false;
}

/* The three numbers of the direction to the middle of the triangle at the begin, which does for
 * most; false: there is none. */
PHYS_INLINE bool middle_numbers(const struct contact_solid *solid,
                                const struct solid_triangle *triangle, double least[3])
{
    const phys_vec *c = triangle->from.c;
    const double middle[3] = {c[0][3], c[1][3], c[2][3]};
    double way[3] = {1, 0, 0}, there[3];
    struct solid_divide divide;
    phys_vec number[3];
    if (!solid->endless) {
        contact_core_away(solid, middle, way);
        const double length = sqrt(contact_inner(way, way));
        if (!(length > CONTACT_MARGIN))
            return false;
        for (int k = 0; k < 3; k++)
            way[k] /= length;
    }
    other_end(solid, CONTACT_BEGIN, way, there);
    divide_by(solid, way, solid->endless ? way : there, &divide);
    corner_numbers(&divide, &triangle->from, &triangle->to, number);
    for (int i = 0; i < 3; i++)
        least[i] = contact_least(number + i);
    return true;
}

/* However near the triangle began, what is enough far from there is enough. */
PHYS_KERNEL_OF(enum contact_passing, contact_solid_pass,
               (const struct contact_solid *solid, const phys_vec x[3], const phys_vec y[3],
                double thickness, double reach),
               (solid, x, y, thickness, reach))
{
    struct solid_triangle triangle;
    double least[3], due[3];
    triangle_of(solid, x, y, &triangle);
    if (middle_numbers(solid, &triangle, least)) {
        const double far = reach + triangle.rounding;
        if (least[0] > far && least[1] > far && least[2] > far)
            return CONTACT_PASSES_BY;
        numbers_due(INFINITY, thickness, triangle.rounding, due);
        if (least[0] >= due[0] && least[1] >= due[1] && least[2] >= due[2])
            return CONTACT_PASSES;
    }
    return certify_near(solid, &triangle, thickness) ? CONTACT_PASSES : CONTACT_MAY_TOUCH;
}

bool contact_solid_certify(const struct contact_solid *solid, const phys_vec x[3],
                           const phys_vec y[3], double thickness)
{
    return contact_solid_pass(solid, x, y, thickness, INFINITY) != CONTACT_MAY_TOUCH;
}

/* ---- The cut ---- */

/* The part of its way that a corner may go, at most t; below 0: none will do. Numbers of a corner
 * that stays and of one that goes all its way. */
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

/* A triangle that is cut, as its begin, its end without a cut, and its end without a way see it. */
struct solid_cut {
    const phys_vec *x, *y;
    double thickness;
    struct solid_triangle goes;
    struct contact_lanes stays;
    double due[3];
    unsigned held;
};

/* Cuts by two directions. */
enum cut { CUT_FAILS, CUT_HOLDS, CUT_HOLDS_BELOW }; /* the last: and so does all that goes less */
static enum cut cut_by(const struct solid_divide *divide, const struct solid_cut *cut,
                       const double t[3], double part[3])
{
    const double *due = cut->due;
    phys_vec still[3], goes[3];
    bool below = true;
    corner_numbers(divide, &cut->goes.from, &cut->stays, still);
    corner_numbers(divide, &cut->goes.from, &cut->goes.to, goes);
    for (int k = 0; k < 3; k++) {
        part[k] = corner_part((const double[3]){still[0][k], still[1][k], still[2][k]},
                              (const double[3]){goes[0][k], goes[1][k], goes[2][k]}, due,
                              cut->goes.rounding, t[k], cut->held >> k & 1);
        if (!(part[k] >= 0 && still[0][k] >= due[0]))
            return CUT_FAILS;
        below = below && still[1][k] >= due[1] && still[2][k] >= due[2];
    }
    return below ? CUT_HOLDS_BELOW : CUT_HOLDS;
}

static void put_cut(const phys_vec x[3], const phys_vec y[3], const double t[3], phys_vec end[3])
{
    for (int k = 0; k < 3; k++)
        end[k] = x[k] + t[k] * (y[k] - x[k]);
}

/* The nearest directions, in the core's axes: at the begin; at the end, of the triangle as t has
 * it; at the end, of one that stays. */
enum { WAYS = 3 };

/* end: of the triangle as t has it. */
static void prepare_cut(const struct contact_solid *solid, const phys_vec end[3],
                        struct solid_cut *cut, double way[WAYS][3])
{
    struct contact_lanes at;
    contact_core_lanes(solid->place + CONTACT_END, end, &at);
    nearest_way(solid, &at, way[1]);
    triangle_of(solid, cut->x, cut->y, &cut->goes);
    for (int k = 0; k < 3; k++) /* of ends as they are told in the room */
        for (int c = 0; c < 3; c++)
            cut->goes.rounding += ROUNDING * (fabs(cut->x[k][c]) + fabs(cut->y[k][c]));
    contact_core_lanes(solid->place + CONTACT_END, cut->x, &cut->stays);
    nearest_way(solid, &cut->stays, way[2]);
    const double gap = nearest_way(solid, &cut->goes.from, way[0]);
    numbers_due(gap, cut->thickness, cut->goes.rounding, cut->due);
}

/* The first pair of directions, that of the begin, is taken if it holds below, for every later look
 * finds it again; else that pair which cuts least. */
static bool take_cut(const struct contact_solid *solid, const struct solid_cut *cut,
                     const double t[3], const double way[WAYS][3], double best[3])
{
    const int first = first_divide(solid), n = last_divide(solid) + 1 - first;
    double most = -1;
    for (int i = 0; i < 2 * n; i++) {
        struct solid_divide divide;
        double part[3] = {0};
        phys_vec at[3];
        divide_pair(solid, first + i % n, way[0], way[i < n ? 1 : 2], &divide);
        const enum cut how = cut_by(&divide, cut, t, part);
        const double sum = part[0] + part[1] + part[2];
        put_cut(cut->x, cut->y, part, at);
        if (how == CUT_FAILS || sum <= most ||
            !contact_solid_certify(solid, cut->x, at, cut->thickness))
            continue;
        most = sum;
        for (int k = 0; k < 3; k++)
            best[k] = part[k];
        if (i == 0 && how == CUT_HOLDS_BELOW)
            break;
    }
    return most >= 0;
}

bool contact_solid_cut(const struct contact_solid *solid, const phys_vec x[3], const phys_vec y[3],
                       double thickness, unsigned held, double t[3])
{
    struct solid_cut cut = {.x = x, .y = y, .thickness = thickness, .held = held};
    phys_vec at[3];
    double best[3] = {t[0], t[1], t[2]}, way[WAYS][3];
    put_cut(x, y, t, at);
    if (contact_solid_certify(solid, x, at, thickness))
        return true;
    prepare_cut(solid, at, &cut, way);
    if (!take_cut(solid, &cut, t, (const double(*)[3])way, best))
        return false;
    for (int k = 0; k < 3; k++)
        t[k] = best[k];
    return true;
}

/* ---- Apart ---- */

/* The direction, in the core's axes, from a shape to the point of a box that is nearest to it, or
 * nearly. */
static void box_way(const struct contact_solid *solid, enum contact_end end, const double low[3],
                    const double high[3], double way[3])
{
    const struct contact_place *place = solid->place + end;
    phys_vec at = place->at;
    for (int i = 0;; i++) {
        double own[3], out[3];
        for (int c = 0; c < 3; c++) {
            at[c] = at[c] < low[c] ? low[c] : at[c] > high[c] ? high[c] : at[c];
            out[c] = at[c] - place->at[c];
        }
        contact_way_in(place, out, own);
        contact_core_away(solid, own, way);
        if (i == APPROACHES)
            break;
        contact_way_out(place, way, out);
        at -= (phys_vec){out[0], out[1], out[2], 0};
    }
    const double length = sqrt(contact_inner(way, way));
    for (int c = 0; c < 3; c++)
        way[c] = solid->endless ? c == 0 : length > CONTACT_TINY ? way[c] / length : 0;
}

/* Whether two directions divide a box that stays from the shape, by so much. */
static bool box_divided(const struct contact_solid *solid, const double low[3],
                        const double high[3], const double early[3], const double late[3],
                        double reach)
{
    struct solid_triangle triangle;
    struct solid_divide divide;
    phys_vec middle = {0}, number[3];
    double out[2][3], wide[3] = {0};
    for (int c = 0; c < 3; c++)
        middle[c] = (low[c] + high[c]) / 2;
    const phys_vec x[3] = {middle, middle, middle};
    triangle_of(solid, x, x, &triangle);
    divide_by(solid, early, late, &divide);
    corner_numbers(&divide, &triangle.from, &triangle.to, number);
    contact_way_out(solid->place + CONTACT_BEGIN, early, out[0]);
    contact_way_out(solid->place + CONTACT_END, late, out[1]);
    for (int c = 0; c < 3; c++) {
        const double half = (high[c] - low[c]) / 2;
        wide[0] += fabs(out[0][c]) * half;
        wide[1] += fabs(out[0][c] + out[1][c]) / 2 * half;
        wide[2] += fabs(out[1][c]) * half;
    }
    const double due = reach + CONTACT_MARGIN + triangle.rounding + ROUNDING * wide[0];
    return number[0][0] - wide[0] > due && number[1][0] - wide[1] > due &&
           number[2][0] - wide[2] > due;
}

bool contact_solid_apart(const struct contact_solid *solid, const double low[3],
                         const double high[3], double reach)
{
    double begin[3], end[3], there[3];
    box_way(solid, CONTACT_BEGIN, low, high, begin);
    other_end(solid, CONTACT_BEGIN, begin, there);
    if (!solid->endless && box_divided(solid, low, high, begin, there, reach))
        return true;
    if (!solid->moves && !solid->endless)
        return false;
    box_way(solid, CONTACT_END, low, high, end);
    other_end(solid, CONTACT_END, end, there);
    if (!solid->endless && box_divided(solid, low, high, there, end, reach))
        return true;
    return box_divided(solid, low, high, begin, end, reach);
}
