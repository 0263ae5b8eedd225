/* One connection a process, one answer a command; a rank without a run of that name, or with a
 * wrong answer, says so and goes on. */
#include "bench/serve.h"

#include "tests/support/rank.h"

#include <sched.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

static char failure[400];

int serve_fail(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(failure, sizeof failure, format, list);
    va_end(list);
    return 1;
}

const char *serve_failure(void)
{
    return failure;
}

int serve_no_memory(void)
{
    return serve_fail("out of memory");
}

uint64_t serve_most_bytes(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) ? 0 : 1024 * (uint64_t)usage.ru_maxrss;
}

double serve_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The text behind " KEY=" in the request; NULL if nothing does. */
static const char *find(const struct serve_request *request, const char *key)
{
    size_t length = strlen(key);
    const char *word = request->text;
    while ((word = strchr(word, ' '))) {
        word++;
        if (!strncmp(word, key, length) && word[length] == '=')
            return word + length + 1;
    }
    return NULL;
}

uint64_t serve_number(struct serve_request *request, const char *key)
{
    const char *text = find(request, key);
    if (!text)
        request->missing = key;
    return text ? strtoull(text, NULL, 10) : 0;
}

void serve_word(const struct serve_request *request, const char *key, char *word, size_t size)
{
    const char *text = find(request, key);
    size_t length = text ? strcspn(text, " ") : 0;
    snprintf(word, size, "%.*s", (int)length, text ? text : "");
}

static int run(const struct serve_run *const *runs, void *context, const char *text, double *value)
{
    struct serve_request request = {.text = text};
    size_t length = strcspn(text, " ");
    for (; *runs; runs++)
        for (const struct serve_run *run = *runs; run->name; run++)
            if (strlen(run->name) == length && !strncmp(run->name, text, length)) {
                int code = run->run(context, &request, value);
                return request.missing ? serve_fail("the command lacks %s=", request.missing)
                                       : code;
            }
    return serve_fail("there is no run %.*s", (int)length, text);
}

/* The socket, for reading; answers are written to its descriptor. */
static FILE *connect_to(const char *path)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    if (!path || strlen(path) >= sizeof address.sun_path)
        return NULL;
    memcpy(address.sun_path, path, strlen(path) + 1);
    int wire = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (wire >= 0 && !connect(wire, (struct sockaddr *)&address, sizeof address))
        return fdopen(wire, "r");
    if (wire >= 0)
        close(wire);
    return NULL;
}

void serve_bind(int rank)
{
    cpu_set_t allowed, one;
    CPU_ZERO(&one);
    if (sched_getaffinity(0, sizeof allowed, &allowed) || CPU_COUNT(&allowed) <= rank)
        return;
    for (size_t core = 0, n = 0; core < CPU_SETSIZE; core++)
        if (CPU_ISSET(core, &allowed) && n++ == (size_t)rank)
            CPU_SET(core, &one);
    sched_setaffinity(0, sizeof one, &one);
}

int serve_wanted(void)
{
    return getenv("DUITE_BENCH_SOCKET") != NULL;
}

const char *serve_kind(void)
{
    const char *kind = getenv("DUITE_BENCH_KIND");
    return kind ? kind : "";
}

int serve(const char *settings, const struct serve_run *const *runs, void *context)
{
    const char *rank = rank_said();
    FILE *bench = connect_to(getenv("DUITE_BENCH_SOCKET"));
    if (!bench) {
        fprintf(stderr, "this program is started by duite-bench\n");
        return 2;
    }
    dprintf(fileno(bench), "hello %s %s\n", rank ? rank : "0", settings);
    char line[512];
    while (fgets(line, sizeof line, bench)) {
        double value = 0;
        line[strcspn(line, "\n")] = '\0';
        if (run(runs, context, line, &value))
            dprintf(fileno(bench), "failed %s\n", failure);
        else
            dprintf(fileno(bench), "ok %.17g\n", value);
    }
    fclose(bench);
    return 0;
}
