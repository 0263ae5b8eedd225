/* Maps of bodies against closed forms, against every triangle there is, and against the tree that
 * is exact. */
#include "tests/cloth/contact/images.h"

#include <unistd.h>

/* ---- A ball ---- */

/* Depths are off by what the triangles are inside of the ball, along the axis. */
UNIT_LOOP(ball_is_seen_as_a_ball, 0, 3)
{
    static struct surface ball;
    struct shown s;
    surface_ball(&ball, R, 4);
    show(&s, &ball, NULL, (uint32_t)_i, CONTACT_STRIPS);
    const double sag = 6e-4;
    ck_assert(s.view.axis == (uint32_t)_i && s.view.width + s.view.height >= 2 * RESOLUTION - 2);
    for (uint32_t j = 0; j < s.view.height; j++)
        for (uint32_t i = 0; i < s.view.width; i++) {
            const struct contact_pixel *pixel = pixel_of(&s, i, j);
            double at[2];
            pixel_middle(&s, i, j, at);
            const double far = sqrt(at[0] * at[0] + at[1] * at[1]);
            if (is_covered(pixel))
                ck_assert_double_le(far, R);
            else
                ck_assert_double_ge(far, R - 2.5 * sag);
            if (far > 0.95 * R)
                continue;
            const double up = sqrt(R * R - far * far);
            for (int side = 0; side < 2; side++) {
                const double depth = (double)pixel->depth[side] + s.body->low[_i];
                const float *n = pixel->normal[side];
                const double towards = side ? -up : up;
                ck_assert_double_eq_tol(depth, towards, sag * R / up);
                const double due[3] = {towards / R, at[0] / R, at[1] / R};
                for (int c = 0; c < 3; c++)
                    ck_assert_double_eq_tol((double)n[(_i + c) % 3], due[c], 5e-3);
            }
        }
    drop(&s);
}

/* Near the surface, and where it is not seen from beside, gaps are those of the tree to second
 * order. */
UNIT_TEST(gaps_near_a_ball)
{
    static struct surface ball;
    struct shown s;
    surface_ball(&ball, R, 4);
    show(&s, &ball, NULL, CONTACT_THINNEST, CONTACT_STRIPS);
    for (int k = 0; k < POINTS; k++) {
        struct contact_hit map, tree;
        phys_vec x;
        pick(1, &x);
        x *= (R + random_in(-0.005, 0.005)) / sqrt(phys_dot(&x, &x));
        if (fabs(x[s.view.axis]) < 0.3 * R)
            continue;
        closest(&s, &x, &map, &tree);
        ck_assert_double_eq_tol(map.gap, tree.gap, 1e-3);
        ck_assert_double_eq_tol(sqrt(phys_dot(&map.normal, &map.normal)), 1, 1e-6);
        ck_assert_double_gt(phys_dot(&map.normal, &x), 0.997 * sqrt(phys_dot(&x, &x)));
        ck_assert_double_eq(phys_dot(&map.velocity, &map.velocity), 0);
    }
    drop(&s);
}

/* ---- Inside ---- */

static void check_inside(const struct surface *of, uint32_t axis)
{
    struct shown s;
    int inside = 0, beside = 0;
    show(&s, of, NULL, axis, CONTACT_STRIPS);
    for (int k = 0; k < POINTS; k++) {
        struct contact_hit map, tree;
        phys_vec x;
        pick(0.6, &x);
        closest(&s, &x, &map, &tree);
        inside += map.gap <= 0;
        beside += map.gap >= INFINITY;
        if (fabs(tree.gap) > 1.5 * s.view.pitch)
            ck_assert_msg((map.gap <= 0) == (tree.gap <= 0), "%g, by the tree %g", map.gap,
                          tree.gap);
    }
    ck_assert_int_gt(inside, POINTS / 50);
    ck_assert_int_gt(beside, POINTS / 50);
    drop(&s);
}

UNIT_LOOP(inside_of_convex_bodies, 1, 4)
{
    static struct surface of;
    surface_ball(&of, R, _i);
    for (uint32_t axis = 0; axis < 3; axis++)
        check_inside(&of, axis);
    for (uint32_t v = 0; v < of.n; v++) { /* an egg that leans */
        of.x[v][1] *= 0.6;
        of.x[v][0] += 0.4 * of.x[v][1];
    }
    check_inside(&of, CONTACT_THINNEST);
}

