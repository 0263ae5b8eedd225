/* A weld makes vertices of any cloths one. They stay names of it: files, pins, loads and probes
 * name each of them, and their masses and loads add up. The lowest of them, the root, stands for
 * all: it alone has a row. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/sets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- Which vertices are one ---- */

static int list_pairs(struct cloth_list *list, const struct model *model, const unsigned char *used,
                      struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t w = 0; w < model->n_welds && !code; w++)
        code = flow_pairs_list(list, model, &model->welds[w].pairs, "a weld", error);
    const struct flow_pair *pair = list->items;
    for (size_t i = 0; i < list->n && !code; i++)
        if (!used[pair[i].vertex[0]] || !used[pair[i].vertex[1]])
            code = flow_pair_fail(model, pair + i, "a weld",
                                  "one of which no face, edge or joint uses", error);
    return code ? code : flow_pairs_once(list, model, "a weld", error);
}

/* The root of each vertex, and the list of all other names. */
static int name_all(struct flow_particles *p, const struct cloth_list *list,
                    struct cloth_error *error)
{
    struct flow_welds *welds = &p->welds;
    const struct flow_pair *pair = list->items;
    const uint32_t n = p->n;
    uint32_t *root = welds->root = cloth_take(&p->memory, n, sizeof *root, error);
    if (!root)
        return CLOTH_E_MEMORY;
    cloth_sets_start(root, n);
    for (size_t i = 0; i < list->n; i++)
        cloth_sets_join(root, pair[i].vertex[0], pair[i].vertex[1]);
    for (uint32_t v = 0; v < n; v++) {
        root[v] = cloth_sets_root(root, v);
        welds->n += root[v] != v;
    }
    welds->name = cloth_take(&p->memory, welds->n, sizeof *welds->name, error);
    if (!welds->name)
        return CLOTH_E_MEMORY;
    for (uint32_t v = 0, k = 0; v < n; v++) {
        if (root[v] == v)
            continue;
        welds->name[k][0] = root[v];
        welds->name[k++][1] = v;
    }
    qsort(welds->name, welds->n, sizeof *welds->name, cloth_by_two);
    return CLOTH_OK;
}

/* The place of a weld that has a vertex of a cloth. */
static const char *place_of_vertex(const struct model *model, uint32_t cloth, uint32_t vertex)
{
    for (uint32_t w = 0; w < model->n_welds; w++) {
        const struct model_pairs *pairs = &model->welds[w].pairs;
        for (int end = 0; end < 2; end++)
            for (uint32_t i = 0; i < pairs->end[0].n && pairs->end[end].cloth == cloth; i++)
                if (pairs->end[end].vertices[i] == vertex)
                    return pairs->place;
    }
    return NULL;
}

/* Checks that welds keep n vertices of a cloth, which one thing joins, apart. root: by vertex of
 * the cloth. */
static int welds_check_apart(const struct model *model, uint32_t cloth, const uint32_t *root,
                             const uint32_t *vertex, uint32_t n, const char *what,
                             struct cloth_error *error)
{
    for (uint32_t j = 1; j < n; j++)
        for (uint32_t i = 0; i < j; i++)
            if (root[vertex[i]] == root[vertex[j]])
                return model_fail(place_of_vertex(model, cloth, vertex[i]), error,
                                  "welds make vertices %u and %u of cloth '%.60s' one, which %s "
                                  "joins; it needs them apart",
                                  vertex[i], vertex[j], model->cloths[cloth].name, what);
    return CLOTH_OK;
}

static int check_shapes(const struct flow_welds *welds, const struct model *model,
                        struct cloth_error *error)
{
    const uint32_t *root = welds->root;
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        const struct mesh *mesh = &model->cloths[c].mesh;
        uint32_t corner[3];
        for (uint32_t t = 0; t < mesh->n_triangles && !code; t++) {
            mesh_corners(mesh, t, corner);
            code = welds_check_apart(model, c, root, corner, 3, "a triangle", error);
        }
        for (uint32_t e = 0; e < mesh->n_lone_edges && !code; e++)
            code = welds_check_apart(model, c, root, mesh->lone_edge + 2 * (size_t)e, 2, "an edge",
                                     error);
        root += mesh->n_vertices;
    }
    return code;
}

int flow_welds_make(struct flow_particles *p, const struct model *model, struct cloth_error *error)
{
    struct cloth_list list = {0};
    if (!model->n_welds)
        return CLOTH_OK;
    int code = list_pairs(&list, model, p->used, error);
    code = code ? code : name_all(p, &list, error);
    free(list.items);
    return code ? code : check_shapes(&p->welds, model, error);
}

bool flow_is_welded(const struct flow_welds *welds, uint32_t root)
{
    const uint32_t at = cloth_first_from(welds->name, 2, welds->n, root);
    return at < welds->n && welds->name[at][0] == root;
}

