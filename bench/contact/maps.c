/* Maps of a ring of 27,784 triangles, 1 m across, as seen along its axis: 1024 x 1024 pixels, of
 * which the ring has a quarter. Threads take strips, one after the other. */
#include "bench/contact/contact.h"

#include "cloth/contact/image.h"
#include "cloth/mesh/mesh.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum {
    AROUND = 302,
    ACROSS = 46,
    QUICK = 8, /* parts of these, and of the resolution, that a quick run has */
    RESOLUTION = 1024,
    SIDE = 187 /* vertices of the sheet that is looked up, along an edge */
};
static const double RADIUS = 0.45, TUBE = 0.05; /* m */

struct ring {
    struct contact_bodies bodies;
    struct contact_image image;
    void *strip[CONTACT_STRIPS];
    atomic_uint next;
};

/* ---- The ring ---- */

static int make_mesh(uint32_t around, uint32_t across, struct mesh *mesh)
{
    const double turn = 2 * acos(-1);
    const size_t n = (size_t)around * across;
    double(*x)[3] = calloc(n, sizeof *x);
    uint32_t(*triangle)[3] = calloc(2 * n, sizeof *triangle);
    struct cloth_error error = {0};
    for (uint32_t i = 0; x && triangle && i < around; i++)
        for (uint32_t j = 0; j < across; j++) {
            const double u = turn * i / around, v = turn * j / across;
            const uint32_t k = (i + 1) % around, l = (j + 1) % across, a = i * across + j;
            const double far = RADIUS + TUBE * cos(v);
            x[a][0] = far * cos(u);
            x[a][1] = far * sin(u);
            x[a][2] = TUBE * sin(v);
            const uint32_t pair[2][3] = {{a, k * across + j, k * across + l},
                                         {a, k * across + l, i * across + l}};
            memcpy(triangle + 2 * (size_t)a, pair, sizeof pair);
        }
    const int code = x && triangle ? mesh_inline(mesh, (uint32_t)n, *x, 0, NULL, 2 * (uint32_t)n,
                                                 *triangle, &error)
                                   : CLOTH_E_MEMORY;
    free(x);
    free(triangle);
    return code ? serve_no_memory() : 0;
}

static void free_ring(struct ring *ring)
{
    for (int i = 0; i < CONTACT_STRIPS; i++)
        free(ring->strip[i]);
    free(ring->bodies.memory);
}

static int make_ring(struct ring *ring, uint32_t part)
{
    struct mesh mesh = {0};
    struct cloth_error error = {0};
    bool turned;
    int code = make_mesh(AROUND / part, ACROSS / part, &mesh);
    if (!code && contact_bodies_add(&ring->bodies, &mesh, &turned, &error))
        code = serve_fail("%s", error.text);
    mesh_free(&mesh);
    if (code)
        return code;
    struct contact_image *image = &ring->image;
    image->body = contact_bodies_at(&ring->bodies, 1);
    contact_view_make(image->body, CONTACT_THINNEST, RESOLUTION / part, &image->view);
    contact_view_cut(&image->view, CONTACT_STRIPS);
    for (uint32_t i = 0; i < contact_view_strips(&image->view) && !code; i++) {
        const size_t bytes = contact_strip_bytes(image->body, &image->view, i);
        ring->strip[i] = aligned_alloc(CONTACT_ALIGN, (bytes / CONTACT_ALIGN + 1) * CONTACT_ALIGN);
        image->strip[i] = ring->strip[i];
        code = ring->strip[i] ? 0 : serve_no_memory();
    }
    return code;
}

/* ---- Drawing ---- */

static void *work(void *context)
{
    struct ring *ring = context;
    const struct contact_image *image = &ring->image;
    for (uint32_t i; (i = atomic_fetch_add(&ring->next, 1)) < contact_view_strips(&image->view);)
        contact_strip_draw(image->body, &image->view, i, ring->strip[i]);
    return NULL;
}

