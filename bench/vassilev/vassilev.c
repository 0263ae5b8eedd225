/* vassilev: a scene's cloth by Vassilev's six loops (loops.h), for bench/experiments vassilev.
 * `run` prints what an iteration takes; `check` compares states with those of duite-cloth. */
#include "bench/vassilev/loops.h"

#include "cloth/flow/run.h"
#include "cloth/scene/scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] =
    "Usage: vassilev run THREADS STEPS on|off LIMIT SCENE.yaml [KEY=VALUE]...\n"
    "       vassilev check STEPS SCENE.yaml [KEY=VALUE]...\n"
    "\n"
    "    on|off  whether pieces of cloth repel each other\n"
    "    LIMIT   length of springs against that at rest beyond which velocities are corrected; 0: "
    "none\n"
    "\n"
    "run prints vertices, springs, joints, pieces, milliseconds an iteration, the same of each of "
    "the six\n"
    "loops, and the mean numbers of vertices that were in the body and of pairs that repelled each "
    "other.\n"
    "check makes the steps without body and without the last three by loops, on one thread and on "
    "two, and\n"
    "by duite-cloth; it prints the farthest that a vertex is from where duite-cloth has it, m.\n";

enum { MOST_SETS = 32 };

static int fail(const char *what)
{
    fprintf(stderr, "vassilev: %s\n", what);
    return 1;
}

/* more: NULL-ended, after those of the command line. */
static int read_scene(struct model *model, int argc, char **argv, const char *const *more)
{
    struct scene_set set[MOST_SETS] = {{0}};
    struct cloth_error error = {0};
    size_t n = 0;
    for (int i = 1; i < argc && n < MOST_SETS; i++)
        set[n++].text = argv[i];
    for (; more && *more && n < MOST_SETS; more++)
        set[n++].text = *more;
    if (n == MOST_SETS)
        return fail("too many KEY=VALUE");
    return scene_read(model, argv[0], n, set, &error) ? fail(error.text) : 0;
}

/* ---- run ---- */

static void print(const struct loops_team *team)
{
    const struct loops *l = team->loops;
    const double steps = (double)team->steps, per = 1e3 / steps;
    double sum = 0;
    for (int k = 0; k < LOOPS; k++)
        sum += team->seconds[k];
    printf("%" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %.6g", l->n, l->n_springs, l->n_joints,
           l->n_pieces, per * sum);
    for (int k = 0; k < LOOPS; k++)
        printf(" %.6g", per * team->seconds[k]);
    printf(" %.6g %.6g\n", (double)team->inside / steps, (double)team->pushes / steps);
}

static int find_diverged(const struct loops *l)
{
    for (uint32_t i = 0; i < l->n; i++)
        for (int c = 0; c < 3; c++)
            if (!(fabs(l->x[i][c]) < 1e3))
                return fail("the cloth flew apart: h is too long");
    return 0;
}

static int run(int argc, char **argv)
{
    struct model model = {0};
    struct loops loops = {0};
    struct loops_team team = {.loops = &loops,
                              .threads = (unsigned)strtoul(argv[0], NULL, 10),
                              .steps = strtoull(argv[1], NULL, 10)};
    if (!team.steps || (strcmp(argv[2], "on") != 0 && strcmp(argv[2], "off") != 0))
        return fputs(USAGE, stderr), 2;
    int code = read_scene(&model, argc - 4, argv + 4, NULL) || loops_take(&loops, &model);
    loops.self = !strcmp(argv[2], "on");
    loops.limit = strtod(argv[3], NULL);
    code = code || loops_run(&team) || find_diverged(&loops);
    if (!code)
        print(&team);
    loops_free(&loops);
    model_free(&model);
    return code;
}

/* ---- check ---- */

struct film {
    double *x; /* of the last frame; 3 numbers a vertex */
    size_t n;
};

static int keep(void *context, uint64_t frame, double time, const double *position,
                struct cloth_error *error)
{
    const struct film *film = context;
    (void)frame, (void)time, (void)error;
    memcpy(film->x, position, 3 * film->n * sizeof *film->x);
    return 0;
}

static int run_ours(const struct model *model, struct film *film)
{
    const struct flow_output output = {.context = film, .frame = keep};
    struct flow_report report = {0};
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    duite *rt = NULL;
    duite_options options = duite_options_default();
    int code = flow_prepare(&flow, model, 1, &error) ? fail(error.text) : 0;
    options.kernels = flow_kernels();
    options.context = flow;
    options.threads = 1;
    film->n = code ? 0 : (size_t)flow_vertices(flow);
    film->x = calloc(3 * film->n + 1, sizeof *film->x);
    if (!code && !film->x)
        code = fail("no memory");
    if (!code && duite_start(&rt, &options))
        code = fail(duite_message());
    if (!code && flow_run(flow, rt, &output, NULL, &report, &error))
        code = fail(error.text);
    if (rt && duite_stop(&rt) && !code)
        code = fail(duite_message());
    flow_free(flow);
    return code;
}

/* The farthest from the film on so many threads, m. */
static int run_theirs(const struct model *model, const struct film *film, unsigned threads,
                      uint64_t steps, double *most)
{
    struct loops loops = {0};
    struct loops_team team = {.loops = &loops, .threads = threads, .steps = steps};
    int code = loops_take(&loops, model) || loops_run(&team);
    for (uint32_t i = 0; i < loops.n && !code; i++)
        for (int c = 0; c < 3; c++)
            *most = fmax(*most, fabs(loops.x[i][c] - film->x[3 * i + (uint32_t)c]));
    loops_free(&loops);
    return code;
}

static int check(int argc, char **argv)
{
    struct model model = {0};
    struct film film = {0};
    double most = 0;
    const uint64_t steps = strtoull(argv[0], NULL, 10);
    static const char *const MORE[] = {"obstacles=[]", "contact={mode: project}", NULL};
    if (!steps)
        return fputs(USAGE, stderr), 2;
    int code = read_scene(&model, argc - 1, argv + 1, MORE);
    model.end = (double)steps * model.h;
    model.fps = 1 / model.end;
    code = code || run_ours(&model, &film);
    for (unsigned threads = 1; threads <= 2 && !code; threads++)
        code = run_theirs(&model, &film, threads, steps, &most);
    if (!code)
        printf("%.3g\n", most);
    if (!code && !(most < 1e-12 * (double)steps))
        code = fail("states differ by more than roundoff");
    free(film.x);
    model_free(&model);
    return code;
}

int main(int argc, char **argv)
{
    if (argc > 6 && !strcmp(argv[1], "run"))
        return run(argc - 2, argv + 2);
    if (argc > 3 && !strcmp(argv[1], "check"))
        return check(argc - 2, argv + 2);
    fputs(USAGE, stderr);
    return 2;
}
