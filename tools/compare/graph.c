/* A graph grows task by task; every row leads to earlier tasks only, so there are no rings. */
#include "tools/compare/graph.h"

#include "runtime/duite_policy.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void compare_graph_free(struct compare_graph *graph)
{
    free(graph->cost);
    free(graph->bytes);
    free(graph->start);
    free(graph->from);
    free(graph->place);
    *graph = (struct compare_graph){0};
}

static bool grow(void *array, size_t capacity, size_t size)
{
    void *moved = realloc(*(void **)array, capacity * size);
    if (moved)
        *(void **)array = moved;
    return moved != NULL;
}

static bool room(struct compare_graph *graph, size_t reads)
{
    if (graph->n + 2 > graph->capacity) {
        size_t more = 2 * graph->capacity + 64;
        if (!grow(&graph->cost, more, sizeof *graph->cost) ||
            !grow(&graph->bytes, more, sizeof *graph->bytes) ||
            !grow(&graph->place, more, sizeof *graph->place) ||
            !grow(&graph->start, more, sizeof *graph->start))
            return false;
        graph->capacity = more;
        graph->start[0] = 0;
    }
    if (graph->n_reads + reads <= graph->reads_capacity)
        return true;
    size_t more = 2 * graph->reads_capacity + 64 + reads;
    if (!grow(&graph->from, more, sizeof *graph->from))
        return false;
    graph->reads_capacity = more;
    return true;
}

/* Reads a task once, however often it is named; -1: none. */
static void add(struct compare_graph *graph, double cost, uint32_t bytes, size_t n,
                const int64_t *reads)
{
    if (!room(graph, n))
        return; /* told by who looks at the number of tasks */
    size_t first = graph->n_reads;
    for (size_t k = 0; k < n; k++) {
        bool seen = reads[k] < 0;
        for (size_t j = first; j < graph->n_reads; j++)
            seen |= graph->from[j] == reads[k];
        if (!seen)
            graph->from[graph->n_reads++] = (uint32_t)reads[k];
    }
    graph->cost[graph->n] = cost;
    graph->place[graph->n] = COMPARE_NO_PLACE;
    graph->bytes[graph->n++] = bytes;
    graph->start[graph->n] = graph->n_reads;
}

size_t compare_graph_most_reads(const struct compare_graph *graph)
{
    size_t most = 0;
    for (size_t i = 0; i < graph->n; i++)
        if (most < graph->start[i + 1] - graph->start[i])
            most = graph->start[i + 1] - graph->start[i];
    return most;
}

/* ---- Kinds ---- */

enum { MOST_READS = 5, SPREAD = 5, MOST_WIDTH = 1000000 };

struct make {
    const struct kind *kind;
    struct compare_graph *graph;
    size_t n;
    int64_t width; /* of rows; 0: as long as there are */
    double cost;
    uint32_t bytes;
    uint64_t random;
};

struct kind {
    const char *name;
    void (*make)(struct make *make);
    int64_t most; /* reads of a task, in rows and at random */
    /* The k-th column that column x of row y reads of the row before; columns outside are none. */
    int64_t (*column)(int64_t k, int64_t x, int64_t y, int64_t width);
    double decades; /* that costs are spread over */
};

static int64_t stencil(int64_t k, int64_t x, int64_t y, int64_t width)
{
    (void)y, (void)width;
    return x + k - 1;
}

static int64_t nearest(int64_t k, int64_t x, int64_t y, int64_t width)
{
    (void)y, (void)width;
    return x + k - 2;
}

static int64_t fft(int64_t k, int64_t x, int64_t y, int64_t width)
{
    int64_t levels = 1;
    while ((int64_t)1 << levels < width)
        levels++;
    return x + (k - 1) * ((int64_t)1 << y % levels);
}

static int64_t spread(int64_t k, int64_t x, int64_t y, int64_t width)
{
    return (x + k * width / SPREAD + (k ? y % 3 : 0)) % width;
}

static void make_rows(struct make *make)
{
    const int64_t width = make->width ? make->width : (int64_t)sqrt((double)make->n);
    const int64_t rows = (int64_t)make->n / width, n = make->kind->most;
    for (int64_t i = 0; i < width * (rows ? rows : 1); i++) {
        int64_t reads[MOST_READS];
        for (int64_t k = 0; k < n; k++) {
            const int64_t column = make->kind->column(k, i % width, i / width, width);
            const bool none = i < width || column < 0 || column >= width;
            reads[k] = none ? -1 : (i / width - 1) * width + column;
        }
        add(make->graph, make->cost, make->bytes, (size_t)n, reads);
    }
}

