/* + - * / and sqrt only, so that a motion has the same bits everywhere. */
#include "cloth/physics/motion.h"

#include "cloth/base/axes.h"
#include "cloth/physics/curve.h"

void phys_pose_at(size_t n, const struct phys_key *keys, const double about[3], double time,
                  struct phys_pose *pose)
{
    const size_t at = phys_key_before(n, &keys->time, sizeof *keys / sizeof(double), time);
    const struct phys_key *a = keys + at, *b = at + 1 < n ? a + 1 : a;
    const double part = b == a || time <= a->time ? 0 : (time - a->time) / (b->time - a->time);
    double dot = 0, q[4];
    for (int i = 0; i < 4; i++)
        dot += a->rotate[i] * b->rotate[i];
    const double sign = dot < 0 ? -1 : 1;
    for (int i = 0; i < 4; i++)
        q[i] = (1 - part) * a->rotate[i] + part * sign * b->rotate[i];
    cloth_rotation(q, pose->turn);
    for (int i = 0; i < 3; i++) {
        pose->about[i] = about[i];
        pose->translate[i] = (1 - part) * a->translate[i] + part * b->translate[i];
    }
}

void phys_pose_direction(const struct phys_pose *pose, const phys_vec *from, phys_vec *to)
{
    const phys_vec d = *from;
    phys_vec turned = {0};
    for (int i = 0; i < 3; i++)
        turned[i] = pose->turn[i][0] * d[0] + pose->turn[i][1] * d[1] + pose->turn[i][2] * d[2];
    *to = turned;
}

void phys_pose_direction_back(const struct phys_pose *pose, const phys_vec *from, phys_vec *to)
{
    const phys_vec d = *from;
    phys_vec turned = {0};
    for (int i = 0; i < 3; i++)
        turned[i] = pose->turn[0][i] * d[0] + pose->turn[1][i] * d[1] + pose->turn[2][i] * d[2];
    *to = turned;
}

static void offsets(const struct phys_pose *pose, phys_vec *about, phys_vec *shift)
{
    *about = PHYS_VEC(pose->about);
    *shift = PHYS_VEC(pose->translate);
}

void phys_pose_point(const struct phys_pose *pose, const phys_vec *from, phys_vec *to)
{
    phys_vec about, shift, turned;
    offsets(pose, &about, &shift);
    const phys_vec arm = *from - about;
    phys_pose_direction(pose, &arm, &turned);
    *to = turned + about + shift;
}

void phys_pose_back(const struct phys_pose *pose, const phys_vec *from, phys_vec *to)
{
    phys_vec about, shift, turned;
    offsets(pose, &about, &shift);
    const phys_vec arm = *from - shift - about;
    phys_pose_direction_back(pose, &arm, &turned);
    *to = turned + about;
}
