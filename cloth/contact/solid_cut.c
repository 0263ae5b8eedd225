/* Cuts. Along a pair of directions, the three numbers of a corner are linear in the part of its way
 * that it goes. So the largest part that leaves the numbers due follows at once. */
#include "cloth/contact/solid_divide.h"

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
    struct contact_solid_triangle goes;
    struct contact_lanes stays;
    double due[3];
    unsigned held;
};

/* Cuts by two directions. */
enum cut { CUT_FAILS, CUT_HOLDS, CUT_HOLDS_BELOW }; /* the last: and so does all that goes less */
static enum cut cut_by(const struct contact_solid_divide *divide, const struct solid_cut *cut,
                       const double t[3], double part[3])
{
    const double *due = cut->due;
    phys_vec still[3], goes[3];
    bool below = true;
    contact_numbers(divide, &cut->goes.from, &cut->stays, still);
    contact_numbers(divide, &cut->goes.from, &cut->goes.to, goes);
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
    contact_nearest_way(solid, &at, way[1]);
    contact_triangle_of(solid, cut->x, cut->y, &cut->goes);
    for (int k = 0; k < 3; k++) /* of ends as they are told in the room */
        for (int c = 0; c < 3; c++)
            cut->goes.rounding +=
                CONTACT_SOLID_ROUNDING * (fabs(cut->x[k][c]) + fabs(cut->y[k][c]));
    contact_core_lanes(solid->place + CONTACT_END, cut->x, &cut->stays);
    contact_nearest_way(solid, &cut->stays, way[2]);
    const double gap = contact_nearest_way(solid, &cut->goes.from, way[0]);
    contact_numbers_due(gap, cut->thickness, cut->goes.rounding, cut->due);
}

/* The first pair of directions, that of the begin, is taken if it holds below, as every later look
 * finds it again. Else the pair that cuts least is taken. */
static bool take_cut(const struct contact_solid *solid, const struct solid_cut *cut,
                     const double t[3], const double way[WAYS][3], double best[3])
{
    const int first = contact_first_divide(solid), n = contact_last_divide(solid) + 1 - first;
    double most = -1;
    for (int i = 0; i < 2 * n; i++) {
        struct contact_solid_divide divide;
        double part[3] = {0};
        phys_vec at[3];
        contact_divide_pair(solid, first + i % n, way[0], way[i < n ? 1 : 2], &divide);
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
