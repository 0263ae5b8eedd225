/* The table of programs is constant; configure says what is missing. */
#include "bench/program.h"

#include "bench/subject.h"
#include "tools/compare/environment.h"

#include <config.h>

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A core for each thread is what both manuals recommend; whether waiting threads should spin
 * depends on the case, so both are tried and the faster one counts. */
#define BOUND "OMP_PROC_BIND=true", "OMP_PLACES=cores", "OMP_DYNAMIC=false"
#define ACTIVE                                                                                     \
    .settings = {"OMP_WAIT_POLICY=active", BOUND},                                                 \
    .crowded = {"OMP_WAIT_POLICY=passive", "OMP_DYNAMIC=false"}
#define PASSIVE                                                                                    \
    .settings = {"OMP_WAIT_POLICY=passive", BOUND},                                                \
    .crowded = {"OMP_WAIT_POLICY=passive", "OMP_DYNAMIC=false"}

/* A rank that waits keeps its core. */
#define TURNS                                                                                      \
    {                                                                                              \
        "OMPI_MCA_mpi_yield_when_idle=0"                                                           \
    }

#ifdef HAVE_HDF5
#define HDF5_MISSING ""
#else
#define HDF5_MISSING "libhdf5-dev"
#endif

#ifdef HAVE_ASSIMP
#define ASSIMP_MISSING ""
#else
#define ASSIMP_MISSING "libassimp-dev"
#endif

#ifdef HAVE_ZMQ
#define ZMQ_MISSING ""
#else
#define ZMQ_MISSING "libzmq3-dev"
#endif

static const struct program PROGRAMS[] = {
    {"duite", NULL, "", NULL, NULL, false, {0}, {0}},
    {"duite_hosts", NULL, "", NULL, NULL, true, {0}, {0}},
    {"duite_valgrind", NULL, "", NULL, "valgrind", false, {0}, {0}},
    {"duite_hdf5", NULL, HDF5_MISSING, NULL, NULL, false, {0}, {0}},
    {"duite_assimp", NULL, ASSIMP_MISSING, NULL, NULL, false, {0}, {0}},
    {"duite_live", NULL, ZMQ_MISSING, NULL, NULL, false, {0}, {0}},
    {"view", "output/draw", BENCH_VIEW_MISSING, NULL, NULL, false, {0}, {0}},
    {"film", "output/draw", BENCH_VIEW_MISSING, NULL, "ffmpeg", false, {0}, {0}},
    {"blender", NULL, "", NULL, "blender", false, {0}, {0}},
    {"twin", NULL, "", NULL, NULL, false, TURNS, {0}},
    {"twin_hosts", NULL, "", NULL, NULL, true, TURNS, {0}},
    {"sequential", NULL, "", NULL, NULL, false, {0}, {0}},
    {"libgomp", "rivals/libgomp", RIVAL_LIBGOMP_MISSING, "libgomp_passive", NULL, false, ACTIVE},
    {"libgomp_passive", "rivals/libgomp", RIVAL_LIBGOMP_MISSING, NULL, NULL, false, PASSIVE},
    {"libomp", "rivals/libomp", RIVAL_LIBOMP_MISSING, "libomp_passive", NULL, false, ACTIVE},
    {"libomp_passive", "rivals/libomp", RIVAL_LIBOMP_MISSING, NULL, NULL, false, PASSIVE},
    {"tbb", "rivals/tbb", RIVAL_TBB_MISSING, NULL, NULL, false, {0}, {0}},
    {"taskflow", "rivals/taskflow", RIVAL_TASKFLOW_MISSING, NULL, NULL, false, {0}, {0}},
    {"starpu", "rivals/starpu", RIVAL_STARPU_MISSING, NULL, NULL, false, {"STARPU_SILENT=1"}, {0}},
    {"mpi", "rivals/mpi", RIVAL_MPI_MISSING, NULL, NULL, false, TURNS, {0}},
    {"openmp", "cg/twin", RIVAL_OPENMP_MISSING, NULL, NULL, false, ACTIVE},
    {"embree", "rivals/embree", RIVAL_EMBREE_MISSING, NULL, NULL, false, {0}, {0}},
    {"petsc",
     "rivals/petsc",
     RIVAL_PETSC_MISSING,
     NULL,
     NULL,
     false,
     {"OMPI_MCA_mpi_yield_when_idle=0", "OPENBLAS_NUM_THREADS=1"},
     {0}},
};

