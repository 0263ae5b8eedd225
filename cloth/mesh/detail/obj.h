#ifndef CLOTH_MESH_DETAIL_OBJ_H
#define CLOTH_MESH_DETAIL_OBJ_H

#include "cloth/base/memory.h"
#include "cloth/mesh/mesh.h"

#include <locale.h>
#include <stdio.h>

/* The parts of the OBJ reader. All are local, and zeroed at first. */

/* ---- Lines ---- */

/* Lines of any length, with LF or CR LF, the last one with or without. A line that ends with `\`
 * goes on in the next one, unless it is a comment (#). */
struct obj_lines {
    const char *path;
    FILE *file;
    char *raw; /* the last line read, as it is in the file */
    size_t room;
    struct cloth_list text; /* the whole line */
    size_t line, next; /* the number of its first line in the file, from 1; of the last one read */
};

/* Errors: CLOTH_E_IO. */
int obj_lines_open(struct obj_lines *lines, const char *path, struct cloth_error *error);

/* *text: the next line, ended by a zero, without its line end; valid until the next call; NULL
 * after the last one. Errors: CLOTH_E_INPUT for a zero byte (not a text file), CLOTH_E_IO,
 * CLOTH_E_MEMORY. */
int obj_lines_next(struct obj_lines *lines, const char **text, struct cloth_error *error);

void obj_lines_close(struct obj_lines *lines);

/* ---- Words of a line: blanks stand between them; one that starts with # begins a comment ---- */

/* The next word at or behind `at`, or NULL; and the first byte behind a word. */
const char *obj_word(const char *at);
const char *obj_word_end(const char *word);
/* If the line starts with this keyword, what stands behind it; else NULL. */
const char *obj_word_after(const char *line, const char *keyword);

/* The word as a decimal number; false if it is none or not finite. c: a "C" locale. */
bool obj_word_number(const char *word, locale_t c, double *number);

/* The word as a corner: v, v/vt, v//vn or v/vt/vn, in whole numbers, those left out 0. Numbers
 * beyond +-2^31 become 2^31 + 1 or -2^31 - 1. False if the word is something else. */
bool obj_word_corner(const char *word, long long corner[3]);

/* A printable copy of the word, cut to what a sentence can hold. */
struct obj_quote {
    char text[48];
};
struct obj_quote obj_word_quote(const char *word);

/* ---- Names ---- */

/* Lines that name what the faces after them are in: each opens its names and closes those that were
 * opened by a line of its kind. */
enum obj_naming_kind { OBJ_GROUPS, OBJ_OBJECTS, OBJ_NAMINGS };
struct obj_naming {
    struct cloth_list entry; /* a name with its faces, in the order of the file */
    size_t open[OBJ_NAMINGS], end[OBJ_NAMINGS]; /* entries open .. end - 1 are open */
};

/* A line of names, `at` the first of them, or none, after n faces. All words of an object are
 * one name. Error: CLOTH_E_MEMORY. */
int obj_naming_line(struct obj_naming *naming, enum obj_naming_kind kind, const char *at,
                    uint32_t n_faces, struct cloth_error *error);

/* The names of all lines before that have faces, of n, in the order of the file, and their runs: of
 * a mesh, to which they belong also after an error. Error: CLOTH_E_MEMORY. */
int obj_naming_end(struct obj_naming *naming, uint32_t n_faces, char ***name, uint32_t *n_names,
                   struct mesh_group_run **run, uint32_t *n_runs, struct cloth_error *error);

void obj_naming_free(struct obj_naming *naming);

/* The rest of a line `mtllib` of the file `path`: adds what it names to a list of char *, whose
 * items the caller frees. The line is one file, or each of its words is one. Those that are found
 * beside the file have absolute paths, others their names; none is read. Error: CLOTH_E_MEMORY. */
int obj_library_line(struct cloth_list *library, const char *path, const char *at,
                     struct cloth_error *error);

/* ---- A mesh of what was read ---- */

/* Lists, in the file's order; without lines, faces and edges are named by their numbers. */
struct obj_parts {
    struct cloth_list position, uv; /* 3 and 2 doubles an item */
    struct cloth_list corner;       /* uint32_t[2]: vertex, and uv or OBJ_NO_UV */
    struct cloth_list face_start, face_line, edge, edge_line;
    struct obj_naming naming, drawing; /* groups, materials */
    struct cloth_list library;         /* char *: paths of the files with these */
};

/* Uses the lists up. fans: as of struct mesh_source. After an error the mesh is empty. Errors:
 * those of mesh_finish. */
int obj_parts_make(struct obj_parts *parts, const char *path, bool fans, struct mesh *mesh,
                   struct cloth_error *error);
void obj_parts_free(struct obj_parts *parts);

/* ---- Texture coordinates ---- */

#define OBJ_NO_UV 0xffffffffu

/* Gives the uv of corners to a mesh that has its faces and triangles. uv: a list of u and v;
 * corner: of all faces in turn, the vertex and a number in the list, which exists, or OBJ_NO_UV.
 * Error: CLOTH_E_MEMORY. */
int obj_uv_put(struct mesh *mesh, const double (*uv)[2], const uint32_t (*corner)[2],
               struct cloth_error *error);

#endif
