/* A plane is seen as a square around the foot of the cloth's centre. Its light is known in two
 * squares of it: that of the sky around the same foot, that of the sun where its shadow falls. */
#include "cloth/view/draw/draw.h"

#include "cloth/base/vector.h"

#include <math.h>

static void ground_set_vector(GLuint program, const char *name, const double v[3], double scale)
{
    glUniform3f(glGetUniformLocation(program, name), (float)(v[0] * scale), (float)(v[1] * scale),
                (float)(v[2] * scale));
}

/* Directions u and v on a plane, square to each other and to its normal n; all of length 1. */
static void span(const double n[3], double u[3], double v[3])
{
    double other[3] = {fabs(n[0]) < 0.7, 0, fabs(n[0]) >= 0.7}, along = cloth_dot(other, n);
    for (int k = 0; k < 3; k++)
        u[k] = other[k] - along * n[k];
    double length = sqrt(cloth_dot(u, u));
    for (int k = 0; k < 3; k++)
        u[k] /= length;
    for (int k = 0; k < 3; k++)
        v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
}

const int DRAW_SQUARE_SIZE[DRAW_SQUARES] = {96, 256};

int draw_ground_make(struct draw_ground *ground, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (int i = 0; i < DRAW_SQUARES && !code; i++)
        code = draw_sky_make_square(&ground->square[i].light, DRAW_SQUARE_SIZE[i], error);
    return code;
}

/* The sky's directions are about sqrt(2 pi / n) radians apart, those of the sun's disk its radius
 * times sqrt(pi / n). So on the ground the shadows of a point are that fraction of its height
 * apart. Blurred by 0.7 of this distance they melt into one. Less than a texel is a stair. */
static void set_blur(struct draw_square *square, int size, double apart, double height)
{
    square->blur = (float)fmax(1.0 / size, 0.5 * 0.7 * apart * fabs(height) / square->half);
}

static void place_sky(struct draw_ground *ground, double height, double radius)
{
    struct draw_square *square = ground->square + DRAW_BY_SKY;
    square->half = 4 * radius;
    for (int k = 0; k < 3; k++)
        square->centre[k] = ground->foot[k];
    set_blur(square, DRAW_SQUARE_SIZE[DRAW_BY_SKY], sqrt(2 * acos(-1.0) / DRAW_SKY), height);
}

/* The shadow of the lights' sphere: an ellipse, which the sun's disk makes wider. */
static void place_sun(struct draw_ground *ground, double height, const struct draw_lights *lights)
{
    struct draw_square *square = ground->square + DRAW_BY_SUN;
    double toward[3];
    for (int k = 0; k < 3; k++)
        toward[k] = (double)lights->block.toward[k];
    const double steep = fmax(cloth_dot(ground->n, toward), 0.2), way = height / steep;
    for (int k = 0; k < 3; k++)
        square->centre[k] = ground->foot[k] - way * (toward[k] - steep * ground->n[k]);
    square->half = ((double)lights->radius + DRAW_SUN_RADIUS * fabs(way)) / steep;
    set_blur(square, DRAW_SQUARE_SIZE[DRAW_BY_SUN], DRAW_SUN_RADIUS * sqrt(acos(-1.0) / DRAW_SUN),
             height);
}

void draw_ground_place(struct draw_ground *ground, const double plane[6], const float center[3],
                       float radius, const struct draw_lights *lights)
{
    const double length = sqrt(cloth_dot(plane + 3, plane + 3));
    for (int k = 0; k < 3; k++) {
        ground->n[k] = plane[3 + k] / length;
        ground->foot[k] = (double)center[k];
    }
    const double height = cloth_dot(ground->n, ground->foot) - cloth_dot(ground->n, plane);
    for (int k = 0; k < 3; k++)
        ground->foot[k] -= height * ground->n[k];
    span(ground->n, ground->u, ground->v);
    place_sky(ground, height, (double)radius);
    place_sun(ground, height, lights);
}

void draw_ground_square(const struct draw_ground *ground, GLuint program, const double centre[3],
                        double half)
{
    ground_set_vector(program, "centre", centre, 1);
    ground_set_vector(program, "u", ground->u, half);
    ground_set_vector(program, "v", ground->v, half);
    ground_set_vector(program, "n", ground->n, 1);
}

void draw_ground(const struct draw_ground *ground, GLuint program, const float eye[3], float reach)
{
    static const char *const names[DRAW_SQUARES] = {"sky_square", "sun_square"};
    double away[3];
    for (int k = 0; k < 3; k++)
        away[k] = (double)eye[k] - ground->foot[k];
    if (cloth_dot(ground->n, away) <= 0)
        return; /* seen from behind it would hide everything */
    const double end = (ground->n[1] > 0.95 ? 7 : 1.5) * (double)reach;
    draw_ground_square(ground, program, ground->foot, end);
    for (int i = 0; i < DRAW_SQUARES; i++) {
        const struct draw_square *square = ground->square + i;
        const double scale = 0.5 / square->half;
        const float to[4] = {(float)(0.5 - scale * cloth_dot(square->centre, ground->u)),
                             (float)(0.5 - scale * cloth_dot(square->centre, ground->v)),
                             (float)scale};
        glUniform3fv(glGetUniformLocation(program, names[i]), 1, to);
        glActiveTexture(GL_TEXTURE0 + (i ? DRAW_UNIT_BACK : DRAW_UNIT_FRONT));
        glBindTexture(GL_TEXTURE_2D, square->light.light[0]);
    }
    glActiveTexture(GL_TEXTURE0);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void draw_ground_free(struct draw_ground *ground)
{
    for (int i = 0; i < DRAW_SQUARES; i++)
        draw_sky_free(&ground->square[i].light);
}
