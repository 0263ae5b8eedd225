/* Welds of seams move partners to their mean before the first step. It is a way as that of a step
 * is: straight, and certified. The skin here has every vertex by its own name, since partners come
 * from different places, so no skin of the run serves. Pairs none of whose corners move are free by
 * the state that the run starts from. Each triangle stands for all its features, which meets some
 * pairs more than once: their verdict is the same. */
#include "cloth/app/run/start.h"

#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/contact/body_skin.h"
#include "cloth/contact/certificate.h"
#include "cloth/contact/solid.h"
#include "cloth/contact/soup.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double REACH = 10 * CONTACT_MARGIN; /* m: pairs farther apart all the way do not touch
                                                  */
enum { MOST_PARTS = 16 };                        /* of a way, certified one after the other */
enum { ALL_FEATURES = 63 };

struct motion {
    const struct model *model;
    const struct contact_apart *apart;
    struct contact_soup soup;
    uint32_t n, n_triangles; /* of its cloths */
    phys_vec *x, *y;         /* by vertex, m: before, and after */
    uint32_t *id, *joined;   /* joined: the soup's, with seams that are pulled */
    unsigned char *stands, *held;
    struct contact_skin skin;
    struct contact_side side;
    void *table, *boxes;
    /* The obstacle that is looked at; NULL: cloth. */
    const struct contact_side *body;
    uint32_t obstacle;
    bool fails;
    uint32_t vertex[4], n_vertices; /* the first that fails: those of cloth */
    uint32_t with;                  /* then: obstacle from 1; 0: cloth */
};

static bool moves(const struct motion *motion, uint32_t v)
{
    bool differs = false;
    for (int c = 0; c < 3; c++)
        differs = differs || motion->x[v][c] < motion->y[v][c] || motion->x[v][c] > motion->y[v][c];
    return differs;
}

static void start_welds_fail(struct motion *motion, uint32_t n, const uint32_t *vertex)
{
    if (motion->fails)
        return;
    memcpy(motion->vertex, vertex, n * sizeof *vertex);
    motion->n_vertices = n;
    motion->with = motion->obstacle;
    motion->fails = true;
}

/* The place at part k of n of a way: where one part ends the next begins, to the bit. */
static void place_at(const phys_vec *x, const phys_vec *y, int k, int n, phys_vec *to)
{
    *to = k == n ? *y : *x + (double)k / n * (*y - *x);
}

/* ---- Pairs of features ---- */

static bool passes(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4])
{
    bool all = false;
    for (int n = 1; n <= MOST_PARTS && !all; n *= 4) {
        all = true;
        for (int part = 0; part < n && all; part++) {
            phys_vec from[4], to[4];
            for (int k = 0; k < 4; k++) {
                place_at(x + k, y + k, part, n, from + k);
                place_at(x + k, y + k, part + 1, n, to + k);
            }
            all = contact_certify(pair, from, to, 0);
        }
    }
    return all;
}

static bool start_welds_meets(const struct motion *motion, uint32_t n, const uint32_t *vertex)
{
    const struct model *model = motion->model;
    const uint32_t cloth = contact_soup_cloth(&motion->soup, vertex[0]);
    if (motion->obstacle)
        return model_meets(model, cloth, model->n_cloths + motion->obstacle - 1) &&
               !contact_is_attached(motion->apart, n, vertex, motion->obstacle - 1);
    return model_meets(model, cloth, contact_soup_cloth(&motion->soup, vertex[n - 1]));
}

static void start_welds_look_at(struct motion *motion, const struct contact_candidate *candidate)
{
    const struct contact_skin *other = motion->body ? motion->body->skin : &motion->skin;
    uint32_t point[4], vertex[4], n = 0;
    unsigned char side[4];
    phys_vec x[4], y[4];
    bool moving = false;
    const enum contact_pair pair =
        contact_candidate_corners(&motion->skin, other, candidate, point, side);
    for (int k = 0; k < 4; k++) {
        const bool of_body = motion->body && side[k];
        x[k] = of_body ? motion->body->x[point[k]] : motion->x[point[k]];
        y[k] = of_body ? motion->body->y[point[k]] : motion->y[point[k]];
        moving = moving || (!of_body && moves(motion, point[k]));
        if (!of_body)
            vertex[n++] = point[k];
    }
    if (moving && start_welds_meets(motion, n, vertex) && !passes(pair, x, y))
        start_welds_fail(motion, n, vertex);
}

