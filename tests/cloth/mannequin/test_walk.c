/* Figures that walk: no self-intersection, room for cloth between limbs, edges that keep their
 * length, no jump of velocities; poses turn limbs where they should. */
#include "cloth/mannequin/pose.h"
#include "tests/cloth/mannequin/tools.h"

static const double FPS = 25, ROOM_BESIDE = 0.03, ROOM_BETWEEN = 0.02, STRETCH = 1.6;

struct figure_at {
    struct mesh mesh;
    struct mannequin_rig rig;
    double (*x)[3];
};

static void make(struct figure_at *figure, const struct mannequin *mannequin)
{
    UNIT_FINE(mannequin_make(&figure->mesh, &figure->rig, mannequin, NULL, &error));
    figure->x = calloc(figure->mesh.n_vertices, sizeof *figure->x);
}

static void release(struct figure_at *figure)
{
    mesh_free(&figure->mesh);
    mannequin_rig_free(&figure->rig);
    free(figure->x);
}

static void place(struct figure_at *figure, const struct mannequin_walk *walk, double time)
{
    double angle[MANNEQUIN_ANGLES];
    mannequin_walk_at(walk, time, angle);
    mannequin_place(&figure->rig, &figure->mesh, angle, figure->x);
}

static void check_stretch(const struct figure_at *figure)
{
    for (size_t i = 0; i < 3 * (size_t)figure->mesh.n_triangles; i++) {
        const uint32_t a = figure->mesh.triangle[i];
        const uint32_t b = figure->mesh.triangle[i - i % 3 + (i + 1) % 3];
        const double was = distance_of(place_of(&figure->mesh, a), place_of(&figure->mesh, b));
        ck_assert(distance_of(figure->x[a], figure->x[b]) <= STRETCH * was);
    }
}

/* Where a vertex of the standing figure belongs to: parts that are to keep apart. */
enum region { ELSEWHERE, TORSO, LEFT_ARM, RIGHT_ARM, LEFT_LEG, RIGHT_LEG };

static enum region region_of(const double *x)
{
    if (fabs(x[0]) > 0.31)
        return x[0] > 0 ? LEFT_ARM : RIGHT_ARM;
    if (x[1] < 0.76)
        return x[0] > 0 ? LEFT_LEG : RIGHT_LEG;
    return x[1] < 1.3 && fabs(x[0]) < 0.2 ? TORSO : ELSEWHERE;
}

static double apart(const struct figure_at *figure, enum region one, enum region two)
{
    double least = INFINITY;
    for (uint32_t v = 0; v < figure->mesh.n_vertices; v++)
        for (uint32_t w = 0;
             region_of(place_of(&figure->mesh, v)) == one && w < figure->mesh.n_vertices; w++)
            if (region_of(place_of(&figure->mesh, w)) == two)
                least = fmin(least, distance_of(figure->x[v], figure->x[w]));
    return least;
}

/* Over the way into the walk and two periods of it. */
UNIT_TEST(walk_keeps_room)
{
    const struct mannequin_walk walk = {0};
    struct figure_at figure;
    make(&figure, &(struct mannequin){0});
    const int end = (int)(FPS * (MANNEQUIN_WALK_RAMP + 4)), stride = unit_quick() ? 15 : 1;
    for (int frame = 0; frame <= end; frame += stride) {
        place(&figure, &walk, frame / FPS);
        ck_assert_uint_eq(crossings(&figure.mesh, figure.x[0]), 0);
        check_stretch(&figure);
        if (frame % 5)
            continue;
        ck_assert_double_gt(apart(&figure, LEFT_ARM, TORSO), ROOM_BESIDE);
        ck_assert_double_gt(apart(&figure, RIGHT_ARM, TORSO), ROOM_BESIDE);
        ck_assert_double_gt(apart(&figure, LEFT_ARM, LEFT_LEG), ROOM_BESIDE);
        ck_assert_double_gt(apart(&figure, LEFT_LEG, RIGHT_LEG), ROOM_BETWEEN);
    }
    release(&figure);
}

