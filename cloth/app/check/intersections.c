/* A frame places the vertices of the cloths; the time of the frame places those of bodies. A frame
 * counts as bad once, even if it is checked as doubles and as written. */
#include "cloth/app/check/intersections.h"

#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/contact/soup.h"
#include "cloth/model/model.h"
#include "cloth/verify/orient.h"
#include "cloth/verify/verify.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SAID = 5 }; /* intersections of the first frame that has any */
static const uint32_t NO_PART = UINT32_MAX;

/* The soup of triangles, and what is known of it before the first frame. */
struct intersections {
    struct intersections_setup of;
    struct contact_soup soup;
    phys_vec *place;     /* room for the vertices of a body */
    uint32_t *part;      /* by point of cloth: the lowest that triangles join it to, directly or
                          * through others; NO_PART: no triangle has it */
    unsigned char *seen; /* by part, while a body is looked at: a vertex of it was */
    double (*x)[3];
    uint32_t *sewn;             /* by point: as of struct verify_soup; NULL: no seams are pulled */
    struct verify_soup checked; /* the soup, welded, with its places */
    struct cloth_list pairs, entered;
    uint64_t last; /* the last frame that had any; UINT64_MAX: none had */
};

/* A frame that is looked at. */
struct look {
    struct intersections *all;
    uint64_t frame, n; /* n: how much was found in it */
    double time;       /* s, as it is printed, and */
    double placed;     /* of motions and bodies */
    bool written;
    bool says; /* it prints findings */
};

/* ---- Opening ---- */

static int take_arrays(struct intersections *all, struct cloth_error *error)
{
    const struct contact_surface cloths = contact_soup_cloths(&all->soup),
                                 end = contact_soup_all(&all->soup);
    all->x = cloth_alloc(end.point, sizeof *all->x, error);
    all->seen = cloth_alloc(cloths.point, sizeof *all->seen, error);
    all->place = aligned_alloc(sizeof *all->place,
                               (end.point - cloths.point + (size_t)1) * sizeof *all->place);
    if (!all->place)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the vertices of bodies");
    all->checked = (struct verify_soup){.n_points = end.point,
                                        .n_triangles = end.triangle,
                                        .n_first = cloths.triangle,
                                        .x = (const double(*)[3])all->x,
                                        .corner = (const uint32_t(*)[3])all->soup.welded};
    return error->code;
}

/* Vertices that seams or welds join share one number. */
static int check_take_sewn(struct intersections *all, struct cloth_error *error)
{
    const uint32_t *joined = all->of.apart->joined, n = contact_soup_cloths(&all->soup).point;
    if (!joined)
        return CLOTH_OK;
    all->sewn = cloth_alloc(all->checked.n_points, sizeof *all->sewn, error);
    if (!all->sewn)
        return CLOTH_E_MEMORY;
    cloth_sets_start(all->sewn, all->checked.n_points);
    for (uint32_t v = 0; v < n; v++) {
        cloth_sets_join(all->sewn, v, joined[v]);
        cloth_sets_join(all->sewn, v, all->soup.same ? all->soup.same[v] : v);
    }
    for (uint32_t v = 0; v < n; v++)
        all->sewn[v] = cloth_sets_root(all->sewn, v);
    all->checked.joined = all->sewn;
    return CLOTH_OK;
}

static int find_parts(struct intersections *all, struct cloth_error *error)
{
    const struct contact_surface cloths = contact_soup_cloths(&all->soup);
    bool *used = cloth_alloc(cloths.point, sizeof *used, error);
    all->part = cloth_alloc(cloths.point, sizeof *all->part, error);
    if (used && all->part)
        cloth_sets_start(all->part, cloths.point);
    for (uint32_t t = 0; t < cloths.triangle && used && all->part; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t *corner = all->soup.welded[t];
            cloth_sets_join(all->part, corner[k], corner[0]);
            used[corner[k]] = true;
        }
    for (uint32_t v = 0; v < cloths.point && used && all->part; v++)
        all->part[v] = used[v] ? cloth_sets_root(all->part, v) : NO_PART;
    free(used);
    return error->code;
}

