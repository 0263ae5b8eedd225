/* Tables are those of the cloth; vectors are by place, so a block's are a part of each array. */
#include "bench/ranks/sheet.h"

#include "bench/serve.h"
#include "cloth/physics/particle.h"
#include "tests/support/rank.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct flow_tables *sheet_tables(const struct sheet *sheet)
{
    return &sheet->tables;
}

size_t sheet_row(const struct sheet *sheet, uint32_t block)
{
    return sheet_tables(sheet)->block[block].first;
}

size_t sheet_halo(const struct sheet *sheet, uint32_t block)
{
    return 3 * sheet->halo_start[block];
}

/* ---- Making ---- */

/* cloth/scenes/sheet.yaml, of any size. */
void sheet_model(struct sheet *sheet, uint32_t side, uint32_t grain)
{
    static const double corner[3][3] = {{-0.5, 0, -0.5}, {0.5, 0, -0.5}, {0, 0, 0.5}};
    sheet->side = side;
    sheet->material = (struct model_material){
        .density = 0.2, .stretch = 5000, .shear = 2500, .damping_stiffness = 0.015};
    sheet->cloth.pins = sheet->pin;
    sheet->cloth.n_pins = 3;
    for (int i = 0; i < 3; i++) {
        sheet->pin[i].pick.kind = MODEL_PICK_NEAREST;
        memcpy(sheet->pin[i].pick.point, corner[i], sizeof corner[i]);
    }
    sheet->model = (struct model){.n_materials = 1,
                                  .n_cloths = 1,
                                  .materials = &sheet->material,
                                  .cloths = &sheet->cloth,
                                  .gravity = {0, -9.81, 0},
                                  .h = 0.001,
                                  .end = 0.001,
                                  .fps = 1,
                                  .integrator = MODEL_IMPLICIT_EULER,
                                  .stop = MODEL_STOP_COUNT,
                                  .max_iterations = 2,
                                  .grain = grain};
}

int sheet_own_rank(void)
{
    const char *rank = rank_said();
    return rank ? atoi(rank) : 0;
}

int sheet_flow(struct sheet *sheet)
{
    struct cloth_error error = {0};
    flow_free(sheet->flow);
    sheet->flow = NULL;
    const int code = sheet_own_rank() ? flow_join(&sheet->flow, &error)
                                      : flow_prepare(&sheet->flow, &sheet->model, 1, &error);
    return code ? serve_fail("%s", error.text) : 0;
}

void sheet_wave(const struct flow_table *t, void *memory)
{
    const struct flow_layout table = flow_table_layout(t, memory);
    for (uint32_t i = 0; i < t->n; i++) {
        const double x = table.position[i][0], z = table.position[i][2];
        table.position[i][1] += 0.01 * sin(9 * x) * cos(7 * z);
        table.velocity[i] =
            table.free[i] * (phys_vec){0.1 * sin(5 * z), 0.2 * cos(6 * x), 0.1 * x, 0};
    }
}

static int wave(const duite_call *call)
{
    const struct flow *flow = call->context;
    const struct flow_block_args *args = call->args;
    sheet_wave(flow->tables.block + args->block, duite_out(call, 0, char));
    return 0;
}
const duite_kernel sheet_wave_kernel = {.name = "sheet_wave",
                                        .body = wave,
                                        .access = {DUITE_RW},
                                        .args_size = sizeof(struct flow_block_args)};

static size_t n_halo(const struct sheet *s)
{
    return s->halo_start[s->tables.n_blocks];
}

/* The tables of all blocks, waved, and where the parts of each begin in the arrays of all. */
static int make_tables(struct sheet *s, struct cloth_error *error)
{
    const uint32_t n = s->source.blocks.n_blocks;
    struct flow_tables *all = &s->tables;
    *all = (struct flow_tables){.n_blocks = n,
                                .block = calloc(n, sizeof *all->block),
                                .neighbour = s->source.neighbours.neighbour,
                                .ghost = s->source.neighbours.ghost};
    s->memory = calloc(n, sizeof *s->memory);
    s->halo_start = calloc((size_t)n + 1, sizeof *s->halo_start);
    s->value_start = calloc((size_t)n + 1, sizeof *s->value_start);
    if (!all->block || !s->memory || !s->halo_start || !s->value_start)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for tables");
    const int code = flow_source_gather(&s->source, 0, n, error);
    for (uint32_t b = 0; b < n && !code; b++) {
        struct flow_table *t = all->block + b;
        *t = s->source.shape[b];
        s->halo_start[b + 1] = s->halo_start[b] + t->n_halo;
        s->value_start[b + 1] = s->value_start[b] + t->n_inner + t->n_cut;
        s->memory[b] = aligned_alloc(64, flow_table_bytes(t));
        if (!s->memory[b])
            return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a table");
        flow_source_table(&s->source, b, s->memory[b]);
        sheet_wave(t, s->memory[b]);
        flow_table_open(t, s->memory[b]);
        t->matrix.diagonal = t->mass; /* there is no drag */
    }
    return code;
}

