/* Bodies whose surface goes through itself: the inside is undefined there, and cloth between two of
 * its parts is pinched. They are met all the same, with a warning. Seams that cross: they pull
 * panels through each other. */
#include "cloth/scene/build/build.h"
#include "cloth/verify/verify.h"

#include <stdlib.h>
#include <string.h>

/* The pairs of triangles of a surface that intersect. */
static int find_pairs(struct cloth_list *pairs, uint32_t n_points, const double *x,
                      uint32_t n_triangles, const uint32_t *corner, struct cloth_error *error)
{
    const struct verify_soup soup = {.n_points = n_points,
                                     .n_triangles = n_triangles,
                                     .n_first = n_triangles,
                                     .x = (const double(*)[3])x,
                                     .corner = (const uint32_t(*)[3])corner};
    return verify_pairs(&soup, pairs, error);
}

static void warn_of_pairs(const struct mesh *mesh, const struct cloth_list *pairs,
                          const struct scene_tree *tree, int file)
{
    const struct verify_pair *first = pairs->items;
    const uint32_t *a = mesh->triangle + 3 * (size_t)first->triangle[0];
    const uint32_t *b = mesh->triangle + 3 * (size_t)first->triangle[1];
    scene_build_warn(
        tree, file,
        "the body goes through itself: %zu pairs of its triangles intersect, the "
        "first are %u %u %u and %u %u %u (vertices count from 1); cloth can be pinched "
        "there: move its parts apart, or join them",
        pairs->n, a[0] + 1, a[1] + 1, a[2] + 1, b[0] + 1, b[1] + 1, b[2] + 1);
}

int scene_build_warn_crossed(const struct mesh *mesh, const double *place,
                             const struct scene_tree *tree, int file)
{
    struct cloth_list pairs = {0};
    if (!find_pairs(&pairs, mesh->n_vertices, place ? place : mesh->position, mesh->n_triangles,
                    mesh->triangle, tree->error) &&
        pairs.n)
        warn_of_pairs(mesh, &pairs, tree, file);
    free(pairs.items);
    return tree->error->code;
}

/* ---- Seams ---- */

static const double END = 0.02; /* of the way between partners: so near to them seams may touch */

/* The surface between threads of a cloth's seams: two triangles between each two neighbours. */
struct threads {
    double (*x)[3];
    uint32_t (*corner)[3], *seam; /* of each triangle, and the seam it is of */
    uint32_t n_points, n_triangles;
};

/* A thread, from near the one partner to near the other. */
static void add_thread(struct threads *to, const double *position, const uint32_t pair[2])
{
    const double *a = position + 3 * (size_t)pair[0], *b = position + 3 * (size_t)pair[1];
    for (int k = 0; k < 3; k++) {
        to->x[to->n_points][k] = a[k] + END * (b[k] - a[k]);
        to->x[to->n_points + 1][k] = b[k] + END * (a[k] - b[k]);
    }
    to->n_points += 2;
}

/* Without its first and its last thread, which other seams can have, too. */
static void crossed_add_seam(struct threads *to, const double *position,
                             const struct model_seam *seam, uint32_t number)
{
    for (uint32_t i = 1; i + 1 < seam->n_pairs; i++) {
        const uint32_t p = to->n_points;
        add_thread(to, position, seam->pair[i]);
        if (i == 1)
            continue;
        const uint32_t corner[2][3] = {{p - 2, p, p + 1}, {p - 2, p + 1, p - 1}};
        for (int k = 0; k < 2; k++) {
            memcpy(to->corner[to->n_triangles], corner[k], sizeof corner[k]);
            to->seam[to->n_triangles++] = number;
        }
    }
}

/* Finds the first two seams where a good part of the one's threads goes through the other. Seams
 * that begin at one corner may touch near it. Triangles are in the order of the seams, and so are
 * pairs. crossed, last: room, of each seam: triangles of the one that go through it; the last of
 * these. */
static bool find_crossed(const struct threads *threads, const struct cloth_list *pairs,
                         const struct model_seams *seams, uint32_t *crossed, uint32_t *last,
                         uint32_t found[2])
{
    const double PART = 0.25;
    uint32_t now = UINT32_MAX;
    for (size_t i = 0; i < pairs->n; i++) {
        const struct verify_pair *pair = (const struct verify_pair *)pairs->items + i;
        const uint32_t one = threads->seam[pair->triangle[0]];
        const uint32_t other = threads->seam[pair->triangle[1]];
        if (one != now)
            memset(crossed, 0, seams->n * sizeof *crossed);
        crossed[other] += !crossed[other] || last[other] != pair->triangle[0];
        last[other] = pair->triangle[0];
        now = one;
        found[0] = one;
        found[1] = other;
        if (one != other && crossed[other] >= PART * 2 * seams->seam[one].n_pairs)
            return true;
    }
    return false;
}

static void warn_of_threads(const struct model_cloth *cloth, const struct threads *threads,
                            const struct cloth_list *pairs, const struct scene_tree *tree, int node)
{
    char one[MODEL_SEAM_NAME], other[MODEL_SEAM_NAME];
    uint32_t found[2], *room = cloth_alloc(2 * cloth->seams.n, sizeof *room, tree->error);
    if (room && find_crossed(threads, pairs, &cloth->seams, room, room + cloth->seams.n, found)) {
        model_name_seam(cloth, found[0], one);
        model_name_seam(cloth, found[1], other);
        scene_build_warn(
            tree, node,
            "%.160s and %.160s cross where the run starts: what they pull goes through "
            "each other; place the panels otherwise, or see seams.reversed",
            one, other);
    }
    free(room);
}

int scene_build_warn_seams(struct scene_tree *tree, uint32_t c, int node)
{
    const struct model_cloth *cloth = tree->model->cloths + c;
    const struct model_seams *seams = &cloth->seams;
    const size_t n = 2 * scene_build_count_pairs(seams);
    struct cloth_list pairs = {0};
    if (!n)
        return CLOTH_OK;
    struct threads threads = {.x = cloth_alloc(n, sizeof *threads.x, tree->error),
                              .corner = cloth_alloc(n, sizeof *threads.corner, tree->error),
                              .seam = cloth_alloc(n, sizeof *threads.seam, tree->error)};
    for (uint32_t s = 0; s < seams->n && !tree->error->code; s++)
        if (seams->seam[s].sewing.state == MODEL_SEAMS_PULLED)
            crossed_add_seam(&threads, cloth->mesh.position, seams->seam + s, s);
    if (!tree->error->code && !find_pairs(&pairs, threads.n_points, *threads.x, threads.n_triangles,
                                          *threads.corner, tree->error))
        warn_of_threads(cloth, &threads, &pairs, tree, scene_tree_get(tree, node, "seams"));
    free(threads.x);
    free(threads.corner);
    free(threads.seam);
    free(pairs.items);
    return tree->error->code;
}
