/* Conjugate gradients as one would write them by hand for MPI, with the kernels of the cloth. A
 * rank has a range of blocks; in a pass it computes those at its border first, sends each other
 * rank the rows of q that its blocks need in one message, computes the others, and adds up the dots
 * (MPI_Allreduce). */
#include "bench/ranks/ranks.h"

#include <math.h>
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RANKS = 16 };

/* The rows that go to another rank, or come from it: where its rows lie in the halos, three numbers
 * each. */
struct traffic {
    size_t n, *at;
    double *packed;
};

struct twin {
    struct sheet *sheet;
    int rank, ranks;
    uint32_t first[MOST_RANKS + 1]; /* block of each rank */
    struct traffic out[MOST_RANKS], in[MOST_RANKS];
    MPI_Request request[2 * MOST_RANKS];
    unsigned char *border; /* a block: whether another rank needs rows of it */
};

static int rank_of(const struct twin *twin, uint32_t block)
{
    int rank = 0;
    while (block >= twin->first[rank + 1])
        rank++;
    return rank;
}

/* Contiguous ranges, cut where the bisection that numbered the blocks cut, if the number of ranks
 * is a power of two. */
static void share_blocks(struct twin *twin)
{
    const uint64_t n = sheet_tables(twin->sheet)->n_blocks, ranks = (uint64_t)twin->ranks;
    for (uint64_t rank = 0; rank <= ranks; rank++)
        twin->first[rank] = (uint32_t)(n * rank / ranks);
}

/* Rows of the blocks of rank `from` that blocks of rank `to` need, in the order of the halos. */
static int list_rows(struct twin *twin, int from, int to, struct traffic *traffic)
{
    const struct sheet *sheet = twin->sheet;
    const struct flow_tables *all = sheet_tables(sheet);
    const size_t begin = sheet_halo(sheet, twin->first[from]) / 3;
    const uint32_t last = twin->first[from + 1] - 1;
    const size_t end = sheet_halo(sheet, last) / 3 + all->block[last].n_halo;
    unsigned char *needed = calloc(end - begin + 1, 1);
    traffic->at = calloc(end - begin + 1, sizeof *traffic->at);
    traffic->packed = calloc(3 * (end - begin) + 1, sizeof *traffic->packed);
    if (!needed || !traffic->at || !traffic->packed) {
        free(needed);
        return serve_no_memory();
    }
    for (uint32_t b = twin->first[to]; b < twin->first[to + 1]; b++) {
        const struct flow_table *t = all->block + b;
        for (uint32_t s = 0; s < t->n_neighbours; s++)
            for (uint32_t i = t->ghost_start[s];
                 i < t->ghost_start[s + 1] && rank_of(twin, t->neighbour[s]) == from; i++)
                needed[sheet_halo(sheet, t->neighbour[s]) / 3 + t->ghost[i] - begin] = 1;
    }
    for (size_t i = begin; i < end; i++)
        if (needed[i - begin])
            traffic->at[traffic->n++] = 3 * i;
    free(needed);
    return 0;
}

static void mark_border(struct twin *twin)
{
    const struct flow_tables *all = sheet_tables(twin->sheet);
    for (uint32_t b = 0; b < all->n_blocks; b++)
        for (uint32_t s = 0; s < all->block[b].n_neighbours; s++)
            twin->border[b] |= rank_of(twin, all->block[b].neighbour[s]) != rank_of(twin, b);
}

static int twin_make(struct twin *twin, struct sheet *sheet)
{
    *twin = (struct twin){.sheet = sheet};
    if (MPI_Comm_rank(MPI_COMM_WORLD, &twin->rank) || MPI_Comm_size(MPI_COMM_WORLD, &twin->ranks) ||
        twin->ranks > MOST_RANKS || (uint32_t)twin->ranks > sheet_tables(sheet)->n_blocks)
        return serve_fail("a twin of %d ranks cannot be", twin->ranks);
    share_blocks(twin);
    twin->border = calloc(sheet_tables(sheet)->n_blocks, 1);
    if (!twin->border)
        return serve_no_memory();
    mark_border(twin);
    int code = 0;
    for (int other = 0; other < twin->ranks && !code; other++) {
        twin->request[2 * other] = twin->request[2 * other + 1] = MPI_REQUEST_NULL;
        if (other == twin->rank)
            continue;
        code = list_rows(twin, twin->rank, other, &twin->out[other]) ||
               list_rows(twin, other, twin->rank, &twin->in[other]);
    }
    return code;
}

static void twin_free(struct twin *twin)
{
    for (int i = 0; i < MOST_RANKS; i++) {
        free(twin->out[i].at);
        free(twin->out[i].packed);
        free(twin->in[i].at);
        free(twin->in[i].packed);
    }
    free(twin->border);
}

/* ---- Solving ---- */

static int expect_rows(struct twin *twin)
{
    int code = 0;
    for (int other = 0; other < twin->ranks && !code; other++)
        if (twin->in[other].n)
            code = MPI_Irecv(twin->in[other].packed, (int)(3 * twin->in[other].n), MPI_DOUBLE,
                             other, 0, MPI_COMM_WORLD, &twin->request[2 * other]);
    return code;
}

static int send_rows(struct twin *twin, const double *halo)
{
    int code = 0;
    for (int other = 0; other < twin->ranks && !code; other++) {
        struct traffic *out = &twin->out[other];
        for (size_t i = 0; i < out->n; i++)
            memcpy(out->packed + 3 * i, halo + out->at[i], 3 * sizeof *halo);
        if (out->n)
            code = MPI_Isend(out->packed, (int)(3 * out->n), MPI_DOUBLE, other, 0, MPI_COMM_WORLD,
                             &twin->request[2 * other + 1]);
    }
    return code;
}