int flow_welds_check(const struct flow_welds *welds, const struct element_cloths *elements,
                     struct cloth_error *error)
{
    const struct model *model = elements->model;
    const uint32_t *root = welds->root;
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && root && !code; c++) {
        const struct mesh_edges *edges = elements->edges + c;
        const bool bends = element_parts(model, model->cloths + c) & 1u << ELEMENT_HINGES;
        for (uint32_t e = 0; e < edges->n && bends && !code; e++)
            if (element_is_hinge(edges->edge + e))
                code =
                    welds_check_apart(model, c, root, edges->edge[e].opposite, 2, "a hinge", error);
        root += model->cloths[c].mesh.n_vertices;
    }
    return code;
}

/* ---- Welded vertices ---- */

static int check_distance(const struct flow_particles *p, const struct model *model,
                          const struct flow_pair *pair, double max, struct cloth_error *error)
{
    const double *a = p->start[pair->vertex[0]], *b = p->start[pair->vertex[1]];
    const phys_vec d = {b[0] - a[0], b[1] - a[1], b[2] - a[2], 0};
    const double distance = sqrt(phys_dot(&d, &d));
    char why[200];
    if (distance <= max)
        return CLOTH_OK;
    snprintf(why, sizeof why,
             "which start %g m from each other; at most %g m are expected (tolerance)", distance,
             max);
    return flow_pair_fail(model, pair, "a weld", why, error);
}

static int check_distances(const struct flow_particles *p, const struct model *model,
                           struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t w = 0; w < model->n_welds && !code; w++) {
        struct cloth_list list = {0};
        code = flow_pairs_list(&list, model, &model->welds[w].pairs, "a weld", error);
        const struct flow_pair *pair = list.items;
        for (size_t i = 0; i < list.n && !code; i++)
            code = check_distance(p, model, pair + i, model->welds[w].tolerance, error);
        free(list.items);
    }
    return code;
}

/* at: where the cloth is looked for from; zeroed at first. */
static const struct model_material *welds_material_of(const struct model *model, uint32_t vertex,
                                                      struct flow_cloths *at)
{
    flow_source_cloth(at, model, vertex);
    const uint32_t own = vertex - at->first;
    return model->materials + model_material_of(model->cloths + at->cloth, 1, &own);
}

/* The drag of a root with n other names. A vertex has one viscous damping, the largest; each part
 * has its own mass damping. If all have the same rate it takes the whole mass: equal cloths have
 * the bits of one. */
static double drag_of(const struct flow_particles *p, const struct model *model, uint32_t root,
                      const uint32_t (*name)[2], uint32_t n)
{
    struct flow_cloths at = {0};
    const struct model_material *first = welds_material_of(model, root, &at);
    double viscous = first->damping_viscous, sum = first->damping_mass * p->own[root];
    bool alike = true;
    for (uint32_t i = 0; i < n; i++) {
        const struct model_material *material = welds_material_of(model, name[i][1], &at);
        viscous = fmax(viscous, material->damping_viscous);
        sum += material->damping_mass * p->own[name[i][1]];
        alike = alike && !(material->damping_mass < first->damping_mass) &&
                !(material->damping_mass > first->damping_mass);
    }
    return viscous + (alike ? first->damping_mass * p->mass[root] : sum);
}

/* All start at the mean of their places, with the mean of their velocities by mass. The mean of
 * equal ones has the same bits. */
static void meet_at_root(struct flow_particles *p, uint32_t root, const uint32_t (*name)[2],
                         uint32_t n)
{
    double *start = p->start[root], away[6] = {0};
    for (uint32_t i = 0; i < n; i++)
        for (int c = 0; c < 6; c++) {
            const double part = c < 3 ? 1.0 / (n + 1) : p->own[name[i][1]] / p->mass[root];
            away[c] += part * (p->start[name[i][1]][c] - start[c]);
        }
    for (int c = 0; c < 6; c++)
        start[c] += away[c];
    for (uint32_t i = 0; i < n; i++)
        for (int c = 0; c < 6; c++)
            p->start[name[i][1]][c] = start[c];
}

/* Keeps the places of all vertices before welds of seams move them. */
static int keep_unwelded(struct flow_particles *p, const struct model *model,
                         struct cloth_error *error)
{
    bool sewn = false;
    for (uint32_t w = 0; w < model->n_welds; w++)
        sewn = sewn || model->welds[w].pairs.seam;
    if (!sewn)
        return CLOTH_OK;
    p->unwelded = cloth_take(&p->memory, p->n, sizeof *p->unwelded, error);
    for (uint32_t v = 0; v < p->n && p->unwelded; v++)
        for (int c = 0; c < 3; c++)
            p->unwelded[v][c] = p->start[v][c];
    return p->unwelded ? CLOTH_OK : CLOTH_E_MEMORY;
}

int flow_welds_settle(struct flow_particles *p, const struct model *model,
                      struct cloth_error *error)
{
    const struct flow_welds *welds = &p->welds;
    if (!welds->root)
        return CLOTH_OK;
    int code = check_distances(p, model, error);
    code = code ? code : keep_unwelded(p, model, error);
    struct flow_cloths at = {0};
    for (uint32_t v = 0; v < p->n && !code; v++) {
        const struct model_material *material = welds_material_of(model, v, &at);
        p->drag[v] = material->damping_viscous + material->damping_mass * p->mass[v];
    }
    for (uint32_t i = 0, n; i < welds->n && !code; i += n) {
        const uint32_t root = welds->name[i][0];
        const uint32_t(*name)[2] = (const uint32_t(*)[2])welds->name + i;
        for (n = 1; i + n < welds->n && name[n][0] == root;)
            n++;
        p->drag[root] = drag_of(p, model, root, name, n);
        meet_at_root(p, root, name, n);
    }
    return code;
}

