/* Frames in real time: a tilted sheet falls onto the floor, crumples and comes to rest, with all
 * that belongs to it: impacts, steps that are halved, frames handed over. One run tells three
 * numbers; each is told once, then there is another run. */
#include "bench/cg/cg.h"

#include "cloth/base/order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STEPS = 4096, STEPS_A_FRAME = 2, STEPS = 100, QUICK_STEPS = 8 };

/* Bounds of an answer: of edges, m below the floor, m/s in the last frame. */
static const double STRETCH_LIMIT = 1.25, DEEPEST = 1e-9, AT_REST = 0.01;

struct film {
    double at[MOST_STEPS + 1]; /* s: when so many steps were over */
    uint64_t n;
    size_t n_vertices;
    double *last; /* n_vertices x 3: the frame before */
    double time;  /* of that, s */
    double lowest, fastest;
};

static void begun(void *context)
{
    struct film *film = context;
    film->at[0] = serve_seconds();
}

static void note(void *context, uint64_t step, uint64_t steps, uint64_t cg_iterations)
{
    struct film *film = context;
    (void)cg_iterations;
    if (step <= MOST_STEPS && steps)
        film->at[film->n = step] = serve_seconds();
}

static int show(void *context, uint64_t frame, double time, const double *position,
                struct cloth_error *error)
{
    struct film *film = context;
    (void)error;
    film->fastest = 0;
    for (size_t v = 0; v < film->n_vertices; v++) {
        const double *x = position + 3 * v, *y = film->last + 3 * v;
        const double way = sqrt((x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]) +
                                (x[2] - y[2]) * (x[2] - y[2]));
        film->lowest = fmin(film->lowest, x[1]);
        if (frame)
            film->fastest = fmax(film->fastest, way / (time - film->time));
    }
    memcpy(film->last, position, film->n_vertices * 3 * sizeof *position);
    film->time = time;
    return 0;
}

/* Seconds a frame: the mean, and in *p95 what 95 % of them stay below. */
static double seconds_a_frame(const struct film *film, double *p95)
{
    static double frame[MOST_STEPS];
    const uint64_t n = film->n / STEPS_A_FRAME;
    for (uint64_t i = 0; i < n; i++)
        frame[i] = film->at[(i + 1) * STEPS_A_FRAME] - film->at[i * STEPS_A_FRAME];
    qsort(frame, n, sizeof *frame, cloth_by_double);
    *p95 = n ? frame[(n - 1) * 95 / 100] : NAN;
    return n ? (film->at[n * STEPS_A_FRAME] - film->at[0]) / (double)n : NAN;
}

static int check(const struct film *film, const struct flow_report *report, bool quick)
{
    if (!(report->stretch_highest <= STRETCH_LIMIT))
        return serve_fail("wrong answer: an edge was %g of its length", report->stretch_highest);
    if (!(film->lowest >= -DEEPEST))
        return serve_fail("wrong answer: a vertex was %g m below the floor", -film->lowest);
    if (!quick && !(film->fastest < AT_REST))
        return serve_fail("wrong answer: %g m/s in the last frame", film->fastest);
    return 0;
}

/* The reference's sheet, tilted by 58 degrees and waved, 0.62 m above the floor, at rest. There is
 * no friction: what slides is slowed down by damping. */
static int make(struct states_plan *plan, bool quick)
{
    int code = states_plan_make(plan, "crumpled_h20", quick);
    if (!code)
        code = states_wave(&plan->model);
    if (code)
        return code;
    struct model *model = &plan->model;
    for (size_t v = 0; v < model->cloths->mesh.n_vertices; v++)
        memset(model->cloths->start + 6 * v + 3, 0, 3 * sizeof(double));
    model->end = (quick ? QUICK_STEPS : STEPS) * model->h;
    model->stretch_limit = STRETCH_LIMIT;
    model->full_slope = PHYS_ABSOLUTE;
    model->materials->damping_mass = 2;
    return 0;
}

static int run(struct serve_request *request, bool quick, struct film *film,
               struct flow_report *report)
{
    struct states_plan plan = {0};
    const struct flow_progress progress = {.context = film, .distributed = begun, .step = note};
    const struct flow_output output = {.context = film, .frame = show};
    int code = make(&plan, quick);
    if (!code) {
        film->n_vertices = plan.model.cloths->mesh.n_vertices;
        film->last = calloc(3 * film->n_vertices + 1, sizeof *film->last);
        code = film->last ? cg_run(&plan.model, request, &output, &progress, report)
                          : serve_no_memory();
    }
    free(film->last);
    states_plan_free(&plan);
    return code ? code : check(film, report, quick);
}

int cg_frames(void *session, struct serve_request *request, double *value)
{
    static const char *const whats[] = {"mean", "p95", "halved"};
    static double known[3] = {NAN, NAN, NAN};
    static struct film film;
    struct flow_report report = {0};
    char word[16];
    size_t what = 0;
    const bool quick = serve_number(request, "quick") != 0;
    serve_word(request, "what", word, sizeof word);
    while (what < 2 && strcmp(word, whats[what]) != 0)
        what++;
    int code = 0;
    if (isnan(known[what])) {
        film = (struct film){0};
        code = cg_pause(session);
        if (!code)
            code = run(request, quick, &film, &report);
        known[0] = seconds_a_frame(&film, known + 1);
        known[2] = (double)report.steps_halved;
    }
    *value = known[what];
    known[what] = NAN;
    return code;
}
