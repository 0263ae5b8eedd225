/* A recorded graph as dot: the nodes and edges of a draft, the same on any number of ranks, whether
 * a plan would be made of it or not. */
#include "runtime/plan/draft.h"

#include "runtime/base/error.h"
#include "runtime/data/law.h"
#include "runtime/data/mode.h"
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
    if (fork->how.at >= 0)
        fprintf(file, "\\nat rank %d", fork->how.at);
    for (uint32_t k = 0; k < fork->n; k++) {
        duite_mode mode = sets ? DUITE_W : data_mode_of(kernel, k);
        print_use(record, record->use[fork->first + k], mode, file);
        if (task_immediate(mode) == DUITE_CW) {
            fputs(" ", file);
            print_name(file, data_law_of(kernel, k)->name);
        }
    }
}

static void print_draft(const struct plan_draft *draft, FILE *file)
{
    const struct plan_record *record = draft->record;
    fputs("digraph duite {\n    node [shape=box];\n", file);
    for (size_t i = 0; i < draft->n_nodes; i++) {
        const struct plan_draft_node *node = &draft->node[i];
        fprintf(file, "    n%zu [label=\"", i);
        if (node->kind == TASK_NODE_SUM) {
            fputs("duite_sum", file);
            print_use(record, draft->use[node->first_use].place, DUITE_RW, file);
        } else if (node->kind == TASK_NODE_VIEW) {
            fputs("duite_view", file);
            print_use(record, draft->use[node->first_use].place, DUITE_R, file);
            print_use(record, draft->use[node->first_use + 1].place, DUITE_W, file);
        } else {
            print_fork(record, &record->fork[node->fork], file);
        }
        fputs(node->kind == TASK_NODE ? "\"];\n" : "\", shape=ellipse];\n", file);
    }
    for (size_t i = 0; i < draft->n_edges; i++) {
        const struct plan_draft_edge *edge = &draft->edge[i];
        fprintf(file, "    n%u -> n%u%s;\n", edge->from, edge->to,
                edge->cyclic ? " [style=dashed, constraint=false]" : "");
    }
    fputs("}\n", file);
}

int plan_record_print(const struct plan_record *record, FILE *file)
{
    struct plan_draft draft = {.record = record};
    int code = DUITE_OK;
    if (!plan_draft_make(&draft, record->n_objects, 0))
        code = base_no_memory("a recorded graph");
    else
        print_draft(&draft, file);
    plan_draft_free(&draft);
    if (!code && (fflush(file) || ferror(file)))
        code = base_error(DUITE_E_SYSTEM, "duite_graph_print: the file cannot be written");
    return code;
}
