/* The camera of a fit: all points inside the margins and as near as they allow, looking from where
 * it was told. */
#include "cloth/view/pick.h"
#include "cloth/view/view.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>

enum { POINTS = 50 };
static const double MARGIN = 0.86; /* of half the picture, as camera.c has it */

/* Points of a small repeatable cloud off the origin. */
static void cloud(double *position)
{
    unsigned state = 1;
    for (int i = 0; i < 3 * POINTS; i++) {
        state = state * 1664525u + 1013904223u;
        position[i] = 3.0 + (state >> 8) / 16777216.0 * (i % 3 + 1);
    }
}

static void fit_cloud(double azimuth, double elevation, double aspect, double zoom,
                      struct view_camera *camera)
{
    struct view_fit fit;
    double position[3 * POINTS];
    cloud(position);
    view_fit_start(&fit, azimuth, elevation, aspect, zoom);
    view_fit_add(&fit, POINTS, position);
    view_fit_camera(&fit, camera);
}

/* To normalised device coordinates. */
static void project(const struct view_camera *camera, const double *p, double at[3])
{
    double clip[4];
    for (int i = 0; i < 4; i++) {
        clip[i] = (double)camera->clip[3][i];
        for (int k = 0; k < 3; k++)
            clip[i] += (double)camera->clip[k][i] * p[k];
    }
    for (int i = 0; i < 3; i++)
        at[i] = clip[i] / clip[3];
}

static void cloud_bounds(const struct view_camera *camera, double low[3], double high[3])
{
    double position[3 * POINTS], at[3];
    cloud(position);
    for (int i = 0; i < 3; i++) {
        low[i] = INFINITY;
        high[i] = -INFINITY;
    }
    for (int v = 0; v < POINTS; v++) {
        project(camera, position + 3 * v, at);
        for (int i = 0; i < 3; i++) {
            low[i] = fmin(low[i], at[i]);
            high[i] = fmax(high[i], at[i]);
        }
    }
}

UNIT_LOOP(fits_tightly, 0, 5)
{
    struct view_camera camera;
    double low[3], high[3];
    fit_cloud(37 * _i, 25 * (_i - 2), _i % 2 ? 1.778 : 0.4, 1, &camera);
    cloud_bounds(&camera, low, high);
    double max = 0;
    for (int i = 0; i < 2; i++) {
        max = fmax(max, fmin(high[i], -low[i])); /* it touches both margins of one direction */
        ck_assert(high[i] <= MARGIN + 1e-4 && low[i] >= -MARGIN - 1e-4);
    }
    ck_assert_double_eq_tol(max, MARGIN, 1e-4);
    ck_assert(low[2] > -1 && high[2] < 1);
}

UNIT_LOOP(knows_the_way_back, 0, 5)
{
    struct view_camera camera;
    double position[3 * POINTS], at[4] = {0, 0, 0, 1};
    fit_cloud(37 * _i, 25 * (_i - 2), 1.778, _i + 1, &camera);
    cloud(position);
    for (int v = 0; v < POINTS; v++) {
        double back[4] = {0};
        project(&camera, position + 3 * v, at);
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 4; k++)
                back[i] += (double)camera.world[k][i] * at[k];
        for (int i = 0; i < 3; i++)
            ck_assert_double_eq_tol(back[i] / back[3], position[3 * v + i], 1e-4);
    }
}

UNIT_TEST(zooms)
{
    struct view_camera camera;
    double low[3], high[3];
    fit_cloud(20, 30, 1.5, 2, &camera);
    cloud_bounds(&camera, low, high);
    ck_assert_double_eq_tol(fmax(high[0], high[1]), 2 * MARGIN, 1e-3);
}

UNIT_LOOP(looks_from_where_it_is_told, 0, 4)
{
    static const double from[4][2] = {{0, 0}, {90, 0}, {0, 89}, {180, 0}};
    static const int axis[4] = {2, 0, 1, 2}, sign[4] = {1, 1, 1, -1};
    struct view_camera camera;
    double low[3], high[3], centre[3] = {3.5, 4.0, 4.5};
    fit_cloud(from[_i][0], from[_i][1], 1.5, 1, &camera);
    cloud_bounds(&camera, low, high);
    for (int k = 0; k < 3; k++) {
        double away = (double)camera.eye[k] - centre[k];
        if (k == axis[_i])
            ck_assert(away * sign[_i] > 3);
        else
            ck_assert(fabs(away) < 1);
    }
    static const double right[4][3] = {{1, 0, 0}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}};
    double above[3] = {3.5, 4.4, 4.5}, aside[3], at[3][3];
    for (int k = 0; k < 3; k++)
        aside[k] = centre[k] + 0.4 * right[_i][k];
    project(&camera, centre, at[0]);
    project(&camera, above, at[1]);
    project(&camera, aside, at[2]);
    ck_assert(_i == 2 || at[1][1] > at[0][1] + 0.05); /* up is up, and nothing is mirrored */
    ck_assert(at[2][0] > at[0][0] + 0.05);
}