/* Thick and thin figures do not go through themselves. */
UNIT_LOOP(walk_of_others, 0, 3)
{
    static const struct mannequin other[] = {{.height = 1.55,
                                              .girth[MANNEQUIN_CHEST] = 1.05,
                                              .girth[MANNEQUIN_WAIST] = 0.95,
                                              .girth[MANNEQUIN_HIP] = 1.1,
                                              .girth[MANNEQUIN_THIGH] = 0.62,
                                              .girth[MANNEQUIN_UPPER_ARM] = 0.33},
                                             {.height = 1.9,
                                              .girth[MANNEQUIN_CHEST] = 0.92,
                                              .girth[MANNEQUIN_WAIST] = 0.74,
                                              .girth[MANNEQUIN_HIP] = 0.95,
                                              .girth[MANNEQUIN_THIGH] = 0.53},
                                             {.edge = 0.012}};
    const struct mannequin_walk walk = {.speed = 2};
    struct figure_at figure;
    make(&figure, &other[_i]);
    for (int frame = 30; frame <= 80; frame += unit_quick() ? 20 : 2) {
        place(&figure, &walk, frame / FPS);
        ck_assert_uint_eq(crossings(&figure.mesh, figure.x[0]), 0);
        check_stretch(&figure);
    }
    release(&figure);
}

/* It stands still until it begins, and at the begin. */
UNIT_TEST(walk_begins_at_rest)
{
    const struct mannequin_walk walk = {.begin = 0.5};
    struct figure_at figure;
    make(&figure, &(struct mannequin){0});
    for (int i = 0; i < 2; i++) {
        place(&figure, &walk, 0.5 * i);
        for (uint32_t v = 0; v < figure.mesh.n_vertices; v++)
            ck_assert_double_lt(distance_of(figure.x[v], place_of(&figure.mesh, v)), 1e-12);
    }
    release(&figure);
}

/* Differences of angles over 1 ms change by no more than an acceleration that is finite allows,
 * also where the ramp begins and ends. */
UNIT_TEST(walk_has_no_jerk)
{
    const struct mannequin_walk walk = {.speed = 1.5, .begin = 0.3};
    const double h = 0.001, most = 1500; /* s; degrees / s^2 */
    double angle[3][MANNEQUIN_ANGLES];
    mannequin_walk_at(&walk, 0, angle[0]);
    mannequin_walk_at(&walk, h, angle[1]);
    for (int i = 2; i < 6000; i++) {
        mannequin_walk_at(&walk, i * h, angle[2]);
        for (uint32_t k = 0; k < MANNEQUIN_ANGLES; k++)
            ck_assert_double_lt(fabs(angle[2][k] - 2 * angle[1][k] + angle[0][k]), most * h * h);
        memmove(angle[0], angle[1], 2 * sizeof angle[0]);
    }
}

/* Both sides do the same, half a period apart; after a period all is the same again. */
UNIT_TEST(walk_is_periodic)
{
    const struct mannequin_walk walk = {.speed = 1.25};
    const double step = 1 / 1.25;
    for (int i = 0; i < 20; i++) {
        double one[MANNEQUIN_ANGLES], next[MANNEQUIN_ANGLES], again[MANNEQUIN_ANGLES];
        mannequin_walk_at(&walk, 2 + 0.11 * i, one);
        mannequin_walk_at(&walk, 2 + 0.11 * i + step, next);
        mannequin_walk_at(&walk, 2 + 0.11 * i + 2 * step, again);
        for (uint32_t k = 0; k < MANNEQUIN_ANGLES; k++)
            ck_assert_double_lt(fabs(one[k] - again[k]), 1e-9);
        for (uint32_t k = MANNEQUIN_ARM_ASIDE; k < MANNEQUIN_SIDE; k++)
            ck_assert_double_lt(fabs(one[k] - next[mannequin_on_side(k, 1)]), 1e-9);
        for (uint32_t k = 0; k < MANNEQUIN_SIDE; k++) {
            ck_assert(one[k] >= mannequin_limits[k].least - 1e-9);
            ck_assert(one[k] <= mannequin_limits[k].most + 1e-9);
        }
    }
}

static void rest_pose(struct mannequin_pose *pose)
{
    for (uint32_t k = 0; k < MANNEQUIN_SIDE; k++) {
        pose->angle[k] = mannequin_limits[k].rest;
        if (k >= MANNEQUIN_ARM_ASIDE)
            pose->angle[mannequin_on_side(k, 1)] = mannequin_limits[k].rest;
    }
}

