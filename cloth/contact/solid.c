/* Certificates of triangles against convex shapes: three numbers for a pair of directions, as
 * solid.h derives them. All numbers are in the core's own axes at either end of the step, so
 * neither a common velocity nor the room's origin costs digits. */
#include "cloth/contact/solid_divide.h"

enum { APPROACHES = 4 };

/* ---- The solid ---- */

static void solid_put_place(const struct contact_core *core, const struct phys_pose *pose,
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
    solid_put_place(&core, pose->moves ? &pose->from : NULL, solid->place + CONTACT_BEGIN);
    solid_put_place(&core, pose->moves ? &pose->to : NULL, solid->place + CONTACT_END);
}

/* ---- The certificate ---- */

/* False for values that are not finite, as `due` is then not finite. */
PHYS_INLINE bool is_divided(const struct contact_solid_divide *divide,
                            const struct contact_solid_triangle *triangle, const double due[3])
{
    phys_vec number[3];
    contact_numbers(divide, &triangle->from, &triangle->to, number);
    return contact_least(number) >= due[0] && contact_least(number + 1) >= due[1] &&
           contact_least(number + 2) >= due[2];
}

double contact_nearest_way(const struct contact_solid *solid, const struct contact_lanes *own,
                           double way[3])
{
    struct contact_solid_point point;
    contact_core_nearest(solid, own, &point);
    for (int c = 0; c < 3; c++)
        way[c] = point.normal[c];
    return point.gap;
}

/* A sum of two unit vectors that is no longer counts as none. */
static const double OPPOSITE = 1e-9;

static void put_mean(const double a[3], const double b[3], double mean[3])
{
    double length = 0;
    for (int c = 0; c < 3; c++) {
        mean[c] = a[c] + b[c];
        length += mean[c] * mean[c];
    }
    length = sqrt(length);
    for (int c = 0; c < 3; c++) /* of two that are opposite it is neither */
        mean[c] = length > OPPOSITE ? mean[c] / length : a[c];
}

void contact_divide_pair(const struct contact_solid *solid, int i, const double begin[3],
                         const double end[3], struct contact_solid_divide *divide)
{
    const double *early = i == 4 ? end : begin, *late = i == 5 ? begin : end;
    double there[3], mean[3];
    if (i == 0) {
        contact_other_end(solid, CONTACT_BEGIN, begin, there);
        late = there;
    } else if (i == 1) {
        contact_other_end(solid, CONTACT_END, end, there);
        early = there;
    } else if (i == 3) {
        contact_other_end(solid, CONTACT_END, end, there);
        put_mean(begin, there, mean);
        contact_other_end(solid, CONTACT_BEGIN, mean, there);
        early = mean;
        late = there;
    } else if (i == 6) {
        put_mean(begin, end, mean);
        early = late = mean;
    }
    contact_divide_by(solid, early, late, divide);
}

/* By the best directions of both ends. */
static bool certify_near(const struct contact_solid *solid,
                         const struct contact_solid_triangle *triangle, double thickness)
{
    struct contact_solid_divide divide;
    double begin[3], end[3], due[3];
    const double gap = contact_nearest_way(solid, &triangle->from, begin);
    contact_numbers_due(gap, thickness, triangle->rounding, due);
    contact_divide_pair(solid, 0, begin, begin, &divide);
    if (!solid->endless && is_divided(&divide, triangle, due))
        return true;
    contact_nearest_way(solid, &triangle->to, end);
    for (int i = contact_first_divide(solid) + !solid->endless; i <= contact_last_divide(solid);
         i++) {
        contact_divide_pair(solid, i, begin, end, &divide);
        if (is_divided(&divide, triangle, due))
            return true;
    }
    return false;
}

/* The three numbers of the direction to the middle of the triangle at the begin, which is enough
 * for most; false: there is none. */