UNIT_TEST(one_point_is_enough)
{
    struct view_fit fit;
    struct view_camera camera;
    static const double point[3] = {5, -2, 1};
    double at[3];
    view_fit_start(&fit, 32, 20, 1.5, 1);
    view_fit_add(&fit, 1, point);
    view_fit_camera(&fit, &camera);
    project(&camera, point, at);
    ck_assert(fabs(at[0]) < 1e-2 && fabs(at[1]) < 1e-2 && fabs(at[2]) < 1);
}

/* A floor just below is in the picture, one far below does not push the camera away. */
UNIT_TEST(shows_the_near_floor)
{
    struct view_camera alone, near, far;
    struct view_fit fit;
    double position[3 * POINTS], at[3];
    static const double floors[2][1][6] = {{{0, 2, 0, 0, 2, 0}}, {{0, -20, 0, 0, 1, 0}}};
    cloud(position);
    view_fit_start(&fit, 0, 20, 1, 1);
    view_fit_add(&fit, POINTS, position);
    view_fit_camera(&fit, &alone);
    view_fit_planes(&fit, 1, floors[1]);
    view_fit_camera(&fit, &far);
    ck_assert_mem_eq(far.eye, alone.eye, sizeof far.eye);
    view_fit_planes(&fit, 1, floors[0]);
    view_fit_camera(&fit, &near);
    static const double foot[3] = {3.5, 2, 5.5};
    project(&near, foot, at);
    ck_assert(at[1] > -0.9);
    project(&alone, foot, at);
    ck_assert(at[1] < -0.9);
}

static void orbit_cloud(struct view_orbit *orbit)
{
    struct view_fit fit;
    double position[3 * POINTS];
    cloud(position);
    view_fit_start(&fit, 30, 20, 1.5, 1);
    view_fit_add(&fit, POINTS, position);
    view_fit_orbit(&fit, orbit);
}

/* A full turn ends where it began; the target stays in the middle, at the same distance. */
UNIT_TEST(turns_around_the_target)
{
    struct view_orbit orbit;
    struct view_camera camera, first;
    double at[3];
    orbit_cloud(&orbit);
    view_orbit_camera(&orbit, 1.5, &first);
    for (int i = 0; i < 12; i++) {
        view_orbit_turn(&orbit, 30, i % 2 ? 15 : -15);
        view_orbit_camera(&orbit, 1.5, &camera);
        project(&camera, orbit.target, at);
        ck_assert(fabs(at[0]) < 1e-5 && fabs(at[1]) < 1e-5 && fabs(at[2]) < 1);
        double square = 0;
        for (int k = 0; k < 3; k++)
            square += pow((double)camera.eye[k] - orbit.target[k], 2);
        ck_assert_double_eq_tol(sqrt(square), orbit.distance, 1e-5 * orbit.distance);
    }
    for (int k = 0; k < 3; k++)
        ck_assert_float_eq_tol(camera.eye[k], first.eye[k], 1e-5f);
    view_orbit_turn(&orbit, 0, 500);
    ck_assert_double_eq(orbit.elevation, 89);
}

/* The point in the middle moves by the parts of the height that are asked for, at any zoom. */
UNIT_LOOP(pans_by_parts_of_the_height, 0, 2)
{
    struct view_orbit orbit;
    struct view_camera camera;
    double before[3], at[3];
    orbit_cloud(&orbit);
    view_orbit_zoom(&orbit, _i ? 3 : 1);
    memcpy(before, orbit.target, sizeof before);
    view_orbit_pan(&orbit, 0.2, -0.1);
    view_orbit_camera(&orbit, 1.5, &camera);
    project(&camera, before, at);
    ck_assert_double_eq_tol(at[0], 0.2 * 2 / 1.5, 1e-4);
    ck_assert_double_eq_tol(at[1], -0.1 * 2, 1e-4);
}

/* Whatever the direction, nothing that was fitted is cut off by the near or the far plane. */
UNIT_LOOP(keeps_depths_when_it_turns, 0, 9)
{
    struct view_orbit orbit;
    struct view_camera camera;
    double position[3 * POINTS], at[3];
    cloud(position);
    orbit_cloud(&orbit);
    view_orbit_turn(&orbit, 40 * _i, 30 * (_i % 3 - 1));
    view_orbit_camera(&orbit, 1.5, &camera);
    for (int v = 0; v < POINTS; v++) {
        project(&camera, position + 3 * v, at);
        ck_assert(at[2] > -1 && at[2] < 1);
    }
}

/* ---- Vertices that are pointed at ---- */

enum { WIDE = 600, HIGH = 400, SHEET = 9, ALL = 2 * SHEET * SHEET };

