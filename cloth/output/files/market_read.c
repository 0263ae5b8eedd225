/* A system that was written before, from its files: entries are put in the order of their blocks,
 * so that any order of lines will do. What a diagonal block has besides the blocks beside it, and
 * is no multiple of I, ties its vertex to one that is held. */
#include "cloth/output/files/files.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct reader {
    char *path, *line;
    FILE *file;
    size_t room;
    unsigned long number; /* of the line */
    struct cloth_error *error;
};

/* Of the matrix, lower triangle. */
struct entry {
    uint32_t row, column;
    double value;
};

static int bad(const struct reader *reader, const char *what)
{
    return cloth_fail(reader->error, CLOTH_E_INPUT, "%s:%lu: %s", reader->path, reader->number,
                      what);
}

/* The next line that is no comment. */
static int next(struct reader *reader)
{
    do {
        reader->number++;
        if (getline(&reader->line, &reader->room, reader->file) < 0)
            return ferror(reader->file) ? output_fail(reader->error, "read", reader->path)
                                        : bad(reader, "the file ends here");
    } while (*reader->line == '%' && reader->number > 1);
    return CLOTH_OK;
}

static int open_file(struct reader *reader, const char *folder, const char *name,
                     const char *banner)
{
    reader->number = 0;
    reader->path = output_path(folder, name, ".mtx");
    if (!reader->path)
        return cloth_fail(reader->error, CLOTH_E_MEMORY, "no memory to read %s.mtx", name);
    reader->file = fopen(reader->path, "r");
    if (!reader->file)
        return output_refuse(reader->error, "read", reader->path);
    const int code = next(reader);
    if (code || !strncmp(reader->line, banner, strlen(banner)))
        return code ? code : next(reader);
    return cloth_fail(reader->error, CLOTH_E_INPUT, "%s:1: '%s' is expected", reader->path, banner);
}

static void close_file(struct reader *reader)
{
    if (reader->file)
        fclose(reader->file);
    free(reader->path);
    reader->file = NULL;
    reader->path = NULL;
}

/* ---- Vectors ---- */

/* n x 3 numbers. */
static int read_array(struct reader *reader, const char *folder, const char *name, uint32_t n,
                      double *value)
{
    unsigned long long rows = 0;
    int columns = 0;
    int code = open_file(reader, folder, name, "%%MatrixMarket matrix array real general");
    if (!code && (sscanf(reader->line, "%llu %d", &rows, &columns) != 2 ||
                  rows != 3 * (unsigned long long)n || columns != 1))
        code = bad(reader, "as many rows as the matrix has and one column are expected");
    for (size_t i = 0; i < rows && !code; i++) {
        char *end;
        code = next(reader);
        if (code)
            break;
        value[i] = strtod(reader->line, &end);
        if (end == reader->line || !isfinite(value[i]))
            code = bad(reader, "a finite number is expected");
    }
    close_file(reader);
    return code;
}

/* ---- The matrix ---- */

static int compare(const void *va, const void *vb)
{
    const struct entry *a = va, *b = vb;
    const uint32_t key[][2] = {{a->column / 3, b->column / 3},
                               {a->row / 3, b->row / 3},
                               {a->column, b->column},
                               {a->row, b->row}};
    for (int i = 0; i < 4; i++)
        if (key[i][0] != key[i][1])
            return key[i][0] < key[i][1] ? -1 : 1;
    return 0;
}

static int read_entry(struct reader *reader, uint32_t rows, struct entry *entry)
{
    unsigned long row, column;
    const int code = next(reader);
    if (code)
        return code;
    if (sscanf(reader->line, "%lu %lu %lf", &row, &column, &entry->value) != 3 || row > rows ||
        column < 1 || row < column || !isfinite(entry->value))
        return bad(reader, "a row, a column not above the diagonal and a finite number are "
                           "expected");
    entry->row = (uint32_t)(row - 1);
    entry->column = (uint32_t)(column - 1);
    return CLOTH_OK;
}

/* All entries, in order. The caller frees them. */
static int read_entries(struct reader *reader, const char *folder, uint32_t *n,
                        struct entry **entries, size_t *n_entries)
{
    unsigned long rows = 0, columns = 0;
    *entries = NULL;
    int code =
        open_file(reader, folder, "matrix", "%%MatrixMarket matrix coordinate real symmetric");
    if (!code && (sscanf(reader->line, "%lu %lu %zu", &rows, &columns, n_entries) != 3 ||
                  rows != columns || rows % 3 || rows > UINT32_MAX - 3))
        code = bad(reader, "three equal rows and columns a vertex, and a number of entries, are "
                           "expected");
    if (!code && !(*entries = calloc(*n_entries + 1, sizeof **entries)))
        code = cloth_fail(reader->error, CLOTH_E_MEMORY, "no memory for %zu entries", *n_entries);
    for (size_t i = 0; i < *n_entries && !code; i++)
        code = read_entry(reader, (uint32_t)rows, *entries + i);
    if (!code)
        qsort(*entries, *n_entries, sizeof **entries, compare);
    *n = (uint32_t)rows / 3;
    close_file(reader);
    return code;
}

/* Whether an entry is the first one of its block. */
static bool opens(const struct entry *entry, size_t i)
{
    return i == 0 || entry[i].column / 3 != entry[i - 1].column / 3 ||
           entry[i].row / 3 != entry[i - 1].row / 3;
}

