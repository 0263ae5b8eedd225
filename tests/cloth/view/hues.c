/* hues PICTURE.png [X Y WIDTH HEIGHT]: which colours of scales and of parts a picture, or a
 * rectangle of it, has, however light or dark they are. Prints the percentage of pixels that have
 * each colour of parts, those of its grey left out, then how many have one of the scale, and the
 * lowest, middle and highest place on it, 0 .. 1. */
#include "cloth/view/colour.h"

#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>

enum { PLACES = 201, COLOURED = VIEW_HUES - 1 };
static const double NEAR = 0.03; /* of colours of length 1, linear */

static void direction(const double c[3], double to[3])
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        to[k] = c[k] <= 0.04045 ? c[k] / 12.92 : pow((c[k] + 0.055) / 1.055, 2.4);
        square += to[k] * to[k];
    }
    for (int k = 0; k < 3; k++)
        to[k] /= square > 0 ? sqrt(square) : 1;
}

static double distance(const double a[3], const float colour[3])
{
    const double c[3] = {(double)colour[0], (double)colour[1], (double)colour[2]};
    double b[3], square = 0;
    direction(c, b);
    for (int k = 0; k < 3; k++)
        square += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(square);
}

struct found {
    size_t part[COLOURED], place[PLACES], n_places;
};

static void look(const unsigned char *rgb, struct found *found)
{
    const double c[3] = {rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0};
    double to[3], nearest = NEAR;
    int best = -1;
    direction(c, to);
    for (int p = 0; p < COLOURED; p++)
        found->part[p] += distance(to, view_hue[p]) < NEAR;
    for (int i = 0; i < PLACES; i++) {
        float colour[3];
        view_map_at(i / (PLACES - 1.0), colour);
        if (distance(to, colour) < nearest) {
            nearest = distance(to, colour);
            best = i;
        }
    }
    if (best < 0)
        return;
    found->place[best]++;
    found->n_places++;
}

/* Where so many of the places are passed. */
static double place_at(const struct found *found, size_t n)
{
    size_t sum = 0;
    for (int i = 0; i < PLACES; i++) {
        sum += found->place[i];
        if (sum > n)
            return i / (PLACES - 1.0);
    }
    return 1;
}

int main(int argc, char **argv)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    struct found found = {0};
    if (argc < 2 || !png_image_begin_read_from_file(&image, argv[1]))
        return fprintf(stderr, "hues: cannot read a picture\n"), 2;
    image.format = PNG_FORMAT_RGB;
    unsigned char *pixels = malloc(PNG_IMAGE_SIZE(image));
    if (!pixels || !png_image_finish_read(&image, NULL, pixels, 0, NULL))
        return fprintf(stderr, "hues: cannot read %s\n", argv[1]), 2;
    const size_t x0 = argc > 5 ? (size_t)atoi(argv[2]) : 0,
                 y0 = argc > 5 ? (size_t)atoi(argv[3]) : 0;
    const size_t width = argc > 5 ? (size_t)atoi(argv[4]) : image.width;
    const size_t height = argc > 5 ? (size_t)atoi(argv[5]) : image.height;
    for (size_t y = y0; y < y0 + height && y < image.height; y++)
        for (size_t x = x0; x < x0 + width && x < image.width; x++)
            look(pixels + 3 * (y * image.width + x), &found);
    const double n = (double)(width * height);
    for (int p = 0; p < COLOURED; p++)
        printf("%.2f ", 100 * (double)found.part[p] / n);
    printf("%.2f %g %g %g\n", 100 * (double)found.n_places / n, place_at(&found, 0),
           place_at(&found, found.n_places / 2),
           place_at(&found, found.n_places ? found.n_places - 1 : 0));
    free(pixels);
    return 0;
}
