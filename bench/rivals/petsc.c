/* PETSc's conjugate gradients on the systems of the bench "cg". Which format of the matrix and
 * which order of the vertices are best is measured when a state is first used; what was chosen goes
 * to standard error. */
#include "bench/rivals/petsc_system.h"

#include <malloc.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const FORMAT[] = {"aij", "aij without inodes", "baij", "sbaij"};
static const char *const ORDER[] = {"the input's", "of the cloth's blocks",
                                    "reverse Cuthill-McKee"};

struct session {
    int rank, ranks;
    struct state state;
    char made[40];            /* of which state: */
    struct system any, plain; /* in the best of all formats; in the best of AIJ's two */
    struct {
        char pc[16];
        PetscInt iterations;
    } needed[4]; /* to the error asked for */
};

/* ---- Solving ---- */

/* Block Jacobi with incomplete Cholesky of each rank's part, shifted where a pivot fails. */
static int set_icc(KSP ksp, PC pc)
{
    KSP *sub;
    PetscInt n;
    PC inner;
    TRY(PCSetType(pc, PCBJACOBI));
    TRY(KSPSetUp(ksp));
    TRY(PCBJacobiGetSubKSP(pc, &n, NULL, &sub));
    TRY(KSPSetType(sub[0], KSPPREONLY));
    TRY(KSPGetPC(sub[0], &inner));
    TRY(PCSetType(inner, PCICC));
    TRY(PCFactorSetShiftType(inner, MAT_SHIFT_POSITIVE_DEFINITE));
    return 0;
}

static int make_solver(const struct system *s, const char *kind, KSP *ksp)
{
    PC pc;
    TRY(KSPCreate(PETSC_COMM_WORLD, ksp));
    TRY(KSPSetOperators(*ksp, s->a, s->a));
    TRY(KSPSetType(*ksp, KSPCG));
    TRY(KSPSetInitialGuessNonzero(*ksp, PETSC_FALSE));
    TRY(KSPGetPC(*ksp, &pc));
    if (!strcmp(kind, "icc"))
        return set_icc(*ksp, pc);
    TRY(PCSetType(pc, !strcmp(kind, "gamg") ? PCGAMG : PCNONE));
    return 0;
}

/* So many iterations, no norm but what the method needs. With set-up. The matrix has just been
 * written, as in a simulation, where each step has its own: after a pause in which it was not,
 * PETSc takes three times the time for as long as it is only read. */
static int iterate(const struct system *s, const char *pc, PetscInt count, double *seconds)
{
    KSP ksp;
    TRY(MatScale(s->a, 2));
    TRY(MatScale(s->a, 0.5));
    MPI_Barrier(PETSC_COMM_WORLD);
    const double begin = serve_seconds();
    if (make_solver(s, pc, &ksp))
        return 1;
    TRY(KSPSetNormType(ksp, KSP_NORM_NONE));
    TRY(KSPSetConvergenceTest(ksp, KSPConvergedSkip, NULL, NULL));
    TRY(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, count));
    TRY(KSPSolve(ksp, s->b, s->x));
    MPI_Barrier(PETSC_COMM_WORLD);
    *seconds = serve_seconds() - begin;
    TRY(KSPDestroy(&ksp));
    return 0;
}

/* x in the numbering of the input, on every rank. */
static int answer(const struct session *session, const struct system *s, Vec x, double *dv)
{
    VecScatter scatter;
    Vec all;
    const PetscScalar *value;
    TRY(VecScatterCreateToAll(x, &scatter, &all));
    TRY(VecScatterBegin(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD));
    TRY(VecScatterEnd(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD));
    TRY(VecGetArrayRead(all, &value));
    for (uint32_t v = 0; v < session->state.system.n; v++)
        for (size_t c = 0; c < 3; c++)
            dv[3 * (size_t)v + c] = value[3 * (size_t)s->place[v] + c];
    TRY(VecRestoreArrayRead(all, &value));
    TRY(VecScatterDestroy(&scatter));
    TRY(VecDestroy(&all));
    return 0;
}

/* ---- Choosing ---- */

/* Seconds an iteration of the best of some tries, of the slowest rank. The choice is idle for tiny
 * systems, and a machine that is full of other work takes its time over every message. */
