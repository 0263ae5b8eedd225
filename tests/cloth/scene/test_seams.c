/* Seams of cloths: which pairs become joints or welds, and what a sewn garment is made of: the
 * numbers of vertices, edges and triangles that its pattern predicts, and the mass of its panels.
 */
#include "cloth/flow/state/flow.h"
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RECTANGLE                                                                                  \
    "\"vertices\": [[0, 0], [20, 0], [20, 30], [0, 30]], \"edges\": [{\"endpoints\": [0, 1]}, "    \
    "{\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]}, {\"endpoints\": [3, 0]}]"
#define STITCH(a, b)                                                                               \
    "[{\"panel\": \"front\", \"edge\": " #a "}, {\"panel\": \"back\", \"edge\": " #b "}]"

/* Two rectangles face to face, 3 cm from each other, sewn along one, two or all edges. */
static const char *const PANELS =
    "{\"pattern\": {\"panels\": {\n"
    "  \"front\": {" RECTANGLE ",\n    \"translation\": [0, 0, 3], \"rotation\": [0, 0, 0]},\n"
    "  \"back\": {" RECTANGLE ",\n    \"translation\": [20, 0, 0], \"rotation\": [0, 180, 0]}\n"
    "  %s},\n"
    "  \"stitches\": [%s]},\n"
    " \"properties\": {\"curvature_coords\": \"relative\", \"units_in_meter\": 100}}\n";
#define TOP_OF    ", \"top\": {" RECTANGLE ", \"translation\": [300, 60, 0], \"rotation\": [0, 0, 0]}"
#define SIDES_OF  STITCH(1, 3) ", " STITCH(3, 1)
#define BAG_OF    STITCH(0, 0) ", " SIDES_OF
#define PILLOW_OF STITCH(2, 2) ", " BAG_OF

static char *scene_of(const char *stitches, const char *keys)
{
    char *pattern = NULL, *text = NULL;
    ck_assert_int_ge(asprintf(&pattern, PANELS, strstr(stitches, "top") ? TOP_OF : "", stitches),
                     0);
    scene_write_file("panels.json", pattern, strlen(pattern));
    free(pattern);
    ck_assert_int_ge(asprintf(&text,
                              "schema: 1\ncloths:\n  - name: bag\n    mesh: {pattern: {file: "
                              "panels.json, edge: 0.03}}\n    material: m\n    seams: %s\n"
                              "materials: {m: {model: triangles, density: 0.25, stretch: 100, "
                              "shear: 30, bending: {rigidity: 2.0e-5}}}\n"
                              "time: {h: 0.01, end: 0.1}\n",
                              keys),
                     0);
    return text;
}

static struct model read_scene(const char *stitches, const char *keys)
{
    char *text = scene_of(stitches, keys);
    struct model model = scene_read_right(text, 0, NULL);
    free(text);
    return model;
}

/* The sides of the front sewn to the same sides of the back, which faces the other way: the threads
 * go across the bag, and through each other. */
UNIT_LOOP(seams_that_cross, 0, 2)
{
    static const char *const stitches[] = {SIDES_OF, STITCH(1, 1) ", " STITCH(3, 3)};
    UNIT_OWNED(model_free) struct model model = read_scene(stitches[_i], "{state: pulled}");
    ck_assert_uint_eq(model.n_warnings, (uint32_t)_i);
    if (_i)
        unit_says(model.warnings[0],
                  ":6:12: seam 0 of cloth 'bag' (edge 1 of panel 'front', edge 1 of panel "
                  "'back') and seam 1 of cloth 'bag' (edge 3 of panel 'front', edge 3 of panel "
                  "'back') cross where the run starts: what they pull goes through each other");
}

