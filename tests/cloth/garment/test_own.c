/* The project's own garments: their panels, seams and surfaces, of all sizes and of random
 * measures. */
#include "cloth/base/order.h"
#include "cloth/garment/own/own.h"
#include "tests/cloth/garment/tools.h"

#include <stdint.h>

enum { TSHIRT, TROUSERS, SKIRT, GARMENTS, SIZES = 5, MIDDLE = 2, RANDOM = 200 };

/* Surfaces: boundary loops, and the Euler number of a sphere with so many holes. */
static const struct shape {
    const char *name;
    uint32_t loops;
    int euler;
} SHAPES[GARMENTS] = {{"tshirt", 4, -2}, {"trousers", 3, -1}, {"skirt", 2, 0}};

static void own_of(struct garment_pattern *pattern, int which, const double *value)
{
    const struct garment_own *own = garment_own_find(SHAPES[which].name);
    UNIT_FINE(garment_own_make(pattern, own, value, &error));
}

static void size_of(struct garment_pattern *pattern, int which, int size)
{
    double value[GARMENT_MEASURES];
    garment_own_size(garment_own_find(SHAPES[which].name), size, value);
    own_of(pattern, which, value);
}

static double side_length(const struct garment_pattern *pattern, struct garment_side side)
{
    return garment_edge_length(&pattern->panel[side.panel], side.edge);
}

/* Seams whose first edge is gathered: the skirt's to its band. */
static bool is_gathered(const struct garment_pattern *pattern, int which, uint32_t s)
{
    return which == SKIRT &&
           !strncmp(pattern->panel[pattern->stitch[s].side[1].panel].name, "band", 4) &&
           strncmp(pattern->panel[pattern->stitch[s].side[0].panel].name, "band", 4);
}

static void check_lengths(const struct garment_pattern *pattern, int which, double gather)
{
    for (uint32_t s = 0; s < pattern->n_stitches; s++) {
        const double a = side_length(pattern, pattern->stitch[s].side[0]);
        const double b = side_length(pattern, pattern->stitch[s].side[1]);
        const double wanted = is_gathered(pattern, which, s) ? gather * b : b;
        ck_assert_msg(fabs(a - wanted) <= 0.03 * wanted, "%s: seam %u: %g and %g m",
                      SHAPES[which].name, s, a, b);
    }
}

static uint32_t root_of(uint32_t *parent, uint32_t v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

/* The Euler number of the sewn surface, and how many loops its boundary has. */
static int surface_of(const struct garment *garment, uint32_t *loops)
{
    const uint32_t n = garment->n_vertices, n_edges = 3 * garment->n_triangles;
    uint32_t *parent = calloc(n, sizeof *parent), *bound = calloc(n, sizeof *bound);
    uint64_t *edge = calloc(n_edges, sizeof *edge);
    int euler = (int)garment->n_triangles;
    ck_assert(parent && bound && edge);
    for (uint32_t v = 0; v < n; v++)
        parent[v] = bound[v] = v;
    for (uint32_t s = 0; s < garment->n_seams; s++)
        for (uint32_t k = 0; k < garment->seam[s].n_pairs; k++)
            parent[root_of(parent, garment->seam[s].pair[k][0])] =
                root_of(parent, garment->seam[s].pair[k][1]);
    for (uint32_t t = 0; t < garment->n_triangles; t++)
        for (int i = 0; i < 3; i++) {
            const uint64_t a = root_of(parent, garment->triangle[t][i]);
            const uint64_t b = root_of(parent, garment->triangle[t][(i + 1) % 3]);
            edge[3 * t + (uint32_t)i] = a < b ? a << 32 | b : b << 32 | a;
        }
    qsort(edge, n_edges, sizeof *edge, cloth_by_u64);
    for (uint32_t v = 0; v < n; v++)
        euler += parent[v] == v;
    *loops = 0;
    for (uint32_t e = 0; e < n_edges; euler--) {
        uint32_t same = e + 1;
        while (same < n_edges && edge[same] == edge[e])
            same++;
        ck_assert_uint_le(same - e, 2);
        const uint32_t a = root_of(bound, (uint32_t)(edge[e] >> 32));
        const uint32_t b = root_of(bound, (uint32_t)edge[e]);
        if (same - e == 1)
            *loops += a == b; /* of a loop's edges the last one closes it */
        if (same - e == 1)
            bound[a] = b;
        e = same;
    }
    free(parent);
    free(bound);
    free(edge);
    return euler;
}

static void check_mesh(const struct garment_pattern *pattern, int which, double fineness)
{
    UNIT_OWNED(garment_free) struct garment garment;
    uint32_t below, loops;
    make_garment(&garment, pattern, fineness, 0);
    ck_assert_double_ge(garment_least_angle(&garment, &below), 20);
    for (uint32_t s = 0; s < garment.n_seams; s++)
        ck_assert_msg(garment.seam[s].reversed, "%s: seam %u joins fronts to backs",
                      SHAPES[which].name, s);
    ck_assert_int_eq(surface_of(&garment, &loops), SHAPES[which].euler);
    ck_assert_uint_eq(loops, SHAPES[which].loops);
}

UNIT_CASES(patience, cases)
{
    tcase_set_timeout(cases, 0);
}

UNIT_LOOP(sizes, 0, GARMENTS)
{
    struct garment_pattern pattern;
    for (int size = 0; size < SIZES; size++) {
        size_of(&pattern, _i, size);
        check_lengths(&pattern, _i, 1.15);
        check_mesh(&pattern, _i, 0.03);
        garment_pattern_free(&pattern);
    }
}

/* Corners of all panels in space, those of the right mirrored: each corner has its image. */
UNIT_LOOP(left_is_right, 0, GARMENTS)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern;
    UNIT_OWNED(garment_free) struct garment garment;
    size_of(&pattern, _i, MIDDLE);
    make_garment(&garment, &pattern, 0.03, 0);
    for (uint32_t p = 0; p < garment.n_pieces; p++)
        for (uint32_t e = 0; e < pattern.panel[p].n_edges; e++) {
            const double *x = garment.position[garment.piece[p].first + garment.piece[p].start[e]];
            const double image[3] = {-x[0], x[1], x[2]};
            double nearest = INFINITY;
            for (uint32_t v = 0; v < garment.n_vertices; v++)
                nearest = fmin(nearest, distance_of(garment.position[v], image, 3));
            ck_assert_double_le(nearest, 1e-12);
        }
}

