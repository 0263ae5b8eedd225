/* contact-partition: whether METIS should know which blocks touch (Keckeisen & Blochinger 2004
 * leave it open). A pilot run notes how many rows blocks show each other for their contacts. Other
 * runs, and predictions from the pilot's trace, map the same blocks by METIS with these rows as
 * further edges, or without. A line of figures is printed; bench/experiments makes tables of them.
 */
#include "bench/ranks/sheet.h"

#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/scene/scene.h"
#include "tools/predict/predict.h"

#include <duite_policy.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] =
    "Usage: contact-partition pilot LINKS TRACE FIRST_STEP SCENE.yaml [KEY=VALUE]...\n"
    "       contact-partition run with|without LINKS SCENE.yaml [KEY=VALUE]...     (under mpirun)\n"
    "       contact-partition predict with|without LINKS TRACE HOSTS CORES\n";

enum { MOST_SETS = 32 };

static int fail(const char *what)
{
    fprintf(stderr, "contact-partition: %s\n", what);
    return 1;
}

/* ---- Links: rows that a block shows another one for their contacts, mean of the steps ---- */

static struct {
    uint32_t n; /* blocks; 0: there are none */
    double *rows;
    uint64_t steps;
    bool used; /* by the mapping */
} links;

/* argv: with or without, and the file. */
static int links_read(char **argv)
{
    uint32_t a, b;
    double rows;
    FILE *file = fopen(argv[1], "r");
    links.used = !strcmp(argv[0], "with");
    int code = !file || fscanf(file, "%" SCNu32, &links.n) != 1 || !links.n || links.n > 10000;
    links.rows = code ? NULL : calloc((size_t)links.n * links.n, sizeof *links.rows);
    code = code || !links.rows;
    while (!code && fscanf(file, "%" SCNu32 " %" SCNu32 " %lf", &a, &b, &rows) == 3)
        if (a < links.n && b < links.n)
            links.rows[(size_t)a * links.n + b] = rows;
    if (file)
        fclose(file);
    return code ? fail("the links cannot be read") : 0;
}

static int links_write(const char *path)
{
    FILE *file = fopen(path, "w");
    if (file)
        fprintf(file, "%" PRIu32 "\n", links.n);
    for (uint32_t a = 0; file && a < links.n; a++)
        for (uint32_t b = 0; b < links.n; b++)
            if (links.rows[(size_t)a * links.n + b] > 0)
                fprintf(file, "%" PRIu32 " %" PRIu32 " %.6g\n", a, b,
                        links.rows[(size_t)a * links.n + b] / (double)links.steps);
    return !file || fclose(file) ? fail("the links cannot be written") : 0;
}

/* ---- The mapping: METIS with these edges, in the bytes that hints count ---- */

static double edge_of(const duite_object_graph *graph, size_t a, uint32_t b)
{
    for (size_t i = graph->start[a]; i < graph->start[a + 1]; i++)
        if (graph->neighbour[i] == b)
            return graph->edge_weight[i];
    return 0;
}

/* The bytes that two blocks show each other for their contacts. Blocks come first among the
 * objects. */
static double contacts_of(size_t a, size_t b)
{
    return a < links.n && b < links.n
               ? 3 * sizeof(double) * (links.rows[a * links.n + b] + links.rows[b * links.n + a])
               : 0;
}

/* The mapping that was made last: bytes of an exchange that cross ranks, as neighbours and for
 * contacts, and the largest share of the work over the mean. */
static struct {
    double neighbours, contacts, uneven;
} cut;

static void note_cut(const duite_object_graph *graph, int n_ranks, const int *home)
{
    double work[256] = {0}, all = 0, most = 0;
    cut.neighbours = cut.contacts = 0;
    for (size_t a = 0; a < graph->n; a++) {
        work[home[a] % 256] += graph->weight[a];
        all += graph->weight[a];
        for (uint32_t b = 0; b < a; b++)
            if (home[a] != home[b]) {
                cut.neighbours += edge_of(graph, a, b);
                cut.contacts += contacts_of(a, b);
            }
    }
    for (int r = 0; r < n_ranks && r < 256; r++)
        most = fmax(most, work[r]);
    cut.uneven = most * n_ranks / all;
}

