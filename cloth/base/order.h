#ifndef CLOTH_BASE_ORDER_H
#define CLOTH_BASE_ORDER_H

#include <stddef.h>
#include <stdint.h>

/* Compares two numbers for qsort: below 0, 0 or above 0. Their difference might overflow. */
static inline int cloth_compare_u32(uint32_t a, uint32_t b)
{
    return (a > b) - (a < b);
}

/* The same of two of an array, for qsort. */
static inline int cloth_compare_items_u32(const void *a, const void *b)
{
    return cloth_compare_u32(*(const uint32_t *)a, *(const uint32_t *)b);
}

/* The same of n numbers each: the first that differ count. */
static inline int cloth_compare_numbers(const void *a, const void *b, size_t n)
{
    const uint32_t *one = a, *other = b;
    int order = 0;
    for (size_t i = 0; i < n && !order; i++)
        order = cloth_compare_u32(one[i], other[i]);
    return order;
}

/* The same of items that begin with two, three or four numbers. */
static inline int cloth_by_two(const void *a, const void *b)
{
    return cloth_compare_numbers(a, b, 2);
}

static inline int cloth_by_three(const void *a, const void *b)
{
    return cloth_compare_numbers(a, b, 3);
}

static inline int cloth_by_four(const void *a, const void *b)
{
    return cloth_compare_numbers(a, b, 4);
}

/* The same of items that begin with a number of 64 bits. */
static inline int cloth_by_u64(const void *a, const void *b)
{
    const uint64_t one = *(const uint64_t *)a, other = *(const uint64_t *)b;
    return (one > other) - (one < other);
}

/* The same of items that begin with a double, none of which is NaN. */
static inline int cloth_by_double(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

/* The place of the first of n ascending numbers that is not below `least`; n: there is none. They
 * lie `stride` numbers from each other. */
static inline uint32_t cloth_first_from(const void *numbers, size_t stride, uint32_t n,
                                        uint32_t least)
{
    const uint32_t *number = numbers;
    uint32_t low = 0, high = n;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (number[stride * middle] < least)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static inline size_t cloth_larger(size_t a, size_t b)
{
    return a > b ? a : b;
}
static inline size_t cloth_smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

#endif
