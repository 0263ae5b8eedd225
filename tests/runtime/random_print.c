/* Programs as they are told to whoever looks for what went wrong: one line an operation. */

#include "tests/runtime/random_program.h"

void prog_print_element(duite_type type, const void *data, size_t i, char *text, size_t size)
{
    switch (type) {
    case DUITE_BYTE:
        snprintf(text, size, "%u", ((const uint8_t *)data)[i]);
        break;
    case DUITE_I32:
        snprintf(text, size, "%d", ((const int32_t *)data)[i]);
        break;
    case DUITE_I64:
        snprintf(text, size, "%lld", (long long)((const int64_t *)data)[i]);
        break;
    case DUITE_F32:
        snprintf(text, size, "%.9g (%a)", (double)((const float *)data)[i],
                 (double)((const float *)data)[i]);
        break;
    case DUITE_F64:
        snprintf(text, size, "%.17g (%a)", ((const double *)data)[i], ((const double *)data)[i]);
        break;
    }
}

static void print_graph(FILE *file, const struct prog_op *op)
{
    fprintf(file, " graph %u", op->graph);
    if (op->kind == PROG_REPLAY_WHILE || op->kind == PROG_GRAPH_BIND)
        fprintf(file, " object %u", op->object);
    if (op->kind == PROG_GRAPH_BIND)
        fprintf(file, " by %u", op->objects[0]);
    else if (op->kind != PROG_GRAPH_FREE)
        fprintf(file, ", %zu", op->count);
}

void prog_print(FILE *file, const struct prog *prog, size_t index)
{
    static const char *const KINDS[] = {
        "skip",         "new",    "free",       "set",        "fork",        "get",
        "get_at",       "count",  "wait",       "hint",       "follow",      "home",
        "wrong",        "graph",  "  fork",     "  set",      "graph again", "replay",
        "replay while", "rounds", "graph args", "graph bind", "graph free"};
    static const char *const TYPES[] = {"", "byte", "i32", "i64", "f32", "f64"};
    static const char *const MODES[] = {"", "r", "w", "rw", "cw"};
    static const char *const LAWS[] = {"", ",min:", ",max:", ",mix:", ",weave:"};
    const struct prog_op *op = &prog->ops[index];
    const int forks = op->kind == PROG_FORK || op->kind == PROG_GRAPH_FORK;
    const int sets = op->kind == PROG_SET || op->kind == PROG_GRAPH_SET;

    fprintf(file, "#   %3zu %s", index, KINDS[op->kind]);
    if (forks)
        fprintf(file, " task %u %s", op->number, prog->name[op->kernel]);
    else if (op->kind >= PROG_GRAPH && !sets)
        print_graph(file, op);
    else if (op->kind != PROG_WAIT)
        fprintf(file, " object %u", op->object);
    if (op->kind == PROG_NEW)
        fprintf(file, " %s x %zu", TYPES[op->type], op->count);
    if (op->max)
        fprintf(file, " of %zu", op->max);
    if (sets)
        fprintf(file, " x %zu", op->count);
    for (unsigned i = 0; (forks || op->kind < PROG_GRAPH) && i < op->n; i++)
        fprintf(file, " %s%s%u", forks ? MODES[prog_mode(&prog->kernel[op->kernel], i)] : "",
                forks ? LAWS[prog_law(&prog->kernel[op->kernel], i)] : "", op->objects[i]);
    if (op->kind == PROG_FOLLOW)
        fprintf(file, " leader %u", op->objects[0]);
    if (op->rank >= 0)
        fprintf(file, " at rank %d", op->rank);
    if (forks && op->cost >= 0)
        fprintf(file, " priority %d cost %g", (int)op->priority, op->cost);
    if (op->fails)
        fprintf(file, " fails with %d%s", op->fails, op->sometimes ? " sometimes" : "");
    if (op->exceeds)
        fprintf(file, " gives parameter %u too much", op->exceeds - 1);
    fputc('\n', file);
}