/* A bag's corner at the bottom is in two seams: the second has one pair less. */
UNIT_TEST(joints_of_seams)
{
    UNIT_OWNED(model_free) struct model model = read_scene(BAG_OF, "{state: pulled}");
    ck_assert_uint_eq(model.n_joints, 3);
    ck_assert_uint_eq(model.n_pulled, 3);
    const struct model_seam *seam = model.cloths[0].seams.seam;
    for (uint32_t j = 0; j < 3; j++) {
        const struct model_joint *joint = model.joints + j;
        ck_assert_uint_eq(joint->pairs.seam, j + 1);
        ck_assert_uint_eq(joint->pairs.end[0].n, seam[j].n_pairs - (j > 0));
        ck_assert_uint_eq(joint->pairs.end[1].n, joint->pairs.end[0].n);
        ck_assert_double_eq(joint->stiffness, 200);
        ck_assert_double_eq_tol(joint->damping, 20, 1e-12);
        ck_assert_double_eq(joint->length, 0);
        for (uint32_t i = 0; i < joint->pairs.end[0].n; i++) {
            const double *x = model.cloths[0].mesh.position;
            const double *a = x + 3 * (size_t)joint->pairs.end[0].vertices[i];
            const double *b = x + 3 * (size_t)joint->pairs.end[1].vertices[i];
            ck_assert_double_eq_tol(hypot(a[0] - b[0], a[1] - b[1]), 0, 1e-12);
            ck_assert_uint_eq(model.contact.apart.joined[joint->pairs.end[1].vertices[i]],
                              joint->pairs.end[0].vertices[i]);
        }
    }
}

UNIT_TEST(keys_of_seams)
{
    UNIT_OWNED(model_free)
    struct model model = read_scene(SIDES_OF, "{stiffness: 50, damping: 3, reversed: [1]}");
    ck_assert_double_eq(model.joints[0].stiffness, 50);
    ck_assert_double_eq(model.joints[0].damping, 3);
    const struct model_seam *seam = model.cloths[0].seams.seam;
    ck_assert(seam[0].reversed && !seam[1].reversed);
    ck_assert_str_eq(seam[1].side[0].panel, "front");
    ck_assert_uint_eq(seam[1].side[0].edge, 3);
    const double *x = model.cloths[0].mesh.position;
    ck_assert_double_eq_tol(
        fabs(x[3 * (size_t)seam[1].pair[0][0] + 1] - x[3 * (size_t)seam[1].pair[0][1] + 1]), 0.3,
        1e-12);
    model_free(&model);
    model = read_scene(SIDES_OF, "{state: open}");
    ck_assert_uint_eq(model.n_joints + model.n_welds + model.n_pulled, 0);
    ck_assert_ptr_null(model.contact.apart.joined);
}

/* ---- Some seams that are sewn otherwise than the cloth ---- */

/* How many joints and welds there are, of those seams (from 1, 0: of no more). */
struct some {
    const char *keys;
    uint32_t joint[3], weld[3];
    double stiffness, damping; /* of the first joint */
};
static const struct some SOME[] = {
    {"{state: open, some: [{numbers: [1], state: pulled, stiffness: 50}]}", {2}, {0}, 50, 5},
    {"{some: [{of: [front, back], stiffness: 50}, {numbers: [0, 2], state: open}]}",
     {2},
     {0},
     50,
     5},
    {"{damping: 3, some: [{of: ['ba*', '*nt'], stiffness: 50}, {numbers: [1, 2], state: welded}]}",
     {1},
     {2, 3},
     50,
     3},
    {"{stiffness: 10, some: [{numbers: [0], damping: 7}, {numbers: [0], stiffness: 20}]}",
     {1, 2, 3},
     {0},
     20,
     7},
    {"{state: welded, some: []}", {0}, {1, 2, 3}, 0, 0}};

UNIT_LOOP(some_seams, 0, sizeof SOME / sizeof *SOME)
{
    const struct some *some = SOME + _i;
    UNIT_OWNED(model_free) struct model model = read_scene(BAG_OF, some->keys);
    for (uint32_t i = 0; i < 3; i++) {
        ck_assert_uint_eq(i < model.n_joints ? model.joints[i].pairs.seam : 0, some->joint[i]);
        ck_assert_uint_eq(i < model.n_welds ? model.welds[i].pairs.seam : 0, some->weld[i]);
    }
    ck_assert_uint_eq(model.n_pulled, model.n_joints);
    if (model.n_joints) {
        ck_assert_double_eq(model.joints[0].stiffness, some->stiffness);
        ck_assert_double_eq_tol(model.joints[0].damping, some->damping, 1e-12);
    }
}

