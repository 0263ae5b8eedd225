/* Bodies that change their shape by frames: at every time they are what a body made of their places
 * then is, and their surface has the velocity of its chord. */
#include "cloth/base/memory.h"
#include "cloth/contact/body_skin.h"
#include "cloth/contact/making.h"
#include "tests/cloth/contact/bodies.h"

#include <string.h>

enum { FRAMES = 4, POINTS = 300 };
static const double FIRST = 0.5, RATE = 4;

/* A ball that is drawn out, turned and shifted from frame to frame. */
struct moving {
    struct surface ball;
    double place[FRAMES][BODY_VERTICES][3];
    struct mesh mesh;
    struct contact_bodies bodies;
};

static void place_frame(struct moving *m, int frame, double (*place)[3])
{
    const double turn = 0.3 * frame, c = cos(turn), s = sin(turn);
    for (uint32_t v = 0; v < m->ball.n; v++) {
        const double *x = m->ball.x[v], y = x[1] * (1 + 0.2 * frame);
        place[v][0] = c * x[0] - s * y + 0.1 * frame;
        place[v][1] = s * x[0] + c * y;
        place[v][2] = x[2] + 0.02 * frame * frame;
    }
}

static void make(struct moving *m)
{
    bool turned;
    surface_ball(&m->ball, 0.5, 2);
    surface_mesh(&m->ball, &m->mesh);
    double(*all)[3] = m->place[0];
    for (int k = 0; k < FRAMES; k++)
        place_frame(m, k, all + (size_t)k * m->ball.n);
    const struct contact_frames frames = {FRAMES, FIRST, RATE, (const double(*)[3])all};
    m->bodies = (struct contact_bodies){0};
    UNIT_FINE(contact_bodies_add(&m->bodies, &m->mesh, &turned, &error));
    UNIT_FINE(contact_bodies_add_frames(&m->bodies, &m->mesh, &frames, &turned, &error));
}

static void drop(struct moving *m)
{
    mesh_free(&m->mesh);
    free(m->bodies.memory);
}

/* Where vertices are at a time, by hand. */
static void blend(const struct moving *m, double time, double (*place)[3])
{
    const double(*all)[3] = m->place[0];
    const double count = fmin(fmax((time - FIRST) * RATE, 0), FRAMES - 1);
    const uint32_t k = (uint32_t)fmin(floor(count), FRAMES - 2);
    for (uint32_t v = 0; v < m->ball.n; v++)
        for (int c = 0; c < 3; c++) {
            const double a = all[(size_t)k * m->ball.n + v][c];
            const double b = all[(size_t)(k + 1) * m->ball.n + v][c];
            place[v][c] = a + (count - k) * (b - a);
        }
}

static double random_in(double low, double high)
{
    return low + (high - low) * rand() / RAND_MAX;
}

static void pick(phys_vec *x)
{
    *x = (phys_vec){random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), 0};
}

UNIT_TEST(is_a_body_of_its_places)
{
    static struct moving m;
    static double place[BODY_VERTICES][3];
    const double times[] = {0, 0.5, 0.6, 0.75, 1.07, 1.25, 3};
    make(&m);
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        struct contact_bodies same = {0};
        bool turned;
        blend(&m, times[i], place);
        memcpy(m.mesh.position, place, m.ball.n * sizeof *place);
        UNIT_FINE(contact_bodies_add(&same, &m.mesh, &turned, &error));
        contact_bodies_move(&m.bodies, times[i] - 0.01, times[i]);
        const struct contact_body *body = contact_bodies_at(&m.bodies, 2);
        for (int k = 0; k < POINTS; k++) {
            const struct contact_shape shape[2] = {{.kind = 5, .body = 2}, {.kind = 5, .body = 1}};
            struct contact_hit hit, due;
            struct contact_pose pose;
            phys_vec x;
            pick(&x);
            contact_pose_over(shape, NULL, &m.bodies, times[i] - 0.01, times[i], &pose);
            contact_closest(shape, &pose, 1, &x, &hit);
            contact_pose_over(shape + 1, NULL, &same, 0, 0, &pose);
            contact_closest(shape + 1, &pose, 1, &x, &due);
            const phys_vec off = hit.normal - due.normal;
            ck_assert_double_eq_tol(hit.gap, due.gap, 1e-12);
            ck_assert_double_le(phys_dot(&off, &off), 1e-18);
        }
        for (int c = 0; c < 3; c++) {
            ck_assert_double_eq_tol(body->low[c], contact_bodies_at(&same, 1)->low[c], 1e-13);
            ck_assert_double_eq_tol(body->high[c], contact_bodies_at(&same, 1)->high[c], 1e-13);
        }
        free(same.memory);
    }
    drop(&m);
}

