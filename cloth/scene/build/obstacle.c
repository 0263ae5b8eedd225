/* Obstacles, and the check that they leave the cloths some room. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double TOUCH = 1e-9; /* m: planes that overlap by less touch */
static const double BOUND = 1e6;  /* m: beyond it there is no cloth either */
static const double LEAST_EXTENT = 0.01, MAX_EXTENT = 10; /* m: of a figure, or furniture */

/* Refuses a number, or a list of numbers, beyond the bound of a scene. what: "the radius of a
 * sphere". */
static int check_bound(const double *value, size_t n, const char *what,
                       const struct scene_tree *tree, int node)
{
    for (size_t i = 0; i < n; i++)
        if (!(fabs(value[i]) < BOUND))
            return scene_tree_fail(tree, scene_tree_part(tree, node, i),
                                   "%s is %g m; a magnitude of less than %g m is expected", what,
                                   value[i], BOUND);
    return CLOTH_OK;
}

/* The numbers of a parameter; its range is that of the schema, which also has its default. */
static int build_parameter(double *value, const struct contact_kind *kind,
                           const struct contact_parameter *parameter, const struct scene_tree *tree,
                           int node)
{
    char what[80];
    snprintf(what, sizeof what, "the %s of a %s", parameter->name, kind->name);
    if (parameter->role == CONTACT_DIRECTION)
        return scene_build_direction(value, what, tree, node);
    if (parameter->role == CONTACT_ROTATION)
        return scene_build_rotation(value, what, tree, node);
    const size_t n = contact_role_size(parameter->role);
    scene_tree_vector(tree, node, n, value);
    return check_bound(value, n, what, tree, node);
}

static int check_motion(const struct model_motion *motion, const struct scene_tree *tree, int node)
{
    const int translate = scene_tree_get(tree, node, "translate");
    double shift[3];
    int code = check_bound(motion->about, 3, "the about of a motion", tree,
                           scene_tree_get(tree, node, "about"));
    for (size_t k = 0; k < scene_tree_length(tree, translate) && !code; k++) {
        scene_tree_vector(tree, scene_tree_item(tree, translate, k), 3, shift);
        code = check_bound(shift, 3, "a translate of a motion", tree,
                           scene_tree_item(tree, translate, k));
    }
    return code;
}

static int build_shape_motion(struct contact_shape *shape, const struct scene_tree *tree, int node)
{
    struct model_motion motion;
    if (scene_build_motion(&motion, tree, node) || check_motion(&motion, tree, node))
        return tree->error->code;
    shape->first = motion.first;
    shape->n = motion.n;
    memcpy(shape->about, motion.about, sizeof shape->about);
    return CLOTH_OK;
}

/* The node that says what a body is. */
static int source_of(const struct scene_tree *tree, int node)
{
    static const char *const keys[] = {"obj", "file", "ellipsoid", "mannequin"};
    size_t i = 0;
    while (!scene_tree_get(tree, node, keys[i]))
        i++;
    return scene_tree_get(tree, node, keys[i]);
}

static int build_ellipsoid(struct mesh *mesh, struct scene_tree *tree, int node)
{
    double half[3];
    scene_tree_vector(tree, node, 3, half);
    return check_bound(half, 3, "half an axis of an ellipsoid", tree, node) ||
           mesh_ellipsoid(mesh, half, tree->error);
}

/* The mesh of a body, where it starts, and its frames if it has any. */
static int build_body_mesh(struct mesh *mesh, struct contact_frames *frames, double **place,
                           struct scene_tree *tree, int node)
{
    struct mesh_transform transform = {0};
    const int source = source_of(tree, node);
    if (scene_fill(&transform, &scene_body, tree, node) ||
        scene_build_transform(&transform, tree, node) ||
        (scene_tree_scalar(tree, source)
             ? scene_build_obj(mesh, mesh_read_surface, "body", tree, source)
         : scene_tree_is(tree, source, YAML_SEQUENCE_NODE)
             ? build_ellipsoid(mesh, tree, source)
             : scene_build_mannequin(mesh, &transform, frames, place, tree, node)))
        return tree->error->code;
    mesh_apply(mesh, &transform);
    return scene_tree_get(tree, node, "frames") &&
           scene_build_frames(frames, place, mesh, &transform, tree, node);
}

