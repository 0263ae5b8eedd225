/* A system that somebody saved (duite-cloth --save-system), solved again. It becomes a state, so
 * that everybody finds it; for ours, a model has a spring for each of its pairs, and what a step
 * makes of that is replaced by the system's own numbers. */
#include "bench/cg/cg.h"

#include "bench/tasks/tasks.h"
#include "cloth/flow/bodies.h"
#include "cloth/output/output.h"
#include "cloth/solve/assemble.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GRAIN = 1000, QUICK_GRAIN = 40 };

int cg_system_make(const char *folder, bool quick, char *text, size_t size)
{
    struct state state = {.name = CG_SYSTEM};
    struct cloth_error error = {0};
    double *told = NULL;
    int code = output_system_read(folder, &state.system, &error) ? serve_fail("%s", error.text) : 0;
    const struct solve_system *s = &state.system;
    if (!code)
        told = calloc((size_t)s->n + 1, 3 * sizeof *told);
    state.after = calloc((size_t)s->n + 1, 3 * sizeof *state.after);
    if (!code && (!told || !state.after))
        code = serve_no_memory();
    if (!code) {
        memcpy(told, s->dv, 3 * (size_t)s->n * sizeof *told);
        code = cg_order(&state, quick ? QUICK_GRAIN : GRAIN);
    }
    if (!code)
        code = state_solve(s, s->dv);
    if (!code) {
        state.hash = cg_hash(s);
        snprintf(text, size,
                 "%016" PRIx64 ", %u vertices, %zu pairs; the solution beside it is %.3g off",
                 state.hash, s->n, s->n_pairs, state_distance(&state, told, s->dv));
        code = state_write(&state);
    }
    free(told);
    state_free(&state);
    return code;
}

/* ---- Ours ---- */

static int make_cloth(struct model_cloth *cloth, const struct solve_system *s)
{
    struct cloth_error error = {0};
    cloth->name = strdup(CG_SYSTEM);
    cloth->mass_per_vertex = 1;
    cloth->n_pins = 1;
    cloth->pins = calloc(1, sizeof *cloth->pins);
    uint32_t *held = malloc(sizeof *held);
    if (!cloth->name || !cloth->pins || !held) {
        free(held);
        return serve_no_memory();
    }
    *held = s->n - 1;
    cloth->pins->pick.kind = MODEL_PICK_VERTICES;
    cloth->pins->pick.n_vertices = 1;
    cloth->pins->pick.vertices = held;
    return mesh_inline(&cloth->mesh, s->n, s->x, (uint32_t)s->n_pairs, *s->end, 0, NULL, &error)
               ? serve_fail("%s", error.text)
               : 0;
}

int cg_system_plan(struct states_plan *plan, const struct solve_system *s, bool quick)
{
    *plan = (struct states_plan){0};
    struct model *model = &plan->model;
    model->h = model->end = 0.001;
    model->fps = 1;
    model->integrator = MODEL_IMPLICIT_EULER;
    model->stop = MODEL_STOP_MASS_NORM;
    model->tolerance = 0.01;
    model->max_iterations = 10000;
    model->preconditioner = MODEL_IC0_COARSE;
    model->format = SOLVE_HALF;
    model->grain = quick ? QUICK_GRAIN : GRAIN;
    model->materials = calloc(1, sizeof *model->materials);
    model->cloths = calloc(1, sizeof *model->cloths);
    if (!model->materials || !model->cloths)
        return serve_no_memory();
    model->n_materials = model->n_cloths = 1;
    model->materials->ea = 1;
    return make_cloth(model->cloths, s);
}

/* What the numbers go into: tables of all blocks, opened. */
struct room {
    struct flow_table *table;
    void **image;
    struct phys_pair *sums;
    double *values, *rows; /* of the largest block; values: as the object has them */
};

static void room_free(struct room *room, uint32_t n)
{
    for (uint32_t b = 0; room->image && b < n; b++)
        free(room->image[b]);
    free(room->image);
    free(room->table);
    free(room->values);
    free(room->sums);
    free(room->rows);
}

static int open_table(const struct cg_session *s, uint32_t b, struct room *room)
{
    struct flow_table *t = room->table + b;
    *t = s->flow->tables.block[b];
    room->image[b] = aligned_alloc(64, (flow_table_bytes(t) + 63) / 64 * 64);
    if (!room->image[b])
        return serve_no_memory();
    const int code = tasks_code(duite_get(s->rt, s->run.block[b].table, room->image[b]));
    if (!code)
        flow_table_open(t, room->image[b]);
    return code;
}

