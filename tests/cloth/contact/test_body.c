/* Bodies: gaps against brute force over all triangles, signs against the winding number, normals of
 * edges and corners, what is apart; the real body where it is beside the source tree. Meshes that
 * are refused leave the bodies before them as they were (tests/cloth/scene/sentences.txt has more
 * of them). A part that is inside out is turned round, or a hole. */
#include "cloth/contact/shape.h"
#include "tests/cloth/contact/bodies.h"
#include "tests/cloth/contact/distances.h"
#include "tests/support/random.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { N_MADE = 4, POINTS = 600 };

static struct surface made;
static struct contact_bodies bodies;
static struct mesh mesh;

static void end(void)
{
    free(bodies.memory);
    bodies = (struct contact_bodies){0};
    mesh_free(&mesh);
}

/* A mesh anywhere, of any size and turn. */
static void make(int which)
{
    struct mesh_transform pose = mesh_identity;
    if (which == 0)
        surface_box(&made, 0.3, 0.2, 0.5);
    else if (which == 1)
        surface_torus(&made, 0.5, 0.2, 24, 12);
    else
        surface_ball(&made, 0.5, which == 2 ? 1 : 3);
    surface_mesh(&made, &mesh);
    pose.scale[0] = uniform(0.3, 3);
    pose.scale[1] = uniform(0.3, 3);
    for (int c = 0; c < 3; c++)
        pose.translate[c] = uniform(-2, 2);
    for (int c = 0; c < 4; c++)
        pose.rotate[c] = uniform(-1, 1);
    mesh_apply(&mesh, &pose);
}

static const struct contact_body *body_of(void)
{
    bool turned = true;
    UNIT_FINE(contact_bodies_add(&bodies, &mesh, &turned, &error));
    ck_assert(!turned);
    return contact_bodies_at(&bodies, bodies.n);
}

static void find(const struct contact_body *body, size_t n, const phys_vec *x,
                 struct contact_hit *hit)
{
    contact_body_kind.closest(NULL, body, n, x, hit);
}

/* ---- Another way to the same ---- */

static void corner_of(uint32_t t, int i, phys_vec *x)
{
    const double *p = mesh.position + 3 * (size_t)mesh.triangle[3 * (size_t)t + (size_t)i];
    *x = (phys_vec){p[0], p[1], p[2], 0};
}

static double brute_distance(const phys_vec *x)
{
    double least = INFINITY;
    phys_vec p[4] = {*x};
    for (uint32_t t = 0; t < mesh.n_triangles; t++) {
        for (int i = 0; i < 3; i++)
            corner_of(t, i, p + 1 + i);
        least = fmin(least, vertex_distance(p));
    }
    return least;
}

/* The winding number: the solid angles of all triangles (van Oosterom & Strackee 1983). */
static bool is_inside(const phys_vec *x)
{
    double sum = 0;
    for (uint32_t t = 0; t < mesh.n_triangles; t++) {
        phys_vec p[3];
        double l[3], volume = 0, rest = 0;
        for (int i = 0; i < 3; i++) {
            corner_of(t, i, p + i);
            p[i] -= *x;
            l[i] = length(p + i);
        }
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            volume += p[0][i] * (p[1][j] * p[2][k] - p[1][k] * p[2][j]);
            rest += phys_dot(p + i, p + j) * l[k];
        }
        sum += 2 * atan2(volume, l[0] * l[1] * l[2] + rest);
    }
    return fabs(sum) > 2 * acos(-1);
}

/* ---- Tests ---- */

/* Anywhere in a box somewhat larger than the body; every other one near to a triangle. */
static void pick_point(int i, phys_vec *x)
{
    const uint32_t t = (uint32_t)uniform(0, mesh.n_triangles);
    const double u = uniform(0, 1), v = uniform(0, 1 - u), off = i % 4 == 1 ? 1e-3 : 0.3;
    phys_vec p[3];
    for (int k = 0; k < 3; k++)
        corner_of(i % 2 ? t : (uint32_t)uniform(0, mesh.n_triangles), k, p + k);
    *x = p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]);
    for (int c = 0; c < 3; c++)
        (*x)[c] += uniform(-off, off);
}

