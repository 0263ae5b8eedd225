/* Finds cloth that is too flat to touch itself, over a whole step and with a distance (Volino &
 * Magnenat-Thalmann, Efficient self-collision detection on smoothly discretized surfaces using
 * geometrical shape regularity, 1994).
 *
 * Let all normals of a patch have a positive part along a direction, and let its border, seen along
 * it, be one line that does not cross itself. Then no line along it meets the patch twice: the
 * triangles lie beside each other in the view. A way in the view from an inner vertex to another
 * triangle leads through one of the vertex's own triangles. Its length is at least their least
 * altitude in the view. From a vertex on the border it may also lead out of the patch and in again.
 * Then it is no shorter than the distance that the border keeps from itself. Both hold at all times
 * of a step if normals are those of the whole step, and if the border keeps its distance all the
 * time: then it never crosses itself. Distances in space are not shorter.
 *
 * A line between two points that move straight keeps a distance from another, all the time, if it
 * does at both ends of the step, measured along one direction. */
#include "cloth/contact/skin_table.h"

#include <math.h>
#include <string.h>

enum { MOST = 768 };                 /* points of a border: a longer one is not looked at */
static const float ROUNDING = 1e-3f; /* of a normal in floats */
static const double FLOATS = 1e-6;   /* of positions in a view, in floats */

/* A border in the view: points at both ends of the step; boxes of edges, and of four edges each. */
struct border {
    uint32_t n;
    float at[2][MOST + 1][2];
    float low[2][MOST + 8], high[2][MOST + 8];
    float four_low[2][MOST / 4 + 4], four_high[2][MOST / 4 + 4];
    float reach;
};

struct view {
    double axis[2][3], origin[3], way[3]; /* way: of the frame, at the end of the step */
};

static float lesser(float a, float b)
{
    return a < b ? a : b;
}

/* ---- The direction ---- */

/* Finds a direction for both patches; returns the least part of a normal along it; 0: there is no
 * direction. */
static float find_direction(const struct contact_point_box *hull, double direction[3])
{
    double square = 0, least = 0;
    for (int c = 0; c < 3; c++) {
        direction[c] = 0.5 * ((double)hull->low[c] + (double)hull->high[c]);
        square += direction[c] * direction[c];
    }
    if (!(square > 0.01))
        return 0;
    for (int c = 0; c < 3; c++) {
        direction[c] /= sqrt(square);
        least += direction[c] * (double)(direction[c] > 0 ? hull->low[c] : hull->high[c]);
    }
    return (float)least - ROUNDING;
}

/* Two directions across it and each other. */
static void skin_flat_look_along(const double direction[3], struct view *view)
{
    double *u = view->axis[0], *v = view->axis[1], square = 0;
    int c = fabs(direction[0]) < fabs(direction[1]) ? 0 : 1;
    c = fabs(direction[2]) < fabs(direction[c]) ? 2 : c;
    for (int i = 0; i < 3; i++) {
        u[i] = (i == c) - direction[c] * direction[i];
        square += u[i] * u[i];
    }
    for (int i = 0; i < 3; i++)
        u[i] /= sqrt(square);
    for (int i = 0; i < 3; i++)
        v[i] = direction[(i + 1) % 3] * u[(i + 2) % 3] - direction[(i + 2) % 3] * u[(i + 1) % 3];
}

/* ---- The border ---- */

static void add_points(const struct contact_patch *patch, uint32_t from, uint32_t n,
                       const struct view *view, struct border *border)
{
    const uint32_t *along = patch->side->skin->along + patch->loop->first;
    for (uint32_t i = 0, k = from; i < n; i++, k++) {
        k = k < patch->loop->n ? k : k - patch->loop->n;
        const phys_vec x = patch->side->x[along[k]], y = patch->side->y[along[k]];
        float(*at)[2] = border->at[0] + border->n, (*then)[2] = border->at[1] + border->n;
        for (int a = 0; a < 2; a++) {
            double begin = 0, end = 0;
            for (int c = 0; c < 3; c++) {
                begin += view->axis[a][c] * (x[c] - view->origin[c]);
                end += view->axis[a][c] * (y[c] - view->way[c] - view->origin[c]);
            }
            (*at)[a] = (float)begin;
            (*then)[a] = (float)end;
        }
        border->n++;
    }
}

