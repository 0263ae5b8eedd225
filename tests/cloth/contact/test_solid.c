/* Triangles against moving convex shapes. What is certified is held against the shape at many times
 * between both ends: where its points are then is said here once more, as what is inside. */
#include "cloth/contact/solid.h"
#include "tests/support/unit.h"

#include <math.h>

enum { BRUTE = 12, PAIRS = 60, MANY = 2000, TIMES = 50, THIRDS = 30 };
static const double THICKNESS = 1e-3;

static uint64_t seed = 1;
static double uniform(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

/* Of any size between two: as many of each power of ten. */
static double any_size(double low, double high)
{
    return low * pow(high / low, uniform(0, 1));
}

static void pick_point(double reach, phys_vec *x)
{
    *x = (phys_vec){uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach), 0};
}

static void make_unit(size_t n, double *value)
{
    double square = 0;
    for (size_t i = 0; i < n; i++)
        square += value[i] * value[i];
    for (size_t i = 0; i < n; i++)
        value[i] /= sqrt(square);
}

static double length(const phys_vec *a)
{
    return sqrt(phys_dot(a, a));
}

/* ---- Scenes of one shape and one triangle ---- */

struct meeting {
    struct contact_shape shape;
    struct phys_key keys[2]; /* at 0 and 1 s */
    struct contact_pose pose;
    struct contact_solid solid;
    phys_vec x[3], y[3];
};

static void make_shape(uint32_t kind, double shift, double turn, struct meeting *m)
{
    double *value = m->shape.value;
    m->shape = (struct contact_shape){.kind = kind, .n = 2};
    for (const struct contact_parameter *p = contact_kinds[kind]->parameter; p->name; p++) {
        const size_t n = contact_role_size(p->role);
        const bool is_length = p->role == CONTACT_LENGTH || p->role == CONTACT_LENGTHS;
        for (size_t i = 0; i < n; i++)
            value[i] = is_length ? uniform(0.1, 1) : uniform(-1, 1);
        if (p->role == CONTACT_DIRECTION || p->role == CONTACT_ROTATION)
            make_unit(n, value);
        value += n;
    }
    for (int i = 0; i < 3; i++)
        m->shape.about[i] = uniform(-1, 1);
    for (int k = 0; k < 2; k++) {
        m->keys[k].time = k;
        for (int i = 0; i < 3; i++)
            m->keys[k].translate[i] =
                k ? m->keys[0].translate[i] + uniform(-shift, shift) : uniform(-1, 1);
        for (int i = 0; i < 4; i++)
            m->keys[k].rotate[i] =
                k ? m->keys[0].rotate[i] + uniform(-turn, turn) / 2 : uniform(-1, 1);
        make_unit(4, m->keys[k].rotate);
    }
    contact_pose_over(&m->shape, m->keys, NULL, 0, 1, &m->pose);
    contact_solid_make(&m->shape, &m->pose, &m->solid);
}

/* Where what the shape carries along is at the end. */
static void carry(const struct meeting *m, const phys_vec *x, phys_vec *y)
{
    phys_pose_back(&m->pose.from, x, y);
    phys_pose_point(&m->pose.to, y, y);
}

/* A triangle so far from the shape at the begin. Its end: carried along or not, and moved. */
static void place_triangle(double gap, double edge, bool carried, double away, struct meeting *m)
{
    struct contact_solid_point point;
    phys_vec middle, common;
    pick_point(3, &middle);
    for (int k = 0; k < 3; k++) {
        pick_point(edge, m->x + k);
        m->x[k] += middle;
    }
    for (int i = 0; i < 3; i++) {
        contact_solid_nearest(&m->solid, CONTACT_BEGIN, m->x, &point);
        for (int k = 0; k < 3; k++)
            m->x[k] += (gap - point.gap) * point.normal;
    }
    pick_point(away, &common);
    for (int k = 0; k < 3; k++) {
        phys_vec own;
        pick_point(away, &own);
        m->y[k] = m->x[k];
        if (carried)
            carry(m, m->x + k, m->y + k);
        m->y[k] += own + common;
    }
}

/* ---- What is inside at a time between both ends ---- */