int flow_names_make(struct flow_names *names, const struct flow_welds *welds,
                    struct mesh_blocks *blocks, struct cloth_error *error)
{
    *names = (struct flow_names){0};
    if (!welds->n)
        return CLOTH_OK;
    names->name = cloth_alloc(welds->n, sizeof *names->name, error);
    if (!names->name)
        return CLOTH_E_MEMORY;
    names->n = welds->n;
    for (uint32_t i = 0; i < welds->n; i++) {
        const uint32_t place = blocks->place[welds->name[i][0]];
        blocks->place[welds->name[i][1]] = place;
        names->name[i][0] = place;
        names->name[i][1] = welds->name[i][1];
    }
    qsort(names->name, names->n, sizeof *names->name, cloth_by_two);
    return CLOTH_OK;
}

bool flow_name_of(const struct flow_names *names, const uint32_t *vertex,
                  const struct flow_table *t, uint32_t k, struct flow_name *name)
{
    const uint32_t at =
        k < t->n ? 0 : cloth_first_from(names->name, 2, names->n, t->first) + (k - t->n);
    if (k < t->n)
        *name = (struct flow_name){k, vertex[t->first + k]};
    else if (at < names->n && names->name[at][0] < t->first + t->n)
        *name = (struct flow_name){names->name[at][0] - t->first, names->name[at][1]};
    else
        return false;
    return true;
}

/* ---- Springs ---- */

/* A spring with two welded ends, which are its roots, and its number among all. */
struct candidate {
    struct flow_spring spring;
    uint64_t number;
};

struct finder {
    const struct flow_welds *welds;
    uint64_t number;
    struct cloth_list found; /* candidates */
    struct cloth_error *error;
    int code;
};

static void welds_find_joined(void *to, const struct flow_spring *s)
{
    struct finder *finder = to;
    const uint64_t number = finder->number++;
    const struct flow_welds *welds = finder->welds;
    const uint32_t a = welds->root[s->a], b = welds->root[s->b];
    if (finder->code || !flow_is_welded(welds, a) || !flow_is_welded(welds, b))
        return;
    struct candidate candidate = {*s, number};
    candidate.spring.a = a < b ? a : b;
    candidate.spring.b = a < b ? b : a;
    finder->code = cloth_list_put(&finder->found, &candidate, sizeof candidate, finder->error);
}

static int compare_kinds(const struct flow_spring *a, const struct flow_spring *b)
{
    int order = cloth_compare_numbers(a, b, 2);
    if (!order)
        order = (a->stretch > b->stretch) - (a->stretch < b->stretch);
    if (!order)
        order = (a->length > b->length) - (a->length < b->length);
    if (!order)
        order = cloth_compare_numbers(a->size.curve, b->size.curve, 2);
    return order ? order : (a->size.along > b->size.along) - (a->size.along < b->size.along);
}

static int compare_candidates(const void *va, const void *vb)
{
    const struct candidate *a = va, *b = vb;
    const int order = compare_kinds(&a->spring, &b->spring);
    return order ? order : (a->number > b->number) - (a->number < b->number);
}

/* The first of alike ones has the sum, the others go. */
static int merge(struct flow_springs *springs, const struct cloth_list *found,
                 struct cloth_error *error)
{
    const struct candidate *all = found->items;
    springs->merged = cloth_take(&springs->memory, found->n, sizeof *springs->merged, error);
    if (!springs->merged)
        return CLOTH_E_MEMORY;
    for (size_t i = 0, end; i < found->n; i = end) {
        struct flow_merged *sum = springs->merged + springs->n_merged;
        const struct flow_spring *first = &all[i].spring;
        *sum = (struct flow_merged){all[i].number, 0, 0, first->a == first->b};
        for (end = i; end < found->n && !compare_kinds(first, &all[end].spring); end++) {
            sum->stiffness += all[end].spring.stiffness;
            sum->damping += all[end].spring.damping;
            springs->merged[springs->n_merged++] =
                end > i ? (struct flow_merged){all[end].number, 0, 0, true} : *sum;
        }
    }
    qsort(springs->merged, springs->n_merged, sizeof *springs->merged, cloth_by_u64);
    return CLOTH_OK;
}

int flow_springs_merge(struct flow_springs *springs, struct cloth_error *error)
{
    struct finder finder = {.welds = springs->welds, .error = error};
    if (!springs->welds->n)
        return CLOTH_OK;
    flow_springs_each(springs, welds_find_joined, &finder);
    int code = finder.code;
    cloth_list_sort(&finder.found, sizeof(struct candidate), compare_candidates);
    if (!code && finder.found.n)
        code = merge(springs, &finder.found, error);
    free(finder.found.items);
    return code;
}