/* Warns of a body of another size than cloth is worn on: files are often in other units. */
static int warn_of_body(const struct scene_tree *tree, int file, bool turned)
{
    const struct contact_body *body =
        contact_bodies_at(&tree->model->bodies, tree->model->bodies.n);
    double extent = 0;
    for (int c = 0; c < 3; c++)
        extent = fmax(extent, body->high[c] - body->low[c]);
    if (turned)
        scene_build_warn(tree, file,
                         "the mesh of a body is inside out: its triangles are clockwise as seen "
                         "from outside; they are turned round");
    if (extent < LEAST_EXTENT || extent > MAX_EXTENT)
        scene_build_warn(tree, file,
                         "the body is %g m long in its largest extent, %s than %g m: is its mesh "
                         "in metres? units: cm reads centimetres",
                         extent, extent > MAX_EXTENT ? "more" : "less",
                         extent > MAX_EXTENT ? MAX_EXTENT : LEAST_EXTENT);
    return tree->error->code;
}

/* The maps that a body is met by, if it is. */
static void build_view(struct contact_shape *shape, const struct scene_tree *tree, int node)
{
    const char *along = scene_tree_text(tree, node, "view");
    const uint32_t axis = (uint32_t)scene_word_value(scene_views, along, NULL);
    if (scene_word_value(scene_meets, scene_tree_text(tree, node, "meet"), NULL))
        contact_view_make(contact_bodies_at(&tree->model->bodies, shape->body), axis,
                          (uint32_t)scene_tree_number(tree, node, "resolution"), &shape->view);
}

static int obstacle_build_body(struct contact_shape *shape, struct scene_tree *tree, int node)
{
    struct contact_bodies *bodies = &tree->model->bodies;
    struct mesh mesh = {0};
    struct contact_frames frames = {0};
    double *place = NULL;
    char what[220];
    const int source = source_of(tree, node);
    const char *file = scene_tree_scalar(tree, source);
    bool turned = false;
    int code =
        build_body_mesh(&mesh, &frames, &place, tree, node) ||
        contact_bodies_add_frames(bodies, &mesh, frames.n ? &frames : NULL, &turned, &tree->inner);
    snprintf(what, sizeof what, "body: %.200s",
             file ? file : "the mesh of the figure, or of the ellipsoid");
    code = scene_build_blame(code, what, tree, source) || warn_of_body(tree, source, turned) ||
           scene_build_warn_crossed(&mesh, place, tree, source);
    shape->body = bodies->n;
    if (!code)
        build_view(shape, tree, node);
    mesh_free(&mesh);
    free(place);
    return code;
}

static int build_shape(struct contact_shape *shape, struct scene_tree *tree, int obstacle)
{
    int node = 0, code = CLOTH_OK;
    while (!(node = scene_tree_get(tree, obstacle, contact_kinds[shape->kind]->name)))
        shape->kind++;
    const struct contact_kind *kind = contact_kinds[shape->kind];
    double *value = shape->value;
    for (const struct contact_parameter *p = kind->parameter; p->name && !code; p++) {
        code = build_parameter(value, kind, p, tree, scene_tree_get(tree, node, p->name));
        value += contact_role_size(p->role);
    }
    shape->friction = scene_tree_get(tree, node, "friction")
                          ? scene_tree_number(tree, node, "friction")
                          : tree->model->contact.friction;
    if (scene_tree_get(tree, node, "thickness"))
        shape->thickness = scene_tree_number(tree, node, "thickness");
    const int motion = scene_tree_get(tree, node, "motion");
    return code || (kind == &contact_body_kind && obstacle_build_body(shape, tree, node)) ||
           (motion && build_shape_motion(shape, tree, motion));
}