/* The point of the shape's own axes that is there then: the chords of all are an affine map. */
static void point_then(const struct meeting *m, double s, const phys_vec *x, phys_vec *own)
{
    const struct phys_pose *from = &m->pose.from, *to = &m->pose.to;
    double a[3][4];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            a[i][j] = (1 - s) * from->turn[i][j] + s * to->turn[i][j];
        a[i][3] = (*x)[i] - from->about[i] - (1 - s) * from->translate[i] - s * to->translate[i];
    }
    for (int i = 0; i < 3;
         i++) { /* near to a rotation: its pivots are not small where it matters */
        int best = i;
        for (int r = i + 1; r < 3; r++)
            best = fabs(a[r][i]) > fabs(a[best][i]) ? r : best;
        for (int j = 0; j < 4; j++) {
            const double value = a[i][j];
            a[i][j] = a[best][j];
            a[best][j] = value;
        }
        for (int r = 0; r < 3; r++)
            for (int j = 3; r != i && j >= i; j--)
                a[r][j] -= a[r][i] / a[i][i] * a[i][j];
    }
    *own = (phys_vec){0};
    for (int i = 0; i < 3; i++)
        (*own)[i] = a[i][3] / a[i][i] + from->about[i];
}

static void chord(const struct meeting *m, double s, const double *own, phys_vec *x)
{
    const phys_vec p = {own[0], own[1], own[2], 0};
    phys_vec was, is;
    phys_pose_point(&m->pose.from, &p, &was);
    phys_pose_point(&m->pose.to, &p, &is);
    *x = (1 - s) * was + s * is;
}

/* A convex function of a point x that is 0 on the shape's surface, and changes no faster than x for
 * shapes that do not turn. */
static double level_plane(const struct meeting *m, double s, const phys_vec *x)
{
    const phys_vec up = {m->shape.value[3], m->shape.value[4], m->shape.value[5], 0};
    phys_vec at, was, is;
    chord(m, s, m->shape.value, &at);
    phys_pose_direction(&m->pose.from, &up, &was);
    phys_pose_direction(&m->pose.to, &up, &is);
    const phys_vec normal = (1 - s) * was + s * is, from = *x - at;
    return phys_dot(&from, &normal);
}

static double level_sphere(const struct meeting *m, double s, const phys_vec *x)
{
    phys_vec at;
    chord(m, s, m->shape.value, &at);
    at = *x - at;
    return length(&at) - m->shape.value[3];
}

static double level_box(const struct meeting *m, double s, const phys_vec *x)
{
    phys_vec own;
    struct contact_hit hit;
    point_then(m, s, x, &own);
    contact_kinds[m->shape.kind]->closest(m->shape.value, NULL, 1, &own, &hit);
    return hit.gap;
}

static double level_capsule(const struct meeting *m, double s, const phys_vec *x)
{
    phys_vec from, to;
    chord(m, s, m->shape.value, &from);
    chord(m, s, m->shape.value + 3, &to);
    const phys_vec axis = to - from;
    phys_vec away = *x - from;
    const double along = phys_dot(&away, &axis) / phys_dot(&axis, &axis);
    away -= fmax(0, fmin(1, along)) * axis;
    return length(&away) - m->shape.value[6];
}

static double (*const LEVEL[])(const struct meeting *, double, const phys_vec *) = {
    level_plane, level_sphere, level_box, level_capsule, level_box};

/* The least of a convex function on a line of a triangle, then of a triangle: thirds that cannot
 * hold it are left out. */
static double least_on_line(const struct meeting *m, double s, const phys_vec *a, const phys_vec *b)
{
    double low = 0, high = 1, value[2] = {0};
    for (int i = 0; i < THIRDS; i++) {
        const double part[2] = {low + (high - low) / 3, high - (high - low) / 3};
        for (int k = 0; k < 2; k++) {
            const phys_vec x = (1 - part[k]) * *a + part[k] * *b;
            value[k] = LEVEL[m->shape.kind](m, s, &x);
        }
        *(value[0] < value[1] ? &high : &low) = part[value[0] < value[1]];
    }
    return fmin(value[0], value[1]);
}

static double least_level(const struct meeting *m, double s, const phys_vec x[3])
{
    double low = 0, high = 1, value[2] = {0};
    for (int i = 0; i < THIRDS; i++) {
        const double part[2] = {low + (high - low) / 3, high - (high - low) / 3};
        for (int k = 0; k < 2; k++) {
            const phys_vec a = (1 - part[k]) * x[0] + part[k] * x[1],
                           b = (1 - part[k]) * x[0] + part[k] * x[2];
            value[k] = least_on_line(m, s, &a, &b);
        }
        *(value[0] < value[1] ? &high : &low) = part[value[0] < value[1]];
    }
    return fmin(value[0], value[1]);
}