/* Sides along the view are not seen: the way out is the front or the back. */
UNIT_TEST(box_has_a_front_and_a_back)
{
    static struct surface box;
    struct shown s;
    surface_box(&box, 0.3, 0.1, 0.2);
    show(&s, &box, NULL, CONTACT_THINNEST, CONTACT_STRIPS);
    ck_assert_uint_eq(s.view.axis, 1);
    ck_assert_uint_eq(s.view.height, RESOLUTION);
    for (int k = 0; k < POINTS; k++) {
        struct contact_hit hit;
        phys_vec x;
        pick(0.4, &x);
        contact_image_closest(&s.image, 1, &x, &hit);
        const double out = fmax(fabs(x[0]) - 0.3, fabs(x[2]) - 0.2);
        if (out > s.view.pitch)
            ck_assert_double_eq(hit.gap, INFINITY);
        if (out > -s.view.pitch)
            continue;
        ck_assert_double_eq_tol(hit.gap, fabs(x[1]) - 0.1, 1e-7);
        ck_assert_double_eq_tol(hit.normal[1] * x[1], fabs(x[1]), 1e-9);
    }
    const phys_vec nowhere = {NAN, 0, 0, 0};
    struct contact_hit hit;
    contact_image_closest(&s.image, 1, &nowhere, &hit);
    ck_assert_double_eq(hit.gap, INFINITY);
    drop(&s);
}

/* ---- Triangles ---- */

/* The largest depth of any triangle there, by the plane of each. near: the middle of the pixel is
 * so near to an edge that it may belong to either side. */
static double deepest(const struct shown *s, const double at[2], double towards, bool *near)
{
    const struct contact_facet *facet = contact_body_facets(s->body);
    const phys_vec *x = contact_body_vertices(s->body);
    const uint32_t u = (s->view.axis + 1) % 3, v = (s->view.axis + 2) % 3;
    double most = -INFINITY;
    for (uint32_t f = 0; f < s->body->n_triangles; f++) {
        double side[3], depth = 0, least = INFINITY, area = 0;
        for (int k = 0; k < 3; k++) {
            const phys_vec *a = x + facet[f].corner[(k + 1) % 3],
                           *b = x + facet[f].corner[(k + 2) % 3];
            side[k] =
                ((*b)[u] - (*a)[u]) * (at[1] - (*a)[v]) - ((*b)[v] - (*a)[v]) * (at[0] - (*a)[u]);
            area += side[k];
        }
        for (int k = 0; k < 3; k++) {
            least = fmin(least, side[k] / area);
            depth += side[k] / area * x[facet[f].corner[k]][s->view.axis];
        }
        *near = *near || fabs(least) < 1e-3;
        if (least >= 0)
            most = fmax(most, towards * depth);
    }
    return most;
}

/* A ring that leans, seen along each axis: from the side it hides itself. */
UNIT_LOOP(ring_is_that_of_all_triangles, 0, 3)
{
    static struct surface ring;
    struct shown s;
    int n = 0;
    surface_torus(&ring, 0.4, 0.11, 31, 17);
    for (uint32_t v = 0; v < ring.n; v++)
        ring.x[v][1] += 0.37 * ring.x[v][0] + 0.21 * ring.x[v][2];
    show(&s, &ring, NULL, (uint32_t)_i, 5);
    for (uint32_t j = 0; j < s.view.height; j++)
        for (uint32_t i = 0; i < s.view.width; i++) {
            const struct contact_pixel *pixel = pixel_of(&s, i, j);
            const bool covered = is_covered(pixel);
            bool near = false;
            double at[2];
            if ((i + j) % 7)
                continue;
            pixel_middle(&s, i, j, at);
            const double front = deepest(&s, at, 1, &near), back = -deepest(&s, at, -1, &near);
            if (near)
                continue;
            n++;
            ck_assert(covered == (front > -INFINITY));
            if (!covered)
                continue;
            ck_assert_double_eq_tol((double)pixel->depth[0] + s.body->low[_i], front, 1e-4);
            ck_assert_double_eq_tol((double)pixel->depth[1] + s.body->low[_i], back, 1e-4);
        }
    ck_assert_int_gt(n, 1000);
    drop(&s);
}

/* Middles of pixels on edges, of a double pyramid: on those inside there are no holes, and of its
 * outline just half of the sides have theirs. */
UNIT_LOOP(edges_have_their_pixels_once, 0, 2)
{
    static struct surface pyramid;
    struct shown s;
    uint32_t inside = 0, due = 0, outline = 0;
    pyramid = (struct surface){.n = 6, .x = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}};
    pyramid.x[4][2] = 0.5;
    pyramid.x[5][2] = -0.5;
    for (uint32_t i = 0; i < 8; i++) {
        const uint32_t x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2);
        const bool flips = (x + y + z) % 2;
        surface_add(&pyramid, x, flips ? z : y, flips ? y : z);
    }
    show(&s, &pyramid, NULL, 2, CONTACT_STRIPS);
    contact_view_make(s.body, 2, RESOLUTION + (uint32_t)_i, &s.view);
    draw(&s);
    for (uint32_t j = 0; j < s.view.height; j++)
        for (uint32_t i = 0; i < s.view.width; i++) {
            const int64_t from = (int64_t)s.view.width;
            const int64_t far = llabs(2 * (int64_t)i + 1 - from) + llabs(2 * (int64_t)j + 1 - from);
            const bool covered = is_covered(pixel_of(&s, i, j));
            ck_assert(far <= from || !covered);
            inside += covered && far < from;
            due += far < from;
            outline += covered && far == from;
        }
    ck_assert_uint_eq(inside, due);
    ck_assert_uint_eq(outline, _i ? 0 : RESOLUTION);
    drop(&s);
}

