/* A recorded graph as dot: the nodes and edges of its round, the same on any number of ranks,
 * whether a plan would be made of it or not. */
#include "runtime/plan/record.h"

#include "runtime/base/error.h"
#include "runtime/data/law.h"
#include "runtime/task/internal.h"

static void print_name(FILE *file, const char *name)
{
    for (; *name; name++) {
        if (*name == '"' || *name == '\\')
            fputc('\\', file);
        fputc(*name, file);
    }
}

static void print_use(const struct plan_record *record, size_t object, duite_mode mode, FILE *file)
{
    duite_object name = record->object[object].bound;
    fprintf(file, "\\n%s %u.%u", task_mode_name(mode), name.slot, name.generation);
}

static void print_fork(const struct plan_record *record, const struct plan_recorded_fork *fork,
                       FILE *file)
{
    bool sets = fork->kernel == PLAN_SETS;
    const duite_kernel *kernel = sets ? NULL : record->graph->kernels[fork->kernel];
    print_name(file, sets ? "duite_set" : kernel->name);
    if (fork->options.at >= 0)
        fprintf(file, "\\nat rank %d", fork->options.at);
    for (uint32_t k = 0; k < fork->n; k++) {
        duite_mode mode = sets ? DUITE_W : data_mode_of(kernel, k);
        print_use(record, record->access[fork->first + k].object, mode, file);
        if (task_immediate(mode) == DUITE_CW) {
            fputs(" ", file);
            print_name(file, data_law_of(kernel, k)->name);
        }
    }
}

static void print_round(const struct plan_record *record, const struct plan_round *round,
                        FILE *file)
{
    fputs("digraph duite {\n    node [shape=box];\n", file);
    for (size_t i = 0; i < round->n_nodes; i++) {
        const struct plan_round_node *node = &round->node[i];
        fprintf(file, "    n%zu [label=\"", i);
        if (node->kind == PLAN_SUM) {
            fputs("duite_sum", file);
            print_use(record, round->use[node->first_use].place, DUITE_RW, file);
        } else {
            print_fork(record, &record->fork[node->fork], file);
        }
        fputs(node->kind == PLAN_TASK ? "\"];\n" : "\", shape=ellipse];\n", file);
    }
    for (size_t i = 0; i < round->n_edges; i++) {
        const struct plan_round_edge *edge = &round->edge[i];
        fprintf(file, "    n%u -> n%u%s;\n", edge->from, edge->to,
                edge->cyclic ? " [style=dashed, constraint=false]" : "");
    }
    fputs("}\n", file);
}

int plan_record_print(const struct plan_record *record, FILE *file)
{
    struct plan_source source;
    struct plan_round round = {0};
    int code = DUITE_OK;
    if (!plan_record_source(record, NULL, &source) || !plan_lower(&round, &source) ||
        !plan_edges(&round))
        code = base_no_memory("a recorded graph");
    else
        print_round(record, &round, file);
    plan_round_free(&round);
    plan_source_free(&source);
    if (!code && (fflush(file) || ferror(file)))
        code = base_error(DUITE_E_SYSTEM, "duite_graph_print: the file cannot be written");
    return code;
}
