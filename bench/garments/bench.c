/* The bench "garments": meshes of sewing patterns, here, and garments that are worn, in files of
 * their own. Each figure of meshes is that of the worst pattern. The patterns are those beside the
 * tree, or, where these are absent, small ones of the tests. */
#include "bench/contact/contact.h"
#include "bench/garments/garments.h"

#include "cloth/garment/garment.h"
#include "cloth/scene/pattern.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { VERTICES = 35000, QUICK_VERTICES = 1000, N_NAMES = 4 };
static const char *const OTHERS[N_NAMES] = {"tee", "dress", "skirt_4_panels", "wb_pants_straight"};
static const char *const OWN[N_NAMES] = {"circle", "dart", "gather", "quadratic"};

static bool others_are_there(void)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.json", BENCH_PATTERNS, OTHERS[0]);
    return access(path, R_OK) == 0;
}

/* The figures of a mesh. */
struct figures {
    double seconds, below, least; /* s; share of triangles; degrees */
};

/* The mesh has to have the vertices that are asked for, within 1 %; of few, the boundaries have
 * whole divisions. */
static int mesh(const char *path, uint32_t vertices, bool quick, struct figures *figures)
{
    struct garment_pattern pattern;
    struct garment garment = {0};
    struct cloth_error error = {0};
    const struct garment_fineness fineness = {0, vertices};
    int code = scene_read_pattern(&pattern, path, NULL, &error);
    const double begin = serve_seconds();
    code = code ? code : garment_make(&garment, &pattern, &fineness, &error);
    figures->seconds = serve_seconds() - begin;
    if (code) {
        code = serve_fail("%s", error.text);
    } else {
        uint32_t below;
        figures->least = garment_least_angle(&garment, &below);
        figures->below = (double)below / garment.n_triangles;
        if (fabs((double)garment.n_vertices - vertices) > (quick ? 0.05 : 0.01) * vertices)
            code = serve_fail("%s: %u vertices, not %u", path, garment.n_vertices, vertices);
    }
    garment_free(&garment);
    garment_pattern_free(&pattern);
    return code;
}

/* The worst of all patterns. */
static int mesh_all(struct serve_request *request, struct figures *worst)
{
    const bool quick = serve_number(request, "quick"), others = others_are_there();
    *worst = (struct figures){0, 0, 60};
    for (int i = 0; i < N_NAMES; i++) {
        struct figures figures = {0};
        char path[4096];
        snprintf(path, sizeof path, "%s/%s.json", others ? BENCH_PATTERNS : BENCH_OWN_PATTERNS,
                 others ? OTHERS[i] : OWN[i]);
        int code = mesh(path, quick ? QUICK_VERTICES : VERTICES, quick, &figures);
        if (code)
            return code;
        worst->seconds = fmax(worst->seconds, figures.seconds);
        worst->below = fmax(worst->below, figures.below);
        worst->least = fmin(worst->least, figures.least);
    }
    return 0;
}

static int run_seconds(void *context, struct serve_request *request, double *value)
{
    struct figures worst;
    (void)context;
    const int code = mesh_all(request, &worst);
    *value = worst.seconds;
    return code;
}

static int run_below(void *context, struct serve_request *request, double *value)
{
    struct figures worst;
    (void)context;
    const int code = mesh_all(request, &worst);
    *value = worst.below;
    return code;
}

static int run_least(void *context, struct serve_request *request, double *value)
{
    struct figures worst;
    (void)context;
    const int code = mesh_all(request, &worst);
    *value = worst.least;
    return code;
}

static const struct serve_run RUNS[] = {{"pattern_seconds", run_seconds},
                                        {"pattern_below", run_below},
                                        {"pattern_least", run_least},
                                        {0}};

static void plan_patterns(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape ours = {"duite", 0, options->threads};
    const int quick = options->quick;
    measure_value(measure, measure_series(measure, ours, "pattern_seconds quick=%d", quick), 1e3,
                  "ms", "pattern_ms");
    measure_value(measure, measure_series(measure, ours, "pattern_below quick=%d", quick), 1,
                  "share", "pattern_below_30");
    measure_value(measure, measure_series(measure, ours, "pattern_least quick=%d", quick), 1,
                  "degrees", "pattern_least_angle");
}

static const struct bench_case PATTERNS = {
    "patterns",
    "meshes of four sewing patterns, of 35,000 vertices each, on one thread: the slowest, the one "
    "with the most triangles that have an angle below 30 degrees, and the least angle of all",
    plan_patterns, RUNS, 0};

static const struct bench_case *const CASES[] = {&PATTERNS,
                                                 &garments_avatar,
                                                 &contact_maps,
                                                 &garments_worn,
                                                 &garments_jeans,
                                                 &garments_walk,
                                                 &garments_correction,
                                                 &garments_intersections,
                                                 NULL};

static const struct measure_target TARGETS[] = {{"pattern_ms", 900, false},
                                                {"pattern_below_30", 0.0001, false},
                                                {"pattern_least_angle", 20, true},
                                                {"avatar_seconds", 2, false},
                                                {"map_ms", 20, false},
                                                {"body_ns_per_vertex", 200, false},
                                                {"open_mesh_vs_body", 1.3, false},
                                                {"self_ns_per_vertex", 700, false},
                                                {"jeans_repulsion_seconds", 1.2, false},
                                                {"jeans_certified_seconds", 2, false},
                                                {"walk_seconds_per_frame", 0.35, false},
                                                {"velocity_correction_cost", 1.1, false},
                                                {"intersections", 0, false},
                                                {0}};
enum { TARGET_THREADS = 2 };

static int serve_garments(const struct bench *bench)
{
    const struct serve_run *const runs[] = {RUNS,
                                            garments_avatar_runs,
                                            contact_map_runs,
                                            garments_worn_runs,
                                            garments_scene_runs,
                                            garments_correction_runs,
                                            NULL};
    (void)bench;
    const int status =
        serve(others_are_there() ? "tee, dress, skirt_4_panels and wb_pants_straight"
                                 : "circle, dart, gather and quadratic of the tests: the "
                                   "patterns of ../shared/data/patterns are not there",
              runs, NULL);
    const int code = contact_state_end();
    return status || code;
}

const struct bench bench_garments = {"garments",
                                     "sewing patterns, and garments that are put on and worn",
                                     CASES,
                                     TARGETS,
                                     TARGET_THREADS,
                                     serve_garments,
                                     garments_worn_make,
                                     NULL};
