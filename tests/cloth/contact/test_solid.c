/* Triangles against moving convex shapes. Certified ones are held against the shape at many times
 * between both ends. Its places at these times, and its inside, are computed here once more. */
#include "tests/cloth/contact/solids.h"
#include "tests/support/unit.h"

enum { BRUTE = 12, PAIRS = 60, MANY = 2000 };
static const double THICKNESS = 1e-3;

/* ---- The cases, one for each kind ---- */

static int quick(int n)
{
    return unit_quick() ? n / 10 : n;
}

/* The last kind is bodies: test_body.c. */
#define N_SHAPES ((int)contact_n_kinds - 1)

/* At the end as at the begin, against the gaps of points. */
UNIT_LOOP(nearest, 0, N_SHAPES)
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

/* Corners, edges and insides are told from each other, and weights say the same. */
UNIT_LOOP(features, 0, N_SHAPES)
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

UNIT_LOOP(certified_never_touches, 0, N_SHAPES)
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

/* Free flight is not held up: what never comes near is certified. */
UNIT_LOOP(what_is_far_is_certified, 0, N_SHAPES)
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

/* Every triangle at a shape that stays can be cut; at one that moves, those that it lets. */
UNIT_LOOP(what_is_cut_is_certified, 0, N_SHAPES)
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

/* A ball of 0.1 m goes by `shift` past what begins 0.2 m from its centre. Ends are told from its
 * centre then, angles from the way to where the triangle was. */
static void pass_ball(const double shift[2], const double radius[3], double degrees, double part[3])
{
    struct meeting m = {.shape = {.kind = 0, .n = 2, .value = {0, 0, 0, 0.1}}};
    const double angle = degrees * 0.017453292519943295;
    while (contact_kinds[m.shape.kind] != &contact_sphere)
        m.shape.kind++;
    m.keys[0] = (struct phys_key){.rotate = {1, 0, 0, 0}};
    m.keys[1] =
        (struct phys_key){.time = 1, .translate = {shift[0], shift[1], 0}, .rotate = {1, 0, 0, 0}};
    contact_pose_over(&m.shape, m.keys, NULL, 0, 1, &m.pose);
    contact_solid_make(&m.shape, &m.pose, &m.solid);
    for (int k = 0; k < 3; k++) {
        const double aside = (k - 1) * 1e-4, along = 1e-4 * (k == 1);
        m.x[k] = (phys_vec){0.2, along, aside, 0};
        m.y[k] = (phys_vec){shift[0] + radius[k] * cos(angle),
                            shift[1] + radius[k] * sin(angle) + along, aside, 0};
        part[k] = 1;
    }
    ck_assert(contact_solid_certify(&m.solid, m.x, m.x, THICKNESS));
    ck_assert(!contact_solid_certify(&m.solid, m.x, m.y, THICKNESS));
    ck_assert(contact_solid_cut(&m.solid, m.x, m.y, THICKNESS, 0, part));
}

/* It cuts along the direction that cuts least: that to the end, (cos 14, sin 14), leaves whole what
 * ends outside. The one to the end of what stays, n = (0.08, 0.1) / 0.1281, would leave 0.6, the
 * mean of that and the one of the begin 0.96. On the far side the direction to the end divides
 * nothing. Along n what stays has 0.0281 m, what goes all its way -0.1937 m, and 1e-4 m, a tenth of
 * the thickness, is due. */
UNIT_TEST(cuts_along_what_cuts_least)
{
    const double shift[2] = {0.12, -0.1};
    double part[3];
    pass_ball(shift, (const double[3]){0.1015, 0.1015, 0.0999}, 14, part);
    ck_assert_double_eq(part[0], 1);
    ck_assert_double_eq(part[1], 1);
    ck_assert(part[2] > 0.8 && part[2] < 1);
    pass_ball(shift, (const double[3]){0.15, 0.15, 0.15}, 180, part);
    for (int k = 0; k < 3; k++)
        ck_assert_double_eq_tol(part[k], 0.0280 / 0.2218, 1e-3);
}

/* The direction of the begin is taken if it divides all that goes less: there 0.1 m of 0.4 m. That
 * of the end would leave 0.36. */
UNIT_TEST(cuts_along_that_of_the_begin)
{
    double part[3];
    pass_ball((const double[2]){0, -0.15}, (const double[3]){0.2, 0.2, 0.2}, 180, part);
    for (int k = 0; k < 3; k++)
        ck_assert_double_eq_tol(part[k], (0.1 - 1e-4) / 0.4, 1e-6);
}

/* A corner that is held is not cut. */
UNIT_LOOP(held_corners_stay, 0, N_SHAPES)
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

/* Boxes that are told to be apart hold no point that is near, at any time. */
UNIT_LOOP(apart, 0, N_SHAPES)
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
            ck_assert_double_gt(level(&m, k % 20 / 19.0, &x), 0);
            struct contact_hit hit;
            contact_closest(&m.shape, &m.pose, 1, &x, &hit);
            ck_assert_double_gt(hit.gap, reach);
        }
    }
    ck_assert_int_gt(n, quick(MANY) / 8);
}

/* Also where the shortest turn to the normal is one of many. */
UNIT_TEST(planes_along_the_axes)
{
    for (int k = 0; k < 6; k++) {
        struct contact_shape shape = {.value = {0.1, 0.2, 0.3}};
        struct contact_pose pose;
        struct contact_solid solid;
        struct contact_solid_point on;
        struct contact_hit hit;
        const phys_vec x[3] = {{0.5, 0.7, 0.9}, {0.5, 0.7, 0.9}, {0.5, 0.7, 0.9}};
        shape.value[3 + k / 2] = k % 2 ? -1 : 1;
        while (contact_kinds[shape.kind] != &contact_plane)
            shape.kind++;
        contact_pose_over(&shape, NULL, NULL, 0, 1, &pose);
        contact_solid_make(&shape, &pose, &solid);
        contact_solid_nearest(&solid, CONTACT_END, x, &on);
        contact_closest(&shape, &pose, 1, x, &hit);
        ck_assert_double_eq_tol(on.gap, hit.gap, 1e-12);
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(on.normal[c], hit.normal[c], 1e-12);
    }
}

/* No point of a surface goes farther in the step; without a turn all of them go as far. */
UNIT_LOOP(way_of_the_shape, 0, N_SHAPES)
{
    for (int i = 0; i < quick(MANY); i++) {
        struct meeting m;
        struct contact_solid_point on;
        const double turn = i % 2 ? 0.3 : 0;
        make_shape((uint32_t)_i, 0.3, turn, &m);
        place_triangle(any_size(1e-3, 1), 0.1, true, 0, &m);
        contact_solid_nearest(&m.solid, CONTACT_END, m.y, &on);
        const double way = contact_solid_way(&m.solid);
        const double went = sqrt(phys_dot(&on.velocity, &on.velocity));
        ck_assert_double_le(went, way + 1e-12);
        ck_assert(turn > 0 || m.solid.endless || way < went + 1e-9);
    }
}

/* Triangles that pass by are at no time within the reach; far triangles do pass by. */
UNIT_LOOP(passing_by, 0, N_SHAPES)
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

UNIT_LOOP(what_is_not_a_number_is_not_certified, 0, N_SHAPES)
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
