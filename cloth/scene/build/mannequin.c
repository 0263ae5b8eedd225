/* A body that is a figure: its mesh, and its frames if it moves. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/build/made.h"
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdlib.h>

static const double MOST_BYTES = 4e9; /* of all frames */

/* ---- The figure asked for ---- */

static int check_angles(const struct mannequin_pose *pose, const struct scene_tree *tree, int node,
                        struct cloth_error *error)
{
    for (uint32_t i = 0; i < MANNEQUIN_ANGLES; i++) {
        const bool right = i >= MANNEQUIN_SIDE;
        const uint32_t k = right ? i - MANNEQUIN_SIDE + MANNEQUIN_ARM_ASIDE : i;
        const struct mannequin_limit *limit = &mannequin_limits[k];
        const char *side = k < MANNEQUIN_ARM_ASIDE ? "" : right ? "right_" : "left_";
        if (!(pose->angle[i] >= limit->least && pose->angle[i] <= limit->most))
            return scene_tree_fail(tree, node, error, "%s%s is %g degrees; %g to %g are expected",
                                   side, limit->name, pose->angle[i], limit->least, limit->most);
    }
    return CLOTH_OK;
}

static int check_poses(const struct scene_figure *figure, const struct scene_tree *tree, int list,
                       struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t k = 0; k < figure->n_poses && !code; k++) {
        const int node = scene_tree_item(tree, list, k);
        code = check_angles(&figure->poses[k], tree, node, error);
        if (!code && k > 0 && !(figure->poses[k].time > figure->poses[k - 1].time))
            code = scene_tree_fail(tree, node, error,
                                   "the time of a pose is %g s, after one of %g s; times in "
                                   "ascending order are expected",
                                   figure->poses[k].time, figure->poses[k - 1].time);
    }
    return code;
}

static int check_figure(const struct scene_figure *figure, const struct scene_tree *tree, int body,
                        struct cloth_error *error)
{
    const int node = scene_tree_get(tree, body, "mannequin");
    const int walk = scene_tree_get(tree, node, "walk"),
              poses = scene_tree_get(tree, node, "poses");
    const int frames = scene_tree_get(tree, body, "frames");
    const int motion = scene_tree_get(tree, body, "motion");
    if (walk && poses)
        return scene_tree_fail(tree, poses, error,
                               "a figure that has both walk and poses; one of them is expected");
    if ((walk || poses) && (frames || motion))
        return scene_tree_fail(tree, frames ? frames : motion, error,
                               "a figure with %s has no %s: they say where it is",
                               walk ? "a walk" : "poses", frames ? "frames" : "motion");
    if (walk && figure->walk.speed > MANNEQUIN_MOST_SPEED)
        return scene_tree_fail(tree, scene_tree_get(tree, walk, "speed"), error,
                               "the speed of a walk is %g steps a second; at most %g are expected",
                               figure->walk.speed, MANNEQUIN_MOST_SPEED);
    return check_poses(figure, tree, poses, error);
}

/* ---- Frames ---- */

/* The figure that is built, and its place. */
struct building {
    double end; /* s: of the run */
    struct scene_figure figure;
    const struct scene_made_part *made;
    const struct mesh_transform *transform;
    const struct scene_tree *tree;
    int node; /* of the figure */
    struct cloth_error *error;
};

/* From time 0 to the end of the run, and one more for what is rounded. */
static int build_frames(const struct building *building, struct contact_frames *frames,
                        double **place)
{
    const struct scene_figure *figure = &building->figure;
    const size_t stride = 3 * (size_t)building->made->mesh.n_vertices;
    const double n = ceil(building->end * figure->fps) + 2;
    const double bytes = n * (double)stride * sizeof **place;
    if (!(bytes <= MOST_BYTES))
        return scene_tree_fail(building->tree, building->node, building->error,
                               "the frames of the figure until time.end, %g a second, take %.3g "
                               "GB; at most %g are expected: use a lower fps",
                               figure->fps, bytes / 1e9, MOST_BYTES / 1e9);
    *frames = (struct contact_frames){.n = (uint32_t)n, .rate = figure->fps};
    *place = scene_build_array(frames->n, stride * sizeof **place, building->error);
    for (uint32_t k = 0; *place && k < frames->n; k++) {
        double angle[MANNEQUIN_ANGLES], *x = *place + k * stride;
        struct mesh moved = {.n_vertices = building->made->mesh.n_vertices, .position = x};
        if (figure->n_poses)
            mannequin_pose_at(figure->poses, figure->n_poses, k / figure->fps, angle);
        else
            mannequin_walk_at(&figure->walk, k / figure->fps, angle);
        mannequin_place(&building->made->rig, &building->made->mesh, angle,
                        (double(*)[3])(void *)x);
        mesh_apply(&moved, building->transform);
    }
    frames->place = (const double(*)[3])(void *)*place;
    return *place ? CLOTH_OK : building->error->code;
}

static int make_figure(struct building *building)
{
    struct cloth_error inner = {0};
    const struct mannequin *asked = &building->figure.mannequin;
    struct scene_made_part *of =
        scene_made_part(building->tree->made, asked, sizeof *asked, building->error);
    building->made = of;
    if (!of || of->is_made)
        return of ? CLOTH_OK : building->error->code;
    const int code = mannequin_make_rigged(&of->mesh, &of->rig, asked, NULL, &inner);
    of->is_made = !code;
    return scene_build_blame(code, &inner, "mannequin", building->tree, building->node,
                             building->error);
}

int scene_build_mannequin(const struct model *model, struct mesh *mesh,
                          const struct mesh_transform *transform, struct contact_frames *frames,
                          double **place, struct scene_tree *tree, int body,
                          struct cloth_error *error)
{
    struct building building = {.end = model->end,
                                .transform = transform,
                                .tree = tree,
                                .node = scene_tree_get(tree, body, "mannequin"),
                                .error = error};
    int code = scene_fill(&building.figure, &scene_mannequin, tree, building.node, error);
    code = code ? code : check_figure(&building.figure, tree, body, error);
    code = code ? code : make_figure(&building);
    if (!code && (building.figure.n_poses || scene_tree_get(tree, building.node, "walk")))
        code = build_frames(&building, frames, place);
    if (!code) {
        const struct mesh *of = &building.made->mesh;
        code = mesh_inline(mesh, of->n_vertices, of->position, 0, NULL, of->n_triangles,
                           of->triangle, error);
    }
    if (!code)
        mesh_apply(mesh, transform);
    free(building.figure.poses);
    return code;
}
