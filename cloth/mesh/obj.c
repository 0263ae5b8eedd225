/* Wavefront OBJ: the file is read once, into growing lists. Indices are checked against the counts
 * at the end, since corners may name later vertices. After the first error lists stay as they are.
 */
#include "cloth/mesh/detail/obj.h"
#include "cloth/mesh/detail/figure.h"
#include "cloth/mesh/detail/finish.h"

#include <stdlib.h>
#include <string.h>

struct obj {
    struct obj_lines lines;
    struct cloth_error error;
    locale_t c; /* numbers have points, whatever the program's locale */
    struct obj_parts parts;
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
    corner[0] = resolve(obj, word, read[0], obj->parts.position.n, "vertex");
    if (read[1])
        corner[1] = resolve(obj, word, read[1], obj->parts.uv.n, "texture coordinate");
}

static void read_face(struct obj *obj, const char *at)
{
    const uint32_t first = (uint32_t)obj->parts.corner.n;
    for (const char *word; !obj->error.code && (word = obj_word(at)); at = obj_word_end(word)) {
        uint32_t corner[2];
        check_room(obj, &obj->parts.corner, "corners");
        read_corner(obj, word, corner);
        put(obj, &obj->parts.corner, corner, sizeof corner);
    }
    if (obj->parts.corner.n - first < 3)
        FAIL(obj, "the face has %zu corners; it needs at least 3", obj->parts.corner.n - first);
    put(obj, &obj->parts.face_start, &first, sizeof first);
    put(obj, &obj->parts.face_line, &obj->lines.line, sizeof obj->lines.line);
}

static void read_edges(struct obj *obj, const char *at)
{
    uint32_t edge[2], corner[2] = {0};
    size_t n = 0;
    for (const char *word; !obj->error.code && (word = obj_word(at)); at = obj_word_end(word)) {
        edge[0] = corner[0];
        check_room(obj, &obj->parts.edge, "edges");
        read_corner(obj, word, corner);
        edge[1] = corner[0];
        if (n++ == 0)
            continue;
        put(obj, &obj->parts.edge, edge, sizeof edge);
        put(obj, &obj->parts.edge_line, &obj->lines.line, sizeof obj->lines.line);
    }
    if (n < 2)
        FAIL(obj, "the line has %zu vertices; it needs at least 2", n);
}

static void read_line(struct obj *obj, const char *line)
{
    const char *at;
    const uint32_t n_faces = (uint32_t)obj->parts.face_start.n;
    if ((at = obj_word_after(line, "v")))
        read_place(obj, &obj->parts.position, "vertices", at, 3, 3);
    else if ((at = obj_word_after(line, "vt")))
        read_place(obj, &obj->parts.uv, "texture coordinates", at, 1, 2);
    else if ((at = obj_word_after(line, "f")))
        read_face(obj, at);
    else if ((at = obj_word_after(line, "l")))
        read_edges(obj, at);
    else if ((at = obj_word_after(line, "g")))
        obj_naming_line(&obj->parts.naming, OBJ_GROUPS, at, n_faces, &obj->error);
    else if ((at = obj_word_after(line, "o")))
        obj_naming_line(&obj->parts.naming, OBJ_OBJECTS, at, n_faces, &obj->error);
    else if ((at = obj_word_after(line, "usemtl")))
        obj_naming_line(&obj->parts.drawing, OBJ_OBJECTS, at, n_faces, &obj->error);
    else if ((at = obj_word_after(line, "mtllib")))
        obj_library_line(&obj->parts.library, obj->lines.path, at, &obj->error);
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
    if (obj->parts.position.n == 0)
        cloth_fail(&obj->error, CLOTH_E_INPUT,
                   "%s: the file has no vertices (lines `v x y z`): it is empty or not OBJ",
                   mesh_path_shown(path));
}

/* Every corner's texture coordinate must exist. */
static void check_uv(struct obj *obj)
{
    const uint32_t(*corner)[2] = obj->parts.corner.items, *start = obj->parts.face_start.items;
    const size_t *line = obj->parts.face_line.items;
    for (size_t c = 0, face = 0; c < obj->parts.corner.n && !obj->error.code; c++) {
        while (face + 1 < obj->parts.face_start.n && start[face + 1] <= c)
            face++;
        if (corner[c][1] != OBJ_NO_UV && corner[c][1] >= obj->parts.uv.n)
            cloth_fail(&obj->error, CLOTH_E_INPUT,
                       "%s:%zu: there is no texture coordinate %u; the file has %zu",
                       mesh_path_shown(obj->lines.path), line[face], corner[c][1] + 1,
                       obj->parts.uv.n);
    }
}

static void free_obj(struct obj *obj)
{
    obj_lines_close(&obj->lines);
    obj_parts_free(&obj->parts);
    if (obj->c)
        freelocale(obj->c);
}

static int mesh_obj_read(struct mesh *mesh, const char *path, bool fans, struct cloth_error *error)
{
    if (mesh_figure_path(path))
        return mesh_read_figure(mesh, path, fans, error);
    struct obj obj = {.c = newlocale(LC_ALL_MASK, "C", (locale_t)0)};
    *mesh = (struct mesh){0};
    if (obj.c)
        read_file(&obj, path);
    else
        cloth_fail(&obj.error, CLOTH_E_MEMORY, "out of memory for the C locale");
    check_uv(&obj);
    if (!obj.error.code)
        obj_parts_make(&obj.parts, path, fans, mesh, &obj.error);
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
