/* Names are sorted once, at the end: a file may have as many groups as faces. */
#include "cloth/mesh/detail/naming.h"

#include "cloth/base/order.h"
#include "cloth/mesh/detail/words.h"

#include <stdlib.h>
#include <string.h>

struct entry {
    char *name;
    uint32_t first, end; /* faces */
    uint32_t number;     /* in the order of the file, of those with faces */
    uint32_t group;      /* the number of the first entry of this name; then of its group */
};

/* Gives the open entries of a kind their last face. */
static void close_open(struct mesh_naming *naming, enum mesh_naming_kind kind, uint32_t n_faces)
{
    struct entry *entry = naming->entry.items;
    for (size_t i = naming->open[kind]; i < naming->end[kind]; i++)
        entry[i].end = n_faces;
    naming->open[kind] = naming->end[kind] = naming->entry.n;
}

static int add_name(struct mesh_naming *naming, const char *from, const char *to, uint32_t n_faces,
                    struct cloth_error *error)
{
    const size_t length = (size_t)(to - from);
    char *name = cloth_alloc(length + 1, 1, error);
    struct entry *entry = name ? cloth_list_add(&naming->entry, sizeof *entry, 1, error) : NULL;
    if (!entry) {
        free(name);
        return CLOTH_E_MEMORY;
    }
    memcpy(name, from, length);
    *entry = (struct entry){.name = name, .first = n_faces};
    return CLOTH_OK;
}

int mesh_naming_line(struct mesh_naming *naming, enum mesh_naming_kind kind, const char *at,
                     uint32_t n_faces, struct cloth_error *error)
{
    int code = CLOTH_OK;
    close_open(naming, kind, n_faces);
    for (const char *word, *end; !code && (word = mesh_word(at)); at = end) {
        end = mesh_word_end(word);
        for (const char *next; kind == MESH_OBJECTS && (next = mesh_word(end));)
            end = mesh_word_end(next);
        code = add_name(naming, word, end, n_faces, error);
    }
    naming->end[kind] = naming->entry.n;
    return code;
}

/* Entries without faces are gone. */
static size_t drop_empty(struct entry *entry, size_t n)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        if (entry[i].first == entry[i].end)
            free(entry[i].name);
        else
            entry[kept++] = entry[i];
    }
    return kept;
}

static int by_name(const void *va, const void *vb)
{
    const struct entry *a = va, *b = vb;
    const int order = strcmp(a->name, b->name);
    return order ? order : cloth_compare_u32(a->number, b->number);
}

static int naming_by_number(const void *va, const void *vb)
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
    qsort(entry, n, sizeof *entry, naming_by_number);
    for (size_t i = 0; i < n; i++)
        entry[i].group =
            entry[i].group == i ? groups++ : entry[entry[i].group].group; /* which came before */
    return groups;
}

int mesh_naming_end(struct mesh_naming *naming, uint32_t n_faces, struct mesh_names *names,
                    struct cloth_error *error)
{
    struct entry *entry = naming->entry.items;
    *names = (struct mesh_names){0};
    for (enum mesh_naming_kind kind = MESH_GROUPS; kind < MESH_NAMINGS; kind++)
        close_open(naming, kind, n_faces);
    const size_t n = naming->entry.n = drop_empty(entry, naming->entry.n);
    for (size_t i = 0; i < n; i++)
        entry[i].number = (uint32_t)i;
    const uint32_t groups = n ? number_groups(entry, n) : 0;
    names->name = cloth_alloc(groups, sizeof *names->name, error);
    names->run = cloth_alloc(n, sizeof *names->run, error);
    if (!names->name || !names->run)
        return CLOTH_E_MEMORY;
    for (size_t i = 0; i < n; i++) {
        names->run[i] =
            (struct mesh_group_run){entry[i].group, entry[i].first, entry[i].end - entry[i].first};
        if (entry[i].group < names->n)
            continue;
        names->name[names->n++] = entry[i].name;
        entry[i].name = NULL; /* the names have it now */
    }
    names->n_runs = (uint32_t)n;
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