/* Two level sheets of SHEET x SHEET vertices, the second one below the first, seen from above. */
static void see_sheets(struct view_camera *camera, double *position)
{
    struct view_fit fit;
    for (int v = 0; v < ALL; v++) {
        position[3 * v] = 0.1 * (v % SHEET);
        position[3 * v + 1] = v < SHEET * SHEET ? 1 : 0.8;
        position[3 * v + 2] = 0.1 * (v / SHEET % SHEET);
    }
    view_fit_start(&fit, 20, 70, (double)WIDE / HIGH, 1);
    view_fit_add(&fit, ALL, position);
    view_fit_camera(&fit, camera);
}

/* Both sheets, or, without triangles, a chain along the first row of each. */
static void join_sheets(struct mesh *mesh, bool triangles)
{
    static double none[3 * ALL];
    uint32_t corner[2 * ALL][3], edge[ALL][2], n = 0, n_edges = 0;
    struct cloth_error error = {0};
    for (uint32_t v = 0; v < ALL; v++) {
        const bool inside = v % SHEET + 1 < SHEET, last = v / SHEET % SHEET + 1 == SHEET;
        if (triangles && inside && !last) {
            memcpy(corner[n++], (uint32_t[3]){v, v + SHEET, v + 1}, sizeof *corner);
            memcpy(corner[n++], (uint32_t[3]){v + 1, v + SHEET, v + SHEET + 1}, sizeof *corner);
        }
        if (!triangles && inside && v / SHEET % SHEET == 0)
            memcpy(edge[n_edges++], (uint32_t[2]){v, v + 1}, sizeof *edge);
    }
    ck_assert_int_eq(mesh_inline(mesh, ALL, none, n_edges, edge[0], n, corner[0], &error), 0);
}

static uint32_t pick_beside(const struct mesh *mesh, uint32_t vertex, double pixels)
{
    struct view_camera camera;
    double position[3 * ALL], at[3];
    see_sheets(&camera, position);
    project(&camera, position + 3 * vertex, at);
    return view_pick(&camera, WIDE, HIGH, mesh, position, 0.5 * WIDE * (1 + at[0]) + pixels,
                     0.5 * HIGH * (1 - at[1]) - pixels);
}

/* Where it is seen it is picked; one below the other sheet is not. */
UNIT_TEST(picks_what_is_seen)
{
    UNIT_OWNED(mesh_free) struct mesh mesh;
    join_sheets(&mesh, true);
    for (uint32_t v = 0; v < SHEET * SHEET; v++)
        if (v % SHEET && v % SHEET + 1 < SHEET && v >= SHEET && v < SHEET * (SHEET - 1))
            ck_assert_uint_eq(pick_beside(&mesh, v, 3), v);
    const uint32_t below = SHEET * SHEET + SHEET * (SHEET / 2) + SHEET / 2;
    ck_assert_uint_lt(pick_beside(&mesh, below, 0), SHEET * SHEET);
    ck_assert_uint_eq(pick_beside(&mesh, 0, 150), VIEW_PICKED_NONE);
}

UNIT_TEST(picks_chains)
{
    UNIT_OWNED(mesh_free) struct mesh mesh;
    join_sheets(&mesh, false);
    for (uint32_t v = 0; v < SHEET; v++)
        ck_assert_uint_eq(pick_beside(&mesh, v, 5), v);
    ck_assert_uint_eq(pick_beside(&mesh, 4 * SHEET, 0), VIEW_PICKED_NONE);
}

/* Two cloths, one of two panels, as cloth.obj has them. */
UNIT_TEST(names_what_is_picked)
{
    char *group[] = {"shirt", "front", "back", "scarf"};
    struct mesh_group_run run[] = {{0, 0, 2}, {1, 0, 1}, {2, 1, 1}, {3, 2, 1}};
    uint32_t corner[] = {0, 1, 2, 3, 4, 5, 6, 7, 8}, start[] = {0, 3, 6, 9}, end[] = {6, 9};
    const struct mesh mesh = {.n_vertices = 9,
                              .n_faces = 3,
                              .face_start = start,
                              .face_corner = corner,
                              .n_groups = 4,
                              .n_group_runs = 4,
                              .group = group,
                              .group_run = run};
    char line[160];
    struct view_picked picked = view_picked_of(&mesh, 2, end, 4);
    ck_assert_uint_eq(picked.vertex, 4);
    ck_assert_str_eq(picked.cloth, "shirt");
    ck_assert_str_eq(picked.panel, "back");
    picked = view_picked_of(&mesh, 2, end, 8);
    ck_assert_ptr_null(picked.panel);
    view_picked_probe(&picked, sizeof line, line);
    ck_assert_str_eq(line, "- {name: vertex2, cloth: scarf, vertices: [2]}");
}
