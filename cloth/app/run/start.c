/* Welded vertices are one point for untangling, and move together. */
#include "cloth/app/run/start.h"

#include "cloth/app/check/intersections.h"
#include "cloth/app/run/phases.h"
#include "cloth/base/memory.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* The cloths as they are untangled; all by vertex of all cloths. */
struct tangle {
    uint32_t n;
    struct contact_soup soup;
    double (*start)[6];
    phys_vec *x;
    unsigned char *held, *held_point; /* by name; by the lowest name */
    uint32_t *layer;                  /* by cloth */
    struct contact_apart apart;       /* as of the model and the flow */
};

static void free_tangle(struct tangle *tangle)
{
    contact_soup_free(&tangle->soup);
    free(tangle->start);
    free(tangle->x);
    free(tangle->held);
    free(tangle->held_point);
    free(tangle->layer);
}

static int run_start_make_room(struct tangle *to, const struct model *model,
                               struct cloth_error *error)
{
    to->n = model_first(model, model->n_cloths);
    to->start = cloth_alloc(to->n, sizeof *to->start, error);
    to->x = aligned_alloc(sizeof *to->x, ((size_t)to->n + 1) * sizeof *to->x);
    to->held = cloth_alloc(to->n, 1, error);
    to->held_point = cloth_alloc(to->n, 1, error);
    to->layer = cloth_alloc(model->n_cloths, sizeof *to->layer, error);
    if (!to->x)
        cloth_fail(error, CLOTH_E_MEMORY, "out of memory for where the run starts");
    return error->code ? error->code : model_soup(model, &to->soup, error);
}

static void run_start_take_cloths(const struct model *model, const struct flow *flow,
                                  struct tangle *to)
{
    const uint32_t *same = to->soup.same;
    flow_starts(flow, to->start, to->held);
    to->apart = model->contact.apart;
    to->apart.attached = flow_attached(flow);
    to->apart.n_vertices = to->n;
    for (uint32_t v = 0; v < to->n; v++) {
        const double *start = to->start[same[v]];
        to->x[v] = (phys_vec){start[0], start[1], start[2], 0};
        to->held_point[same[v]] |= to->held[v];
    }
    for (uint32_t c = 0; c < model->n_cloths; c++)
        to->layer[c] = model->cloths[c].layer;
}

/* ---- Progress ---- */

static void say_round(void *context, uint32_t round, const struct untangle_count *count)
{
    const bool *says = context;
    const bool terminal = isatty(STDERR_FILENO) == 1;
    if (!*says || (!terminal && round % 10))
        return;
    fprintf(stderr,
            "%sduite-cloth: untangling, round %" PRIu32 ": %" PRIu64 " pairs intersect, %" PRIu64
            " are too near, %" PRIu64 " places in obstacles, %" PRIu64 " in the wrong layer%s",
            terminal ? "\r\033[K" : "", round, count->pairs, count->near, count->entered,
            count->layers, terminal ? "" : "\n");
}

static void say_result(const struct untangle_result *result)
{
    const bool terminal = isatty(STDERR_FILENO) == 1;
    fprintf(stderr,
            "%sduite-cloth: the start is untangled: %" PRIu32 " rounds moved %" PRIu64
            " vertices, by %.3g m at most\n",
            terminal ? "\r\033[K" : "", result->rounds, result->moved, result->largest);
}

/* ---- Results ---- */

/* A point of those that are untangled; those of bodies follow the cloths' vertices. */
static void name_point(const struct model *model, uint32_t n, uint32_t point, char *text,
                       size_t size)
{
    uint32_t c = 0;
    if (point >= n) {
        snprintf(text, size, " one of a body");
        return;
    }
    while (point - model_first(model, c) >= model->cloths[c].mesh.n_vertices)
        c++;
    snprintf(text, size, " %" PRIu32 " of '%.40s'", point - model_first(model, c) + 1,
             model->cloths[c].name);
}

/* An edge that became so many times as long is warned of. */
static const double MUCH_STRETCH = 3;

static void warn_of_stretch(const struct model *model, const struct untangle_result *result)
{
    const uint32_t n = model_first(model, model->n_cloths);
    char end[2][80];
    if (!(result->stretch >= MUCH_STRETCH))
        return;
    for (int k = 0; k < 2; k++)
        name_point(model, n, result->stretched[k], end[k], sizeof end[k]);
    fprintf(stderr,
            "duite-cloth: warning: contact.untangle made the edge between vertices%s and%s %.3g "
            "times as long (vertices count from 1): move the cloth there nearer to where it is "
            "free\n",
            end[0], end[1], result->stretch);
}

/* Out is told by the triangles of the inner cloth. */
static void warn_of_turned(const struct model *model, const struct untangle_result *result)
{
    const uint32_t n = model_first(model, model->n_cloths);
    for (uint32_t i = 0; i < result->n_turned && i < UNTANGLE_TURNED; i++) {
        const struct untangle_turned *turned = result->turned + i;
        const char *outer = model->cloths[turned->outer].name;
        char point[80];
        name_point(model, n, turned->point, point, sizeof point);
        fprintf(stderr,
                "duite-cloth: warning: contact.untangle: the part of %" PRIu32
                " vertices with vertex%s (counted from 1) faces away from '%.40s', whose layer is "
                "higher, and which goes through it; if that part is inside out, turn its faces "
                "round\n",
                turned->n, point, outer);
    }
    if (result->n_turned > UNTANGLE_TURNED)
        fprintf(stderr, "duite-cloth: warning: contact.untangle: and %" PRIu32 " such parts more\n",
                result->n_turned - UNTANGLE_TURNED);
}

