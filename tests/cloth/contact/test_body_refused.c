/* Meshes that bodies cannot be made of leave the bodies before them as they were; what further ones
 * are told is in tests/cloth/scene/sentences.txt. What is inside out is turned round, or a hole. */
#include "tests/cloth/contact/bodies.h"

#include <string.h>

static struct surface made;
static struct contact_bodies bodies;
static struct mesh mesh;

static void end(void)
{
    free(bodies.memory);
    bodies = (struct contact_bodies){0};
    mesh_free(&mesh);
}

static void expect(const char *text)
{
    struct cloth_error error = {0};
    bool turned;
    const struct contact_bodies before = bodies;
    ck_assert_int_eq(contact_bodies_add(&bodies, &mesh, &turned, &error), CLOTH_E_INPUT);
    unit_says(error.text, text);
    ck_assert_mem_eq(&before, &bodies, sizeof bodies);
    mesh_free(&mesh);
}

static void swap(uint32_t *a, uint32_t *b)
{
    const uint32_t c = *a;
    *a = *b;
    *b = c;
}

UNIT_FIXTURE(NULL, end)

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
