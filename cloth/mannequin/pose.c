/* Bones hang on each other: chest on pelvis, arms on chest, legs on pelvis. A bone's turn comes
 * after that of the bone it hangs on. Vertices follow bones by weights, which go from each vertex
 * to its neighbours in so many rounds that they are smooth over a few centimetres, whatever the
 * length of edges. */
#include "cloth/mannequin/pose.h"
#include "cloth/base/vector.h"
#include "cloth/mannequin/detail/surface.h"
#include "cloth/physics/curve.h"

#include <stdlib.h>
#include <string.h>

const struct mannequin_limit mannequin_limits[MANNEQUIN_SIDE] = {
    [MANNEQUIN_SPINE_BEND] = {"spine_bend", -20, 30, 0},
    [MANNEQUIN_SPINE_TURN] = {"spine_turn", -30, 30, 0},
    [MANNEQUIN_ARM_ASIDE] = {"arm_aside", 15, 90, 45},
    [MANNEQUIN_ARM_SWING] = {"arm_swing", -40, 60, 0},
    [MANNEQUIN_ELBOW_BEND] = {"elbow_bend", 0, 90, 0},
    [MANNEQUIN_LEG_ASIDE] = {"leg_aside", -1, 25, 0},
    [MANNEQUIN_LEG_SWING] = {"leg_swing", -30, 50, 0},
    [MANNEQUIN_KNEE_BEND] = {"knee_bend", 0, 80, 0},
    [MANNEQUIN_ANKLE_BEND] = {"ankle_bend", -30, 20, 0}};

static void rest(double angle[MANNEQUIN_ANGLES])
{
    for (uint32_t i = 0; i < MANNEQUIN_ANGLES; i++)
        angle[i] = mannequin_limits[i < MANNEQUIN_SIDE ? i : i - MANNEQUIN_SIDE + 2].rest;
}

/* Rises from 0 at u <= 0 to 1 at u >= 1. */
static double pose_smooth(double u)
{
    u = u < 0 ? 0 : u > 1 ? 1 : u;
    return u * u * (3 - 2 * u);
}

void mannequin_pose_at(const struct mannequin_pose *pose, uint32_t n, double time,
                       double angle[MANNEQUIN_ANGLES])
{
    uint32_t k = 0;
    while (k + 1 < n && time >= pose[k + 1].time)
        k++;
    const struct mannequin_pose *from = &pose[k], *to = k + 1 < n ? from + 1 : from;
    const double part = to == from ? 0 : pose_smooth((time - from->time) / (to->time - from->time));
    for (uint32_t i = 0; i < MANNEQUIN_ANGLES; i++)
        angle[i] = from->angle[i] + part * (to->angle[i] - from->angle[i]);
}

/* ---- The walk ---- */

/* degrees: how far each joint goes */
static const double ASIDE = 20, ARMS = 25, LEGS = 20, KNEES = 40, ELBOWS = 14, CHEST = 4;

void mannequin_walk_at(const struct mannequin_walk *walk, double time,
                       double angle[MANNEQUIN_ANGLES])
{
    const double since = time - walk->begin;
    const double part = pose_smooth(since / MANNEQUIN_WALK_RAMP);
    const double speed = walk->speed > 0 ? walk->speed : MANNEQUIN_WALK_SPEED;
    rest(angle);
    for (uint32_t side = 0; side < 2; side++) {
        const double turns = 0.5 * speed * since + 0.5 * side;
        const double sine = phys_sine(turns), cosine = phys_sine(turns + 0.25);
        double *of = angle + mannequin_on_side(0, side);
        of[MANNEQUIN_ARM_ASIDE] += part * (ASIDE - of[MANNEQUIN_ARM_ASIDE]);
        of[MANNEQUIN_ARM_SWING] = -part * ARMS * sine;
        of[MANNEQUIN_ELBOW_BEND] = part * ELBOWS * (1 - 0.5 * sine);
        of[MANNEQUIN_LEG_SWING] = part * LEGS * sine;
        of[MANNEQUIN_KNEE_BEND] = part * KNEES * 0.25 * (1 + cosine) * (1 + cosine);
        of[MANNEQUIN_ANKLE_BEND] = part * 6 * cosine;
        if (side == 0)
            angle[MANNEQUIN_SPINE_TURN] = -part * CHEST * sine;
    }
}

