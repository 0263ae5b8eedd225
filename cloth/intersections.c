/* One soup has the triangles of all cloths, then those of all obstacles that are bodies, whose
 * vertices follow those of the cloths. Only bodies move in between frames by anything but the
 * frame. */
#include "cloth/intersections.h"
#include "cloth/intersections_parts.h"

#include "cloth/base/memory.h"
#include "cloth/verify/orient.h"
#include "cloth/verify/verify.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SAID = 5 }; /* intersections of the first frame that has any */

/* Triangles and vertices of the soup from its first ones on. */
struct surface {
    uint32_t triangle, point;
    char *name; /* of a cloth; NULL: there is none */
};

struct intersections {
    const char *program;
    const struct contact_shape *obstacles;
    const struct phys_key *keys;
    const struct contact_bodies *bodies;
    const struct contact_apart *apart;
    bool self_off;
    size_t n_cloths, n_obstacles;
    phys_vec *place;                  /* room for the vertices of a body */
    struct surface *cloth, *obstacle; /* n_cloths + 1; n_obstacles + 1: empty but of bodies */
    uint32_t *part; /* a vertex of each part of the cloths whose triangles are joined */
    uint32_t n_parts;
    double (*x)[3];
    uint32_t (*corner)[3]; /* by vertices of their own, */
    uint32_t (*joined)[3]; /* by the lowest that these are one with */
    struct verify_soup soup;
    struct cloth_list pairs, entered;
    struct intersections_found found;
    uint64_t last; /* the last frame that had any */
};

/* A frame that is looked at. */
struct look {
    struct intersections *all;
    uint64_t frame, n; /* n: how much was found in it */
    double time;
    bool written;
    bool says; /* what is found */
};

/* ---- The soup ---- */

static int count_points(struct intersections *all, const struct intersections_setup *setup,
                        struct cloth_error *error)
{
    uint64_t points = 0, triangles = 0;
    for (size_t i = 0; i <= setup->n_meshes; i++) {
        all->cloth[i].point = (uint32_t)points;
        all->cloth[i].triangle = (uint32_t)triangles;
        points += i < setup->n_meshes ? setup->meshes[i]->n_vertices : 0;
        triangles += i < setup->n_meshes ? setup->meshes[i]->n_triangles : 0;
    }
    all->soup.n_first = (uint32_t)triangles;
    for (size_t i = 0; i <= setup->n_obstacles; i++) {
        const struct contact_body *body =
            i < setup->n_obstacles ? contact_bodies_at(setup->bodies, setup->obstacles[i].body)
                                   : NULL;
        all->obstacle[i].point = (uint32_t)points;
        all->obstacle[i].triangle = (uint32_t)triangles;
        points += body ? body->n_vertices : 0;
        triangles += body ? body->n_triangles : 0;
    }
    if (points > UINT32_MAX || triangles > UINT32_MAX)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "--check-intersections: cloths and bodies have more than %" PRIu32
                          " vertices or triangles",
                          UINT32_MAX);
    all->soup.n_points = (uint32_t)points;
    all->soup.n_triangles = (uint32_t)triangles;
    return CLOTH_OK;
}

static void take_cloth(struct intersections *all, const struct intersections_setup *setup, size_t i)
{
    const struct mesh *mesh = setup->meshes[i];
    const struct surface *cloth = all->cloth + i;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t *corner = all->corner[cloth->triangle + t];
        mesh_corners(mesh, t, corner);
        for (int c = 0; c < 3; c++) {
            corner[c] += cloth->point;
            all->joined[cloth->triangle + t][c] = setup->same ? setup->same[corner[c]] : corner[c];
        }
    }
}

static int take_body(struct intersections *all, size_t i, struct cloth_error *error)
{
    const struct contact_body *body = contact_bodies_at(all->bodies, all->obstacles[i].body);
    const struct surface *obstacle = all->obstacle + i;
    struct mesh mesh;
    if (!body)
        return CLOTH_OK;
    const int code = contact_body_mesh(body, &mesh, error);
    for (uint32_t t = 0; t < body->n_triangles && !code; t++) {
        uint32_t *corner = all->corner[obstacle->triangle + t];
        mesh_corners(&mesh, t, corner);
        for (int c = 0; c < 3; c++)
            corner[c] += obstacle->point;
        memcpy(all->joined[obstacle->triangle + t], corner, sizeof *all->joined);
    }
    mesh_free(&mesh);
    return code;
}

