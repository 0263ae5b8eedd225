/* Patterns in DXF: pieces that are drawn in each of the ways that programs have, against what they
 * measure; and files that are wrong. Texts are written a pair a word, "CODE VALUE" with | behind.
 */
#include "cloth/output/garment.h"
#include "tests/cloth/garment/tools.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define BEGIN                   "0 SECTION|2 BLOCKS|"
#define BLOCK(texts)            "0 BLOCK|8 0|2 B|" texts
#define TEXT(text)              "0 TEXT|8 1|1 " text "|"
#define NAME(name)              TEXT("Piece Name: " name)
#define V(layer, x, y)          "0 VERTEX|8 " #layer "|10 " #x "|20 " #y "|"
#define LOOP(layer, vertices)   "0 POLYLINE|8 " #layer "|66 1|70 1|" vertices "0 SEQEND|8 1|"
#define OPEN(layer, vertices)   "0 POLYLINE|8 " #layer "|66 1|70 0|" vertices "0 SEQEND|8 1|"
#define LINE(layer, a, b, c, d) "0 LINE|8 " #layer "|10 " #a "|20 " #b "|11 " #c "|21 " #d "|"
#define POINT(layer, x, y)      "0 POINT|8 " #layer "|10 " #x "|20 " #y "|"
#define END                     "0 ENDBLK|"
#define UNITS(units)            "0 ENDSEC|0 SECTION|2 ENTITIES|" TEXT("UNITS: " units)
#define OVER                    "0 ENDSEC|0 EOF|"
#define SQUARE(layer, a)        LOOP(layer, V(layer, 0, 0) V(layer, a, 0) V(layer, a, a) V(layer, 0, a))

/* Reads a text, in a file in memory. Returns the code. */
static int read_dxf(struct garment_pattern *pattern, const char *pairs,
                    const struct garment_choice *choice, struct cloth_error *error)
{
    char path[64];
    const int file = memfd_create("dxf", 0);
    FILE *to = fdopen(dup(file), "w");
    bool in_code = true;
    for (const char *at = pairs; *at; at++) {
        const bool ends = *at == '|' || (in_code && *at == ' ');
        in_code = ends ? *at == '|' : in_code;
        fputs(ends ? "\r\n" : (char[]){*at, '\0'}, to);
    }
    fclose(to);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    int code = garment_read_dxf(pattern, path, choice, error);
    code = code ? code : garment_pattern_check(pattern, error);
    close(file);
    return code;
}

static struct garment_pattern read_right(const char *pairs, const char *size)
{
    const struct garment_choice choice = {.size = size};
    struct garment_pattern pattern;
    UNIT_FINE(read_dxf(&pattern, pairs, &choice, &error));
    return pattern;
}

static void lengths_are(const struct garment_panel *panel, uint32_t n, const double *length)
{
    ck_assert_uint_eq(panel->n_edges, n);
    for (uint32_t e = 0; e < n; e++)
        ck_assert_double_eq_tol(garment_edge_length(panel, e), length[e], 1e-12);
}

/* The grain line of a piece that lies along x points up in the panel; the middle is the origin. */
UNIT_TEST(a_piece_stands_by_its_grain_line)
{
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern pattern =
        read_right(BEGIN BLOCK(NAME("front left") TEXT("SIZE: M"))
                       LOOP(1, V(1, 100, 50) V(1, 500, 50) V(1, 500, 250) V(1, 100, 250))
                           POINT(2, 500, 50) POINT(2, 500, 250) POINT(2, 100, 250) POINT(2, 100, 50)
                               LINE(7, 200, 100, 400, 100) END UNITS("METRIC") OVER,
                   NULL);
    ck_assert_uint_eq(pattern.n_panels, 1);
    const struct garment_panel *panel = pattern.panel;
    ck_assert_str_eq(panel->name, "front_left");
    ck_assert(panel->warp_up);
    lengths_are(panel, 4, (double[]){0.4, 0.2, 0.4, 0.2});
    const double corner[4][2] = {{0.1, -0.2}, {0.1, 0.2}, {-0.1, 0.2}, {-0.1, -0.2}};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++)
            ck_assert_double_eq_tol(panel->corner[i][k], corner[i][k], 1e-15);
}

