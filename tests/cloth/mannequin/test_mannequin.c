/* Figures are closed, of the girths and height asked for, the same on the left and right, of good
 * triangles; impossible ones are refused by name. */
#include "tests/cloth/mannequin/tools.h"

static const double PI = 3.14159265358979323846;

/* ---- The surface ---- */

struct side { /* of a triangle, from a to b */
    uint32_t a, b;
};

static int by_ends(const void *left, const void *right)
{
    const struct side *x = left, *y = right;
    return x->a != y->a ? (x->a > y->a) - (x->a < y->a) : (x->b > y->b) - (x->b < y->b);
}

/* Each side once, and once the other way round: closed, manifold at edges, oriented. */
static uint32_t check_sides(const struct mesh *mesh)
{
    const size_t n = 3 * (size_t)mesh->n_triangles;
    struct side *side = malloc(n * sizeof *side);
    for (size_t i = 0; i < n; i++)
        side[i] = (struct side){mesh->triangle[i], mesh->triangle[i - i % 3 + (i + 1) % 3]};
    qsort(side, n, sizeof *side, by_ends);
    for (size_t i = 0; i < n; i++) {
        const struct side back = {side[i].b, side[i].a};
        ck_assert(i == 0 || by_ends(&side[i - 1], &side[i]) != 0);
        ck_assert_ptr_nonnull(bsearch(&back, side, n, sizeof *side, by_ends));
    }
    free(side);
    return (uint32_t)(n / 2);
}

/* The triangles around a vertex are one fan: one can go from one to the next around all. */
static void check_fans(const struct mesh *mesh)
{
    const size_t n = 3 * (size_t)mesh->n_triangles;
    uint32_t *count = calloc(mesh->n_vertices, sizeof *count), *first = malloc(n * sizeof *first);
    struct side *side = malloc(n * sizeof *side); /* around corner a: from b to `first` */
    for (size_t i = 0; i < n; i++) {
        const size_t t = i - i % 3;
        count[mesh->triangle[i]]++;
        side[i] = (struct side){mesh->triangle[i], mesh->triangle[t + (i + 1) % 3]};
    }
    qsort(side, n, sizeof *side, by_ends);
    for (size_t i = 0; i < n; i++) {
        const size_t t = i - i % 3;
        const struct side key = {mesh->triangle[i], mesh->triangle[t + (i + 1) % 3]};
        const struct side *found = bsearch(&key, side, n, sizeof *side, by_ends);
        first[found - side] = mesh->triangle[t + (i + 2) % 3];
    }
    for (size_t i = 0; i < n; i += count[side[i].a]) {
        struct side key = side[i];
        uint32_t steps = 0;
        do {
            const struct side *found = bsearch(&key, side, n, sizeof *side, by_ends);
            ck_assert_ptr_nonnull(found);
            key.b = first[found - side];
            steps++;
        } while (key.b != side[i].b && steps <= n);
        ck_assert_uint_eq(steps, count[key.a]);
    }
    free(count);
    free(first);
    free(side);
}

static double volume_of(const struct mesh *mesh)
{
    double sum = 0;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        const double *a = place_of(mesh, mesh->triangle[3 * t]);
        const double *b = place_of(mesh, mesh->triangle[3 * t + 1]);
        const double *c = place_of(mesh, mesh->triangle[3 * t + 2]);
        sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                a[2] * (b[0] * c[1] - b[1] * c[0])) /
               6;
    }
    return sum;
}