int intersections_open(struct intersections **intersections, const struct intersections_setup *of,
                       struct contact_soup *soup, struct cloth_error *error)
{
    struct intersections *all = *intersections = cloth_alloc(1, sizeof *all, error);
    if (!all) {
        contact_soup_free(soup);
        return CLOTH_E_MEMORY;
    }
    all->of = *of;
    all->last = UINT64_MAX;
    all->soup = *soup;
    *soup = (struct contact_soup){0};
    int code = take_arrays(all, error);
    code = code ? code : check_take_sewn(all, error);
    code = code ? code : find_parts(all, error);
    if (code)
        intersections_close(intersections);
    return code;
}

int intersections_of(struct intersections **intersections, const struct model *model,
                     struct intersections_setup of, struct cloth_error *error)
{
    struct contact_soup soup;
    of.model = model;
    of.obstacles = model->obstacles;
    of.keys = model->keys;
    of.bodies = &model->bodies;
    int code = model_soup(model, &soup, error);
    code = code ? code : intersections_open(intersections, &of, &soup, error);
    contact_soup_free(&soup);
    return code;
}

void intersections_close(struct intersections **intersections)
{
    struct intersections *all = *intersections;
    *intersections = NULL;
    if (!all)
        return;
    contact_soup_free(&all->soup);
    free(all->part);
    free(all->seen);
    free(all->x);
    free(all->place);
    free(all->sewn);
    free(all->pairs.items);
    free(all->entered.items);
    free(all);
}

/* ---- Findings ---- */