/* Whether the triangle is surely outside at a time: all of it as its middle is. */
static bool outside_by_middle(const struct meeting *m, double s, const phys_vec x[3])
{
    const phys_vec middle = (x[0] + x[1] + x[2]) / 3;
    double reach = 0;
    for (int k = 0; k < 3; k++) {
        const phys_vec away = x[k] - middle;
        reach = fmax(reach, length(&away));
    }
    return LEVEL[m->shape.kind](m, s, &middle) > 2 * reach;
}

/* The shape at a time as one that stands still, and the triangle as that one sees it: of a box and
 * a cylinder in the axes in which they are what they were. */
static void freeze(const struct meeting *m, double s, struct meeting *still)
{
    *still = *m;
    still->pose = (struct contact_pose){0};
    for (int k = 0; k < 3; k++)
        still->x[k] = (1 - s) * m->x[k] + s * m->y[k];
    if (contact_kinds[m->shape.kind] == &contact_box ||
        contact_kinds[m->shape.kind] == &contact_cylinder) {
        for (int k = 0; k < 3; k++)
            point_then(m, s, still->x + k, still->x + k);
    } else { /* points come first, and what else they have keeps its size */
        const int points = contact_kinds[m->shape.kind] == &contact_capsule ? 2 : 1;
        for (int i = 0; i < points; i++) {
            phys_vec at;
            chord(m, s, m->shape.value + 3 * i, &at);
            for (int c = 0; c < 3; c++)
                still->shape.value[3 * i + c] = at[c];
        }
    }
    contact_solid_make(&still->shape, &still->pose, &still->solid);
}

/* The same by the nearest point, which `nearest` holds against the search above. */
static bool comes_near(const struct meeting *m)
{
    for (int i = 0; i <= TIMES; i++) {
        const double s = (double)i / TIMES;
        struct contact_solid_point point = {.gap = INFINITY};
        struct meeting still;
        phys_vec x[3];
        for (int k = 0; k < 3; k++) {
            x[k] = (1 - s) * m->x[k] + s * m->y[k];
            if (contact_kinds[m->shape.kind] == &contact_plane)
                point.gap = fmin(point.gap, level_plane(m, s, x + k));
        }
        if (contact_kinds[m->shape.kind] != &contact_plane) {
            freeze(m, s, &still);
            contact_solid_nearest(&still.solid, CONTACT_BEGIN, still.x, &point);
        }
        if (!(point.gap > 0))
            return true;
    }
    return false;
}

static bool touches(const struct meeting *m)
{
    for (int i = 0; i <= TIMES; i++) {
        const double s = (double)i / TIMES;
        phys_vec x[3];
        for (int k = 0; k < 3; k++)
            x[k] = (1 - s) * m->x[k] + s * m->y[k];
        if (!outside_by_middle(m, s, x) && !(least_level(m, s, x) > 0))
            return true;
    }
    return false;
}

/* ---- The cases, one for each kind ---- */

static int quick(int n)
{
    return unit_quick() ? n / 10 : n;
}

/* At the end as at the begin, against the gaps of points. */
START_TEST(nearest)
{
    for (int i = 0; i < quick(PAIRS); i++) {
        struct meeting m;
        make_shape((uint32_t)_i, 0.5, 0.5, &m);
        place_triangle(any_size(1e-6, 1), any_size(1e-3, 1), true, 0, &m);
        for (int end = 0; end < 2; end++) {
            const phys_vec *x = end ? m.y : m.x;
            struct contact_solid_point point;
            struct contact_pose pose = m.pose;
            struct contact_hit hit;
            phys_vec at = {0};
            double sum = 0;
            contact_solid_nearest(&m.solid, end ? CONTACT_END : CONTACT_BEGIN, x, &point);
            for (int k = 0; k < 3; k++) {
                ck_assert_double_ge(point.weight[k], 0);
                at += point.weight[k] * x[k];
                sum += point.weight[k];
            }
            pose.to = end ? pose.to : pose.from;
            contact_closest(&m.shape, &pose, 1, &at, &hit);
            const phys_vec off = hit.normal - point.normal;
            ck_assert_double_eq_tol(sum, 1, 1e-14);
            ck_assert_double_eq_tol(hit.gap, point.gap, 1e-12);
            ck_assert_double_le(length(&off) * fabs(point.gap), 1e-12);
            ck_assert_double_ge(least_level(&m, end, x), point.gap - 1e-9);
            if (end) {
                const phys_vec slip = hit.velocity - point.velocity;
                ck_assert_double_le(length(&slip), 1e-9);
            }
        }
    }
}
END_TEST

