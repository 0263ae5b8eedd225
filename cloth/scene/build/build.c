/* Helpers of all that builds a model: its lists, warnings and files, and faults of parts. */
#include "cloth/scene/build/build.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The bytes that a vertex of a grid takes on rank 0 while it is cut, for any number of ranks:
 * position, graph, METIS. The system overcommits memory, so an allocation is no test. */
static const double LEAST_BYTES = 150;

void *scene_build_out_of_memory(struct cloth_error *error)
{
    cloth_fail(error, CLOTH_E_MEMORY, "out of memory while the scene is read");
    return NULL;
}

void *scene_build_add(void *list, uint32_t *n, size_t more, size_t size, struct cloth_error *error)
{
    char *items;
    memcpy(&items, list, sizeof items);
    items = realloc(items, (*n + more) * size);
    if (!items)
        return scene_build_out_of_memory(error);
    memcpy(list, &items, sizeof items);
    items += *n * size;
    *n += (uint32_t)more;
    return memset(items, 0, more * size);
}

char *scene_build_copy(const char *text, struct cloth_error *error)
{
    char *copy = strdup(text);
    return copy ? copy : scene_build_out_of_memory(error);
}

char *scene_build_place(const struct scene_tree *tree, int node)
{
    char *place = scene_tree_place(tree, node);
    return place ? place : scene_build_out_of_memory(tree->error);
}

int scene_build_warn(const struct scene_tree *tree, int node, const char *format, ...)
{
    struct model *model = tree->model;
    char text[500], *warning = NULL, *place = scene_build_place(tree, node);
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (!place || asprintf(&warning, "%s: %s", place, text) < 0)
        warning = scene_build_out_of_memory(tree->error);
    char **to =
        warning ? scene_build_add(&model->warnings, &model->n_warnings, 1, sizeof *to, tree->error)
                : NULL;
    if (to)
        *to = warning;
    else
        free(warning);
    free(place);
    return tree->error->code;
}

int scene_build_blame(int code, const char *what, struct scene_tree *tree, int node)
{
    if (tree->inner.code == CLOTH_E_MEMORY)
        return cloth_fail(tree->error, CLOTH_E_MEMORY, "%s: %s", tree->path, tree->inner.text);
    return tree->inner.code ? scene_tree_fail(tree, node, "%s: %s", what, tree->inner.text) : code;
}

/* ---- Files ---- */

int scene_build_file(const struct scene_tree *tree, const char *path)
{
    struct model *model = tree->model;
    char *copy = scene_build_copy(path, tree->error);
    char **to =
        copy ? scene_build_add(&model->files, &model->n_files, 1, sizeof *to, tree->error) : NULL;
    if (to)
        *to = copy;
    else
        free(copy);
    return tree->error->code;
}

char *scene_build_path(const struct scene_tree *tree, int node)
{
    char *path = scene_tree_beside(tree, node, scene_tree_scalar(tree, node));
    if (!path)
        return scene_build_out_of_memory(tree->error);
    if (!scene_build_file(tree, path))
        return path;
    free(path);
    return NULL;
}

int scene_build_obj(struct mesh *mesh, scene_obj_reader *reads, const char *what,
                    struct scene_tree *tree, int node)
{
    char *path = scene_build_path(tree, node);
    const int code = path ? reads(mesh, path, &tree->inner) : tree->error->code;
    free(path);
    return scene_build_blame(code, what, tree, node);
}

/* ---- Memory ---- */

/* The memory of this machine; infinite if unknown. */
static double memory_bytes(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? (double)pages * (double)size : INFINITY;
}

int scene_build_check_memory(uint64_t n, const char *what, const struct scene_tree *tree, int node)
{
    const double need = LEAST_BYTES * (double)n, memory = memory_bytes();
    if (need <= memory)
        return CLOTH_OK;
    return scene_tree_fail(tree, node,
                           "%s %llu vertices, which take %.0f GB of memory or more; this machine "
                           "has %.0f GB",
                           what, (unsigned long long)n, need / 1e9, memory / 1e9);
}

/* ---- Parts that phases share, as many as a scene has garments and figures ---- */

struct scene_made_part *scene_made_part(struct scene_made *made, const void *key, size_t size,
                                        struct cloth_error *error)
{
    struct scene_made_part *part = made->parts;
    while (part && (part->size != size || memcmp(part->key, key, size) != 0))
        part = part->next;
    if (part)
        return part;
    char *copy = cloth_alloc(size, 1, error);
    part = copy ? cloth_alloc(1, sizeof *part, error) : NULL;
    if (!part) {
        free(copy);
        return NULL;
    }
    memcpy(copy, key, size);
    *part = (struct scene_made_part){.next = made->parts, .key = copy, .size = size};
    return made->parts = part;
}

void scene_made_free(struct scene_made *made)
{
    while (made->parts) {
        struct scene_made_part *part = made->parts;
        made->parts = part->next;
        garment_free(&part->garment);
        garment_pattern_free(&part->pattern);
        mesh_free(&part->mesh);
        mannequin_rig_free(&part->rig);
        free(part->key);
        free(part);
    }
}
