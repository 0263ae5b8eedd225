/* synthetic KIND HOSTS TRACE TASKS: a graph of tasks as a trace of one rank for duite-predict, and
 * as lines for simgrid.cpp: host; seconds; bytes that the task writes; how many tasks it reads, and
 * their numbers, from 0. Each task writes an object of its own; hosts have them as the mapping
 * block gives them, columns side by side. Rows of four columns a host: a task reads two of the row
 * before, its neighbours (stencil), or two far away (shuffle). */
#include "tests/support/trace_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 60, COLUMNS_OF_A_HOST = 4 };

struct synthetic {
    unsigned hosts, columns;
    int shuffles;
};

static unsigned mixed(unsigned row, unsigned column)
{
    return (row * 2654435761u + column * 40503u) >> 7 & 1023;
}

static uint32_t slot_of(unsigned row, unsigned column)
{
    return column * ROWS + row + 1;
}

static uint64_t bytes_of(unsigned row, unsigned column)
{
    return 200000 + 2000ull * mixed(column, row);
}

static void task_put(const struct synthetic *s, struct trace_file *trace, FILE *tasks, unsigned row,
                     unsigned column)
{
    const unsigned n = s->columns, far = s->shuffles ? n / 2 : 1;
    const unsigned reads[] = {(column + far) % n,
                              (s->shuffles ? column * 7 + 3 : column + n - 1) % n};
    const double seconds = 1e-3 + 4e-6 * mixed(row, column);
    const uint32_t slots[] = {slot_of(row ? row - 1 : 0, reads[0]),
                              slot_of(row ? row - 1 : 0, reads[1]), slot_of(row, column)};
    const size_t skip = row ? 0 : 2;
    trace_file_fork(trace, row ? FILE_RR_W : FILE_W, seconds, 0, 3 - skip, slots + skip);
    fprintf(tasks, "%u %.9f %llu", column / COLUMNS_OF_A_HOST, seconds,
            (unsigned long long)bytes_of(row, column));
    if (row)
        fprintf(tasks, " 2 %u %u\n", (row - 1) * n + reads[0], (row - 1) * n + reads[1]);
    else
        fputs(" 0\n", tasks);
}

int main(int argc, char **argv)
{
    struct trace_file trace = {0};
    if (argc != 5)
        return 2;
    struct synthetic s = {.hosts = (unsigned)strtoul(argv[2], NULL, 10),
                          .shuffles = !strcmp(argv[1], "shuffle")};
    FILE *tasks = fopen(argv[4], "w");
    if (!s.hosts || !tasks)
        return 1;
    s.columns = COLUMNS_OF_A_HOST * s.hosts;
    for (unsigned column = 0; column < s.columns; column++)
        for (unsigned row = 0; row < ROWS; row++)
            trace_file_object(&trace, slot_of(row, column), bytes_of(row, column));
    trace_file_begin(&trace, ROWS * s.columns);
    for (unsigned row = 0; row < ROWS; row++)
        for (unsigned column = 0; column < s.columns; column++)
            task_put(&s, &trace, tasks, row, column);
    return fclose(tasks) || !trace_file_write(&trace, argv[3]);
}