const struct program *program_find(const char *kind)
{
    for (size_t i = 0; i < sizeof PROGRAMS / sizeof *PROGRAMS; i++)
        if (!strcmp(PROGRAMS[i].kind, kind))
            return &PROGRAMS[i];
    return NULL;
}

/* The path of duite-bench, or of a file beside it. */
static const char *path_of(const struct program *program)
{
    static char path[PATH_MAX + 64];
    ssize_t length = readlink("/proc/self/exe", path, PATH_MAX);
    path[length < 0 ? 0 : length] = '\0';
    char *slash = strrchr(path, '/');
    if (program->file && slash)
        snprintf(slash + 1, sizeof path - (size_t)(slash + 1 - path), "%s", program->file);
    return path;
}

size_t program_folder(char *folder, size_t size)
{
    static const struct program own = {.kind = "duite"};
    const char *path = path_of(&own), *slash = strrchr(path, '/');
    return (size_t)snprintf(folder, size, "%.*s", slash ? (int)(slash - path) : 0, path);
}

/* Why there are no hosts here, in the words of the script that makes them; or NULL. Asked once. */
static const char *hosts_missing(void)
{
    static char why[200] = "no hosts: the script that makes them does not start";
    static int failed = -1;
    FILE *answer = failed < 0 ? popen("sh '" BENCH_HOSTS "' 1 true 2>&1", "r") : NULL;
    if (answer) {
        if (!fgets(why, sizeof why, answer))
            snprintf(why, sizeof why, "no hosts here");
        why[strcspn(why, "\n")] = '\0';
        failed = pclose(answer) != 0;
    }
    return failed ? why : NULL;
}

/* True if a folder of PATH has it. */
static bool is_installed(const char *tool)
{
    char path[PATH_MAX];
    const char *folder = getenv("PATH");
    while (folder && *folder) {
        const int length = (int)strcspn(folder, ":");
        snprintf(path, sizeof path, "%.*s/%s", length, folder, tool);
        if (!access(path, X_OK))
            return true;
        folder += length + (folder[length] == ':');
    }
    return false;
}

const char *program_missing(const struct program *program)
{
    static char why[200];
    if (!program)
        return "unknown";
    if (program->tool && !is_installed(program->tool)) {
        snprintf(why, sizeof why, "not installed: %s", program->tool);
        return why;
    }
    const bool left_out = !program->file && *program->missing; /* a part of duite itself */
    if (!left_out && !access(path_of(program), X_OK))
        return program->hosts ? hosts_missing() : NULL;
    snprintf(why, sizeof why, "not built: %s%s",
             *program->missing ? program->missing : "make bench",
             *program->missing ? " is missing" : " builds it");
    return why;
}

static void set(const char *setting)
{
    char name[64];
    size_t length = strcspn(setting, "=");
    snprintf(name, sizeof name, "%.*s", (int)length, setting);
    setenv(name, setting + length + 1, 0);
}

const char *const *program_settings(const struct program *program, unsigned cores)
{
    return cores <= subject_cores() ? program->settings : program->crowded;
}

void program_environment(const struct program *program, unsigned cores)
{
    environment_forget();
    for (const char *const *word = program_settings(program, cores); *word; word++)
        set(*word);
    /* hwloc: silent about caches that virtual machines report wrongly; no look for graphics cards,
     * which can take seconds */
    set("HWLOC_HIDE_ERRORS=2");
    set("HWLOC_COMPONENTS=-gl");
    set("OMPI_MCA_rmaps_base_oversubscribe=1");
    set("OMPI_MCA_hwloc_base_binding_policy=none"); /* the programs bind themselves */
    if (geteuid() == 0) {
        set("OMPI_ALLOW_RUN_AS_ROOT=1");
        set("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1");
    }
}

void program_command(const struct program *program, const char *ranks, const char **argv)
{
    const char *mpirun = getenv("MPIRUN");
    size_t n = 0;
    if (program->hosts && ranks) {
        argv[n++] = "sh";
        argv[n++] = BENCH_HOSTS;
        argv[n++] = ranks;
    }
    if (ranks) {
        argv[n++] = mpirun && *mpirun ? mpirun : BENCH_MPIRUN;
        argv[n++] = "-n";
        argv[n++] = ranks;
    }
    argv[n++] = path_of(program);
    argv[n] = NULL;
}