/* The gap, and that the way along the normal ends on the surface. */
static void check_hit(const phys_vec *x, const struct contact_hit *hit)
{
    const phys_vec foot = *x - hit->gap * hit->normal;
    ck_assert_double_eq_tol(fabs(hit->gap), brute_distance(x), 1e-12);
    ck_assert_double_eq_tol(brute_distance(&foot), 0, 1e-12);
    ck_assert_double_eq_tol(phys_dot(&hit->normal, &hit->normal), 1, 1e-12);
    if (fabs(hit->gap) > 1e-9)
        ck_assert_int_eq(hit->gap < 0, is_inside(x));
}

UNIT_FIXTURE(NULL, end)

UNIT_LOOP(nearest_of_all, 0, N_MADE)
{
    static phys_vec x[POINTS];
    static struct contact_hit hit[POINTS], alone;
    size_t inside = 0;
    for (int round = 0; round < 3; round++) {
        random_seed = (uint64_t)(10 * _i + round);
        make(_i);
        const struct contact_body *body = body_of();
        const int n = mesh.n_triangles > 1000 ? POINTS / 4 : POINTS;
        for (int i = 0; i < n; i++)
            pick_point(i, x + i);
        find(body, (size_t)n, x, hit);
        for (int i = 0; i < n; i++) {
            check_hit(x + i, hit + i);
            inside += hit[i].gap < 0;
            find(body, 1, x + i, &alone); /* whatever came before it */
            ck_assert(alone.gap == hit[i].gap);
            ck_assert_mem_eq(&alone.normal, &hit[i].normal, sizeof alone.normal);
        }
        mesh_free(&mesh);
    }
    ck_assert_uint_gt(inside, 100);
}

/* A copy of the memory elsewhere is the same bodies; a second body leaves the first as it was. */
UNIT_TEST(lies_anywhere)
{
    struct contact_bodies copy;
    struct contact_hit here[2], there[2];
    const phys_vec x = {0.1, 0.9, 0.2, 0};
    make(1);
    find(body_of(), 1, &x, here);
    mesh_free(&mesh);
    make(2);
    find(body_of(), 1, &x, here + 1);
    copy = bodies;
    copy.memory = aligned_alloc(CONTACT_ALIGN, bodies.bytes);
    ck_assert_ptr_nonnull(copy.memory);
    memcpy(copy.memory, bodies.memory, bodies.bytes);
    memset(bodies.memory, 0xff, bodies.bytes);
    for (uint32_t i = 0; i < 2; i++) {
        find(contact_bodies_at(&copy, i + 1), 1, &x, there + i);
        ck_assert(there[i].gap == here[i].gap);
        ck_assert_mem_eq(&there[i].normal, &here[i].normal, sizeof here[i].normal);
    }
    ck_assert_ptr_null(contact_bodies_at(&copy, 0));
    free(copy.memory);
}

/* Each part of a node lies in its box, by the doubles; each triangle is in one leaf. */
UNIT_LOOP(boxes, 0, N_MADE)
{
    make(_i);
    const struct contact_body *body = body_of();
    const struct contact_node *nodes = contact_body_nodes(body);
    const phys_vec *vertex = contact_body_vertices(body);
    uint32_t n_facets = 0, n_nodes = 1;
    for (uint32_t n = 0; n < body->n_nodes; n++)
        for (int part = 0; part < 4; part++) {
            const uint32_t child = nodes[n].child[part];
            const bool leaf = child & CONTACT_IS_LEAF;
            if (nodes[n].low[0][part] > nodes[n].high[0][part])
                continue;
            n_nodes += !leaf;
            for (int c = 0; c < 3; c++) {
                const double low = (double)nodes[n].low[c][part];
                const double high = (double)nodes[n].high[c][part];
                for (int k = 0; k < 4 && !leaf; k++)
                    if (nodes[child].low[c][k] <= nodes[child].high[c][k])
                        ck_assert((double)nodes[child].low[c][k] >= low &&
                                  (double)nodes[child].high[c][k] <= high);
                for (uint32_t i = 0; leaf && i < 3 * contact_leaf_n(child); i++) {
                    const struct contact_facet *facet =
                        contact_body_facets(body) + contact_leaf_first(child) + i / 3;
                    const double x = vertex[facet->corner[i % 3]][c];
                    ck_assert(x >= low && x <= high);
                }
            }
            n_facets += leaf ? contact_leaf_n(child) : 0;
        }
    ck_assert_uint_eq(n_facets, mesh.n_triangles);
    ck_assert_uint_eq(n_nodes, body->n_nodes);
}

