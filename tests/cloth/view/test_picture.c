/* A small sheet over a floor is drawn, and what is in the picture is compared with what the camera
 * says. */
#include "cloth/view/view.h"
#include "tests/support/unit.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { N = 12, WIDTH = 320, HEIGHT = 200 };
static const struct contact_shape PLANE = {.value = {0, -0.3, 0, 0, 1, 0}};

static struct view_context *context;
static struct view_scene *scene;
static struct view_obstacles obstacles;
static struct view_camera camera;
static struct view_picture picture;
static double position[3 * N * N];
static uint32_t triangle[6 * (N - 1) * (N - 1)];

/* A sheet of 1 m, a little wavy, its front up. */
static void make_sheet(void)
{
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            double *p = position + 3 * (j * N + i);
            p[0] = i / (N - 1.0) - 0.5;
            p[1] = 0.05 * sin(7 * p[0]);
            p[2] = j / (N - 1.0) - 0.5;
        }
    uint32_t *t = triangle;
    for (uint32_t j = 0; j + 1 < N; j++)
        for (uint32_t i = 0; i + 1 < N; i++) {
            uint32_t v = j * N + i, corner[6] = {v, v + N, v + N + 1, v, v + N + 1, v + 1};
            memcpy(t, corner, sizeof corner);
            t += 6;
        }
}

static void draw_beside(double elevation, size_t n, const struct contact_shape *beside)
{
    UNIT_FINE(view_obstacles_make(&obstacles, n, beside, NULL, NULL, &error));
    struct view_shape shape = {.n_vertices = N * N,
                               .n_triangles = 2 * (N - 1) * (N - 1),
                               .triangle = triangle,
                               .obstacles = &obstacles};
    struct view_fit fit;
    view_fit_start(&fit, 30, elevation, (double)WIDTH / HEIGHT, 1);
    view_fit_add(&fit, N * N, position);
    view_fit_planes(&fit, obstacles.n_planes, (const double(*)[6])obstacles.plane);
    view_fit_camera(&fit, &camera);
    UNIT_FINE(view_scene_new(&scene, &shape, &error));
    UNIT_FINE(view_scene_move(scene, position, &error));
    picture = (struct view_picture){WIDTH, HEIGHT, NULL};
    UNIT_FINE(view_picture_draw(&picture, scene, &camera, &error));
}

static void draw(double elevation, size_t n_planes)
{
    draw_beside(elevation, n_planes, &PLANE);
}

static void start(void)
{
    UNIT_FINE(view_context_open(&context, &error));
    make_sheet();
}

static void end(void)
{
    view_picture_free(&picture);
    view_scene_free(scene);
    view_obstacles_free(&obstacles);
    view_context_close(context);
}

/* Pixels from the left and the top. */
static void pixel_of(const double *p, double at[2])
{
    double clip[4];
    for (int i = 0; i < 4; i++) {
        clip[i] = (double)camera.clip[3][i];
        for (int k = 0; k < 3; k++)
            clip[i] += (double)camera.clip[k][i] * p[k];
    }
    at[0] = (0.5 + 0.5 * clip[0] / clip[3]) * WIDTH;
    at[1] = (0.5 - 0.5 * clip[1] / clip[3]) * HEIGHT;
}

static const unsigned char *pixel(int x, int y)
{
    return picture.rgb + 3 * (y * WIDTH + x);
}

/* The cloth is red, all else is nearly grey. */
static int is_cloth(int x, int y)
{
    const unsigned char *p = pixel(x, y);
    return p[0] > 1.4 * p[1];
}

static int brightness(int x, int y)
{
    const unsigned char *p = pixel(x, y);
    return p[0] + p[1] + p[2];
}

UNIT_FIXTURE(start, end)