static uint32_t root(uint32_t *parent, uint32_t v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

static uint32_t parts_of(const struct mesh *mesh)
{
    uint32_t *parent = malloc(mesh->n_vertices * sizeof *parent), n = 0;
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        parent[v] = v;
    for (size_t i = 0; i < 3 * (size_t)mesh->n_triangles; i++)
        parent[root(parent, mesh->triangle[i])] = root(parent, mesh->triangle[i - i % 3]);
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        n += root(parent, v) == v;
    free(parent);
    return n;
}

static void check_surface(const struct mesh *mesh)
{
    const uint32_t n_edges = check_sides(mesh);
    check_fans(mesh);
    ck_assert_int_eq((int)mesh->n_vertices - (int)n_edges + (int)mesh->n_triangles, 2);
    ck_assert_uint_eq(parts_of(mesh), 1);
    ck_assert(volume_of(mesh) > 0);
    ck_assert_uint_eq(crossings(mesh, mesh->position), 0);
}

/* ---- Triangles ---- */

/* degrees, of the corner at a */
static double angle_at(const double *a, const double *b, const double *c)
{
    const double p = distance_of(a, b), q = distance_of(a, c), r = distance_of(b, c);
    return 180 / PI * acos((p * p + q * q - r * r) / (2 * p * q));
}

static void check_triangles(const struct mesh *mesh, double edge)
{
    uint32_t n_long = 0;
    for (size_t i = 0; i < 3 * (size_t)mesh->n_triangles; i++) {
        const size_t t = i - i % 3;
        const double *a = place_of(mesh, mesh->triangle[i]);
        const double *b = place_of(mesh, mesh->triangle[t + (i + 1) % 3]);
        const double *c = place_of(mesh, mesh->triangle[t + (i + 2) % 3]);
        ck_assert(angle_at(a, b, c) > 15);
        ck_assert(distance_of(a, b) > 0.25 * edge && distance_of(a, b) < 2 * edge);
        n_long += distance_of(a, b) > 1.4 * edge;
    }
    ck_assert(n_long < 0.01 * 3 * mesh->n_triangles);
}

static int by_place(const void *left, const void *right)
{
    const double *a = left, *b = right;
    for (int c = 0; c < 3; c++)
        if (a[c] < b[c] || a[c] > b[c])
            return a[c] > b[c] ? 1 : -1;
    return 0;
}

/* Bit for bit. */
static void check_mirror(const struct mesh *mesh)
{
    const size_t n = mesh->n_vertices;
    double(*x)[3] = malloc(n * sizeof *x);
    memcpy(x, mesh->position, n * sizeof *x);
    qsort(x, n, sizeof *x, by_place);
    for (size_t v = 0; v < n; v++) {
        const double image[3] = {0 - x[v][0], x[v][1], x[v][2]};
        ck_assert_ptr_nonnull(bsearch(image, x, n, sizeof *x, by_place));
    }
    free(x);
}

/* ---- Girths ---- */

/* Where a plane through a point cuts a triangle, if it does. */
static bool cut(const struct mesh *mesh, uint32_t t, const double point[3], const double normal[3],
                double at[3][3])
{
    int n = 0;
    for (uint32_t k = 0; k < 3; k++) {
        const double *a = place_of(mesh, mesh->triangle[3 * t + k]);
        const double *b = place_of(mesh, mesh->triangle[3 * t + (k + 1) % 3]);
        double p = 0, q = 0;
        for (int c = 0; c < 3; c++) {
            p += normal[c] * (a[c] - point[c]);
            q += normal[c] * (b[c] - point[c]);
        }
        if ((p < 0) == (q < 0))
            continue;
        for (int c = 0; c < 3; c++)
            at[n][c] = a[c] + p / (p - q) * (b[c] - a[c]);
        n++;
    }
    return n == 2;
}

/* Level, and across the figure's left arm. */
static const double NORMAL[2][3] = {{0, 1, 0}, {0.70710678118654752, -0.70710678118654752, 0}};

/* The end of the part of a section that begins at x = from: how far it reaches to larger x, or to
 * smaller ones (way 1, -1). */
static double end_of(const struct mesh *mesh, const double point[3], bool arm, double from, int way)
{
    double at[3][3], reach = way * from, before = -INFINITY;
    while (reach > before) {
        before = reach;
        for (uint32_t t = 0; t < mesh->n_triangles; t++)
            if (cut(mesh, t, point, NORMAL[arm], at) &&
                fmin(way * at[0][0], way * at[1][0]) <= reach + 1e-6)
                reach = fmax(reach, fmax(way * at[0][0], way * at[1][0]));
    }
    return way * reach;
}

/* The length of the section's pieces from x = low to high. */
static double section_of(const struct mesh *mesh, const double point[3], bool arm, double low,
                         double high)
{
    double sum = 0, at[3][3];
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        if (cut(mesh, t, point, NORMAL[arm], at) && at[0][0] >= low && at[0][0] <= high)
            sum += distance_of(at[0], at[1]);
    return sum;
}

/* The largest x of a section across the arm. */
static double far_of(const struct mesh *mesh, const double point[3])
{
    double at[3][3], far = 0;
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        if (cut(mesh, t, point, NORMAL[1], at))
            far = fmax(far, fmax(at[0][0], at[1][0]));
    return far;
}

/* Along the arm places count from the shoulder; the fingertips are at 0.736 m. */
static double girth_of(const struct mesh *mesh, uint32_t i, double scale)
{
    const double at = mannequin_measures[i].at * scale;
    double tip[3] = {0, at, 0};
    if (i < MANNEQUIN_THIGH) {
        const double reach = end_of(mesh, tip, false, 0, 1) + 1e-9;
        return section_of(mesh, tip, false, -reach, reach);
    }
    if (i < MANNEQUIN_UPPER_ARM) /* of both legs, but not of hands */
        return 0.5 * section_of(mesh, tip, false, -0.3 * scale, 0.3 * scale);
    tip[1] = 2 * scale;
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        if (place_of(mesh, v)[1] > 0.5 * scale &&
            place_of(mesh, v)[0] - place_of(mesh, v)[1] > tip[0] - tip[1])
            memcpy(tip, place_of(mesh, v), sizeof tip);
    for (int c = 0; c < 3; c++)
        tip[c] -= (0.736 * scale - at) * NORMAL[1][c];
    return section_of(mesh, tip, true, end_of(mesh, tip, true, far_of(mesh, tip), -1) - 1e-6, 9);
}

static void check_girths(const struct mesh *mesh, const struct mannequin *asked)
{
    const double height = asked->height > 0 ? asked->height : MANNEQUIN_HEIGHT;
    const double scale = height / MANNEQUIN_HEIGHT;
    double low[3], high[3];
    mesh_box(mesh, low, high);
    ck_assert_double_eq(low[1], 0);
    ck_assert_double_eq(high[1], height);
    for (uint32_t i = 0; i < MANNEQUIN_GIRTHS; i++) {
        const double wanted =
            asked->girth[i] > 0 ? asked->girth[i] : mannequin_measures[i].girth * scale;
        const double is = girth_of(mesh, i, scale);
        ck_assert_msg(fabs(is - wanted) <= 0.02 * wanted, "%s is %g, asked for is %g",
                      mannequin_measures[i].name, is, wanted);
    }
}

/* ---- Cases ---- */

static void check_all(const struct mannequin *mannequin)
{
    UNIT_OWNED(mesh_free) struct mesh mesh;
    make_mannequin(&mesh, mannequin);
    check_surface(&mesh);
    check_triangles(&mesh, mannequin->edge > 0 ? mannequin->edge : MANNEQUIN_EDGE);
    check_mirror(&mesh);
    check_girths(&mesh, mannequin);
}

UNIT_TEST(default_figure)
{
    struct mannequin mannequin = {0};
    UNIT_OWNED(mesh_free) struct mesh mesh;
    make_mannequin(&mesh, &mannequin);
    ck_assert(mesh.n_triangles >= 8000 && mesh.n_triangles <= 15000);
    check_all(&mannequin);
}

UNIT_TEST(other_sizes)
{
    check_all(&(struct mannequin){.edge = unit_quick() ? 0.02 : 0.012});
    check_all(&(struct mannequin){.edge = 0.025});
    check_all(&(struct mannequin){.height = 1.2, .edge = 0.015});
    check_all(&(struct mannequin){.height = 2.0});
}

static double random_part(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 40) / (1 << 24);
}