static void make_tree(struct make *make)
{
    size_t leaves = (make->n + 1) / 2;
    for (size_t i = 0; i < leaves; i++)
        add(make->graph, make->cost, make->bytes, 0, NULL);
    for (size_t i = 0; i + 1 < leaves; i++)
        add(make->graph, make->cost, make->bytes, 2,
            (const int64_t[]){(int64_t)(2 * i), (int64_t)(2 * i + 1)});
}

/* The task that wrote a tile last; each step of the algorithm reads it first. */
static void tile_step(struct make *make, int64_t *last, double work, int64_t a, int64_t b)
{
    int64_t own = (int64_t)make->graph->n;
    add(make->graph, make->cost * work, make->bytes, 3, (const int64_t[]){*last, a, b});
    *last = own;
}

static void make_cholesky(struct make *make)
{
    size_t t = 2;
    while ((t + 1) * (t + 2) * (t + 3) / 6 <= make->n)
        t++;
    int64_t *last = malloc(t * t * sizeof *last);
    for (size_t i = 0; last && i < t * t; i++)
        last[i] = -1;
    double unit = 0.55; /* so that the mean is about 1 */
    for (size_t k = 0; last && k < t; k++) {
        int64_t *pivot = &last[k * t + k];
        tile_step(make, pivot, unit / 3, -1, -1);
        for (size_t i = k + 1; i < t; i++)
            tile_step(make, &last[i * t + k], unit, *pivot, -1);
        for (size_t i = k + 1; i < t; i++) {
            tile_step(make, &last[i * t + i], unit, last[i * t + k], -1);
            for (size_t j = k + 1; j < i; j++)
                tile_step(make, &last[i * t + j], 2 * unit, last[i * t + k], last[j * t + k]);
        }
    }
    free(last);
}

static double toss(struct make *make)
{
    return (double)(duite_random(&make->random) >> 11) * 0x1p-53;
}

static void make_random(struct make *make)
{
    const double decades = make->kind->decades;
    size_t reach = 2 * (size_t)sqrt((double)make->n) + 1;
    double mean = decades > 0 ? (pow(10, decades) - 1) / (decades * log(10)) : 1;
    for (size_t i = 0; i < make->n; i++) {
        int64_t reads[MOST_READS];
        size_t n = i ? (size_t)(toss(make) * (double)(make->kind->most + 1)) : 0;
        for (size_t k = 0; k < n; k++)
            reads[k] = (int64_t)(i - 1) - (int64_t)(toss(make) * (double)(i < reach ? i : reach));
        double cost = make->cost * pow(10, decades * toss(make)) / mean;
        add(make->graph, cost, make->bytes, n, reads);
    }
}

/* The chain comes last, in a third of the time that two workers need for all of it. */
static void make_chain(struct make *make)
{
    size_t length = make->n / 3;
    for (size_t i = 0; i < make->n - length; i++)
        add(make->graph, make->cost, make->bytes, 0, NULL);
    for (size_t i = 0; i < length; i++)
        add(make->graph, make->cost, make->bytes, i > 0,
            (const int64_t[]){(int64_t)make->graph->n - 1});
}

static const struct kind KINDS[] = {
    {"stencil", make_rows, 3, stencil, 0}, {"nearest", make_rows, 5, nearest, 0},
    {"fft", make_rows, 3, fft, 0},         {"spread", make_rows, SPREAD, spread, 0},
    {"tree", make_tree, 2, NULL, 0},       {"cholesky", make_cholesky, 3, NULL, 0},
    {"random", make_random, 3, NULL, 0},   {"irregular", make_random, 5, NULL, 2},
    {"chain", make_chain, 1, NULL, 0}};

/* KIND, or KIND:WIDTH if it has rows. */
static const struct kind *find_kind(const char *name, int64_t *width)
{
    const size_t length = strcspn(name, ":");
    char *end = "";
    *width = name[length] ? strtol(name + length + 1, &end, 10) : 0;
    if (*end || (name[length] && (*width < 1 || *width > MOST_WIDTH)))
        return NULL;
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++)
        if (strlen(KINDS[i].name) == length && !strncmp(KINDS[i].name, name, length))
            return *width && !KINDS[i].column ? NULL : &KINDS[i];
    return NULL;
}

int compare_graph_make(struct compare_graph *graph, const char *kind, size_t n, double cost,
                       uint32_t bytes, uint64_t seed)
{
    struct make make = {
        .graph = graph, .n = n < 4 ? 4 : n, .cost = cost, .bytes = bytes, .random = seed};
    make.kind = find_kind(kind, &make.width);
    if (make.kind)
        make.kind->make(&make);
    if (!graph->n)
        fprintf(stderr, "there is no kind of graph %s, or no memory for it\n", kind);
    return !graph->n;
}