/* However the rows are cut, and whatever was in the memory. */
UNIT_TEST(strips_do_not_change_bits)
{
    static struct surface ring;
    struct shown whole, cut;
    surface_torus(&ring, 0.4, 0.11, 31, 17);
    show(&whole, &ring, NULL, 2, 1);
    show(&cut, &ring, NULL, 2, CONTACT_STRIPS);
    ck_assert_uint_eq(contact_view_strips(&whole.view), 1);
    ck_assert_uint_gt(contact_view_strips(&cut.view), CONTACT_STRIPS / 2);
    for (uint32_t j = 0; j < whole.view.height; j++)
        ck_assert_mem_eq(pixel_of(&whole, 0, j), pixel_of(&cut, 0, j),
                         whole.view.width * sizeof(struct contact_pixel));
    drop(&whole);
    drop(&cut);
}

/* ---- Frames ---- */

/* An egg that is drawn out, turned and shifted: its maps have the velocity of the chord, and are as
 * large in every frame. */
UNIT_TEST(bodies_by_frames)
{
    enum { FRAMES = 3 };
    static struct surface ball;
    static double place[FRAMES][BODY_VERTICES][3];
    struct shown s;
    surface_ball(&ball, R, 3);
    double(*all)[3] = place[0];
    for (uint32_t k = 0; k < FRAMES; k++)
        for (uint32_t v = 0; v < ball.n; v++) {
            double *to = all[(size_t)k * ball.n + v];
            const double c = cos(0.2 * k), n = sin(0.2 * k), *x = ball.x[v];
            const double wide = x[0] * (1 + 0.3 * k);
            to[0] = c * wide - n * x[1] + 0.1 * k;
            to[1] = n * wide + c * x[1];
            to[2] = 0.8 * x[2] + 0.3 * k;
        }
    const struct contact_frames frames = {FRAMES, 0, 10, (const double(*)[3])all};
    show(&s, &ball, &frames, CONTACT_THINNEST, 7);
    ck_assert_uint_eq(s.view.axis, 2);
    for (double time = 0; time < 0.25; time += 0.03) {
        int inside = 0;
        contact_bodies_move(&s.bodies, time - 0.01, time);
        draw(&s);
        for (int k = 0; k < POINTS / 10; k++) {
            struct contact_hit map, tree;
            phys_vec x;
            pick(0.6, &x);
            x += (phys_vec){1 * time, 0, 3 * time, 0};
            closest(&s, &x, &map, &tree);
            inside += map.gap <= 0;
            if (fabs(tree.gap) > 1.5 * s.view.pitch)
                ck_assert((map.gap <= 0) == (tree.gap <= 0));
            if (fabs(tree.gap) > 0.01 || fabs(tree.normal[2]) < 0.3)
                continue;
            const phys_vec off = map.velocity - tree.velocity;
            ck_assert_double_lt(sqrt(phys_dot(&off, &off)), 0.06);
            ck_assert(time <= 0 || time > 0.2 || map.velocity[2] > 2.99);
        }
        ck_assert_int_gt(inside, POINTS / 100);
    }
    drop(&s);
}

/* ---- A body of others ---- */

/* Both maps have the same pixels; just under what is seen a point is inside by both ways, and just
 * above it outside. */
UNIT_LOOP(figure, 0, access(real_body_path(), R_OK) == 0)
{
    struct mesh mesh;
    struct shown s = {0};
    bool turned;
    int covered = 0, differ = 0;
    UNIT_FINE(mesh_read_surface(&mesh, real_body_path(), &error));
    UNIT_FINE(contact_bodies_add(&s.bodies, &mesh, &turned, &error));
    mesh_free(&mesh);
    s.body = contact_bodies_at(&s.bodies, 1);
    contact_view_make(s.body, CONTACT_THINNEST, 512, &s.view);
    ck_assert_uint_eq(s.view.axis, 2);
    draw(&s);
    for (uint32_t j = 0; j < s.view.height; j++)
        for (uint32_t i = 0; i < s.view.width; i++) {
            const struct contact_pixel *pixel = pixel_of(&s, i, j);
            double at[2];
            if (!is_covered(pixel) || (i + j) % 3)
                continue;
            pixel_middle(&s, i, j, at);
            for (int k = 0; k < 4; k++) { /* by 1 mm out and in */
                const double depth = (double)pixel->depth[k / 2] + (k % 2 ? 0.01 : -0.01);
                const phys_vec x = {at[0], at[1], depth + s.body->low[2], 0};
                struct contact_hit map, tree;
                closest(&s, &x, &map, &tree);
                differ += (map.gap <= 0) != (tree.gap <= 0);
                covered++;
            }
        }
    ck_assert_int_gt(covered, 40000);
    ck_assert_msg(differ < covered / 100, "%d of %d points differ", differ, covered);
    drop(&s);
}