/* Measures that do not go together are refused before anything is made. */
UNIT_TEST(random_measures)
{
    const int wanted = unit_quick() ? 5 : 50;
    uint64_t state = 1;
    for (int made = 0; made < wanted;) {
        struct mannequin mannequin = {.height = 1.5 + 0.5 * random_part(&state), .edge = 0.021};
        struct cloth_error error = {0};
        UNIT_OWNED(mesh_free) struct mesh mesh;
        for (uint32_t i = 0; i < MANNEQUIN_GIRTHS; i++) {
            const struct mannequin_measure *m = &mannequin_measures[i];
            mannequin.girth[i] = (m->least + (m->most - m->least) * random_part(&state)) *
                                 mannequin.height / MANNEQUIN_HEIGHT;
        }
        if (mannequin_make(&mesh, NULL, &mannequin, NULL, &error)) {
            unit_says(error.text, "it has to be at least");
            continue;
        }
        made++;
        check_surface(&mesh);
        check_girths(&mesh, &mannequin);
    }
}

static void check_refused(const struct mannequin *mannequin, const char *sentence)
{
    struct mesh mesh;
    UNIT_REFUSED(mannequin_make(&mesh, NULL, mannequin, NULL, &error), CLOTH_E_INPUT, sentence);
    ck_assert_ptr_null(mesh.position);
}

UNIT_TEST(refused)
{
    check_refused(&(struct mannequin){.height = 3}, "height is 3 m; figures have 1 to 2.3 m");
    check_refused(&(struct mannequin){.height = NAN}, "height is nan m");
    check_refused(&(struct mannequin){.edge = 0.1}, "edge is 0.1 m");
    check_refused(&(struct mannequin){.girth[MANNEQUIN_CHEST] = 2},
                  "chest is 2 m; a figure of 1.75 m has 0.82 to 1.28 m");
    check_refused(&(struct mannequin){.height = 1.4, .girth[MANNEQUIN_HIP] = 0.6},
                  "hip is 0.6 m; a figure of 1.4 m has 0.672 to 1.04 m");
    check_refused(&(struct mannequin){.girth[MANNEQUIN_HIP] = 0.85},
                  "a hip of 0.85 m does not go with a thigh of 0.57 m");
    check_refused(&(struct mannequin){.girth[MANNEQUIN_WRIST] = -1}, "wrist is -1 m");
}

UNIT_TEST(names)
{
    for (uint32_t i = 0; i < MANNEQUIN_GIRTHS; i++)
        ck_assert_uint_eq(mannequin_find(mannequin_measures[i].name), i);
    ck_assert_uint_eq(mannequin_find("nose"), MANNEQUIN_GIRTHS);
}