static void check_intersections_say(const struct look *look, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void check_intersections_say(const struct look *look, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    fprintf(stderr,
            "%s%s: frame %" PRIu64 "%s, at %g s: ", isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "",
            look->all->of.program, look->frame, look->written ? " as written" : "", look->time);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
}

enum { NAMED = 200 }; /* characters */

/* "triangle 1 2 3 of cloth 'a'", by the numbers that the cloth's mesh has. */
static void name_triangle(const struct intersections *all, uint32_t t, char text[NAMED])
{
    const uint32_t owner = contact_soup_owner(&all->soup, t), n_cloths = all->soup.n_cloths;
    const uint32_t *corner = all->soup.corner[t], before = all->soup.surface[owner].point;
    const int n = snprintf(text, NAMED, "triangle %" PRIu32 " %" PRIu32 " %" PRIu32,
                           corner[0] - before + 1, corner[1] - before + 1, corner[2] - before + 1);
    if (owner >= n_cloths)
        snprintf(text + n, NAMED - (size_t)n, " of obstacles[%" PRIu32 "]", owner - n_cloths);
    else if (all->of.model)
        snprintf(text + n, NAMED - (size_t)n, " of cloth '%.100s'",
                 all->of.model->cloths[owner].name);
}

/* Counts one more; true if it is to be printed. */
static bool is_said(struct look *look)
{
    return look->n++ < SAID && look->says;
}

static void say_pair(struct look *look, const struct verify_pair *pair)
{
    char one[NAMED], other[NAMED];
    if (!is_said(look))
        return;
    name_triangle(look->all, pair->triangle[0], one);
    name_triangle(look->all, pair->triangle[1], other);
    check_intersections_say(look, "%s and %s intersect (vertices count from 1)", one, other);
}

static void say_entered(struct look *look, uint32_t triangle, size_t obstacle)
{
    char one[NAMED];
    if (!is_said(look))
        return;
    name_triangle(look->all, triangle, one);
    check_intersections_say(look, "%s enters obstacles[%zu], a %s (vertices count from 1)", one,
                            obstacle, contact_kinds[look->all->of.obstacles[obstacle].kind]->name);
}

static void say_inside(struct look *look, uint32_t point, size_t obstacle)
{
    const struct intersections *all = look->all;
    if (!is_said(look))
        return;
    const uint32_t cloth = contact_soup_cloth(&all->soup, point);
    const struct model *model = all->of.model;
    check_intersections_say(
        look, "vertex %" PRIu32 "%s%.100s%s is inside obstacles[%zu] (vertices count from 1)",
        point - all->soup.surface[cloth].point + 1, model ? " of cloth '" : "",
        model ? model->cloths[cloth].name : "", model ? "'" : "", obstacle);
}

/* ---- Pairs that do not meet ---- */

/* A folder has all cloths in one mesh. */
static uint32_t intersections_cloth_of(const struct intersections *all, uint32_t t)
{
    return all->of.apart->apart ? contact_apart_cloth(all->of.apart, all->soup.corner[t][0], 0)
                                : contact_soup_owner(&all->soup, t);
}

/* True if a triangle of cloth and an obstacle are not to meet. */
static bool misses(const struct intersections *all, uint32_t t, size_t obstacle)
{
    return contact_is_attached(all->of.apart, 3, all->soup.corner[t], (uint32_t)obstacle) ||
           contact_are_apart(all->of.apart, intersections_cloth_of(all, t),
                             all->of.apart->n_cloths + (uint32_t)obstacle);
}

static bool intersections_is_left_out(const struct intersections *all,
                                      const struct verify_pair *pair)
{
    const uint32_t *t = pair->triangle, a = intersections_cloth_of(all, t[0]);
    if (t[1] < all->checked.n_first)
        return (all->of.self_off && a == intersections_cloth_of(all, t[1])) ||
               contact_are_apart(all->of.apart, a, intersections_cloth_of(all, t[1]));
    return misses(all, t[0], contact_soup_owner(&all->soup, t[1]) - all->soup.n_cloths);
}

/* ---- A frame ---- */

static void intersections_place_body(const struct look *look, size_t obstacle)
{
    const struct intersections *all = look->all;
    const struct contact_shape *shape = all->of.obstacles + obstacle;
    const struct contact_body *body = contact_bodies_at(all->of.bodies, shape->body);
    const phys_vec *from = body ? contact_body_vertices(body) : NULL;
    struct contact_pose pose;
    contact_pose_over(shape, all->of.keys, all->of.bodies, look->placed, look->placed, &pose);
    if (body && body->n_frames) {
        contact_body_places(body, look->placed, all->place);
        from = all->place;
    }
    const uint32_t first = all->soup.surface[all->soup.n_cloths + obstacle].point;
    for (uint32_t v = 0; body && v < body->n_vertices; v++) {
        phys_vec x = from[v];
        if (pose.moves)
            phys_pose_point(&pose.to, &x, &x);
        for (int c = 0; c < 3; c++)
            all->x[first + v][c] = verify_coordinate(x[c]);
    }
}

static void intersections_place_points(const struct look *look, const double *position)
{
    const struct intersections *all = look->all;
    for (uint32_t v = 0; v < contact_soup_cloths(&all->soup).point; v++)
        for (int c = 0; c < 3; c++) {
            const double x = position[3 * (size_t)v + (size_t)c];
            all->x[v][c] = verify_coordinate(look->written ? (double)(float)x : x);
        }
    for (size_t i = 0; i < all->soup.n_obstacles; i++)
        intersections_place_body(look, i);
}

static int look_at_pairs(struct look *look, uint64_t *pairs, uint64_t *with_bodies,
                         struct cloth_error *error)
{
    struct intersections *all = look->all;
    all->pairs.n = 0;
    const int code = verify_pairs(&all->checked, &all->pairs, error);
    const struct verify_pair *pair = all->pairs.items;
    for (size_t i = 0; i < all->pairs.n && !code; i++) {
        const bool cloths = pair[i].triangle[1] < all->checked.n_first;
        if (intersections_is_left_out(all, pair + i))
            continue;
        *pairs += cloths;
        *with_bodies += !cloths;
        say_pair(look, pair + i);
    }
    return code;
}

static int intersections_look_at_shape(struct look *look, size_t obstacle, uint64_t *entered,
                                       struct cloth_error *error)
{
    struct intersections *all = look->all;
    const struct contact_shape *shape = all->of.obstacles + obstacle;
    const double depth = look->written ? INTERSECTIONS_DEPTH_FLOAT : INTERSECTIONS_DEPTH;
    struct contact_pose pose;
    contact_pose_over(shape, all->of.keys, all->of.bodies, look->placed, look->placed, &pose);
    all->entered.n = 0;
    const int code = verify_enter(&all->checked, shape, &pose, depth, &all->entered, error);
    const uint32_t *triangle = all->entered.items;
    for (size_t i = 0; i < all->entered.n && !code; i++) {
        if (misses(all, triangle[i], obstacle))
            continue;
        *entered += 1;
        say_entered(look, triangle[i], obstacle);
    }
    return code;
}

/* True if a vertex of cloth may be in an obstacle. *guess: a cloth near its own. */
static bool may_be_in(const struct intersections *all, uint32_t point, size_t obstacle,
                      uint32_t *guess)
{
    if (contact_is_attached(all->of.apart, 1, &point, (uint32_t)obstacle))
        return true;
    if (!all->of.apart->apart)
        return false;
    *guess = contact_apart_cloth(all->of.apart, point, *guess);
    return contact_are_apart(all->of.apart, *guess, all->of.apart->n_cloths + (uint32_t)obstacle);
}

/* If no triangles intersect, a part of the cloth is inside or outside as a whole, apart from
 * vertices that may be inside. So the first other vertex of a part decides. */
static void look_inside(struct look *look, size_t obstacle, uint64_t *inside)
{
    const struct intersections *all = look->all;
    const struct contact_surface *body = all->soup.surface + all->soup.n_cloths + obstacle;
    const uint32_t n = contact_soup_cloths(&all->soup).point;
    uint32_t guess = 0;
    memset(all->seen, 0, n);
    for (uint32_t point = 0; point < n; point++) {
        const uint32_t part = all->part[point];
        if (part == NO_PART || all->seen[part] || may_be_in(all, point, obstacle, &guess))
            continue;
        all->seen[part] = 1;
        if (!verify_inside(&all->checked, body[0].triangle, body[1].triangle, all->x[point]))
            continue;
        *inside += 1;
        say_inside(look, point, obstacle);
    }
}

static void add_found(const struct look *look, uint64_t pairs, uint64_t with_shapes)
{
    struct intersections *all = look->all;
    struct intersections_found *found = all->of.found;
    if (look->n && all->last != look->frame) {
        found->first = found->bad ? found->first : look->frame;
        found->bad++;
        all->last = look->frame;
    }
    found->pairs = pairs > found->pairs ? pairs : found->pairs;
    found->with_shapes = with_shapes > found->with_shapes ? with_shapes : found->with_shapes;
    found->frames = look->frame + 1;
}

int intersections_frame(struct intersections *intersections, uint64_t frame, double time,
                        const double *position, bool written, struct cloth_error *error)
{
    struct look look = {.all = intersections,
                        .frame = frame,
                        .time = time,
                        .placed = time - intersections->of.begin,
                        .written = written,
                        .says = intersections->of.program && intersections->last == UINT64_MAX};
    uint64_t pairs = 0, with_shapes = 0;
    intersections_place_points(&look, position);
    int code = look_at_pairs(&look, &pairs, &with_shapes, error);
    for (size_t i = 0; i < intersections->soup.n_obstacles && !code; i++)
        if (intersections->of.obstacles[i].body)
            look_inside(&look, i, &with_shapes);
        else
            code = intersections_look_at_shape(&look, i, &with_shapes, error);
    if (code)
        return code;
    if (look.n > SAID && look.says)
        check_intersections_say(&look, "and %" PRIu64 " more", look.n - SAID);
    add_found(&look, pairs, with_shapes);
    return CLOTH_OK;
}

void intersections_say(const struct intersections_found *found, const char *program)
{
    if (found->bad)
        fprintf(stderr,
                "%s: triangles intersect in %" PRIu64 " of %" PRIu64 " frames, from frame %" PRIu64
                " on: at most %" PRIu64 " pairs of cloth, and %" PRIu64 " with obstacles\n",
                program, found->bad, found->frames, found->first, found->pairs, found->with_shapes);
}