static int take_rows(struct twin *twin, double *halo)
{
    const int code = MPI_Waitall(2 * twin->ranks, twin->request, MPI_STATUSES_IGNORE);
    for (int other = 0; other < twin->ranks && !code; other++) {
        const struct traffic *in = &twin->in[other];
        for (size_t i = 0; i < in->n; i++)
            memcpy(halo + in->at[i], in->packed + 3 * i, 3 * sizeof *halo);
    }
    return code;
}

/* The blocks at the border, or the others. */
static void pass_blocks(struct twin *twin, bool border, const struct solve_scalars *now, int from,
                        double sum[SOLVE_DOTS])
{
    const uint32_t first = twin->first[twin->rank], n = twin->first[twin->rank + 1] - first;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t b = first + sheet_order(n, i, from);
        double dots[SOLVE_DOTS] = {0};
        if (twin->border[b] != border)
            continue;
        sheet_pass(twin->sheet, b, now, from, dots);
        for (int k = 0; k < SOLVE_DOTS; k++)
            sum[k] += dots[k];
    }
}

static int pass(struct twin *twin, const struct solve_scalars *now, int from,
                double sum[SOLVE_DOTS])
{
    double own[SOLVE_DOTS] = {0};
    double *halo = twin->sheet->halo[1 - from];
    const bool on = now->phase == SOLVE_ON;
    int code = on ? expect_rows(twin) : 0;
    pass_blocks(twin, true, now, from, own);
    if (on && !code)
        code = send_rows(twin, halo);
    pass_blocks(twin, false, now, from, own);
    if (!code)
        code = MPI_Allreduce(own, sum, SOLVE_RZ, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    sum[SOLVE_RZ] = sum[SOLVE_RR];
    return on && !code ? take_rows(twin, halo) : code;
}

static int solve(struct twin *twin, uint32_t count, struct solve_scalars *scalars)
{
    const struct solve_stop stop = {.count = true, .max = count};
    int code = expect_rows(twin);
    *scalars = solve_scalars_start(0, SOLVE_ON);
    for (uint32_t b = twin->first[twin->rank]; b < twin->first[twin->rank + 1]; b++)
        sheet_start(twin->sheet, b);
    if (!code)
        code = send_rows(twin, twin->sheet->halo[0]);
    if (!code)
        code = take_rows(twin, twin->sheet->halo[0]);
    for (int from = 0; scalars->phase != SOLVE_DONE && !code; from = 1 - from) {
        const struct solve_scalars now = *scalars;
        double sum[SOLVE_DOTS];
        code = pass(twin, &now, from, sum);
        if (!code)
            code = solve_scalars_next(&stop, sum, &now, scalars);
    }
    return code;
}

/* This rank's rows against the answer: the same up to what another order of sums makes of them. */
static int compare(const struct twin *twin, const struct solve_scalars *scalars)
{
    const struct sheet *s = twin->sheet;
    const size_t first = sheet_row(s, twin->first[twin->rank]);
    const uint32_t last = twin->first[twin->rank + 1] - 1;
    const size_t end = sheet_row(s, last) + sheet_tables(s)->block[last].n;
    double wrong = 0, all = 0;
    for (size_t i = first; i < end; i++) {
        const phys_vec d = s->dv[i] - s->answer[i];
        wrong += phys_dot(&d, &d);
        all += phys_dot(s->answer + i, s->answer + i);
    }
    if (wrong <= 1e-12 * all && fabs(scalars->square - s->square) <= 1e-3 * s->square)
        return 0;
    return serve_fail("wrong answer: %g off, r.r = %g, not %g", sqrt(wrong / all), scalars->square,
                      s->square);
}

/* The sum over all ranks. */
static struct twin_traffic count_traffic(const struct twin *twin)
{
    struct twin_traffic own = {0}, sum;
    for (int other = 0; other < twin->ranks; other++) {
        own.messages += twin->out[other].n > 0;
        own.bytes += 3.0 * sizeof(double) * (double)twin->out[other].n;
    }
    /* A sum over 2^k ranks is k exchanges at least. */
    for (int ranks = 1; ranks < twin->ranks; ranks *= 2) {
        own.messages++;
        own.bytes += SOLVE_RZ * sizeof(double);
    }
    MPI_Allreduce(&own, &sum, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum;
}

int twin_solve(struct sheet *sheet, uint32_t count, double *seconds, struct twin_traffic *traffic)
{
    struct twin twin;
    struct solve_scalars scalars;
    int code = sheet_solve(sheet, count);
    if (!code)
        code = twin_make(&twin, sheet);
    if (!code && solve(&twin, count / 10 + 1, &scalars))
        code = serve_fail("MPI failed, or the solve breaks down");
    if (!code) {
        MPI_Barrier(MPI_COMM_WORLD);
        const double start = serve_seconds();
        const int failed = solve(&twin, count, &scalars);
        MPI_Barrier(MPI_COMM_WORLD);
        *seconds = serve_seconds() - start;
        code =
            failed ? serve_fail("MPI failed, or the solve breaks down") : compare(&twin, &scalars);
        *traffic = count_traffic(&twin); /* collective, whatever the answers are */
    }
    twin_free(&twin);
    return code;
}
