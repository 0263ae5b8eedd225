#ifndef TESTS_CLOTH_MESH_TOOLS_H
#define TESTS_CLOTH_MESH_TOOLS_H

#include "cloth/mesh/blocks.h"
#include "cloth/mesh/lattice.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* A file in memory, so that nothing is left behind. */
struct file {
    int descriptor;
    char path[64];
};

static inline struct file file_new(const void *bytes, size_t n)
{
    struct file file = {.descriptor = memfd_create("mesh", 0)};
    ck_assert_int_ge(file.descriptor, 0);
    ck_assert_int_eq(write(file.descriptor, bytes, n), (ssize_t)n);
    snprintf(file.path, sizeof file.path, "/proc/self/fd/%d", file.descriptor);
    return file;
}

/* Reads the text as an OBJ file; it must succeed. */
static inline struct mesh read_text(const char *text)
{
    struct mesh mesh;
    struct file file = file_new(text, strlen(text));
    UNIT_FINE(mesh_read_obj(&mesh, file.path, &error));
    close(file.descriptor);
    return mesh;
}

static inline struct mesh grid_of(double width, double height, uint32_t nx, uint32_t ny,
                                  enum mesh_cells cells)
{
    struct mesh mesh;
    UNIT_FINE(mesh_grid(&mesh, width, height, nx, ny, cells, &error));
    return mesh;
}

static inline struct mesh grid(double width, double height, uint32_t nx, uint32_t ny)
{
    return grid_of(width, height, nx, ny, MESH_SAME);
}

static inline void keep_spring(void *to, const struct mesh_spring *spring)
{
    struct mesh_spring **next = to;
    *(*next)++ = *spring;
}

/* The springs of a lattice, lattice->n, to be freed by the caller. */
static inline struct mesh_spring *springs_of(const struct mesh_lattice *lattice)
{
    struct mesh_spring *spring = malloc(((size_t)lattice->n + 1) * sizeof *spring), *next = spring;
    mesh_lattice_each(lattice, keep_spring, &next);
    ck_assert_int_eq(next - spring, lattice->n);
    return spring;
}

/* Pairs of vertices, for mesh_blocks_cut. */
struct pair_list {
    size_t n;
    const uint32_t *pair;
};

static inline void each_pair(const void *context, void (*visit)(void *to, uint32_t a, uint32_t b),
                             void *to)
{
    const struct pair_list *list = context;
    for (size_t i = 0; i < list->n; i++)
        visit(to, list->pair[2 * i], list->pair[2 * i + 1]);
}

/* mesh_blocks_cut of n_pairs x 2 vertices. */
static inline int cut_list(struct mesh_blocks *blocks, uint32_t n_vertices,
                           const unsigned char *used, size_t n_pairs, const uint32_t *pair,
                           uint32_t grain, struct cloth_error *error)
{
    const struct pair_list list = {n_pairs, pair};
    const struct mesh_pairs pairs = {&list, each_pair};
    return mesh_blocks_cut(blocks, n_vertices, used, &pairs, grain, error);
}

#endif