static double part(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

/* Measures anywhere in their ranges: what is not refused can be sewn. */
UNIT_LOOP(random_measures, 0, GARMENTS)
{
    const struct garment_own *own = garment_own_find(SHAPES[_i].name);
    uint64_t state = 19;
    const int wanted = unit_quick() ? RANDOM / 10 : RANDOM;
    int made = 0, tried = 0;
    for (; made < wanted && tried < 100 * RANDOM; tried++) {
        UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern;
        struct cloth_error error = {0};
        double value[GARMENT_MEASURES] = {0};
        for (int k = 0; own->measure[k].name; k++)
            value[k] = own->measure[k].least +
                       part(&state) * (own->measure[k].most - own->measure[k].least);
        const int code = garment_own_make(&pattern, own, value, &error);
        if (code) {
            ck_assert_int_eq(code, CLOTH_E_INPUT);
            ck_assert_msg(strncmp(error.text, own->name, strlen(own->name)) == 0, "%s", error.text);
        } else {
            const int gather = garment_own_measure(own, "gather");
            check_lengths(&pattern, _i, gather < 0 ? 1 : value[gather]);
            check_mesh(&pattern, _i, 0.03);
            made++;
        }
    }
    ck_assert_msg(made == wanted, "%s: of %d only %d can be sewn", own->name, tried, made);
}

/* Girths are what the measures say. */
UNIT_TEST(widths)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern;
    double value[GARMENT_MEASURES];
    const struct garment_own *own = garment_own_find("tshirt");
    garment_own_size(own, MIDDLE, value);
    value[garment_own_measure(own, "chest")] = 1.1;
    value[garment_own_measure(own, "ease")] = 0.06;
    own_of(&pattern, TSHIRT, value);
    ck_assert_double_eq_tol(garment_edge_length(&pattern.panel[0], 0), 0.58, 1e-12);
    garment_pattern_free(&pattern);
    size_of(&pattern, TROUSERS, MIDDLE);
    double waist = 0;
    for (uint32_t s = 0; s < pattern.n_stitches; s++) {
        const char *name = pattern.panel[pattern.stitch[s].side[1].panel].name;
        const double length = side_length(&pattern, pattern.stitch[s].side[1]);
        waist += !strncmp(name, "band", 4) && length > 0.1 ? length : 0;
    }
    ck_assert_double_eq_tol(waist, 0.862, 0.001); /* the back's rise makes it a little longer */
}

static void refuse(int which, const char *measure, double value, const char *sentence)
{
    const struct garment_own *own = garment_own_find(SHAPES[which].name);
    double values[GARMENT_MEASURES];
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern;
    garment_own_size(own, MIDDLE, values);
    values[garment_own_measure(own, measure)] = value;
    UNIT_REFUSED(garment_own_make(&pattern, own, values, &error), CLOTH_E_INPUT, sentence);
}

UNIT_TEST(refused)
{
    refuse(TSHIRT, "chest", 3, "tshirt: the measure chest is 3; it has to be 0.5 to 1.8");
    refuse(TSHIRT, "chest", NAN, "it has to be 0.5 to 1.8");
    refuse(TSHIRT, "chest", 0.6, "chest has to be at least");
    refuse(TSHIRT, "shoulders", 0.2, "shoulders have to be at least");
    refuse(TSHIRT, "armhole", 0.1, "an armhole of 0.1 m is too small for a sleeve of 0.4 m");
    refuse(TSHIRT, "sleeve", 0.06, "sleeve has to be at least");
    refuse(TSHIRT, "length", 0.25, "length has to be at least");
    refuse(TSHIRT, "chest", 1.8, "chest has to be at most");
    refuse(TROUSERS, "knee", 0.9, "a leg of 0.9 m at the knee does not go with a hip of 1 m");
    refuse(TROUSERS, "hem", 0.9, "hem has to be");
    refuse(TROUSERS, "inseam", 0.1, "knee has to be");
    refuse(TROUSERS, "waist", 1.5, "waist has to be 0.6 to 1.3");
    refuse(TROUSERS, "waist", 0.5, "waist has to be 0.6 to 1.3");
    refuse(SKIRT, "hem", 0.6, "hem has to be at least");
    refuse(SKIRT, "waist", 1.5, "waist has to be 0.6 to 1.3");
    refuse(SKIRT, "hem", 4, "hem has to be at most");
    ck_assert_ptr_null(garment_own_find("kilt"));
    ck_assert_int_eq(garment_size_find("XXL"), -1);
    ck_assert_int_eq(garment_size_find("XL"), 4);
    ck_assert_int_eq(garment_own_measure(garment_own_find("skirt"), "sleeve"), -1);
}
