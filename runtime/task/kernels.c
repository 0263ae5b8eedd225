/* The kernels of a graph: what each fork of them needs is found out once. Indices never change, so
 * tasks, recorded graphs and traces keep them. Kernels that are added later move the arrays, when
 * no task is left and nobody else looks. */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <string.h>

_Static_assert(sizeof(duite_kernel) <= 128, "a kernel takes two cache lines");

/* A replicated kernel leaves the same values on all ranks, and has no other effect. */
static int kernel_check_replicated(const duite_kernel *kernel)
{
    const char *why = kernel->side_effects ? "has side effects"
                      : kernel->events     ? "has events, which would complete once for each rank"
                                           : NULL;
    for (uint32_t i = 0; i <= DUITE_MAX_ACCESS && !why; i++) {
        duite_mode mode = i < DUITE_MAX_ACCESS ? (duite_mode)kernel->access[i] : kernel->variadic;
        if (mode == DUITE_CW)
            why = "accumulates (cw), which would count once for each rank";
        else if (task_postponed(mode))
            why = "has a postponed mode: its children would run once for each rank";
    }
    return kernel->replicated && why
               ? base_error(DUITE_E_KERNEL, "kernel %s is replicated, but %s", kernel->name, why)
               : DUITE_OK;
}

static int kernel_check(const duite_kernel *kernel, uint32_t index, struct task_fixed *fixed)
{
    if (!kernel->name || !kernel->name[0])
        return base_error(DUITE_E_KERNEL, "kernel %u of the list has no name", index);
    if (!kernel->body)
        return base_error(DUITE_E_KERNEL, "kernel %s has no body", kernel->name);
    *fixed = (struct task_fixed){.kernel = kernel,
                                 .index = index,
                                 .hash = task_fork_hash(task_fork_what(index, TASK_ANYWHERE)),
                                 .few = kernel->variadic == DUITE_NONE && !kernel->replicated &&
                                        !kernel->events};
    bool contributes = false;
    for (uint32_t i = 0; i < DUITE_MAX_ACCESS; i++) {
        duite_mode mode = (duite_mode)kernel->access[i];
        if (mode > DUITE_CWP)
            return base_error(DUITE_E_KERNEL, "kernel %s: parameter %u has no such mode: %d",
                              kernel->name, i, (int)mode);
        if (mode != DUITE_NONE && i != fixed->n)
            return base_error(DUITE_E_KERNEL, "kernel %s: parameter %u has a mode after DUITE_NONE",
                              kernel->name, i);
        fixed->n += mode != DUITE_NONE;
        fixed->postponed += task_postponed(mode);
        fixed->few &= !task_postponed(mode);
        contributes |= mode == DUITE_CW;
    }
    if ((int)kernel->variadic < DUITE_NONE || kernel->variadic > DUITE_CWP)
        return base_error(DUITE_E_KERNEL, "kernel %s: `variadic` has no such mode: %d",
                          kernel->name, (int)kernel->variadic);
    const size_t grains = task_grains(fixed->n, kernel->args_size);
    fixed->few &= fixed->n <= TASK_FEW && grains <= UINT32_MAX;
    fixed->plain = fixed->few && !contributes;
    fixed->grains = (uint32_t)grains;
    fixed->owner[0] = task_owner(kernel->access, kernel->variadic, fixed->n);
    fixed->owner[1] = task_owner(kernel->access, kernel->variadic, (size_t)fixed->n + 1);
    return kernel_check_replicated(kernel);
}

static int kernel_check_unique(const duite_kernel *const kernels[], uint32_t index)
{
    for (uint32_t i = 0; i < index; i++)
        if (!strcmp(kernels[i]->name, kernels[index]->name))
            return base_error(DUITE_E_KERNEL, "two kernels of the list have the name %s",
                              kernels[i]->name);
    return DUITE_OK;
}

/* Finds out once what each fork of a plain kernel needs. */
static int kernel_prepare(const struct task_graph *graph, struct task_fixed *fixed)
{
    const uint32_t n = fixed->n;
    struct task *head;
    if (!fixed->plain)
        return DUITE_OK;
    fixed->direct = graph->n_ranks == 1;
    fixed->head = head = base_alloc(sizeof *head + n * sizeof head->access[0]);
    if (!head)
        return base_no_memory("the list of kernels");
    *head = (struct task){.pending = n + 1,
                          .n = n,
                          .kernel = fixed->index,
                          .grains = fixed->grains,
                          .type = TASK_BODY,
                          .placed = fixed->owner[0] != TASK_NOBODY};
    for (uint32_t i = 0; i < n; i++)
        head->access[i] = (struct task_access){
            .waiter = {.back = (uint32_t)(sizeof *head + i * sizeof head->access[0]),
                       .mode = fixed->kernel->access[i]}};
    return DUITE_OK;
}

/* ---- Lists ---- */

struct kernel_lists {
    const duite_kernel **kernels;
    struct task_fixed *fixed, **place;
    const duite_law **laws;
    uint32_t mask;
};

static void lists_free(const struct kernel_lists *lists)
{
    base_free(lists->fixed);
    base_free(lists->kernels);
    base_free(lists->place);
    base_free(lists->laws);
}

/* The places of n kernels by their addresses; at most half of them are taken. NULL without
 * memory. */