static int room_make(const struct cg_session *s, struct room *room)
{
    const uint32_t n = s->flow->tables.n_blocks;
    size_t values = 1, rows = 1, entries = 1;
    for (uint32_t b = 0; b < n; b++) {
        const struct flow_table *t = s->flow->tables.block + b;
        const size_t doubles = 4 * flow_diagonal_rows(t) + flow_table_doubles(t);
        const size_t all = (size_t)t->n_entries + t->n_cut_entries;
        values = doubles > values ? doubles : values;
        entries = all > entries ? all : entries;
        rows = t->n > rows ? t->n : rows;
    }
    room->table = calloc(n, sizeof *room->table);
    room->image = calloc(n, sizeof *room->image);
    room->values = aligned_alloc(32, (values + 3) / 4 * 4 * sizeof(double));
    room->sums = aligned_alloc(32, entries * sizeof *room->sums);
    room->rows = calloc(rows, 4 * sizeof *room->rows);
    if (!room->table || !room->image || !room->values || !room->sums || !room->rows)
        return serve_no_memory();
    int code = 0;
    for (uint32_t b = 0; b < n && !code; b++)
        code = open_table(s, b, room);
    return code;
}

/* Adds N of the pair of two vertices, if the system has it; the model has no other. */
static void add_pair(const struct solve_system *s, uint32_t a, uint32_t b, struct phys_pair *sum)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    size_t from = 0, to = s->n_pairs;
    double n[3][3];
    while (to - from > 1) {
        const size_t middle = from + (to - from) / 2;
        const uint32_t *end = s->end[middle];
        if (end[0] < low || (end[0] == low && end[1] <= high))
            from = middle;
        else
            to = middle;
    }
    solve_system_pair(s, from, n);
    solve_assemble(sum, a > b, (const double(*)[3])n);
}

static void assemble(const struct cg_session *s, const struct room *room, uint32_t b)
{
    const struct flow_table *t = room->table + b;
    const struct solve_system *y = &s->state.system;
    const size_t inner = t->matrix.row[t->n];
    const struct solve_cut cut = flow_table_cut_entries(t);
    memset(room->sums, 0, (inner + cut.n) * sizeof *room->sums);
    for (uint32_t a = 0; a < t->n; a++)
        for (size_t i = t->matrix.row[a]; i < t->matrix.row[a + 1]; i++)
            add_pair(y, t->vertex[a], t->vertex[t->matrix.column[i]], room->sums + i);
    for (uint32_t k = 0; k < t->n_slots; k++)
        for (size_t i = t->cut_entry[k]; i < t->cut_entry[k + 1]; i++) {
            const struct flow_table *other = room->table + t->slot[k];
            const uint32_t row = other->rim[t->copy[cut.end[i][1]]];
            add_pair(y, t->vertex[cut.end[i][0]], other->vertex[row], room->sums + inner + i);
        }
    solve_assembled(&t->matrix, &cut, room->sums, room->values + 4 * flow_diagonal_rows(t));
}

static int put_block(const struct cg_session *s, const struct room *room, uint32_t b)
{
    const struct flow_table *t = room->table + b;
    const struct flow_objects *o = s->run.block + b;
    const struct solve_system *y = &s->state.system;
    memset(room->values, 0, 4 * flow_diagonal_rows(t) * sizeof *room->values);
    assemble(s, room, b);
    for (uint32_t i = 0; i < t->n; i++) {
        const size_t v = t->vertex[i];
        room->values[i] = y->free[v] > 0 ? y->diagonal[v] : 1;
        for (size_t c = 0; c < 3; c++)
            room->rows[4 * (size_t)i + c] = y->b[3 * v + c];
        room->rows[4 * (size_t)i + 3] = 0;
    }
    const int code = tasks_code(duite_set(s->rt, o->a, room->values));
    return code ? code : tasks_code(duite_set(s->rt, o->f, room->rows));
}

int cg_system_put(const struct cg_session *s)
{
    struct room room = {0};
    int code = room_make(s, &room);
    for (uint32_t b = 0; b < s->flow->tables.n_blocks && !code; b++)
        code = put_block(s, &room, b);
    room_free(&room, s->flow->tables.n_blocks);
    return code ? code : tasks_code(duite_wait(s->rt));
}