static phys_vec *vectors(size_t n)
{
    phys_vec *rows = aligned_alloc(64, ((n + 2) & ~(size_t)1) * sizeof *rows);
    if (rows)
        memset(rows, 0, n * sizeof *rows);
    return rows;
}

static int allocate(struct sheet *s)
{
    const size_t rows = s->source.blocks.n_places, ghosts = s->source.neighbours.n_ghosts;
    phys_vec **array[] = {&s->b, &s->dv, &s->r, &s->p, &s->q, &s->answer};
    bool has = true;
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        has = (*array[i] = vectors(rows)) && has;
    has = (s->value = vectors(s->value_start[s->tables.n_blocks])) && has;
    has = (s->ghost_r = vectors(ghosts)) && has;
    has = (s->ghost_p = vectors(ghosts)) && has;
    for (int i = 0; i < 2; i++)
        has = (s->halo[i] = calloc(3 * n_halo(s) + 1, sizeof(double))) && has;
    return has ? 0 : serve_no_memory();
}

void sheet_free(struct sheet *s)
{
    phys_vec *array[] = {s->b,      s->dv,    s->r,       s->p,      s->q,
                         s->answer, s->value, s->ghost_r, s->ghost_p};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        free(array[i]);
    free(s->halo[0]);
    free(s->halo[1]);
    free(s->halo_start);
    free(s->value_start);
    for (uint32_t b = 0; s->memory && b < s->tables.n_blocks; b++)
        free(s->memory[b]);
    free(s->memory);
    free(s->tables.block);
    flow_source_free(&s->source);
    flow_free(s->flow);
    mesh_free(&s->cloth.mesh);
    *s = (struct sheet){0};
}

/* b and the matrix of a block, as the body of flow_system makes them; x and v of the
 * halos are in place of their objects. */
static void make_block(struct sheet *s, const struct flow_table *t, const phys_vec *halo_x,
                       const phys_vec *halo_v)
{
    const struct flow_tables *all = sheet_tables(s);
    const double h = s->model.h;
    const phys_vec *x = t->position, *v = t->velocity;
    phys_vec *b = s->b + t->first, *value = s->value + s->value_start[t - all->block];
    struct phys_springs springs = flow_table_inner(t);
    phys_outside(t->n, t->load, t->drag, v, b);
    for (uint32_t i = 0; i < t->n; i++)
        b[i] = h * b[i];
    phys_springs_system(&springs, h, h, x, v, NULL, NULL, b, value);
    for (uint32_t i = 0; i < t->n_neighbours; i++) {
        const size_t at = s->halo_start[t->neighbour[i]];
        springs = flow_table_cut(t, i);
        phys_springs_system(&springs, h, h, x, v, halo_x + at, halo_v + at, b,
                            value + t->n_inner + t->cut[i]);
    }
}

static int make_system(struct sheet *s)
{
    const struct flow_tables *all = sheet_tables(s);
    phys_vec *halo_x = vectors(n_halo(s)), *halo_v = vectors(n_halo(s));
    for (uint32_t b = 0; b < all->n_blocks && halo_x && halo_v; b++) {
        const struct flow_table *t = all->block + b;
        for (uint32_t i = 0; i < t->n_halo; i++) {
            halo_x[s->halo_start[b] + i] = t->position[t->halo[i]];
            halo_v[s->halo_start[b] + i] = t->velocity[t->halo[i]];
        }
    }
    const bool has = halo_x && halo_v;
    for (uint32_t b = 0; b < all->n_blocks && has; b++)
        make_block(s, all->block + b, halo_x, halo_v);
    free(halo_x);
    free(halo_v);
    return has ? 0 : serve_no_memory();
}

