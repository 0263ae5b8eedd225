/* Wavefront OBJ: the file is read once, into growing lists. Indices are checked against the counts
 * at the end, since corners may name later vertices. After the first error lists stay as they are.
 */
#include "cloth/mesh/detail/obj.h"
#include "cloth/mesh/detail/finish.h"

#include <stdlib.h>
#include <string.h>

struct obj {
    bool fans; /* finish.h */
    struct obj_lines lines;
    struct cloth_error error;
    locale_t c;                     /* numbers have points, whatever the program's locale */
    struct cloth_list position, uv; /* 3 and 2 doubles an item */
    struct cloth_list corner;       /* uint32_t[2]: vertex, and uv or OBJ_NO_UV */
    struct cloth_list face_start, face_line, edge, edge_line;
    struct obj_naming naming, drawing; /* groups, materials */
    struct cloth_list library;         /* char *: paths of the files with these */
};

#define FAIL(obj, format, ...)                                                                     \
    cloth_fail(&(obj)->error, CLOTH_E_INPUT, "%s:%zu: " format,                                    \
               mesh_path_shown((obj)->lines.path), (obj)->lines.line, __VA_ARGS__)

static void check_room(struct obj *obj, const struct cloth_list *list, const char *what)
{
    if (list->n >= MESH_MAX)
        FAIL(obj, "there are more than %u %s", MESH_MAX, what);
}

static void put(struct obj *obj, struct cloth_list *list, const void *item, size_t size)
{
    if (!obj->error.code)
        cloth_list_put(list, item, size, &obj->error);
}

/* Reads a line of `min` to `max` numbers, at most 3, to the end of a list. Missing ones are 0; the
 * rest of the line is ignored. */
static void read_place(struct obj *obj, struct cloth_list *list, const char *what, const char *at,
                       int min, int max)
{
    double x[3] = {0};
    const char *word;
    check_room(obj, list, what);
    int n = 0;
    for (; n < max && (word = obj_word(at)); at = obj_word_end(word), n++)
        if (!obj_word_number(word, obj->c, &x[n]))
            FAIL(obj, "'%s' is not a finite decimal number", obj_word_quote(word).text);
    if (n < min)
        FAIL(obj, "there are %d numbers; at least %d are needed", n, min);
    put(obj, list, x, (size_t)max * sizeof *x);
}

/* A number of the file, from 1 or backwards from the last of n, as one from 0. */
static uint32_t resolve(struct obj *obj, const char *word, long long number, size_t n,
                        const char *what)
{
    if (number == 0)
        FAIL(obj, "there is no %s 0; they count from 1", what);
    else if (number > (long long)MESH_MAX || number < -(long long)MESH_MAX)
        FAIL(obj, "there is no %s of the number in '%s'; %zu come before this line", what,
             obj_word_quote(word).text, n);
    else if (number < 0 && -number > (long long)n)
        FAIL(obj, "there is no %s %lld; %zu come before this line", what, number, n);
    return (uint32_t)(number > 0 ? number - 1 : (long long)n + number);
}

static void read_corner(struct obj *obj, const char *word, uint32_t corner[2])
{
    long long read[3];
    corner[0] = corner[1] = OBJ_NO_UV;
    if (!obj_word_corner(word, read)) {
        FAIL(obj, "'%s' is not a corner; it is v, v/vt, v//vn or v/vt/vn in whole numbers",
             obj_word_quote(word).text);
        return;
    }
    corner[0] = resolve(obj, word, read[0], obj->position.n, "vertex");
    if (read[1])
        corner[1] = resolve(obj, word, read[1], obj->uv.n, "texture coordinate");
}

static void read_face(struct obj *obj, const char *at)
{
    const uint32_t first = (uint32_t)obj->corner.n;
    for (const char *word; !obj->error.code && (word = obj_word(at)); at = obj_word_end(word)) {
        uint32_t corner[2];
        check_room(obj, &obj->corner, "corners");
        read_corner(obj, word, corner);
        put(obj, &obj->corner, corner, sizeof corner);
    }
    if (obj->corner.n - first < 3)
        FAIL(obj, "the face has %zu corners; it needs at least 3", obj->corner.n - first);
    put(obj, &obj->face_start, &first, sizeof first);
    put(obj, &obj->face_line, &obj->lines.line, sizeof obj->lines.line);
}

