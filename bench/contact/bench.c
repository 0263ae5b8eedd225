/* The bench "contact": its cases and its targets. */
#include "bench/contact/contact.h"

static void plan_certify(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape ours = {"duite", 0, options->threads};
    const struct measure_series *time =
        measure_series(measure, ours, "certify pairs=%d", options->quick ? 1000 : 200000);
    const struct measure_series *uncut =
        measure_series(measure, ours, "uncut pairs=%d", options->quick ? 1000 : 1000000);
    measure_value(measure, time, 1e9, "ns", "certify_ns_per_pair");
    measure_value(measure, uncut, 1, "share", "certified_uncut");
}

static const struct bench_case CERTIFY = {
    "certify",
    "whether a moving pair of features never touches, of random pairs: corners in a cube of 10 mm, "
    "ways of up to 2 mm together and 2 mm each along each axis, thickness 1 mm; one thread",
    plan_certify, contact_certify_runs, 0};

static void plan_solid(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape ours = {"duite", 0, options->threads};
    const int n = options->quick ? 1000 : 200000;
    measure_value(measure, measure_series(measure, ours, "sphere triangles=%d", n), 1e9, "ns",
                  "solid_ns_per_triangle_sphere");
    measure_value(measure, measure_series(measure, ours, "box triangles=%d", n), 1e9, "ns",
                  "solid_ns_per_triangle_box");
}

static const struct bench_case SOLID = {"solid",
                                        "whether a triangle that lies 1 to 3 mm from a ball or a "
                                        "box touches it on ways of up to 0.2 mm "
                                        "along each axis; one thread",
                                        plan_solid, contact_solid_runs, 0};

static void plan_detect(struct measure *measure, const struct bench_options *options)
{
    static const char *const shape[] = {"waves", "draped", "six_layers"};
    for (int i = 0; i < 3; i++) {
        const struct measure_series *time =
            measure_series(measure, (struct subject_shape){"duite", 0, options->threads},
                           "detect shape=%s threads=%u quick=%d rounds=%d", shape[i],
                           options->threads, options->quick, options->quick ? 2 : 10);
        const struct measure_series *rival =
            measure_series(measure, (struct subject_shape){"embree", 0, options->threads},
                           "detect shape=%s threads=%u quick=%d rounds=%d", shape[i],
                           options->threads, options->quick, options->quick ? 2 : 10);
        measure_value(measure, time, 1e9, "ns", "detect_ns_per_vertex_%s", shape[i]);
        measure_value(measure, rival, 1e9, "ns", "detect_embree_ns_per_vertex_%s", shape[i]);
        measure_ratio(measure, time, rival, "detect_vs_embree_%s", shape[i]);
    }
}

static const struct bench_case DETECT = {
    "detect",
    "what is nearer than 2 mm in a sheet of 34,969 vertices in 36 blocks: skins made for a step, "
    "queries, and the distances of what they visit",
    plan_detect, contact_detect_runs, 0};

static const struct bench_case *const CASES[] = {&CERTIFY,
                                                 &SOLID,
                                                 &DETECT,
                                                 &contact_maps,
                                                 &contact_part,
                                                 &contact_iterations,
                                                 &contact_self,
                                                 &contact_frames_sphere,
                                                 &contact_frames_stack,
                                                 &contact_twist,
                                                 contact_peers + 0,
                                                 contact_peers + 1,
                                                 contact_peers + 2,
                                                 contact_peers + 3,
                                                 contact_peers + 4,
                                                 contact_peers + 5,
                                                 contact_peers + 6,
                                                 &contact_ring,
                                                 &contact_pinch,
                                                 &contact_memory,
                                                 &contact_instructions,
                                                 &contact_intersections,
                                                 NULL};

/* For two threads and the full sizes. */
static const struct measure_target TARGETS[] = {{"certify_ns_per_pair", 35, false},
                                                {"certified_uncut", 0.85, true},
                                                {"detect_ns_per_vertex_waves", 130, false},
                                                {"detect_ns_per_vertex_draped", 400, false},
                                                {"detect_ns_per_vertex_six_layers", 1600, false},
                                                {"detect_vs_embree_waves", 0.45, false},
                                                {"detect_vs_embree_six_layers", 1.2, false},
                                                {"map_ms", 20, false},
                                                {"collision_speedup_t2", 1.9, true},
                                                {"collision_speedup_r2", 1.7, true},
                                                {"iterations_with_contact", 1.2, false},
                                                {"self_on_vs_off", 1.5, false},
                                                {"sphere_seconds_per_frame", 0.25, false},
                                                {"stack_seconds_per_frame", 1.5, false},
                                                {"sphere_vs_blender", 0.02, false},
                                                {"twist_balance_vs_none", 0.95, false},
                                                {"peers_drape", 0.9, false},
                                                {"peers_curtain", 0.35, false},
                                                {"peers_twist", 4.5, false},
                                                {"peers_needle", 1.8, false},
                                                {"peers_stack", 8, false},
                                                {"peers_ribbon", 0.8, false},
                                                {"peers_layers", 3, false},
                                                {"ring_solves_per_step", 2.5, false},
                                                {"ring_seconds", 4, false},
                                                {"pinch_force_growth", 1.01, false},
                                                {"pinch_force_h1_vs_h10", 1.1, false},
                                                {"memory_cross_vs_still", 2, false},
                                                {"instructions_nothing_to_touch", 1.01, false},
                                                {"intersections", 0, false},
                                                {0}};
enum { TARGET_THREADS = 2 };

static int serve_contact(const struct bench *bench)
{
    const struct serve_run *const runs[] = {
        contact_certify_runs, contact_detect_runs,      contact_solid_runs,
        contact_map_runs,     contact_scene_runs,       contact_state_runs,
        contact_blender_runs, contact_instruction_runs, NULL};
    (void)bench;
    const int status = serve("the cloth's kernels of contact, and its runs; "
                             "duite_options_default() but for threads, scheduler and balancer",
                             runs, NULL);
    const int code = contact_state_end();
    return status || code;
}

const struct bench bench_contact = {
    "contact",      "finding contacts and certifying that nothing goes through",
    CASES,          TARGETS,
    TARGET_THREADS, serve_contact,
    NULL,           NULL};
