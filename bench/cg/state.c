/* A file is a head and the arrays as they lie in memory: it stays on the machine that made it. */
#include "bench/cg/state.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char MAGIC[8] = "state 1";

struct head {
    char magic[8], name[40];
    uint64_t hash, n_pairs;
    double h;
    uint32_t n, count;
};

/* The arrays of a state, in the order of the file. */
enum { ARRAYS = 11 };
struct array {
    void *at;
    size_t bytes;
};

static void list_arrays(const struct state *s, struct array array[ARRAYS])
{
    const size_t n = s->system.n, springs = s->system.n_pairs;
    const struct solve_system *y = &s->system;
    const struct array all[ARRAYS] = {
        {y->mass, n * sizeof(double)},          {y->diagonal, n * sizeof(double)},
        {y->free, n * sizeof(double)},          {y->b, 3 * n * sizeof(double)},
        {y->dv, 3 * n * sizeof(double)},        {y->x, 3 * n * sizeof(double)},
        {y->v, 3 * n * sizeof(double)},         {y->end, springs * sizeof *y->end},
        {y->value, springs * sizeof *y->value}, {s->after, 3 * n * sizeof(double)},
        {s->order, n * sizeof *s->order}};
    memcpy(array, all, sizeof all);
}

void state_free(struct state *state)
{
    solve_system_free(&state->system);
    free(state->after);
    free(state->order);
    *state = (struct state){0};
}

static void path_of(const char *name, const char *ending, char *path, size_t size)
{
    const char *folder = getenv(STATE_FOLDER);
    snprintf(path, size, "%s/%s.state%s", folder ? folder : ".", name, ending);
}

static int read_arrays(struct state *state, const struct head *head, FILE *file)
{
    struct array array[ARRAYS];
    if (solve_system_make(&state->system, head->n, head->n_pairs, SOLVE_PAIRS_OF_SPRINGS, NULL))
        return serve_no_memory();
    state->system.h = head->h;
    state->after = malloc(((size_t)head->n + 1) * 3 * sizeof *state->after);
    state->order = malloc(((size_t)head->n + 1) * sizeof *state->order);
    if (!state->after || !state->order)
        return serve_no_memory();
    list_arrays(state, array);
    for (int i = 0; i < ARRAYS; i++)
        if (fread(array[i].at, 1, array[i].bytes, file) != array[i].bytes)
            return serve_fail("the state %s is cut short", head->name);
    return 0;
}

double state_step(const char *name)
{
    const char *told = strstr(name, "_h");
    return told && isdigit((unsigned char)told[2]) ? strtod(told + 2, NULL) : 0;
}

static int check_step(const char *name, const char *path, double h)
{
    const double ms = state_step(name);
    return !(ms > 0) || fabs(1e3 * h - ms) <= 1e-9 * ms
               ? 0
               : serve_fail("%s has the system of a step of %g ms, not of one of %g ms", path,
                            1e3 * h, ms);
}

int state_read(struct state *state, const char *name)
{
    char path[4200];
    struct head head;
    path_of(name, "", path, sizeof path);
    FILE *file = fopen(path, "rb");
    if (!file)
        return serve_fail("there is no state %s", path);
    *state = (struct state){0};
    int code = fread(&head, sizeof head, 1, file) != 1 || memcmp(head.magic, MAGIC, sizeof MAGIC)
                   ? serve_fail("%s is not a state of this version", path)
                   : check_step(name, path, head.h);
    if (!code)
        code = read_arrays(state, &head, file);
    fclose(file);
    if (code) {
        state_free(state);
        return code;
    }
    snprintf(state->name, sizeof state->name, "%s", name);
    state->hash = head.hash;
    state->count = head.count;
    return 0;
}