static void read_edges(struct obj *obj, const char *at)
{
    uint32_t edge[2], corner[2] = {0};
    size_t n = 0;
    for (const char *word; !obj->error.code && (word = obj_word(at)); at = obj_word_end(word)) {
        edge[0] = corner[0];
        check_room(obj, &obj->edge, "edges");
        read_corner(obj, word, corner);
        edge[1] = corner[0];
        if (n++ == 0)
            continue;
        put(obj, &obj->edge, edge, sizeof edge);
        put(obj, &obj->edge_line, &obj->lines.line, sizeof obj->lines.line);
    }
    if (n < 2)
        FAIL(obj, "the line has %zu vertices; it needs at least 2", n);
}

static void read_line(struct obj *obj, const char *line)
{
    const char *at;
    const uint32_t n_faces = (uint32_t)obj->face_start.n;
    if ((at = obj_word_after(line, "v")))
        read_place(obj, &obj->position, "vertices", at, 3, 3);
    else if ((at = obj_word_after(line, "vt")))
        read_place(obj, &obj->uv, "texture coordinates", at, 1, 2);
    else if ((at = obj_word_after(line, "f")))
        read_face(obj, at);
    else if ((at = obj_word_after(line, "l")))
        read_edges(obj, at);
    else if ((at = obj_word_after(line, "g")))
        obj_naming_line(&obj->naming, OBJ_GROUPS, at, n_faces, &obj->error);
    else if ((at = obj_word_after(line, "o")))
        obj_naming_line(&obj->naming, OBJ_OBJECTS, at, n_faces, &obj->error);
    else if ((at = obj_word_after(line, "usemtl")))
        obj_naming_line(&obj->drawing, OBJ_OBJECTS, at, n_faces, &obj->error);
    else if ((at = obj_word_after(line, "mtllib")))
        obj_library_line(&obj->library, obj->lines.path, at, &obj->error);
}

static void read_file(struct obj *obj, const char *path)
{
    static const char mark[] = "\xef\xbb\xbf"; /* UTF-8's byte order mark */
    const char *line;
    int code = obj_lines_open(&obj->lines, path, &obj->error);
    while (!code && !obj_lines_next(&obj->lines, &line, &obj->error) && line) {
        read_line(obj, obj->lines.line == 1 && !strncmp(line, mark, 3) ? line + 3 : line);
        code = obj->error.code;
    }
    if (obj->position.n == 0)
        cloth_fail(&obj->error, CLOTH_E_INPUT,
                   "%s: the file has no vertices (lines `v x y z`): it is empty or not OBJ",
                   mesh_path_shown(path));
}

/* Every corner's texture coordinate must exist. */
static void check_uv(struct obj *obj)
{
    const uint32_t(*corner)[2] = obj->corner.items, *start = obj->face_start.items;
    const size_t *line = obj->face_line.items;
    for (size_t c = 0, face = 0; c < obj->corner.n && !obj->error.code; c++) {
        while (face + 1 < obj->face_start.n && start[face + 1] <= c)
            face++;
        if (corner[c][1] != OBJ_NO_UV && corner[c][1] >= obj->uv.n)
            cloth_fail(&obj->error, CLOTH_E_INPUT,
                       "%s:%zu: there is no texture coordinate %u; the file has %zu",
                       mesh_path_shown(obj->lines.path), line[face], corner[c][1] + 1, obj->uv.n);
    }
}

