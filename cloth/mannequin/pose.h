#ifndef CLOTH_MANNEQUIN_POSE_H
#define CLOTH_MANNEQUIN_POSE_H

#include "cloth/mannequin/mannequin.h"

/* Figures that move: bones turn about joints, and the mesh follows by smooth weights (linear blend
 * skinning). Pure functions of + - * / and sqrt, as of mannequin.h. */

/* Angles in degrees. The arms' angle aside is that from straight down. Swings go forwards, to +z.
 * The spine turns and bends the chest, with arms and head; the hips stay where they are. */
enum mannequin_angle {
    MANNEQUIN_SPINE_BEND, /* forwards */
    MANNEQUIN_SPINE_TURN, /* to the left */
    MANNEQUIN_ARM_ASIDE,  /* of the left side, then of the right one */
    MANNEQUIN_ARM_SWING,
    MANNEQUIN_ELBOW_BEND,
    MANNEQUIN_LEG_ASIDE,
    MANNEQUIN_LEG_SWING,
    MANNEQUIN_KNEE_BEND,
    MANNEQUIN_ANKLE_BEND, /* the toes up */
    MANNEQUIN_SIDE,       /* angles before those of the right side */
    MANNEQUIN_ANGLES = MANNEQUIN_SIDE + MANNEQUIN_SIDE - MANNEQUIN_ARM_ASIDE
};

/* The angle's number on a side, 0 left, 1 right. */
static inline uint32_t mannequin_on_side(uint32_t angle, uint32_t side)
{
    return angle + side * (MANNEQUIN_SIDE - MANNEQUIN_ARM_ASIDE);
}

/* The range of each angle; at rest the figure stands as it was made. */
struct mannequin_limit {
    const char *name; /* "elbow_bend" */
    double least, most, rest;
};
extern const struct mannequin_limit mannequin_limits[MANNEQUIN_SIDE];

struct mannequin_pose {
    double time; /* s */
    double angle[MANNEQUIN_ANGLES];
};

/* Fills the angles at a time from n > 0 poses of ascending times. Between two poses they go by 3
 * u^2 - 2 u^3, so that nothing jerks; before the first and after the last one they rest. */
void mannequin_pose_at(const struct mannequin_pose *pose, uint32_t n, double time,
                       double angle[MANNEQUIN_ANGLES]);

/* A walk on the spot. From the time `begin` on the figure goes over in MANNEQUIN_WALK_RAMP from
 * rest to walking, with its left leg first. 0: the default speed. */
#define MANNEQUIN_WALK_RAMP  1.5 /* s */
#define MANNEQUIN_WALK_SPEED 1.0
#define MANNEQUIN_MOST_SPEED 3.0
struct mannequin_walk {
    double speed; /* steps a second */
    double begin; /* s */
};
void mannequin_walk_at(const struct mannequin_walk *walk, double time,
                       double angle[MANNEQUIN_ANGLES]);

/* How a mesh hangs on the bones. */
enum { MANNEQUIN_BONES = 12 };
struct mannequin_rig {
    double joint[MANNEQUIN_BONES][3];  /* m: where each bone hangs on the one before */
    double (*weight)[MANNEQUIN_BONES]; /* of each vertex: its sum is 1 */
};

void mannequin_rig_free(struct mannequin_rig *rig);

/* Fills x, m, with the places of the vertices of the rig's mesh. */
void mannequin_place(const struct mannequin_rig *rig, const struct mesh *mesh,
                     const double angle[MANNEQUIN_ANGLES], double (*x)[3]);

#endif
