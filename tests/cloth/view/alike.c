/* alike PICTURE.png SCREEN.xwd [X Y]: how far a picture is from what a screen shows at its corner
 * X, Y (0 0). Prints the mean difference of colours, of 255, and the share of pixels (percent) that
 * differ by more than 16 in some colour. The screen is one of Xvfb -fbdir: 32 bits a pixel, blue
 * first. */
#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { HEADER = 25 }; /* numbers of an XWD header, big-endian */

struct screen {
    uint32_t width, height, row; /* row: bytes */
    unsigned char *pixels;
};

static int read_screen(const char *path, struct screen *screen)
{
    FILE *file = fopen(path, "rb");
    unsigned char bytes[4 * HEADER];
    uint32_t n[HEADER];
    if (!file)
        return 1;
    if (fread(bytes, sizeof bytes, 1, file) != 1) {
        fclose(file);
        return 1;
    }
    for (int i = 0; i < HEADER; i++)
        n[i] = (uint32_t)bytes[4 * i] << 24 | (uint32_t)bytes[4 * i + 1] << 16 |
               (uint32_t)bytes[4 * i + 2] << 8 | bytes[4 * i + 3];
    *screen = (struct screen){.width = n[4], .height = n[5], .row = n[12]};
    screen->pixels = malloc((size_t)screen->row * screen->height);
    const int code = !screen->pixels || n[11] != 32 ||
                     fseek(file, (long)n[0] + 12L * (long)n[19], SEEK_SET) != 0 ||
                     fread(screen->pixels, screen->row, screen->height, file) != screen->height;
    fclose(file);
    return code;
}

static int read_picture(const char *path, png_image *image, unsigned char **pixels)
{
    *image = (png_image){.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(image, path))
        return 1;
    image->format = PNG_FORMAT_BGRA;
    *pixels = malloc(PNG_IMAGE_SIZE(*image));
    return !*pixels || !png_image_finish_read(image, NULL, *pixels, 0, NULL);
}

static int compare(const png_image *image, const unsigned char *pixels, const struct screen *screen,
                   uint32_t x0, uint32_t y0)
{
    if (x0 + image->width > screen->width || y0 + image->height > screen->height)
        return fprintf(stderr, "alike: the screen is smaller than the picture\n"), 2;
    double sum = 0, far = 0;
    for (uint32_t y = 0; y < image->height; y++)
        for (uint32_t x = 0; x < image->width; x++) {
            const unsigned char *a = pixels + 4 * ((size_t)y * image->width + x);
            const unsigned char *b =
                screen->pixels + (size_t)screen->row * (y + y0) + 4 * (size_t)(x + x0);
            int most = 0;
            for (int k = 0; k < 3; k++) {
                sum += abs(a[k] - b[k]);
                most = abs(a[k] - b[k]) > most ? abs(a[k] - b[k]) : most;
            }
            far += most > 16;
        }
    const double n = (double)image->width * image->height;
    printf("%g %g\n", sum / (3 * n), 100 * far / n);
    return 0;
}

int main(int argc, char **argv)
{
    struct screen screen = {0};
    png_image image;
    unsigned char *pixels = NULL;
    int code = 2;
    if (argc < 3 || read_picture(argv[1], &image, &pixels) || read_screen(argv[2], &screen))
        fprintf(stderr, "alike: cannot read %s\n", argc < 3 ? "nothing" : argv[1]);
    else
        code = compare(&image, pixels, &screen, argc > 4 ? (uint32_t)atoi(argv[3]) : 0,
                       argc > 4 ? (uint32_t)atoi(argv[4]) : 0);
    free(pixels);
    free(screen.pixels);
    return code;
}