/* So that contact.pairs and contact.ignore can say it. */
static int name_obstacle(uint32_t i, const struct scene_tree *tree, int obstacle)
{
    const int shape = scene_tree_pair(tree, obstacle, 0).value;
    const int node = scene_tree_get(tree, shape, "name");
    if (!node)
        return CLOTH_OK;
    if (scene_build_name(tree, SCENE_OBSTACLES, i, shape))
        return tree->error->code;
    const char *name = scene_tree_scalar(tree, node);
    if (scene_build_find(tree->model, SCENE_MATERIALS, name) == UINT32_MAX)
        return CLOTH_OK;
    return scene_tree_fail(tree, node,
                           "an obstacle is named '%.60s', as a material is; another name is "
                           "expected, since contact.pairs has names of both",
                           name);
}

int scene_build_obstacles(struct scene_tree *tree)
{
    struct model *model = tree->model;
    const int list = scene_tree_get(tree, 1, "obstacles");
    const size_t n = scene_tree_length(tree, list);
    model->obstacles = cloth_alloc(n, sizeof *model->obstacles, tree->error);
    model->obstacle_names = cloth_alloc(n, sizeof *model->obstacle_names, tree->error);
    int code = tree->error->code;
    model->n_obstacles = code ? 0 : (uint32_t)n;
    for (uint32_t i = 0; !code && i < n; i++) {
        const int node = scene_tree_item(tree, list, i);
        code = build_shape(model->obstacles + i, tree, node) || name_obstacle(i, tree, node);
    }
    return code;
}

/* The normal of a plane, behind a point of it. */
static const double *normal_of(const struct contact_shape *plane)
{
    return plane->value + contact_role_size(CONTACT_POINT);
}

static bool is_still_plane(const struct contact_shape *shape)
{
    return contact_kinds[shape->kind] == &contact_plane && !shape->n;
}

/* The height of a point above a plane, towards its free side. */
static double height_above(const struct contact_shape *plane, const double x[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += normal_of(plane)[i] * (x[i] - plane->value[i]);
    return sum;
}

/* The middle of the box around a mesh, and how far from it the corners of the box are. */
static double surround_mesh(const struct mesh *mesh, double middle[3])
{
    double square = 0, low[3], high[3];
    mesh_box(mesh, low, high);
    for (int i = 0; i < 3; i++) {
        middle[i] = (low[i] + high[i]) / 2;
        square += (high[i] - low[i]) * (high[i] - low[i]) / 4;
    }
    return sqrt(square);
}

/* True if no point within `radius` of the middle is on the free sides of both planes: the sum of
 * both heights is below 0 there. It grows only along the sum of the normals. */
static bool planes_exclude(const struct contact_shape *a, const struct contact_shape *b,
                           const double middle[3], double radius)
{
    const double *na = normal_of(a), *nb = normal_of(b);
    double cosine = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        cosine += na[i] * nb[i];
        square += (na[i] + nb[i]) * (na[i] + nb[i]);
    }
    return cosine < 0 &&
           height_above(a, middle) + height_above(b, middle) + radius * sqrt(square) < -TOUCH;
}

static int check_pair(const struct scene_tree *tree, uint32_t a, uint32_t b)
{
    const struct model *model = tree->model;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        double middle[3];
        const double radius = surround_mesh(&cloth->mesh, middle);
        if (planes_exclude(model->obstacles + a, model->obstacles + b, middle, radius))
            return scene_tree_fail(
                tree, scene_tree_item(tree, scene_tree_get(tree, 1, "obstacles"), b),
                "obstacles[%u] and obstacles[%u] face each other and overlap: around cloth '%.60s' "
                "no point is on the free sides of both; turn a normal round, or move a plane",
                b, a, cloth->name);
    }
    return CLOTH_OK;
}

int scene_build_check_obstacles(struct scene_tree *tree)
{
    const struct model *model = tree->model;
    int code = CLOTH_OK;
    for (uint32_t b = 0; b < model->n_obstacles; b++)
        for (uint32_t a = 0; a < b && !code; a++)
            if (is_still_plane(model->obstacles + a) && is_still_plane(model->obstacles + b))
                code = check_pair(tree, a, b);
    return code;
}