int state_write(const struct state *state)
{
    char path[4200], part[4200];
    struct array array[ARRAYS];
    struct head head = {.hash = state->hash,
                        .n_pairs = state->system.n_pairs,
                        .h = state->system.h,
                        .n = state->system.n,
                        .count = state->count};
    memcpy(head.magic, MAGIC, sizeof MAGIC);
    memcpy(head.name, state->name, sizeof head.name);
    path_of(state->name, "", path, sizeof path);
    path_of(state->name, ".part", part, sizeof part);
    list_arrays(state, array);
    FILE *file = fopen(part, "wb");
    bool bad = !file || fwrite(&head, sizeof head, 1, file) != 1;
    for (int i = 0; i < ARRAYS && !bad; i++)
        bad = fwrite(array[i].at, 1, array[i].bytes, file) != array[i].bytes;
    if (file && fclose(file))
        bad = true;
    if (!bad && !rename(part, path))
        return 0;
    unlink(part);
    return serve_fail("%s cannot be written", path);
}

int state_ready(struct state *state, struct serve_request *request)
{
    char name[sizeof state->name];
    serve_word(request, "state", name, sizeof name);
    if (*name && !strcmp(name, state->name))
        return 0;
    state_free(state);
    return state_read(state, name);
}

/* ---- Answers ---- */

double state_distance(const struct state *state, const double *a, const double *b)
{
    double wrong = 0, all = 0;
    for (size_t v = 0; v < state->system.n; v++)
        for (size_t c = 0; c < 3; c++) {
            const double m = state->system.free[v] * state->system.mass[v];
            const double d = a[3 * v + c] - b[3 * v + c];
            wrong += m * d * d;
            all += m * b[3 * v + c] * b[3 * v + c];
        }
    return sqrt(wrong / all);
}

int state_check(const struct state *state, uint32_t count, const double *dv)
{
    if (count != state->count)
        return serve_fail("%s has the answer of %u iterations, not %u", state->name, state->count,
                          count);
    const double wrong = state_distance(state, dv, state->after);
    return wrong <= 1e-6 ? 0 : serve_fail("wrong answer: %g off after %u iterations", wrong, count);
}

double state_bytes(const struct state *state)
{
    return (8 * 24 + 2 * 8) * (double)state->system.n + (4 * 8 + 4) * (double)state->system.n_pairs;
}

/* ---- Conjugate gradients ---- */

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* r = S (b - A dv); returns r.r. */
static double residual(const struct solve_system *s, const double *dv, double *r)
{
    const size_t n = 3 * (size_t)s->n;
    solve_system_multiply(s, dv, r);
    for (size_t i = 0; i < n; i++)
        r[i] = s->free[i / 3] * s->b[i] - r[i];
    return dot(n, r, r);
}

struct room {
    double *r, *z, *p, *q;
    double (*inverse)[9]; /* of 3x3 blocks; NULL: no preconditioner */
};

static void precondition(const struct solve_system *s, const struct room *room)
{
    for (size_t v = 0; v < s->n; v++) {
        const double *r = room->r + 3 * v;
        for (size_t i = 0; i < 3; i++)
            room->z[3 * v + i] = room->inverse ? room->inverse[v][3 * i] * r[0] +
                                                     room->inverse[v][3 * i + 1] * r[1] +
                                                     room->inverse[v][3 * i + 2] * r[2]
                                               : r[i];
    }
}

/* From dv on, until r.r is as wanted or so many iterations are done. */
static void iterate(const struct solve_system *s, const struct room *room, double wanted,
                    uint32_t most, double *dv)
{
    const size_t n = 3 * (size_t)s->n;
    double square = residual(s, dv, room->r), before = 1;
    memset(room->p, 0, n * sizeof *room->p);
    for (uint32_t k = 0; k < most && square > wanted; k++) {
        precondition(s, room);
        const double rz = dot(n, room->r, room->z);
        for (size_t i = 0; i < n; i++)
            room->p[i] = room->z[i] + (k ? rz / before : 0) * room->p[i];
        solve_system_multiply(s, room->p, room->q);
        const double alpha = rz / dot(n, room->p, room->q);
        for (size_t i = 0; i < n; i++) {
            dv[i] += alpha * room->p[i];
            room->r[i] -= alpha * room->q[i];
        }
        square = dot(n, room->r, room->r);
        before = rz;
    }
}