static size_t count_pairs(const struct entry *entry, size_t n)
{
    size_t pairs = 0;
    for (size_t i = 0; i < n; i++)
        pairs += opens(entry, i) && entry[i].row / 3 != entry[i].column / 3;
    return pairs;
}

/* Blocks beside the diagonal become pairs, those on it `own`. */
static void put_entries(const struct entry *entry, size_t n, struct solve_system *system,
                        double (*own)[9])
{
    system->n_pairs = 0;
    for (size_t i = 0; i < n; i++) {
        const uint32_t a = entry[i].column / 3, b = entry[i].row / 3;
        const uint32_t c = entry[i].column % 3, r = entry[i].row % 3;
        if (a == b) {
            own[a][3 * r + c] = own[a][3 * c + r] = entry[i].value;
            continue;
        }
        if (opens(entry, i)) {
            system->end[system->n_pairs][0] = a;
            system->end[system->n_pairs++][1] = b;
        }
        system->block[system->n_pairs - 1][3 * c + r] = -entry[i].value;
    }
}

/* ---- What is left on the diagonal ---- */

/* Takes the symmetric part of each pair from its ends; marks those. */
static void take_pairs(const struct solve_system *system, double (*own)[9], unsigned char *met)
{
    for (size_t i = 0; i < system->n_pairs; i++)
        for (int k = 0; k < 2; k++) {
            const uint32_t v = system->end[i][k];
            met[v] = 1;
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++)
                    own[v][3 * r + c] -=
                        0.5 * (system->block[i][3 * r + c] + system->block[i][3 * c + r]);
        }
}

/* Whether what is left is a positive multiple of I, up to rounding of so large numbers. */
static bool is_scalar(const double left[9], double size, double *scalar)
{
    const double rounding = 1e-13 * size;
    *scalar = (left[0] + left[4] + left[8]) / 3;
    bool same = *scalar > rounding;
    for (int i = 0; i < 9; i++)
        same = same && fabs(left[i] - (i % 4 ? 0 : *scalar)) <= rounding;
    return same;
}

/* The last vertex is the one that others are tied to. */
static void put_diagonal(struct solve_system *system, const double (*left)[9], const double *size,
                         const unsigned char *met)
{
    const uint32_t held = system->n - 1;
    for (uint32_t v = 0; v < held; v++) {
        double scalar = system->mass[v];
        if (!(system->free[v] > 0))
            continue;
        const bool alone = is_scalar(left[v], size[v], &scalar);
        system->diagonal[v] = alone ? scalar : system->mass[v];
        if (alone && met[v])
            continue;
        double *n = system->block[system->n_pairs];
        for (int i = 0; i < 9; i++)
            n[i] = alone ? 0 : left[v][i] - (i % 4 ? 0 : system->mass[v]);
        system->end[system->n_pairs][0] = v;
        system->end[system->n_pairs++][1] = held;
    }
}

static int make(struct solve_system *system, const struct entry *entry, size_t n_entries,
                struct cloth_error *error)
{
    const uint32_t n = system->n;
    double(*own)[9] = calloc(n, sizeof *own), *size = calloc(n, sizeof *size);
    unsigned char *met = calloc(n, 1);
    int code =
        own && size && met ? CLOTH_OK : cloth_fail(error, CLOTH_E_MEMORY, "no memory for a matrix");
    if (!code) {
        put_entries(entry, n_entries, system, own);
        for (uint32_t v = 0; v < n; v++)
            size[v] = fmax(own[v][0], fmax(own[v][4], own[v][8]));
        take_pairs(system, own, met);
        put_diagonal(system, (const double(*)[9])own, size, met);
        code = solve_system_sort(system, error);
    }
    free(own);
    free(size);
    free(met);
    return code;
}

static int read_vectors(struct reader *reader, const char *folder, struct solve_system *system)
{
    const uint32_t n = system->n - 1;
    int code = read_array(reader, folder, "mass", n, system->v);
    for (uint32_t v = 0; v < n && !code; v++) {
        system->mass[v] = system->v[3 * (size_t)v];
        system->free[v] = system->mass[v] > 0;
    }
    memset(system->v, 0, 3 * (size_t)n * sizeof *system->v);
    if (!code)
        code = read_array(reader, folder, "rhs", n, system->b);
    if (!code)
        code = read_array(reader, folder, "solution", n, system->dv);
    return code ? code : read_array(reader, folder, "position", n, system->x);
}

int output_system_read(const char *folder, struct solve_system *system, struct cloth_error *error)
{
    struct reader reader = {.error = error};
    struct entry *entry = NULL;
    size_t n_entries = 0;
    uint32_t n = 0;
    *system = (struct solve_system){0};
    int code = read_entries(&reader, folder, &n, &entry, &n_entries);
    if (!code)
        code = solve_system_make(system, n + 1, count_pairs(entry, n_entries) + n,
                                 SOLVE_PAIRS_OF_BLOCKS, error);
    if (!code)
        code = read_vectors(&reader, folder, system);
    if (!code)
        code = make(system, entry, n_entries, error);
    if (code)
        solve_system_free(system);
    free(entry);
    free(reader.line);
    return code;
}
