/* Wavefront OBJ: the file is read once, into growing lists. Indices are checked against the counts
 * at the end, since corners may name later vertices. */
#include "cloth/base/memory.h"
#include "cloth/mesh/detail/finish.h"
#include "cloth/mesh/detail/islands.h"
#include "cloth/mesh/detail/library.h"
#include "cloth/mesh/detail/lines.h"
#include "cloth/mesh/detail/naming.h"
#include "cloth/mesh/detail/words.h"
#include "cloth/mesh/mesh.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct obj {
    bool fans; /* finish.h */
    struct mesh_lines lines;
    struct cloth_error *error;
    locale_t c;                     /* numbers have points, whatever the program's locale */
    struct cloth_list position, uv; /* 3 and 2 doubles an item */
    struct cloth_list corner;       /* uint32_t[2]: vertex, and uv or MESH_NO_UV */
    struct cloth_list face_start, face_line, edge, edge_line;
    struct mesh_naming naming, drawing; /* groups, materials */
    struct cloth_list library;          /* char *: paths of the files with these */
};

#define FAIL(obj, format, ...)                                                                     \
    cloth_fail((obj)->error, CLOTH_E_INPUT, "%s:%zu: " format, mesh_path_shown((obj)->lines.path), \
               (obj)->lines.line, __VA_ARGS__)

static int full(struct obj *obj, const struct cloth_list *list, const char *what)
{
    return list->n < MESH_MAX ? CLOTH_OK : FAIL(obj, "there are more than %u %s", MESH_MAX, what);
}

/* Reads `min` to `max` numbers; missing ones are 0; the rest of the line is ignored. */
static int read_numbers(struct obj *obj, const char *at, int min, int max, double *numbers)
{
    for (int i = 0; i < max; i++) {
        const char *word = mesh_word(at);
        numbers[i] = 0;
        if (!word && i < min)
            return FAIL(obj, "there are %d numbers; at least %d are needed", i, min);
        if (!word)
            continue;
        if (!mesh_word_number(word, obj->c, &numbers[i]))
            return FAIL(obj, "'%s' is not a finite decimal number", mesh_word_quote(word).text);
        at = mesh_word_end(word);
    }
    return CLOTH_OK;
}

static int read_vertex(struct obj *obj, const char *at)
{
    double x[3];
    int code = full(obj, &obj->position, "vertices");
    if (!code)
        code = read_numbers(obj, at, 3, 3, x);
    if (code)
        return code;
    double *to = cloth_list_add(&obj->position, sizeof x, 1, obj->error);
    if (!to)
        return CLOTH_E_MEMORY;
    memcpy(to, x, sizeof x);
    return CLOTH_OK;
}

static int read_uv(struct obj *obj, const char *at)
{
    double uv[2];
    int code = full(obj, &obj->uv, "texture coordinates");
    if (!code)
        code = read_numbers(obj, at, 1, 2, uv);
    if (code)
        return code;
    double *to = cloth_list_add(&obj->uv, sizeof uv, 1, obj->error);
    if (!to)
        return CLOTH_E_MEMORY;
    memcpy(to, uv, sizeof uv);
    return CLOTH_OK;
}

/* A number of the file, from 1 or backwards from the last of n, into one from 0. */
static int resolve(struct obj *obj, const char *word, long long number, size_t n, const char *what,
                   uint32_t *index)
{
    if (number == 0)
        return FAIL(obj, "there is no %s 0; they count from 1", what);
    if (number > (long long)MESH_MAX || number < -(long long)MESH_MAX)
        return FAIL(obj, "there is no %s of the number in '%s'; %zu come before this line", what,
                    mesh_word_quote(word).text, n);
    if (number < 0 && -number > (long long)n)
        return FAIL(obj, "there is no %s %lld; %zu come before this line", what, number, n);
    *index = (uint32_t)(number > 0 ? number - 1 : (long long)n + number);
    return CLOTH_OK;
}

static int read_corner(struct obj *obj, const char *word, uint32_t *corner)
{
    struct mesh_corner read;
    if (!mesh_word_corner(word, &read))
        return FAIL(obj, "'%s' is not a corner; it is v, v/vt, v//vn or v/vt/vn in whole numbers",
                    mesh_word_quote(word).text);
    corner[1] = MESH_NO_UV;
    int code = resolve(obj, word, read.v, obj->position.n, "vertex", &corner[0]);
    if (!code && read.vt)
        code = resolve(obj, word, read.vt, obj->uv.n, "texture coordinate", &corner[1]);
    return code;
}