static int map_joined(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    const size_t most = graph->start[graph->n] + (size_t)links.n * links.n + 1;
    duite_object_graph joined = *graph;
    size_t *start = calloc(graph->n + 1, sizeof *start), n = 0;
    uint32_t *neighbour = malloc(most * sizeof *neighbour);
    double *weight = malloc(most * sizeof *weight);
    int code = start && neighbour && weight ? DUITE_OK : DUITE_E_MEMORY;
    for (size_t a = 0; a < graph->n && !code; a++) {
        for (uint32_t b = 0; b < graph->n; b++) {
            const double bytes = a == b ? 0 : edge_of(graph, a, b) + contacts_of(a, b);
            neighbour[n] = b;
            weight[n] = bytes;
            n += bytes > 0;
        }
        start[a + 1] = n;
    }
    joined.start = start;
    joined.neighbour = neighbour;
    joined.edge_weight = weight;
    code = code ? code : duite_mapping_find("metis")->map(&joined, n_ranks, seed, home);
    free(start);
    free(neighbour);
    free(weight);
    return code;
}

/* Objects of the run, which are few, are mapped as they are. */
static int map_with_links(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    const bool blocks = graph->n >= links.n;
    const int code = blocks && links.used
                         ? map_joined(graph, n_ranks, seed, home)
                         : duite_mapping_find("metis")->map(graph, n_ranks, seed, home);
    if (!code && blocks)
        note_cut(graph, n_ranks, home);
    return code;
}

static const duite_mapping WITH_LINKS = {.size = sizeof(duite_mapping),
                                         .name = "metis_contacts",
                                         .summary = "METIS, with contacts as edges or without",
                                         .map = map_with_links};

/* ---- Runs ---- */

static struct flow_state run;

/* After each step: what the blocks said of their ties. */
static void note(void *context, uint64_t step, uint64_t steps, uint64_t cg_iterations)
{
    const struct flow_tie_records *said = &run.tied.said;
    (void)context, (void)step, (void)steps, (void)cg_iterations;
    links.steps++;
    for (uint32_t a = 0; a < links.n; a++)
        for (uint32_t i = said->first[a]; i < said->first[a] + said->of[a].n_links; i++)
            links.rows[(size_t)a * links.n + said->link[i].block] += said->link[i].rows;
}

/* All of a run but its end, as flow_run makes it, so that `note` can look into it. */
static int make_steps(struct flow *flow, duite *rt, struct flow_report *report)
{
    static struct cloth_error error;
    run = (struct flow_state){.flow = flow, .rt = rt, .report = report, .error = &error};
    int code = flow_run_begin(&run);
    links.n = run.head.n_blocks;
    links.rows = calloc((size_t)links.n * links.n, sizeof *links.rows);
    if (!code && !links.rows)
        code = DUITE_E_MEMORY;
    if (!code)
        code = flow_ties_choose(&run);
    if (!code)
        code = flow_cg_record(&run);
    if (!code)
        code = flow_initialise(&run);
    if (!code)
        code = flow_contact_start(&run);
    if (!code)
        code = flow_steps(&run);
    if (!code)
        code = duite_wait(rt);
    flow_objects_free(&run);
    duite_wait(rt);
    flow_memory_free(&run);
    return code;
}

static int read_scene(struct model *model, int argc, char **argv)
{
    struct scene_set set[MOST_SETS] = {{0}};
    struct cloth_error error = {0};
    const int n = argc - 1;
    for (int i = 0; i < n && i < MOST_SETS; i++)
        set[i].text = argv[i + 1];
    if (n > MOST_SETS)
        return fail("too many KEY=VALUE");
    return scene_read(model, argv[0], (size_t)n, set, &error) ? fail(error.text) : 0;
}

static int make_flow(struct flow **flow, const struct model *model)
{
    struct cloth_error error = {0};
    const int code =
        sheet_own_rank() ? flow_join(flow, &error) : flow_prepare(flow, model, 1, &error);
    return code ? fail(error.text) : 0;
}

