/* Meshes of panels: nothing of the boundary is lost, no triangle is bad, seams have equal sides. */
#include "tests/cloth/garment/tools.h"

#define PI 3.14159265358979323846

static const char *const PATTERNS[] = {"straight", "quadratic", "cubic", "circle",
                                       "dart",     "gather",    "fold",  "steep"};
enum { N_PATTERNS = sizeof PATTERNS / sizeof *PATTERNS };
static const double EDGES[] = {0.1, 0.021, 0.0053};
enum { N_EDGES = sizeof EDGES / sizeof *EDGES };

struct edge { /* a < b; the triangle's third vertex */
    uint32_t a, b, apex;
};

static int compare(const void *left, const void *right)
{
    const struct edge *x = left, *y = right;
    return x->a != y->a ? (x->a > y->a) - (x->a < y->a) : (x->b > y->b) - (x->b < y->b);
}

static struct edge *edges_of(const struct garment *garment, const struct garment_piece *piece)
{
    struct edge *edge = malloc(3 * (size_t)piece->n_triangles * sizeof *edge);
    for (size_t i = 0; i < 3 * (size_t)piece->n_triangles; i++) {
        const uint32_t *v = garment->triangle[piece->first_triangle + i / 3];
        const uint32_t a = v[i % 3], b = v[(i + 1) % 3];
        edge[i] = (struct edge){a < b ? a : b, a < b ? b : a, v[(i + 2) % 3]};
    }
    qsort(edge, 3 * (size_t)piece->n_triangles, sizeof *edge, compare);
    return edge;
}

