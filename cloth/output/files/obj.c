/* The OBJ of a folder: vertices in the order of the input meshes, cloth after cloth, so that vertex
 * i of the file is point i of the cache; faces are the input's polygons. */
#include "cloth/output/files/files.h"

#include <ctype.h>

/* Where a mesh's numbers begin in the file, counted from 1 as OBJ does. */
struct start {
    uint64_t vertex, uv;
};

/* printf takes ten times as long, and a mesh has more corners than all else. */
static void put_whole(FILE *file, char before, uint64_t number)
{
    char text[24];
    size_t at = sizeof text;
    do
        text[--at] = (char)('0' + number % 10);
    while (number /= 10);
    text[--at] = before;
    fwrite_unlocked(text + at, 1, sizeof text - at, file);
}

static void put_name(FILE *file, const char *name)
{
    fputs("o ", file);
    for (; *name; name++)
        fputc(iscntrl((unsigned char)*name) ? '_' : *name, file);
    fputc('\n', file);
}

static void put_vertices(FILE *file, const struct mesh *mesh)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        const double *x = mesh->position + 3 * v;
        fprintf(file, "v %.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    double uv[2];
    for (uint32_t v = 0; v < mesh->n_vertices && mesh_uv(mesh, v, uv); v++)
        fprintf(file, "vt %.17g %.17g\n", uv[0], uv[1]);
}

static void put_faces(FILE *file, const struct mesh *mesh, struct start start, int has_uv)
{
    for (uint32_t f = 0; f < mesh->n_faces; f++) {
        uint32_t room[3];
        const uint32_t *corner, n = mesh_face(mesh, f, room, &corner);
        fputc('f', file);
        for (uint32_t c = 0; c < n; c++) {
            const uint64_t v = corner[c];
            put_whole(file, ' ', start.vertex + v);
            if (has_uv)
                put_whole(file, '/', start.uv + v);
        }
        fputc('\n', file);
    }
    for (size_t e = 0; e < mesh->n_lone_edges; e++)
        fprintf(file, "l %ju %ju\n", (uintmax_t)(start.vertex + mesh->lone_edge[2 * e]),
                (uintmax_t)(start.vertex + mesh->lone_edge[2 * e + 1]));
}

int output_fill_obj(FILE *file, const void *what)
{
    const struct output_setup *setup = what;
    struct start start = {1, 1};
    for (size_t i = 0; i < setup->n_meshes && !ferror(file); i++) {
        const struct mesh *mesh = setup->meshes[i];
        put_name(file, setup->names[i]);
        put_vertices(file, mesh);
        double uv[2];
        const int has_uv = mesh_uv(mesh, 0, uv);
        put_faces(file, mesh, start, has_uv);
        start.vertex += mesh->n_vertices;
        start.uv += has_uv ? mesh->n_vertices : 0;
    }
    return ferror(file);
}