static void start_welds_visit(void *to, uint32_t n, const struct contact_candidate *candidate)
{
    for (uint32_t i = 0; i < n; i++)
        start_welds_look_at(to, candidate + i);
}

/* ---- Obstacles ---- */

static int start_welds_look_at_body(struct motion *motion, const struct contact_body *body,
                                    const struct contact_pose *pose, struct cloth_error *error)
{
    const size_t n = body->n_vertices;
    const phys_vec none = {0};
    phys_vec way, *x = aligned_alloc(sizeof *x, n * sizeof *x);
    phys_vec *y = aligned_alloc(sizeof *y, n * sizeof *y);
    void *table = aligned_alloc(CONTACT_ALIGN, contact_body_skin_bytes(body));
    void *boxes = aligned_alloc(CONTACT_ALIGN, contact_body_boxes_bytes(body));
    int code = x && y && table && boxes
                   ? contact_body_skin_make(body, motion->n, table, error)
                   : cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a body");
    if (!code) {
        const struct contact_skin skin = contact_skin_open(table);
        const struct contact_side side = {.skin = &skin, .boxes = boxes, .x = x, .y = x};
        contact_body_ends(body, pose, x, y, &way);
        contact_refit(&skin, x, x, &none, boxes);
        motion->body = &side;
        contact_query(&motion->side, &side, REACH, start_welds_visit, motion);
        motion->body = NULL;
    }
    free(x);
    free(y);
    free(table);
    free(boxes);
    return code;
}

static void look_at_solid(struct motion *motion, const struct contact_shape *shape,
                          const struct contact_pose *pose)
{
    struct contact_solid solid;
    contact_solid_make(shape, pose, &solid);
    for (uint32_t t = 0; t < motion->n_triangles; t++) {
        const uint32_t *v = motion->soup.corner[t];
        const phys_vec x[3] = {motion->x[v[0]], motion->x[v[1]], motion->x[v[2]]};
        const phys_vec y[3] = {motion->y[v[0]], motion->y[v[1]], motion->y[v[2]]};
        const bool moving = moves(motion, v[0]) || moves(motion, v[1]) || moves(motion, v[2]);
        if (moving && start_welds_meets(motion, 3, v) && !contact_solid_certify(&solid, x, y, 0))
            start_welds_fail(motion, 3, v);
    }
}

static int look_at_obstacles(struct motion *motion, struct cloth_error *error)
{
    const struct model *model = motion->model;
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < model->n_obstacles && !code; i++) {
        const struct contact_shape *shape = model->obstacles + i;
        const struct contact_body *body = contact_bodies_at(&model->bodies, shape->body);
        struct contact_pose pose;
        contact_pose_over(shape, model->keys, &model->bodies, 0, 0, &pose);
        motion->obstacle = i + 1;
        if (body)
            code = start_welds_look_at_body(motion, body, &pose, error);
        else
            look_at_solid(motion, shape, &pose);
    }
    return code;
}

/* ---- The cloths ---- */

static int start_welds_make_room(struct motion *motion, struct cloth_error *error)
{
    const struct model *model = motion->model;
    if (model_soup(model, &motion->soup, error))
        return error->code;
    motion->n = contact_soup_cloths(&motion->soup).point;
    motion->n_triangles = contact_soup_cloths(&motion->soup).triangle;
    motion->joined = motion->soup.same;
    motion->x = aligned_alloc(sizeof(phys_vec), (motion->n + (size_t)1) * sizeof *motion->x);
    motion->y = aligned_alloc(sizeof(phys_vec), (motion->n + (size_t)1) * sizeof *motion->y);
    if (!motion->x || !motion->y)
        cloth_fail(error, CLOTH_E_MEMORY, "out of memory for where seams are welded");
    motion->stands = cloth_alloc(motion->n_triangles, 1, error);
    motion->id = cloth_alloc(motion->n, sizeof *motion->id, error);
    motion->held = cloth_alloc(motion->n, 1, error);
    return error->code;
}