/* The bottom, which is pulled, ends in both sides, which are welded: their pairs stand first. */
UNIT_TEST(welds_come_before_joints)
{
    UNIT_OWNED(model_free)
    struct model model =
        read_scene(BAG_OF, "{tolerance: 0.031, some: [{numbers: [1, 2], state: welded}]}");
    struct flow *flow;
    const struct model_seam *seam = model.cloths[0].seams.seam;
    ck_assert_uint_eq(model.n_joints, 1);
    ck_assert_uint_eq(model.joints[0].pairs.end[0].n, seam[0].n_pairs - 2);
    ck_assert_uint_eq(model.welds[0].pairs.end[0].n, seam[1].n_pairs);
    const uint32_t *vertex = model.contact.apart.joined;
    for (uint32_t s = 0; s < 3; s++)
        for (uint32_t i = 0; i < seam[s].n_pairs; i++)
            ck_assert_uint_eq(vertex[seam[s].pair[i][0]], vertex[seam[s].pair[i][1]]);
    UNIT_FINE(flow_prepare(&flow, &model, 1, &error));
    flow_free(flow);
}

/* Three seams that meet at a corner, as of a box: where two are welded its three vertices are one,
 * and the third has no pair there. */
UNIT_TEST(corners_of_three_seams)
{
    static const char *const stitches =
        STITCH(0, 3) ", [{\"panel\": \"back\", \"edge\": 0}, {\"panel\": \"top\", \"edge\": 3}], "
                     "[{\"panel\": \"top\", \"edge\": 0}, {\"panel\": \"front\", \"edge\": 3}]";
    UNIT_OWNED(model_free)
    struct model model = read_scene(
        stitches, "{tolerance: 4, reversed: [0, 2], some: [{numbers: [0, 1], state: welded}]}");
    struct flow *flow;
    for (int s = 0; s < 3; s++)
        ck_assert(model.cloths[0].seams.seam[s].reversed);
    ck_assert_uint_eq(model.n_welds, 2);
    ck_assert_uint_eq(model.n_joints, 1);
    ck_assert_uint_eq(model.joints[0].pairs.end[0].n, model.cloths[0].seams.seam[2].n_pairs - 1);
    UNIT_FINE(flow_prepare(&flow, &model, 1, &error));
    flow_free(flow);
}

/* Sewn: what the pattern says of it. */
struct sewn {
    const char *stitches;
    int euler;
    double border; /* m */
};

struct side {
    uint32_t low, high;
    double length;
};

static int compare_sides(const void *va, const void *vb)
{
    const struct side *a = va, *b = vb;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    return (a->high > b->high) - (a->high < b->high);
}

static double length_of(const struct mesh *mesh, uint32_t a, uint32_t b)
{
    const double *x = mesh->position + 3 * (size_t)a, *y = mesh->position + 3 * (size_t)b;
    return hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]);
}

/* Edges of the sewn mesh, and the length of those with one triangle. */
static uint32_t count_edges(const struct mesh *mesh, const uint32_t *root, double *border)
{
    const uint32_t n = 3 * mesh->n_triangles;
    struct side *side = calloc(n, sizeof *side);
    uint32_t edges = 0;
    ck_assert_ptr_nonnull(side);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t *corner = mesh->triangle + i / 3 * 3;
        const uint32_t p = corner[i % 3], q = corner[(i + 1) % 3], a = root[p], b = root[q];
        side[i] = (struct side){a < b ? a : b, a < b ? b : a, length_of(mesh, p, q)};
    }
    qsort(side, n, sizeof *side, compare_sides);
    *border = 0;
    for (uint32_t i = 0, end; i < n; i = end, edges++) {
        for (end = i + 1; end < n && !compare_sides(side + i, side + end);)
            end++;
        ck_assert_uint_le(end - i, 2);
        *border += end - i == 1 ? side[i].length : 0;
    }
    free(side);
    return edges;
}