static uint32_t id_on(const struct contact_patch *patch, uint32_t i)
{
    const struct contact_skin *skin = patch->side->skin;
    return skin->id[skin->along[patch->loop->first + i]];
}

/* Ids of a border, and some others: most points of another border are not on it, which one look
 * tells. */
struct marks {
    bool is[1024];
};

static bool *mark_of(struct marks *marks, uint32_t id)
{
    return marks->is + id % (sizeof marks->is / sizeof *marks->is);
}

/* Finds the line that the borders of a and b share. *from_a, *from_b: the points where it begins on
 * a and ends on b. Returns how many points it has; 0: they share no line, or more. */
static uint32_t shared_line(const struct contact_patch *a, const struct contact_patch *b,
                            uint32_t *from_a, uint32_t *from_b)
{
    const uint32_t n_a = a->loop->n, n_b = b->loop->n;
    uint32_t id[MOST + 4], begins = 0, n = 0, before = UINT32_MAX;
    uint32_t at_a = 0, at_b = 0;
    struct marks of_b = {{0}};
    for (uint32_t i = 0; i < n_b; i++) {
        id[i] = id_on(b, i);
        *mark_of(&of_b, id[i]) = true;
    }
    for (uint32_t i = 0; i <= n_a; i++) { /* the last one again, as it precedes the first */
        const uint32_t here = id_on(a, i < n_a ? i : 0);
        uint32_t k = *mark_of(&of_b, here) ? 0 : n_b;
        while (k < n_b && id[k] != here)
            k++;
        const bool goes_on = k < n_b && before != UINT32_MAX && (k + 1) % n_b == before;
        if (i > 0 && k < n_b && !goes_on) {
            begins++;
            at_a = i % n_a;
            at_b = k;
        }
        n += i < n_a && k < n_b;
        before = k < n_b ? k : UINT32_MAX;
    }
    *from_a = at_a;
    *from_b = at_b;
    return begins == 1 && n >= 2 && n < n_a && n < n_b ? n : 0;
}

/* The border of both: that of a from where the line ends to where it begins, then that of b. */
static bool join_borders(const struct contact_patch *a, const struct contact_patch *b,
                         const struct view *view, struct border *border)
{
    uint32_t from_a, from_b;
    const uint32_t n = shared_line(a, b, &from_a, &from_b);
    if (!n)
        return false;
    add_points(a, (from_a + n - 1) % a->loop->n, a->loop->n - n + 2, view, border);
    add_points(b, (from_b + 1) % b->loop->n, b->loop->n - n, view, border);
    return true;
}

static void box_edges(struct border *border)
{
    const uint32_t n = border->n, n_fours = (n + 3) / 4;
    memcpy(border->at[0] + n, border->at[0], sizeof border->at[0][0]);
    memcpy(border->at[1] + n, border->at[1], sizeof border->at[1][0]);
    for (int a = 0; a < 2; a++)
        for (uint32_t i = 0; i < 4 * n_fours + 4; i++) {
            float low = INFINITY, high = -INFINITY;
            for (uint32_t k = 0; k < 4 && i < n; k++) {
                const float at = border->at[k / 2][i + k % 2][a];
                low = at < low ? at : low;
                high = at > high ? at : high;
            }
            border->low[a][i] = low;
            border->high[a][i] = high;
        }
    for (int a = 0; a < 2; a++)
        for (uint32_t i = 0; i < n_fours + 3; i++) {
            border->four_low[a][i] = INFINITY;
            border->four_high[a][i] = -INFINITY;
            for (uint32_t k = 4 * i; k < 4 * i + 4 && i < n_fours; k++) {
                const float low = border->low[a][k], high = border->high[a][k];
                border->four_low[a][i] = lesser(border->four_low[a][i], low);
                border->four_high[a][i] = -lesser(-border->four_high[a][i], -high);
            }
        }
}

