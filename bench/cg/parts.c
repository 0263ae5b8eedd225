/* A part is made in four passes over the springs of the whole state: simple, and not timed. */
#include "bench/cg/parts.h"

#include <stdlib.h>
#include <string.h>

struct maker {
    const struct state *state;
    struct parts *parts;
    uint32_t *place;             /* of each vertex */
    uint32_t *part_of, *halo_of; /* by place; halo_of: number in the halo of its part, plus one */
};

/* One side of a spring, seen from a part. */
struct side {
    uint32_t other, here, there; /* other: part of the far end; rows, `there` in `other` */
    uint32_t spring;
};

static int compare(const void *va, const void *vb)
{
    const struct side *a = va, *b = vb;
    if (a->other != b->other)
        return a->other < b->other ? -1 : 1;
    if (a->here != b->here)
        return a->here < b->here ? -1 : 1;
    if (a->there != b->there)
        return a->there < b->there ? -1 : 1;
    return (a->spring > b->spring) - (a->spring < b->spring);
}

/* By there: ghosts of one part are ascending and each once. */
static int compare_there(const void *va, const void *vb)
{
    const struct side *a = va, *b = vb;
    return (a->there > b->there) - (a->there < b->there);
}

/* The sides of a part's springs: the inner ones first, then those into each other part. */
static struct side *find_sides(const struct maker *m, uint32_t p, uint32_t *n_inner, size_t *n)
{
    const struct solve_system *s = &m->state->system;
    struct side *side = malloc((s->n_pairs + 1) * sizeof *side);
    size_t count = 0;
    for (size_t i = 0; i < s->n_pairs && side; i++) {
        uint32_t a = m->place[s->end[i][0]], b = m->place[s->end[i][1]];
        if (m->part_of[b] == p && (m->part_of[a] != p || b < a)) {
            const uint32_t swap = a;
            a = b;
            b = swap;
        }
        const uint32_t other = m->part_of[b];
        if (m->part_of[a] == p)
            side[count++] = (struct side){other == p ? 0 : other + 1, a - m->parts->start[p],
                                          b - m->parts->start[other], (uint32_t)i};
    }
    if (!side)
        return NULL;
    qsort(side, count, sizeof *side, compare);
    *n = count;
    for (*n_inner = 0; *n_inner < count && !side[*n_inner].other; ++*n_inner)
        ;
    return side;
}

static phys_vec *vectors(size_t n)
{
    phys_vec *rows = aligned_alloc(64, ((n + 3) & ~(size_t)1) * sizeof *rows);
    if (rows)
        memset(rows, 0, ((n + 3) & ~(size_t)1) * sizeof *rows);
    return rows;
}

static int allocate(struct part *part, uint32_t n, uint32_t n_inner, size_t n_sides,
                    uint32_t n_parts)
{
    const size_t cut = n_sides - n_inner;
    const size_t bytes[] = {(n + (size_t)1) * 8,       (n + (size_t)1) * 8, (n + (size_t)1) * 4,
                            (n_inner + (size_t)1) * 4, (cut + 1) * 8,       (n + (size_t)1) * 4,
                            (n_parts + (size_t)1) * 4, (cut + 1) * 4};
    int has = 1;
    for (int i = 0; i < 8; i++)
        has = (part->owned[i] = calloc(bytes[i], 1)) && has;
    phys_vec **rows[] = {&part->rows.dv, &part->rows.r, &part->rows.p, &part->rows.q, &part->b};
    for (int i = 0; i < 5; i++)
        has = (*rows[i] = vectors(n)) && has;
    part->rows.z = part->rows.r;
    part->rows.s = part->rows.q;
    has = (part->value = vectors(n_sides)) && has;
    has = (part->ghost_r = vectors(cut)) && has;
    has = (part->ghost_p = vectors(cut)) && has;
    for (int i = 0; i < 2; i++)
        has = (part->halo[i] = calloc(3 * (size_t)n + 1, sizeof(double))) && has;
    part->ghosts = part->owned[6];
    part->at = part->owned[7];
    return has ? 0 : serve_no_memory();
}

static void fill_rows(const struct maker *m, struct part *part, uint32_t n)
{
    const struct solve_system *s = &m->state->system;
    double *diagonal = part->owned[0], *free = part->owned[1];
    uint32_t *halo = part->owned[5];
    for (uint32_t i = 0; i < n; i++) {
        const size_t v = m->state->order[part->first + i];
        diagonal[i] = s->diagonal[v];
        free[i] = s->free[v];
        part->b[i] = (phys_vec){s->b[3 * v], s->b[3 * v + 1], s->b[3 * v + 2], 0};
        if (m->halo_of[part->first + i])
            halo[part->cut.n_halo++] = i;
    }
    part->cut.halo = halo;
}

/* `side` is sorted: inner springs by rows, cut ones by part. */
static void fill_springs(const struct maker *m, struct part *part, uint32_t n,
                         const struct side *side, uint32_t n_inner, size_t n_sides)
{
    const struct solve_system *s = &m->state->system;
    uint32_t *row = part->owned[2], *column = part->owned[3], (*end)[2] = part->owned[4];
    uint32_t span = 0;
    for (uint32_t i = 0; i < n_inner; i++) {
        const uint32_t length = side[i].there - side[i].here;
        row[side[i].here + 1]++;
        column[i] = side[i].there;
        span = span > length ? span : length;
    }
    for (uint32_t a = 0; a < n; a++)
        row[a + 1] += row[a];
    for (size_t i = 0; i < n_sides; i++) {
        const double *w = s->value[side[i].spring];
        part->value[i] = (phys_vec){w[0], w[1], w[2], w[3]};
    }
    for (size_t i = n_inner; i < n_sides; i++)
        end[i - n_inner][0] = side[i].here;
    part->matrix = (struct solve_block){.n = n,
                                        .diagonal = part->owned[0],
                                        .free = part->owned[1],
                                        .row = row,
                                        .column = column,
                                        .span = span,
                                        .format = SOLVE_SPRINGS};
    part->cut.n = n_sides - n_inner;
    part->cut.end = (const uint32_t(*)[2])end;
}

