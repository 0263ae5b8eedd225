/* The OBJ of a folder: vertices in the order of the input meshes, cloth after cloth, so that vertex
 * i of the file is point i of the cache; faces are the input's polygons. */
#include "cloth/output/files/files.h"
#include "cloth/output/files/scene.h"

#include <ctype.h>
#include <stdlib.h>

/* Where a mesh's numbers begin in the file, counted from 1 as OBJ does, and what holds there:
 * groups, or a material. */
struct start {
    uint64_t vertex, uv;
    bool grouped, drawn;
};

/* printf takes ten times as long, and a mesh has more corners than all else. */
static void files_obj_put_whole(FILE *file, char before, uint64_t number)
{
    char text[24];
    size_t at = sizeof text;
    do
        text[--at] = (char)('0' + number % 10);
    while (number /= 10);
    text[--at] = before;
    fwrite_unlocked(text + at, 1, sizeof text - at, file);
}

/* Names that share a line have no blanks. */
static void files_obj_put_name(FILE *file, const char *before, const char *name, bool blanks)
{
    fputs(before, file);
    for (; *name; name++)
        fputc(iscntrl((unsigned char)*name) || (!blanks && *name == ' ') ? '_' : *name, file);
}

static void files_obj_put_line(FILE *file, const char *before, const char *name)
{
    files_obj_put_name(file, before, name, true);
    fputc('\n', file);
}

static void files_obj_put_vertices(FILE *file, const struct mesh *mesh)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        const double *x = mesh->position + 3 * v;
        fprintf(file, "v %.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    double uv[2];
    const uint32_t n_uv = mesh->n_vertices + mesh->n_more_uv;
    for (uint32_t i = 0; i < n_uv && mesh_uv(mesh, i, uv); i++)
        fprintf(file, "vt %.17g %.17g\n", uv[0], uv[1]);
}

/* Runs of faces by their first ones, and which of them the face has that was come to. */
struct runs {
    const struct mesh_group_run *run;
    char **name;
    uint32_t n, next, n_open, end; /* end: the face before which one of the open ones ends */
    uint32_t *open;                /* n */
};

/* Goes on to face f; whether it is in others than the face before. */
static bool files_obj_go_on(struct runs *runs, uint32_t f)
{
    const bool begins = runs->next < runs->n && runs->run[runs->next].first == f;
    uint32_t kept = 0;
    if (!begins && !(runs->n_open && runs->end == f))
        return false;
    while (runs->next < runs->n && runs->run[runs->next].first == f)
        runs->open[runs->n_open++] = runs->next++;
    runs->end = UINT32_MAX;
    for (uint32_t i = 0; i < runs->n_open; i++) {
        const uint32_t r = runs->open[i], end = runs->run[r].first + runs->run[r].n;
        if (end <= f)
            continue;
        runs->open[kept++] = r;
        runs->end = end < runs->end ? end : runs->end;
    }
    runs->n_open = kept;
    return true;
}

static const char *open_name(const struct runs *runs, uint32_t i)
{
    return runs->name[runs->run[runs->open[i]].group];
}

/* A line of groups ends those before it, also those of the cloth before. */
static void put_groups(FILE *file, struct runs *runs, uint32_t f, struct start *start)
{
    if (!files_obj_go_on(runs, f) && (f || !start->grouped))
        return;
    fputc('g', file);
    for (uint32_t i = 0; i < runs->n_open; i++)
        files_obj_put_name(file, " ", open_name(runs, i), false);
    fputc('\n', file);
    start->grouped = runs->n_open > 0;
}

/* No line ends a material: a cloth that begins without one has one of its own name then. */
static void put_material(FILE *file, struct runs *runs, uint32_t f, const char *cloth,
                         struct start *start)
{
    const bool changed = files_obj_go_on(runs, f) && runs->n_open;
    if (changed || (!f && start->drawn))
        files_obj_put_line(file, "usemtl ", changed ? open_name(runs, 0) : cloth);
    start->drawn = start->drawn || changed;
}

static void files_obj_put_corners(FILE *file, const struct mesh *mesh, uint32_t f,
                                  const struct start *start, bool has_uv)
{
    uint32_t room[3];
    const uint32_t *corner, n = mesh_face(mesh, f, room, &corner);
    const uint32_t *uv = mesh->face_uv ? mesh->face_uv + mesh->face_start[f] : corner;
    fputc('f', file);
    for (uint32_t c = 0; c < n; c++) {
        files_obj_put_whole(file, ' ', start->vertex + corner[c]);
        if (has_uv)
            files_obj_put_whole(file, '/', start->uv + uv[c]);
    }
    fputc('\n', file);
}

static int put_faces(FILE *file, const struct mesh *mesh, const char *cloth, struct start *start,
                     bool has_uv)
{
    struct runs groups = {.run = mesh->group_run, .n = mesh->n_group_runs, .name = mesh->group};
    struct runs materials = {
        .run = mesh->material_run, .n = mesh->n_material_runs, .name = mesh->material};
    groups.open = calloc((size_t)groups.n + 1, sizeof *groups.open);
    materials.open = calloc((size_t)materials.n + 1, sizeof *materials.open);
    const bool made = groups.open && materials.open;
    for (uint32_t f = 0; made && f < mesh->n_faces; f++) {
        put_groups(file, &groups, f, start);
        put_material(file, &materials, f, cloth, start);
        files_obj_put_corners(file, mesh, f, start, has_uv);
    }
    for (size_t e = 0; e < mesh->n_lone_edges; e++)
        fprintf(file, "l %ju %ju\n", (uintmax_t)(start->vertex + mesh->lone_edge[2 * e]),
                (uintmax_t)(start->vertex + mesh->lone_edge[2 * e + 1]));
    free(groups.open);
    free(materials.open);
    return !made;
}

int output_fill_obj(FILE *file, const void *what)
{
    const struct output_setup *setup = what;
    struct start start = {.vertex = 1, .uv = 1};
    int failed = 0;
    for (size_t i = 0; i < setup->n_meshes && !failed && !ferror(file); i++) {
        const struct mesh *mesh = setup->meshes[i];
        for (uint32_t l = 0; l < mesh->n_libraries; l++)
            files_obj_put_line(file, "mtllib ", mesh->library[l]);
        files_obj_put_line(file, "o ", setup->names[i]);
        files_obj_put_vertices(file, mesh);
        double uv[2];
        const int has_uv = mesh_uv(mesh, 0, uv);
        failed = put_faces(file, mesh, setup->names[i], &start, has_uv);
        start.vertex += mesh->n_vertices;
        start.uv += has_uv ? (uint64_t)mesh->n_vertices + mesh->n_more_uv : 0;
    }
    return failed || ferror(file);
}

int output_mesh_obj(const char *path, const struct mesh *mesh, const char *name,
                    struct cloth_error *error)
{
    const struct output_setup alone = {.n_meshes = 1, .meshes = &mesh, .names = &name};
    return output_replace_file(path, output_fill_obj, &alone, error);
}