/* ---- Bones ---- */

/* The number of a bone in a rig: of the left and of the right side. */
static const uint32_t rig_bones[2][FIGURE_BONES] = {{0, 1, 2, 3, 4, 5, 6}, {0, 1, 7, 8, 9, 10, 11}};

/* x -> turn x + shift. Turns are not const: C17 has no such arguments of arrays of arrays. */
struct motion {
    double turn[3][3], shift[3];
};

/* A turn by degrees about an axis of length 1 (Rodrigues). */
static void turn_about(const double axis[3], double degrees, double turn[3][3])
{
    const double s = phys_sine(degrees / 360), half = phys_sine(degrees / 720);
    const double rest_of = 2 * half * half; /* 1 - cosine */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double cross = i == j ? 0 : (i + 1) % 3 == j ? -axis[3 - i - j] : axis[3 - i - j];
            turn[i][j] = (i == j) * (1 - rest_of) + rest_of * axis[i] * axis[j] + s * cross;
        }
}

static void pose_multiply(double a[3][3], double b[3][3], double product[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            product[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

/* A bone's motion: its turn about its joint, then the motion of the bone it hangs on. */
static void hang(struct motion *on, double turn[3][3], const double joint[3], struct motion *motion)
{
    double local[3];
    for (int i = 0; i < 3; i++)
        local[i] = joint[i] - cloth_dot(turn[i], joint);
    pose_multiply(on->turn, turn, motion->turn);
    for (int i = 0; i < 3; i++)
        motion->shift[i] = cloth_dot(on->turn[i], local) + on->shift[i];
}

/* First about z, outwards, then about x, forwards: hanging limbs swing to +z. */
static void swing(double aside, double forwards, bool right, double turn[3][3])
{
    static const double across[3] = {1, 0, 0}, along[3] = {0, 0, 1};
    double out[3][3], forth[3][3];
    turn_about(along, right ? -aside : aside, out);
    turn_about(across, -forwards, forth);
    pose_multiply(forth, out, turn);
}

static void move_side(const struct mannequin_rig *rig, const double *angle, bool right,
                      struct motion *motion)
{
    static const double across[3] = {1, 0, 0};
    static const double half = 0.7071067811865476;
    const double elbow[3] = {half, right ? -half : half, 0};
    const uint32_t *bone = rig_bones[right];
    const uint32_t arm = bone[FIGURE_UPPER_ARM], forearm = bone[FIGURE_FOREARM];
    const uint32_t thigh = bone[FIGURE_THIGH], shin = bone[FIGURE_SHIN], foot = bone[FIGURE_FOOT];
    double turn[3][3];
    swing(angle[MANNEQUIN_ARM_ASIDE] - mannequin_limits[MANNEQUIN_ARM_ASIDE].rest,
          angle[MANNEQUIN_ARM_SWING], right, turn);
    hang(&motion[FIGURE_CHEST], turn, rig->joint[arm], &motion[arm]);
    turn_about(elbow, -angle[MANNEQUIN_ELBOW_BEND], turn);
    hang(&motion[arm], turn, rig->joint[forearm], &motion[forearm]);
    swing(angle[MANNEQUIN_LEG_ASIDE], angle[MANNEQUIN_LEG_SWING], right, turn);
    hang(&motion[FIGURE_PELVIS], turn, rig->joint[thigh], &motion[thigh]);
    turn_about(across, angle[MANNEQUIN_KNEE_BEND], turn);
    hang(&motion[thigh], turn, rig->joint[shin], &motion[shin]);
    turn_about(across, -angle[MANNEQUIN_ANKLE_BEND], turn);
    hang(&motion[shin], turn, rig->joint[foot], &motion[foot]);
}

void mannequin_place(const struct mannequin_rig *rig, const struct mesh *mesh,
                     const double angle[MANNEQUIN_ANGLES], double (*x)[3])
{
    static const double across[3] = {1, 0, 0}, up[3] = {0, 1, 0};
    struct motion motion[MANNEQUIN_BONES] = {
        [FIGURE_PELVIS] = {.turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    double bend[3][3], round[3][3], turn[3][3];
    turn_about(across, angle[MANNEQUIN_SPINE_BEND], bend);
    turn_about(up, angle[MANNEQUIN_SPINE_TURN], round);
    pose_multiply(bend, round, turn);
    hang(&motion[FIGURE_PELVIS], turn, rig->joint[FIGURE_CHEST], &motion[FIGURE_CHEST]);
    for (uint32_t side = 0; side < 2; side++)
        move_side(rig, angle + mannequin_on_side(0, side), side == 1, motion);
    for (uint32_t v = 0; v < mesh->n_vertices; v++) {
        const double *from = mesh->position + 3 * (size_t)v;
        double sum[3] = {0};
        for (uint32_t b = 0; b < MANNEQUIN_BONES; b++) {
            const double w = rig->weight[v][b];
            if (!(w > 0))
                continue;
            for (int i = 0; i < 3; i++)
                sum[i] += w * (cloth_dot(motion[b].turn[i], from) + motion[b].shift[i]);
        }
        memcpy(x[v], sum, sizeof sum);
    }
}

void mannequin_rig_free(struct mannequin_rig *rig)
{
    free(rig->weight);
    *rig = (struct mannequin_rig){0};
}

/* ---- Weights ---- */

static const double WIDTH = 0.055; /* m: over which weights are smooth */

/* Neighbours of vertices come in the order of triangles; each edge has both its directions. */
static void rig_smooth(const struct mesh *mesh, double (*weight)[MANNEQUIN_BONES], uint32_t rounds,
                       struct cloth_error *error)
{
    const size_t n = mesh->n_vertices, n_sides = 3 * (size_t)mesh->n_triangles;
    double(*sum)[MANNEQUIN_BONES] = cloth_alloc(n, sizeof *sum, error);
    double *count = cloth_alloc(n, sizeof *count, error);
    const bool made = sum && count;
    for (size_t i = 0; made && i < n_sides; i++)
        count[mesh->triangle[i]] += 1;
    for (uint32_t round = 0; made && round < rounds; round++) {
        memset(sum, 0, n * sizeof *sum);
        for (size_t i = 0; i < n_sides; i++) {
            const uint32_t a = mesh->triangle[i], b = mesh->triangle[i - i % 3 + (i + 1) % 3];
            for (uint32_t k = 0; k < MANNEQUIN_BONES; k++)
                sum[a][k] += weight[b][k];
        }
        for (size_t v = 0; v < n; v++)
            for (uint32_t k = 0; k < MANNEQUIN_BONES; k++)
                weight[v][k] = sum[v][k] / count[v];
    }
    free(sum);
    free(count);
}

void rig_make(struct mannequin_rig *rig, const struct mesh *mesh, const struct surface *half,
              double edge, double low, const double scale[2])
{
    rig->weight = cloth_alloc(mesh->n_vertices, sizeof *rig->weight, half->error);
    if (!rig->weight)
        return;
    for (uint32_t b = 1; b < FIGURE_BONES; b++) {
        double at[3];
        figure_joint(half->figure, b, at);
        for (uint32_t side = 0; side < 2; side++) {
            double *joint = rig->joint[rig_bones[side][b]];
            joint[0] = scale[1] * (side ? -at[0] : at[0]);
            joint[1] = scale[0] * (at[1] - low);
            joint[2] = scale[1] * at[2];
        }
    }
    uint32_t image = half->n;
    for (uint32_t v = 0; v < half->n; v++) {
        const enum figure_bone bone = figure_bone(half->figure, half->x[v]);
        rig->weight[v][rig_bones[0][bone]] = 1;
        if (!half->middle[v])
            rig->weight[image++][rig_bones[1][bone]] = 1;
    }
    const uint32_t rounds = (uint32_t)(WIDTH * WIDTH / (edge * edge)) + 1;
    rig_smooth(mesh, rig->weight, rounds, half->error);
}