/* The ghosts of each other part: the rows that cut springs end at, each once. */
static int fill_ghosts(const struct maker *m, struct part *part, const struct side *side, size_t n)
{
    uint32_t(*end)[2] = part->owned[4];
    struct side *sorted = malloc((n + 1) * sizeof *sorted);
    if (!sorted)
        return serve_no_memory();
    for (size_t i = 0; i < n; i++) {
        sorted[i] = side[i];
        sorted[i].spring = (uint32_t)i;
    }
    size_t from = 0;
    for (uint32_t p = 0; p < m->parts->n; p++) {
        size_t to = from;
        part->ghosts[p] = part->n_ghosts;
        while (to < n && sorted[to].other == p + 1)
            to++;
        qsort(sorted + from, to - from, sizeof *sorted, compare_there);
        for (size_t i = from; i < to; i++) {
            if (i == from || sorted[i].there != sorted[i - 1].there)
                part->at[part->n_ghosts++] = m->halo_of[m->parts->start[p] + sorted[i].there] - 1;
            end[sorted[i].spring][1] = part->n_ghosts - 1;
        }
        from = to;
    }
    part->ghosts[m->parts->n] = part->n_ghosts;
    free(sorted);
    return 0;
}

static int make_part(const struct maker *m, uint32_t p)
{
    struct part *part = m->parts->part + p;
    const uint32_t n = m->parts->start[p + 1] - m->parts->start[p];
    uint32_t n_inner = 0;
    size_t n_sides = 0;
    struct side *side = find_sides(m, p, &n_inner, &n_sides);
    part->first = m->parts->start[p];
    int code = side ? allocate(part, n, n_inner, n_sides, m->parts->n) : serve_no_memory();
    if (!code) {
        fill_rows(m, part, n);
        fill_springs(m, part, n, side, n_inner, n_sides);
        code = fill_ghosts(m, part, side + n_inner, n_sides - n_inner);
    }
    free(side);
    return code;
}

/* Numbers the rows that springs cross the border at. */
static void number_halos(const struct maker *m)
{
    const struct solve_system *s = &m->state->system;
    for (size_t i = 0; i < s->n_pairs; i++) {
        const uint32_t a = m->place[s->end[i][0]], b = m->place[s->end[i][1]];
        if (m->part_of[a] != m->part_of[b])
            m->halo_of[a] = m->halo_of[b] = 1;
    }
    for (uint32_t p = 0; p < m->parts->n; p++) {
        uint32_t count = 0;
        for (uint32_t i = m->parts->start[p]; i < m->parts->start[p + 1]; i++)
            if (m->halo_of[i])
                m->halo_of[i] = ++count;
    }
}

static int cut(const struct maker *m)
{
    const uint32_t n = m->state->system.n;
    struct parts *parts = m->parts;
    for (uint32_t p = 0; p <= parts->n; p++)
        parts->start[p] = (uint32_t)((uint64_t)n * p / parts->n);
    for (uint32_t p = 0; p < parts->n; p++)
        for (uint32_t i = parts->start[p]; i < parts->start[p + 1]; i++)
            m->part_of[i] = p;
    for (uint32_t i = 0; i < n; i++)
        m->place[m->state->order[i]] = i;
    number_halos(m);
    int code = 0;
    for (uint32_t p = 0; p < parts->n && !code; p++)
        code = make_part(m, p);
    return code;
}

int parts_make(struct parts *parts, const struct state *state, uint32_t size, uint32_t least)
{
    const uint32_t n = state->system.n;
    const uint32_t wanted = size ? (n + size - 1) / size : least;
    struct maker m = {.state = state, .parts = parts};
    parts->n = wanted > least ? wanted : least;
    parts->part = calloc(parts->n, sizeof *parts->part);
    parts->start = calloc((size_t)parts->n + 1, sizeof *parts->start);
    m.place = calloc((size_t)n + 1, sizeof *m.place);
    m.part_of = calloc((size_t)n + 1, sizeof *m.part_of);
    m.halo_of = calloc((size_t)n + 1, sizeof *m.halo_of);
    const int has = parts->part && parts->start && m.place && m.part_of && m.halo_of;
    const int code = has ? cut(&m) : serve_no_memory();
    free(m.place);
    free(m.part_of);
    free(m.halo_of);
    return code;
}

void parts_free(struct parts *parts)
{
    for (uint32_t p = 0; parts->part && p < parts->n; p++) {
        struct part *part = parts->part + p;
        void *all[] = {part->rows.dv, part->rows.r,  part->rows.p,  part->rows.q,  part->b,
                       part->value,   part->ghost_r, part->ghost_p, part->halo[0], part->halo[1]};
        for (size_t i = 0; i < sizeof all / sizeof *all; i++)
            free(all[i]);
        for (int i = 0; i < 8; i++)
            free(part->owned[i]);
    }
    free(parts->part);
    free(parts->start);
    *parts = (struct parts){0};
}

void parts_answer(const struct parts *parts, const struct state *state, double *dv)
{
    for (uint32_t p = 0; p < parts->n; p++)
        for (uint32_t i = parts->start[p]; i < parts->start[p + 1]; i++)
            for (size_t c = 0; c < 3; c++)
                dv[3 * (size_t)state->order[i] + c] =
                    parts->part[p].rows.dv[i - parts->start[p]][c];
}
