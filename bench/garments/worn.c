/* A T-shirt as it is worn, and what finding and certifying its contacts costs. dressing.yaml is run
 * once, with shorter steps since it has more vertices than the scene; the end of its last frame is
 * welded, and each triangle cut in four. The mesh is kept in the folder of the states. */
#include "bench/garments/garments.h"

#include "bench/cg/cg.h"
#include "bench/contact/contact.h"
#include "bench/program.h"
#include "bench/sets.h"
#include "cloth/mesh/mesh.h"
#include "cloth/scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH = 4200, VERTICES = 9150, QUICK_VERTICES = 800 };

#define PULLED "gravity: [0, 0, 0], time.h: 0.01"
#define PHASES                                                                                     \
    "--set 'phases[0].set={" PULLED ", time.end: 1.2}' --set 'phases[1].set={" PULLED              \
    ", time.end: 1, time.sewn: {distance: 0.0025}, \"cloths[0].seams.stiffness\": 3000}' --set "   \
    "phases[2].set.time.h=0.02"
/* With --quick: panels on their way. */
#define QUICK_PHASES "--set 'phases=[{name: sew, set: {gravity: [0, 0, 0], time.end: 0.06}}]'"

static int fail(const char *what)
{
    fprintf(stderr, "duite-bench: the T-shirt as it is worn: %s\n", what);
    return 1;
}

/* ---- A mesh in four times as many triangles ---- */

struct place {
    float x[3];
    uint32_t vertex;
};

static int compare_places(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    for (int c = 0; c < 3; c++)
        if (x->x[c] < y->x[c] || y->x[c] < x->x[c])
            return x->x[c] < y->x[c] ? -1 : 1;
    return (x->vertex > y->vertex) - (x->vertex < y->vertex);
}

/* Welds what is at one place: triangles get the lowest number there. */
static int weld(struct mesh *mesh, const double *x)
{
    const uint32_t n = mesh->n_vertices;
    struct place *place = calloc(n + 1, sizeof *place);
    uint32_t *name = calloc(n + 1, sizeof *name);
    for (uint32_t i = 0; place && i < n; i++) {
        place[i].vertex = i;
        for (int c = 0; c < 3; c++)
            place[i].x[c] = (float)x[3 * i + (uint32_t)c];
    }
    if (place)
        qsort(place, n, sizeof *place, compare_places);
    for (uint32_t i = 0; place && name && i < n; i++) {
        const bool again = i && !memcmp(place[i].x, place[i - 1].x, sizeof place->x);
        name[place[i].vertex] = again ? name[place[i - 1].vertex] : place[i].vertex;
    }
    for (size_t t = 0; name && t < 3 * (size_t)mesh->n_triangles; t++)
        mesh->triangle[t] = name[mesh->triangle[t]];
    const bool well = place && name;
    free(place);
    free(name);
    return well ? 0 : fail("no memory");
}

struct side {
    uint32_t end[2]; /* ascending */
    uint32_t of;     /* side of a triangle: 3 t + k, from corner k to the next */
};

static int compare_sides(const void *a, const void *b)
{
    const struct side *x = a, *y = b;
    const uint64_t p = (uint64_t)x->end[0] << 32 | x->end[1];
    const uint64_t q = (uint64_t)y->end[0] << 32 | y->end[1];
    return p < q || q < p ? (p < q ? -1 : 1) : (x->of > y->of) - (x->of < y->of);
}

static void list_sides(const struct mesh *mesh, struct side *side)
{
    const uint32_t n = 3 * mesh->n_triangles;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t a = mesh->triangle[i], b = mesh->triangle[i % 3 == 2 ? i - 2 : i + 1];
        side[i] = (struct side){{a < b ? a : b, a < b ? b : a}, i};
    }
    qsort(side, n, sizeof *side, compare_sides);
}

/* Vertices, those that are used first; then middles of edges. Numbers from 1, as files have them.
 */
