/* A failure of the machinery (memory, MPI) ends the test program at once: no case is about it. */
#include "tests/cloth/flow/models.h"

#include "tests/support/rank.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void die(const char *why)
{
    fprintf(stderr, "%s\n", why);
    exit(99);
}

static void setup_common(struct setup *s)
{
    s->model.name = "test";
    s->model.n_materials = s->model.n_cloths = 1;
    s->model.materials = &s->material;
    s->model.cloths = &s->cloth;
    s->model.obstacles = &s->plane;
    s->model.gravity[1] = -9.81;
    s->model.h = 0.001;
    s->model.end = 0.01;
    s->model.fps = 1000;
    s->model.integrator = MODEL_IMPLICIT_EULER;
    s->model.stop = MODEL_STOP_RELATIVE;
    s->model.tolerance = 1e-3;
    s->model.max_iterations = 10000;
    s->model.grain = 8;
    s->material.name = "test";
    s->cloth.name = "test";
    s->cloth.pins = &s->pin;
    s->cloth.loads = &s->load;
}

void setup_sheet(struct setup *s, uint32_t n)
{
    struct cloth_error error = {0};
    memset(s, 0, sizeof *s);
    setup_common(s);
    s->material.density = 0.2;
    s->material.stretch = 50;
    s->material.shear = 25;
    s->material.bend = 5;
    s->material.damping_stiffness = 0.01;
    if (mesh_grid(&s->cloth.mesh, 1, 1, n, n, MESH_SAME, &error))
        die(error.text);
}

void setup_mesh(struct setup *s, uint32_t n, const double *vertices, uint32_t n_edges,
                const uint32_t *edges, uint32_t n_triangles, const uint32_t *triangles)
{
    struct cloth_error error = {0};
    mesh_free(&s->cloth.mesh);
    if (mesh_inline(&s->cloth.mesh, n, vertices, n_edges, edges, n_triangles, triangles, &error))
        die(error.text);
}

void setup_weight(struct setup *s)
{
    static const double vertices[] = {0, 0, 0, 0, -1, 0};
    static const uint32_t edge[] = {0, 1};
    memset(s, 0, sizeof *s);
    setup_common(s);
    s->material.density = 1;
    s->material.ea = 40; /* of 1 m */
    s->material.damping_stiffness = 0.002;
    s->cloth.mass_per_vertex = 0.1;
    s->model.grain = 1;
    setup_mesh(s, 2, vertices, 1, edge, 0, NULL);
    setup_pin(s, 1, (const uint32_t[]){0});
}

void setup_chain(struct setup *s, uint32_t links, double x, double y, double mass, double stiffness)
{
    double *vertices = calloc(3 * ((size_t)links + 1), sizeof *vertices);
    uint32_t *edges = calloc(2 * (size_t)links, sizeof *edges);
    if (!vertices || !edges)
        die("out of memory");
    setup_weight(s);
    for (uint32_t i = 0; i <= links; i++) {
        vertices[3 * i] = x * i;
        vertices[3 * i + 1] = y * i;
    }
    for (uint32_t i = 0; i < 2 * links; i++)
        edges[i] = (i + 1) / 2;
    setup_mesh(s, links + 1, vertices, links, edges, 0, NULL);
    s->cloth.mass_per_vertex = mass;
    s->material.ea = stiffness * hypot(x, y);
    s->material.damping_stiffness = 0;
    free(vertices);
    free(edges);
}

void setup_masses(const struct setup *s, double *mass)
{
    mesh_add_mass(&s->cloth.mesh, s->material.density, true, mass);
}

void setup_pin(struct setup *s, uint32_t n, const uint32_t *vertices)
{
    memcpy(s->pinned, vertices, n * sizeof *vertices);
    s->pin.pick.kind = MODEL_PICK_VERTICES;
    s->pin.pick.n_vertices = n;
    s->pin.pick.vertices = s->pinned;
    s->cloth.n_pins = 1;
}

void setup_load(struct setup *s, uint32_t vertex, double x, double y, double z)
{
    s->loaded[0] = vertex;
    s->load =
        (struct model_load){.pick = {.n_vertices = 1, .vertices = s->loaded}, .force = {x, y, z}};
    s->cloth.n_loads = 1;
}

void setup_free(struct setup *s)
{
    mesh_free(&s->cloth.mesh);
}

