#ifndef DUITE_BASE_STACK_H
#define DUITE_BASE_STACK_H

#include <stdatomic.h>
#include <stddef.h>

/* The lock-free stack: any thread pushes a node, and one thread takes all nodes at once. Single
 * nodes are never taken, so no node returns to the stack while another thread still compares with
 * it.
 *
 * A stack is an `_Atomic(T *)`, NULL while it is empty; T has a member `T *next`, which belongs to
 * the stack from the push to the take. These are macros so that tasks, pieces and waiters keep
 * their own types T. The list of a version's waiters is no such stack: its producer closes it, see
 * data/version.h. */

/* Pushes a node. `order`: memory_order_release, or memory_order_seq_cst where the push must also be
 * ordered before a later look at something else. */
#define BASE_STACK_PUSH(stack, node, order)                                                        \
    do {                                                                                           \
        __typeof__((node)->next) base_first = atomic_load_explicit(stack, memory_order_relaxed);   \
        do                                                                                         \
            (node)->next = base_first;                                                             \
        while (!atomic_compare_exchange_weak_explicit(stack, &base_first, node, order,             \
                                                      memory_order_relaxed));                      \
    } while (0)

/* Takes all nodes: the list, newest first, linked by next. Sees all that their threads did before
 * the push. */
#define BASE_STACK_TAKE(stack) atomic_exchange_explicit(stack, NULL, memory_order_acquire)

/* True if the stack is empty; a look without order. */
#define BASE_STACK_IS_EMPTY(stack) (!atomic_load_explicit(stack, memory_order_relaxed))

/* Reverses a list that was taken: oldest first. `list` is a variable. */
#define BASE_LIST_REVERSE(list)                                                                    \
    do {                                                                                           \
        __typeof__(list) base_rest = list;                                                         \
        list = NULL;                                                                               \
        while (base_rest) {                                                                        \
            __typeof__(list) base_node = base_rest;                                                \
            base_rest = base_node->next;                                                           \
            base_node->next = list;                                                                \
            list = base_node;                                                                      \
        }                                                                                          \
    } while (0)

#endif
