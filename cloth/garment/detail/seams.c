/* The file does not say in which direction an edge is sewn to the other. A sewn cloth has a front
 * and a back: where the fronts of two panels are on one side of it, their loops run against each
 * other along the seam, and else alike. So all seams of two panels have one answer, and those that
 * are clear decide for others. */
#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/sets.h"
#include "cloth/base/vector.h"
#include "cloth/garment/detail/meshing.h"

#include <stdlib.h>

/* A seam tells its direction if its two distances differ by at least this part of the longer one.
 * Short edges of panels that are far from each other are as near either way round. */
static const double CLEAR = 0.05;

struct seams {
    struct garment *garment;
    const struct garment_pattern *pattern;
    uint32_t *set; /* by panel p: p as its front is, p + n_panels turned over; one set: one side */
};

/* Vertex k along an edge, from its begin. */
static uint32_t vertex_of(const struct seams *of, struct garment_side side, uint32_t k)
{
    const struct garment_piece *piece = &of->garment->piece[side.panel];
    const uint32_t n = piece->start[of->pattern->panel[side.panel].n_edges];
    return piece->first + (piece->start[side.edge] + k) % n;
}

/* Vertex k of a seam's pairs on side j; reversed: if side 1 runs from its end. */
static uint32_t seam_vertex(const struct seams *of, uint32_t s, int j, uint32_t k, bool reversed)
{
    const struct garment_stitch *stitch = &of->pattern->stitch[s];
    const struct garment_side side = stitch->side[j];
    const uint32_t *start = of->garment->piece[side.panel].start + side.edge;
    const uint32_t n = of->garment->seam[s].n_pairs - 1;
    k = reversed && j ? n - k : k;
    if (stitch->pleats.count && j != stitch->pleats.side)
        k = pleats_place(stitch->pleats.count, n, start[1] - start[0], k);
    return vertex_of(of, side, k);
}

/* The distances of vertices that belong together if both edges run alike, and if one is reversed.
 */
static void measure_seam(const struct seams *of, uint32_t s)
{
    const struct garment_stitch *stitch = &of->pattern->stitch[s];
    const struct garment_side side = stitch->side[stitch->pleats.side];
    const double(*position)[3] = (const double(*)[3])of->garment->position;
    struct garment_seam *seam = &of->garment->seam[s];
    const uint32_t *start = of->garment->piece[side.panel].start + side.edge;
    const uint32_t n = seam->n_pairs = start[1] - start[0] + 1;
    for (uint32_t k = 0; k < n; k++)
        for (int reversed = 0; reversed < 2; reversed++) {
            const uint32_t a = seam_vertex(of, s, 0, k, reversed);
            const uint32_t b = seam_vertex(of, s, 1, k, reversed);
            seam->distance[reversed] += cloth_distance(position[a], position[b]) / n;
        }
}

/* ---- Which panels have their fronts on one side ---- */

/* The vote of the seams of two panels: above 0, their fronts are on one side; below 0 not. */
struct vote {
    uint32_t panel[2]; /* ascending */
    double sum;
};

/* Above 0: nearer if one is reversed. */
static double vote_of(const struct garment_seam *seam)
{
    const double *mean = seam->distance, margin = mean[0] - mean[1];
    const double longer = fmax(mean[0], mean[1]);
    return fabs(margin) > CLEAR * longer ? margin / longer : 0;
}

/* Above 0: the fronts of two panels are on one side, below 0: not; 0: nothing is known. */
static int relation(const struct seams *of, uint32_t a, uint32_t b)
{
    const uint32_t root = cloth_sets_root(of->set, a);
    if (root == cloth_sets_root(of->set, b))
        return 1;
    return root == cloth_sets_root(of->set, b + of->pattern->n_panels) ? -1 : 0;
}

static void relate(const struct seams *of, uint32_t a, uint32_t b, bool one_side)
{
    const uint32_t n = of->pattern->n_panels;
    cloth_sets_join(of->set, a, one_side ? b : b + n);
    cloth_sets_join(of->set, a + n, one_side ? b + n : b);
}

static int compare_votes(const void *va, const void *vb)
{
    const double a = fabs(((const struct vote *)va)->sum), b = fabs(((const struct vote *)vb)->sum);
    return a < b ? 1 : a > b ? -1 : cloth_by_two(va, vb);
}

