/* A body that is a figure: its mesh, and its frames if it moves. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdlib.h>

static const double MOST_BYTES = 4e9; /* of all frames */

/* ---- The figure asked for ---- */

static int check_angles(const struct mannequin_pose *pose, const struct scene_tree *tree, int node)
{
    for (uint32_t i = 0; i < MANNEQUIN_ANGLES; i++) {
        const bool right = i >= MANNEQUIN_SIDE;
        const uint32_t k = right ? i - MANNEQUIN_SIDE + MANNEQUIN_ARM_ASIDE : i;
        const struct mannequin_limit *limit = &mannequin_limits[k];
        const char *side = k < MANNEQUIN_ARM_ASIDE ? "" : right ? "right_" : "left_";
        if (!(pose->angle[i] >= limit->least && pose->angle[i] <= limit->most))
            return scene_tree_fail(tree, node, "%s%s is %g degrees; %g to %g are expected", side,
                                   limit->name, pose->angle[i], limit->least, limit->most);
    }
    return CLOTH_OK;
}

static int check_poses(const struct scene_figure *figure, const struct scene_tree *tree, int list)
{
    int code = CLOTH_OK;
    for (uint32_t k = 0; k < figure->n_poses && !code; k++) {
        const int node = scene_tree_item(tree, list, k);
        code = check_angles(&figure->poses[k], tree, node);
        if (!code && k > 0 && !(figure->poses[k].time > figure->poses[k - 1].time))
            code = scene_tree_fail(tree, node,
                                   "the time of a pose is %g s, after one of %g s; times in "
                                   "ascending order are expected",
                                   figure->poses[k].time, figure->poses[k - 1].time);
    }
    return code;
}

static int check_figure(const struct scene_figure *figure, const struct scene_tree *tree, int body)
{
    const int node = scene_tree_get(tree, body, "mannequin");
    const int walk = scene_tree_get(tree, node, "walk"),
              poses = scene_tree_get(tree, node, "poses");
    const int frames = scene_tree_get(tree, body, "frames");
    const int motion = scene_tree_get(tree, body, "motion");
    if (walk && poses)
        return scene_tree_fail(tree, poses,
                               "a figure that has both walk and poses; one of them is expected");
    if ((walk || poses) && (frames || motion))
        return scene_tree_fail(tree, frames ? frames : motion,
                               "a figure with %s has no %s: they say where it is",
                               walk ? "a walk" : "poses", frames ? "frames" : "motion");
    if (walk && figure->walk.speed > MANNEQUIN_MOST_SPEED)
        return scene_tree_fail(tree, scene_tree_get(tree, walk, "speed"),
                               "the speed of a walk is %g steps a second; at most %g are expected",
                               figure->walk.speed, MANNEQUIN_MOST_SPEED);
    return check_poses(figure, tree, poses);
}

/* ---- Frames ---- */

/* From time 0 to the end of the run, and one more for what is rounded. node: of the figure. */
static int build_frames(const struct scene_figure *figure, const struct scene_made_part *made,
                        const struct mesh_transform *transform, struct contact_frames *frames,
                        double **place, const struct scene_tree *tree, int node)
{
    const size_t stride = 3 * (size_t)made->mesh.n_vertices;
    const double n = ceil(tree->model->end * figure->fps) + 2;
    const double bytes = n * (double)stride * sizeof **place;
    if (!(bytes <= MOST_BYTES))
        return scene_tree_fail(tree, node,
                               "the frames of the figure until time.end, %g a second, take %.3g "
                               "GB; at most %g are expected: use a lower fps",
                               figure->fps, bytes / 1e9, MOST_BYTES / 1e9);
    *frames = (struct contact_frames){.n = (uint32_t)n, .rate = figure->fps};
    *place = cloth_alloc(frames->n, stride * sizeof **place, tree->error);
    for (uint32_t k = 0; *place && k < frames->n; k++) {
        double angle[MANNEQUIN_ANGLES], *x = *place + k * stride;
        struct mesh moved = {.n_vertices = made->mesh.n_vertices, .position = x};
        if (figure->n_poses)
            mannequin_pose_at(figure->poses, figure->n_poses, k / figure->fps, angle);
        else
            mannequin_walk_at(&figure->walk, k / figure->fps, angle);
        mannequin_place(&made->rig, &made->mesh, angle, (double(*)[3])(void *)x);
        mesh_apply(&moved, transform);
    }
    frames->place = (const double(*)[3])(void *)*place;
    return tree->error->code;
}

static int make_figure(struct scene_made_part *to, const struct mannequin *asked,
                       struct scene_tree *tree, int node)
{
    if (to->is_made)
        return CLOTH_OK;
    const int code = mannequin_make(&to->mesh, &to->rig, asked, NULL, &tree->inner);
    to->is_made = !code;
    return scene_build_blame(code, "mannequin", tree, node);
}

int scene_build_mannequin(struct mesh *mesh, const struct mesh_transform *transform,
                          struct contact_frames *frames, double **place, struct scene_tree *tree,
                          int body)
{
    const int node = scene_tree_get(tree, body, "mannequin");
    const bool walks = scene_tree_get(tree, node, "walk");
    struct scene_figure figure = {0};
    struct scene_made_part *made = NULL;
    const int code = scene_fill(&figure, &scene_mannequin, tree, node) ||
                     check_figure(&figure, tree, body) ||
                     !(made = scene_made_part(tree->made, &figure.mannequin,
                                              sizeof figure.mannequin, tree->error)) ||
                     make_figure(made, &figure.mannequin, tree, node) ||
                     ((figure.n_poses || walks) &&
                      build_frames(&figure, made, transform, frames, place, tree, node)) ||
                     mesh_inline(mesh, made->mesh.n_vertices, made->mesh.position, 0, NULL,
                                 made->mesh.n_triangles, made->mesh.triangle, tree->error);
    free(figure.poses);
    return code;
}