int sheet_ready(struct sheet *sheet, uint32_t side, uint32_t grain)
{
    struct cloth_error error = {0};
    if (sheet->answer && sheet->side == side && sheet->model.grain == grain)
        return 0;
    sheet_free(sheet);
    sheet_model(sheet, side, grain);
    if (mesh_grid(&sheet->cloth.mesh, 1, 1, side, side, MESH_SAME, &error) ||
        flow_source_make(&sheet->source, &sheet->model, 1, &error) || make_tables(sheet, &error))
        return serve_fail("%s", error.text);
    const int code = allocate(sheet);
    return code ? code : make_system(sheet);
}

/* ---- Solving ---- */

void sheet_start(struct sheet *s, uint32_t block)
{
    const struct flow_table *t = sheet_tables(s)->block + block;
    const size_t first = t->first, ghosts = (size_t)(t->ghost - sheet_tables(s)->ghost);
    solve_start(t->n, t->free, s->b + first, s->dv + first, s->r + first, s->p + first,
                s->q + first);
    memset(s->ghost_r + ghosts, 0, t->n_ghosts * sizeof *s->ghost_r);
    memset(s->ghost_p + ghosts, 0, t->n_ghosts * sizeof *s->ghost_p);
    solve_pack(t->n_halo, t->halo, s->q + first, s->halo[0] + sheet_halo(s, block));
}

void sheet_pass(struct sheet *s, uint32_t block, const struct solve_scalars *scalars, int from,
                double dots[SOLVE_DOTS])
{
    const struct flow_tables *all = sheet_tables(s);
    const struct flow_table *t = all->block + block;
    const size_t first = t->first, ghosts = (size_t)(t->ghost - all->ghost);
    const phys_vec *value = s->value + s->value_start[block];
    const struct solve_cut cut = flow_table_cut_entries(t);
    const struct solve_rows rows =
        solve_rows_plain(s->dv + first, s->r + first, s->p + first, s->q + first);
    if (scalars->phase == SOLVE_LAST)
        dots[SOLVE_RR] = solve_finish(t->n, scalars->alpha, rows.q, rows.p, rows.dv, rows.r);
    if (scalars->phase != SOLVE_ON)
        return;
    for (uint32_t i = 0; i < t->n_neighbours; i++)
        solve_advance_ghosts(t->ghost_start[i + 1] - t->ghost_start[i], scalars->alpha,
                             scalars->beta, s->halo[from] + sheet_halo(s, t->neighbour[i]),
                             t->ghost + t->ghost_start[i], s->ghost_r + ghosts + t->ghost_start[i],
                             s->ghost_p + ghosts + t->ghost_start[i]);
    solve_pass(&t->matrix, &cut, value, s->ghost_p + ghosts, scalars->alpha, scalars->beta, &rows,
               dots);
    solve_pack(t->n_halo, t->halo, rows.q, s->halo[1 - from] + sheet_halo(s, block));
}

/* The runtime's tree over the sums of tasks first .. first + n - 1 (runtime/data/subtrees.h), left
 * in sum[first]. */
static void add_tree(double (*sum)[SOLVE_DOTS], size_t first, size_t n)
{
    size_t left = 1;
    while (2 * left < n)
        left *= 2;
    if (n < 2)
        return;
    add_tree(sum, first, left);
    add_tree(sum, first + left, n - left);
    for (int i = 0; i < SOLVE_DOTS; i++)
        sum[first][i] += sum[first + left][i];
}

int sheet_solve(struct sheet *s, uint32_t count)
{
    const uint32_t n = sheet_tables(s)->n_blocks;
    const struct solve_stop stop = {.count = true, .max = count};
    struct solve_scalars scalars = solve_scalars_start(0, SOLVE_ON);
    if (s->answered == count)
        return 0;
    double(*sum)[SOLVE_DOTS] = malloc(n * sizeof *sum);
    int code = sum ? 0 : serve_no_memory();
    for (uint32_t b = 0; b < n && !code; b++)
        sheet_start(s, b);
    for (int from = 0; scalars.phase != SOLVE_DONE && !code; from = 1 - from) {
        const struct solve_scalars now = scalars;
        memset(sum, 0, n * sizeof *sum);
        for (uint32_t i = 0; i < n; i++)
            sheet_pass(s, sheet_order(n, i, from), &now, from, sum[i]);
        add_tree(sum, 0, n);
        if (solve_scalars_next(&stop, sum[0], &now, &scalars))
            code = serve_fail("the solve breaks down");
    }
    free(sum);
    memcpy(s->answer, s->dv, s->source.blocks.n_places * sizeof *s->dv);
    s->square = scalars.square;
    s->answered = count;
    return code;
}
