/* A plane is seen as a square around the foot of the cloth's centre. Its square of known light of
 * the sky lies around the same foot. */
#include "cloth/view/draw/draw.h"

#include <math.h>

static void set_vector(GLuint program, const char *name, const double v[3], double scale)
{
    glUniform3f(glGetUniformLocation(program, name), (float)(v[0] * scale), (float)(v[1] * scale),
                (float)(v[2] * scale));
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Directions u and v on a plane, square to each other and to its normal n; all of length 1. */
static void span(const double n[3], double u[3], double v[3])
{
    double other[3] = {fabs(n[0]) < 0.7, 0, fabs(n[0]) >= 0.7}, along = dot(other, n);
    for (int k = 0; k < 3; k++)
        u[k] = other[k] - along * n[k];
    double length = sqrt(dot(u, u));
    for (int k = 0; k < 3; k++)
        u[k] /= length;
    for (int k = 0; k < 3; k++)
        v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
}

void draw_ground_place(struct draw_ground *ground, const double plane[6], const float center[3],
                       float radius)
{
    const double length = sqrt(dot(plane + 3, plane + 3));
    for (int k = 0; k < 3; k++) {
        ground->n[k] = plane[3 + k] / length;
        ground->foot[k] = (double)center[k];
    }
    ground->height = dot(ground->n, ground->foot) - dot(ground->n, plane);
    for (int k = 0; k < 3; k++)
        ground->foot[k] -= ground->height * ground->n[k];
    span(ground->n, ground->u, ground->v);
    ground->radius = (double)radius;
    ground->lit = 4 * (double)radius;
}

void draw_ground_square(const struct draw_ground *ground, GLuint program, double half)
{
    set_vector(program, "centre", ground->foot, 1);
    set_vector(program, "u", ground->u, half);
    set_vector(program, "v", ground->v, half);
    set_vector(program, "n", ground->n, 1);
}

/* The sky's directions are about sqrt(2 pi / n) radians apart, those of the sun's disk its radius
 * times sqrt(pi / n). So on the ground the shadows of a point are that fraction of its height
 * apart. Blurred by 0.7 of this distance they melt into one. */
static double melting(const struct draw_ground *ground, double apart)
{
    return 0.7 * apart * fabs(ground->height);
}

float draw_ground_sky_blur(const struct draw_ground *ground)
{
    const double blur = melting(ground, sqrt(2 * acos(-1.0) / DRAW_SKY));
    return (float)fmax(1.0 / DRAW_SKY_SQUARE, 0.5 * blur / ground->lit);
}

/* In units of the lights' own blur. */
static double sun_blur(const struct draw_ground *ground, const struct draw_lights *lights)
{
    const double unit = (double)lights->block.bias[1] * 2 * ground->radius;
    return fmax(1, melting(ground, DRAW_SUN_RADIUS * sqrt(acos(-1.0) / DRAW_SUN)) / unit);
}

void draw_ground(const struct draw_ground *ground, GLuint program, const struct draw_lights *lights,
                 const float eye[3], float reach)
{
    double away[3];
    for (int k = 0; k < 3; k++)
        away[k] = (double)eye[k] - ground->foot[k];
    if (dot(ground->n, away) <= 0)
        return; /* seen from behind it would hide everything */
    const double end = (ground->n[1] > 0.95 ? 7 : 1.5) * (double)reach;
    draw_ground_square(ground, program, end);
    set_vector(program, "u_map", ground->u, 1 / ground->lit);
    set_vector(program, "v_map", ground->v, 1 / ground->lit);
    glUniform1f(glGetUniformLocation(program, "blur"), (float)sun_blur(ground, lights));
    glUniform2f(glGetUniformLocation(program, "fade"), (float)(0.15 * end), (float)end);
    draw_sky_bind(&ground->sky);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}