UNIT_LOOP(cloth_is_where_the_camera_says, 0, 2)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, at[2];
    int left = WIDTH, right = -1, top = HEIGHT, bottom = -1, n = 0;
    draw(_i ? -35 : 35, 1); /* its front, its back */
    for (int v = 0; v < N * N; v++) {
        pixel_of(position + 3 * v, at);
        for (int i = 0; i < 2; i++) {
            low[i] = fmin(low[i], at[i]);
            high[i] = fmax(high[i], at[i]);
        }
    }
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            if (is_cloth(x, y)) {
                left = x < left ? x : left;
                right = x > right ? x : right;
                top = y < top ? y : top;
                bottom = y > bottom ? y : bottom;
                n++;
            }
    ck_assert_int_gt(n, 3000);
    ck_assert_double_eq_tol(left, low[0], 2.5);
    ck_assert_double_eq_tol(right + 1, high[0], 2.5);
    ck_assert_double_eq_tol(top, low[1], 2.5);
    ck_assert_double_eq_tol(bottom + 1, high[1], 2.5);
}

UNIT_TEST(throws_a_shadow)
{
    static const double shaded[3] = {0.28, -0.3, -0.05}, lit[3] = {-0.9, -0.3, 0.2};
    double at[2][2];
    draw(8, 1);
    pixel_of(shaded, at[0]);
    pixel_of(lit, at[1]);
    for (int i = 0; i < 2; i++)
        ck_assert(!is_cloth((int)at[i][0], (int)at[i][1]));
    int dark = brightness((int)at[0][0], (int)at[0][1]);
    int light = brightness((int)at[1][0], (int)at[1][1]);
    ck_assert_msg(dark < 0.75 * light, "%d in the shadow, %d beside it", dark, light);
}

static int near_cloth(int x, int y)
{
    int found = 0;
    for (int j = -2; j < 3; j++)
        for (int i = -2; i < 3; i++)
            found |= is_cloth(x + i, y + j);
    return found;
}

/* Neither grain nor edges of single lights: on the ground a pixel is the mean of its neighbours,
 * but for rounding, noise of half a step against bands, and the bend of the shadow's border. */
UNIT_TEST(shadows_are_smooth)
{
    double sum = 0;
    int n = 0;
    draw(30, 1);
    for (int y = HEIGHT / 2; y < HEIGHT - 2; y++)
        for (int x = 2; x < WIDTH - 2; x++) {
            if (near_cloth(x, y))
                continue;
            const int around = brightness(x - 1, y) + brightness(x + 1, y) + brightness(x, y - 1) +
                               brightness(x, y + 1);
            const double off = (brightness(x, y) - around / 4.0) / 3;
            sum += off * off;
            n++;
        }
    const double grain = sqrt(sum / n);
    printf("# grain of the ground: %.2f of 255 on %d pixels\n", grain, n);
    ck_assert_int_gt(n, 5000);
    ck_assert_double_lt(grain, 0.8);
}

static void forget_picture(void)
{
    view_picture_free(&picture);
    view_scene_free(scene);
    view_obstacles_free(&obstacles);
    scene = NULL;
}

/* Sides that are seen from inside are not drawn. */
UNIT_TEST(a_box_around_the_eye)
{
    struct contact_shape box = {.kind = 2, .value = {0, 0, 0, 1, 1, 1, 1, 0, 0, 0}};
    double at[2];
    draw(30, 0);
    for (int k = 0; k < 3; k++)
        box.value[k] = (double)camera.eye[k];
    forget_picture();
    draw_beside(30, 1, &box);
    pixel_of(position + 3 * (N * N / 2 + N / 2), at);
    ck_assert(is_cloth((int)at[0], (int)at[1]));
}

UNIT_TEST(front_and_back_differ)
{
    unsigned char seen[2][3];
    double at[2];
    for (int i = 0; i < 2; i++) {
        draw(i ? -40 : 40, 0);
        pixel_of(position + 3 * (N * N / 2 + N / 2), at);
        memcpy(seen[i], pixel((int)at[0], (int)at[1]), 3);
        forget_picture();
    }
    double hue[2] = {(double)seen[0][1] / seen[0][0], (double)seen[1][1] / seen[1][0]};
    ck_assert_msg(hue[1] > hue[0] + 0.1, "green to red is %g, %g", hue[0], hue[1]);
}