static int try_out(const struct session *session, const struct system *s, double *seconds)
{
    const bool tiny = session->state.system.n < 1000;
    const int tries = tiny ? 1 : 3, count = tiny ? 1 : 20;
    double best = 1e9;
    for (int i = 0; i < tries; i++) {
        double now;
        if (iterate(s, "none", count, &now))
            return 1;
        best = now < best * count ? now / count : best;
    }
    MPI_Allreduce(&best, seconds, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
    return 0;
}

/* Makes the system that is fastest among some formats. It is made again when all others are gone:
 * one that lies where others lay before it can take twice the time. */
static int choose(struct session *session, enum format formats, struct system *best)
{
    double least = 1e9;
    enum format format = AIJ;
    enum order order = NATURAL;
    for (enum format f = AIJ; f < formats; f++)
        for (enum order o = NATURAL; o < ORDERS; o++) {
            struct system s;
            double seconds;
            if (system_make(&s, &session->state, f, o) || try_out(session, &s, &seconds))
                return 1;
            system_free(&s);
            if (seconds < least) {
                format = f;
                order = o;
                least = seconds;
            }
        }
    if (system_make(best, &session->state, format, order) || try_out(session, best, &least))
        return 1;
    if (session->rank == 0)
        fprintf(
            stderr,
            "# PETSc on %d rank%s, %s, best of %d formats x %d orders: %s, order %s: %.0f us an "
            "iteration\n",
            session->ranks, session->ranks > 1 ? "s" : "", session->state.name, (int)formats,
            (int)ORDERS, FORMAT[format], ORDER[order], 1e6 * least);
    return 0;
}

static int ready(struct session *session, struct serve_request *request, bool plain,
                 struct system **system)
{
    int code = state_ready(&session->state, request);
    if (!code && strcmp(session->made, session->state.name) != 0) {
        system_free(&session->any);
        system_free(&session->plain);
        memset(session->needed, 0, sizeof session->needed);
        snprintf(session->made, sizeof session->made, "%s", session->state.name);
    }
    *system = plain ? &session->plain : &session->any;
    if (!code && !(*system)->a)
        code = choose(session, plain ? BAIJ : FORMATS, *system);
    return code;
}

/* ---- Runs ---- */

static int cg(void *context, struct serve_request *request, double *value)
{
    struct session *session = context;
    const uint32_t count = (uint32_t)serve_number(request, "count");
    struct system *s;
    double *dv = NULL;
    int code = ready(session, request, false, &s);
    if (!code)
        code = iterate(s, "none", (PetscInt)count / 10 + 1, value);
    if (!code)
        code = iterate(s, "none", (PetscInt)count, value);
    if (!code && !(dv = calloc((size_t)session->state.system.n + 1, 3 * sizeof *dv)))
        code = serve_no_memory();
    if (!code)
        code = answer(session, s, s->x, dv);
    if (!code)
        code = state_check(&session->state, count, dv);
    free(dv);
    return code;
}

/* A search for the iteration after which the error is small enough: looked at after each, not
 * timed.
 */
struct search {
    const struct session *session;
    const struct system *system;
    double *dv, error;
};

static PetscErrorCode look(KSP ksp, PetscInt iterations, PetscReal norm, KSPConvergedReason *reason,
                           void *context)
{
    struct search *search = context;
    const struct state *state = &search->session->state;
    Vec x;
    (void)norm;
    *reason = KSP_CONVERGED_ITERATING;
    if (iterations == 0)
        return 0;
    PetscCall(KSPBuildSolution(ksp, NULL, &x));
    if (answer(search->session, search->system, x, search->dv))
        return PETSC_ERR_LIB;
    if (state_distance(state, search->dv, state->system.dv) <= search->error)
        *reason = KSP_CONVERGED_RTOL;
    return 0;
}

static int count_iterations(const struct session *session, const struct system *s, const char *pc,
                            double error, PetscInt *iterations)
{
    KSP ksp;
    KSPConvergedReason reason;
    struct search search = {session, s, NULL, error};
    search.dv = calloc((size_t)session->state.system.n + 1, 3 * sizeof *search.dv);
    if (!search.dv)
        return serve_no_memory();
    int code = make_solver(s, pc, &ksp);
    if (!code && (KSPSetConvergenceTest(ksp, look, &search, NULL) ||
                  KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 20000) ||
                  KSPSolve(ksp, s->b, s->x) || KSPGetIterationNumber(ksp, iterations) ||
                  KSPGetConvergedReason(ksp, &reason) || KSPDestroy(&ksp)))
        code = serve_fail("PETSc failed with %s", pc);
    else if (!code && reason <= 0)
        code = serve_fail("PETSc with %s does not come to an error of %g: reason %d", pc, error,
                          (int)reason);
    free(search.dv);
    return code;
}

static PetscInt *needed(struct session *session, const char *pc)
{
    size_t i = 0;
    while (*session->needed[i].pc && strcmp(session->needed[i].pc, pc) != 0)
        i++;
    snprintf(session->needed[i].pc, sizeof session->needed[i].pc, "%s", pc);
    return &session->needed[i].iterations;
}

/* error=: in the mass norm, millionths. what=iterations: so many instead of the seconds. */
static int solve(void *context, struct serve_request *request, double *value)
{
    struct session *session = context;
    const double error = 1e-6 * (double)serve_number(request, "error");
    char pc[16], what[16];
    struct system *s;
    double *dv = NULL;
    serve_word(request, "pc", pc, sizeof pc);
    serve_word(request, "what", what, sizeof what);
    int code = ready(session, request, true, &s);
    PetscInt *iterations = needed(session, pc);
    if (!code && !*iterations)
        code = count_iterations(session, s, pc, error, iterations);
    if (!code)
        code = iterate(s, pc, *iterations, value);
    if (!code && !(dv = calloc((size_t)session->state.system.n + 1, 3 * sizeof *dv)))
        code = serve_no_memory();
    if (!code)
        code = answer(session, s, s->x, dv);
    if (!code && state_distance(&session->state, dv, session->state.system.dv) > 1.01 * error)
        code = serve_fail("wrong answer with %s", pc);
    free(dv);
    if (!strcmp(what, "iterations"))
        *value = (double)*iterations;
    return code;
}

int main(int argc, char **argv)
{
    static const struct serve_run runs[] = {{"cg", cg}, {"solve", solve}, {0}};
    const struct serve_run *const all[] = {runs, NULL};
    static struct session session;
    char settings[200], version[100];
    if (PetscInitialize(&argc, &argv, NULL, NULL)) {
        fprintf(stderr, "PETSc does not start\n");
        return 1;
    }
    mallopt(M_MMAP_THRESHOLD, 1 << 18); /* what is large lies in pages of its own */
    MPI_Comm_rank(PETSC_COMM_WORLD, &session.rank);
    MPI_Comm_size(PETSC_COMM_WORLD, &session.ranks);
    PetscGetVersion(version, sizeof version);
    version[strcspn(version, ",")] = '\0';
    serve_bind(session.rank);
    snprintf(settings, sizeof settings,
             "%s, KSPCG without norms; the best format and order of each state by measurement",
             version);
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    const int status = serve(settings, all, &session);
    system_free(&session.any);
    system_free(&session.plain);
    state_free(&session.state);
    return PetscFinalize() || status;
}
