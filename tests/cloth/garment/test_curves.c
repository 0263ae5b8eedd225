/* Lengths, areas and divisions of a panel's edges against closed forms. */
#include "cloth/garment/detail/curve.h"
#include "tests/cloth/garment/tools.h"

#define PI 3.14159265358979323846

static void expect(double got, double want, double relative)
{
    ck_assert_msg(fabs(got - want) <= relative * fabs(want), "%.17g is not %.17g", got, want);
}

/* The length of a parabola over a chord, whose control point is `height` chords beside its middle:
 * the integral of sqrt(1 + (2 height (1 - 2 t))^2). */
static double parabola(double chord, double height)
{
    const double m = 2 * height;
    return chord * 0.5 * (sqrt(1 + m * m) + asinh(m) / m);
}

UNIT_TEST(straight_edges)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("straight");
    expect(garment_panel_area(&pattern.panel[0]), 0.12, 1e-14);
    expect(garment_edge_length(&pattern.panel[0], 0), 0.4, 1e-14);
    expect(garment_edge_length(&pattern.panel[0], 3), 0.3, 1e-14);
}

/* Under a parabola are two thirds of its height, which is half that of the control point. */
UNIT_TEST(quadratic_edges)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("quadratic");
    expect(garment_panel_area(&pattern.panel[0]), 0.24 + 0.36 * (0.2 - 0.1) / 3, 1e-13);
    expect(garment_edge_length(&pattern.panel[0], 0), parabola(0.6, 0.2), 1e-13);
    expect(garment_edge_length(&pattern.panel[0], 2), parabola(0.6, 0.1), 1e-13);
}

/* A cubic curve whose controls are two thirds on the way to that of a quadratic one is that one:
 * the controls are at 8 cm and 4 cm, those of the parabolas at 12 and 6. */
UNIT_TEST(cubic_edges)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("cubic");
    expect(garment_panel_area(&pattern.panel[0]), 0.24 + 0.36 * (0.2 - 0.1) / 3, 1e-13);
    expect(garment_edge_length(&pattern.panel[0], 0), parabola(0.6, 0.2), 1e-13);
    expect(garment_edge_length(&pattern.panel[0], 2), parabola(0.6, 0.1), 1e-13);
}

/* The radius of the disc's other half is a rounded one, less than half its chord: a half circle,
 * too. */
UNIT_TEST(circular_edges)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("circle");
    expect(garment_panel_area(&pattern.panel[0]), PI * 0.04, 1e-13);
    expect(garment_edge_length(&pattern.panel[0], 0), PI * 0.2, 1e-13);
    expect(garment_edge_length(&pattern.panel[0], 1), PI * 0.2, 1e-13);
    expect(garment_panel_area(&pattern.panel[1]), 0.75 * PI * 0.04, 1e-13);
    expect(garment_edge_length(&pattern.panel[1], 1), 1.5 * PI * 0.2, 1e-13);
    expect(garment_panel_area(&pattern.panel[2]), 0.04 - 0.01 * (PI / 2 - 1), 1e-13);
    expect(garment_edge_length(&pattern.panel[2], 3), sqrt(0.02) * PI / 2, 1e-13);
    ck_assert_str_eq(pattern.panel[1].name, "three_quarters");
}

/* Places at equal parts of the length: of an arc the chords between them are equal, and all are as
 * far from the centre; of a parabola the length up to each is its part of the whole. */
UNIT_TEST(equal_parts)
{
    UNIT_OWNED(garment_pattern_free) struct garment_pattern pattern = read_pattern("circle");
    struct curve curve;
    double last[2] = {-0.2, 0}, now[2];
    curve_make(&curve, &pattern.panel[0], 0);
    for (int k = 1; k <= 7; k++) {
        curve_at_length(&curve, k / 7.0, now);
        expect(sqrt(now[0] * now[0] + now[1] * now[1]), 0.2, 1e-14);
        expect(distance_of(last, now, 2), 0.4 * sin(PI / 14), 1e-13);
        memcpy(last, now, sizeof last);
    }
    garment_pattern_free(&pattern);
    pattern = read_pattern("quadratic");
    curve_make(&curve, &pattern.panel[0], 0);
    for (int k = 1; k < 10; k++) { /* x = 0.6 t; the length from the middle on is odd in 1 - 2 t */
        curve_at_length(&curve, k / 10.0, now);
        const double u = 0.4 * (1 - 2 * now[0] / 0.6), whole = 0.4 * sqrt(1.16) + asinh(0.4);
        expect(0.5 - 0.5 * (u * sqrt(1 + u * u) + asinh(u)) / whole, k / 10.0, 1e-12);
    }
}
