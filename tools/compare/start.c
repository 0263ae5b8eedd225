/* A run is a program of its own: duite-cloth for scenes, duite-graph for graphs, a twin of it in
 * another runtime for schedulers named RUNTIME:NAME, or the one behind --. Its report is a file in
 * the folder, which the next run overwrites; what it prints goes to run.log there, and of a run
 * that failed to failed.log. */
#include "tools/compare/compare.h"
#include "tools/compare/environment.h"
#include "tools/compare/figure.h"
#include "tools/compare/program.h"

#include <libgen.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define FORKS "forks:"

enum { WORDS = 120 };

struct line {
    char *word[WORDS];
    int n;
};

static void append(struct line *line, const char *word)
{
    if (line->n + 1 < WORDS && word)
        line->word[line->n++] = strdup(word);
    line->word[line->n] = NULL;
}

static void append_pair(struct line *line, const char *option, const char *value)
{
    append(line, option);
    append(line, value);
}

const char *compare_find_program(const char *name, char path[COMPARE_PROGRAM])
{
    char self[PATH_MAX] = "";
    if (readlink("/proc/self/exe", self, sizeof self - 1) < 0)
        self[0] = 0;
    snprintf(path, COMPARE_PROGRAM, "%s/%s", dirname(self), name);
    return path;
}

static void append_filled(const struct compare *compare, const struct compare_config *config,
                          const char *word, struct line *line)
{
    char *filled = program_fill(compare, config, word);
    append(line, filled);
    free(filled);
}

static void append_program(struct line *line, const char *name)
{
    char path[COMPARE_PROGRAM];
    append(line, compare_find_program(name, path));
}

const char *compare_name_in_runtime(const char *scheduler)
{
    const size_t letters = strspn(scheduler, "abcdefghijklmnopqrstuvwxyz");
    return letters && scheduler[letters] == ':' ? scheduler + letters + 1 : NULL;
}

bool compare_is_twin(const char *scheduler)
{
    return compare_name_in_runtime(scheduler) && strncmp(scheduler, FORKS, strlen(FORKS)) != 0;
}

/* starpu:NAME is of bench/rivals/starpu-graph. */
static const char *find_twin(const char *scheduler, char path[COMPARE_PROGRAM])
{
    char name[100];
    snprintf(name, sizeof name, "bench/rivals/%.*s-graph", (int)strcspn(scheduler, ":"), scheduler);
    return compare_find_program(name, path);
}

const char *compare_twin_wrong(const char *scheduler, char *text, size_t size)
{
    char path[COMPARE_PROGRAM], command[COMPARE_PROGRAM + 40], known[2000] = "", word[100];
    bool found = false;
    if (access(find_twin(scheduler, path), X_OK)) {
        snprintf(text, size,
                 "%s is not there: make bench builds it in the build folder, if configure finds "
                 "what it needs",
                 path);
        return text;
    }
    snprintf(command, sizeof command, "'%s' --schedulers", path);
    FILE *in = popen(command, "r");
    for (size_t used = 0; in && used < sizeof known && fscanf(in, "%99s", word) == 1;) {
        found = found || !strcmp(word, compare_name_in_runtime(scheduler));
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", word);
    }
    if (!in || pclose(in) || !*known)
        snprintf(text, size, "%s --schedulers does not list its schedulers", path);
    else if (!found)
        snprintf(text, size, "there is no scheduler of this name; known are %s", known);
    else
        return NULL;
    return text;
}

static bool is_scene(const char *subject)
{
    const char *end = strrchr(subject, '.');
    return end && (!strcmp(end, ".yaml") || !strcmp(end, ".yml"));
}

static void append_scene(const struct compare *compare, const struct compare_config *config,
                         struct line *line)
{
    append_program(line, "duite-cloth");
    append(line, config->value[SUBJECT]);
    append(line, "--quiet");
    if (strcmp(config->value[GRAIN], "0") != 0)
        append_pair(line, "--grain", config->value[GRAIN]);
    for (size_t i = 0; i < compare->sets.n; i++)
        append_pair(line, "--set", compare->sets.item[i]);
}

/* The grain of a graph is a factor of its tasks' cost; their number falls as it grows, but for
 * --metg. */
