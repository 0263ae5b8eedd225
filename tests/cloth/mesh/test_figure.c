/* Meshes of other programs: a skinned figure against its closed form, one that hangs at a node, one
 * of two shapes; and files that are wrong. */
#include "tests/cloth/mesh/tools.h"
#include "tests/support/skinned.h"

#include <math.h>

static char folder[] = "/tmp/duite-figure.XXXXXX";

static void make_folder(void)
{
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static void remove_folder(void)
{
    char command[64];
    snprintf(command, sizeof command, "rm -r %s", folder);
    ck_assert_int_eq(system(command), 0);
}
UNIT_FIXTURE(make_folder, remove_folder)

static const char *path_of(const char *name)
{
    static char path[64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static const char *write_text(const char *name, const char *text)
{
    FILE *file = fopen(path_of(name), "w");
    ck_assert_ptr_nonnull(file);
    fputs(text, file);
    ck_assert_int_eq(fclose(file), 0);
    return path_of(name);
}

/* A figure, in a file, and its mesh. */
static struct mesh figure_of(const struct skinned *of)
{
    struct mesh mesh;
    ck_assert_int_eq(skinned_write(of, path_of("bend.glb")), 0);
    UNIT_FINE(mesh_read_surface(&mesh, path_of("bend.glb"), &error));
    return mesh;
}

#define NEAR 1e-7 /* m: floats of a file, of a figure of 1 m */

/* The wall's seam is whole; the clip's frames between keys lie on the arc. */
UNIT_TEST(a_cylinder_that_bends)
{
    const struct skinned of = {.around = 12, .along = 20, .keys = 4};
    UNIT_OWNED(mesh_free) struct mesh mesh = figure_of(&of);
    uint32_t n_frames;
    double *place;
    ck_assert_uint_eq(mesh.n_vertices, skinned_vertices(&of));
    ck_assert_uint_eq(mesh.n_triangles, skinned_triangles(&of));
    ck_assert_uint_ne(mesh_group_of(&mesh, "tube"), UINT32_MAX);
    ck_assert(mesh.uv && mesh.n_more_uv == of.along + 1);
    UNIT_FINE(mesh_read_clip(path_of("bend.glb"), mesh.n_vertices, "bend", 20, &n_frames, &place,
                             &error));
    ck_assert_uint_eq(n_frames, 21);
    for (uint32_t k = 0; k < n_frames; k++)
        for (uint32_t v = 0; v < mesh.n_vertices; v++) {
            double x[3];
            memcpy(x, mesh.position + 3 * v, sizeof x);
            skinned_bend(k / 20.0, x);
            for (int c = 0; c < 3; c++)
                ck_assert_double_eq_tol(place[3 * (k * mesh.n_vertices + v) + (uint32_t)c], x[c],
                                        NEAR);
        }
    free(place);
}

/* By FBX, whose column bends as the cylinder does; each vertex has one bone. */
UNIT_TEST(a_column_of_fbx)
{
    const char *top = getenv("srcdir");
    UNIT_OWNED(mesh_free) struct mesh mesh;
    char path[4096];
    uint32_t n_frames;
    double *place;
    snprintf(path, sizeof path, "%s/tests/cloth/mesh/column.fbx", top ? top : ".");
    UNIT_FINE(mesh_read_surface(&mesh, path, &error));
    ck_assert_uint_eq(mesh.n_vertices, 8);
    ck_assert_uint_eq(mesh.n_faces, 6);
    UNIT_FINE(mesh_read_clip(path, 8, "bend", 8, &n_frames, &place, &error));
    ck_assert_uint_eq(n_frames, 9);
    for (uint32_t k = 0; k < n_frames; k++)
        for (uint32_t v = 0; v < 8; v++) {
            double x[3];
            memcpy(x, mesh.position + 3 * v, sizeof x);
            skinned_bend(k / 8.0, x);
            for (uint32_t c = 0; c < 3; c++)
                ck_assert_double_eq_tol(place[3 * (8 * k + v) + c], x[c], NEAR);
        }
    free(place);
}

/* All of it turns about z at y = 0.5 m times the scale of the root. */
UNIT_TEST(a_mesh_that_hangs_at_a_node)
{
    const struct skinned of = {.around = 5, .along = 2, .keys = 2, .hangs = true, .scale = 2};
    UNIT_OWNED(mesh_free) struct mesh mesh = figure_of(&of);
    uint32_t n_frames;
    double *place, low[3], high[3];
    mesh_box(&mesh, low, high);
    ck_assert_double_eq_tol(low[1], 1, 2 * NEAR);
    ck_assert_double_eq_tol(high[1], 3, 2 * NEAR);
    UNIT_FINE(mesh_read_clip(path_of("bend.glb"), mesh.n_vertices, "first", 1, &n_frames, &place,
                             &error));
    ck_assert_uint_eq(n_frames, 2);
    for (uint32_t v = 0; v < mesh.n_vertices; v++) {
        const double *x = mesh.position + 3 * v, *to = place + 3 * (mesh.n_vertices + v);
        ck_assert_double_eq_tol(to[0], -(x[1] - 1), 4 * NEAR);
        ck_assert_double_eq_tol(to[1], x[0] + 1, 4 * NEAR);
        ck_assert_double_eq_tol(to[2], x[2], 4 * NEAR);
    }
    free(place);
}

/* One of the nodes of a file is read, by its name behind the path. */
UNIT_TEST(a_node_of_a_file)
{
    const struct skinned of = {.around = 3, .along = 1, .keys = 2};
    UNIT_OWNED(mesh_free) struct mesh mesh = figure_of(&of);
    char path[80];
    static const char *const names[] = {"tube", "figure", "upper"};
    for (int i = 0; i < 3; i++) {
        UNIT_OWNED(mesh_free) struct mesh part = {0};
        snprintf(path, sizeof path, "%s#%s", path_of("bend.glb"), names[i]);
        if (i < 2)
            UNIT_FINE(mesh_read_obj(&part, path, &error));
        else
            UNIT_REFUSED(mesh_read_obj(&part, path, &error), CLOTH_E_INPUT,
                         "bend.glb#upper: no node 'upper' has a mesh, nor what hangs at it; these "
                         "have one: 'tube'");
        ck_assert_uint_eq(part.n_vertices, i < 2 ? mesh.n_vertices : 0);
    }
}

/* A tetrahedron whose tip goes up by 1 m in 2 s: weights are 0 at the start and 1 at the end. */
static const char SHAPE[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
    "\"name\":"
    "\"tip\",\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
    "\"targets\":"
    "[{\"POSITION\":1}],\"indices\":2}],\"weights\":[0]}],\"animations\":[{\"name\":\"grow\","
    "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}}],\"samplers\":[{"
    "\"input\":3,\"output\":4}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
    "\"count\":4,"
    "\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},{"
    "\"bufferView\":2,\"componentType\":5125,\"count\":12,\"type\":\"SCALAR\"},{\"bufferView\":3,"
    "\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\"},{\"bufferView\":4,\"componentType\":"
    "5126,"
    "\"count\":2,\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,"
    "\"byteLength\":"
    "48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":96,"
    "\"byteLength\":48},{\"buffer\":0,\"byteOffset\":144,\"byteLength\":8},{\"buffer\":0,"
    "\"byteOffset\":152,\"byteLength\":8}],\"buffers\":[{\"byteLength\":160,\"uri\":"
    "\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAAAAAAAA"
    "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAEAAAACAAAAAAAAAAMAAAABAAAAAAAAAAIAAAADAAAA"
    "AQAAAAMAAAACAAAAAAAAAAAAAEAAAAAAAACAPw=="
    "\"}]}";

UNIT_TEST(a_mesh_of_two_shapes)
{
    UNIT_OWNED(mesh_free) struct mesh mesh;
    uint32_t n_frames;
    double *place;
    const char *path = write_text("grow.gltf", SHAPE);
    UNIT_FINE(mesh_read_obj(&mesh, path, &error));
    ck_assert_uint_eq(mesh.n_vertices, 4);
    UNIT_FINE(mesh_read_clip(path, 4, "grow", 4, &n_frames, &place, &error));
    ck_assert_uint_eq(n_frames, 9);
    for (uint32_t k = 0; k < n_frames; k++)
        ck_assert_double_eq_tol(place[12 * k + 10], 1 + k / 8.0, NEAR);
    free(place);
}

static const struct {
    const char *name, *text, *sentence;
} wrong[] = {
    {"a.glb", "no glTF", "a.glb: Assimp cannot read it: "},
    {"a.gltf", "{\"asset\":{\"version\":\"2.0\"}}",
     "a.gltf: Assimp cannot read it: GLTF: No scene"},
    {"a.fbx", "hello\n", "a.fbx: Assimp cannot read it: FBX"},
    {"a.dae", "<COLLADA>", "a.dae: Assimp cannot read it: "},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
     "z\nend_header\n0 0 0\n",
     "a.ply: "},
    {"a.stl",
     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex nan 0 0\nvertex 0 1 "
     "0\nendloop\n"
     "endfacet\nendsolid\n",
     "a.stl: "}};

UNIT_TEST(files_that_are_wrong)
{
    struct mesh mesh;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        UNIT_REFUSED(mesh_read_obj(&mesh, write_text(wrong[i].name, wrong[i].text), &error),
                     CLOTH_E_INPUT, wrong[i].sentence);
    UNIT_REFUSED(mesh_read_obj(&mesh, path_of("none.fbx"), &error), CLOTH_E_IO,
                 "none.fbx: cannot be read: No such file");
}

/* A clip that is not there, one that moves no vertex, and a mesh of other vertices. */
UNIT_TEST(clips_that_are_wrong)
{
    uint32_t n;
    double *place;
    struct skinned of = {.around = 3, .along = 2, .keys = 2};
    UNIT_OWNED(mesh_free) struct mesh mesh = figure_of(&of);
    const char *path = path_of("bend.glb");
    UNIT_REFUSED(mesh_read_clip(path, mesh.n_vertices, "walk", 25, &n, &place, &error),
                 CLOTH_E_INPUT, "it has no animation 'walk'; there are 'bend', and `first`");
    UNIT_REFUSED(mesh_read_clip(path, 4, "bend", 25, &n, &place, &error), CLOTH_E_INPUT,
                 "it has 11 vertices, but the mesh has 4");
    UNIT_REFUSED(mesh_read_clip(path, mesh.n_vertices, "bend", 1e8, &n, &place, &error),
                 CLOTH_E_INPUT, "use a lower fps");
    of.bare = true;
    ck_assert_int_eq(skinned_write(&of, path), 0);
    UNIT_REFUSED(mesh_read_clip(path, mesh.n_vertices, "bend", 25, &n, &place, &error),
                 CLOTH_E_INPUT, "the animation 'bend' moves no vertex: no mesh has bones");
    ck_assert_ptr_null(place);
}