/* ---- Distances ---- */

/* The way from the nearest point of an edge to a point, in the middle of the step; its square. */
static float way_from(const struct border *border, uint32_t point, uint32_t edge, float way[2])
{
    float along[2], to[2], dot = 0, length = 0, square = 0;
    for (int a = 0; a < 2; a++) {
        const float begin = border->at[0][edge][a] + border->at[1][edge][a];
        along[a] = border->at[0][edge + 1][a] + border->at[1][edge + 1][a] - begin;
        to[a] = border->at[0][point][a] + border->at[1][point][a] - begin;
        dot += along[a] * to[a];
        length += along[a] * along[a];
    }
    float part = length > 0 ? dot / length : 0;
    part = part < 0 ? 0 : part > 1 ? 1 : part;
    for (int a = 0; a < 2; a++) {
        way[a] = 0.5f * (to[a] - part * along[a]);
        square += way[a] * way[a];
    }
    return square;
}

/* True if n points from `point` on keep the distance from an edge, measured along `way`, whose
 * square is `square`. */
static bool keeps_along(const struct border *border, uint32_t point, uint32_t n, uint32_t edge,
                        const float way[2], float square)
{
    float least = INFINITY;
    for (int time = 0; time < 2; time++) {
        float from = -INFINITY, to = INFINITY;
        for (uint32_t k = 0; k < 2; k++) {
            const float *at = border->at[time][edge + k];
            const float along = way[0] * at[0] + way[1] * at[1];
            from = along > from ? along : from;
        }
        for (uint32_t k = 0; k < n; k++) {
            const float *at = border->at[time][point + k];
            const float along = way[0] * at[0] + way[1] * at[1];
            to = along < to ? along : to;
        }
        least = to - from < least ? to - from : least;
    }
    return least > 0 && least * least >= border->reach * border->reach * square;
}

static bool point_keeps(const struct border *border, uint32_t point, uint32_t edge)
{
    float way[2];
    const float square = way_from(border, point, edge, way);
    return keeps_along(border, point, 1, edge, way, square);
}

/* Two edges that share no point: along the shortest way from the one to an end of the other. */
static bool edges_keep(const struct border *border, uint32_t e, uint32_t f)
{
    float best = INFINITY, way[2] = {0}, other[2];
    bool of_e = true;
    for (uint32_t k = 0; k < 4; k++) {
        const bool is_e = k < 2;
        const float square = way_from(border, (is_e ? e : f) + k % 2, is_e ? f : e, other);
        if (square < best) {
            best = square;
            of_e = is_e;
            memcpy(way, other, sizeof way);
        }
    }
    return keeps_along(border, of_e ? e : f, 2, of_e ? f : e, way, best);
}

/* Edges e < f. */
static bool pair_keeps(const struct border *border, uint32_t e, uint32_t f)
{
    const uint32_t n = border->n;
    if (f == e + 1)
        return point_keeps(border, e, f) && point_keeps(border, f + 1, e);
    if (e == 0 && f == n - 1)
        return point_keeps(border, f, e) && point_keeps(border, 1, f);
    return edges_keep(border, e, f);
}

/* Which of four boxes from `i` on are near to a box. */
static unsigned near_boxes(const float box[4], const float *const low[2],
                           const float *const high[2], uint32_t i)
{
    unsigned bits = 0;
    PHYS_UNROLL
    for (uint32_t k = 0; k < 4; k++) {
        const int is = (box[0] <= high[0][i + k]) & (box[1] >= low[0][i + k]) &
                       (box[2] <= high[1][i + k]) & (box[3] >= low[1][i + k]);
        bits |= (unsigned)is << k;
    }
    return bits;
}