/* On edges and corners normals are in their middle, however many triangles a side has there. The
 * first counts of nearest triangles that are as near: side x < 0 at the centre of a cube. */
UNIT_TEST(pseudo_normals)
{
    surface_box(&made, 1, 1, 1);
    surface_mesh(&made, &mesh);
    const struct contact_body *body = body_of();
    for (int i = 0; i < 8; i++) {
        const double x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1, z = i & 4 ? 1 : -1;
        body_check_normal(body, x, y, z, x, y, z);
        body_check_normal(body, x, y, 0.3, x, y, 0);
        body_check_normal(body, x, -0.1, 0.3, 1 * x, 0, 0);
        body_check_normal(body, 2 * x, 3 * y, 3 * z, x, 2 * y, 2 * z);
        body_check_normal(body, 0.2 * x, 3 * y, 2 * z, 0, 2 * y, z);
    }
    body_check_normal(body, 0, 0, 0, -1, 0, 0);
    const phys_vec wrong[] = {{NAN, 0, 0, 0}, {0, INFINITY, 0, 0}, {-1e153, 1e152, 0, 0}};
    struct contact_hit hit[3];
    find(body, 3, wrong, hit);
    ck_assert(isnan(hit[0].gap) && hit[1].gap > 0 && hit[2].gap > 1e150);
}

UNIT_LOOP(apart, 0, N_MADE)
{
    size_t n_apart = 0, n_free = 0;
    random_seed = 7;
    make(_i);
    const struct contact_body *body = body_of();
    for (int i = 0; i < POINTS; i++) {
        phys_vec x[3], wrong[3];
        struct contact_hit hit[3];
        pick_point(i, x);
        for (int k = 1; k < 3; k++)
            x[k] =
                x[0] + (phys_vec){uniform(-0.03, 0.03), uniform(-0.03, 0.03), uniform(-0.03, 0.03)};
        find(body, 3, x, hit);
        const bool is = contact_body_kind.apart(NULL, body, 3, x);
        const bool free = hit[0].gap > 0 && hit[1].gap > 0 && hit[2].gap > 0;
        ck_assert(!is || free);
        n_apart += is;
        n_free += free;
        memcpy(wrong, x, sizeof x);
        wrong[i % 3][0] = NAN;
        ck_assert(!contact_body_kind.apart(NULL, body, 3, wrong));
    }
    ck_assert_uint_gt(n_apart, n_free / 4);
    ck_assert_uint_lt(n_free, POINTS);
}

UNIT_LOOP(a_real_body, 0, access(real_body_path(), R_OK) == 0)
{
    enum { N = 30000 };
    struct mesh_transform metres = mesh_identity;
    for (int c = 0; c < 3; c++)
        metres.scale[c] = 0.1;
    UNIT_FINE(mesh_read_surface(&mesh, real_body_path(), &error));
    mesh_apply(&mesh, &metres);
    const struct contact_body *body = body_of();
    phys_vec *x = aligned_alloc(CONTACT_ALIGN, N * sizeof *x);
    struct contact_hit *hit = aligned_alloc(CONTACT_ALIGN, N * sizeof *hit);
    ck_assert(x && hit);
    for (uint32_t i = 0; i < N; i++) { /* one after the other, as rows of a cloth are */
        corner_of((uint32_t)((uint64_t)i * mesh.n_triangles / N), (int)(i % 3), x + i);
        for (int c = 0; c < 3; c++)
            x[i][c] += uniform(-2e-3, 2e-3);
    }
    find(body, N, x, hit);
    for (uint32_t i = 0; i < N; i += 200)
        check_hit(x + i, hit + i);
    free(x);
    free(hit);
}