/* Pairs that intersect start_check names. */
static int run_start_refuse(const struct model *model, const struct untangle_result *result,
                            struct cloth_error *error)
{
    const struct untangle_count *left = &result->left;
    char near[4][80] = {""};
    for (int k = 0; k < 4 && left->near; k++)
        name_point(model, model_first(model, model->n_cloths), result->near[k], near[k],
                   sizeof near[k]);
    return cloth_fail(error, CLOTH_E_INPUT,
                      "contact.untangle: after %" PRIu32 " rounds %" PRIu64
                      " pairs of triangles still go through each other, %" PRIu64
                      " places are in obstacles, %" PRIu64 " in the wrong layer, and %" PRIu64
                      " pairs of features are nearer than a tenth of the thickness%s%s%s%s%s: "
                      "move them apart where the scene has them",
                      result->rounds, left->pairs, left->entered, left->layers, left->near,
                      left->near ? ", the first of them at vertices" : "", near[0], near[1],
                      near[2], near[3]);
}

static int look_at_start(const struct model *model, const struct contact_apart *apart,
                         const double *position, bool written, struct intersections_found *found,
                         struct cloth_error *error)
{
    struct intersections *intersections = NULL;
    const struct intersections_setup of = {
        .program = "duite-cloth", .apart = apart, .self_off = !model->contact.self, .found = found};
    *found = (struct intersections_found){0};
    int code = intersections_of(&intersections, model, of, error);
    code = code ? code : intersections_frame(intersections, 0, 0, position, written, error);
    intersections_close(&intersections);
    return code;
}

/* Names the first pairs of where it got to. */
static int name_pairs(const struct model *model, const struct tangle *of, struct cloth_error *error)
{
    struct intersections_found found;
    double *position = cloth_alloc(of->n, 3 * sizeof *position, error);
    if (!position)
        return CLOTH_E_MEMORY;
    for (uint32_t v = 0; v < of->n; v++)
        for (size_t k = 0; k < 3; k++)
            position[3 * (size_t)v + k] = of->x[of->soup.same[v]][k];
    const int code = look_at_start(model, &of->apart, position, false, &found, error);
    free(position);
    return code;
}

static int make_free(struct model *model, struct flow **flow, int ranks, bool says,
                     struct tangle *tangle, struct untangle_result *result,
                     struct cloth_error *error)
{
    const struct untangle_cloths cloths = {.soup = &tangle->soup,
                                           .layer = tangle->layer,
                                           .held = tangle->held_point,
                                           .apart = &tangle->apart,
                                           .self_off = !model->contact.self,
                                           .thickness = model->contact.thickness,
                                           .obstacles = model->obstacles,
                                           .keys = model->keys,
                                           .bodies = &model->bodies};
    const struct untangle_listener listener = {&says, say_round};
    int code = untangle(&cloths, tangle->x, &listener, result, error);
    if (!code)
        warn_of_turned(model, result);
    if (!code && untangle_faults(&result->left)) {
        code = name_pairs(model, tangle, error);
        return code ? code : run_start_refuse(model, result, error);
    }
    if (code || !result->moved)
        return code;
    if (says)
        say_result(result);
    warn_of_stretch(model, result);
    for (uint32_t v = 0; v < tangle->n; v++)
        for (int k = 0; k < 3; k++)
            tangle->start[v][k] = tangle->x[tangle->soup.same[v]][k];
    code = phases_start_at(model, tangle->start, error);
    flow_free(*flow);
    *flow = NULL;
    return code ? code : flow_prepare(flow, model, ranks, error);
}

int start_untangle(struct model *model, struct flow **flow, int ranks, bool says,
                   struct untangle_result *result, struct cloth_error *error)
{
    struct tangle tangle = {0};
    *result = (struct untangle_result){0};
    if (!model_promise(model).apart || !model->contact.untangle)
        return CLOTH_OK;
    int code = run_start_make_room(&tangle, model, error);
    if (!code) {
        run_start_take_cloths(model, *flow, &tangle);
        code = make_free(model, flow, ranks, says, &tangle, result, error);
    }
    free_tangle(&tangle);
    return code;
}

/* Refuses a start of which triangles go through others; written: in frame 0, which is in floats. */
static int check_places(const struct model *model, const struct contact_apart *apart,
                        const double *position, bool written, const char *scene,
                        struct cloth_error *error)
{
    struct intersections_found found;
    const int code = look_at_start(model, apart, position, written, &found, error);
    if (code || !found.bad)
        return code;
    if (written)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: where the run starts %" PRIu64 " pairs of triangles and %" PRIu64
                          " with obstacles are so near to each other that frames, whose numbers "
                          "are floats, have them in one place: %s",
                          scene, found.pairs, found.with_shapes, model_start_cure(model));
    return cloth_fail(
        error, CLOTH_E_INPUT,
        "%s: where the run starts %" PRIu64 " pairs of triangles go through each other and %" PRIu64
        " through obstacles; contact.mode certified needs a start where none "
        "does: %s%s",
        scene, found.pairs, found.with_shapes, model_start_cure(model), model_contact_cure(model));
}

int start_check(const struct model *model, const struct flow *flow,
                const struct contact_apart *apart, const char *scene, struct cloth_error *error)
{
    if (!model_promise(model).apart)
        return CLOTH_OK;
    double *position = cloth_alloc(flow_vertices(flow), 3 * sizeof *position, error);
    if (!position)
        return CLOTH_E_MEMORY;
    flow_start(flow, position);
    int code = check_places(model, apart, position, false, scene, error);
    code = code ? code : check_places(model, apart, position, true, scene, error);
    free(position);
    return code ? code : start_welds(model, flow, apart, scene, error);
}