/* The names of the groups and of the materials. */
static int make_names(struct obj *obj, struct mesh *mesh)
{
    int code = obj_naming_end(&obj->naming, mesh->n_faces, &mesh->group, &mesh->n_groups,
                              &mesh->group_run, &mesh->n_group_runs, &obj->error);
    code = code ? code
                : obj_naming_end(&obj->drawing, mesh->n_faces, &mesh->material, &mesh->n_materials,
                                 &mesh->material_run, &mesh->n_material_runs, &obj->error);
    mesh->n_libraries = (uint32_t)obj->library.n;
    mesh->library = obj->library.items;
    obj->library = (struct cloth_list){0};
    return code;
}

/* The items of a list as an array of its own length; the list is empty then. */
static void *hand_over(struct cloth_list *list, size_t size, struct cloth_error *error)
{
    if (!cloth_list_add(list, size, 0, error)) /* a list without items may have no array */
        return NULL;
    void *items = realloc(list->items, (list->n ? list->n : 1) * size);
    items = items ? items : list->items;
    *list = (struct cloth_list){0};
    return items;
}

static void make_mesh(struct obj *obj, struct mesh *mesh)
{
    mesh->n_vertices = (uint32_t)obj->position.n;
    mesh->n_faces = (uint32_t)obj->face_start.n;
    mesh->n_lone_edges = (uint32_t)obj->edge.n;
    uint32_t *end = cloth_list_add(&obj->face_start, sizeof *end, 1, &obj->error);
    mesh->face_corner = cloth_alloc(obj->corner.n, sizeof *mesh->face_corner, &obj->error);
    if (!end || !mesh->face_corner)
        return;
    *end = (uint32_t)obj->corner.n;
    const uint32_t(*corner)[2] = obj->corner.items;
    for (size_t c = 0; c < obj->corner.n; c++)
        mesh->face_corner[c] = corner[c][0];
    mesh->position = hand_over(&obj->position, 3 * sizeof(double), &obj->error);
    mesh->face_start = hand_over(&obj->face_start, sizeof(uint32_t), &obj->error);
    mesh->lone_edge = hand_over(&obj->edge, 2 * sizeof(uint32_t), &obj->error);
    if (!mesh->lone_edge) /* the others have items */
        return;
    const struct mesh_source source = {obj->lines.path, obj->face_line.items, obj->edge_line.items,
                                       obj->fans};
    if (!mesh_finish(mesh, &source, &obj->error) && !make_names(obj, mesh) && obj->uv.n &&
        obj->corner.n)
        obj_uv_put(mesh, obj->uv.items, obj->corner.items, &obj->error);
}

static void free_obj(struct obj *obj)
{
    obj_lines_close(&obj->lines);
    free(obj->position.items);
    free(obj->uv.items);
    free(obj->corner.items);
    free(obj->face_start.items);
    free(obj->face_line.items);
    free(obj->edge.items);
    free(obj->edge_line.items);
    obj_naming_free(&obj->naming);
    obj_naming_free(&obj->drawing);
    for (size_t i = 0; i < obj->library.n; i++)
        free(((char **)obj->library.items)[i]);
    free(obj->library.items);
    if (obj->c)
        freelocale(obj->c);
}

static int mesh_obj_read(struct mesh *mesh, const char *path, bool fans, struct cloth_error *error)
{
    struct obj obj = {.fans = fans, .c = newlocale(LC_ALL_MASK, "C", (locale_t)0)};
    *mesh = (struct mesh){0};
    if (obj.c)
        read_file(&obj, path);
    else
        cloth_fail(&obj.error, CLOTH_E_MEMORY, "out of memory for the C locale");
    check_uv(&obj);
    if (!obj.error.code)
        make_mesh(&obj, mesh);
    if (obj.error.code)
        mesh_free(mesh);
    free_obj(&obj);
    return obj.error.code ? cloth_fail(error, obj.error.code, "%s", obj.error.text) : CLOTH_OK;
}

int mesh_read_obj(struct mesh *mesh, const char *path, struct cloth_error *error)
{
    return mesh_obj_read(mesh, path, false, error);
}

int mesh_read_surface(struct mesh *mesh, const char *path, struct cloth_error *error)
{
    return mesh_obj_read(mesh, path, true, error);
}
