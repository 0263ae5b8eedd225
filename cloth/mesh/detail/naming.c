/* Names are sorted once, at the end: a file may have as many groups as faces. */
#include "cloth/mesh/detail/naming.h"

#include "cloth/base/order.h"
#include "cloth/mesh/detail/words.h"

#include <stdlib.h>
#include <string.h>

struct entry {
    char *name;
    uint32_t first, end; /* faces */
    uint32_t number;     /* in the order of the file */
    uint32_t group;      /* the number of the first entry of this name; then of its group */
};

/* Gives the open entries their last face; those without faces are gone. */
static void close_open(struct mesh_naming *naming, uint32_t n_faces)
{
    struct entry *entry = naming->entry.items;
    for (size_t i = naming->open; i < naming->entry.n; i++)
        entry[i].end = n_faces;
    for (size_t i = naming->open; i < naming->entry.n && entry[i].first == n_faces; i++)
        free(entry[i].name);
    if (naming->open < naming->entry.n && entry[naming->open].first == n_faces)
        naming->entry.n = naming->open;
    naming->open = naming->entry.n;
}

int mesh_naming_line(struct mesh_naming *naming, const char *at, uint32_t n_faces,
                     struct cloth_error *error)
{
    close_open(naming, n_faces);
    for (const char *word; (word = mesh_word(at)); at = mesh_word_end(word)) {
        const size_t length = (size_t)(mesh_word_end(word) - word);
        char *name = cloth_alloc(length + 1, 1, error);
        struct entry *entry = name ? cloth_list_add(&naming->entry, sizeof *entry, 1, error) : NULL;
        if (!entry) {
            free(name);
            return CLOTH_E_MEMORY;
        }
        memcpy(name, word, length);
        *entry = (struct entry){
            .name = name, .first = n_faces, .number = (uint32_t)(naming->entry.n - 1)};
    }
    return CLOTH_OK;
}

static int by_name(const void *va, const void *vb)
{
    const struct entry *a = va, *b = vb;
    const int order = strcmp(a->name, b->name);
    return order ? order : cloth_compare_u32(a->number, b->number);
}

static int by_number(const void *va, const void *vb)
{
    return cloth_compare_u32(((const struct entry *)va)->number,
                             ((const struct entry *)vb)->number);
}

/* Finds the groups: they are in the order in which the file names them first. */
static uint32_t number_groups(struct entry *entry, size_t n)
{
    uint32_t groups = 0;
    qsort(entry, n, sizeof *entry, by_name);
    for (size_t i = 0; i < n; i++) {
        const bool again = i && !strcmp(entry[i - 1].name, entry[i].name);
        entry[i].group = again ? entry[i - 1].group : entry[i].number;
    }
    qsort(entry, n, sizeof *entry, by_number);
    for (size_t i = 0; i < n; i++)
        entry[i].group =
            entry[i].group == i ? groups++ : entry[entry[i].group].group; /* which came before */
    return groups;
}

int mesh_naming_end(struct mesh_naming *naming, struct mesh *mesh, struct cloth_error *error)
{
    struct entry *entry = naming->entry.items;
    close_open(naming, mesh->n_faces);
    const size_t n = naming->entry.n;
    for (size_t i = 0; i < n; i++)
        entry[i].number = (uint32_t)i;
    const uint32_t groups = n ? number_groups(entry, n) : 0;
    mesh->group = cloth_alloc(groups, sizeof *mesh->group, error);
    mesh->group_run = cloth_alloc(n, sizeof *mesh->group_run, error);
    if (!mesh->group || !mesh->group_run)
        return CLOTH_E_MEMORY;
    for (size_t i = 0; i < n; i++) {
        mesh->group_run[i] =
            (struct mesh_group_run){entry[i].group, entry[i].first, entry[i].end - entry[i].first};
        if (entry[i].group < mesh->n_groups)
            continue;
        mesh->group[mesh->n_groups++] = entry[i].name;
        entry[i].name = NULL; /* the mesh has it now */
    }
    mesh->n_group_runs = (uint32_t)n;
    return CLOTH_OK;
}

void mesh_naming_free(struct mesh_naming *naming)
{
    struct entry *entry = naming->entry.items;
    for (size_t i = 0; i < naming->entry.n; i++)
        free(entry[i].name);
    free(naming->entry.items);
    *naming = (struct mesh_naming){0};
}
