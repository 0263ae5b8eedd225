/* Triangles that lie on a ball and on a box, each a batch of which is in the first cache. */
#include "bench/contact/contact.h"
#include "bench/contact/shapes.h"

#include "cloth/base/simd.h"
#include "cloth/contact/solid.h"

enum { BATCH = 64 };
static const double EDGE = 0.005, GAP = 0.001, WAY = 0.0002, THICKNESS = 0.001; /* m */
static const double REACH = 0.0013;

struct ends {
    phys_vec x[3], y[3];
};

static void draw_vector(uint64_t *seed, double reach, phys_vec *x)
{
    *x = (phys_vec){contact_draw(seed, reach), contact_draw(seed, reach), contact_draw(seed, reach),
                    0};
}

/* A triangle of about an edge, one to three gaps from the shape. */
static void draw_ends(const struct contact_solid *solid, uint64_t *seed, struct ends *ends)
{
    struct contact_solid_point point;
    phys_vec middle, own;
    draw_vector(seed, 1, &middle);
    for (int k = 0; k < 3; k++) {
        draw_vector(seed, EDGE, &own);
        ends->x[k] = middle + own;
    }
    contact_solid_nearest(solid, CONTACT_BEGIN, ends->x, &point);
    const double gap = 2 * GAP + contact_draw(seed, GAP);
    for (int k = 0; k < 3; k++) {
        draw_vector(seed, WAY, &own);
        ends->x[k] += (gap - point.gap) * point.normal;
        ends->y[k] = ends->x[k] + own;
    }
}

static size_t count_passing(const struct contact_solid *solid, const struct ends ends[BATCH])
{
    size_t n = 0;
    for (int i = 0; i < BATCH; i++)
        n += contact_solid_pass(solid, ends[i].x, ends[i].y, THICKNESS, REACH) != CONTACT_MAY_TOUCH;
    return n;
}

static void make_solid(bool box, struct contact_solid *solid)
{
    const struct contact_pose still = {0};
    struct contact_shape shape = {.value = {0, 0, 0, 0.5, 0.4, 0.6, 1}};
    while (contact_kinds[shape.kind] != (box ? &contact_box : &contact_sphere))
        shape.kind++;
    contact_solid_make(&shape, &still, solid);
}

/* Seconds a triangle. As many must pass without wide instructions. */
static int run(struct serve_request *request, bool box, double *seconds)
{
    const uint64_t triangles = serve_number(request, "triangles");
    const enum cloth_simd wide = cloth_simd;
    struct contact_solid solid;
    struct ends ends[BATCH];
    uint64_t seed = 1, done = 0;
    size_t n = 0, n_narrow = 0;
    make_solid(box, &solid);
    *seconds = 0;
    for (; done < triangles; done += BATCH) {
        for (int i = 0; i < BATCH; i++)
            draw_ends(&solid, &seed, ends + i);
        const double begin = serve_seconds();
        n += count_passing(&solid, ends);
        *seconds += serve_seconds() - begin;
        cloth_simd = CLOTH_SIMD_NONE;
        n_narrow += count_passing(&solid, ends);
        cloth_simd = wide;
    }
    *seconds /= (double)done;
    return n == n_narrow && n > done / 2
               ? 0
               : serve_fail("wrong answer: not those of kernels without wide instructions");
}

static int sphere_time(void *context, struct serve_request *request, double *value)
{
    (void)context;
    return run(request, false, value);
}

static int box_time(void *context, struct serve_request *request, double *value)
{
    (void)context;
    return run(request, true, value);
}

const struct serve_run contact_solid_runs[] = {{"sphere", sphere_time}, {"box", box_time}, {0}};