static void append_graph(const struct compare *compare, const struct compare_config *config,
                         struct line *line)
{
    char cost[40], tasks[40];
    double grain = strtod(config->value[GRAIN], NULL);
    grain = grain > 0 ? grain : 1;
    snprintf(cost, sizeof cost, "%.9g", strtod(compare->cost, NULL) * grain);
    snprintf(tasks, sizeof tasks, "%.0f",
             strtod(compare->tasks, NULL) / (compare->metg ? 1 : grain));
    append(line, config->value[SUBJECT]);
    append_pair(line, "--cost", cost);
    append_pair(line, "--tasks", tasks);
    append_pair(line, "--bytes", compare->bytes);
    append_pair(line, "--rounds", compare->steps);
}

static void make_line(const struct compare *compare, const struct compare_config *config,
                      const char *report, struct line *line)
{
    const char *subject = config->value[SUBJECT], *scheduler = config->value[SCHEDULER];
    const char *name = compare_name_in_runtime(scheduler);
    const bool twin = compare_is_twin(scheduler);
    char seconds[20], path[COMPARE_PROGRAM];
    snprintf(seconds, sizeof seconds, "%u", compare->timeout);
    append_pair(line, "timeout", "-k");
    append_pair(line, "5", seconds);
    const char *ranks = strncmp(scheduler, "mpi:", 4) ? config->value[RANKS] : /* a rank a core */
                            config->value[THREADS];
    if (*ranks && strcmp(ranks, "1") != 0) {
        append(line, COMPARE_MPIRUN);
        append_pair(line, "-n", ranks);
    }
    for (char *const *word = compare->program; word && *word; word++)
        append_filled(compare, config, *word, line);
    if (compare->program)
        return;
    if (is_scene(subject)) {
        append_scene(compare, config, line);
    } else {
        append(line, twin ? find_twin(scheduler, path) : compare_find_program("duite-graph", path));
        append_graph(compare, config, line);
    }
    append_pair(line, "--scheduler", name ? name : scheduler);
    append_pair(line, "--threads", config->value[THREADS]);
    append_pair(line, "--report", report);
    if (twin)
        return;
    if (name)
        append(line, "--forks");
    append_pair(line, "--mapping", config->value[MAPPING]);
    append_pair(line, "--balance", config->value[BALANCE]);
}

/* A policy that does not return is named by the report of a standstill, well before its run is
 * stopped, so that the page can say it. The user's own setting counts. */
static void report_standstills_by(unsigned timeout)
{
    const double usual = 60, soon = timeout / 4.0;
    char seconds[30];
    snprintf(seconds, sizeof seconds, "%g", soon < usual ? soon : usual);
    setenv("DUITE_STUCK_SECONDS", seconds, 0);
}

/* As duite's workers: a thread a core, bound, and waiting actively; on fewer cores it sleeps. The
 * user's own setting counts. */
static void settle_openmp(bool alone)
{
    setenv("OMP_PROC_BIND", alone ? "true" : "false", 0);
    setenv("OMP_PLACES", "cores", 0);
    setenv("OMP_WAIT_POLICY", alone ? "active" : "passive", 0);
}

/* The program may run in another folder. */
static void set_path(const char *variable, const char *path)
{
    char folder[PATH_MAX], whole[2 * PATH_MAX];
    const bool relative = *path != '/' && getcwd(folder, sizeof folder);
    snprintf(whole, sizeof whole, "%s%s%s", relative ? folder : "", relative ? "/" : "", path);
    setenv(variable, whole, 1);
}

/* A trace is a chart's: one that gets too long ends early, and the run goes on. */
static void limit_trace(const char *trace)
{
    const struct rlimit most = {256 << 20, 256 << 20}; /* bytes: six million tasks */
    set_path("DUITE_TRACE", trace);
    setrlimit(RLIMIT_FSIZE, &most);
    signal(SIGXFSZ, SIG_IGN);
}