static int draw(struct ring *ring, unsigned threads)
{
    atomic_store(&ring->next, 0);
    return contact_on_threads(threads, work, ring);
}

/* The look of a sheet through the ring: how much of it is inside, and the sum of its gaps there. */
static void look(const struct contact_image *image, const phys_vec *x, struct contact_hit *hit,
                 size_t sum[2])
{
    contact_image_closest(image, SIDE * SIDE, x, hit);
    sum[0] = sum[1] = 0;
    for (size_t i = 0; i < SIDE * SIDE; i++)
        if (hit[i].gap <= 0) {
            sum[0]++;
            sum[1] += (size_t)(-1e12 * hit[i].gap);
        }
}

static void place_sheet(phys_vec *x)
{
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++)
            x[i * SIDE + j] = (phys_vec){(i + 0.5) / SIDE - 0.5, (j + 0.5) / SIDE - 0.5,
                                         0.01 * sin(0.2 * i) + 0.04, 0};
}

/* The best of so many times, s: to draw the maps, and to look up a vertex. The sheet must see on
 * all threads what it sees on one. */
static int run(struct serve_request *request, double *drawn, double *looked)
{
    const unsigned threads = (unsigned)serve_number(request, "threads");
    const uint32_t part = serve_number(request, "quick") ? QUICK : 1;
    const uint64_t rounds = serve_number(request, "rounds");
    const size_t points = (size_t)SIDE * SIDE;
    struct ring ring = {0};
    size_t due[2], seen[2];
    phys_vec *x = aligned_alloc(CONTACT_ALIGN,
                                points * sizeof *x / CONTACT_ALIGN * CONTACT_ALIGN + CONTACT_ALIGN);
    struct contact_hit *hit = aligned_alloc(CONTACT_ALIGN, points * sizeof *hit);
    int code = x && hit ? make_ring(&ring, part) : serve_no_memory();
    *drawn = *looked = INFINITY;
    if (x)
        place_sheet(x);
    for (uint64_t i = 0; i <= rounds && !code; i++) {
        const double begin = serve_seconds();
        code = draw(&ring, i ? threads : 1);
        const double middle = serve_seconds();
        look(&ring.image, x, hit, i ? seen : due);
        const double looking = (serve_seconds() - middle) / (double)points;
        *drawn = i ? fmin(*drawn, middle - begin) : *drawn;
        *looked = fmin(*looked, looking);
        if (!code && (due[0] < points / 50 || (i && memcmp(seen, due, sizeof due))))
            code = serve_fail("wrong answer: %zu vertices are inside, %zu by maps that one thread "
                              "has drawn",
                              i ? seen[0] : due[0], due[0]);
    }
    free(x);
    free(hit);
    free_ring(&ring);
    return code;
}

static int map_time(void *context, struct serve_request *request, double *value)
{
    double looked;
    (void)context;
    return run(request, value, &looked);
}

static int look_time(void *context, struct serve_request *request, double *value)
{
    double drawn;
    (void)context;
    return run(request, &drawn, value);
}

const struct serve_run contact_map_runs[] = {{"map", map_time}, {"look_up", look_time}, {0}};

/* ---- The plan ---- */

static void plan_maps(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape ours = {"duite", 0, options->threads};
    const int rounds = options->quick ? 2 : 20;
    const struct measure_series *map =
        measure_series(measure, ours, "map threads=%u quick=%d rounds=%d", options->threads,
                       options->quick, rounds);
    const struct measure_series *look_up =
        measure_series(measure, ours, "look_up threads=%u quick=%d rounds=%d", options->threads,
                       options->quick, rounds);
    measure_value(measure, map, 1e3, "ms", "map_ms");
    measure_value(measure, look_up, 1e9, "ns", "map_lookup_ns_per_vertex");
}

const struct bench_case contact_maps = {
    "maps",
    "depths and normals of a ring of 27,784 triangles from the front and the back, 1024 x 1024 "
    "pixels, on all threads; what a sheet of 34,969 vertices meets there, on one",
    plan_maps, contact_map_runs, 0};
