/* Girths of garments and bodies by closed forms: tubes of two rectangles, prisms with many sides.
 */
#include "cloth/garment/girth.h"
#include "cloth/garment/own/own.h"
#include "tests/cloth/garment/tools.h"

enum { SIDES = 64, SIZE_M = 2 };
static const double HALF_TURN = 3.14159265358979323846;

/* A prism around the y axis through (x, z), from y = -1 to 2, without its ends. */
struct prism {
    double place[2 * SIDES][3];
    uint32_t triangle[2 * SIDES][3];
};

static double around(double radius) /* of its outline */
{
    return 2 * SIDES * radius * sin(HALF_TURN / SIDES);
}

static void prism_make(struct prism *prism, double radius, double x, double z)
{
    for (uint32_t i = 0; i < SIDES; i++) {
        const double turn = 2 * HALF_TURN * i / SIDES;
        const uint32_t next = (i + 1) % SIDES;
        for (uint32_t k = 0; k < 2; k++) {
            double *at = prism->place[2 * i + k];
            at[0] = x + radius * cos(turn);
            at[1] = k ? 2 : -1;
            at[2] = z + radius * sin(turn);
        }
        const uint32_t corner[2][3] = {{2 * i, 2 * i + 1, 2 * next},
                                       {2 * next, 2 * i + 1, 2 * next + 1}};
        memcpy(prism->triangle[2 * i], corner, sizeof corner);
    }
}

static struct slice_mesh body_of(const struct prism *prism, uint32_t n)
{
    return (struct slice_mesh){n * 2 * SIDES, (const double(*)[3])prism->place,
                               (const uint32_t(*)[3])prism->triangle};
}

/* Compares the mesh of a pattern with a body; the first n_seams of its seams are sewn. */
static struct girth_worst compare(const struct garment_pattern *pattern, uint32_t n_seams,
                                  const struct slice_mesh *body)
{
    struct garment garment;
    struct girth_seam seam[32];
    struct girth_worst worst;
    make_garment(&garment, pattern, 0.03, 0);
    const struct slice_mesh mesh = {garment.n_triangles, (const double(*)[3])garment.position,
                                    (const uint32_t(*)[3])garment.triangle};
    for (uint32_t s = 0; s < n_seams; s++)
        seam[s] = (struct girth_seam){garment.seam[s].n_pairs,
                                      (const uint32_t(*)[2])garment.seam[s].pair};
    UNIT_FINE(girth_compare(&worst, &mesh, n_seams, seam, body, &error));
    garment_free(&garment);
    return worst;
}

static struct garment_pattern pattern; /* the tube */
static struct prism prism;             /* the body, which each test makes */

/* Two rectangles of 0.5 x 0.3 m at z = +-0.2, sewn at their sides. */
static void tube(void)
{
    static double corner[4][2] = {{-0.25, 0}, {0.25, 0}, {0.25, 0.3}, {-0.25, 0.3}};
    static struct garment_edge edge[4] = {
        {.end = {0, 1}}, {.end = {1, 2}}, {.end = {2, 3}}, {.end = {3, 0}}};
    static char front[] = "front", back[] = "back";
    static struct garment_panel panel[2];
    static struct garment_stitch stitch[2];
    panel[0] = (struct garment_panel){front, 4, 4, corner, edge, {0, 0, 0}, {0, 0, 0.2}, false};
    panel[1] = (struct garment_panel){back, 4, 4, corner, edge, {0, 180, 0}, {0, 0, -0.2}, false};
    stitch[0] = (struct garment_stitch){.side = {{0, 1}, {1, 3}}};
    stitch[1] = (struct garment_stitch){.side = {{0, 3}, {1, 1}}};
    pattern = (struct garment_pattern){2, 2, panel, stitch};
}

UNIT_FIXTURE(tube, NULL)

UNIT_TEST(a_tube_around_a_prism)
{
    for (int i = 0; i < 4; i++) {
        const double radius = 0.1 + 0.03 * i; /* 0.1 to 0.19: girths of 0.63 to 1.19 m */
        prism_make(&prism, radius, 0.01, 0);
        const struct slice_mesh body = body_of(&prism, 1);
        const struct girth_worst worst = compare(&pattern, 2, &body);
        ck_assert(worst.found);
        ck_assert_double_eq_tol(worst.garment, 1, 1e-12);
        ck_assert_double_eq_tol(worst.body, around(radius), 1e-12);
        ck_assert(worst.y > 0 && worst.y < 0.3);
        ck_assert_int_eq(girth_too_small(&worst), radius > 0.162);
    }
}

/* The hull around two prisms has straight ways between them. */
UNIT_TEST(a_tube_around_two_legs)
{
    struct {
        double place[2][2 * SIDES][3];
        uint32_t triangle[2][2 * SIDES][3];
    } legs;
    for (uint32_t leg = 0; leg < 2; leg++) {
        prism_make(&prism, 0.08, leg ? 0.12 : -0.12, 0);
        memcpy(legs.place[leg], prism.place, sizeof prism.place);
        for (uint32_t t = 0; t < 2 * SIDES; t++)
            for (int k = 0; k < 3; k++)
                legs.triangle[leg][t][k] = prism.triangle[t][k] + leg * 2 * SIDES;
    }
    const struct slice_mesh body = {4 * SIDES, (const double(*)[3])legs.place,
                                    (const uint32_t(*)[3])legs.triangle};
    const struct girth_worst worst = compare(&pattern, 2, &body);
    ck_assert(worst.found);
    ck_assert_double_eq_tol(worst.body, around(0.08) + 2 * 0.24, 1e-12);
}

/* A girth that is not surrounded, or only partly, is not compared; nor is a cut that does not
 * close. */
UNIT_TEST(nothing_to_compare)
{
    prism_make(&prism, 0.1, 0.5, 0);
    struct slice_mesh body = body_of(&prism, 1);
    ck_assert(!compare(&pattern, 2, &body).found);
    prism_make(&prism, 0.1, 0.25, 0);
    body = body_of(&prism, 1);
    ck_assert(!compare(&pattern, 2, &body).found);
    prism_make(&prism, 0.1, 0, 0);
    body = body_of(&prism, 1);
    ck_assert(compare(&pattern, 2, &body).found);
    ck_assert(!compare(&pattern, 1, &body).found);
    ck_assert(!compare(&pattern, 0, &body).found);
    body.n_triangles = 0;
    ck_assert(!compare(&pattern, 2, &body).found);
}

/* A skirt is narrowest at its waistband. */
UNIT_TEST(skirts_of_random_waists)
{
    const struct garment_own *own = garment_own_find("skirt");
    const int waist = garment_own_measure(own, "waist");
    for (int i = 0; i < 20; i++) {
        UNIT_OWNED(garment_pattern_free) struct garment_pattern skirt;
        double value[GARMENT_MEASURES];
        const double radius = 0.11 + 0.003 * (i * 7 % 20);
        garment_own_size(own, SIZE_M, value);
        value[waist] = 0.7 + 0.012 * (i * 11 % 20);
        UNIT_FINE(garment_own_make(&skirt, own, value, &error));
        prism_make(&prism, radius, 0, 0);
        const struct slice_mesh body = body_of(&prism, 1);
        const struct girth_worst worst = compare(&skirt, skirt.n_stitches, &body);
        ck_assert(worst.found);
        ck_assert_double_eq_tol(worst.garment, value[waist] + 0.02, 1e-12);
        ck_assert_double_eq_tol(worst.body, around(radius), 1e-12);
        ck_assert_int_eq(girth_too_small(&worst), around(radius) > 1.02 * (value[waist] + 0.02));
    }
}