static const struct sewn GARMENTS[] = {{SIDES_OF, 0, 0.8}, {BAG_OF, 1, 0.4}, {PILLOW_OF, 2, 0}};

UNIT_LOOP(what_is_sewn, 0, sizeof GARMENTS / sizeof *GARMENTS)
{
    const struct sewn *sewn = GARMENTS + _i;
    UNIT_OWNED(model_free)
    struct model model = read_scene(sewn->stitches, "{state: welded, tolerance: 0.031}");
    struct flow *flow;
    UNIT_FINE(flow_prepare(&flow, &model, 1, &error));
    const struct flow_source *source = &flow->source;
    const struct model_seams *seams = &model.cloths[0].seams;
    const struct mesh *mesh = &model.cloths[0].mesh;
    uint32_t merged = 4, hinges = 0; /* the ends of seams are the corners, */
    double border, mass = 0;
    for (uint32_t s = 0; s < seams->n; s++) {
        merged += seams->seam[s].n_pairs - 2; /* this is what is between them */
        hinges += seams->seam[s].n_pairs - 1;
    }
    const uint32_t edges = count_edges(mesh, source->particles.welds.root, &border);
    ck_assert_uint_eq(source->blocks.n_places, mesh->n_vertices - merged);
    ck_assert_int_eq((int)source->blocks.n_places - (int)edges + (int)mesh->n_triangles,
                     sewn->euler);
    ck_assert_double_eq_tol(border, sewn->border, 1e-12);
    ck_assert_uint_eq(source->elements.n_seams, hinges);
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        mass += source->particles.mass[v];
    ck_assert_double_eq_tol(mass, 0.25 * 2 * 0.2 * 0.3, 1e-12);
    flow_free(flow);
}

struct hinges {
    uint32_t n;
    double stiffness, rest;
    const struct element_cloths *cloths;
};

/* A hinge across a seam: k and s0 of bending.h. */
static void take_hinge(void *to, const struct element *element)
{
    struct hinges *hinges = to;
    struct element_one one;
    if (!element->seam)
        return;
    element_alone(hinges->cloths, element, NULL, &one);
    hinges->n++;
    hinges->stiffness += one.number[0];
    hinges->rest = fmax(hinges->rest, fabs(one.number[2]));
}

/* They are flat at rest, though the panels lie face to face, and as stiff as the key says. */
UNIT_TEST(hinges_of_seams)
{
    double stiffness[4];
    static const char *const keys[4] = {"{state: welded, tolerance: 0.031}",
                                        "{state: welded, tolerance: 0.031, bending: 2.0e-5}",
                                        "{state: welded, tolerance: 0.031, bending: 6.0e-5}",
                                        ("{state: welded, tolerance: 0.031, bending: 2.0e-5, some: "
                                         "[{numbers: [1], bending: 6e-5}]}")};
    for (int i = 0; i < 4; i++) {
        UNIT_OWNED(model_free) struct model model = read_scene(SIDES_OF, keys[i]);
        struct flow *flow;
        UNIT_FINE(flow_prepare(&flow, &model, 1, &error));
        struct hinges hinges = {.cloths = &flow->source.elements};
        element_each(&flow->source.elements, take_hinge, &hinges);
        ck_assert_uint_eq(hinges.n, flow->source.elements.n_seams);
        ck_assert_double_eq(hinges.rest, 0);
        stiffness[i] = hinges.stiffness;
        flow_free(flow);
    }
    ck_assert_double_gt(stiffness[0], 0);
    ck_assert_double_eq_tol(stiffness[1], stiffness[0], 1e-12 * stiffness[0]);
    ck_assert_double_eq_tol(stiffness[2], 3 * stiffness[0], 1e-12 * stiffness[2]);
    ck_assert_double_gt(stiffness[3],
                        1.9 * stiffness[0]); /* one of two sides, whose meshes differ */
    ck_assert_double_lt(stiffness[3], 2.1 * stiffness[0]);
}