/* Returns the status of waitpid; *seconds from the start to the end. */
static int execute(const struct compare *compare, const struct compare_config *config,
                   struct line *line, const char *report, const char *log, double *seconds)
{
    struct timespec start, end;
    int status = 1;
    fflush(NULL);
    unlink(log); /* the last run's: one that cannot be started says nothing */
    clock_gettime(CLOCK_MONOTONIC, &start);
    pid_t child = fork();
    if (!child) {
        environment_forget();
        program_environment(compare, config);
        if (!strncmp(config->value[SCHEDULER], "lib", 3))
            settle_openmp(strtod(config->value[THREADS], NULL) <= compare->load.cores);
        if (compare->program)
            set_path("DUITE_REPORT", report);
        if (compare->trace)
            limit_trace(compare->trace);
        report_standstills_by(compare->timeout);
        const bool closed = freopen("/dev/null", "r", stdin); /* a question would have no answer */
        if (closed && freopen(log, "w", stdout))
            dup2(STDOUT_FILENO, STDERR_FILENO);
        execvp(line->word[0], line->word);
        _exit(127);
    }
    if (child < 0 || waitpid(child, &status, 0) < 0)
        status = 1 << 8;
    clock_gettime(CLOCK_MONOTONIC, &end);
    *seconds = (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
    return status;
}

/* ---- Failures ---- */

static bool is_error(const char *line)
{
    static const char *const programs[] = {
        "duite-cloth: ",  "duite-graph: ", "starpu-graph: ", "libgomp-graph: ",
        "libomp-graph: ", "mpi-graph: ",   "duite: ",        "timeout: "};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        if (!strncmp(line, programs[i], strlen(programs[i])))
            return true;
    return false;
}

/* A report of a standstill has many lines, and each rank writes one: the line that names a policy
 * counts more than what these say after it. */
static bool is_said_after(const char *line, const char *last)
{
    return strstr(last, ", which has not returned;") && !strncmp(line, "duite: rank ", 12) &&
           !strstr(line, ", which has not returned;");
}

/* The words of mpirun on a rank that failed begin with it. */
#define MPIRUN_RULE "--------------------------------------------------------------------------"

/* The last line of the log that a program of ours has said, else the last line. mpirun and argp add
 * theirs behind it. */
static void find_last_error(const char *log, char *last, size_t size)
{
    char line[1000];
    bool found = false, said = false;
    FILE *in = fopen(log, "r");
    while (in && fgets(line, sizeof line, in)) {
        line[strcspn(line, "\n")] = 0;
        if (said && !strcmp(line, MPIRUN_RULE))
            break;
        if (!*line || (found && (!is_error(line) || is_said_after(line, last))))
            continue;
        said = true;
        found = is_error(line);
        snprintf(last, size, "%s", line);
    }
    if (in)
        fclose(in);
}

/* status: of waitpid. `timeout` ends with 124 where it had to stop what it started. missing: what a
 * run that ended well has not left. */
static void note_failure(const struct compare *compare, int status, const char *missing,
                         struct compare_run *run)
{
    enum { TIMED_OUT = 124 };
    char log[PATH_MAX], kept[PATH_MAX], last[1000] = "it said nothing", how[200];
    snprintf(log, sizeof log, "%s/run.log", compare->folder);
    snprintf(kept, sizeof kept, "%s/failed.log", compare->folder);
    find_last_error(log, last, sizeof last);
    if (!compare->trace)
        rename(log, kept);
    if (WIFSIGNALED(status))
        snprintf(how, sizeof how, "signal %d", WTERMSIG(status));
    else if ((run->stopped = WEXITSTATUS(status) == TIMED_OUT))
        snprintf(how, sizeof how, "stopped after %u s (--timeout)", compare->timeout);
    else
        snprintf(how, sizeof how, "exit status %d%s%s", WEXITSTATUS(status),
                 missing ? ", but " : "", missing ? missing : "");
    if (asprintf(&run->why, "%s: %s", how, last) < 0)
        run->why = NULL;
}

size_t compare_failures(const struct compare *compare, const struct compare_config *config,
                        const struct compare_run **first)
{
    size_t n = 0;
    for (size_t r = 0; r < compare->rounds; r++) {
        const struct compare_run *run = &config->run[r];
        if (run->done && !run->fine && !n++)
            *first = run;
    }
    return n;
}

void compare_start(const struct compare *compare, const struct compare_config *config,
                   struct compare_run *run)
{
    struct line line = {0};
    char report[PATH_MAX], log[PATH_MAX], text[200];
    const char *missing = NULL;
    double seconds;
    snprintf(report, sizeof report, "%s/run.json", compare->folder);
    snprintf(log, sizeof log, "%s/run.log", compare->folder);
    unlink(report);
    *run = (struct compare_run){.done = true};
    make_line(compare, config, report, &line);
    const int status = execute(compare, config, &line, report, log, &seconds);
    if (!status)
        missing = figure_read(compare, report, log, seconds, run, text, sizeof text);
    if (!run->fine)
        note_failure(compare, status, missing, run);
    for (int i = 0; i < line.n; i++)
        free(line.word[i]);
}