static void widen(const float *const low[2], const float *const high[2], uint32_t i, float reach,
                  float box[4])
{
    for (int a = 0; a < 2; a++) {
        box[2 * a] = low[a][i] - reach;
        box[2 * a + 1] = high[a][i] + reach;
    }
}

/* The edges of two fours. */
static bool fours_keep(const struct border *border, uint32_t r, uint32_t q)
{
    const float *const low[2] = {border->low[0], border->low[1]};
    const float *const high[2] = {border->high[0], border->high[1]};
    for (uint32_t e = 4 * r; e < 4 * r + 4 && e < border->n; e++) {
        float box[4];
        widen(low, high, e, border->reach, box);
        unsigned bits = near_boxes(box, low, high, 4 * q);
        if (r == q)
            bits &= ~1u << e % 4;
        for (; bits; bits &= bits - 1)
            if (!pair_keeps(border, e, 4 * q + (uint32_t)__builtin_ctz(bits)))
                return false;
    }
    return true;
}

/* True if points and edges that do not share a point keep the reach, and edges do not cross. */
static bool border_keeps(struct border *border)
{
    const float *const low[2] = {border->four_low[0], border->four_low[1]};
    const float *const high[2] = {border->four_high[0], border->four_high[1]};
    box_edges(border);
    for (uint32_t r = 0; 4 * r < border->n; r++) {
        float box[4];
        widen(low, high, r, border->reach, box);
        for (uint32_t q = r; 4 * q < border->n; q += 4) {
            unsigned bits = near_boxes(box, low, high, q);
            for (; bits; bits &= bits - 1)
                if (!fours_keep(border, r, q + (uint32_t)__builtin_ctz(bits)))
                    return false;
        }
    }
    return true;
}

/* ---- Patches ---- */

/* m: the reach, enlarged by the rounding of the border's floats. */
static float reach_of(const struct border *border, double reach)
{
    float most = 0;
    for (uint32_t i = 0; i < 4 * border->n; i++)
        most = -lesser(-most, -fabsf(border->at[i & 1][i / 4][i >> 1 & 1]));
    return (float)(reach * (1 + 1e-5) + FLOATS * (double)most);
}

static void set_view(const struct contact_patch *patch, const double direction[3],
                     struct view *view)
{
    const struct contact_boxes_head *head = patch->side->boxes;
    const phys_vec *origin = patch->side->x + patch->side->skin->along[patch->loop->first];
    skin_flat_look_along(direction, view);
    memcpy(view->way, head->way, sizeof view->way);
    for (int c = 0; c < 3; c++)
        view->origin[c] = (*origin)[c];
}

bool contact_patches_flat(const struct contact_patch *a, const struct contact_patch *b,
                          double reach)
{
    struct contact_point_box hull = a->normal;
    struct border border;
    struct view view;
    double direction[3];
    float altitude = a->altitude;
    for (int c = 0; c < 3 && b; c++) {
        hull.low[c] = lesser(hull.low[c], b->normal.low[c]);
        hull.high[c] = -lesser(-hull.high[c], -b->normal.high[c]);
        altitude = lesser(altitude, b->altitude);
    }
    if (!a->loop->n || (b && !b->loop->n) || a->loop->n + (b ? b->loop->n : 0) > MOST)
        return false;
    const float least = find_direction(&hull, direction);
    if (!(least > 0 && (double)(least * altitude) * (1 - 2 * (double)ROUNDING) >= reach))
        return false;
    set_view(a, direction, &view);
    border.n = 0;
    if (!b)
        add_points(a, 0, a->loop->n, &view, &border);
    else if (!join_borders(a, b, &view, &border))
        return false;
    border.reach = reach_of(&border, reach);
    return border_keeps(&border);
}