/* Corners, edges and insides are told from each other, and weights say the same. */
START_TEST(features)
{
    int n[7] = {0};
    for (int i = 0; i < 10 * PAIRS; i++) {
        struct meeting m;
        struct contact_solid_point point;
        make_shape((uint32_t)_i, 0, 0, &m);
        place_triangle(0.1, 1, true, 0, &m);
        contact_solid_nearest(&m.solid, CONTACT_END, m.x, &point);
        n[point.feature]++;
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t edge = point.feature - CONTACT_ON_EDGE;
            const bool has = point.feature == CONTACT_IN_TRIANGLE ||
                             (point.feature < CONTACT_ON_EDGE && point.feature == k) ||
                             (edge < 3 && (edge == k || (edge + 1) % 3 == k));
            ck_assert(has == (point.weight[k] > 0));
        }
    }
    for (int f = 0; f < 7; f++)
        ck_assert(n[f] > 0 || (contact_kinds[_i] == &contact_plane && f >= CONTACT_ON_EDGE));
}
END_TEST

START_TEST(certified_never_touches)
{
    int certified = 0, hit = 0;
    for (int i = 0; i < quick(MANY); i++) {
        struct meeting m;
        const double gap = any_size(1e-6, 1e-2), far = i % 4 ? 0.1 : 100;
        make_shape((uint32_t)_i, far, any_size(1e-3, 0.5), &m);
        place_triangle(gap, any_size(1e-3, 0.3), true, any_size(0.1, 10) * gap, &m);
        const bool is = contact_solid_certify(&m.solid, m.x, m.y, THICKNESS),
                   meets = comes_near(&m);
        ck_assert(!is || !meets);
        ck_assert(i >= quick(BRUTE) || touches(&m) == meets);
        certified += is;
        hit += meets;
    }
    ck_assert_int_gt(certified, quick(MANY) / 4);
    ck_assert_int_gt(hit, quick(MANY) / 20);
}
END_TEST

/* Free flight is not held up: what never comes near is certified. */
START_TEST(what_is_far_is_certified)
{
    int n = 0;
    for (int i = 0; i < quick(MANY); i++) {
        struct meeting m;
        make_shape((uint32_t)_i, i % 2 ? 0.01 : 100, 0.05, &m);
        place_triangle(0.1, 0.02, true, 0.03, &m);
        n += contact_solid_certify(&m.solid, m.x, m.y, THICKNESS);
    }
    ck_assert_int_eq(n, quick(MANY));
}
END_TEST

/* Of a shape that stays every triangle can be cut; of one that moves, those that it lets. */
START_TEST(what_is_cut_is_certified)
{
    for (int still = 0; still < 2; still++) {
        int pinched = 0, cut = 0;
        for (int i = 0; i < MANY; i++) {
            struct meeting m;
            double t[3] = {1, 1, uniform(0, 1)}, part[3] = {t[0], t[1], t[2]};
            const double gap = any_size(1e-6, 1e-2), moves = still ? 0 : any_size(0.01, 1) * gap;
            make_shape((uint32_t)_i, moves, moves, &m);
            place_triangle(gap, any_size(1e-3, 0.3), true, any_size(0.1, 10) * gap, &m);
            if (!contact_solid_cut(&m.solid, m.x, m.y, THICKNESS, 0, part)) {
                pinched++;
                continue;
            }
            phys_vec y[3];
            for (int k = 0; k < 3; k++) {
                const phys_vec way = m.y[k] - m.x[k];
                ck_assert(part[k] >= 0 && part[k] <= t[k]);
                cut += part[k] < t[k];
                y[k] = m.x[k] + part[k] * way;
            }
            for (int k = 0; k < 3; k++)
                m.y[k] = y[k];
            ck_assert(contact_solid_certify(&m.solid, m.x, m.y, THICKNESS));
            ck_assert(i >= quick(BRUTE) || !touches(&m));
            ck_assert(!comes_near(&m));
        }
        ck_assert_int_le(pinched, still ? 0 : MANY / 3);
        ck_assert_int_gt(cut, MANY / 20);
    }
}
END_TEST

