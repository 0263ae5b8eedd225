/* Garments: dresses that tests/support/dress.awk makes, and, where they are beside the source tree,
 * those of others. */
#include "cloth/base/order.h"
#include "cloth/mesh/blocks.h"
#include "cloth/mesh/lattice.h"
#include "tests/cloth/mesh/tools.h"

#include <stdlib.h>

static const struct garment {
    const char *name; /* of a file; or what the dress is made by */
    uint32_t vertices, triangles, edges;
    uint32_t more_uv; /* than vertices: of corners that differ */
} MADE[] = {{"around=40 -v rows=30", 1216, 2320, 3538, 0},
            {"around=80 -v rows=60", 4768, 9312, 14082, 0}},
  GARMENTS[] = {
      {"dress-v17k-f34k.obj", 17562, 34099, 51665, 0},
      {"skirt4925.obj", 2565, 4925, 7490, 0},
      {"tshirt1900.obj", 1921, 3726, 5649, 6256},
};

static const char *path_of(const char *name)
{
    static char path[4096];
    const char *top = getenv("srcdir");
    snprintf(path, sizeof path, "%s/../shared/data/meshes/%s", top ? top : ".", name);
    return path;
}

/* Counts edges another way than the code does. */
static uint32_t count_edges(const struct mesh *mesh)
{
    size_t n = 3 * (size_t)mesh->n_triangles;
    uint64_t *keys = malloc(n * sizeof *keys);
    for (size_t i = 0; i < n; i++) {
        uint64_t a = mesh->triangle[i], b = mesh->triangle[i % 3 == 2 ? i - 2 : i + 1];
        keys[i] = a < b ? a << 32 | b : b << 32 | a;
    }
    qsort(keys, n, sizeof *keys, cloth_by_u64);
    uint32_t count = 0;
    for (size_t i = 0; i < n; i++)
        count += i == 0 || keys[i] != keys[i - 1];
    free(keys);
    return count;
}

static void check_edges(const struct mesh *mesh, const struct garment *garment)
{
    UNIT_OWNED(mesh_edges_free) struct mesh_edges edges;
    ck_assert_int_eq(mesh_edges_find(&edges, mesh, NULL), CLOTH_OK);
    ck_assert_uint_eq(edges.n, garment->edges);
    ck_assert_uint_eq(edges.n, count_edges(mesh));
    uint32_t border = 0;
    double area = 0, mass = 0, *masses = calloc(mesh->n_vertices, sizeof *masses);
    for (uint32_t e = 0; e < edges.n; e++) {
        border += edges.edge[e].opposite[1] == UINT32_MAX;
        area += edges.edge[e].area / 3;
    }
    ck_assert_uint_eq(2 * edges.n - border, 3 * mesh->n_triangles);
    mesh_add_mass(mesh, 0.2, false, masses);
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        mass += masses[v];
    ck_assert_double_eq_tol(mass, 0.2 * area, 1e-11 * mass);
    free(masses);
}

static void check_blocks(const struct mesh *mesh)
{
    struct mesh_moduli moduli = {1000, 1000, 1, 1, 0, NULL, 0};
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice;
    UNIT_OWNED(mesh_blocks_free) struct mesh_blocks blocks;
    unsigned char *used = malloc(mesh->n_vertices);
    mesh_used(mesh, used);
    ck_assert_int_eq(mesh_lattice_build(&lattice, mesh, &moduli, NULL), CLOTH_OK);
    struct mesh_spring *spring = springs_of(&lattice);
    uint32_t *pairs = malloc(2 * (size_t)lattice.n * sizeof *pairs);
    for (size_t s = 0; s < lattice.n; s++) {
        pairs[2 * s] = spring[s].a;
        pairs[2 * s + 1] = spring[s].b;
    }
    free(spring);
    ck_assert_int_eq(cut_list(&blocks, mesh->n_vertices, used, lattice.n, pairs, 500, NULL),
                     CLOTH_OK);
    double mean = (double)blocks.n_places / blocks.n_blocks;
    for (uint32_t b = 0; b < blocks.n_blocks; b++) {
        ck_assert_double_lt(blocks.start[b + 1] - blocks.start[b], 1.02 * mean);
        ck_assert_double_gt(blocks.start[b + 1] - blocks.start[b], 0.98 * mean);
    }
    free(pairs);
    free(used);
}

static void check_garment(const struct garment *garment, const char *path)
{
    UNIT_OWNED(mesh_free) struct mesh mesh;
    UNIT_FINE(mesh_read_obj(&mesh, path, &error));
    ck_assert_uint_eq(mesh.n_vertices, garment->vertices);
    ck_assert_uint_eq(mesh.n_triangles, garment->triangles);
    ck_assert_uint_eq(mesh.n_faces, garment->triangles);
    ck_assert_uint_eq(mesh.n_lone_edges, 0);
    ck_assert_uint_eq(mesh.n_more_uv, garment->more_uv);
    check_edges(&mesh, garment);
    check_blocks(&mesh);
}

UNIT_LOOP(a_dress_that_is_made, 0, sizeof MADE / sizeof *MADE)
{
    char command[4400];
    const char *top = getenv("srcdir");
    struct file file = file_new("", 0);
    snprintf(command, sizeof command, "awk -v %s -f '%s/tests/support/dress.awk' > /proc/%d/fd/%d",
             MADE[_i].name, top ? top : ".", (int)getpid(), file.descriptor);
    ck_assert_int_eq(system(command), 0);
    check_garment(&MADE[_i], file.path);
    close(file.descriptor);
}

UNIT_LOOP(a_garment_of_others, 0, sizeof GARMENTS / sizeof *GARMENTS)
{
    if (access(path_of(GARMENTS[_i].name), R_OK) == 0)
        check_garment(&GARMENTS[_i], path_of(GARMENTS[_i].name));
}