bool compare_graph_is_file(const char *what)
{
    return strchr(what, '.') || strchr(what, '/');
}

const char *compare_graph_wrong(const char *what, char *text, size_t size)
{
    if (compare_graph_is_file(what)) {
        if (access(what, R_OK) == 0)
            return NULL;
        snprintf(text, size, "%s: %s", what, strerror(errno));
        return text;
    }
    int64_t width;
    if (find_kind(what, &width))
        return NULL;
    snprintf(
        text, size,
        "there is no kind of graph %.60s; known are " COMPARE_GRAPH_KINDS
        ", and files by a name with a . or / in it; the first four take a width of rows from 1 "
        "to %d, as stencil:16",
        what, MOST_WIDTH);
    return text;
}

/* ---- Files ---- */

static bool take_number(const char **line, uint64_t below, uint64_t *value)
{
    char *end;
    const char *text = *line + strspn(*line, " ");
    *value = strtoull(text, &end, 10);
    *line = end;
    return *text >= '0' && *text <= '9' && *value < below;
}

static bool take_cost(const char **line, double *cost)
{
    char *end;
    *cost = strtod(*line, &end);
    bool fine = end != *line && *cost >= 0 && *cost < 3600;
    *line = end;
    return fine;
}

/* The end of a line: a place, or nothing. */
static bool take_place(const char *line, uint64_t below, uint32_t *place)
{
    uint64_t number = COMPARE_NO_PLACE;
    line += strspn(line, " ");
    if (*line == '@' && (line++, !take_number(&line, below, &number)))
        return false;
    *place = (uint32_t)number;
    return line[strspn(line, " \n")] == 0;
}

static int read_task(struct compare_graph *graph, const char *line)
{
    double cost;
    uint64_t bytes, n, task;
    uint32_t place = COMPARE_NO_PLACE;
    /* A task reads each of those before it once at most. */
    if (!take_cost(&line, &cost) || !take_number(&line, (uint64_t)1 << 32, &bytes) ||
        !take_number(&line, graph->n + 1, &n))
        return 1;
    int64_t *reads = malloc((n + 1) * sizeof *reads);
    bool fine = reads != NULL;
    for (size_t i = 0; i < n && fine; i++) {
        fine = take_number(&line, graph->n, &task);
        reads[i] = (int64_t)task;
    }
    fine = fine && take_place(line, graph->n + 1, &place);
    size_t before = graph->n;
    if (fine)
        add(graph, cost, (uint32_t)bytes, n, reads);
    free(reads);
    if (graph->n == before)
        return 1;
    graph->place[before] = place;
    return 0;
}

int compare_graph_read(struct compare_graph *graph, const char *file)
{
    char *line = NULL;
    size_t number = 1, room = 0;
    FILE *in = fopen(file, "r");
    bool fine = in && getline(&line, &room, in) > 0 && !strcmp(line, "duite-graph 1\n");
    while (fine && getline(&line, &room, in) > 0) {
        number++;
        fine = strchr(line, '\n') && (line[0] == '#' || !read_task(graph, line));
    }
    if (!in)
        fprintf(stderr, "%s: %s\n", file, strerror(errno));
    else if (!fine || !graph->n)
        fprintf(stderr, "%s:%zu: %s\n", file, number,
                number == 1 ? "no graph of version 1, or an empty one"
                            : "cost, bytes, number of reads, tasks before it, and maybe @ and a "
                              "place are expected");
    free(line);
    if (in)
        fclose(in);
    return !fine || !graph->n;
}

int compare_graph_write(const struct compare_graph *graph, const char *file)
{
    FILE *out = fopen(file, "w");
    if (out)
        fputs("duite-graph 1\n", out);
    for (size_t i = 0; out && i < graph->n; i++) {
        fprintf(out, "%.9g %u %zu", graph->cost[i], (unsigned)graph->bytes[i],
                graph->start[i + 1] - graph->start[i]);
        for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++)
            fprintf(out, " %u", (unsigned)graph->from[k]);
        if (graph->place[i] != COMPARE_NO_PLACE)
            fprintf(out, " @ %u", (unsigned)graph->place[i]);
        fputc('\n', out);
    }
    bool whole = out && !ferror(out);
    if (out && fclose(out))
        whole = false;
    if (!whole)
        fprintf(stderr, "%s: %s\n", file, strerror(errno));
    return !whole;
}
