/* Programs in readable form, to find what went wrong: one line an operation, with the calls of its
 * body. */

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
    case DUITE_U16:
        snprintf(text, size, "%u", ((const uint16_t *)data)[i]);
        break;
    case DUITE_CF64:
        snprintf(text, size, "%a, %a", ((const double *)data)[2 * i],
                 ((const double *)data)[2 * i + 1]);
        break;
    default:
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

static void print_fork(FILE *file, const struct prog *prog, const struct prog_op *op)
{
    static const char *const MODES[] = {"", "r", "w", "rw", "cw", "rp", "wp", "rwp", "cwp"};
    static const char *const LAWS[] = {"", ",min:", ",max:", ",mix:", ",weave:"};
    const duite_kernel *kernel = &prog->kernel[op->kernel];

    fprintf(file, " task %u %s", op->number, kernel->name);
    for (unsigned i = 0; i < op->n; i++)
        fprintf(file, " %s%s%u", MODES[prog_mode(kernel, i)], LAWS[prog_law(kernel, i)],
                op->objects[i]);
    if (op->rank >= 0)
        fprintf(file, " at rank %d", op->rank);
    if (op->cost >= 0)
        fprintf(file, " priority %d cost %g", (int)op->priority, op->cost);
    if (op->fails)
        fprintf(file, " fails with %d%s", op->fails, op->sometimes ? " sometimes" : "");
    if (op->exceeds)
        fprintf(file, " gives parameter %u too much", op->exceeds - 1);
}

static void print_object(FILE *file, const struct prog_op *op)
{
    static const char *const TYPES[] = {
        [DUITE_BYTE] = "byte", [DUITE_I32] = "i32", [DUITE_I64] = "i64",   [DUITE_F32] = "f32",
        [DUITE_F64] = "f64",   [DUITE_U16] = "u16", [DUITE_CF64] = "cf64",
    };

    fprintf(file, " object %u", op->object);
    if (op->kind == PROG_NEW)
        fprintf(file, " %s", TYPES[op->type]);
    if (op->kind == PROG_NEW || op->kind == PROG_SET || op->kind == PROG_GRAPH_SET)
        fprintf(file, " x %zu", op->count);
    if (op->max)
        fprintf(file, " of %zu", op->max);
    for (unsigned i = 0; i < op->n; i++)
        fprintf(file, " %u", op->objects[i]);
    if (op->kind == PROG_ACQUIRE)
        fprintf(file, " %s", op->mode == DUITE_R ? "r" : op->mode == DUITE_W ? "w" : "rw");
    if (op->kind == PROG_FOLLOW)
        fprintf(file, " leader %u", op->objects[0]);
    if (op->rank >= 0)
        fprintf(file, " at rank %d", op->rank);
}

static void print_operation(FILE *file, const struct prog *prog, const struct prog_op *op,
                            int indent)
{
    static const char *const KINDS[] = {
        "skip",         "new",    "free",       "set",        "fork",      "get",         "get_at",
        "count",        "wait",   "wait_for",   "test",       "get begin", "get end",     "kernel",
        "contribute",   "hint",   "follow",     "home",       "wrong",     "acquire",     "release",
        "split",        "join",   "graph",      "  fork",     "  set",     "graph again", "replay",
        "replay while", "rounds", "graph args", "graph bind", "graph free"};

    fprintf(file, "%*s%s", indent, "", KINDS[op->kind]);
    if (prog_is_fork(op))
        print_fork(file, prog, op);
    else if (op->kind == PROG_KERNEL)
        fprintf(file, " %s", prog->name[op->kernel]);
    else if (op->kind >= PROG_GRAPH && op->kind != PROG_GRAPH_SET)
        print_graph(file, op);
    else if (op->kind != PROG_WAIT)
        print_object(file, op);
    fputc('\n', file);
    for (size_t i = 0; prog_is_fork(op) && i < op->n_inner; i++) {
        fprintf(file, "#       ");
        print_operation(file, prog, &prog->inner[op->body + i], indent + 4);
    }
}

void prog_print(FILE *file, const struct prog *prog, size_t index)
{
    fprintf(file, "#   %3zu ", index);
    print_operation(file, prog, &prog->ops[index], 0);
}