static struct task_fixed **kernels_index(struct task_fixed *fixed, uint32_t n, uint32_t *mask)
{
    *mask = 3;
    while (*mask < 2 * (uint64_t)n)
        *mask = 2 * *mask + 1;
    struct task_fixed **place = base_alloc_zero(((size_t)*mask + 1) * sizeof *place);
    for (uint32_t i = 0; i < n && place; i++) {
        uint32_t at = task_kernel_hash(fixed[i].kernel);
        while (place[at & *mask])
            at++;
        place[at & *mask] = &fixed[i];
    }
    return place;
}

/* A list of laws with those that a kernel names and it has not; NULL ends both, `laws` may be NULL.
 * NULL without memory. */
static const duite_law **laws_with(const duite_law *const *laws, const duite_kernel *kernel)
{
    size_t n = 0;
    while (laws && laws[n])
        n++;
    const size_t listed = kernel ? data_modes_listed(kernel) : 0, more = kernel ? listed + 1 : 0;
    const duite_law **all = base_alloc((n + more + 1) * sizeof *all);
    if (!all)
        return NULL;
    memcpy(all, laws ? (const void *)laws : all, n * sizeof *all);
    for (size_t i = 0; i < more; i++) {
        const duite_law *law = i < listed ? data_law_named(kernel, i) : kernel->variadic_law;
        size_t k = 0;
        while (k < n && all[k] != law)
            k++;
        if (law && k == n)
            all[n++] = law;
    }
    all[n] = NULL;
    return all;
}

int task_kernels_start(struct task_graph *graph, const duite_kernel *const *kernels,
                       const duite_law *const *laws)
{
    size_t n = 0;
    while (kernels[n])
        n++;
    graph->laws = laws_with(laws, NULL);
    graph->kernels = base_alloc(n * sizeof graph->kernels[0]);
    graph->fixed = base_alloc_zero(n * sizeof *graph->fixed);
    if (!graph->laws || !graph->kernels || !graph->fixed)
        return base_no_memory("the list of kernels");
    memcpy(graph->kernels, kernels, n * sizeof graph->kernels[0]);
    graph->n_kernels = (uint32_t)n;
    for (uint32_t i = 0; i < n; i++) {
        int code = kernel_check(graph->kernels[i], i, &graph->fixed[i]);
        if (!code)
            code = kernel_check_unique(graph->kernels, i);
        if (!code)
            code = data_law_check_kernel(graph->kernels[i], graph->laws);
        if (!code)
            code = kernel_prepare(graph, &graph->fixed[i]);
        if (code)
            return code;
    }
    graph->kernel_place = kernels_index(graph->fixed, graph->n_kernels, &graph->kernel_mask);
    return graph->kernel_place ? DUITE_OK : base_no_memory("the list of kernels");
}

void task_kernels_stop(struct task_graph *graph)
{
    for (uint32_t i = 0; i < graph->n_kernels && graph->fixed; i++)
        base_free(graph->fixed[i].head);
    lists_free(&(struct kernel_lists){graph->kernels, graph->fixed, graph->kernel_place,
                                      graph->laws, graph->kernel_mask});
}

/* ---- One more ---- */

int task_kernel_check(const struct task_graph *graph, const duite_kernel *kernel)
{
    struct task_fixed fixed;
    const duite_law **laws = laws_with(graph->laws, kernel);
    int code = laws ? kernel_check(kernel, graph->n_kernels, &fixed) : base_no_memory("a kernel");
    for (uint32_t i = 0; i < graph->n_kernels && !code; i++)
        if (!strcmp(graph->kernels[i]->name, kernel->name))
            code = base_error(DUITE_E_KERNEL, "there is a kernel of the name %s already",
                              kernel->name);
    if (!code)
        code = data_laws_check(laws);
    if (!code)
        code = data_law_check_kernel(kernel, laws);
    base_free(laws);
    return code;
}

/* The graph's lists with one kernel more. False without memory. */
static bool lists_grow(const struct task_graph *graph, const duite_kernel *kernel,
                       struct kernel_lists *more)
{
    const uint32_t n = graph->n_kernels;
    *more = (struct kernel_lists){.kernels = base_alloc((n + 1) * sizeof *more->kernels),
                                  .fixed = base_alloc((n + 1) * sizeof *more->fixed),
                                  .laws = laws_with(graph->laws, kernel)};
    if (!more->kernels || !more->fixed || !more->laws)
        return false;
    memcpy(more->kernels, graph->kernels, n * sizeof *more->kernels);
    memcpy(more->fixed, graph->fixed, n * sizeof *more->fixed);
    more->kernels[n] = kernel;
    if (kernel_check(kernel, n, &more->fixed[n]) || kernel_prepare(graph, &more->fixed[n]))
        return false;
    more->place = kernels_index(more->fixed, n + 1, &more->mask);
    if (!more->place)
        base_free(more->fixed[n].head);
    return more->place != NULL;
}

int task_kernel_add(struct task_graph *graph, const duite_kernel *kernel)
{
    const struct kernel_lists old = {graph->kernels, graph->fixed, graph->kernel_place, graph->laws,
                                     graph->kernel_mask};
    struct kernel_lists more;
    if (!lists_grow(graph, kernel, &more)) {
        lists_free(&more);
        return base_no_memory("a kernel");
    }
    graph->kernels = more.kernels;
    graph->fixed = more.fixed;
    graph->kernel_place = more.place;
    graph->laws = more.laws;
    graph->kernel_mask = more.mask;
    graph->n_kernels++;
    lists_free(&old);
    return DUITE_OK;
}
