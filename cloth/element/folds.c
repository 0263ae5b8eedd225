/* Folds: hinges whose rest angle the scene gives. An edge stands once in the list, so that the
 * angle of a hinge does not depend on the order of folds. */
#include "cloth/element/cloths.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/physics/curve.h"

#include <stdlib.h>

/* An edge of a fold. */
struct element_fold {
    uint32_t cloth, a, b;        /* ends, a < b, in the cloth's mesh */
    double s;                    /* at rest, from a to b, in front of the first triangle there */
    const struct model_fold *of; /* where the scene says it */
};

static const struct element_fold *folds_find(const struct element_cloths *cloths, uint32_t cloth,
                                             uint32_t a, uint32_t b)
{
    const struct element_fold wanted = {.cloth = cloth, .a = a < b ? a : b, .b = a < b ? b : a};
    return cloths->n_folds
               ? bsearch(&wanted, cloths->fold, cloths->n_folds, sizeof wanted, cloth_by_three)
               : NULL;
}

/* The fold of a hinge; across a seam, that of either side. *s: its 2 sin(theta / 2) at rest, from
 * corner 0 of the hinge to corner 1. The normals are those of its triangles (0, 1, 2) and (1, 0,
 * 3). */
static const struct element_fold *fold_of(const struct element_cloths *cloths,
                                          const struct element *element, double *s)
{
    const struct element_fold *fold = NULL;
    if (!element->seam) {
        fold = folds_find(cloths, element->cloth, element->corner[0], element->corner[1]);
        *s = fold ? fold->s : 0;
        return fold;
    }
    for (int k = 0; k < 2 && !fold; k++) {
        const struct element_side *side = element->seam->side + k;
        const bool along = side->corner[0] < side->corner[1];
        fold = folds_find(cloths, side->cloth, side->corner[0], side->corner[1]);
        *s = !fold ? 0 : along == (k == 0) ? fold->s : -fold->s;
    }
    return fold;
}

bool element_fold_rest(const struct element_cloths *cloths, const struct element *element,
                       double *s)
{
    double folded;
    const struct element_fold *fold = fold_of(cloths, element, &folded);
    if (fold)
        *s = folded;
    return fold;
}

/* ---- Making ---- */

/* A fold's angle is seen from the front of the triangle that goes from a to b. If the first
 * triangle at its edge goes from b to a, its front sees the other sign. */
static void turn_folds(struct element_cloths *cloths, uint32_t c)
{
    const struct mesh *mesh = &cloths->model->cloths[c].mesh;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        for (int i = 0; i < 3; i++) {
            const uint32_t a = corner[i], b = corner[(i + 1) % 3];
            struct element_fold *fold = a > b ? (struct element_fold *)folds_find(cloths, c, a, b)
                                              : NULL; /* they are ours */
            if (fold && mesh_edges_get(cloths->edges + c, a, b)->opposite[0] == corner[(i + 2) % 3])
                fold->s = -fold->s;
        }
    }
}

static void add_folds(struct element_cloths *cloths, uint32_t c)
{
    const struct model_cloth *cloth = cloths->model->cloths + c;
    for (uint32_t f = 0; f < cloth->n_folds; f++) {
        double cosine, sine;
        phys_turn(cloth->folds[f].angle / 2, &cosine, &sine);
        for (uint32_t i = 0; i + 1 < cloth->folds[f].n; i++) {
            const uint32_t *v = cloth->folds[f].vertices + i;
            cloths->fold[cloths->n_folds++] = (struct element_fold){.cloth = c,
                                                                    .a = v[v[1] < v[0]],
                                                                    .b = v[v[1] > v[0]],
                                                                    .s = 2 * sine,
                                                                    .of = cloth->folds + f};
        }
    }
}

