/* Local search: each try is a change that is kept if the worst angle that it touched is better than
 * that of the triangle it was for, else it is undone. So the worst angle never becomes worse, and
 * the search ends. */
#include "cloth/garment/detail/flat.h"

#include <string.h>

enum { ROUNDS = 8, MOST = 24, MOST_NEAR = 64 };

static const double AIM = 0.8572;  /* cos 31 degrees: what is blunter is left alone */
static const double BETTER = 1e-4; /* a smaller gain is none */

/* The vertices that a try moved and may move. */
struct improve {
    struct delaunay *plane;
    const unsigned char *sharp;
    uint32_t n_near, near[MOST_NEAR]; /* vertices that are not fixed */
    bool wide;                        /* those around them move, too */
};

bool flat_excused(const struct delaunay *plane, const unsigned char *sharp, uint32_t triangle)
{
    const uint32_t *v = plane->triangle[triangle].vertex;
    for (int i = 0; i < 3; i++)
        if (v[i] < plane->n_fixed && sharp[v[i]])
            return true;
    return false;
}

/* How bad a triangle is; 0: it is excused. One that is turned over never is. */
static double badness(const struct improve *of, uint32_t triangle)
{
    const double sharpness = delaunay_sharpness_of(of->plane, triangle);
    const bool excused = flat_excused(of->plane, of->sharp, triangle);
    return excused && sharpness < 2 ? 0 : sharpness;
}

static double worst_around(const struct improve *of, uint32_t n, const uint32_t *around)
{
    double worst = 0;
    for (uint32_t k = 0; k < n; k++)
        worst = fmax(worst, badness(of, around[k]));
    return worst;
}

/* Searches a better place for a vertex: in eight directions, by shorter and shorter steps. */
static void settle(struct improve *of, uint32_t vertex)
{
    static const double way[8][2] = {{1, 0},  {0.7071, 0.7071},   {0, 1},  {-0.7071, 0.7071},
                                     {-1, 0}, {-0.7071, -0.7071}, {0, -1}, {0.7071, -0.7071}};
    struct delaunay *plane = of->plane;
    uint32_t around[MOST];
    const uint32_t n = delaunay_around(plane, vertex, MOST, around);
    if (n == 0)
        return;
    double *place = plane->place[vertex], worst = worst_around(of, n, around), step = 0;
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t next = delaunay_after(&plane->triangle[around[k]], vertex, 1);
        step += sqrt(cloth_square_2(plane->place[next], place));
    }
    step *= 0.3 / n;
    delaunay_log_vertex(plane, vertex);
    for (int level = 0; level < 7;) {
        bool moved = false;
        for (int d = 0; d < 8; d++) {
            const double old[2] = {place[0], place[1]};
            place[0] += step * way[d][0];
            place[1] += step * way[d][1];
            const double now = worst_around(of, n, around);
            moved = moved || now < worst - 1e-6;
            if (now < worst - 1e-6)
                worst = now;
            else
                memcpy(place, old, sizeof old);
        }
        level += !moved;
        step *= moved ? 1 : 0.5;
    }
    for (uint32_t k = 0; k < n; k++)
        delaunay_suspect(plane, around[k]);
}

static void add_near(struct improve *of, uint32_t vertex)
{
    if (vertex < of->plane->n_fixed || of->plane->at[vertex] == DELAUNAY_NONE)
        return;
    for (uint32_t i = 0; i < of->n_near; i++)
        if (of->near[i] == vertex)
            return;
    if (of->n_near < MOST_NEAR)
        of->near[of->n_near++] = vertex;
}

static void add_around(struct improve *of, uint32_t vertex)
{
    uint32_t around[MOST];
    const uint32_t n = delaunay_around(of->plane, vertex, MOST, around);
    for (uint32_t k = 0; k < n; k++)
        for (int i = 0; i < 3; i++)
            add_near(of, of->plane->triangle[around[k]].vertex[i]);
}

static void relax(struct improve *of)
{
    const uint32_t n = of->n_near;
    for (uint32_t i = 0; of->wide && i < n; i++)
        add_around(of, of->near[i]);
    for (int pass = 0; pass < 3; pass++)
        for (uint32_t i = 0; i < of->n_near; i++) {
            settle(of, of->near[i]);
            delaunay_legalise(of->plane);
        }
}