/* ---- Refused, and turned ---- */

static void expect(const char *text)
{
    bool turned;
    const struct contact_bodies before = bodies;
    UNIT_REFUSED(contact_bodies_add(&bodies, &mesh, &turned, &error), CLOTH_E_INPUT, text);
    ck_assert_mem_eq(&before, &bodies, sizeof bodies);
    mesh_free(&mesh);
}

static void swap(uint32_t *a, uint32_t *b)
{
    const uint32_t c = *a;
    *a = *b;
    *b = c;
}

UNIT_TEST(both_sides_of_one_triangle)
{
    made = (struct surface){.n = 3, .x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    surface_add(&made, 0, 1, 2);
    surface_add(&made, 0, 2, 1);
    surface_mesh(&made, &mesh);
    expect("triangles 1 and 2 lie on each other, at the edge between vertices 1 and 2");
}

UNIT_TEST(turned_round)
{
    bool turned = false;
    surface_box(&made, 1, 1, 1);
    for (uint32_t t = 0; t < made.n_triangles; t++)
        swap(made.triangle[t], made.triangle[t] + 2);
    surface_mesh(&made, &mesh);
    UNIT_FINE(contact_bodies_add(&bodies, &mesh, &turned, &error));
    ck_assert(turned);
    body_check_normal(contact_bodies_at(&bodies, 1), 1, 1, 1, 1, 1, 1);
    body_check_normal(contact_bodies_at(&bodies, 1), 1, 1, 0.2, 1, 1, 0);
}

/* A box of edge 2, and a smaller one that is so far away along x, inside out. */
static void make_two(double away, double half)
{
    static struct surface other;
    surface_box(&made, 1, 1, 1);
    surface_box(&other, half, half, half);
    for (uint32_t v = 0; v < other.n; v++)
        memcpy(made.x[made.n + v], (double[3]){other.x[v][0] + away, other.x[v][1], other.x[v][2]},
               sizeof *made.x);
    for (uint32_t t = 0; t < other.n_triangles; t++)
        surface_add(&made, made.n + other.triangle[t][2], made.n + other.triangle[t][1],
                    made.n + other.triangle[t][0]);
    made.n += other.n;
    surface_mesh(&made, &mesh);
}

/* A part that is inside out is a hole, or an error; both ways round. */
UNIT_TEST(parts)
{
    static const phys_vec inside[] = {{0}, {0.9, 0, 0}, {2, 0, 0}};
    struct contact_hit hit[3];
    bool turned = true;
    make_two(3, 0.5);
    expect("the part of the mesh that has vertex 15 is inside out, and is no hole in another part");
    make_two(1.5 + 1e-9, 0.5);
    expect("inside out, and is no hole");
    make_two(0.25, 0.5);
    UNIT_FINE(contact_bodies_add(&bodies, &mesh, &turned, &error));
    ck_assert(!turned);
    contact_body_kind.closest(NULL, contact_bodies_at(&bodies, 1), 3, inside, hit);
    ck_assert(hit[0].gap > 0 && hit[1].gap < 0 && hit[2].gap > 0);
    for (uint32_t t = 0; t < mesh.n_triangles; t++)
        swap(made.triangle[t], made.triangle[t] + 2);
    mesh_free(&mesh);
    surface_mesh(&made, &mesh);
    UNIT_FINE(contact_bodies_add(&bodies, &mesh, &turned, &error));
    ck_assert(turned);
    contact_body_kind.closest(NULL, contact_bodies_at(&bodies, 2), 3, inside, hit);
    ck_assert(hit[0].gap > 0 && hit[1].gap < 0 && hit[2].gap > 0);
}