/* The nearest point goes with its triangle: where it was, the surface was. */
UNIT_TEST(the_surface_has_its_velocity)
{
    static struct moving m;
    const struct contact_shape shape = {.kind = 5, .body = 2};
    const double from = 0.62, to = 0.68;
    make(&m);
    for (int k = 0; k < POINTS; k++) {
        struct contact_hit hit, was;
        struct contact_pose pose;
        phys_vec x;
        pick(&x);
        contact_bodies_move(&m.bodies, from, to);
        contact_pose_over(&shape, NULL, &m.bodies, from, to, &pose);
        contact_closest(&shape, &pose, 1, &x, &hit);
        ck_assert_double_gt(phys_dot(&hit.velocity, &hit.velocity), 0.001);
        const phys_vec back = x - hit.gap * hit.normal - (to - from) * hit.velocity;
        contact_bodies_move(&m.bodies, from, from);
        contact_pose_over(&shape, NULL, &m.bodies, from, from, &pose);
        contact_closest(&shape, &pose, 1, &back, &was);
        ck_assert_double_eq_tol(was.gap, 0, 1e-12);
        ck_assert_double_eq(phys_dot(&was.velocity, &was.velocity), 0);
    }
    drop(&m);
}

/* Whatever times it was moved to before; the body without frames is as it was. */
UNIT_TEST(times_alone_say_the_bytes)
{
    static struct moving m;
    make(&m);
    contact_bodies_move(&m.bodies, 0.7, 0.71);
    char *bytes = malloc(m.bodies.bytes);
    memcpy(bytes, m.bodies.memory, m.bodies.bytes);
    contact_bodies_move(&m.bodies, 1, 2);
    ck_assert(memcmp(bytes, m.bodies.memory, m.bodies.bytes) != 0);
    ck_assert_mem_eq(bytes, m.bodies.memory, contact_bodies_at(&m.bodies, 1)->bytes);
    contact_bodies_move(&m.bodies, 0.7, 0.71);
    ck_assert_mem_eq(bytes, m.bodies.memory, m.bodies.bytes);
    free(bytes);
    const struct contact_body *body = contact_bodies_at(&m.bodies, 2);
    ck_assert(contact_body_moves_after(body, 1.2) && !contact_body_moves_after(body, 1.25));
    ck_assert(!contact_body_moves_after(contact_bodies_at(&m.bodies, 1), 0));
    drop(&m);
}

UNIT_TEST(ends_of_steps)
{
    static struct moving m;
    static double place[BODY_VERTICES][3];
    const struct contact_shape shape = {.kind = 5, .body = 2};
    struct contact_pose pose;
    make(&m);
    const struct contact_body *body = contact_bodies_at(&m.bodies, 2);
    phys_vec *x = aligned_alloc(CONTACT_ALIGN, 2 * body->n_vertices * sizeof *x), way;
    phys_vec *y = x + body->n_vertices;
    contact_pose_over(&shape, NULL, &m.bodies, 0.6, 0.9, &pose);
    contact_body_ends(body, &pose, x, y, &way);
    for (int end = 0; end < 2; end++) {
        blend(&m, end ? 0.9 : 0.6, place);
        for (uint32_t v = 0; v < body->n_vertices; v++)
            for (int c = 0; c < 3; c++)
                ck_assert_double_eq_tol((end ? y : x)[v][c], place[v][c], 1e-15);
    }
    ck_assert_double_eq_tol(way[0], 0.1 * 0.3 * RATE, 1e-12);
    free(x);
    drop(&m);
}