static double area_of(const double *a, const double *b, const double *c)
{
    return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

static double angle_at(const double *a, const double *b, const double *c)
{
    return atan2(2 * fabs(area_of(a, b, c)),
                 (b[0] - a[0]) * (c[0] - a[0]) + (b[1] - a[1]) * (c[1] - a[1]));
}

/* Edges of one triangle are those of the boundary, each once; an inner one is Delaunay. V - E + F
 * is that of a disc. */
static void check_edges(const struct garment *garment, const struct garment_piece *piece,
                        uint32_t n_around)
{
    struct edge *edge = edges_of(garment, piece);
    const size_t n = 3 * (size_t)piece->n_triangles;
    uint32_t n_edges = 0, n_border = 0;
    for (size_t i = 0; i < n;) {
        const size_t count = i + 1 < n && compare(&edge[i], &edge[i + 1]) == 0 ? 2 : 1;
        const uint32_t a = edge[i].a - piece->first, b = edge[i].b - piece->first;
        const bool border =
            b < n_around && (b == a + 1 || (a == 0 && b == n_around - 1 && n_around > 2));
        ck_assert(i + 2 >= n || compare(&edge[i], &edge[i + 2]) != 0);
        ck_assert_uint_eq(border, count == 1);
        if (count == 2) {
            const double *x = garment->uv[edge[i].a], *y = garment->uv[edge[i].b];
            ck_assert(angle_at(garment->uv[edge[i].apex], x, y) +
                          angle_at(garment->uv[edge[i + 1].apex], x, y) <
                      PI + 1e-6);
        }
        n_edges++;
        n_border += border;
        i += count;
    }
    ck_assert_uint_eq(n_border, n_around);
    ck_assert_int_eq((int)piece->n_vertices - (int)n_edges + (int)piece->n_triangles, 1);
    free(edge);
}

/* The triangles are counterclockwise, and their areas are that of the boundary's polygon. */
static void check_area(const struct garment *garment, const struct garment_piece *piece,
                       uint32_t n_around)
{
    double sum = 0, around = 0;
    for (uint32_t t = 0; t < piece->n_triangles; t++) {
        const uint32_t *v = garment->triangle[piece->first_triangle + t];
        const double area = area_of(garment->uv[v[0]], garment->uv[v[1]], garment->uv[v[2]]);
        ck_assert(area > 0);
        sum += area;
        for (int i = 0; i < 3; i++) /* panels are not stretched where they are placed */
            ck_assert(fabs(distance_of(garment->uv[v[i]], garment->uv[v[(i + 1) % 3]], 2) -
                           distance_of(garment->position[v[i]], garment->position[v[(i + 1) % 3]],
                                       3)) < 1e-14);
    }
    for (uint32_t i = 0; i < n_around; i++) {
        const double *a = garment->uv[piece->first + i];
        const double *b = garment->uv[piece->first + (i + 1) % n_around];
        around += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    ck_assert(fabs(sum - around) < 1e-12);
}

static void check_piece(const struct garment *garment, const struct garment_pattern *pattern,
                        uint32_t p)
{
    const struct garment_panel *panel = &pattern->panel[p];
    const struct garment_piece *piece = &garment->piece[p];
    const uint32_t n_around = piece->start[panel->n_edges];
    const double side = garment_panel_area(panel) < 0 ? -1 : 1;
    check_edges(garment, piece, n_around);
    check_area(garment, piece, n_around);
    for (uint32_t e = 0; e < panel->n_edges; e++) {
        const double *uv = garment->uv[piece->first + piece->start[e]];
        const double *corner = panel->corner[panel->edge[e].end[0]];
        ck_assert(uv[0] == side * corner[0] && uv[1] == corner[1]);
    }
}

/* "steep" gathers by 4, around a ring of stitches, and beside its partner: its triangles are not as
 * good. */
UNIT_LOOP(panels_are_whole, 0, N_PATTERNS *N_EDGES)
{
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern pattern = read_pattern(PATTERNS[_i / N_EDGES]);
    UNIT_OWNED(garment_free) struct garment garment;
    make_garment(&garment, &pattern, EDGES[_i % N_EDGES], 0);
    uint32_t n = 0, below;
    for (uint32_t p = 0; p < garment.n_pieces; p++) {
        ck_assert_uint_eq(garment.piece[p].first, n);
        n += garment.piece[p].n_vertices;
        check_piece(&garment, &pattern, p);
    }
    ck_assert_uint_eq(n, garment.n_vertices);
    const double least = garment_least_angle(&garment, &below);
    printf("# %s, edges of %g m: %u vertices, %u triangles, least angle %.1f degrees\n",
           PATTERNS[_i / N_EDGES], EDGES[_i % N_EDGES], n, garment.n_triangles, least);
    ck_assert(least >= (pattern.n_stitches > 1 ? 20 : 28));
    ck_assert_uint_le(below, pattern.n_stitches > 1 ? 10 : 2);
}

UNIT_LOOP(as_many_as_wanted, 0, N_PATTERNS * 3)
{
    static const uint32_t wanted[] = {500, 3000, 20000};
    static const double off[] = {0.05, 0.01, 0.01}; /* boundaries have whole divisions */
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern pattern = read_pattern(PATTERNS[_i / 3]);
    UNIT_OWNED(garment_free) struct garment garment;
    const uint32_t n = wanted[_i % 3];
    make_garment(&garment, &pattern, 0, n);
    ck_assert_msg(fabs((double)garment.n_vertices - n) <= off[_i % 3] * n, "%s: %u, not %u",
                  PATTERNS[_i / 3], garment.n_vertices, n);
}

/* On straight edges every part has the same length: each side has that of its own edge. */
static void check_seam(const struct garment *garment, const struct garment_pattern *pattern,
                       uint32_t s)
{
    const struct garment_seam *seam = &garment->seam[s];
    ck_assert_uint_ge(seam->n_pairs, 2);
    for (int k = 0; k < 2; k++) {
        const struct garment_side side = pattern->stitch[s].side[k];
        const double part =
            garment_edge_length(&pattern->panel[side.panel], side.edge) / (seam->n_pairs - 1);
        for (uint32_t i = 0; i + 1 < seam->n_pairs; i++) {
            const double *a = garment->uv[seam->pair[i][k]], *b = garment->uv[seam->pair[i + 1][k]];
            ck_assert(fabs(distance_of(a, b, 2) - part) < 1e-13);
        }
    }
}

UNIT_LOOP(seams_have_equal_sides, 0, 3)
{
    static const char *const sewn[3] = {"dart", "gather", "fold"};
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern(sewn[_i]);
    UNIT_OWNED(garment_free) struct garment garment;
    make_garment(&garment, &pattern, 0.007, 0);
    ck_assert_uint_eq(garment.n_seams, 1);
    check_seam(&garment, &pattern, 0);
}

/* The gathered seam of 0.2 and 0.13 m: its longer edge, side k of the stitch, lies along the
 * shorter one forward, back and forward again, with vertices where it turns; what the pleats leave
 * is gathered evenly. */
static const struct {
    uint32_t count;
    double depth, edge;
    int side;
} PLEATS[] = {{3, 0.07 / 6, 0.007, 0}, {3, 0.07 / 6, 0.007, 1}, {1, 0.035, 0.002, 0},
              {5, 0.002, 0.01, 1},     {7, 0.005, 0.05, 0},     {4, 0.0326, 0.006, 0},
              {1, 0.07 / 2, 0.1, 1}};

/* Where a place at a length along the zig-zag is along the shorter edge, m. */
static double pleated(double along, double pitch, double depth)
{
    const double unit = pitch + 2 * depth, flat = (pitch - depth) / 2;
    const double i = floor(along / unit + 1e-9), t = along - i * unit;
    return i * pitch + (t <= flat + depth       ? t
                        : t <= flat + 2 * depth ? 2 * (flat + depth) - t
                                                : t - 2 * depth);
}

UNIT_LOOP(pleats_fold_the_longer_edge, 0, sizeof PLEATS / sizeof *PLEATS)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("gather");
    UNIT_OWNED(garment_free) struct garment garment;
    struct garment_stitch *stitch = pattern.stitch;
    const int longer = PLEATS[_i].side;
    const double pitch = 0.13 / PLEATS[_i].count, wide = 0.2;
    const double depth = fmin(PLEATS[_i].depth, pitch), whole = 0.13 + 2 * PLEATS[_i].count * depth;
    if (longer) {
        const struct garment_side side = stitch->side[0];
        stitch->side[0] = stitch->side[1];
        stitch->side[1] = side;
    }
    stitch->pleats = (struct garment_pleats){PLEATS[_i].count, depth, longer};
    make_garment(&garment, &pattern, PLEATS[_i].edge, 0);
    const struct garment_seam *seam = &garment.seam[0];
    const double *from = garment.uv[seam->pair[0][longer]];
    const double *to = garment.uv[seam->pair[0][!longer]];
    uint32_t turned = 0;
    for (uint32_t i = 0; i < seam->n_pairs; i++) {
        const double along = distance_of(from, garment.uv[seam->pair[i][longer]], 2);
        const double at = distance_of(to, garment.uv[seam->pair[i][!longer]], 2);
        const double wanted = pleated(along * whole / wide, pitch, depth);
        ck_assert_double_eq_tol(at, wanted, 1e-12);
        turned += fabs(wanted - (0.5 * pitch + 0.5 * depth)) < 1e-12; /* the first pleat's ridge */
    }
    ck_assert_uint_eq(turned, depth < pitch ? 2 : 3);
    ck_assert_double_eq_tol(distance_of(from, garment.uv[seam->pair[seam->n_pairs - 1][longer]], 2),
                            wide, 1e-12);
}

static bool same_vertices(const uint32_t *one, const uint32_t *other, const uint32_t *twin)
{
    uint32_t same = 0;
    for (int i = 0; i < 9; i++)
        same += one[i / 3] == twin[other[i % 3]];
    return same == 3;
}

/* A dart closes at the vertex that its edges share: edge 3 ends there, edge 4 begins there. */
UNIT_TEST(darts_close_at_their_tip)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("dart");
    UNIT_OWNED(garment_free) struct garment garment;
    make_garment(&garment, &pattern, 0.01, 0);
    const struct garment_seam *seam = &garment.seam[0];
    const uint32_t *tip = seam->pair[seam->n_pairs - 1];
    ck_assert(seam->reversed);
    ck_assert_uint_eq(tip[0], tip[1]);
    ck_assert_uint_eq(tip[0], garment.piece[0].start[4]);
}

