/* A sheet in waves touches nothing; one that is draped in folds is near itself at few places, one
 * in layers everywhere. */
#include "bench/contact/shapes.h"

#include <math.h>
#include <string.h>

static void place_waves(double u, double v, phys_vec *x)
{
    *x = (phys_vec){u, 0.02 * sin(50 * u) * cos(35 * v), v, 0};
}

/* Over a disc of 50 cm, in twelve folds beside it. */
static void place_draped(double u, double v, phys_vec *x)
{
    const double px = u - 0.5, pz = v - 0.5, s = sqrt(px * px + pz * pz), down = s - 0.25;
    const double turn = atan2(pz, px), r = 0.25 + down * (0.2 + 0.18 * sin(12 * turn));
    *x = (phys_vec){px, 0, pz, 0};
    if (down > 0)
        *x = (phys_vec){r * cos(turn), -0.97 * down, r * sin(turn), 0};
}

/* Folded five times, layers 1.5 mm from each other. */
static void place_six_layers(double u, double v, phys_vec *x)
{
    const double layer = floor(6 * u) < 6 ? floor(6 * u) : 5, along = u - layer / 6;
    const double at = fmod(layer, 2) < 1 ? along : 1 / 6.0 - along;
    *x = (phys_vec){at, 9e-3 * u + 5e-3 * sin(40 * v) * cos(60 * at), v, 0};
}

static const struct {
    const char *name;
    shapes_place *place;
} shapes[] = {
    {"waves", place_waves}, {"draped", place_draped}, {"six_layers", place_six_layers}, {0}};

shapes_place *shapes_find(const char *name)
{
    int shape = 0;
    while (shapes[shape].name && strcmp(shapes[shape].name, name))
        shape++;
    return shapes[shape].place;
}

void shapes_move(uint64_t *seed, const phys_vec *x, phys_vec *y)
{
    *y = *x + (phys_vec){0, -SHAPES_DOWN, 0, 0};
    for (int c = 0; c < 3; c++) {
        *seed = *seed * 6364136223846793005u + 1442695040888963407u;
        (*y)[c] += SHAPES_OWN * ((double)(*seed >> 11) * 0x1p-53 - 0.5);
    }
}