/* Only hinges have an angle at rest. */
static int check_bending(const struct model *model, const struct model_cloth *cloth,
                         struct cloth_error *error)
{
    const struct model_material *bends = element_bending_of(model, cloth);
    if (!cloth->n_folds || (bends && bends->bending == MODEL_HINGES))
        return CLOTH_OK;
    if (!bends)
        return model_fail(cloth->folds[0].place, error,
                          "a fold needs bending, which no material of cloth '%.60s' has; bending: "
                          "{model: hinge} is expected",
                          cloth->name);
    return model_fail(cloth->folds[0].place, error,
                      "a fold is of bending: {model: hinge}, but material '%.60s' of cloth '%.60s' "
                      "has model: quadratic, which is flat at rest",
                      bends->name, cloth->name);
}

static int folds_check_once(const struct element_cloths *cloths, struct cloth_error *error)
{
    for (uint32_t i = 1; i < cloths->n_folds; i++) {
        const struct element_fold *fold = cloths->fold + i;
        if (!cloth_by_three(fold - 1, fold))
            return model_fail(fold->of->place, error,
                              "the edge between vertices %u and %u of cloth '%.60s' is folded "
                              "twice; once is expected",
                              fold->a, fold->b, cloths->model->cloths[fold->cloth].name);
    }
    return CLOTH_OK;
}

int element_folds_make(struct element_cloths *cloths, struct cloth_error *error)
{
    const struct model *model = cloths->model;
    size_t n = 0;
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        code = check_bending(model, model->cloths + c, error);
        for (uint32_t f = 0; f < model->cloths[c].n_folds; f++)
            n += model->cloths[c].folds[f].n;
    }
    if (code || !n)
        return code;
    cloths->fold = cloth_alloc(n, sizeof *cloths->fold, error);
    if (!cloths->fold)
        return CLOTH_E_MEMORY;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        add_folds(cloths, c);
    qsort(cloths->fold, cloths->n_folds, sizeof *cloths->fold, cloth_by_three);
    code = folds_check_once(cloths, error);
    for (uint32_t c = 0; c < model->n_cloths && !code; c++)
        if (model->cloths[c].n_folds)
            turn_folds(cloths, c);
    return code;
}

/* ---- Folds without a hinge ---- */

/* Marks the folds of seams. A fold on both sides would be given twice. */
static int mark_seams(const struct element_cloths *cloths, unsigned char *mark,
                      struct cloth_error *error)
{
    for (uint32_t s = 0; s < cloths->n_seams; s++) {
        const struct element_fold *fold[2];
        for (int k = 0; k < 2; k++) {
            const struct element_side *side = cloths->seam[s].side + k;
            fold[k] = folds_find(cloths, side->cloth, side->corner[0], side->corner[1]);
            if (fold[k])
                mark[fold[k] - cloths->fold] = 1;
        }
        if (fold[0] && fold[1])
            return model_fail(fold[1]->of->place, error,
                              "the edge between vertices %u and %u of cloth '%.60s' is folded on "
                              "both sides of a weld; one of them is expected",
                              fold[1]->a, fold[1]->b, cloths->model->cloths[fold[1]->cloth].name);
    }
    return CLOTH_OK;
}

static int check_marked(const struct element_cloths *cloths, const unsigned char *mark,
                        struct cloth_error *error)
{
    for (uint32_t i = 0; i < cloths->n_folds; i++) {
        const struct element_fold *fold = cloths->fold + i;
        const struct mesh_edge *edge =
            mesh_edges_get(cloths->edges + fold->cloth, fold->a, fold->b);
        if (!mark[i] && !fold->of->sewn && !element_is_hinge(edge))
            return model_fail(fold->of->place, error,
                              "the edge between vertices %u and %u of cloth '%.60s' has no "
                              "triangles on both sides, so nothing folds there; an edge inside "
                              "the cloth, or one that is welded, is expected",
                              fold->a, fold->b, cloths->model->cloths[fold->cloth].name);
    }
    return CLOTH_OK;
}

int element_folds_check(const struct element_cloths *cloths, struct cloth_error *error)
{
    if (!cloths->n_folds)
        return CLOTH_OK;
    unsigned char *mark = cloth_alloc(cloths->n_folds, 1, error);
    int code = mark ? mark_seams(cloths, mark, error) : CLOTH_E_MEMORY;
    if (!code)
        code = check_marked(cloths, mark, error);
    free(mark);
    return code;
}