static void write_vertices(const struct mesh *mesh, const double *x, const struct side *side,
                           uint32_t *number, uint32_t *middle, FILE *file)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < 3 * mesh->n_triangles; i++) {
        const uint32_t v = mesh->triangle[i];
        if (number[v])
            continue;
        number[v] = ++n;
        fprintf(file, "v %.17g %.17g %.17g\n", x[3 * v], x[3 * v + 1], x[3 * v + 2]);
    }
    for (uint32_t i = 0; i < 3 * mesh->n_triangles; i++) {
        const double *a = x + 3 * (size_t)side[i].end[0], *b = x + 3 * (size_t)side[i].end[1];
        const bool again = i && !memcmp(side[i].end, side[i - 1].end, sizeof side->end);
        middle[side[i].of] = again ? n : ++n;
        if (!again)
            fprintf(file, "v %.17g %.17g %.17g\n", (a[0] + b[0]) / 2, (a[1] + b[1]) / 2,
                    (a[2] + b[2]) / 2);
    }
}

static void write_triangles(const struct mesh *mesh, const uint32_t *number, const uint32_t *middle,
                            FILE *file)
{
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *corner = mesh->triangle + 3 * (size_t)t, *m = middle + 3 * (size_t)t;
        fprintf(file, "f %u %u %u\n", m[0], m[1], m[2]);
        for (int k = 0; k < 3; k++)
            fprintf(file, "f %u %u %u\n", number[corner[k]], m[k], m[(k + 2) % 3]);
    }
}

static int write_cut(const struct mesh *mesh, const double *x, const char *path)
{
    const size_t n = 3 * (size_t)mesh->n_triangles;
    struct side *side = calloc(n + 1, sizeof *side);
    uint32_t *number = calloc(mesh->n_vertices + (size_t)1, sizeof *number);
    uint32_t *middle = calloc(n + 1, sizeof *middle);
    FILE *file = fopen(path, "w");
    const bool well = side && number && middle && file;
    if (well) {
        list_sides(mesh, side);
        write_vertices(mesh, x, side, number, middle, file);
        write_triangles(mesh, number, middle, file);
    }
    free(side);
    free(number);
    free(middle);
    const bool closed = file && !fclose(file);
    return well && closed ? 0 : fail("its mesh cannot be written");
}

/* ---- Made once ---- */

static int dress(const struct bench_options *options, const char *folder)
{
    char command[3 * PATH], programs[PATH];
    program_folder(programs, sizeof programs);
    snprintf(command, sizeof command,
             "'%s/../duite-cloth' '%s/dressing.yaml' --quiet --threads %u --output '%s/dressed' "
             "--set 'cloths[0].mesh.pattern.vertices=%d' %s >&2",
             programs, BENCH_SCENES, options->threads, folder,
             options->quick ? QUICK_VERTICES : VERTICES, options->quick ? QUICK_PHASES : PHASES);
    return system(command) ? fail("duite-cloth does not put it on") : 0;
}

/* The last frame in that folder, cut. */
static int cut(const char *folder, const char *worn)
{
    char path[PATH + 40];
    struct mesh mesh = {0};
    struct cloth_error error = {0};
    double *x = NULL;
    uint32_t n_frames;
    snprintf(path, sizeof path, "%s/dressed/cloth.obj", folder);
    int code = mesh_read_obj(&mesh, path, &error);
    snprintf(path, sizeof path, "%s/dressed/cloth.pc2", folder);
    if (!code)
        code = mesh_read_pc2(path, mesh.n_vertices, MESH_LAST_FRAME, &n_frames, &x, &error);
    if (code || !x)
        code = fail(code ? error.text : "it has no frame");
    snprintf(path, sizeof path, "%s/new.obj", folder);
    code = code || weld(&mesh, x) || write_cut(&mesh, x, path);
    if (!code && rename(path, worn))
        code = fail("its mesh cannot be written");
    free(x);
    mesh_free(&mesh);
    return code;
}