static int start(duite **rt, struct flow *flow, duite_options *options)
{
    options->kernels = flow_kernels();
    options->context = flow;
    return duite_start(rt, options) ? fail(duite_message()) : 0;
}

static int pilot(int argc, char **argv)
{
    struct model model = {0};
    struct flow *flow = NULL;
    struct flow_report report = {0};
    const struct flow_progress progress = {.step = note};
    duite *rt = NULL;
    duite_options options = duite_options_default();
    options.trace = argv[1];
    options.trace_first = strtoull(argv[2], NULL, 10);
    int code = read_scene(&model, argc - 3, argv + 3) || make_flow(&flow, &model);
    if (!code) {
        flow->progress = &progress;
        code = start(&rt, flow, &options);
    }
    if (!code && make_steps(flow, rt, &report))
        code = fail("the pilot fails");
    if (rt && duite_stop(&rt))
        code = fail(duite_message());
    code = code || links_write(argv[0]);
    flow_free(flow);
    model_free(&model);
    return code;
}

/* seconds a step, MB sent, messages, KB of an exchange that cross ranks as neighbours and for
 * contacts, the hash of the end. */
static int run_mapped(int argc, char **argv)
{
    struct model model = {0};
    struct flow *flow = NULL;
    struct flow_report report = {0};
    struct cloth_error error = {0};
    duite *rt = NULL;
    duite_options options = duite_options_default();
    options.threads = 1;
    int code =
        links_read(argv) || read_scene(&model, argc - 2, argv + 2) || make_flow(&flow, &model);
    options.mapping = &WITH_LINKS;
    code = code || start(&rt, flow, &options);
    if (!code && flow_run(flow, rt, NULL, NULL, &report, &error))
        code = fail(error.text);
    if (rt && duite_stop(&rt))
        code = fail(duite_message());
    if (!code && !sheet_own_rank())
        printf("%.6g %.6g %" PRIu64 " %.6g %.6g %016" PRIx64 "\n",
               report.wall_seconds / (double)report.steps, 1e-6 * (double)report.counters.bytes,
               report.counters.messages, 1e-3 * cut.neighbours, 1e-3 * cut.contacts,
               report.state_hash);
    flow_free(flow);
    model_free(&model);
    return code;
}

/* ---- Predictions ---- */

/* seconds of the traced steps, speed-up, messages, KB of an exchange as above, the largest share of
 * the work over the mean. */
static int predict_mapped(char **argv)
{
    struct trace_run *traced = NULL;
    struct predict_result result;
    struct predict_cluster cluster = {.hosts = (uint32_t)strtoul(argv[3], NULL, 10),
                                      .cores = (uint32_t)strtoul(argv[4], NULL, 10),
                                      .latency = 1e-5,
                                      .bandwidth =
                                          1e15, /* lists that grow are traced with all their room */
                                      .capacity = INFINITY,
                                      .core_speed = 1,
                                      .overhead = -1,
                                      .message = 5e-6,
                                      .look = -1,
                                      .steady = true,
                                      .mapping = &WITH_LINKS,
                                      .scheduler = duite_scheduler_find("steal"),
                                      .balance = duite_balancer_find("none"),
                                      .seed = 1};
    int code = links_read(argv);

    if (!code && trace_read(&traced, argv[2], false))
        return fail(duite_message());
    if (!code && predict(traced, &cluster, &result, NULL))
        code = fail(duite_message());
    if (!code)
        printf("%.6g %.6g %" PRIu64 " %.6g %.6g %.4g\n", result.makespan,
               result.work / result.makespan, result.messages, 1e-3 * cut.neighbours,
               1e-3 * cut.contacts, cut.uneven);
    trace_run_free(traced);
    return code;
}

int main(int argc, char **argv)
{
    int code = 2;
    if (argc > 5 && !strcmp(argv[1], "pilot"))
        code = pilot(argc - 2, argv + 2);
    else if (argc > 4 && !strcmp(argv[1], "run"))
        code = run_mapped(argc - 2, argv + 2);
    else if (argc == 7 && !strcmp(argv[1], "predict"))
        code = predict_mapped(argv + 2);
    else
        fputs(USAGE, stderr);
    free(links.rows);
    return code;
}