static int room_make(struct room *room, uint32_t n)
{
    double **array[] = {&room->r, &room->z, &room->p, &room->q};
    int has = 1;
    *room = (struct room){0};
    for (int i = 0; i < 4; i++)
        has = (*array[i] = malloc(((size_t)n + 1) * 3 * sizeof(double))) && has;
    return has ? 0 : serve_no_memory();
}

static void room_free(struct room *room)
{
    free(room->r);
    free(room->z);
    free(room->p);
    free(room->q);
    free(room->inverse);
}

double state_left(const struct state *state, const double *dv)
{
    const size_t n = 3 * (size_t)state->system.n;
    double *nothing = calloc(n + 1, sizeof *nothing), *r = malloc((n + 1) * sizeof *r);
    double left = NAN;
    if (nothing && r)
        left = sqrt(residual(&state->system, dv, r) / residual(&state->system, nothing, r));
    else
        serve_no_memory();
    free(nothing);
    free(r);
    return left;
}

int state_iterate(const struct solve_system *system, uint32_t count, double *dv)
{
    struct room room;
    const int code = room_make(&room, system->n);
    memset(dv, 0, 3 * (size_t)system->n * sizeof *dv);
    if (!code)
        iterate(system, &room, 0, count, dv);
    room_free(&room);
    return code;
}

/* Inverse of a symmetric matrix by cofactors. */
static void invert(const double a[9], double inverse[9])
{
    const double c0 = a[4] * a[8] - a[5] * a[7], c1 = a[5] * a[6] - a[3] * a[8],
                 c2 = a[3] * a[7] - a[4] * a[6], det = a[0] * c0 + a[1] * c1 + a[2] * c2;
    const double cofactor[9] = {c0, a[2] * a[7] - a[1] * a[8], a[1] * a[5] - a[2] * a[4],
                                c1, a[0] * a[8] - a[2] * a[6], a[2] * a[3] - a[0] * a[5],
                                c2, a[1] * a[6] - a[0] * a[7], a[0] * a[4] - a[1] * a[3]};
    for (int i = 0; i < 9; i++)
        inverse[i] = cofactor[i] / det;
}

static int blocks_make(const struct solve_system *s, struct room *room)
{
    room->inverse = calloc((size_t)s->n + 1, sizeof *room->inverse);
    if (!room->inverse)
        return serve_no_memory();
    for (size_t v = 0; v < s->n; v++)
        for (int i = 0; i < 3; i++)
            room->inverse[v][4 * i] = s->diagonal[v] > 0 ? s->diagonal[v] : 1;
    for (size_t k = 0; k < s->n_pairs; k++) {
        double n[3][3];
        solve_system_pair(s, k, n);
        for (int side = 0; side < 2; side++)
            for (int i = 0; i < 9; i++)
                room->inverse[s->end[k][side]][i] += 0.5 * (n[i / 3][i % 3] + n[i % 3][i / 3]);
    }
    for (size_t v = 0; v < s->n; v++) {
        double block[9];
        memcpy(block, room->inverse[v], sizeof block);
        invert(block, room->inverse[v]);
    }
    return 0;
}

int state_solve(const struct solve_system *system, double *dv)
{
    struct room room;
    enum { ROUNDS = 10, MOST = 20000 };
    int code = room_make(&room, system->n);
    memset(dv, 0, 3 * (size_t)system->n * sizeof *dv);
    if (!code)
        code = blocks_make(system, &room);
    if (!code) {
        double square = residual(system, dv, room.r), last = INFINITY;
        const double wanted = 1e-24 * square;
        for (int i = 0; i < ROUNDS && square > wanted && square < 0.25 * last; i++) {
            last = square;
            iterate(system, &room, 0.1 * wanted, MOST, dv);
            square = residual(system, dv, room.r);
        }
        if (!(square <= 1e4 * wanted))
            code = serve_fail("the solution is not found: %g of the right side is left",
                              sqrt(square / wanted) * 1e-12);
    }
    room_free(&room);
    return code;
}