/* All of the shape, seen along z. */
static void draw_shape(const struct view_shape *shape, const double *place)
{
    struct view_fit fit;
    view_fit_start(&fit, 0, 0, (double)WIDTH / HEIGHT, 1);
    view_fit_add(&fit, shape->n_vertices, place);
    view_fit_camera(&fit, &camera);
    UNIT_FINE(view_scene_new(&scene, shape, &error));
    UNIT_FINE(view_scene_move(scene, place, &error));
    picture = (struct view_picture){WIDTH, HEIGHT, NULL};
    UNIT_FINE(view_picture_draw(&picture, scene, &camera, &error));
}

/* A chain of two edges without triangles. */
UNIT_TEST(draws_lines)
{
    static const uint32_t line[4] = {0, 1, 1, 2};
    static const double place[9] = {0, 0, 0, 0.5, 0.2, 0, 1, 0, 0};
    struct view_shape shape = {.n_vertices = 3, .n_lines = 2, .line = line};
    draw_shape(&shape, place);
    int n = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        n += is_cloth(i % WIDTH, i / WIDTH);
    ck_assert_int_gt(n, 150);
    ck_assert_int_lt(n, 2000);
}

/* Two triangles beside each other, each a cloth. */
UNIT_TEST(cloths_differ_in_colour)
{
    static const uint32_t apart[6] = {0, 1, 2, 3, 4, 5}, end[2] = {3, 6};
    static const double place[18] = {0,   0, 0, 0.4, 0, 0, 0.2, 0.4, 0,
                                     0.6, 0, 0, 1,   0, 0, 0.8, 0.4, 0};
    struct view_shape shape = {
        .n_vertices = 6, .n_triangles = 2, .triangle = apart, .n_cloths = 2, .cloth_end = end};
    draw_shape(&shape, place);
    int red = 0, blue = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const unsigned char *pixel = picture.rgb + (size_t)3 * (size_t)i;
        red += i % WIDTH < WIDTH / 2 && pixel[0] > 2 * pixel[2];
        blue += i % WIDTH > WIDTH / 2 && 2 * pixel[2] > 3 * pixel[0];
    }
    ck_assert_int_gt(red, 500);
    ck_assert_int_gt(blue, 500);
}

UNIT_TEST(png_holds_the_picture)
{
    char path[] = "/tmp/duite-view.XXXXXX";
    close(mkstemp(path));
    draw(20, 1);
    UNIT_FINE(view_picture_write(&picture, path, &error));
    png_image image = {.version = PNG_IMAGE_VERSION};
    ck_assert_int_ne(png_image_begin_read_from_file(&image, path), 0);
    ck_assert(image.width == WIDTH && image.height == HEIGHT);
    image.format = PNG_FORMAT_RGB;
    unsigned char *back = malloc(PNG_IMAGE_SIZE(image));
    ck_assert_int_ne(png_image_finish_read(&image, NULL, back, 0, NULL), 0);
    ck_assert_mem_eq(back, picture.rgb, PNG_IMAGE_SIZE(image));
    free(back);
    unlink(path);
}

UNIT_TEST(refuses_what_it_cannot_write)
{
    struct cloth_error error = {0};
    draw(20, 1);
    UNIT_REFUSED(view_picture_write(&picture, "/tmp", &error), CLOTH_E_INPUT, "Is a directory");
    error.code = 0;
    UNIT_REFUSED(view_picture_write(&picture, "/dev/full", &error), CLOTH_E_IO, "No space left");
    struct view_picture huge = {1 << 20, 1, NULL};
    ck_assert_int_eq(view_picture_draw(&huge, scene, &camera, &error), CLOTH_E_INPUT);
    ck_assert_ptr_null(huge.rgb);
}

/* In a process of its own, so that the tests' processes start without a driver's threads. */
static int has_egl(void)
{
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        struct cloth_error error = {0};
        int code = view_context_open(&context, &error);
        if (code)
            printf("1..0 # SKIP %s\n", error.text);
        view_context_close(context);
        fflush(stdout);
        _exit(code != 0);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int main(void)
{
    return has_egl() ? unit_main() : 77;
}