/* The middle of all vertices that are wholly of some of the bones: 0 for none. */
static void middle_of(const struct figure_at *figure, uint32_t bone, double middle[3])
{
    double sum = 0;
    memset(middle, 0, 3 * sizeof *middle);
    for (uint32_t v = 0; v < figure->mesh.n_vertices; v++)
        if (figure->rig.weight[v][bone] > 0.99) {
            for (int c = 0; c < 3; c++)
                middle[c] += figure->x[v][c];
            sum += 1;
        }
    ck_assert(sum > 10);
    for (int c = 0; c < 3; c++)
        middle[c] /= sum;
}

/* The part that one angle moves goes that way, and by the way that its distance from the joint
 * makes. bone: 2 upper arm, 3 forearm, 4 thigh, 5 shin, 6 foot of the left; joint: its own. */
static const struct {
    uint32_t angle, bone, joint;
    double by, way[3];
} MOVES[] = {
    {MANNEQUIN_ARM_ASIDE, 3, 2, 20, {1, 1, 0}},   {MANNEQUIN_ARM_SWING, 3, 2, 20, {0, 0, 1}},
    {MANNEQUIN_ELBOW_BEND, 3, 3, 30, {0, 0, 1}},  {MANNEQUIN_LEG_ASIDE, 5, 4, 10, {1, 0, 0}},
    {MANNEQUIN_LEG_SWING, 5, 4, 20, {0, 0, 1}},   {MANNEQUIN_KNEE_BEND, 5, 5, 30, {0, 0, -1}},
    {MANNEQUIN_ANKLE_BEND, 6, 6, 10, {0, 1, 0}},  {MANNEQUIN_SPINE_BEND, 1, 1, 10, {0, 0, 1}},
    {MANNEQUIN_SPINE_TURN, 3, 1, 10, {0, 0, -1}},
};

UNIT_LOOP(angles_move_their_parts, 0, sizeof MOVES / sizeof *MOVES)
{
    struct mannequin_pose pose = {0};
    struct figure_at figure;
    double before[3], after[3], along = 0;
    make(&figure, &(struct mannequin){0});
    rest_pose(&pose);
    mannequin_place(&figure.rig, &figure.mesh, pose.angle, figure.x);
    middle_of(&figure, MOVES[_i].bone, before);
    pose.angle[MOVES[_i].angle] += MOVES[_i].by;
    mannequin_place(&figure.rig, &figure.mesh, pose.angle, figure.x);
    middle_of(&figure, MOVES[_i].bone, after);
    const double *joint = figure.rig.joint[MOVES[_i].joint];
    for (int c = 0; c < 3; c++)
        along += (after[c] - before[c]) * MOVES[_i].way[c];
    ck_assert_double_gt(along, 0.5 * distance_of(before, after));
    ck_assert_double_lt(fabs(distance_of(before, joint) - distance_of(after, joint)), 1e-4);
    const double chord = 2 * sin(MOVES[_i].by * 3.14159265358979323846 / 360);
    ck_assert_double_le(distance_of(before, after), chord * distance_of(before, joint) + 1e-4);
    ck_assert_double_ge(distance_of(before, after), 0.5 * chord * distance_of(before, joint));
    release(&figure);
}

UNIT_TEST(poses_go_smoothly)
{
    struct mannequin_pose pose[3] = {{.time = 1}, {.time = 2}, {.time = 4}};
    double angle[MANNEQUIN_ANGLES];
    for (int k = 0; k < 3; k++)
        rest_pose(&pose[k]);
    pose[1].angle[MANNEQUIN_KNEE_BEND] = 40;
    pose[2].angle[MANNEQUIN_KNEE_BEND] = 20;
    static const double at[][2] = {
        {0, 0}, {1, 0}, {1.25, 40 * 0.15625}, {1.5, 20}, {2, 40}, {3, 30}, {4, 20}, {9, 20}};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        mannequin_pose_at(pose, 3, at[i][0], angle);
        ck_assert_double_eq_tol(angle[MANNEQUIN_KNEE_BEND], at[i][1], 1e-12);
        ck_assert_double_eq(angle[MANNEQUIN_ARM_ASIDE], 45);
    }
}