/* Two panels sewn all around, of any shape of corner that can open: no triangle of one has the
 * three vertices of one of the other, and each panel is still covered once. */
UNIT_LOOP(sewn_corners_open, 0, N_EDGES * 3)
{
    /* m: how far the upper corners are moved; corners of 90, 68 and 63 degrees */
    static const double aside[3] = {0, 0.08, 0.1};
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("cushion");
    UNIT_OWNED(garment_free) struct garment garment;
    for (uint32_t p = 0; p < 2; p++)
        for (uint32_t v = 2; v < 4; v++)
            pattern.panel[p].corner[v][0] += aside[_i / N_EDGES];
    make_garment(&garment, &pattern, EDGES[_i % N_EDGES], 0);
    uint32_t *twin = malloc(garment.n_vertices * sizeof *twin), n_same = 0;
    for (uint32_t v = 0; v < garment.n_vertices; v++)
        twin[v] = v;
    for (uint32_t s = 0; s < garment.n_seams; s++)
        for (uint32_t k = 0; k < garment.seam[s].n_pairs; k++)
            twin[garment.seam[s].pair[k][1]] = garment.seam[s].pair[k][0];
    for (uint32_t t = 0; t < garment.piece[0].n_triangles; t++)
        for (uint32_t u = garment.piece[1].first_triangle; u < garment.n_triangles; u++)
            n_same += same_vertices(garment.triangle[t], garment.triangle[u], twin);
    ck_assert_uint_eq(n_same, 0);
    for (uint32_t p = 0; p < 2; p++)
        check_area(&garment, &garment.piece[p], garment.piece[p].start[4]);
    free(twin);
}

/* Panels that meet at a right angle along their seam: partners are at one place. The side's loop is
 * clockwise, so its front is on the side of its -z, which the rotation takes to the room's -x, and
 * its u is -x. */
