/* A frame places the vertices of the cloths; the time of the frame places those of bodies. A frame
 * counts as bad once, even if it is checked as doubles and as written. */
#include "cloth/app/check/intersections.h"
#include "cloth/app/check/intersections_state.h"

#include "cloth/verify/orient.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { SAID = 5 }; /* intersections of the first frame that has any */

/* A frame that is looked at. */
struct look {
    struct intersections *all;
    uint64_t frame, n; /* n: how much was found in it */
    double time;       /* s, as it is printed, and */
    double placed;     /* of motions and bodies */
    bool written;
    bool says; /* it prints findings */
};

/* ---- Findings ---- */

static void check_intersections_say(const struct look *look, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void check_intersections_say(const struct look *look, const char *format, ...)
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
    const uint32_t owner = contact_soup_owner(&all->soup, t), n_cloths = all->soup.n_cloths;
    const uint32_t *corner = all->soup.corner[t], before = all->soup.surface[owner].point;
    const int n = snprintf(text, NAMED, "triangle %" PRIu32 " %" PRIu32 " %" PRIu32,
                           corner[0] - before + 1, corner[1] - before + 1, corner[2] - before + 1);
    if (owner >= n_cloths)
        snprintf(text + n, NAMED - (size_t)n, " of obstacles[%" PRIu32 "]", owner - n_cloths);
    else if (all->name)
        snprintf(text + n, NAMED - (size_t)n, " of cloth '%.100s'", all->name[owner]);
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
                            obstacle, contact_kinds[look->all->obstacles[obstacle].kind]->name);
}

static void say_inside(struct look *look, uint32_t point, size_t obstacle)
{
    const struct intersections *all = look->all;
    if (!is_said(look))
        return;
    const uint32_t cloth = contact_soup_cloth(&all->soup, point);
    check_intersections_say(
        look, "vertex %" PRIu32 "%s%.100s%s is inside obstacles[%zu] (vertices count from 1)",
        point - all->soup.surface[cloth].point + 1, all->name ? " of cloth '" : "",
        all->name ? all->name[cloth] : "", all->name ? "'" : "", obstacle);
}

/* ---- Pairs that do not meet ---- */

/* A folder has all cloths in one mesh. */
static uint32_t intersections_cloth_of(const struct intersections *all, uint32_t t)
{
    return all->apart->apart ? contact_apart_cloth(all->apart, all->soup.corner[t][0], 0)
                             : contact_soup_owner(&all->soup, t);
}

/* True if a triangle of cloth and an obstacle are not to meet. */
static bool misses(const struct intersections *all, uint32_t t, size_t obstacle)
{
    return contact_is_attached(all->apart, 3, all->soup.corner[t], (uint32_t)obstacle) ||
           contact_are_apart(all->apart, intersections_cloth_of(all, t),
                             all->apart->n_cloths + (uint32_t)obstacle);
}

static bool intersections_is_left_out(const struct intersections *all,
                                      const struct verify_pair *pair)
{
    const uint32_t *t = pair->triangle, a = intersections_cloth_of(all, t[0]);
    if (t[1] < all->checked.n_first)
        return (all->self_off && a == intersections_cloth_of(all, t[1])) ||
               contact_are_apart(all->apart, a, intersections_cloth_of(all, t[1]));
    return misses(all, t[0], contact_soup_owner(&all->soup, t[1]) - all->soup.n_cloths);
}

/* ---- A frame ---- */

static void intersections_place_body(const struct look *look, size_t obstacle)
{
    const struct intersections *all = look->all;
    const struct contact_shape *shape = all->obstacles + obstacle;
    const struct contact_body *body = contact_bodies_at(all->bodies, shape->body);
    const phys_vec *from = body ? contact_body_vertices(body) : NULL;
    struct contact_pose pose;
    contact_pose_over(shape, all->keys, all->bodies, look->placed, look->placed, &pose);
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
    const struct contact_shape *shape = all->obstacles + obstacle;
    const double depth = look->written ? INTERSECTIONS_DEPTH_FLOAT : INTERSECTIONS_DEPTH;
    struct contact_pose pose;
    contact_pose_over(shape, all->keys, all->bodies, look->placed, look->placed, &pose);
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
    if (contact_is_attached(all->apart, 1, &point, (uint32_t)obstacle))
        return true;
    if (!all->apart->apart)
        return false;
    *guess = contact_apart_cloth(all->apart, point, *guess);
    return contact_are_apart(all->apart, *guess, all->apart->n_cloths + (uint32_t)obstacle);
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
        if (part == INTERSECTIONS_NO_PART || all->seen[part] ||
            may_be_in(all, point, obstacle, &guess))
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

void intersections_begin(struct intersections *intersections, double begin)
{
    intersections->begin = begin;
}

int intersections_frame(struct intersections *intersections, uint64_t frame, double time,
                        const double *position, bool written, struct cloth_error *error)
{
    struct look look = {.all = intersections,
                        .frame = frame,
                        .time = time,
                        .placed = time - intersections->begin,
                        .written = written,
                        .says = intersections->program && !intersections->found.bad};
    uint64_t pairs = 0, with_shapes = 0;
    intersections_place_points(&look, position);
    int code = look_at_pairs(&look, &pairs, &with_shapes, error);
    for (size_t i = 0; i < intersections->soup.n_obstacles && !code; i++)
        if (intersections->obstacles[i].body)
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