static void worn_path(const char *of, char path[PATH])
{
    const char *folder = getenv(STATE_FOLDER);
    snprintf(path, PATH, "%s/%s.obj", folder ? folder : ".", of);
}

/* The figure without its first hundred faces: a surface with a hole. */
static int open_figure(const char *folder)
{
    char command[3 * PATH];
    snprintf(command, sizeof command,
             "awk '!/^f/ || ++n > 100' '%s/dressed/body-0.obj' > '%s/open.obj'", folder, folder);
    return system(command) ? fail("the figure with a hole cannot be written") : 0;
}

int garments_worn_make(const struct bench_options *options,
                       void (*say)(const char *key, const char *text))
{
    char path[PATH];
    int code = cg_make_folder(options);
    worn_path("worn", path);
    if (!code && access(path, R_OK)) {
        fprintf(stderr, "duite-bench: putting on the T-shirt that is worn\n");
        code = dress(options, getenv(STATE_FOLDER)) || cut(getenv(STATE_FOLDER), path) ||
               open_figure(getenv(STATE_FOLDER));
    }
    if (!code)
        say("worn", path);
    return code;
}

/* ---- Looks ---- */

#define HELD "pins: [{box: [[-1e5, -1e5, -1e5], [1e5, 1e5, 1e5]]}]"

static uint32_t n_worn; /* vertices */

static int read_worn(struct model *model, struct serve_request *request)
{
    char path[PATH], of[20];
    struct cloth_error error = {0};
    struct sets sets = {0};
    worn_path("worn", path);
    serve_word(request, "of", of, sizeof of);
    add_set(&sets, "cloths[0].mesh={file: '%s'}", path);
    add_set(&sets, "%s", strcmp(of, "self") ? "contact.self=off" : "obstacles=[]");
    if (!strcmp(of, "open_mesh")) {
        worn_path("open", path);
        add_set(&sets, "obstacles=[]");
        add_set(&sets, "cloths[1]={name: figure, mesh: {file: '%s'}, material: jersey, " HELD "}",
                path);
    }
    add_set(&sets, "%s", serve_number(request, "quick") ? "grain=100" : "");
    if (scene_read(model, BENCH_WORN_SCENE, sets.n, sets.set, &error))
        return serve_fail("%s", error.text);
    n_worn = model->cloths->mesh.n_vertices;
    return 0;
}

static int look(void *context, struct serve_request *request, double *value)
{
    char of[20];
    uint64_t n = 0;
    (void)context;
    serve_word(request, "of", of, sizeof of);
    int code = contact_state_look(request, read_worn, false, value, &n);
    *value /= n_worn;
    return !code && !n && strcmp(of, "self") ? serve_fail("wrong answer: nothing is near the body")
                                             : code;
}

const struct serve_run garments_worn_runs[] = {{"look", look}, {0}};

static void plan_worn(struct measure *measure, const struct bench_options *options)
{
    enum { BODY, SELF, OPEN, WORN_BY };
    static const char *const of[WORN_BY] = {"body", "self", "open_mesh"};
    const struct measure_series *time[WORN_BY];
    for (int i = 0; i < WORN_BY; i++) {
        time[i] = measure_series(measure, (struct subject_shape){"duite", 0, options->threads},
                                 "look of=%s times=%d ms=20 threads=%u scheduler=%s quick=%d",
                                 of[i], options->quick ? 2 : 10, options->threads,
                                 options->scheduler, options->quick);
        measure_value(measure, time[i], 1e9, "ns", "%s_ns_per_vertex", of[i]);
    }
    measure_ratio(measure, time[OPEN], time[BODY], "open_mesh_vs_body");
}

const struct bench_case garments_worn = {
    "worn",
    "what a step does to find contacts and to certify it, for each vertex of a T-shirt of 35,000 "
    "as it is worn: boxes, certificates, what is near; the shirt with the body, with "
    "itself, and with the body as a surface with a hole",
    plan_worn, garments_worn_runs, 8};