/* Nothing is cut of a corner that is held. */
START_TEST(held_corners_stay)
{
    int failed = 0;
    for (int i = 0; i < PAIRS; i++) {
        struct meeting m;
        double t[3] = {1, 1, 1};
        make_shape((uint32_t)_i, 0, 0, &m);
        place_triangle(1e-3, 0.1, true, 3e-3, &m);
        const unsigned held = 1u << i % 3;
        failed += !contact_solid_cut(&m.solid, m.x, m.y, THICKNESS, held, t);
        ck_assert_double_eq(t[i % 3], 1);
    }
    ck_assert_int_gt(failed, 0);
    ck_assert_int_lt(failed, PAIRS * 2 / 3);
}
END_TEST

/* Boxes that are told to be apart hold no point that is near, at any time. */
START_TEST(apart)
{
    int n = 0;
    for (int i = 0; i < quick(MANY); i++) {
        struct meeting m;
        phys_vec middle;
        double low[3], high[3];
        const double reach = uniform(0, 0.2);
        make_shape((uint32_t)_i, 0.3, 0.3, &m);
        pick_point(3, &middle);
        for (int c = 0; c < 3; c++) {
            low[c] = middle[c] - uniform(0, 1);
            high[c] = middle[c] + uniform(0, 1);
        }
        if (!contact_solid_apart(&m.solid, low, high, reach))
            continue;
        n++;
        for (int k = 0; k < 2 * TIMES; k++) { /* corners, and what is between */
            phys_vec x = {0};
            for (int c = 0; c < 3; c++)
                x[c] = k < 8 ? (k >> c & 1 ? high : low)[c] : uniform(low[c], high[c]);
            ck_assert_double_gt(LEVEL[_i](&m, k % 20 / 19.0, &x), 0);
            struct contact_hit hit;
            contact_closest(&m.shape, &m.pose, 1, &x, &hit);
            ck_assert_double_gt(hit.gap, reach);
        }
    }
    ck_assert_int_gt(n, quick(MANY) / 8);
}
END_TEST

/* What passes by is at no time within the reach; far triangles do pass by. */
START_TEST(passing_by)
{
    int by = 0, far = 0;
    for (int i = 0; i < quick(MANY); i++) {
        struct meeting m;
        struct contact_solid_point begin, end;
        const double reach = any_size(1e-4, 1e-1), gap = any_size(0.1, 10) * reach;
        make_shape((uint32_t)_i, 0.3, any_size(1e-3, 0.3), &m);
        place_triangle(gap, 0.1 * gap, true, 0.1 * gap, &m);
        const enum contact_passing is = contact_solid_pass(&m.solid, m.x, m.y, THICKNESS, reach);
        ck_assert((is != CONTACT_MAY_TOUCH) ==
                  contact_solid_certify(&m.solid, m.x, m.y, THICKNESS));
        contact_solid_nearest(&m.solid, CONTACT_BEGIN, m.x, &begin);
        contact_solid_nearest(&m.solid, CONTACT_END, m.y, &end);
        ck_assert(is != CONTACT_PASSES_BY || (begin.gap > reach && end.gap > reach));
        by += is == CONTACT_PASSES_BY;
        far += gap > 2 * reach;
    }
    ck_assert_int_gt(by, far / 4);
}
END_TEST

START_TEST(what_is_not_a_number_is_not_certified)
{
    for (int k = 0; k < 18; k++) {
        struct meeting m;
        make_shape((uint32_t)_i, 0, 0, &m);
        place_triangle(0.1, 0.02, true, 0, &m);
        ck_assert(contact_solid_certify(&m.solid, m.x, m.y, THICKNESS));
        (k < 9 ? m.x : m.y)[k % 9 / 3][k % 3] = NAN;
        ck_assert(!contact_solid_certify(&m.solid, m.x, m.y, THICKNESS));
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("solid");
    TCase *cases = tcase_create("solid");
    const int n = (int)contact_n_kinds - 1; /* bodies are not convex */
    tcase_set_timeout(cases, 120);
    tcase_add_loop_test(cases, nearest, 0, n);
    tcase_add_loop_test(cases, features, 0, n);
    tcase_add_loop_test(cases, certified_never_touches, 0, n);
    tcase_add_loop_test(cases, what_is_far_is_certified, 0, n);
    tcase_add_loop_test(cases, what_is_cut_is_certified, 0, n);
    tcase_add_loop_test(cases, held_corners_stay, 0, n);
    tcase_add_loop_test(cases, apart, 0, n);
    tcase_add_loop_test(cases, passing_by, 0, n);
    tcase_add_loop_test(cases, what_is_not_a_number_is_not_certified, 0, n);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}