/* ---- What is found ---- */

static void say(const struct look *look, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void say(const struct look *look, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    fprintf(stderr,
            "%s%s: frame %" PRIu64 "%s, at %g s: ", isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "",
            look->all->program, look->frame, look->written ? " as written" : "", look->time);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
}

enum { NAMED = 200 }; /* characters */

/* "triangle 1 2 3 of cloth 'a'", by the numbers that the cloth's mesh has. */
static void name_triangle(const struct intersections *all, uint32_t t, char text[NAMED])
{
    const bool cloth = t < all->soup.n_first;
    const struct surface *list = cloth ? all->cloth : all->obstacle;
    size_t i = 0;
    while (t >= list[i + 1].triangle)
        i++;
    const uint32_t *corner = all->corner[t], before = list[i].point;
    const int n = snprintf(text, NAMED, "triangle %" PRIu32 " %" PRIu32 " %" PRIu32,
                           corner[0] - before + 1, corner[1] - before + 1, corner[2] - before + 1);
    if (!cloth)
        snprintf(text + n, NAMED - (size_t)n, " of obstacles[%zu]", i);
    else if (list[i].name)
        snprintf(text + n, NAMED - (size_t)n, " of cloth '%.100s'", list[i].name);
}

/* Counts one more; whether it is to be said. */
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
    say(look, "%s and %s intersect (vertices count from 1)", one, other);
}

static void say_entered(struct look *look, uint32_t triangle, size_t obstacle)
{
    char one[NAMED];
    if (!is_said(look))
        return;
    name_triangle(look->all, triangle, one);
    say(look, "%s enters obstacles[%zu], a %s (vertices count from 1)", one, obstacle,
        contact_kinds[look->all->obstacles[obstacle].kind]->name);
}

static void say_inside(struct look *look, uint32_t point, size_t obstacle)
{
    const struct intersections *all = look->all;
    size_t i = 0;
    if (!is_said(look))
        return;
    while (point >= all->cloth[i + 1].point)
        i++;
    say(look, "vertex %" PRIu32 "%s%.100s%s is inside obstacles[%zu] (vertices count from 1)",
        point - all->cloth[i].point + 1, all->cloth[i].name ? " of cloth '" : "",
        all->cloth[i].name ? all->cloth[i].name : "", all->cloth[i].name ? "'" : "", obstacle);
}

/* ---- What does not meet ---- */

/* A folder has all cloths in one mesh. */
static uint32_t cloth_of(const struct intersections *all, uint32_t t)
{
    uint32_t i = 0;
    if (all->apart->apart)
        return contact_apart_cloth(all->apart, all->corner[t][0], 0);
    while (t >= all->cloth[i + 1].triangle)
        i++;
    return i;
}

/* Whether a triangle of cloth and an obstacle do not meet. */
static bool misses(const struct intersections *all, uint32_t t, size_t obstacle)
{
    return contact_is_attached(all->apart, 3, all->corner[t], (uint32_t)obstacle) ||
           contact_are_apart(all->apart, cloth_of(all, t),
                             all->apart->n_cloths + (uint32_t)obstacle);
}

static bool is_left_out(const struct intersections *all, const struct verify_pair *pair)
{
    const uint32_t *t = pair->triangle, a = cloth_of(all, t[0]);
    size_t i = 0;
    if (t[1] < all->soup.n_first)
        return (all->self_off && a == cloth_of(all, t[1])) ||
               contact_are_apart(all->apart, a, cloth_of(all, t[1]));
    while (t[1] >= all->obstacle[i + 1].triangle)
        i++;
    return misses(all, t[0], i);
}

/* ---- A frame ---- */

