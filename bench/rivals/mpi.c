/* A stencil on a line of points as one would write it by hand for MPI: each rank has a range of
 * points and sends the ends of it to its neighbours as soon as they are computed; a range's inner
 * points hide the way. */
#include "bench/problem.h"
#include "bench/serve.h"

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

static problem_line_body *const volatile POINT = problem_line_point;

struct line {
    int rank, ranks;
    uint64_t points, steps;
    size_t n;                        /* points of this rank */
    struct problem_message *cell[2]; /* n of them, between one more for each neighbour's end */
};

static const struct problem_message *neighbour(const struct line *line, size_t i, int side,
                                               const struct problem_message *old)
{
    if ((side < 0 && i == 1 && line->rank == 0) ||
        (side > 0 && i == line->n && line->rank == line->ranks - 1))
        return NULL;
    return side < 0 ? &old[i - 1] : &old[i + 1];
}

static int point(const struct line *line, size_t i, uint64_t step)
{
    const struct problem_message *old = line->cell[(step - 1) % 2];
    return POINT(neighbour(line, i, -1, old), &old[i], neighbour(line, i, 1, old),
                 &line->cell[step % 2][i]);
}

enum { BYTES = sizeof(struct problem_message), LEFT = 1, RIGHT = 2 };

/* Both ends of a step's values start on their way. */
static int send_end(const struct line *line, uint64_t step, int side, MPI_Request *request)
{
    struct problem_message *cell = line->cell[step % 2];
    int to = side == LEFT ? line->rank - 1 : line->rank + 1;
    *request = MPI_REQUEST_NULL;
    if (to < 0 || to >= line->ranks)
        return 0;
    return MPI_Isend(&cell[side == LEFT ? 1 : line->n], BYTES, MPI_BYTE, to, side, MPI_COMM_WORLD,
                     request);
}

static void receive_ends(const struct line *line, uint64_t step)
{
    struct problem_message *cell = line->cell[step % 2];
    if (line->rank > 0)
        MPI_Recv(&cell[0], BYTES, MPI_BYTE, line->rank - 1, RIGHT, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
    if (line->rank < line->ranks - 1)
        MPI_Recv(&cell[line->n + 1], BYTES, MPI_BYTE, line->rank + 1, LEFT, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
}

/* Step after step: the ends first, so that they travel while the rest is computed. */
static int sweep(const struct line *line)
{
    MPI_Request request[2] = {MPI_REQUEST_NULL, MPI_REQUEST_NULL};
    int wrong = 0;
    send_end(line, 0, LEFT, &request[0]);
    send_end(line, 0, RIGHT, &request[1]);
    for (uint64_t step = 1; step <= line->steps; step++) {
        receive_ends(line, step - 1);
        MPI_Waitall(2, request, MPI_STATUSES_IGNORE);
        wrong |= point(line, 1, step);
        send_end(line, step, LEFT, &request[0]);
        if (line->n > 1)
            wrong |= point(line, line->n, step);
        send_end(line, step, RIGHT, &request[1]);
        for (size_t i = 2; i < line->n; i++)
            wrong |= point(line, i, step);
    }
    receive_ends(line, line->steps);
    MPI_Waitall(2, request, MPI_STATUSES_IGNORE);
    return wrong;
}

static double time_sweep(const struct line *line, size_t first, int *wrong)
{
    for (size_t i = 0; i < line->n; i++)
        line->cell[0][i + 1] = (struct problem_message){0, problem_start(first + i)};
    MPI_Barrier(MPI_COMM_WORLD);
    double start = serve_seconds();
    *wrong |= sweep(line);
    MPI_Barrier(MPI_COMM_WORLD);
    return serve_seconds() - start;
}

/* This rank's points against the sequential line. */
static int check(const struct line *line, size_t first)
{
    struct problem_message *all = calloc(2 * line->points, sizeof *all);
    if (!all)
        return 1;
    int wrong = problem_line(all, line->points, line->steps);
    for (size_t i = 0; i < line->n; i++)
        wrong |= line->cell[line->steps % 2][i + 1].value !=
                 all[line->steps % 2 * line->points + first + i].value;
    free(all);
    return wrong;
}

static int run(void *context, struct serve_request *request, double *value)
{
    struct line line = *(const struct line *)context;
    line.points = serve_number(request, "points");
    line.steps = serve_number(request, "steps");
    uint64_t ranks = (uint64_t)line.ranks, rank = (uint64_t)line.rank;
    if (line.points < ranks)
        return serve_fail("fewer points than ranks");
    size_t first = line.points * rank / ranks;
    line.n = line.points * (rank + 1) / ranks - first;
    line.cell[0] = calloc(2 * (line.n + 2), sizeof *line.cell[0]);
    if (!line.cell[0])
        return serve_no_memory();
    line.cell[1] = line.cell[0] + line.n + 2;
    int wrong = 0;
    struct line warm = line;
    warm.steps = line.steps / 10;
    time_sweep(&warm, first, &wrong);
    *value = time_sweep(&line, first, &wrong);
    wrong |= check(&line, first);
    free(line.cell[0]);
    return wrong ? serve_fail("wrong answer") : 0;
}

int main(void)
{
    static const struct serve_run runs[] = {{"line", run}, {0}};
    const struct serve_run *const all[] = {runs, NULL};
    struct line line = {0};
    char settings[MPI_MAX_LIBRARY_VERSION_STRING + 100], version[MPI_MAX_LIBRARY_VERSION_STRING];
    int length;
    if (MPI_Init(NULL, NULL) || MPI_Comm_rank(MPI_COMM_WORLD, &line.rank) ||
        MPI_Comm_size(MPI_COMM_WORLD, &line.ranks) || MPI_Get_library_version(version, &length)) {
        fprintf(stderr, "MPI does not start\n");
        return 1;
    }
    for (char *c = version; *c; c++)
        if (*c == ',' || *c == '\n')
            *c = '\0'; /* the name and the number */
    serve_bind(line.rank);
    snprintf(settings, sizeof settings, "%s, a rank a core, bound, ends sent first", version);
    int status = serve(settings, all, &line);
    MPI_Finalize();
    return status;
}