/* The votes of panels, one for each two that have clear seams. */
static uint32_t count_votes(struct vote *vote, const struct seams *of)
{
    uint32_t n = 0, kept = 0;
    for (uint32_t s = 0; s < of->pattern->n_stitches; s++) {
        const struct garment_stitch *stitch = &of->pattern->stitch[s];
        const uint32_t a = stitch->side[0].panel, b = stitch->side[1].panel;
        if (a != b && !stitch->right_wrong)
            vote[n++] =
                (struct vote){{a < b ? a : b, a < b ? b : a}, vote_of(&of->garment->seam[s])};
    }
    qsort(vote, n, sizeof *vote, cloth_by_two);
    for (uint32_t i = 0; i < n; i++)
        if (kept && !cloth_by_two(vote + kept - 1, vote + i))
            vote[kept - 1].sum += vote[i].sum;
        else
            vote[kept++] = vote[i];
    qsort(vote, kept, sizeof *vote, compare_votes);
    return kept;
}

/* The clearest first; what contradicts them is overruled. */
static void find_fronts(const struct seams *of, uint32_t n, const struct vote *vote)
{
    for (uint32_t i = 0; i < n && fabs(vote[i].sum) > 0; i++)
        if (!relation(of, vote[i].panel[0], vote[i].panel[1]))
            relate(of, vote[i].panel[0], vote[i].panel[1], vote[i].sum > 0);
}

/* Where no clear seam joins them, panels have their fronts where the pattern has them. */
static void turn_seams(const struct seams *of)
{
    const struct garment_stitch *stitch = of->pattern->stitch;
    for (uint32_t s = 0; s < of->pattern->n_stitches; s++)
        of->garment->seam[s].unsure =
            !stitch[s].right_wrong &&
            !relation(of, stitch[s].side[0].panel, stitch[s].side[1].panel);
    for (uint32_t s = 0; s < of->pattern->n_stitches; s++) {
        const uint32_t a = stitch[s].side[0].panel, b = stitch[s].side[1].panel;
        struct garment_seam *seam = &of->garment->seam[s];
        if (stitch[s].right_wrong)
            continue;
        if (!relation(of, a, b))
            relate(of, a, b, true);
        seam->reversed = relation(of, a, b) > 0;
        const double vote = vote_of(seam);
        seam->unsure = seam->unsure || (seam->reversed ? vote < 0 : vote > 0);
    }
}

/* ---- All seams ---- */

static int pair_vertices(const struct seams *of, uint32_t s, struct cloth_error *error)
{
    struct garment_seam *seam = &of->garment->seam[s];
    const uint32_t n = seam->n_pairs;
    seam->pair = cloth_take(&of->garment->memory, n, sizeof *seam->pair, error);
    for (uint32_t k = 0; k < n && seam->pair; k++) {
        seam->pair[k][0] = seam_vertex(of, s, 0, k, seam->reversed);
        seam->pair[k][1] = seam_vertex(of, s, 1, k, seam->reversed);
    }
    return seam->pair ? CLOTH_OK : CLOTH_E_MEMORY;
}

int seams_make(struct garment *garment, const struct garment_pattern *pattern,
               struct cloth_error *error)
{
    const uint32_t n = pattern->n_stitches, n_fronts = 2 * pattern->n_panels;
    struct cloth_pool memory = {0};
    struct seams seams = {garment, pattern,
                          cloth_take(&memory, n_fronts, sizeof *seams.set, error)};
    struct vote *vote = cloth_take(&memory, n, sizeof *vote, error);
    garment->seam = cloth_take(&garment->memory, n, sizeof *garment->seam, error);
    garment->n_seams = n;
    int code = memory.lacks || garment->memory.lacks ? CLOTH_E_MEMORY : CLOTH_OK;
    for (uint32_t s = 0; s < n && !code; s++)
        measure_seam(&seams, s);
    if (!code) {
        cloth_sets_start(seams.set, n_fronts);
        find_fronts(&seams, count_votes(vote, &seams), vote);
        turn_seams(&seams);
    }
    for (uint32_t s = 0; s < n && !code; s++)
        code = pair_vertices(&seams, s, error);
    cloth_pool_free(&memory);
    return code;
}