/* Returns true if anything moves. */
static bool start_welds_take_places(struct motion *motion, const double (*before)[3],
                                    const double *after)
{
    bool any = false;
    for (uint32_t v = 0; v < motion->n; v++) {
        const double *y = after + 3 * (size_t)v;
        motion->x[v] = (phys_vec){before[v][0], before[v][1], before[v][2], 0};
        motion->y[v] = (phys_vec){y[0], y[1], y[2], 0};
        motion->id[v] = v;
        if (motion->apart->joined)
            cloth_sets_join(motion->joined, v, motion->apart->joined[v]);
        any = any || moves(motion, v);
    }
    for (uint32_t v = 0; v < motion->n; v++)
        motion->joined[v] = cloth_sets_root(motion->joined, v);
    return any;
}

static int start_welds_make_skin(struct motion *motion, struct cloth_error *error)
{
    const phys_vec none = {0};
    const struct contact_skin counts = {.n_points = motion->n,
                                        .n_triangles = motion->n_triangles,
                                        .n_edges = 3 * motion->n_triangles,
                                        .n_vertices = 3 * motion->n_triangles};
    const struct contact_skin_source from = {.n_points = motion->n,
                                             .n_triangles = motion->n_triangles,
                                             .corner = (const uint32_t(*)[3])motion->soup.corner,
                                             .stands = motion->stands,
                                             .id = motion->id,
                                             .joined = motion->joined,
                                             .held = motion->held,
                                             .x = motion->x};
    motion->table = aligned_alloc(CONTACT_ALIGN, contact_skin_bytes(&counts));
    motion->boxes = aligned_alloc(CONTACT_ALIGN, contact_boxes_bytes(&counts));
    if (!motion->table || !motion->boxes)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for where seams are welded");
    const int code = contact_skin_make(&from, motion->table, error);
    if (code)
        return code;
    motion->skin = contact_skin_open(motion->table);
    motion->side = (struct contact_side){
        .skin = &motion->skin, .boxes = motion->boxes, .x = motion->x, .y = motion->y};
    contact_refit(&motion->skin, motion->x, motion->y, &none, motion->boxes);
    return CLOTH_OK;
}

static int start_welds_refuse(const struct motion *motion, const char *scene,
                              struct cloth_error *error)
{
    const struct model *model = motion->model;
    char vertices[200] = "", with[60] = "the cloth";
    size_t used = 0;
    for (uint32_t k = 0; k < motion->n_vertices && used < sizeof vertices; k++) {
        const uint32_t c = contact_soup_cloth(&motion->soup, motion->vertex[k]);
        used += (size_t)snprintf(
            vertices + used, sizeof vertices - used, "%s%" PRIu32 " of '%.30s'", k ? ", " : "",
            motion->vertex[k] - model_first(model, c) + 1, model->cloths[c].name);
    }
    if (motion->with)
        snprintf(with, sizeof with, "obstacles[%" PRIu32 "]", motion->with - 1);
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s: the welds of seams would move cloth through %s, or nothing proves that "
                      "they do not, at vertices %s (counted from 1): pull partners nearer to each "
                      "other before they are welded (time.sewn.distance)",
                      scene, with, vertices);
}

static void free_all(struct motion *motion)
{
    free(motion->x);
    free(motion->y);
    contact_soup_free(&motion->soup);
    free(motion->id);
    free(motion->stands);
    free(motion->held);
    free(motion->table);
    free(motion->boxes);
}

static int certify(struct motion *motion, const struct flow *flow, const char *scene,
                   struct cloth_error *error)
{
    double *after = cloth_alloc(flow_vertices(flow), 3 * sizeof *after, error);
    int code = after ? start_welds_make_room(motion, error) : CLOTH_E_MEMORY;
    if (!code)
        flow_start(flow, after);
    const bool any = !code && start_welds_take_places(motion, flow_unwelded(flow), after);
    free(after);
    if (!any)
        return code;
    memset(motion->stands, ALL_FEATURES, motion->n_triangles);
    code = start_welds_make_skin(motion, error);
    if (code)
        return code;
    contact_query(&motion->side, &motion->side, REACH, start_welds_visit, motion);
    code = look_at_obstacles(motion, error);
    return code || !motion->fails ? code : start_welds_refuse(motion, scene, error);
}

int start_welds(const struct model *model, const struct flow *flow,
                const struct contact_apart *apart, const char *scene, struct cloth_error *error)
{
    struct motion motion = {.model = model, .apart = apart};
    if (model->contact.untangle || !flow_unwelded(flow))
        return CLOTH_OK;
    const int code = certify(&motion, flow, scene, error);
    free_all(&motion);
    return code;
}