/* The worst of all triangles that the try changed. */
static double worst_touched(const struct improve *of)
{
    const struct delaunay *plane = of->plane;
    const struct delaunay_change *change = plane->changes.items;
    double worst = 0;
    for (size_t i = 0; i < plane->changes.n; i++) {
        const uint32_t t = change[i].triangle;
        if (t != DELAUNAY_NONE && plane->triangle[t].vertex[0] != DELAUNAY_NONE &&
            memcmp(plane->triangle[t].vertex, change[i].before.vertex,
                   sizeof change[i].before.vertex) != 0)
            worst = fmax(worst, badness(of, t));
    }
    for (uint32_t i = 0; i < of->n_near; i++) {
        uint32_t around[MOST];
        const uint32_t n = delaunay_around(plane, of->near[i], MOST, around);
        if (n == 0)
            return 2;
        worst = fmax(worst, worst_around(of, n, around));
    }
    return worst;
}

/* Ends a try that left `near` to be relaxed. */
static bool finish_try(struct improve *of, bool done, double before)
{
    if (done) {
        delaunay_legalise(of->plane);
        relax(of);
    }
    const bool better = done && !of->plane->failed && worst_touched(of) < before - BETTER;
    of->plane->suspect.n = 0;
    return delaunay_decide(of->plane, better);
}

static void begin_try(struct improve *of)
{
    of->n_near = 0;
    delaunay_log(of->plane);
}

static bool try_relax(struct improve *of, uint32_t triangle, double before)
{
    begin_try(of);
    for (int i = 0; i < 3; i++)
        add_around(of, of->plane->triangle[triangle].vertex[i]);
    return finish_try(of, of->n_near > 0, before);
}

static bool try_insert(struct improve *of, uint32_t triangle, const double place[2], double before)
{
    begin_try(of);
    const uint32_t vertex = delaunay_insert(of->plane, place, triangle);
    if (vertex != DELAUNAY_NONE)
        add_around(of, vertex);
    return finish_try(of, vertex != DELAUNAY_NONE, before);
}

static bool try_merge(struct improve *of, uint32_t vertex, uint32_t to, double before)
{
    begin_try(of);
    const bool done = vertex >= of->plane->n_fixed && delaunay_merge(of->plane, vertex, to);
    if (done) {
        delaunay_legalise(of->plane);
        add_around(of, to);
    }
    return finish_try(of, done, before);
}

static bool try_all(struct improve *of, uint32_t t)
{
    const struct delaunay *plane = of->plane;
    const double before = badness(of, t);
    uint32_t v[3];
    memcpy(v, plane->triangle[t].vertex, sizeof v);
    const double *x[3] = {plane->place[v[0]], plane->place[v[1]], plane->place[v[2]]};
    double place[5][2];
    flat_centre(plane, t, place[0]);
    for (int k = 0; k < 2; k++)
        place[1][k] = (x[0][k] + x[1][k] + x[2][k]) / 3;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++)
            place[2 + i][k] = 0.5 * (x[i][k] + x[(i + 1) % 3][k]);
    if (try_relax(of, t, before))
        return true;
    for (int i = 0; i < 3; i++)
        for (int k = 1; k < 3; k++)
            if (try_merge(of, v[i], v[(i + k) % 3], before))
                return true;
    for (int p = 0; p < 5; p++)
        if (try_insert(of, t, place[p], before))
            return true;
    return false;
}

void flat_improve(struct delaunay *plane, const unsigned char *sharp)
{
    struct improve improve = {.plane = plane, .sharp = sharp};
    uint32_t left = 16 + plane->n / 500; /* that nothing makes better: such a triangle costs much */
    bool any = true;
    for (int round = 0; round < ROUNDS && (any || round < 2); round++) {
        any = false;
        improve.wide = round > 0;
        for (uint32_t t = 0; t < plane->n_triangles && left > 0 && !plane->failed; t++) {
            if (plane->triangle[t].vertex[0] == DELAUNAY_NONE || badness(&improve, t) <= AIM)
                continue;
            const bool better = try_all(&improve, t);
            left -= !better;
            any = any || better;
        }
    }
}
