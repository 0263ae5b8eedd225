/* A watched vertex stands once in the list of places, however many probes have it: a probe knows
 * its index in the list. So blocks report each of their vertices once. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Entries as they are found. */
struct finder {
    struct cloth_list entries; /* uint32_t: vertices of all cloths together */
    uint32_t first;            /* of the cloth */
    struct cloth_error *error;
};

static void find_entry(void *to, uint32_t vertex)
{
    struct finder *finder = to;
    uint32_t *entry = cloth_list_add(&finder->entries, sizeof *entry, 1, finder->error);
    if (entry)
        *entry = finder->first + vertex;
}

static int check_used(const struct flow_source *source, const struct model_probe *probe,
                      const struct finder *finder, size_t from, struct cloth_error *error)
{
    const uint32_t *entry = finder->entries.items;
    for (size_t i = from; i < finder->entries.n; i++)
        if (!source->particles.used[entry[i]])
            return model_fail(probe->pick.place, error,
                              "probe '%.60s' names vertex %u of cloth '%.60s', which no face or "
                              "edge uses: it does not move",
                              probe->name, entry[i] - finder->first,
                              source->model->cloths[probe->cloth].name);
    return CLOTH_OK;
}

static int find_all(struct flow_watched *watched, const struct flow_source *source,
                    struct finder *finder, struct cloth_error *error)
{
    const struct model *model = source->model;
    for (uint32_t p = 0; p < model->n_probes; p++) {
        const struct model_probe *probe = model->probes + p;
        watched->first[p + 1] = (uint32_t)finder->entries.n;
        if (probe->by_obstacle)
            continue;
        finder->first = model_first(model, probe->cloth);
        const struct flow_picking picking = {model->cloths + probe->cloth,
                                             source->particles.used + finder->first, "a probe",
                                             find_entry, finder};
        int code = flow_pick(&probe->pick, &picking, error);
        if (!code && error->code)
            code = error->code;
        if (!code)
            code = check_used(source, probe, finder, watched->first[p], error);
        if (code)
            return code;
        watched->first[p + 1] = (uint32_t)finder->entries.n;
    }
    return CLOTH_OK;
}

/* Places of the entries, ascending, each once; and where each entry's is. */
static int sort_places(struct flow_watched *watched, const struct flow_source *source, size_t n,
                       const uint32_t *vertex, struct cloth_error *error)
{
    watched->place = cloth_alloc(n, sizeof *watched->place, error);
    watched->entry = cloth_alloc(n, sizeof *watched->entry, error);
    watched->vertex = cloth_alloc(n, sizeof *watched->vertex, error);
    watched->again = cloth_alloc(n, 1, error);
    if (!watched->place || !watched->entry || !watched->vertex || !watched->again)
        return CLOTH_E_MEMORY;
    for (size_t i = 0; i < n; i++)
        watched->place[i] = source->blocks.place[vertex[i]];
    qsort(watched->place, n, sizeof *watched->place, cloth_compare_items_u32);
    for (size_t i = 0; i < n; i++)
        if (i == 0 || watched->place[i] != watched->place[watched->n - 1])
            watched->place[watched->n++] = watched->place[i];
    for (size_t i = 0; i < n; i++) {
        const uint32_t place = source->blocks.place[vertex[i]];
        const uint32_t *at = bsearch(&place, watched->place, watched->n, sizeof *watched->place,
                                     cloth_compare_items_u32);
        watched->entry[i] = (uint32_t)(at - watched->place);
        watched->vertex[i] = vertex[i];
    }
    return CLOTH_OK;
}

/* Marks entries whose vertex an earlier entry of their probe names otherwise. */
static int find_again(struct flow_watched *watched, uint32_t n_probes, struct cloth_error *error)
{
    uint32_t *last = cloth_alloc(watched->n, sizeof *last, error); /* probe, from 1 */
    if (!last)
        return CLOTH_E_MEMORY;
    for (uint32_t p = 0; p < n_probes; p++)
        for (uint32_t i = watched->first[p]; i < watched->first[p + 1]; i++) {
            uint32_t *probe = last + watched->entry[i];
            watched->again[i] = *probe == p + 1;
            *probe = p + 1;
        }
    free(last);
    return CLOTH_OK;
}