UNIT_TEST(folds_meet)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("fold");
    UNIT_OWNED(garment_free) struct garment garment;
    make_garment(&garment, &pattern, 0.01, 0);
    const struct garment_seam *seam = &garment.seam[0];
    ck_assert(!seam->reversed);
    for (uint32_t i = 0; i < seam->n_pairs; i++)
        ck_assert(distance_of(garment.position[seam->pair[i][0]],
                              garment.position[seam->pair[i][1]], 3) < 1e-15);
    const struct garment_piece *side = &garment.piece[1];
    for (uint32_t v = side->first; v < side->first + side->n_vertices; v++) {
        ck_assert(garment.position[v][0] == 0.3);
        ck_assert(garment.position[v][2] == garment.uv[v][0]);
        ck_assert(garment.position[v][1] == garment.uv[v][1]);
    }
    const uint32_t *t = garment.triangle[side->first_triangle];
    const double *a = garment.position[t[0]], *b = garment.position[t[1]],
                 *c = garment.position[t[2]];
    ck_assert((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]) < 0);
}

/* A front, a back, and beside their necks a panel of a hood, by its lower edge. */
struct hood {
    double place[3], turned, back; /* of the hood, m and degrees; z of the back, m */
    bool flipped,
        right_wrong; /* the hood has its front inside; the word, in its seam at the back */
    double vote[2];  /* above 0: by the distances of its seams they are reversed, */
    bool reversed[2], unsure[2]; /* and as they are */
};
static const struct hood HOODS[] = {
    /* Too far to tell: by their fronts. */
    {{0.15, 0.5, 0}, 90, -0.25, false, false, {-0.005, -0.005}, {true, true}, {true, true}},
    {{0.15, 0.5, 0}, 90, -0.25, false, true, {-0.005, -0.005}, {true, false}, {true, false}},
    /* The seam at the front is clear, and decides for that at the back. */
    {{0.07, 0.33, 0.1}, 60, -0.25, false, false, {0.088, -0.0144}, {true, true}, {false, false}},
    {{0.07, 0.33, 0.1}, 60, -0.25, true, false, {-0.088, 0.0144}, {false, false}, {false, false}},
    /* All are clear, and the least so is overruled. */
    {{0.07, 0.33, 0.1}, 60, 0, false, false, {0.088, -0.174}, {false, false}, {true, false}}};

static void place_hood(struct garment_pattern *pattern, const struct hood *hood)
{
    struct garment_panel *panel = pattern->panel + 2;
    struct garment_stitch *stitch = pattern->stitch + 2;
    memcpy(panel->translate, hood->place, sizeof panel->translate);
    panel->rotate[1] = hood->turned + (hood->flipped ? 180 : 0);
    pattern->panel[1].translate[2] = hood->back;
    stitch[0].side[1].edge = hood->flipped;
    stitch[1].side[1].edge = !hood->flipped;
    stitch[1].right_wrong = hood->right_wrong;
}

UNIT_LOOP(fronts_are_on_one_side, 0, sizeof HOODS / sizeof *HOODS)
{
    const struct hood *hood = HOODS + _i;
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("hood");
    UNIT_OWNED(garment_free) struct garment garment;
    place_hood(&pattern, hood);
    make_garment(&garment, &pattern, 0.02, 0);
    const struct garment_seam *seam = garment.seam;
    ck_assert(seam[0].reversed && seam[1].reversed && !seam[0].unsure && !seam[1].unsure);
    for (int k = 0; k < 2; k++) {
        const double *mean = seam[2 + k].distance;
        ck_assert_double_eq_tol((mean[0] - mean[1]) / fmax(mean[0], mean[1]), hood->vote[k], 5e-4);
        ck_assert_int_eq(seam[2 + k].reversed, hood->reversed[k]);
        ck_assert_int_eq(seam[2 + k].unsure, hood->unsure[k]);
    }
}

/* About x first, then y: 90 and 90 degrees take (x, y) to (y, 0, -x). */
UNIT_TEST(rotations_are_in_order)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("straight");
    UNIT_OWNED(garment_free) struct garment garment;
    make_garment(&garment, &pattern, 0.05, 0);
    for (uint32_t v = 0; v < garment.n_vertices; v++) {
        const double *uv = garment.uv[v], *x = garment.position[v];
        ck_assert(fabs(x[0] - (uv[1] + 0.1)) < 1e-15 && fabs(x[1] - 1) < 1e-15 &&
                  fabs(x[2] - (-uv[0] - 0.2)) < 1e-15);
    }
}

/* Twice the same bits, whatever lay in memory before. */
UNIT_TEST(the_same_again)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("circle");
    UNIT_OWNED(garment_free) struct garment one, two;
    make_garment(&one, &pattern, 0.011, 0);
    make_garment(&two, &pattern, 0.011, 0);
    ck_assert_uint_eq(one.n_vertices, two.n_vertices);
    ck_assert_uint_eq(one.n_triangles, two.n_triangles);
    ck_assert(memcmp(one.position, two.position, one.n_vertices * sizeof *one.position) == 0);
    ck_assert(memcmp(one.triangle, two.triangle, one.n_triangles * sizeof *one.triangle) == 0);
}
