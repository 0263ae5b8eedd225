#ifndef TESTS_MODEL_ATOMICS_H
#define TESTS_MODEL_ATOMICS_H

/* Included before a source file of the runtime, which is then compiled into the test with its
 * atomic operations, and what may block, given to the explorer. Headers of the system come first:
 * they must not see these. */
#include "tests/model/explore.h"

#include <errno.h>

/* The value's type, without _Atomic. */
#define EXPLORE_TYPE(object) __typeof__(((void)0, *(object)))

#undef atomic_load_explicit
#undef atomic_load
#undef atomic_store_explicit
#undef atomic_store
#undef atomic_init
#undef atomic_exchange_explicit
#undef atomic_exchange
#undef atomic_fetch_add_explicit
#undef atomic_fetch_add
#undef atomic_fetch_sub_explicit
#undef atomic_fetch_sub
#undef atomic_compare_exchange_strong_explicit
#undef atomic_compare_exchange_weak_explicit
#undef atomic_thread_fence
#undef atomic_flag_test_and_set_explicit
#undef atomic_flag_test_and_set
#undef atomic_flag_clear_explicit
#undef atomic_flag_clear

#define atomic_load_explicit(object, order)                                                        \
    __extension__({ (EXPLORE_TYPE(object)) explore_load(EXPLORE_PLACE(object), order); })
#define atomic_load(object) atomic_load_explicit(object, memory_order_seq_cst)
#define atomic_store_explicit(object, value, order)                                                \
    explore_store(EXPLORE_PLACE(object), (uint64_t)(value), order)
#define atomic_store(object, value) atomic_store_explicit(object, value, memory_order_seq_cst)
#define atomic_init(object, value)  ((void)(*(object) = (value)))
#define atomic_exchange_explicit(object, value, order)                                             \
    __extension__({                                                                                \
        (EXPLORE_TYPE(object)) explore_exchange(EXPLORE_PLACE(object), (uint64_t)(value), order);  \
    })
#define atomic_exchange(object, value) atomic_exchange_explicit(object, value, memory_order_seq_cst)
#define atomic_fetch_add_explicit(object, value, order)                                            \
    __extension__(                                                                                 \
        { (EXPLORE_TYPE(object)) explore_add(EXPLORE_PLACE(object), (uint64_t)(value), order); })
#define atomic_fetch_add(object, value)                                                            \
    atomic_fetch_add_explicit(object, value, memory_order_seq_cst)
#define atomic_fetch_sub_explicit(object, value, order)                                            \
    __extension__(                                                                                 \
        { (EXPLORE_TYPE(object)) explore_add(EXPLORE_PLACE(object), -(uint64_t)(value), order); })
#define atomic_fetch_sub(object, value)                                                            \
    atomic_fetch_sub_explicit(object, value, memory_order_seq_cst)
#define atomic_compare_exchange_strong_explicit(object, expected, value, order, failed)            \
    __extension__({                                                                                \
        uint64_t explore_old = (uint64_t) * (expected);                                            \
        bool explore_same =                                                                        \
            explore_compare(EXPLORE_PLACE(object), &explore_old, (uint64_t)(value), order);        \
        (void)(failed);                                                                            \
        *(expected) = (EXPLORE_TYPE(object))explore_old;                                           \
        explore_same;                                                                              \
    })
#define atomic_compare_exchange_weak_explicit atomic_compare_exchange_strong_explicit
#define atomic_thread_fence(order)            explore_fence(__func__, order)
#define atomic_flag_test_and_set_explicit(object, order)                                           \
    __extension__({ explore_exchange(EXPLORE_PLACE(object), 1, order) != 0; })
#define atomic_flag_test_and_set(object)                                                           \
    atomic_flag_test_and_set_explicit(object, memory_order_seq_cst)
#define atomic_flag_clear_explicit(object, order) explore_store(EXPLORE_PLACE(object), 0, order)
#define atomic_flag_clear(object)                 atomic_flag_clear_explicit(object, memory_order_seq_cst)

#define pthread_mutex_init(mutex, attributes)    ((void)(attributes), explore_clear(mutex))
#define pthread_mutex_destroy(mutex)             ((void)(mutex))
#define pthread_mutex_lock(mutex)                explore_lock(__func__, mutex)
#define pthread_mutex_unlock(mutex)              explore_unlock(__func__, mutex)
#define pthread_cond_init(condition, attributes) ((void)(attributes), explore_clear(condition))
#define pthread_cond_destroy(condition)          ((void)(condition))
#define pthread_cond_wait(condition, mutex)      explore_wait(__func__, condition, mutex, false)
#define pthread_cond_timedwait(condition, mutex, until)                                            \
    ((void)(until), explore_wait(__func__, condition, mutex, true) ? ETIMEDOUT : 0)
#define pthread_cond_signal(condition) explore_signal(__func__, condition)
#define pthread_create(thread, attributes, body, argument)                                         \
    explore_create(__func__, thread, body, argument)
#define pthread_join(thread, result) ((void)(result), explore_join(__func__, thread))
#define pthread_self()               explore_self()

#endif