static void place_body(const struct look *look, size_t obstacle)
{
    const struct intersections *all = look->all;
    const struct contact_shape *shape = all->obstacles + obstacle;
    const struct contact_body *body = contact_bodies_at(all->bodies, shape->body);
    const phys_vec *from = body ? contact_body_vertices(body) : NULL;
    struct contact_pose pose;
    contact_pose_over(shape, all->keys, all->bodies, look->time, look->time, &pose);
    if (body && body->n_frames) {
        contact_body_places(body, look->time, all->place);
        from = all->place;
    }
    for (uint32_t v = 0; body && v < body->n_vertices; v++) {
        phys_vec x = from[v];
        if (pose.moves)
            phys_pose_point(&pose.to, &x, &x);
        for (int c = 0; c < 3; c++)
            all->x[all->obstacle[obstacle].point + v][c] = verify_coordinate(x[c]);
    }
}

static void place_points(const struct look *look, const double *position)
{
    const struct intersections *all = look->all;
    for (uint32_t v = 0; v < all->cloth[all->n_cloths].point; v++)
        for (int c = 0; c < 3; c++) {
            const double x = position[3 * (size_t)v + (size_t)c];
            all->x[v][c] = verify_coordinate(look->written ? (double)(float)x : x);
        }
    for (size_t i = 0; i < all->n_obstacles; i++)
        place_body(look, i);
}

static int look_at_pairs(struct look *look, uint64_t *pairs, uint64_t *with_bodies,
                         struct cloth_error *error)
{
    struct intersections *all = look->all;
    all->pairs.n = 0;
    const int code = verify_pairs(&all->soup, &all->pairs, error);
    const struct verify_pair *pair = all->pairs.items;
    for (size_t i = 0; i < all->pairs.n && !code; i++) {
        const bool cloths = pair[i].triangle[1] < all->soup.n_first;
        if (is_left_out(all, pair + i))
            continue;
        *pairs += cloths;
        *with_bodies += !cloths;
        say_pair(look, pair + i);
    }
    return code;
}

static int look_at_shape(struct look *look, size_t obstacle, uint64_t *entered,
                         struct cloth_error *error)
{
    struct intersections *all = look->all;
    const struct contact_shape *shape = all->obstacles + obstacle;
    const double depth = look->written ? INTERSECTIONS_DEPTH_FLOAT : INTERSECTIONS_DEPTH;
    struct contact_pose pose;
    contact_pose_over(shape, all->keys, all->bodies, look->time, look->time, &pose);
    all->entered.n = 0;
    const int code = verify_enter(&all->soup, shape, &pose, depth, &all->entered, error);
    const uint32_t *triangle = all->entered.items;
    for (size_t i = 0; i < all->entered.n && !code; i++) {
        if (misses(all, triangle[i], obstacle))
            continue;
        *entered += 1;
        say_entered(look, triangle[i], obstacle);
    }
    return code;
}

static void look_inside(struct look *look, size_t obstacle, uint64_t *inside)
{
    const struct intersections *all = look->all;
    const struct surface *body = all->obstacle + obstacle;
    for (uint32_t i = 0; i < all->n_parts; i++) {
        const uint32_t point = all->part[i];
        if (contact_is_attached(all->apart, 1, &point, (uint32_t)obstacle) ||
            (all->apart->apart &&
             contact_are_apart(all->apart, contact_apart_cloth(all->apart, point, 0),
                               all->apart->n_cloths + (uint32_t)obstacle)))
            continue;
        if (!verify_inside(&all->soup, body[0].triangle, body[1].triangle, all->x[point]))
            continue;
        *inside += 1;
        say_inside(look, point, obstacle);
    }
}

static void add_found(const struct look *look, uint64_t pairs, uint64_t with_shapes)
{
    struct intersections *all = look->all;
    struct intersections_found *found = &all->found;
    if (look->n && !(found->bad && all->last == look->frame)) {
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
                        .written = written,
                        .says = !intersections->found.bad};
    uint64_t pairs = 0, with_shapes = 0;
    place_points(&look, position);
    int code = look_at_pairs(&look, &pairs, &with_shapes, error);
    for (size_t i = 0; i < intersections->n_obstacles && !code; i++)
        if (intersections->obstacles[i].body)
            look_inside(&look, i, &with_shapes);
        else
            code = look_at_shape(&look, i, &with_shapes, error);
    if (code)
        return code;
    if (look.n > SAID && look.says)
        say(&look, "and %" PRIu64 " more", look.n - SAID);
    add_found(&look, pairs, with_shapes);
    return CLOTH_OK;
}

