/* The file does not say in which direction an edge is sewn to the other. */
#include "cloth/garment/detail/seams.h"
#include "cloth/base/memory.h"

#include <math.h>

/* Vertex k along an edge, from its begin. */
static uint32_t vertex_of(const struct garment *garment, const struct garment_pattern *pattern,
                          struct garment_side side, uint32_t k)
{
    const struct garment_piece *piece = &garment->piece[side.panel];
    const uint32_t n = piece->start[pattern->panel[side.panel].n_edges];
    return piece->first + (piece->start[side.edge] + k) % n;
}

static double distance(const struct garment *garment, uint32_t a, uint32_t b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double d = garment->position[a][k] - garment->position[b][k];
        sum += d * d;
    }
    return sqrt(sum);
}

/* Whether the second side runs from its end to its begin. */
static bool is_reversed(const struct garment_stitch *stitch, const struct garment_pattern *pattern,
                        const double mean[2])
{
    const struct garment_side *side = stitch->side;
    const uint32_t *a = pattern->panel[side[0].panel].edge[side[0].edge].end;
    const uint32_t *b = pattern->panel[side[1].panel].edge[side[1].edge].end;
    if (stitch->right_wrong)
        return false;
    if (side[0].panel == side[1].panel && (a[1] == b[0] || a[0] == b[1]))
        return true;
    return mean[1] < mean[0];
}

static int make_seam(struct garment *garment, const struct garment_pattern *pattern, uint32_t s,
                     struct cloth_error *error)
{
    const struct garment_stitch *stitch = &pattern->stitch[s];
    const struct garment_side *side = stitch->side;
    struct garment_seam *seam = &garment->seam[s];
    const uint32_t *start = garment->piece[side[0].panel].start;
    const uint32_t n = start[side[0].edge + 1] - start[side[0].edge] + 1;
    seam->pair = cloth_alloc(n, sizeof *seam->pair, error);
    if (!seam->pair)
        return CLOTH_E_MEMORY;
    seam->n_pairs = n;
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t a = vertex_of(garment, pattern, side[0], k);
        seam->distance[0] += distance(garment, a, vertex_of(garment, pattern, side[1], k)) / n;
        seam->distance[1] +=
            distance(garment, a, vertex_of(garment, pattern, side[1], n - 1 - k)) / n;
    }
    seam->reversed = is_reversed(stitch, pattern, seam->distance);
    for (uint32_t k = 0; k < n; k++) {
        seam->pair[k][0] = vertex_of(garment, pattern, side[0], k);
        seam->pair[k][1] = vertex_of(garment, pattern, side[1], seam->reversed ? n - 1 - k : k);
    }
    return CLOTH_OK;
}

int seams_make(struct garment *garment, const struct garment_pattern *pattern,
               struct cloth_error *error)
{
    garment->seam = cloth_alloc(pattern->n_stitches, sizeof *garment->seam, error);
    if (!garment->seam)
        return CLOTH_E_MEMORY;
    garment->n_seams = pattern->n_stitches;
    for (uint32_t s = 0; s < pattern->n_stitches; s++) {
        int code = make_seam(garment, pattern, s, error);
        if (code)
            return code;
    }
    return CLOTH_OK;
}