static int keep_frame(void *context, uint64_t frame, double time, const double *position,
                      struct cloth_error *error)
{
    struct record *r = context;
    if (frame > 0 && frame == r->break_frame)
        return cloth_fail(error, CLOTH_E_IO, "the disk is full: %0300d x, that is where", 0);
    if (frame != r->frames)
        die("frames out of order");
    const size_t size = 3 * r->vertices * sizeof *position;
    r->position = realloc(r->position, (r->frames + 1) * size);
    r->time = realloc(r->time, (r->frames + 1) * sizeof *r->time);
    if (!r->position || !r->time)
        die("out of memory");
    memcpy(r->position + 3 * r->vertices * r->frames, position, size);
    r->time[r->frames++] = time;
    return CLOTH_OK;
}

static void show_step(void *context, uint64_t step, uint64_t steps, uint64_t iterations)
{
    struct record *r = context;
    (void)steps;
    (void)iterations;
    if (step != r->shown + 1 && step != r->shown) /* which a shorter one belongs to */
        die("steps out of order");
    r->shown = step;
}

static int ask_stop(void *context)
{
    const struct record *r = context;
    return r->stop_after > 0 && r->shown >= r->stop_after;
}

static void end_mpi(void)
{
    MPI_Finalize();
}

static void begin_mpi(void)
{
    int begun = 0, provided = 0;
    MPI_Initialized(&begun);
    if (begun)
        return;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided))
        die("MPI does not start");
    if (rank_said()) /* alone, MPI may stay: what it leaks can then be told from
                                           ours */
        atexit(end_mpi);
}

/* The code and sentence of rank 0's preparation, on all ranks, as a program would tell them. */
static void agree(struct record *r)
{
    MPI_Bcast(&r->code, 1, MPI_INT, 0, MPI_COMM_WORLD);
    MPI_Bcast(&r->error, sizeof r->error, MPI_BYTE, 0, MPI_COMM_WORLD);
}

/* Tells all ranks the counts that rank 0 alone was told. */
static void share(struct record *r)
{
    uint64_t counts[2] = {r->frames, r->shown};
    MPI_Bcast(counts, 2, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    r->shown = counts[1];
    if (!r->position && counts[0]) {
        r->frames = counts[0];
        r->position = malloc(3 * r->vertices * r->frames * sizeof *r->position);
        r->time = malloc(r->frames * sizeof *r->time);
        if (!r->position || !r->time)
            die("out of memory");
    }
    MPI_Bcast(r->position, (int)(3 * r->vertices * r->frames), MPI_DOUBLE, 0, MPI_COMM_WORLD);
    MPI_Bcast(r->time, (int)r->frames, MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

static void run_prepared(struct record *r, struct flow *flow)
{
    const struct flow_output output = {.context = r, .frame = keep_frame};
    const struct flow_progress progress = {.context = r, .step = show_step, .stop = ask_stop};
    duite_options options = duite_options_default();
    duite *rt = NULL;
    options.kernels = flow_kernels();
    options.context = flow;
    options.threads = r->threads ? r->threads : 1;
    options.bind = 0;
    if (r->balance)
        options.balance = duite_balancer_find(r->balance);
    if (duite_start(&rt, &options))
        die(duite_message());
    r->vertices = flow_vertices(flow);
    r->code = flow_run(flow, rt, &output, &progress, &r->report, &r->error);
    r->vertices = flow_vertices(flow);
    if (duite_stop(&rt))
        die(duite_message());
    share(r);
}

void record_mpi(int *rank, int *ranks)
{
    begin_mpi();
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, ranks);
}

void record_run(struct record *r, const struct model *model)
{
    struct flow *flow = NULL;
    int rank, ranks;
    record_mpi(&rank, &ranks);
    r->code = rank ? flow_join(&flow, &r->error) : flow_prepare(&flow, model, ranks, &r->error);
    agree(r);
    if (!r->code)
        run_prepared(r, flow);
    flow_free(flow);
}

void record_fine(struct record *r, const struct model *model)
{
    record_run(r, model);
    ck_assert_msg(r->code == 0, "%s", r->error.text);
}

double record_at(const struct record *r, size_t frame, size_t vertex, size_t c)
{
    if (frame >= r->frames || vertex >= r->vertices)
        die("no such frame or vertex");
    return r->position[3 * (r->vertices * frame + vertex) + c];
}

double record_farthest(const struct record *a, const struct record *b)
{
    double max = 0;
    ck_assert_uint_eq(a->frames, b->frames);
    ck_assert_uint_eq(a->vertices, b->vertices);
    for (size_t i = 0; i < 3 * a->frames * a->vertices; i++)
        max = fmax(max, fabs(a->position[i] - b->position[i]));
    return max;
}

void record_free(struct record *r)
{
    free(r->position);
    free(r->time);
    memset(r, 0, sizeof *r);
}