struct intersections_found intersections_found(const struct intersections *intersections)
{
    return intersections->found;
}

void intersections_say(const struct intersections_found *found, const char *program)
{
    if (found->bad)
        fprintf(stderr,
                "%s: triangles intersect in %" PRIu64 " of %" PRIu64 " frames, from frame %" PRIu64
                " on: at most %" PRIu64 " pairs of cloth, and %" PRIu64 " with obstacles\n",
                program, found->bad, found->frames, found->first, found->pairs, found->with_shapes);
}

/* ---- Beginning and end ---- */

static int take_arrays(struct intersections *all, struct cloth_error *error)
{
    all->x = cloth_alloc(all->soup.n_points, sizeof *all->x, error);
    all->corner = cloth_alloc(all->soup.n_triangles, sizeof *all->corner, error);
    all->joined = cloth_alloc(all->soup.n_triangles, sizeof *all->joined, error);
    if (!all->x || !all->corner || !all->joined)
        return CLOTH_E_MEMORY;
    const uint64_t in_bodies = all->soup.n_points - all->cloth[all->n_cloths].point;
    all->place = aligned_alloc(sizeof *all->place, (in_bodies + 1) * sizeof *all->place);
    if (!all->place)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the vertices of bodies");
    all->soup.x = (const double(*)[3])all->x;
    all->soup.corner = (const uint32_t(*)[3])all->joined;
    return CLOTH_OK;
}

static int take_names(struct intersections *all, const struct intersections_setup *setup,
                      struct cloth_error *error)
{
    for (size_t i = 0; i < setup->n_meshes && setup->names; i++)
        if (!(all->cloth[i].name = strdup(setup->names[i])))
            return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the names of cloths");
    return CLOTH_OK;
}

static int fill(struct intersections *all, const struct intersections_setup *setup,
                struct cloth_error *error)
{
    all->cloth = cloth_alloc(setup->n_meshes + 1, sizeof *all->cloth, error);
    all->obstacle = cloth_alloc(setup->n_obstacles + 1, sizeof *all->obstacle, error);
    int code = all->cloth && all->obstacle ? count_points(all, setup, error) : CLOTH_E_MEMORY;
    code = code ? code : take_names(all, setup, error);
    code = code ? code : take_arrays(all, error);
    for (size_t i = 0; i < setup->n_meshes && !code; i++)
        take_cloth(all, setup, i);
    for (size_t i = 0; i < setup->n_obstacles && !code; i++)
        code = take_body(all, i, error);
    return code ? code
                : intersections_parts(all->cloth[all->n_cloths].point, all->soup.n_first,
                                      (const uint32_t(*)[3])all->joined, &all->part, &all->n_parts,
                                      error);
}

int intersections_open(struct intersections **intersections,
                       const struct intersections_setup *setup, struct cloth_error *error)
{
    struct intersections *all = *intersections = cloth_alloc(1, sizeof *all, error);
    if (!all)
        return CLOTH_E_MEMORY;
    all->program = setup->program;
    all->obstacles = setup->obstacles;
    all->keys = setup->keys;
    all->bodies = setup->bodies;
    all->apart = setup->apart;
    all->self_off = setup->self_off;
    all->n_cloths = setup->n_meshes;
    all->n_obstacles = setup->n_obstacles;
    const int code = fill(all, setup, error);
    if (code)
        intersections_close(intersections);
    return code;
}

void intersections_close(struct intersections **intersections)
{
    struct intersections *all = *intersections;
    *intersections = NULL;
    if (!all)
        return;
    for (size_t i = 0; i < all->n_cloths && all->cloth; i++)
        free(all->cloth[i].name);
    free(all->cloth);
    free(all->obstacle);
    free(all->part);
    free(all->x);
    free(all->place);
    free(all->corner);
    free(all->joined);
    free(all->pairs.items);
    free(all->entered.items);
    free(all);
}
