/* Embree against our query: which triangles of a sheet come near each other, by boxes alone. Each
 * triangle is a primitive with the box of its way in a step, without what all do together, half the
 * reach larger; the tree is refitted in each step and met with itself (rtcCollide). */
#include "bench/contact/shapes.h"
#include "bench/serve.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

struct sheet {
    unsigned side;
    phys_vec *x, *y; /* vertices: where they are, where they come to without the common way */
    RTCDevice device;
    RTCScene scene;
    RTCGeometry geometry;
};

/* Pairs that a thread found, in a line of its own; threads take the next place at their first. */
enum { MOST_THREADS = 256 };
static struct {
    _Alignas(64) unsigned long pairs;
} found[MOST_THREADS];
static atomic_uint next_thread;

static unsigned long add_up(void)
{
    unsigned long sum = 0;
    for (int i = 0; i < MOST_THREADS; i++) {
        sum += found[i].pairs;
        found[i].pairs = 0;
    }
    return sum;
}

static uint32_t corner_of(unsigned side, unsigned triangle, int k)
{
    const unsigned cell = triangle / 2, i = cell % (side - 1), j = cell / (side - 1);
    const uint32_t a = j * side + i, b = a + 1, c = a + side, d = c + 1;
    const uint32_t corner[2][3] = {{a, c, d}, {a, d, b}};
    return corner[triangle % 2][k];
}

static unsigned count_triangles(unsigned side)
{
    return 2 * (side - 1) * (side - 1);
}

static void bound(const struct RTCBoundsFunctionArguments *of)
{
    const struct sheet *sheet = of->geometryUserPtr;
    const double more = SHAPES_REACH / 2;
    phys_vec low = {0}, high = {0};
    for (int k = 0; k < 3; k++) {
        const uint32_t v = corner_of(sheet->side, of->primID, k);
        const phys_vec at[2] = {sheet->x[v], sheet->y[v]};
        for (int end = 0; end < 2; end++)
            for (int c = 0; c < 3; c++) {
                const bool first = k == 0 && end == 0;
                low[c] = first || at[end][c] < low[c] ? at[end][c] : low[c];
                high[c] = first || at[end][c] > high[c] ? at[end][c] : high[c];
            }
    }
    *of->bounds_o = (struct RTCBounds){.lower_x = (float)(low[0] - more),
                                       .lower_y = (float)(low[1] - more),
                                       .lower_z = (float)(low[2] - more),
                                       .upper_x = (float)(high[0] + more),
                                       .upper_y = (float)(high[1] + more),
                                       .upper_z = (float)(high[2] + more)};
}

static void count(void *context, struct RTCCollision *collision, unsigned int n)
{
    static _Thread_local unsigned own = MOST_THREADS;
    (void)context, (void)collision;
    if (own == MOST_THREADS)
        own = atomic_fetch_add(&next_thread, 1) % MOST_THREADS;
    found[own].pairs += n;
}

static int make_places(struct sheet *sheet, shapes_place *place)
{
    const unsigned side = sheet->side;
    const size_t n = (size_t)side * side;
    uint64_t seed = 1;
    sheet->x = aligned_alloc(sizeof *sheet->x, 2 * n * sizeof *sheet->x);
    if (!sheet->x)
        return serve_no_memory();
    sheet->y = sheet->x + n;
    for (unsigned v = 0; v < n; v++) {
        place(v % side / (side - 1.0), v / side / (side - 1.0), sheet->x + v);
        shapes_move(&seed, sheet->x + v, sheet->y + v);
        sheet->y[v] += (phys_vec){0, SHAPES_DOWN, 0, 0};
    }
    return 0;
}

static int make_scene(struct sheet *sheet, unsigned threads)
{
    char config[40];
    snprintf(config, sizeof config, "threads=%u", threads);
    sheet->device = rtcNewDevice(config);
    if (!sheet->device)
        return serve_fail("Embree does not start: error %d", (int)rtcGetDeviceError(NULL));
    sheet->scene = rtcNewScene(sheet->device);
    sheet->geometry = rtcNewGeometry(sheet->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetSceneFlags(sheet->scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(sheet->scene, RTC_BUILD_QUALITY_LOW); /* others build the tree again */
    rtcSetGeometryBuildQuality(sheet->geometry, RTC_BUILD_QUALITY_REFIT);
    rtcSetGeometryUserPrimitiveCount(sheet->geometry, count_triangles(sheet->side));
    rtcSetGeometryUserData(sheet->geometry, sheet);
    rtcSetGeometryBoundsFunction(sheet->geometry, bound, NULL);
    rtcCommitGeometry(sheet->geometry);
    rtcAttachGeometry(sheet->scene, sheet->geometry);
    rtcCommitScene(sheet->scene);
    const enum RTCError error = rtcGetDeviceError(sheet->device);
    return error == RTC_ERROR_NONE ? 0 : serve_fail("Embree fails with error %d", (int)error);
}

static void free_sheet(struct sheet *sheet)
{
    if (sheet->device) {
        rtcReleaseGeometry(sheet->geometry);
        rtcReleaseScene(sheet->scene);
        rtcReleaseDevice(sheet->device);
    }
    free(sheet->x);
}

static void step(struct sheet *sheet)
{
    rtcCommitGeometry(sheet->geometry);
    rtcCommitScene(sheet->scene);
    rtcCollide(sheet->scene, sheet->scene, count, sheet);
}

/* Seconds a vertex of the best step. Each triangle meets itself, so there are as many at least. */
static int detect(void *context, struct serve_request *request, double *value)
{
    const bool quick = serve_number(request, "quick") != 0;
    const uint64_t rounds = serve_number(request, "rounds");
    struct sheet sheet = {.side = quick ? SHAPES_QUICK_SIDE : SHAPES_SIDE};
    unsigned long pairs = 0;
    char name[40];
    (void)context;
    serve_word(request, "shape", name, sizeof name);
    shapes_place *place = shapes_find(name);
    int code = place ? make_places(&sheet, place) : serve_fail("no shape '%s'", name);
    if (!code)
        code = make_scene(&sheet, (unsigned)serve_number(request, "threads"));
    *value = INFINITY;
    for (uint64_t i = 0; i <= rounds && !code; i++) {
        const double begin = serve_seconds();
        step(&sheet);
        const double seconds = (serve_seconds() - begin) / ((double)sheet.side * sheet.side);
        *value = i && seconds < *value ? seconds : *value;
        const unsigned long now = add_up();
        if (now < count_triangles(sheet.side) || (i && now != pairs))
            code = serve_fail("wrong answer: %lu pairs of boxes, %lu before", now, pairs);
        pairs = now;
    }
    free_sheet(&sheet);
    return code;
}

int main(void)
{
    static const struct serve_run runs[] = {{"detect", detect}, {0}};
    const struct serve_run *const all[] = {runs, NULL};
    return serve("Embree " RTC_VERSION_STRING
                 ", boxes of triangles as user geometry, refitted, rtcCollide",
                 all, NULL);
}