/* Also of triangles that are a line: their corners come in any order on it. */
UNIT_TEST(angles)
{
    const double pi = acos(-1);
    const phys_vec a = {1, 2, -3, 0}, across = {3, 0, 1, 0}, none = {0};
    const phys_vec ahead = 2 * a, back = -0.5 * a;
    ck_assert_double_eq_tol(contact_angle(&a, &across), pi / 2, 1e-15);
    ck_assert_double_eq_tol(contact_angle(&a, &ahead), 0, 1e-15);
    ck_assert_double_eq_tol(contact_angle(&a, &back), pi, 1e-15);
    ck_assert_double_eq(contact_angle(&a, &none), 0);
    ck_assert_double_eq(contact_angle(&none, &none), 0);
}

/* A corner of a box goes along an edge to the other corner of it, where two triangles have no area
 * any more. A wedge is left. Its inside is inside, and normals have the length 1: that of the
 * corner is along a sum of those of the triangles with an area. */
UNIT_TEST(triangles_that_lose_their_area)
{
    struct surface box;
    struct mesh mesh;
    struct contact_bodies bodies = {0};
    bool turned;
    surface_box(&box, 1, 1, 1);
    surface_mesh(&box, &mesh);
    double place[2][8][3];
    memcpy(place[0], box.x, sizeof place[0]);
    memcpy(place[1], box.x, sizeof place[1]);
    memcpy(place[1][7], place[1][3], sizeof place[1][7]); /* (1, 1, 1) to (1, 1, -1) */
    const struct contact_frames frames = {2, 0, 1, (const double(*)[3])place[0]};
    UNIT_FINE(contact_bodies_add_frames(&bodies, &mesh, &frames, &turned, &error));
    contact_bodies_move(&bodies, 1, 1);
    const struct contact_body *body = contact_bodies_at(&bodies, 1);
    for (uint32_t v = 0; v < body->n_vertices; v++)
        ck_assert_double_eq_tol(
            phys_dot(contact_body_normals(body) + v, contact_body_normals(body) + v), 1, 1e-12);
    const struct contact_shape shape = {.kind = 5, .body = 1};
    const phys_vec at[2] = {{1 - 1e-3, 1 - 1e-3, -1 + 5e-4, 0}, {1 + 1e-3, 1 + 1e-3, -1 - 1e-3, 0}};
    struct contact_pose pose;
    struct contact_hit hit[2];
    contact_pose_over(&shape, NULL, &bodies, 1, 1, &pose);
    contact_closest(&shape, &pose, 2, at, hit);
    ck_assert_double_lt(hit[0].gap, 0);
    ck_assert_double_eq_tol(hit[1].gap, sqrt(3) * 1e-3, 1e-12);
    mesh_free(&mesh);
    free(bodies.memory);
}

UNIT_TEST(frames_that_are_nowhere)
{
    static struct moving m;
    bool turned;
    make(&m);
    double(*all)[3] = m.place[0];
    all[2 * (size_t)m.ball.n + 6][1] = NAN;
    const struct contact_frames frames = {FRAMES, FIRST, RATE, (const double(*)[3])all};
    const uint64_t bytes = m.bodies.bytes;
    UNIT_REFUSED(contact_bodies_add_frames(&m.bodies, &m.mesh, &frames, &turned, &error),
                 CLOTH_E_INPUT, "vertex 7 of frame 3 is ");
    ck_assert_uint_eq(m.bodies.bytes, bytes);
    drop(&m);
}