static size_t columns_of(const struct flow_watched *watched, const struct model *model, uint32_t p)
{
    const struct model_probe *probe = model->probes + p;
    const size_t values =
        3 * ((size_t)probe->position + probe->velocity + probe->reaction + probe->contact);
    return values * (watched->first[p + 1] - watched->first[p]) +
           3 * ((size_t)probe->total + probe->contact_total + probe->by_obstacle);
}

int flow_watched_make(struct flow_watched *watched, const struct flow_source *source,
                      struct cloth_error *error)
{
    const struct model *model = source->model;
    *watched = (struct flow_watched){0};
    if (!model->n_probes)
        return CLOTH_OK;
    struct finder finder = {.error = error};
    watched->first = cloth_alloc((size_t)model->n_probes + 1, sizeof *watched->first, error);
    int code = watched->first ? find_all(watched, source, &finder, error) : CLOTH_E_MEMORY;
    if (!code)
        code = sort_places(watched, source, finder.entries.n, finder.entries.items, error);
    if (!code)
        code = find_again(watched, model->n_probes, error);
    free(finder.entries.items);
    watched->n_columns = FLOW_RUN_COLUMNS;
    for (uint32_t p = 0; p < model->n_probes && !code; p++)
        watched->n_columns += columns_of(watched, model, p);
    return code;
}

void flow_watched_free(struct flow_watched *watched)
{
    free(watched->place);
    free(watched->entry);
    free(watched->vertex);
    free(watched->again);
    free(watched->first);
    *watched = (struct flow_watched){0};
}

/* ---- The header ---- */

static void three(FILE *file, const char *before, const char *unit)
{
    for (const char *c = "xyz"; *c; c++)
        fprintf(file, ",%s%c [%s]", before, *c, unit);
}

static void print_probe(FILE *file, const struct flow_watched *watched, const struct model *model,
                        uint32_t p)
{
    const struct model_probe *probe = model->probes + p;
    const uint32_t first = model_first(model, probe->cloth);
    char before[200];
    for (uint32_t i = watched->first[p]; i < watched->first[p + 1]; i++) {
        const struct {
            bool wanted;
            const char *letter, *unit;
        } values[] = {{probe->position, "", "m"},
                      {probe->velocity, "v", "m/s"},
                      {probe->reaction, "r", "N"},
                      {probe->contact, "c", "N"}};
        for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
            snprintf(before, sizeof before, "%.100s.%u.%s", probe->name, watched->vertex[i] - first,
                     values[k].letter);
            if (values[k].wanted)
                three(file, before, values[k].unit);
        }
    }
    snprintf(before, sizeof before, "%.100s.total.r", probe->name);
    if (probe->total)
        three(file, before, "N");
    snprintf(before, sizeof before, "%.100s%s.c", probe->name, probe->by_obstacle ? "" : ".total");
    if (probe->contact_total || probe->by_obstacle)
        three(file, before, "N");
}

int flow_watched_header(const struct flow_watched *watched, const struct model *model, char **text,
                        struct cloth_error *error)
{
    size_t size;
    *text = NULL;
    if (!watched->n_columns)
        return CLOTH_OK;
    FILE *file = open_memstream(text, &size);
    if (!file)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the header of the probes");
    fputs("step,time [s],iterations,longest [1],shortest [1],kinetic [J],elastic [J],gravity "
          "[J],loads [J]",
          file);
    for (uint32_t p = 0; p < model->n_probes; p++)
        print_probe(file, watched, model, p);
    const bool failed = ferror(file);
    if (fclose(file) == 0 && !failed && *text)
        return CLOTH_OK;
    free(*text);
    *text = NULL;
    return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the header of the probes");
}