static int read_face(struct obj *obj, const char *at)
{
    uint32_t first = (uint32_t)obj->corner.n;
    for (const char *word; (word = mesh_word(at)); at = mesh_word_end(word)) {
        uint32_t corner[2];
        int code = full(obj, &obj->corner, "corners");
        if (!code)
            code = read_corner(obj, word, corner);
        if (code)
            return code;
        uint32_t *to = cloth_list_add(&obj->corner, sizeof corner, 1, obj->error);
        if (!to)
            return CLOTH_E_MEMORY;
        memcpy(to, corner, sizeof corner);
    }
    if (obj->corner.n - first < 3)
        return FAIL(obj, "the face has %zu corners; it needs at least 3", obj->corner.n - first);
    uint32_t *start = cloth_list_add(&obj->face_start, sizeof *start, 1, obj->error);
    size_t *line = cloth_list_add(&obj->face_line, sizeof *line, 1, obj->error);
    if (!start || !line)
        return CLOTH_E_MEMORY;
    *start = first;
    *line = obj->lines.line;
    return CLOTH_OK;
}

static int read_edges(struct obj *obj, const char *at)
{
    uint32_t before[2], corner[2] = {0};
    size_t n = 0;
    for (const char *word; (word = mesh_word(at)); at = mesh_word_end(word), n++) {
        memcpy(before, corner, sizeof before);
        int code = full(obj, &obj->edge, "edges");
        if (!code)
            code = read_corner(obj, word, corner);
        if (code)
            return code;
        if (n == 0)
            continue;
        uint32_t *edge = cloth_list_add(&obj->edge, 2 * sizeof *edge, 1, obj->error);
        size_t *line = cloth_list_add(&obj->edge_line, sizeof *line, 1, obj->error);
        if (!edge || !line)
            return CLOTH_E_MEMORY;
        edge[0] = before[0];
        edge[1] = corner[0];
        *line = obj->lines.line;
    }
    return n >= 2 ? CLOTH_OK : FAIL(obj, "the line has %zu vertices; it needs at least 2", n);
}

static int read_line(struct obj *obj, const char *line)
{
    const char *at;
    const uint32_t n_faces = (uint32_t)obj->face_start.n;
    if ((at = mesh_word_after(line, "v")))
        return read_vertex(obj, at);
    if ((at = mesh_word_after(line, "vt")))
        return read_uv(obj, at);
    if ((at = mesh_word_after(line, "f")))
        return read_face(obj, at);
    if ((at = mesh_word_after(line, "l")))
        return read_edges(obj, at);
    if ((at = mesh_word_after(line, "g")))
        return mesh_naming_line(&obj->naming, MESH_GROUPS, at, n_faces, obj->error);
    if ((at = mesh_word_after(line, "o")))
        return mesh_naming_line(&obj->naming, MESH_OBJECTS, at, n_faces, obj->error);
    if ((at = mesh_word_after(line, "usemtl")))
        return mesh_naming_line(&obj->drawing, MESH_OBJECTS, at, n_faces, obj->error);
    if ((at = mesh_word_after(line, "mtllib")))
        return mesh_library_line(&obj->library, obj->lines.path, at, obj->error);
    return CLOTH_OK;
}

static int read_file(struct obj *obj, const char *path)
{
    static const char mark[] = "\xef\xbb\xbf"; /* UTF-8's byte order mark */
    char *line;
    int code = mesh_lines_open(&obj->lines, path, obj->error);
    while (!code && !(code = mesh_lines_next(&obj->lines, &line, obj->error)) && line) {
        if (obj->lines.line == 1 && strncmp(line, mark, 3) == 0)
            line += 3;
        code = read_line(obj, line);
    }
    if (!code && obj->position.n == 0)
        code = cloth_fail(obj->error, CLOTH_E_INPUT,
                          "%s: the file has no vertices (lines `v x y z`): it is empty or not OBJ",
                          mesh_path_shown(path));
    return code;
}

/* Every corner's texture coordinate must exist. */
static int check_uv(const struct obj *obj)
{
    const uint32_t(*corner)[2] = obj->corner.items;
    const uint32_t *start = obj->face_start.items;
    const size_t *line = obj->face_line.items;
    for (size_t c = 0, face = 0; c < obj->corner.n; c++) {
        while (face + 1 < obj->face_start.n && start[face + 1] <= c)
            face++;
        if (corner[c][1] != MESH_NO_UV && corner[c][1] >= obj->uv.n)
            return cloth_fail(obj->error, CLOTH_E_INPUT,
                              "%s:%zu: there is no texture coordinate %u; the file has %zu",
                              mesh_path_shown(obj->lines.path), line[face], corner[c][1] + 1,
                              obj->uv.n);
    }
    return CLOTH_OK;
}

