/* A watched vertex stands once in the list of places, however many probes have it: a probe knows
 * its index in the list. So blocks report each of their vertices once. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdio.h>
#include <stdlib.h>

static int check_used(const struct flow_picking *picking, const struct model_probe *probe,
                      size_t from, struct cloth_error *error)
{
    const uint32_t *entry = picking->list.items;
    for (size_t i = from; i < picking->list.n; i++)
        if (!picking->used[entry[i]])
            return model_fail(probe->pick.place, error,
                              "probe '%.60s' names vertex %u of cloth '%.60s', which no face or "
                              "edge uses: it does not move",
                              probe->name, entry[i] - picking->first, picking->cloth->name);
    return CLOTH_OK;
}

static int find_all(struct flow_watched *watched, const struct model *model,
                    struct flow_picking *picking, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t p = 0; p < model->n_probes && !code; p++) {
        const struct model_probe *probe = model->probes + p;
        picking->cloth = model->cloths + probe->cloth;
        picking->first = model_first(model, probe->cloth);
        if (!probe->by_obstacle)
            code = flow_pick(&probe->pick, picking, error);
        if (!code)
            code = check_used(picking, probe, watched->first[p], error);
        watched->first[p + 1] = (uint32_t)picking->list.n;
    }
    return code;
}

/* Places of the entries, ascending, each once; and where each entry's is. */
static int sort_places(struct flow_watched *watched, const struct flow_source *source, size_t n,
                       const uint32_t *vertex, struct cloth_error *error)
{
    watched->place = cloth_take(&watched->memory, n, sizeof *watched->place, error);
    watched->entry = cloth_take(&watched->memory, n, sizeof *watched->entry, error);
    watched->vertex = cloth_take(&watched->memory, n, sizeof *watched->vertex, error);
    watched->again = cloth_take(&watched->memory, n, 1, error);
    if (watched->memory.lacks)
        return CLOTH_E_MEMORY;
    for (size_t i = 0; i < n; i++)
        watched->place[i] = source->blocks.place[vertex[i]];
    qsort(watched->place, n, sizeof *watched->place, cloth_compare_items_u32);
    for (size_t i = 0; i < n; i++)
        if (i == 0 || watched->place[i] != watched->place[watched->n - 1])
            watched->place[watched->n++] = watched->place[i];
    for (size_t i = 0; i < n; i++) {
        const uint32_t place = source->blocks.place[vertex[i]];
        watched->entry[i] = cloth_first_from(watched->place, 1, watched->n, place);
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
    struct flow_picking picking = {.used = source->particles.used, .what = "a probe"};
    watched->first =
        cloth_take(&watched->memory, (size_t)model->n_probes + 1, sizeof *watched->first, error);
    int code = watched->first ? find_all(watched, model, &picking, error) : CLOTH_E_MEMORY;
    if (!code)
        code = sort_places(watched, source, picking.list.n, picking.list.items, error);
    if (!code)
        code = find_again(watched, model->n_probes, error);
    free(picking.list.items);
    watched->n_columns = FLOW_RUN_COLUMNS;
    for (uint32_t p = 0; p < model->n_probes && !code; p++)
        watched->n_columns += columns_of(watched, model, p);
    return code;
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