/* Along y in the panel is u, and all of the cloth is right way up. */
UNIT_TEST(warp_runs_along_the_grain_line)
{
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern pattern = read_right(
        BEGIN BLOCK(NAME("a") TEXT("Quantity: 1,1")) SQUARE(1, 10) END UNITS("ENGLISH") OVER, NULL);
    UNIT_OWNED(garment_free) struct garment garment = {0};
    make_garment(&garment, &pattern, 0.05, 0);
    ck_assert_uint_eq(pattern.n_panels, 2);
    ck_assert_str_eq(pattern.panel[1].name, "a_2");
    ck_assert_double_eq_tol(garment_panel_area(&pattern.panel[0]), 0.254 * 0.254, 1e-12);
    ck_assert_double_eq_tol(garment_panel_area(&pattern.panel[1]), -0.254 * 0.254, 1e-12);
    for (uint32_t v = 0; v < garment.n_vertices; v++)
        ck_assert(garment.uv[v][0] >= garment.position[v][1] &&
                  garment.uv[v][0] <= garment.position[v][1]);
    for (uint32_t t = 0; t < garment.n_triangles; t++) {
        const double *a = garment.uv[garment.triangle[t][0]],
                     *b = garment.uv[garment.triangle[t][1]],
                     *c = garment.uv[garment.triangle[t][2]];
        ck_assert((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    }
}

/* Half a trapezium, drawn as an edge after the other, and its sew line 10 mm inside, which ends at
 * the mirror line. */
#define HALF_EDGES                                                                                 \
    OPEN(1, V(1, 0, 0) V(1, 0, 300))                                                               \
    OPEN(1, V(1, 0, 300) V(1, 100, 300))                                                           \
    OPEN(1, V(1, 200, 0) V(1, 100, 300)) OPEN(1, V(1, 200, 0) V(1, 0, 0))
UNIT_TEST(half_pieces_are_unfolded)
{
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern pattern = read_right(
        BEGIN BLOCK(NAME("skirt")) LINE(6, 0, 0, 0, 300) HALF_EDGES END UNITS("METRIC") OVER, NULL);
    const double side = hypot(0.1, 0.3);
    lengths_are(pattern.panel, 4, (double[]){side, 0.4, side, 0.2});
    ck_assert_double_eq_tol(fabs(garment_panel_area(pattern.panel)), 0.3 * 0.3, 1e-12);
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern sewn =
        read_right(BEGIN BLOCK(NAME("skirt")) LINE(6, 0, 0, 0, 300)
                       HALF_EDGES OPEN(14, V(14, 0, 290) V(14, 90, 290))
                           OPEN(14, V(14, 90, 290) V(14, 180, 10))
                               OPEN(14, V(14, 180, 10) V(14, 0, 10)) END UNITS("METRIC") OVER,
                   NULL);
    ck_assert_double_eq_tol(fabs(garment_panel_area(sewn.panel)), 0.28 * 0.27, 1e-12);
    ck_assert_uint_eq(sewn.panel->n_edges, 4);
}

/* A half disc of 200 chords between two turn points; the mesh of the pattern as JSON is the same.
 */
UNIT_TEST(curves_are_edges)
{
    char pairs[20000] =
        BEGIN BLOCK(NAME("half")) POINT(2, 200, 0) POINT(2, -200, 0) "0 POLYLINE|8 1|66 1|70 1|";
    for (int i = 0; i <= 200; i++) {
        const double angle = M_PI * i / 200;
        cloth_text_add(pairs, sizeof pairs, "0 VERTEX|8 1|10 %.9f|20 %.9f|", 200 * cos(angle),
                       200 * sin(angle));
    }
    cloth_text_add(pairs, sizeof pairs, "%s", "0 SEQEND|8 1|" END UNITS("MM") OVER);
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_right(pairs, NULL), back;
    ck_assert_uint_eq(pattern.panel->n_edges, 2);
    ck_assert_double_eq_tol(garment_edge_length(pattern.panel, 0), 0.2 * 200 * 2 * sin(M_PI / 400),
                            1e-9);
    char path[64] = "/tmp/duite-dxf.XXXXXX";
    close(mkstemp(path));
    UNIT_FINE(output_pattern(path, &pattern, &error));
    UNIT_FINE(scene_read_pattern(&back, path, NULL, &error));
    unlink(path);
    UNIT_OWNED(garment_free) struct garment one = {0}, two = {0};
    make_garment(&one, &pattern, 0.01, 0);
    make_garment(&two, &back, 0.01, 0);
    ck_assert_uint_eq(one.n_vertices, two.n_vertices);
    ck_assert_mem_eq(one.position, two.position, one.n_vertices * sizeof *one.position);
    ck_assert_mem_eq(one.uv, two.uv, one.n_vertices * sizeof *one.uv);
    garment_free(&two);
    garment_pattern_free(&back);
}

/* A polyline as one entity, in a file whose header says centimetres. */
UNIT_TEST(light_polylines)
{
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern pattern = read_right(
        "0 SECTION|2 HEADER|9 $INSUNITS|70 5|0 ENDSEC|0 SECTION|2 BLOCKS|0 BLOCK|2 A|"
        "0 LWPOLYLINE|8 1|70 1|10 0|20 0|10 20|20 0|10 20|20 30|10 0|20 30|0 ENDBLK|" OVER,
        NULL);
    lengths_are(pattern.panel, 4, (double[]){0.2, 0.3, 0.2, 0.3});
}

/* A notch of no width is no edge, and a loop that says no corners has them where it turns. */
UNIT_TEST(slits_and_corners)
{
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern pattern = read_right(
        BEGIN BLOCK("") LOOP(1, V(1, 0, 0) V(1, 100, 0) V(1, 200, 0) V(1, 200, 100) V(1, 101, 100)
                                    V(1, 101, 90) V(1, 100.95, 100) V(1, 0, 100)) END OVER,
        NULL);
    ck_assert_str_eq(pattern.panel->name, "B");
    lengths_are(pattern.panel, 4, (double[]){0.2, 0.1, 0.2, 0.1});
}

/* The edges of the piece with its notches as corners. */
static void notched_lengths_are(const char *pairs, uint32_t n, const double *length)
{
    const struct garment_choice choice = {.notches = true};
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern;
    UNIT_FINE(read_dxf(&pattern, pairs, &choice, &error));
    lengths_are(pattern.panel, n, length);
}

/* Notches of each kind cut the edge that they are at, or the sew line inside of them; one at a
 * corner, or far inside, cuts nothing. Without notches edges are as ever. */
#define NOTCHES                                                                                    \
    POINT(4, 30, 0) LINE(80, 100, 60, 95, 60) POINT(83, 0, 0.5) POINT(4, 50, 50) POINT(3, 70, 0)
UNIT_TEST(notches_cut_edges)
{
    UNIT_OWNED(garment_pattern_free)
    struct garment_pattern pattern =
        read_right(BEGIN BLOCK("") SQUARE(1, 100) NOTCHES END OVER, NULL);
    lengths_are(pattern.panel, 4, (double[]){0.1, 0.1, 0.1, 0.1});
    notched_lengths_are(BEGIN BLOCK("") SQUARE(1, 100) NOTCHES END OVER, 6,
                        (double[]){0.03, 0.07, 0.06, 0.04, 0.1, 0.1});
    notched_lengths_are(BEGIN BLOCK("") SQUARE(1, 100)
                            LOOP(14, V(14, 10, 10) V(14, 90, 10) V(14, 90, 90) V(14, 10, 90))
                                NOTCHES END OVER,
                        6, (double[]){0.02, 0.06, 0.05, 0.03, 0.08, 0.08});
}

/* A half piece has the images of its notches, and a slit is a notch. */
UNIT_TEST(notches_of_half_pieces_and_slits)
{
    notched_lengths_are(BEGIN BLOCK("") LINE(6, 0, 0, 0, 300)
                            LOOP(1, V(1, 0, 0) V(1, 100, 0) V(1, 100, 300) V(1, 0, 300))
                                POINT(4, 100, 200) END OVER,
                        6, (double[]){0.2, 0.1, 0.2, 0.1, 0.2, 0.2});
    notched_lengths_are(BEGIN BLOCK("") LOOP(1, V(1, 0, 0) V(1, 200, 0) V(1, 200, 100) V(1, 80, 100)
                                                    V(1, 80, 90) V(1, 80, 100) V(1, 0, 100))
                            END OVER,
                        5, (double[]){0.2, 0.1, 0.12, 0.08, 0.1});
}

#define SIZES                                                                                      \
    BEGIN BLOCK(NAME("a") TEXT("SIZE: S")) SQUARE(1, 100) END BLOCK(NAME("a") TEXT("SIZE: L"))     \
        SQUARE(1, 300) END                                                                         \
        BLOCK(NAME("b")) SQUARE(1, 50) END
UNIT_TEST(sizes)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_right(SIZES OVER, "L");
    ck_assert_uint_eq(pattern.n_panels, 2);
    ck_assert_double_eq_tol(garment_edge_length(pattern.panel, 0), 0.3, 1e-12);
    garment_pattern_free(&pattern);
    pattern = read_right(SIZES "0 ENDSEC|0 SECTION|2 ENTITIES|" TEXT("Sample Size: S") OVER, NULL);
    ck_assert_double_eq_tol(garment_edge_length(pattern.panel, 0), 0.1, 1e-12);
}

static const struct {
    const char *pairs, *size, *sentence;
} wrong[] = {
    {"hello world|", NULL, ":1: 'hello' is no group code"},
    {"999 words|", NULL, "no DXF file: it has no SECTION"},
    {BEGIN "0", NULL, ":5: the file ends behind the group code 0, without a value"},
    {BEGIN OVER, NULL, "no block has a boundary, a polyline on layer 1"},
    {SIZES OVER, NULL, "it has pieces of the sizes S, L, and no sample size among them"},
    {SIZES OVER, "M", "no piece has the size 'M'; there are S, L"},
    {BEGIN BLOCK("") SQUARE(1, 100) END UNITS("FATHOMS") OVER, NULL, "the units are 'FATHOMS'"},
    {BEGIN BLOCK(TEXT("Quantity: some")) SQUARE(1, 100) END OVER, NULL,
     ":12: the quantity of a piece is 'some'"},
    {BEGIN BLOCK("") OPEN(1, V(1, 0, 0) V(1, 9, 0) V(1, 9, 9)) END OVER, NULL,
     ":12: the boundary of piece 'B' is open"},
    {BEGIN BLOCK("") LOOP(1, V(1, 0, 0) V(1, 1e99, 0) V(1, 9, 9)) END OVER, NULL,
     ": '1e99' is no number; group code 10 is a coordinate"},
    {BEGIN BLOCK("") LOOP(1, V(1, 0, 0) "42 1|" V(1, 9, 0) V(1, 9, 9)) END OVER, NULL,
     "a bulge (group code 42) on layer 1: the AAMA and ASTM profiles have polylines alone"},
    {BEGIN BLOCK("") "0 SPLINE|8 1|70 8|" END OVER, NULL, ":12: SPLINE on layer 1"},
    {BEGIN BLOCK(NAME("x")) LOOP(1, V(1, 0, 0) V(1, 9, 9) V(1, 9, 0) V(1, 0, 9)) END OVER, NULL,
     "panel 'x': edges 0 and 2 cross"}};

UNIT_TEST(files_that_are_wrong)
{
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const struct garment_choice choice = {.size = wrong[i].size};
        UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern;
        UNIT_REFUSED(read_dxf(&pattern, wrong[i].pairs, &choice, &error), CLOTH_E_INPUT,
                     wrong[i].sentence);
    }
}