/* The names of the groups and of the materials. */
static int make_names(struct obj *obj, struct mesh *mesh)
{
    struct mesh_names names;
    int code = mesh_naming_end(&obj->naming, mesh->n_faces, &names, obj->error);
    mesh->n_groups = names.n;
    mesh->n_group_runs = names.n_runs;
    mesh->group = names.name;
    mesh->group_run = names.run;
    if (code)
        return code;
    code = mesh_naming_end(&obj->drawing, mesh->n_faces, &names, obj->error);
    mesh->n_materials = names.n;
    mesh->n_material_runs = names.n_runs;
    mesh->material = names.name;
    mesh->material_run = names.run;
    mesh->n_libraries = (uint32_t)obj->library.n;
    mesh->library = obj->library.items;
    obj->library = (struct cloth_list){0};
    return code;
}

/* The items of a list as an array of its own length; the list is empty then. */
static void *mesh_obj_hand_over(struct cloth_list *list, size_t size, struct cloth_error *error)
{
    void *items = list->n ? realloc(list->items, list->n * size) : NULL;
    if (!items)
        items = list->n ? list->items : cloth_alloc(0, size, error);
    if (list->n == 0)
        free(list->items);
    *list = (struct cloth_list){0};
    return items;
}

static int make_mesh(struct obj *obj, struct mesh *mesh)
{
    mesh->n_vertices = (uint32_t)obj->position.n;
    mesh->n_faces = (uint32_t)obj->face_start.n;
    mesh->n_lone_edges = (uint32_t)obj->edge.n;
    uint32_t *end = cloth_list_add(&obj->face_start, sizeof *end, 1, obj->error);
    mesh->face_corner = cloth_alloc(obj->corner.n, sizeof *mesh->face_corner, obj->error);
    if (!end || !mesh->face_corner)
        return CLOTH_E_MEMORY;
    *end = (uint32_t)obj->corner.n;
    const uint32_t(*corner)[2] = obj->corner.items;
    for (size_t c = 0; c < obj->corner.n; c++)
        mesh->face_corner[c] = corner[c][0];
    mesh->position = mesh_obj_hand_over(&obj->position, 3 * sizeof(double), obj->error);
    mesh->face_start = mesh_obj_hand_over(&obj->face_start, sizeof(uint32_t), obj->error);
    mesh->lone_edge = mesh_obj_hand_over(&obj->edge, 2 * sizeof(uint32_t), obj->error);
    if (!mesh->lone_edge)
        return CLOTH_E_MEMORY;
    struct mesh_source source = {obj->lines.path, obj->face_line.items, obj->edge_line.items,
                                 obj->fans};
    int code = mesh_finish(mesh, &source, obj->error);
    if (!code)
        code = make_names(obj, mesh);
    if (code || !obj->uv.n || !obj->corner.n)
        return code;
    return mesh_islands_make(mesh, obj->uv.items, obj->corner.items, obj->error);
}

static void free_obj(struct obj *obj)
{
    mesh_lines_close(&obj->lines);
    free(obj->position.items);
    free(obj->uv.items);
    free(obj->corner.items);
    free(obj->face_start.items);
    free(obj->face_line.items);
    free(obj->edge.items);
    free(obj->edge_line.items);
    mesh_naming_free(&obj->naming);
    mesh_naming_free(&obj->drawing);
    for (size_t i = 0; i < obj->library.n; i++)
        free(((char **)obj->library.items)[i]);
    free(obj->library.items);
    if (obj->c)
        freelocale(obj->c);
}

static int mesh_obj_read(struct mesh *mesh, const char *path, bool fans, struct cloth_error *error)
{
    struct obj obj = {.fans = fans, .error = error, .c = newlocale(LC_ALL_MASK, "C", (locale_t)0)};
    *mesh = (struct mesh){0};
    int code =
        obj.c ? CLOTH_OK : cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the C locale");
    if (!code)
        code = read_file(&obj, path);
    if (!code)
        code = check_uv(&obj);
    if (!code)
        code = make_mesh(&obj, mesh);
    if (code)
        mesh_free(mesh);
    free_obj(&obj);
    return code;
}

int mesh_read_obj(struct mesh *mesh, const char *path, struct cloth_error *error)
{
    return mesh_obj_read(mesh, path, false, error);
}

int mesh_read_surface(struct mesh *mesh, const char *path, struct cloth_error *error)
{
    return mesh_obj_read(mesh, path, true, error);
}