PHYS_INLINE bool middle_numbers(const struct contact_solid *solid,
                                const struct contact_solid_triangle *triangle, double least[3])
{
    const phys_vec *c = triangle->from.c;
    const double middle[3] = {c[0][3], c[1][3], c[2][3]};
    double way[3] = {1, 0, 0}, there[3];
    struct contact_solid_divide divide;
    phys_vec number[3];
    if (!solid->endless) {
        contact_core_away(solid, middle, way);
        const double length = sqrt(contact_inner(way, way));
        if (!(length > CONTACT_MARGIN))
            return false;
        for (int k = 0; k < 3; k++)
            way[k] /= length;
    }
    contact_other_end(solid, CONTACT_BEGIN, way, there);
    contact_divide_by(solid, way, solid->endless ? way : there, &divide);
    contact_numbers(&divide, &triangle->from, &triangle->to, number);
    for (int i = 0; i < 3; i++)
        least[i] = contact_least(number + i);
    return true;
}

/* The gap at the begin is taken as infinite: numbers that suffice then suffice for any gap. */
PHYS_KERNEL_OF(enum contact_passing, contact_solid_pass,
               (const struct contact_solid *solid, const phys_vec x[3], const phys_vec y[3],
                double thickness, double reach),
               (solid, x, y, thickness, reach))
{
    struct contact_solid_triangle triangle;
    double least[3], due[3];
    contact_triangle_of(solid, x, y, &triangle);
    if (middle_numbers(solid, &triangle, least)) {
        const double far = reach + triangle.rounding;
        if (least[0] > far && least[1] > far && least[2] > far)
            return CONTACT_PASSES_BY;
        contact_numbers_due(INFINITY, thickness, triangle.rounding, due);
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

/* True if two directions divide a box that stands still from the shape, by `reach`. */
static bool box_divided(const struct contact_solid *solid, const double low[3],
                        const double high[3], const double early[3], const double late[3],
                        double reach)
{
    struct contact_solid_triangle triangle;
    struct contact_solid_divide divide;
    phys_vec middle = {0}, number[3];
    double out[2][3], wide[3] = {0};
    for (int c = 0; c < 3; c++)
        middle[c] = (low[c] + high[c]) / 2;
    const phys_vec x[3] = {middle, middle, middle};
    contact_triangle_of(solid, x, x, &triangle);
    contact_divide_by(solid, early, late, &divide);
    contact_numbers(&divide, &triangle.from, &triangle.to, number);
    contact_way_out(solid->place + CONTACT_BEGIN, early, out[0]);
    contact_way_out(solid->place + CONTACT_END, late, out[1]);
    for (int c = 0; c < 3; c++) {
        const double half = (high[c] - low[c]) / 2;
        wide[0] += fabs(out[0][c]) * half;
        wide[1] += fabs(out[0][c] + out[1][c]) / 2 * half;
        wide[2] += fabs(out[1][c]) * half;
    }
    const double due =
        reach + CONTACT_MARGIN + triangle.rounding + CONTACT_SOLID_ROUNDING * wide[0];
    return number[0][0] - wide[0] > due && number[1][0] - wide[1] > due &&
           number[2][0] - wide[2] > due;
}

bool contact_solid_apart(const struct contact_solid *solid, const double low[3],
                         const double high[3], double reach)
{
    double begin[3], end[3], there[3];
    box_way(solid, CONTACT_BEGIN, low, high, begin);
    contact_other_end(solid, CONTACT_BEGIN, begin, there);
    if (!solid->endless && box_divided(solid, low, high, begin, there, reach))
        return true;
    if (!solid->moves && !solid->endless)
        return false;
    box_way(solid, CONTACT_END, low, high, end);
    contact_other_end(solid, CONTACT_END, end, there);
    if (!solid->endless && box_divided(solid, low, high, there, end, reach))
        return true;
    return box_divided(solid, low, high, begin, end, reach);
}

double contact_solid_way(const struct contact_solid *solid)
{
    const struct contact_place *begin = solid->place + CONTACT_BEGIN,
                               *end = solid->place + CONTACT_END;
    const phys_vec at = end->at - begin->at;
    double way = sqrt(phys_dot(&at, &at));
    if (!solid->moves)
        return 0;
    for (int i = 0; i < 3; i++) {
        double turn[3];
        for (int c = 0; c < 3; c++)
            turn[c] = end->axis[i][c] - begin->axis[i][c];
        way += (solid->half[i] + solid->radius) * sqrt(contact_inner(turn, turn));
    }
    return solid->endless ? INFINITY : way;
}
